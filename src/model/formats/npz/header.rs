//! The header of an `.npy` file and the types of number it names.

use std::io::Read;

use super::Half;

/// Dimensions that NumPy's arrays can have.
pub(super) const DIMENSIONS: usize = 64;
const MAGIC: &[u8; 6] = b"\x93NUMPY";

/// A number of any supported type.
#[derive(Clone, Copy, Debug)]
pub(super) enum Number {
    Int(i128),
    Float(f64),
}

/// Reads one number from a chunk of its length.
type ReadNumber = fn(&[u8]) -> Number;

/// Returns the bytes per number and a function that decodes one, for a type as NumPy describes it.
pub(super) fn decoder(dtype: &str) -> Option<(usize, ReadNumber)> {
    /// Returns a chunk of the right length as an array.
    fn le<const N: usize>(chunk: &[u8]) -> [u8; N] {
        std::array::from_fn(|i| chunk[i])
    }
    fn be<const N: usize>(chunk: &[u8]) -> [u8; N] {
        std::array::from_fn(|i| chunk[N - 1 - i])
    }
    macro_rules! read {
        ($kind:ident, $type:ty, $order:ident) => {
            Some((size_of::<$type>(), |chunk| {
                Number::$kind(<$type>::from_le_bytes($order(chunk)).into())
            }))
        };
    }
    match dtype {
        "|b1" | "|u1" => read!(Int, u8, le),
        "|i1" => read!(Int, i8, le),
        "<u2" => read!(Int, u16, le),
        "<u4" => read!(Int, u32, le),
        "<u8" => read!(Int, u64, le),
        "<i2" => read!(Int, i16, le),
        "<i4" => read!(Int, i32, le),
        "<i8" => read!(Int, i64, le),
        "<f2" => Some((2, |chunk| {
            Number::Float(Half::from_bits(u16::from_le_bytes(le(chunk))).to_f64())
        })),
        ">f2" => Some((2, |chunk| {
            Number::Float(Half::from_bits(u16::from_le_bytes(be(chunk))).to_f64())
        })),
        "<f4" => read!(Float, f32, le),
        "<f8" => read!(Float, f64, le),
        ">u2" => read!(Int, u16, be),
        ">u4" => read!(Int, u32, be),
        ">u8" => read!(Int, u64, be),
        ">i2" => read!(Int, i16, be),
        ">i4" => read!(Int, i32, be),
        ">i8" => read!(Int, i64, be),
        ">f4" => read!(Float, f32, be),
        ">f8" => read!(Float, f64, be),
        _ => None,
    }
}

/// Returns the sizes of a text and of one of its characters in bytes, for NumPy's texts of characters and of bytes.
pub(super) fn text(dtype: &str) -> Option<(usize, usize)> {
    let (of, digits) = dtype
        .strip_prefix("<U")
        .map(|digits| (4, digits))
        .or_else(|| dtype.strip_prefix("|S").map(|digits| (1, digits)))?;
    let length: usize = digits.parse().ok()?;
    Some((length.checked_mul(of)?, of))
}

pub(super) struct Header {
    pub dtype: String,
    pub fortran_order: bool,
    pub shape: Vec<usize>,
    /// Its own length, from the magic to the line break.
    pub bytes: usize,
}

/// Reads the header of an `.npy` file of at most `limit` bytes: magic, version, length, and a Python dictionary.
pub(super) fn read(mut data: impl Read, limit: usize) -> Result<Header, String> {
    let mut take = |count: usize| {
        let mut bytes = vec![0; count];
        data.read_exact(&mut bytes)
            .map(|()| bytes)
            .map_err(|error| format!("header cut short: {error}"))
    };
    let start = take(8)?;
    if !start.starts_with(MAGIC) {
        return Err("does not begin like an npy file".to_string());
    }
    let (length, before) = match start[6] {
        1 => (
            take(2)?.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte)),
            10,
        ),
        2 | 3 => (
            take(4)?.iter().rev().fold(0, |sum, byte| sum << 8 | usize::from(*byte)),
            12,
        ),
        version => return Err(format!("unknown npy version {version}")),
    };
    if length > limit {
        return Err(format!("the header has {length} bytes; the limit is {limit}"));
    }
    let text = String::from_utf8(take(length)?).map_err(|_| "the header is not UTF-8 text".to_string())?;
    let mut header = Dictionary(&text)
        .parse()
        .ok_or("the header is not the dictionary of an npy file")?;
    header.bytes = before + length;
    Ok(header)
}

/// The rest of a Python dictionary such as `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }`.
struct Dictionary<'t>(&'t str);

impl<'t> Dictionary<'t> {
    fn parse(&mut self) -> Option<Header> {
        let (mut dtype, mut fortran_order, mut shape) = (None, None, None);
        self.eat("{").then_some(())?;
        while !self.eat("}") {
            let key = self.string()?;
            self.eat(":").then_some(())?;
            match key {
                "descr" if dtype.is_none() => dtype = Some(self.dtype()?),
                "fortran_order" if fortran_order.is_none() => fortran_order = Some(self.boolean()?),
                "shape" if shape.is_none() => shape = Some(self.shape()?),
                _ => return None,
            }
            if !self.eat(",") && !self.0.trim_start().starts_with('}') {
                return None;
            }
        }
        self.0.trim().is_empty().then_some(())?;
        Some(Header {
            dtype: dtype?.to_string(),
            fortran_order: fortran_order?,
            shape: shape?,
            bytes: 0,
        })
    }

    fn eat(&mut self, token: &str) -> bool {
        let rest = self.0.trim_start().strip_prefix(token);
        self.0 = rest.unwrap_or(self.0);
        rest.is_some()
    }

    fn string(&mut self) -> Option<&'t str> {
        let quote = if self.eat("'") {
            '\''
        } else {
            self.eat("\"").then_some('"')?
        };
        let (text, rest) = self.0.split_once(quote)?;
        self.0 = rest;
        Some(text)
    }

    fn boolean(&mut self) -> Option<bool> {
        if self.eat("True") {
            Some(true)
        } else {
            self.eat("False").then_some(false)
        }
    }

    /// Parses the type: a string, or the list of fields as written for a structure, which is not supported.
    fn dtype(&mut self) -> Option<&'t str> {
        self.0 = self.0.trim_start();
        if !self.0.starts_with('[') {
            return self.string();
        }
        let mut depth = 0_usize;
        let end = self.0.find(|c| {
            depth = if c == '[' {
                depth + 1
            } else {
                depth - usize::from(c == ']')
            };
            depth == 0
        })?;
        let (list, rest) = self.0.split_at(end + 1);
        self.0 = rest;
        Some(list)
    }

    fn shape(&mut self) -> Option<Vec<usize>> {
        let mut shape = Vec::new();
        self.eat("(").then_some(())?;
        while !self.eat(")") {
            self.0 = self.0.trim_start();
            let end = self.0.find(|c: char| !c.is_ascii_digit())?;
            let (digits, rest) = self.0.split_at(end);
            shape.push(digits.parse().ok()?);
            self.0 = rest;
            if !self.eat(",") && !self.0.trim_start().starts_with(')') || shape.len() > DIMENSIONS {
                return None;
            }
        }
        Some(shape)
    }
}

/// Returns the header of an `.npy` file, padded to a multiple of 64 bytes.
pub(super) fn write(dtype: &str, shape: &[usize]) -> Vec<u8> {
    let lengths: String = shape.iter().map(|length| format!("{length}, ")).collect();
    // Python writes a tuple of one with a comma, longer ones without a last comma; it reads both.
    let shape = if shape.len() == 1 {
        lengths.trim_end()
    } else {
        lengths.trim_end_matches(", ")
    };
    let mut text = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': ({shape}), }}");
    let before = MAGIC.len() + 4;
    let padding = (before + text.len() + 1).next_multiple_of(64) - (before + text.len() + 1);
    text.extend(std::iter::repeat_n(' ', padding));
    text.push('\n');
    let length = text.len() as u16; // at most 64 dimensions of 22 characters
    [MAGIC, &[1, 0][..], &length.to_le_bytes(), text.as_bytes()].concat()
}

//! Pictures from files that are not trusted: every chunk is checked before a decoder sees it.

use ::png::{BitDepth, Decoder, DecodingError, Transformations};

use crate::limits::Limits;

/// The first bytes of every PNG file.
const SIGNATURE: &[u8; 8] = b"\x89PNG\r\n\x1a\n";
/// Bytes of a chunk besides its data: length, name, checksum.
const FRAME: usize = 12;
/// The colour type of pictures with a palette.
const INDEXED: u8 = 3;

/// A picture of 8 bits a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width, pixels.
    pub width: usize,
    /// Height, pixels.
    pub height: usize,
    /// Red, green and blue of each pixel, rows from the top (height, width, 3).
    pub rgb: Vec<u8>,
}

/// Decodes a PNG picture to red, green and blue. Samples of 16 bits are rounded to 8.
///
/// The decoder gets the chunks that make the pixels and no others: texts, profiles and animations have no effect on
/// them.
///
/// # Errors
/// A description of the fault, without the name of the picture.
pub fn decode_png(bytes: &[u8], limits: &Limits) -> Result<Picture, String> {
    let samples = Samples::of(bytes, limits)?;
    let channels = samples.channels;
    let pixels = samples.values.chunks_exact(channels);
    let rgb = match channels {
        1 | 2 => pixels.flat_map(|pixel| [pixel[0]; 3]).collect(),
        3 => samples.values,
        _ => pixels.flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect(),
    };
    Ok(Picture {
        width: samples.width,
        height: samples.height,
        rgb,
    })
}

/// Checks a PNG picture as far as possible without decoding it, each chunk by its checksum; returns width and height, pixels. The error is like that
/// of [`decode_png`].
pub fn check_png(bytes: &[u8], limits: &Limits) -> Result<[u32; 2], String> {
    let pixels = essential(bytes, limits)?;
    let header = chunk(&pixels, SIGNATURE.len())?;
    let side = |at: usize| header.data.get(at..).and_then(|rest| rest.first_chunk::<4>());
    let sides = [0, 4].map(|at| side(at).map_or(0, |side| u32::from_be_bytes(*side)));
    Ok(sides)
}

/// Returns whether a PNG picture is opaque: every pixel has full opacity. A picture with a transparent colour (chunk tRNS) counts as not opaque.
///
/// # Errors
/// A description of the fault, without the name of the picture.
pub fn is_opaque(bytes: &[u8], limits: &Limits) -> Result<bool, String> {
    let Samples { channels, values, .. } = Samples::of(bytes, limits)?;
    let keyed = bytes.windows(4).any(|name| name == b"tRNS");
    let has_alpha = channels == 2 || channels == 4;
    Ok(!keyed
        && (!has_alpha
            || values
                .chunks_exact(channels)
                .all(|pixel| pixel[channels - 1] == u8::MAX)))
}

/// The samples of a picture as stored, 8 bits each.
struct Samples {
    width: usize,
    height: usize,
    /// 1 for gray, 2 with opacity; 3 for colours, 4 with opacity.
    channels: usize,
    values: Vec<u8>,
}

impl Samples {
    fn of(bytes: &[u8], limits: &Limits) -> Result<Self, String> {
        let broken = |e: DecodingError| format!("the PNG picture is broken: {e}");
        let most = usize::try_from(limits.picture_bytes).unwrap_or(usize::MAX);
        let pixels = essential(bytes, limits)?;
        let mut decoder = Decoder::new_with_limits(std::io::Cursor::new(pixels), ::png::Limits { bytes: most });
        // palettes become colours, and 1, 2 and 4 bits become 8
        decoder.set_transformations(Transformations::EXPAND);
        let mut reader = decoder.read_info().map_err(broken)?;
        let needed = reader.output_buffer_size().filter(|&needed| needed <= most);
        let needed = needed.ok_or_else(|| format!("its pixels take more than {most} bytes"))?;
        let mut values = vec![0; needed];
        let info = reader.next_frame(&mut values).map_err(broken)?;
        if info.bit_depth == BitDepth::Sixteen {
            // rounded to the nearest of the 256 values
            let (words, _) = values.as_chunks::<2>();
            values = words
                .iter()
                .map(|&word| ((u32::from(u16::from_be_bytes(word)) + 128) / 257) as u8)
                .collect();
        }
        Ok(Self {
            width: info.width as usize,
            height: info.height as usize,
            channels: info.color_type.samples(),
            values,
        })
    }
}

/// A chunk of a picture, and where it begins.
#[derive(Clone, Copy)]
struct Chunk<'a> {
    at: usize,
    name: &'a str,
    data: &'a [u8],
    whole: &'a [u8],
}

/// Returns the chunk at a byte, after checking its checksum.
fn chunk(bytes: &[u8], at: usize) -> Result<Chunk<'_>, String> {
    let rest = bytes.get(at..).unwrap_or_default();
    let Some((&length, rest)) = rest.split_first_chunk::<4>() else {
        return Err(format!("the picture ends at byte {at}, before its last chunk (IEND)"));
    };
    let name = rest.get(..4).filter(|n| n.iter().all(u8::is_ascii_alphabetic));
    let Some(name) = name.and_then(|n| std::str::from_utf8(n).ok()) else {
        return Err(format!("there is no chunk at byte {at}"));
    };
    let length = u32::from_be_bytes(length) as usize;
    let whole = bytes.get(at..).and_then(|b| b.get(..length.checked_add(FRAME)?));
    let Some(whole) = whole else {
        let left = rest.len() - 4;
        return Err(format!(
            "the chunk {name} at byte {at} should have {length} bytes, but the file ends {left} bytes after its name"
        ));
    };
    let (checked, checksum) = (&whole[4..8 + length], &whole[8 + length..]);
    if crc32fast::hash(checked).to_be_bytes() != checksum {
        return Err(format!(
            "the chunk {name} at byte {at} is damaged: its checksum is wrong"
        ));
    }
    let data = &checked[4..];
    Ok(Chunk { at, name, data, whole })
}

/// Returns the picture with only the chunks that define its pixels, each of them checked.
fn essential(bytes: &[u8], limits: &Limits) -> Result<Vec<u8>, String> {
    if !bytes.starts_with(SIGNATURE) {
        return Err("not a PNG picture: it does not start with the bytes of one".to_string());
    }
    let header = chunk(bytes, SIGNATURE.len())?;
    let colour = check_header(&header, limits)?;
    let mut out = SIGNATURE.to_vec();
    out.extend_from_slice(header.whole);
    let (mut at, mut entries) = (SIGNATURE.len() + header.whole.len(), None);
    loop {
        let chunk = chunk(bytes, at)?;
        at += chunk.whole.len();
        match chunk.name {
            "PLTE" if colour == INDEXED => entries = Some(check_palette(&chunk, entries)?),
            "tRNS" | "PLTE" => continue, // no part of red, green and blue
            "IDAT" if colour == INDEXED && entries.is_none() => {
                return Err("a picture with a palette has no palette (chunk PLTE) before its pixels".to_string());
            }
            "IDAT" | "IEND" => {}
            name if name.starts_with(|c: char| c.is_ascii_lowercase()) => continue,
            name => return Err(format!("the chunk {name} at byte {} is not known", chunk.at)),
        }
        out.extend_from_slice(chunk.whole);
        if chunk.name == "IEND" {
            return Ok(out);
        }
    }
}

/// Checks size and colours; returns the colour type.
fn check_header(header: &Chunk, limits: &Limits) -> Result<u8, String> {
    let (b"IHDR", &[w0, w1, w2, w3, h0, h1, h2, h3, depth, colour, _, _, _]) = (header.name.as_bytes(), header.data)
    else {
        return Err("it does not start with a header (chunk IHDR of 13 bytes)".to_string());
    };
    let (width, height) = (
        u32::from_be_bytes([w0, w1, w2, w3]),
        u32::from_be_bytes([h0, h1, h2, h3]),
    );
    let side = limits.picture_side;
    if !(1..=side).contains(&width) || !(1..=side).contains(&height) {
        return Err(format!("it has {width} x {height} pixels; a side has 1 to {side}"));
    }
    match (colour, depth) {
        (0, 1 | 2 | 4 | 8 | 16) | (INDEXED, 1 | 2 | 4 | 8) | (2 | 4 | 6, 8 | 16) => Ok(colour),
        _ => Err(format!(
            "there are no pictures of colour type {colour} with {depth} bits"
        )),
    }
}

/// Checks a palette; returns its number of entries.
fn check_palette(chunk: &Chunk, before: Option<usize>) -> Result<usize, String> {
    let length = chunk.data.len();
    match (length % 3, length / 3, before) {
        (0, entries @ 1..=256, None) => Ok(entries),
        (_, _, Some(_)) => Err(format!("it has a second palette (chunk PLTE) at byte {}", chunk.at)),
        _ => Err(format!(
            "its palette (chunk PLTE) has {length} bytes; it must have three for each of 1 to 256 colours"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::png::{ColorType, png};

    fn with_chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
        let mut checked = name.to_vec();
        checked.extend_from_slice(data);
        let mut out = (data.len() as u32).to_be_bytes().to_vec();
        out.extend_from_slice(&checked);
        out.extend_from_slice(&crc32fast::hash(&checked).to_be_bytes());
        out
    }

    /// A picture of the given header and chunks.
    fn picture(width: u32, height: u32, depth: u8, colour: u8, chunks: &[Vec<u8>]) -> Vec<u8> {
        let sides = [width.to_be_bytes(), height.to_be_bytes()].concat();
        let header = [&sides[..], &[depth, colour, 0, 0, 0]].concat();
        [&SIGNATURE[..], &with_chunk(b"IHDR", &header), &chunks.concat()].concat()
    }

    fn error(bytes: &[u8]) -> String {
        decode_png(bytes, &Limits::DEFAULT).expect_err("broken")
    }

    fn pixels() -> Vec<u8> {
        // deflate without compression: one row of a filter byte and an index, twice
        let rows = [0, 0, 0, 0, 0, 0];
        let stored = [&[0x78, 0x01, 0x01, 6, 0, 0xf9, 0xff][..], &rows, &[0, 6, 0, 1]].concat();
        with_chunk(b"IDAT", &stored)
    }

    #[test]
    fn palettes_are_checked_before_they_are_decoded() {
        let with = |palette: &[u8]| {
            let chunks = [with_chunk(b"PLTE", palette), pixels(), with_chunk(b"IEND", &[])];
            picture(2, 2, 8, 3, &chunks)
        };
        let good = decode_png(&with(&[9, 8, 7]), &Limits::DEFAULT).expect("a picture");
        assert_eq!(good.rgb, [9, 8, 7].repeat(4));
        for length in [0, 1, 2, 4, 769, 771] {
            assert_eq!(
                error(&with(&vec![0; length])),
                format!("its palette (chunk PLTE) has {length} bytes; it must have three for each of 1 to 256 colours")
            );
        }
        let none = picture(2, 2, 8, 3, &[pixels(), with_chunk(b"IEND", &[])]);
        assert!(error(&none).contains("has no palette"));
    }

    #[test]
    fn damage_is_told_in_words() {
        let good = png(&[7; 12], 2, 2, ColorType::Rgb).expect("a picture");
        let mut wrong = good.clone();
        let at = wrong.len() - 18;
        wrong[at] ^= 1;
        assert_eq!(
            error(&wrong),
            "the chunk IDAT at byte 33 is damaged: its checksum is wrong"
        );
        for cut in 0..good.len() {
            assert!(decode_png(&good[..cut], &Limits::DEFAULT).is_err());
        }
        assert!(error(&good[..good.len() - 12]).contains("before its last chunk"));
        let length = u32::from_be_bytes([good[33], good[34], good[35], good[36]]); // the compressor's own affair
        assert_eq!(
            error(&good[..50]),
            format!("the chunk IDAT at byte 33 should have {length} bytes, but the file ends 9 bytes after its name")
        );
        let huge = picture(9000, 1, 8, 2, &[]);
        assert_eq!(error(&huge), "it has 9000 x 1 pixels; a side has 1 to 8192");
        assert_eq!(
            error(&picture(1, 1, 3, 2, &[])),
            "there are no pictures of colour type 2 with 3 bits"
        );
        assert!(error(b"GIF89a").starts_with("not a PNG picture"));
    }
}

//! Values -> protocol 4.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::{Array, PickleError, Value};
use crate::limits::Limits;

/// Writes a value as a pickle of protocol 4. The same value gives the same bytes.
///
/// # Errors
/// Values nested too deeply, an array whose shape does not fit its numbers.
pub fn to_bytes(value: &Value) -> Result<Vec<u8>, PickleError> {
    let mut writer = PickleWriter::new();
    writer.value(value, 0)?;
    writer.out.push(b'.');
    Ok(writer.out)
}

/// A list of dictionaries as a pickle that grows, so that their sources need not stay in memory. At any time, the bytes are those of [`to_bytes`] for
/// the whole list.
#[derive(Clone)]
pub(crate) struct ListWriter {
    writer: PickleWriter,
    items: usize,
}

/// The opcodes that end a pickled list, and the pickle.
const END: &[u8] = b"e.";

impl ListWriter {
    /// Begins a list, with a capacity of `bytes` bytes.
    pub fn with_capacity(bytes: usize) -> Self {
        let mut writer = PickleWriter::new();
        writer.out.reserve(bytes);
        writer.begin_list();
        writer.out.extend(END);
        Self { writer, items: 0 }
    }

    /// Adds a dictionary, which `fill` fills.
    pub fn push(&mut self, fill: impl FnOnce(&mut DictWriter)) {
        let writer = &mut self.writer;
        writer.out.truncate(writer.out.len() - END.len());
        writer.begin_item(self.items);
        writer.out.extend(b"}(");
        fill(&mut DictWriter { writer });
        writer.out.push(b'u');
        writer.out.extend(END);
        self.items += 1;
    }

    /// Returns the pickle.
    pub fn as_bytes(&self) -> &[u8] {
        &self.writer.out
    }
}

impl std::fmt::Debug for ListWriter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (items, bytes) = (self.items, self.writer.out.len());
        write!(f, "ListWriter {{ items: {items}, bytes: {bytes} }}")
    }
}

/// Writes the entries of a dictionary.
pub(crate) struct DictWriter<'w> {
    writer: &'w mut PickleWriter,
}

impl DictWriter<'_> {
    /// Adds a whole number.
    pub fn int(&mut self, key: &'static str, value: i64) {
        self.writer.key(key);
        self.writer.int(value);
    }

    /// Adds a list of whole numbers.
    pub fn ints(&mut self, key: &'static str, values: impl Iterator<Item = i64>) {
        self.writer.key(key);
        self.writer.begin_list();
        for (index, value) in values.enumerate() {
            self.writer.begin_item(index);
            self.writer.int(value);
        }
        self.writer.end_list();
    }

    /// Adds a number.
    pub fn float(&mut self, key: &'static str, value: f64) {
        self.writer.key(key);
        self.writer.float(value);
    }

    /// Adds a truth value.
    pub fn bool(&mut self, key: &'static str, value: bool) {
        self.writer.key(key);
        self.writer.bool(value);
    }

    /// Adds a text.
    pub fn text(&mut self, key: &'static str, value: &str) {
        self.writer.key(key);
        self.writer.text(value);
    }
}

/// Number of items that are appended to a list at once, as in Python; a reader need not hold more.
const BATCH: usize = 1000;

/// Memo indices of NumPy's constructor, its array type and the type `float64`.
type NumpyMemo = [u32; 3];

#[derive(Clone)]
struct PickleWriter {
    out: Vec<u8>,
    keys: BTreeMap<Arc<str>, u32>,
    numpy: Option<NumpyMemo>,
    memo: u32,
}

impl PickleWriter {
    fn new() -> Self {
        Self {
            out: vec![0x80, 4],
            keys: BTreeMap::new(),
            numpy: None,
            memo: 0,
        }
    }

    fn value(&mut self, value: &Value, depth: usize) -> Result<(), PickleError> {
        // what is written can be read
        let limit = Limits::DEFAULT.pickle_depth;
        if depth > limit {
            let what = "levels of nesting";
            return Err(PickleError::Limit { what, limit });
        }
        match value {
            Value::None => self.out.push(b'N'),
            Value::Bool(b) => self.bool(*b),
            Value::Int(i) => self.int(*i),
            Value::Float(f) => self.float(*f),
            Value::Text(t) => self.text(t),
            Value::List(items) => {
                self.begin_list();
                for (index, item) in items.iter().enumerate() {
                    self.begin_item(index);
                    self.value(item, depth + 1)?;
                }
                self.end_list();
            }
            Value::Dict(items) => {
                self.out.extend(b"}(");
                for (key, item) in items.iter() {
                    self.key(key);
                    self.value(item, depth + 1)?;
                }
                self.out.push(b'u');
            }
            Value::Array(array) => self.array(array)?,
        }
        Ok(())
    }

    fn begin_list(&mut self) {
        self.out.extend(b"](");
    }

    /// Begins an item of a list by its index.
    fn begin_item(&mut self, index: usize) {
        if index > 0 && index.is_multiple_of(BATCH) {
            self.out.extend(b"e(");
        }
    }

    /// Writes a key of a dictionary, in full only the first time.
    fn key(&mut self, key: &str) {
        match self.keys.get(key) {
            Some(&index) => self.get(index),
            None => {
                self.text(key);
                let index = self.put();
                self.keys.insert(key.into(), index);
            }
        }
    }

    fn end_list(&mut self) {
        self.out.push(b'e');
    }

    /// Remembers the top of the stack.
    fn put(&mut self) -> u32 {
        let index = self.memo;
        self.memo += 1;
        self.out.push(0x94);
        index
    }

    /// Writes an opcode that recalls an entry of the memo.
    fn get(&mut self, index: u32) {
        match u8::try_from(index) {
            Ok(byte) => self.out.extend([b'h', byte]),
            Err(_) => {
                self.out.push(b'j');
                self.out.extend(index.to_le_bytes());
            }
        }
    }

    fn bool(&mut self, on: bool) {
        self.out.push(if on { 0x88 } else { 0x89 });
    }

    fn float(&mut self, number: f64) {
        self.out.push(b'G');
        self.out.extend(number.to_be_bytes());
    }

    fn int(&mut self, i: i64) {
        let bytes = i.to_le_bytes();
        if let Ok(byte) = u8::try_from(i) {
            self.out.extend([b'K', byte]);
        } else if u16::try_from(i).is_ok() {
            self.out.push(b'M');
            self.out.extend(&bytes[..2]);
        } else if i32::try_from(i).is_ok() {
            self.out.push(b'J');
            self.out.extend(&bytes[..4]);
        } else {
            self.out.extend([0x8a, 8]);
            self.out.extend(bytes);
        }
    }

    fn text(&mut self, text: &str) {
        self.sized(0x8c, 0x8d, text.as_bytes());
    }

    /// Writes bytes after their length in one or in eight bytes.
    fn sized(&mut self, short: u8, long: u8, bytes: &[u8]) {
        match u8::try_from(bytes.len()) {
            Ok(length) => self.out.extend([short, length]),
            Err(_) => {
                self.out.push(long);
                self.out.extend((bytes.len() as u64).to_le_bytes());
            }
        }
        self.out.extend(bytes);
    }

    /// Writes `_reconstruct(ndarray, (0,), b'b')`, then its state `(1, shape, float64, False, data)`, as NumPy itself
    /// does.
    fn array(&mut self, array: &Array) -> Result<(), PickleError> {
        if array.shape.iter().product::<usize>() != array.data.len() {
            let (at, reason) = (self.out.len(), "an array's shape does not fit its numbers");
            return Err(PickleError::Malformed { at, reason });
        }
        let [_, _, dtype] = match self.numpy {
            Some(memo) => {
                self.get(memo[0]);
                self.get(memo[1]);
                memo
            }
            None => {
                // both NumPy 1 and NumPy 2 find it under its old name, without a warning
                self.global("numpy.core.multiarray", "_reconstruct");
                let reconstruct = self.put();
                self.global("numpy", "ndarray");
                [reconstruct, self.put(), self.memo]
            }
        };
        self.out
            .extend([b'K', 0, 0x85, b'C', 1, b'b', 0x87, b'R', b'(', b'K', 1, b'(']);
        for &n in &array.shape {
            self.int(n as i64);
        }
        self.out.push(b't');
        match &mut self.numpy {
            Some(_) => self.get(dtype),
            None => {
                self.float64();
                let ndarray = self.put() - 1;
                self.numpy = Some([ndarray - 1, ndarray, dtype]);
            }
        }
        self.out.push(0x89);
        let data: Vec<u8> = array.data.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.sized(b'C', 0x8e, &data);
        self.out.extend(b"tb");
        Ok(())
    }

    fn global(&mut self, module: &str, name: &str) {
        self.text(module);
        self.text(name);
        self.out.push(0x93);
    }

    /// Writes `dtype('f8', False, True)` with its state `(3, '<', None, None, None, -1, -1, 0)`.
    fn float64(&mut self) {
        self.global("numpy", "dtype");
        self.text("f8");
        self.out.extend([0x89, 0x88, 0x87, b'R', b'(', b'K', 3]);
        self.text("<");
        self.out.extend(b"NNN");
        self.int(-1);
        self.int(-1);
        self.out.extend(b"K\x00tb");
    }
}

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
    let mut writer = Writer::new();
    writer.value(value, 0)?;
    writer.out.push(b'.');
    Ok(writer.out)
}

/// Writes a list item by item, so that the items need not be in memory at the same time. The bytes are those of
/// [`to_bytes`] for the whole list.
pub(crate) struct ListWriter {
    writer: Writer,
    items: usize,
}

impl ListWriter {
    /// Begins a list.
    pub fn new() -> Self {
        let mut writer = Writer::new();
        writer.begin_list();
        Self { writer, items: 0 }
    }

    /// Adds an item.
    ///
    /// # Errors
    /// As [`to_bytes`].
    pub fn push(&mut self, item: &Value) -> Result<(), PickleError> {
        self.writer.item(self.items, item, 1)?;
        self.items += 1;
        Ok(())
    }

    /// Ends the list and returns the pickle.
    pub fn finish(mut self) -> Vec<u8> {
        self.writer.end_list();
        self.writer.out.push(b'.');
        self.writer.out
    }
}

/// Number of items that are appended to a list at once, as Python does it; a reader need not hold more.
const BATCH: usize = 1000;

/// Memo indices of NumPy's constructor, its array type and the type `float64`.
type Numpy = [u32; 3];

struct Writer {
    out: Vec<u8>,
    keys: BTreeMap<Arc<str>, u32>,
    numpy: Option<Numpy>,
    memo: u32,
}

impl Writer {
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
            Value::Bool(b) => self.out.push(if *b { 0x88 } else { 0x89 }),
            Value::Int(i) => self.int(*i),
            Value::Float(f) => {
                self.out.push(b'G');
                self.out.extend(f.to_be_bytes());
            }
            Value::Text(t) => self.text(t),
            Value::List(items) => {
                self.begin_list();
                for (index, item) in items.iter().enumerate() {
                    self.item(index, item, depth + 1)?;
                }
                self.end_list();
            }
            Value::Dict(items) => {
                self.out.extend(b"}(");
                for (key, item) in items.iter() {
                    match self.keys.get(&**key) {
                        Some(&index) => self.get(index),
                        None => {
                            self.text(key);
                            let index = self.put();
                            self.keys.insert(key.clone(), index);
                        }
                    }
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

    /// Writes an item of a list by its index.
    fn item(&mut self, index: usize, item: &Value, depth: usize) -> Result<(), PickleError> {
        if index > 0 && index.is_multiple_of(BATCH) {
            self.out.extend(b"e(");
        }
        self.value(item, depth)
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

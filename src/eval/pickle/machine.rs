//! Protocols 2 to 5 -> values: a stack machine that knows only what logs need.

use std::borrow::Cow;
use std::sync::Arc;

use super::construct::Callable;
use super::numbers::Dtype;
use super::{Array, MAX_BYTES, MAX_NUMBERS, MAX_OBJECTS, PickleError, Value};

/// Reads a pickle of protocol 2 to 5.
///
/// # Errors
/// Anything that logs do not need, anything damaged, anything larger than the limits of this module. Input is never
/// trusted: nothing is looked up or called, and errors name the byte.
pub fn from_bytes(bytes: &[u8]) -> Result<Value, PickleError> {
    if bytes.len() > MAX_BYTES {
        let (what, limit) = ("bytes", MAX_BYTES);
        return Err(PickleError::Limit { what, limit });
    }
    Machine::new(bytes).run()
}

/// What a stack holds: small things themselves, others by number.
#[derive(Clone, Copy, Debug)]
pub(super) enum Item {
    None,
    Bool(bool),
    Int(i64),
    Float(f64),
    Object(usize),
}

#[derive(Debug)]
pub(super) enum Object<'a> {
    Text(&'a str),
    Bytes(Cow<'a, [u8]>),
    List(Vec<Item>),
    Tuple(Vec<Item>),
    Dict(Vec<(Item, Item)>),
    Callable(Callable),
    Dtype(Dtype),
    /// `None` until its state is known.
    Array(Option<Arc<Array>>),
}

pub(super) struct Machine<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Where the current opcode stands.
    pub(super) op: usize,
    pub(super) stack: Vec<Item>,
    marks: Vec<usize>,
    memo: Vec<Item>,
    pub(super) objects: Vec<Object<'a>>,
    /// What of [`MAX_NUMBERS`] is left.
    budget: usize,
}

pub(super) type Done = Result<(), PickleError>;

impl<'a> Machine<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            at: 0,
            op: 0,
            stack: Vec::new(),
            marks: Vec::new(),
            memo: Vec::new(),
            objects: Vec::new(),
            budget: MAX_NUMBERS,
        }
    }

    fn run(mut self) -> Result<Value, PickleError> {
        if self.bytes.first().is_some_and(|b| *b != 0x80) {
            return Err(self.bad("it does not start with a protocol number from 2 on"));
        }
        loop {
            self.op = self.at;
            let [opcode] = self.array()?;
            if opcode == b'.' {
                break;
            }
            self.step(opcode)?;
            if self.objects.len().max(self.stack.len()).max(self.memo.len()) > MAX_OBJECTS {
                let (what, limit) = ("values", MAX_OBJECTS);
                return Err(PickleError::Limit { what, limit });
            }
        }
        let root = self.pop()?;
        if !self.stack.is_empty() || !self.marks.is_empty() {
            return Err(self.bad("it ends with more than one value"));
        }
        self.unfold(root)
    }

    pub(super) fn bad(&self, reason: &'static str) -> PickleError {
        PickleError::Malformed { at: self.op, reason }
    }

    /// The next `n` bytes.
    fn take(&mut self, n: usize) -> Result<&'a [u8], PickleError> {
        let piece = self.bytes.get(self.at..).and_then(|rest| rest.get(..n));
        let piece = piece.ok_or(PickleError::Truncated { at: self.bytes.len() })?;
        self.at += n;
        Ok(piece)
    }

    fn array<const N: usize>(&mut self) -> Result<[u8; N], PickleError> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N)?);
        Ok(out)
    }

    /// Bytes after their length in `N` bytes.
    fn sized<const N: usize>(&mut self) -> Result<&'a [u8], PickleError> {
        let length = self
            .array::<N>()?
            .iter()
            .rev()
            .fold(0_u64, |n, &b| n << 8 | u64::from(b));
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        self.take(length)
    }

    fn line(&mut self) -> Result<&'a str, PickleError> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let end = rest.iter().position(|b| *b == b'\n');
        let line = self.take(end.unwrap_or(rest.len()))?;
        self.take(1)?;
        self.utf8(line)
    }

    fn utf8(&self, bytes: &'a [u8]) -> Result<&'a str, PickleError> {
        std::str::from_utf8(bytes).map_err(|_| self.bad("text that is not UTF-8"))
    }

    pub(super) fn push(&mut self, object: Object<'a>) {
        self.stack.push(Item::Object(self.objects.len()));
        self.objects.push(object);
    }

    fn push_text(&mut self, bytes: &'a [u8]) -> Done {
        let text = self.utf8(bytes)?;
        self.push(Object::Text(text));
        Ok(())
    }

    fn push_bytes(&mut self, bytes: &'a [u8]) {
        self.push(Object::Bytes(Cow::Borrowed(bytes)));
    }

    pub(super) fn pop(&mut self) -> Result<Item, PickleError> {
        if self.stack.len() <= self.marks.last().copied().unwrap_or(0) {
            return Err(self.bad("a value is missing"));
        }
        self.stack.pop().ok_or_else(|| self.bad("a value is missing"))
    }

    /// The top `N` values.
    pub(super) fn pops<const N: usize>(&mut self) -> Result<[Item; N], PickleError> {
        let mut out = [Item::None; N];
        for slot in out.iter_mut().rev() {
            *slot = self.pop()?;
        }
        Ok(out)
    }

    /// What stands above the last mark.
    fn pop_mark(&mut self) -> Result<Vec<Item>, PickleError> {
        let mark = self.marks.pop().ok_or_else(|| self.bad("a mark is missing"))?;
        Ok(self.stack.split_off(mark))
    }

    pub(super) fn top(&mut self) -> Result<Item, PickleError> {
        let item = self.pop()?;
        self.stack.push(item);
        Ok(item)
    }

    fn put(&mut self, index: usize) -> Done {
        let item = self.top()?;
        if index < self.memo.len() {
            self.memo[index] = item;
        } else if index == self.memo.len() {
            self.memo.push(item);
        } else {
            return Err(self.bad("the memo has a hole"));
        }
        Ok(())
    }

    fn get(&mut self, index: usize) -> Done {
        let item = self.memo.get(index).copied();
        self.stack
            .push(item.ok_or_else(|| self.bad("the memo has no such entry"))?);
        Ok(())
    }

    fn step(&mut self, opcode: u8) -> Done {
        match opcode {
            0x80 => match self.array()? {
                [2..=5] => {}
                _ => return Err(self.bad("a protocol other than 2 to 5")),
            },
            0x95 => drop(self.take(8)?), // length of a frame: only for buffering
            b'(' => self.marks.push(self.stack.len()),
            b'N' => self.stack.push(Item::None),
            0x88 => self.stack.push(Item::Bool(true)),
            0x89 => self.stack.push(Item::Bool(false)),
            b'J' => {
                let i = i32::from_le_bytes(self.array()?);
                self.stack.push(Item::Int(i64::from(i)));
            }
            b'K' => {
                let [byte] = self.array()?;
                self.stack.push(Item::Int(i64::from(byte)));
            }
            b'M' => {
                let i = u16::from_le_bytes(self.array()?);
                self.stack.push(Item::Int(i64::from(i)));
            }
            0x8a => {
                let digits = self.sized::<1>()?;
                let negative = digits.last().is_some_and(|b| b & 0x80 != 0);
                let mut all = [if negative { 0xff } else { 0 }; 8];
                match all.get_mut(..digits.len()) {
                    Some(low) => low.copy_from_slice(digits),
                    None => return Err(self.bad("an integer of more than 64 bits")),
                }
                self.stack.push(Item::Int(i64::from_le_bytes(all)));
            }
            b'G' => {
                let f = f64::from_be_bytes(self.array()?);
                self.stack.push(Item::Float(f));
            }
            0x8c => return self.sized::<1>().and_then(|b| self.push_text(b)),
            b'X' => return self.sized::<4>().and_then(|b| self.push_text(b)),
            0x8d => return self.sized::<8>().and_then(|b| self.push_text(b)),
            b'C' => return self.sized::<1>().map(|b| self.push_bytes(b)),
            b'B' => return self.sized::<4>().map(|b| self.push_bytes(b)),
            0x8e | 0x96 => return self.sized::<8>().map(|b| self.push_bytes(b)),
            b']' => self.push(Object::List(Vec::new())),
            b'}' => self.push(Object::Dict(Vec::new())),
            b')' => self.push(Object::Tuple(Vec::new())),
            0x85 => return self.pops::<1>().map(|v| self.push(Object::Tuple(v.to_vec()))),
            0x86 => return self.pops::<2>().map(|v| self.push(Object::Tuple(v.to_vec()))),
            0x87 => return self.pops::<3>().map(|v| self.push(Object::Tuple(v.to_vec()))),
            b't' => {
                let items = self.pop_mark()?;
                self.spend(items.len())?;
                self.push(Object::Tuple(items));
            }
            b'a' => return self.pop().and_then(|item| self.append(vec![item])),
            b'e' => return self.pop_mark().and_then(|items| self.append(items)),
            b's' => return self.pops::<2>().and_then(|pair| self.set_items(&pair)),
            b'u' => return self.pop_mark().and_then(|items| self.set_items(&items)),
            0x94 => return self.put(self.memo.len()),
            b'q' => {
                let [index] = self.array()?;
                return self.put(usize::from(index));
            }
            b'h' => {
                let [index] = self.array()?;
                return self.get(usize::from(index));
            }
            b'r' => {
                let index = u32::from_le_bytes(self.array()?);
                return self.put(index as usize);
            }
            b'j' => {
                let index = u32::from_le_bytes(self.array()?);
                return self.get(index as usize);
            }
            b'c' => {
                let (module, name) = (self.line()?, self.line()?);
                return self.global(module, name);
            }
            0x93 => {
                let [module, name] = self.pops()?;
                let (module, name) = (self.as_text(module)?, self.as_text(name)?);
                return self.global(module, name);
            }
            b'R' => return self.reduce(),
            b'b' => return self.set_state(),
            opcode => return Err(PickleError::Opcode { at: self.op, opcode }),
        }
        Ok(())
    }

    fn append(&mut self, items: Vec<Item>) -> Done {
        self.spend(items.len())?;
        match self.top()? {
            Item::Object(list) => match &mut self.objects[list] {
                Object::List(l) => l.extend(items),
                _ => return Err(self.bad("items for something that is no list")),
            },
            _ => return Err(self.bad("items for something that is no list")),
        }
        Ok(())
    }

    fn set_items(&mut self, items: &[Item]) -> Done {
        let (pairs, []) = items.as_chunks::<2>() else {
            return Err(self.bad("a key without a value"));
        };
        self.spend(items.len())?;
        match self.top()? {
            Item::Object(dict) => match &mut self.objects[dict] {
                Object::Dict(d) => d.extend(pairs.iter().map(|&[k, v]| (k, v))),
                _ => return Err(self.bad("entries for something that is no dictionary")),
            },
            _ => return Err(self.bad("entries for something that is no dictionary")),
        }
        Ok(())
    }

    pub(super) fn spend(&mut self, numbers: usize) -> Done {
        let (what, limit) = ("numbers", MAX_NUMBERS);
        let left = self.budget.checked_sub(numbers);
        self.budget = left.ok_or(PickleError::Limit { what, limit })?;
        Ok(())
    }
}

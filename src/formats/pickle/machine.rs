//! Executes the opcodes of protocols 2 to 5 that logs need.

use super::objects::{PickleObject, StackItem};
use super::stack::{OpcodeResult, PickleMachine};
use super::{PickleError, Value};
use crate::limits::Limits;

/// Reads a pickle of protocol 2 to 5.
///
/// # Errors
/// Anything that logs do not need, anything damaged, anything larger than the default [`Limits`]. Input is never
/// trusted: nothing is looked up or called, and errors name the byte.
pub fn from_bytes(bytes: &[u8]) -> Result<Value, PickleError> {
    from_bytes_with(bytes, &Limits::DEFAULT)
}

/// Reads a pickle as [`from_bytes`] does, within the given limits.
///
/// # Errors
/// As [`from_bytes`].
pub fn from_bytes_with(bytes: &[u8], limits: &Limits) -> Result<Value, PickleError> {
    if bytes.len() > limits.pickle_bytes {
        let (what, limit) = ("bytes", limits.pickle_bytes);
        return Err(PickleError::Limit { what, limit });
    }
    PickleMachine::new(bytes, limits).run()
}

impl PickleMachine<'_> {
    fn run(mut self) -> Result<Value, PickleError> {
        loop {
            if let Some(root) = self.advance()? {
                return self.unfold(root);
            }
        }
    }

    /// Executes the next opcode; the last one returns the value that is left.
    #[inline]
    pub(super) fn advance(&mut self) -> Result<Option<StackItem>, PickleError> {
        self.op = self.at;
        if self.at == 0 && self.bytes.first().is_some_and(|b| *b != 0x80) {
            return Err(self.bad("it does not start with a protocol number from 2 on"));
        }
        let [opcode] = self.array()?;
        if opcode == b'.' {
            let root = self.pop()?;
            return if self.stack.is_empty() && self.marks.is_empty() {
                Ok(Some(root))
            } else {
                Err(self.bad("it ends with more than one value"))
            };
        }
        self.step(opcode)?;
        if self.objects.len().max(self.stack.len()).max(self.memo_length) > self.limits.pickle_objects {
            let (what, limit) = ("values", self.limits.pickle_objects);
            Err(PickleError::Limit { what, limit })
        } else {
            Ok(None)
        }
    }

    #[inline]
    fn step(&mut self, opcode: u8) -> OpcodeResult {
        match opcode {
            0x80 => match self.array()? {
                [2..=5] => Ok(()),
                _ => Err(self.bad("a protocol other than 2 to 5")),
            },
            0x95 => self.take(8).map(drop), // length of a frame: only for buffering
            b'c' => {
                let (module, name) = (self.line()?, self.line()?);
                self.global(module, name)
            }
            0x93 => {
                let [module, name] = self.pops()?;
                let (module, name) = (self.as_text(module)?, self.as_text(name)?);
                self.global(module, name)
            }
            b'R' => self.reduce(),
            b'b' => self.set_state(),
            b'N' | 0x88 | 0x89 | b'J' | b'K' | b'M' | 0x8a | b'G' => self.scalar(opcode),
            0x8c | b'X' | 0x8d | b'C' | b'B' | 0x8e | 0x96 => self.bytes(opcode),
            0x94 | b'q' | b'h' | b'r' | b'j' => self.recall(opcode),
            _ => self.collection(opcode),
        }
    }

    /// Pushes a byte as an integer, and up to 63 more that follow, because logs consist mostly of lists of small numbers.
    #[inline]
    fn small(&mut self) -> OpcodeResult {
        let [number] = self.array()?;
        self.stack.push(StackItem::Int(i64::from(number)));
        let (more, _) = self.bytes.get(self.at..).unwrap_or_default().as_chunks::<2>();
        for &[opcode, number] in more.iter().take(63) {
            if opcode != b'K' {
                break;
            }
            self.stack.push(StackItem::Int(i64::from(number)));
            self.at += 2;
        }
        Ok(())
    }

    /// Pushes a scalar: None, a boolean, an integer or a float.
    #[inline]
    fn scalar(&mut self, opcode: u8) -> OpcodeResult {
        let item = match opcode {
            b'K' => return self.small(),
            b'N' => StackItem::None,
            0x88 | 0x89 => StackItem::Bool(opcode == 0x88),
            b'J' => StackItem::Int(i64::from(i32::from_le_bytes(self.array()?))),
            b'M' => StackItem::Int(i64::from(u16::from_le_bytes(self.array()?))),
            b'G' => StackItem::Float(f64::from_be_bytes(self.array()?)),
            _ => {
                let digits = self.sized::<1>()?;
                let negative = digits.last().is_some_and(|b| b & 0x80 != 0);
                // two's complement of any length: the sign fills the bytes that are not written
                let mut all = [if negative { 0xff } else { 0 }; 8];
                match all.get_mut(..digits.len()) {
                    Some(low) => low.copy_from_slice(digits),
                    None => return Err(self.bad("an integer of more than 64 bits")),
                }
                StackItem::Int(i64::from_le_bytes(all))
            }
        };
        self.stack.push(item);
        Ok(())
    }

    /// Pushes text or bytes.
    fn bytes(&mut self, opcode: u8) -> OpcodeResult {
        let bytes = match opcode {
            0x8c | b'C' => self.sized::<1>()?,
            b'X' | b'B' => self.sized::<4>()?,
            _ => self.sized::<8>()?,
        };
        match opcode {
            0x8c | b'X' | 0x8d => self.push_text(bytes)?,
            _ => self.push_bytes(bytes),
        }
        Ok(())
    }

    /// Writes to the memo, or pushes what it remembers.
    #[inline]
    fn recall(&mut self, opcode: u8) -> OpcodeResult {
        let index = match opcode {
            0x94 => self.memo_length,
            b'q' | b'h' => usize::from(u8::from_le_bytes(self.array()?)),
            _ => u32::from_le_bytes(self.array()?) as usize,
        };
        match opcode {
            b'h' | b'j' => self.get(index),
            _ => self.put(index),
        }
    }

    /// Makes or fills a list, a tuple or a dictionary.
    #[inline]
    fn collection(&mut self, opcode: u8) -> OpcodeResult {
        match opcode {
            b'(' => self.marks.push(self.stack.len()),
            b']' => self.push(PickleObject::List(Vec::new())),
            b'}' => self.push(PickleObject::Dict(Vec::new())),
            b')' => self.push(PickleObject::Tuple(Vec::new())),
            0x85 => return self.pops::<1>().map(|v| self.push(PickleObject::Tuple(v.to_vec()))),
            0x86 => return self.pops::<2>().map(|v| self.push(PickleObject::Tuple(v.to_vec()))),
            0x87 => return self.pops::<3>().map(|v| self.push(PickleObject::Tuple(v.to_vec()))),
            b't' => {
                let items = self.pop_mark()?;
                self.spend(items.len())?;
                self.push(PickleObject::Tuple(items));
            }
            b'a' => return self.pop().and_then(|item| self.append(vec![item])),
            b'e' => return self.append_marked(),
            b's' => return self.pops::<2>().and_then(|pair| self.set_items(&pair)),
            b'u' => return self.set_marked(),
            opcode => return Err(PickleError::Opcode { at: self.op, opcode }),
        }
        Ok(())
    }

    fn append(&mut self, items: Vec<StackItem>) -> OpcodeResult {
        self.spend(items.len())?;
        match self.top()? {
            StackItem::Object(list) => match &mut self.objects[list] {
                PickleObject::List(l) if l.is_empty() => *l = items,
                PickleObject::List(l) => l.extend(items),
                _ => return Err(self.bad("items for something that is not a list")),
            },
            _ => return Err(self.bad("items for something that is not a list")),
        }
        Ok(())
    }

    fn set_items(&mut self, items: &[StackItem]) -> OpcodeResult {
        let (pairs, []) = items.as_chunks::<2>() else {
            return Err(self.bad("a key without a value"));
        };
        self.spend(items.len())?;
        match self.top()? {
            StackItem::Object(dict) => match &mut self.objects[dict] {
                PickleObject::Dict(d) => d.extend(pairs.iter().map(|&[k, v]| (k, v))),
                _ => return Err(self.bad("entries for something that is not a dictionary")),
            },
            _ => return Err(self.bad("entries for something that is not a dictionary")),
        }
        Ok(())
    }
}

//! The stack machine of a pickle: bytes in, values on a stack, objects and a memo.

use std::borrow::Cow;
use std::collections::BTreeMap;

use super::PickleError;
use super::memo::recalled;
use super::numbers::Dtype;
use super::objects::{PickleObject, StackItem};
use crate::limits::Limits;

/// The outcome of an opcode.
pub(super) type OpcodeResult = Result<(), PickleError>;

/// Capacity kept in the free lists: entries, and lists or dictionaries.
const KEPT: [usize; 2] = [64, 4096];

/// Capacity for the items of short lists and the entries of short dictionaries. Logs have many short records.
#[derive(Default)]
struct SpareLists {
    lists: Vec<Vec<StackItem>>,
    dicts: Vec<Vec<(StackItem, StackItem)>>,
}

/// Empties a list and keeps its capacity.
fn keep<T>(spare: &mut Vec<Vec<T>>, mut list: Vec<T>) {
    if (1..=KEPT[0]).contains(&list.capacity()) && spare.len() < KEPT[1] {
        list.clear();
        spare.push(list);
    }
}

/// A pickle being read: the bytes, the stack, the memo and the objects made so far.
pub(super) struct PickleMachine<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    /// Offset of the current opcode.
    pub op: usize,
    pub stack: Vec<StackItem>,
    pub marks: Vec<usize>,
    pub objects: Vec<PickleObject<'a>>,
    pub limits: &'a Limits,
    /// Entries of the memo so far; recalled ones by their place.
    pub memo_length: usize,
    memo: BTreeMap<usize, StackItem>,
    recalled: Vec<bool>,
    /// Objects in the memo, which may be referred to more than once, by their place.
    shared: Vec<bool>,
    /// Places of objects that are no longer used; new objects reuse them.
    free: Vec<usize>,
    /// Memory of lists and dictionaries that are no longer used.
    spare: SpareLists,
    /// Objects that are yet to be released.
    releasing: Vec<usize>,
    /// The remainder of [`Limits::pickle_numbers`].
    budget: usize,
}

impl<'a> PickleMachine<'a> {
    /// Starts at the first byte of a pickle.
    pub fn new(bytes: &'a [u8], limits: &'a Limits) -> Self {
        Self {
            bytes,
            at: 0,
            op: 0,
            stack: Vec::new(),
            marks: Vec::new(),
            objects: Vec::new(),
            limits,
            memo_length: 0,
            memo: BTreeMap::new(),
            recalled: recalled(bytes, limits),
            shared: Vec::new(),
            free: Vec::new(),
            spare: SpareLists::default(),
            releasing: Vec::new(),
            budget: limits.pickle_numbers,
        }
    }

    /// Returns the error of the current opcode.
    pub fn bad(&self, reason: &'static str) -> PickleError {
        PickleError::Malformed { at: self.op, reason }
    }

    /// Returns the next `n` bytes.
    #[inline]
    pub fn take(&mut self, n: usize) -> Result<&'a [u8], PickleError> {
        let piece = self.bytes.get(self.at..).and_then(|rest| rest.get(..n));
        let piece = piece.ok_or(PickleError::Truncated { at: self.bytes.len() })?;
        self.at += n;
        Ok(piece)
    }

    /// Returns the next `N` bytes as an array.
    #[inline]
    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], PickleError> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N)?);
        Ok(out)
    }

    /// Returns the bytes that follow their length, which has `N` bytes.
    pub fn sized<const N: usize>(&mut self) -> Result<&'a [u8], PickleError> {
        let length = self
            .array::<N>()?
            .iter()
            .rev()
            .fold(0_u64, |n, &b| n << 8 | u64::from(b));
        let length = usize::try_from(length).unwrap_or(usize::MAX);
        self.take(length)
    }

    /// Returns the text up to the next line break.
    pub fn line(&mut self) -> Result<&'a str, PickleError> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let end = rest.iter().position(|b| *b == b'\n');
        let line = self.take(end.unwrap_or(rest.len()))?;
        self.take(1)?;
        self.utf8(line)
    }

    /// Returns bytes as text.
    pub fn utf8(&self, bytes: &'a [u8]) -> Result<&'a str, PickleError> {
        std::str::from_utf8(bytes).map_err(|_| self.bad("text that is not UTF-8"))
    }

    /// Pushes a new object.
    #[inline]
    pub fn push(&mut self, object: PickleObject<'a>) {
        // places are used again, so that memory follows the records at hand, not the length of the log
        let place = self.free.pop().unwrap_or(self.objects.len());
        match self.objects.get_mut(place) {
            Some(old) => *old = object,
            None => self.objects.push(object),
        }
        self.stack.push(StackItem::Object(place));
    }

    /// Removes and returns the items so far of the list at the bottom of the stack, if the pickle is a list.
    #[inline]
    pub fn take_records(&mut self) -> Option<Vec<StackItem>> {
        match (&self.stack[..], self.objects.first_mut()) {
            ([StackItem::Object(0)], Some(PickleObject::List(items))) if !items.is_empty() => {
                Some(std::mem::take(items))
            }
            _ => None,
        }
    }

    /// Frees the places of an item that nothing refers to any more, and of its content.
    pub fn release(&mut self, item: StackItem) {
        self.release_later(item);
        // a list of its own instead of recursion, whose depth the input would choose
        while let Some(place) = self.releasing.pop() {
            match std::mem::replace(&mut self.objects[place], PickleObject::List(Vec::new())) {
                PickleObject::List(items) | PickleObject::Tuple(items) => {
                    items.iter().for_each(|&item| self.release_later(item));
                    keep(&mut self.spare.lists, items);
                }
                PickleObject::Dict(pairs) => {
                    for &(key, value) in &pairs {
                        self.release_later(key);
                        self.release_later(value);
                    }
                    keep(&mut self.spare.dicts, pairs);
                }
                _ => {}
            }
            self.free.push(place);
        }
    }

    #[inline]
    fn release_later(&mut self, item: StackItem) {
        if let StackItem::Object(place) = item
            // the memo may still refer to it
            && !self.shared.get(place).copied().unwrap_or(false)
        {
            self.releasing.push(place);
        }
    }

    /// Pushes text.
    pub fn push_text(&mut self, bytes: &'a [u8]) -> OpcodeResult {
        let text = self.utf8(bytes)?;
        self.push(PickleObject::Text(text));
        Ok(())
    }

    /// Pushes bytes.
    pub fn push_bytes(&mut self, bytes: &'a [u8]) {
        self.push(PickleObject::Bytes(Cow::Borrowed(bytes)));
    }

    /// Pops the top value above the last mark.
    pub fn pop(&mut self) -> Result<StackItem, PickleError> {
        if self.stack.len() <= self.marks.last().copied().unwrap_or(0) {
            return Err(self.bad("a value is missing"));
        }
        self.stack.pop().ok_or_else(|| self.bad("a value is missing"))
    }

    /// Pops the top `N` values, the lowest first.
    pub fn pops<const N: usize>(&mut self) -> Result<[StackItem; N], PickleError> {
        let mut out = [StackItem::None; N];
        for slot in out.iter_mut().rev() {
            *slot = self.pop()?;
        }
        Ok(out)
    }

    /// Pops everything above the last mark, and the mark.
    pub fn pop_mark(&mut self) -> Result<Vec<StackItem>, PickleError> {
        let mark = self.marks.pop().ok_or_else(|| self.bad("a mark is missing"))?;
        Ok(self.stack.split_off(mark))
    }

    /// Appends the items above the last mark to the list below it.
    pub fn append_marked(&mut self) -> OpcodeResult {
        let (mark, list) = self.below_mark()?;
        let items = self.stack.len() - mark;
        self.spend(items)?;
        match list.and_then(|place| self.objects.get_mut(place)) {
            Some(PickleObject::List(list)) => {
                if list.capacity() == 0 && items <= KEPT[0] {
                    *list = self.spare.lists.pop().unwrap_or_default();
                }
                list.extend(self.stack.drain(mark..));
                Ok(())
            }
            _ => Err(self.bad("items for something that is not a list")),
        }
    }

    /// Adds the keys and values above the last mark to the dictionary below it.
    pub fn set_marked(&mut self) -> OpcodeResult {
        let (mark, dict) = self.below_mark()?;
        let items = self.stack.len() - mark;
        if !items.is_multiple_of(2) {
            return Err(self.bad("a key without a value"));
        }
        self.spend(items)?;
        match dict.and_then(|place| self.objects.get_mut(place)) {
            Some(PickleObject::Dict(dict)) => {
                if dict.capacity() == 0 && items <= KEPT[0] {
                    *dict = self.spare.dicts.pop().unwrap_or_default();
                }
                let (pairs, _) = self.stack[mark..].as_chunks::<2>();
                dict.extend(pairs.iter().map(|&[key, value]| (key, value)));
                self.stack.truncate(mark);
                Ok(())
            }
            _ => Err(self.bad("entries for something that is not a dictionary")),
        }
    }

    /// Pops the last mark. Returns its place, and the place of the object below it, if it is one.
    fn below_mark(&mut self) -> Result<(usize, Option<usize>), PickleError> {
        let mark = self.marks.pop().ok_or_else(|| self.bad("a mark is missing"))?;
        // as if everything above the mark had been popped
        if mark <= self.marks.last().copied().unwrap_or(0) {
            return Err(self.bad("a value is missing"));
        }
        let below = match self.stack.get(mark - 1) {
            Some(StackItem::Object(place)) => Some(*place),
            _ => None,
        };
        Ok((mark, below))
    }

    /// Returns the top value without removing it.
    pub fn top(&mut self) -> Result<StackItem, PickleError> {
        let item = self.pop()?;
        self.stack.push(item);
        Ok(item)
    }

    /// Remembers the top value in the memo.
    #[inline]
    pub fn put(&mut self, index: usize) -> OpcodeResult {
        let item = self.top()?;
        // Python numbers them in turn; a far index would ask for memory that the file does not pay for
        if index > self.memo_length {
            return Err(self.bad("the memo has a hole"));
        }
        self.memo_length = self.memo_length.max(index + 1);
        // Python writes nearly every value to the memo and recalls few of them: the others need not be kept
        if self.recalled.get(index).copied().unwrap_or(false) {
            self.memo.insert(index, item);
            if let StackItem::Object(place) = item {
                self.shared.resize(self.shared.len().max(place + 1), false);
                self.shared[place] = true;
            }
        }
        Ok(())
    }

    /// Pushes a value of the memo.
    #[inline]
    pub fn get(&mut self, index: usize) -> OpcodeResult {
        let item = self.memo.get(&index).copied();
        self.stack
            .push(item.ok_or_else(|| self.bad("the memo has no such entry"))?);
        Ok(())
    }

    /// Deducts numbers from the budget.
    #[inline]
    pub fn spend(&mut self, numbers: usize) -> OpcodeResult {
        let (what, limit) = ("numbers", self.limits.pickle_numbers);
        let left = self.budget.checked_sub(numbers);
        self.budget = left.ok_or(PickleError::Limit { what, limit })?;
        Ok(())
    }

    /// Returns an item that must be text.
    pub fn as_text(&self, item: StackItem) -> Result<&'a str, PickleError> {
        match item {
            StackItem::Object(o) => match &self.objects[o] {
                PickleObject::Text(t) => Ok(t),
                _ => Err(self.bad("something other than text where text belongs")),
            },
            _ => Err(self.bad("something other than text where text belongs")),
        }
    }

    /// Returns an item that must be bytes.
    pub fn as_bytes(&self, item: StackItem) -> Result<&[u8], PickleError> {
        match item {
            StackItem::Object(o) => match &self.objects[o] {
                PickleObject::Bytes(b) => Ok(b),
                _ => Err(self.bad("something other than bytes where bytes belong")),
            },
            _ => Err(self.bad("something other than bytes where bytes belong")),
        }
    }

    /// Returns an item that must be a tuple.
    pub fn as_tuple(&self, item: StackItem) -> Result<&[StackItem], PickleError> {
        match item {
            StackItem::Object(o) => match &self.objects[o] {
                PickleObject::Tuple(t) => Ok(t),
                _ => Err(self.bad("something other than a tuple where a tuple belongs")),
            },
            _ => Err(self.bad("something other than a tuple where a tuple belongs")),
        }
    }

    /// Returns an item that must be a type of numbers.
    pub fn as_dtype(&self, item: StackItem) -> Result<Dtype, PickleError> {
        match item {
            StackItem::Object(o) => match &self.objects[o] {
                PickleObject::Dtype(d) => Ok(*d),
                _ => Err(self.bad("something other than a type of numbers where one belongs")),
            },
            _ => Err(self.bad("something other than a type of numbers where one belongs")),
        }
    }

    /// Returns an item that must be the shape of an array.
    pub fn as_shape(&self, item: StackItem) -> Result<Vec<usize>, PickleError> {
        let one = |item: &StackItem| match *item {
            StackItem::Int(i) => usize::try_from(i).ok(),
            _ => None,
        };
        let shape = match item {
            StackItem::Int(_) => one(&item).map(|n| vec![n]),
            _ => match self.as_tuple(item)? {
                dims if dims.len() > self.limits.pickle_dimensions => None,
                dims => dims.iter().map(one).collect(),
            },
        };
        shape.ok_or_else(|| self.bad("an invalid shape"))
    }
}

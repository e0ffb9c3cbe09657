//! Long lists of records, one at a time: a record leaves memory once it has been handed out.

use super::PickleError;
use super::objects::{PickleObject, StackItem};
use super::stack::PickleMachine;
use crate::limits::Limits;

/// The kind of a pickle, without the records that were handed out.
pub(crate) enum PickleKind {
    /// A list of records.
    List,
    /// A dictionary with these text keys.
    Dict(Vec<String>),
    /// Anything else.
    Other,
}

/// A value within a record.
#[derive(Clone, Copy)]
pub(crate) struct RecordNode<'m, 'a> {
    machine: &'m PickleMachine<'a>,
    item: StackItem,
}

impl<'m, 'a> RecordNode<'m, 'a> {
    pub(super) fn new(machine: &'m PickleMachine<'a>, item: StackItem) -> Self {
        Self { machine, item }
    }

    fn object(self) -> Option<&'m PickleObject<'a>> {
        match self.item {
            StackItem::Object(o) => self.machine.objects.get(o),
            _ => None,
        }
    }

    /// Returns whether this is a dictionary.
    pub fn is_dict(self) -> bool {
        matches!(self.object(), Some(PickleObject::Dict(_)))
    }

    /// Returns the value of a key of a dictionary.
    pub fn get(self, key: &str) -> Option<Self> {
        let Some(PickleObject::Dict(pairs)) = self.object() else {
            return None;
        };
        let named = |item: StackItem| matches!(RecordNode { item, ..self }.object(), Some(PickleObject::Text(text)) if *text == key);
        let (_, item) = pairs.iter().rev().find(|(k, _)| named(*k))?;
        Some(Self { item: *item, ..self })
    }

    /// Returns the items of a list.
    pub fn items(self) -> Option<impl ExactSizeIterator<Item = Self>> {
        match self.object() {
            Some(PickleObject::List(items) | PickleObject::Tuple(items)) => {
                Some(items.iter().map(move |&item| Self { item, ..self }))
            }
            _ => None,
        }
    }

    /// Returns a number; 0 or 1 for false and true.
    pub fn number(self) -> Option<f64> {
        match self.item {
            StackItem::Bool(on) => Some(f64::from(u8::from(on))),
            StackItem::Int(number) => Some(number as f64),
            StackItem::Float(number) => Some(number),
            _ => None,
        }
    }

    /// Returns a text.
    pub fn text(self) -> Option<&'m str> {
        match self.object() {
            Some(PickleObject::Text(text)) => Some(text),
            _ => None,
        }
    }

    /// Returns a whole number that is not negative.
    pub fn count(self) -> Option<u64> {
        match self.item {
            StackItem::Int(i) => u64::try_from(i).ok(),
            _ => None,
        }
    }
}

/// Reads the records of a list, which `visit` gets one at a time; it may refuse the rest.
///
/// # Errors
/// As [`super::from_bytes`]; errors of `visit`.
pub(crate) fn visit_records<E: From<PickleError>>(
    bytes: &[u8],
    limits: &Limits,
    mut visit: impl FnMut(RecordNode) -> Result<(), E>,
) -> Result<PickleKind, E> {
    let mut machine = PickleMachine::new(bytes, limits);
    let mut root = None;
    while root.is_none() {
        root = machine.advance()?;
        if let Some(items) = machine.take_records() {
            for item in items {
                visit(RecordNode::new(&machine, item))?;
                machine.release(item);
            }
        }
    }
    let root = root.unwrap_or(StackItem::None);
    Ok(match (root, RecordNode::new(&machine, root).object()) {
        (StackItem::Object(0), Some(PickleObject::List(_))) => PickleKind::List,
        (_, Some(PickleObject::Dict(pairs))) => {
            let text = |item: &StackItem| match RecordNode::new(&machine, *item).object() {
                Some(PickleObject::Text(text)) => Some((*text).to_string()),
                _ => None,
            };
            PickleKind::Dict(pairs.iter().filter_map(|(key, _)| text(key)).collect())
        }
        _ => PickleKind::Other,
    })
}

//! Converts objects of the stack machine to values.

use std::sync::Arc;

use super::objects::{PickleObject, StackItem};
use super::stack::PickleMachine;
use super::{PickleError, Value};

/// The progress of building a value; the number is how deeply it is nested.
enum BuildProgress {
    Not,
    Now,
    Value(Value, usize),
}

impl PickleMachine<'_> {
    /// Converts an item to a value.
    pub(super) fn unfold(&self, root: StackItem) -> Result<Value, PickleError> {
        let mut built: Vec<BuildProgress> = Vec::new();
        built.resize_with(self.objects.len(), || BuildProgress::Not);
        self.build_value(root, &mut built, 0)
    }

    /// Converts an item to a value. Each object is built once and shared from then on.
    fn build_value(&self, item: StackItem, built: &mut [BuildProgress], depth: usize) -> Result<Value, PickleError> {
        let object = match item {
            StackItem::None => return Ok(Value::None),
            StackItem::Bool(b) => return Ok(Value::Bool(b)),
            StackItem::Int(i) => return Ok(Value::Int(i)),
            StackItem::Float(f) => return Ok(Value::Float(f)),
            StackItem::Object(object) => object,
        };
        let height = match &built[object] {
            BuildProgress::Not => 0,
            BuildProgress::Now => return Err(self.bad("a value that contains itself")),
            BuildProgress::Value(_, height) => *height,
        };
        // sharing must not make deep what looks flat
        if depth + height > self.limits.pickle_depth {
            let (what, limit) = ("levels of nesting", self.limits.pickle_depth);
            return Err(PickleError::Limit { what, limit });
        }
        if let BuildProgress::Value(value, _) = &built[object] {
            return Ok(value.clone());
        }
        built[object] = BuildProgress::Now;
        let mut children = Vec::new();
        let value = match &self.objects[object] {
            PickleObject::Text(text) => Value::Text((*text).into()),
            PickleObject::List(items) | PickleObject::Tuple(items) => {
                children.extend(items);
                let items = items.iter().map(|&i| self.build_value(i, built, depth + 1));
                Value::List(Arc::new(items.collect::<Result<_, _>>()?))
            }
            PickleObject::Dict(items) => {
                let mut out: Vec<(Arc<str>, Value)> = Vec::with_capacity(items.len());
                for &(key, item) in items {
                    let Value::Text(key) = self.build_value(key, built, depth + 1)? else {
                        return Err(self.bad("a key that is not text"));
                    };
                    children.push(item);
                    out.push((key, self.build_value(item, built, depth + 1)?));
                }
                Value::Dict(Arc::new(out))
            }
            PickleObject::Array(Some(array)) => Value::Array(array.clone()),
            PickleObject::Array(None) => return Err(self.bad("an array without numbers")),
            _ => return Err(self.bad("a kind of value that does not occur in logs")),
        };
        let heights = children.iter().map(|child| match child {
            StackItem::Object(o) => match &built[*o] {
                BuildProgress::Value(_, height) => 1 + height,
                _ => 1,
            },
            _ => 1,
        });
        built[object] = BuildProgress::Value(value.clone(), heights.max().unwrap_or(0));
        Ok(value)
    }
}

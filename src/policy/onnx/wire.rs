//! The bytes of a model: the parts of protobuf that the runtime reads (`onnx.proto`).
//!
//! The runtime believes lengths, waits for ever for the end of a number that is too long, and reads messages in messages by
//! recursion. So a model is looked through before the runtime gets it.

/// Levels of messages in messages; each graph in an operator takes three.
const DEPTH: usize = 64;

/// A field of a message: its number, or its bytes.
pub(super) enum WireField<'a> {
    Number(u64),
    Bytes(&'a [u8]),
}

/// The types of messages that the runtime reads.
#[derive(Clone, Copy)]
enum MessageType {
    Model,
    Graph,
    Node,
    Attribute,
    Tensor,
    Value,
    Type,
    TensorType,
    Sequence,
    Shape,
    /// Without messages inside.
    Plain,
}

/// The content of a field's bytes.
enum FieldContent {
    Message(MessageType),
    /// Numbers of variable length, one after the other.
    Numbers,
    /// Text, or bytes that the runtime does not parse.
    Other,
}

impl MessageType {
    /// Returns the content of a field's bytes.
    fn content(self, field: u64) -> FieldContent {
        FieldContent::Message(match (self, field) {
            (Self::Model, 7) | (Self::Attribute, 6) => Self::Graph,
            (Self::Graph, 1) => Self::Node,
            (Self::Node, 5) => Self::Attribute,
            (Self::Graph, 5) | (Self::Attribute, 5) => Self::Tensor,
            (Self::Graph, 11..=13) => Self::Value,
            (Self::Value, 2) | (Self::Sequence, 1) => Self::Type,
            (Self::Type, 1) => Self::TensorType,
            (Self::Type, 4) => Self::Sequence,
            (Self::TensorType, 2) => Self::Shape,
            (Self::Model, 8 | 14) | (Self::Tensor, 13) | (Self::Shape, 1) => Self::Plain,
            (Self::Attribute, 8) | (Self::Tensor, 1 | 5 | 7) => return FieldContent::Numbers,
            _ => return FieldContent::Other,
        })
    }
}

/// Reads a number of variable length.
pub(super) fn varint(bytes: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

/// Lists the fields of a message, unless it is malformed.
pub(super) fn fields(mut bytes: &[u8]) -> Option<Vec<(u64, WireField<'_>)>> {
    let mut out = Vec::new();
    while !bytes.is_empty() {
        let key = varint(&mut bytes)?;
        let length = match key & 7 {
            0 => {
                out.push((key >> 3, WireField::Number(varint(&mut bytes)?)));
                continue;
            }
            1 => 8,
            2 => usize::try_from(varint(&mut bytes)?).ok()?,
            5 => 4,
            _ => return None,
        };
        let (data, rest) = bytes.split_at_checked(length)?;
        out.push((key >> 3, WireField::Bytes(data)));
        bytes = rest;
    }
    Some(out)
}

/// Checks the bytes of a model; the error describes the fault.
pub(super) fn check(model: &[u8]) -> Result<(), String> {
    walk(model, MessageType::Model, DEPTH)
}

fn walk(bytes: &[u8], message: MessageType, depth: usize) -> Result<(), String> {
    let malformed = || "it is damaged, or no ONNX model: its bytes are not protobuf".to_string();
    let Some(depth) = depth.checked_sub(1) else {
        return Err(format!("it has more than {DEPTH} levels of nested messages"));
    };
    for (number, field) in fields(bytes).ok_or_else(malformed)? {
        let WireField::Bytes(data) = field else { continue };
        match message.content(number) {
            FieldContent::Message(inside) => walk(data, inside, depth)?,
            FieldContent::Numbers => {
                let mut rest = data;
                while !rest.is_empty() {
                    varint(&mut rest).ok_or_else(malformed)?;
                }
            }
            FieldContent::Other => {}
        }
    }
    Ok(())
}

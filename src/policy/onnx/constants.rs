//! Constants in a model: tensors and attributes of operators (`onnx.proto`: `TensorProto`, `AttributeProto`).

use super::wire::{self, WireField, varint};

/// Longest list of sizes.
pub(super) const LIST: usize = 64;

/// A short list of numbers of a model.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ShortTensor {
    pub(super) values: Vec<f64>,
    /// Whether their type is a whole number.
    pub(super) whole: bool,
}

/// Lists the fields of a message that was checked.
pub(super) fn fields(bytes: &[u8]) -> Vec<(u64, WireField<'_>)> {
    wire::fields(bytes).unwrap_or_default()
}

/// Lists the messages, texts or bytes in a field.
pub(super) fn parts(bytes: &[u8], number: u64) -> Vec<&[u8]> {
    let one = |(n, field)| match field {
        WireField::Bytes(data) if n == number => Some(data),
        _ => None,
    };
    fields(bytes).into_iter().filter_map(one).collect()
}

/// Appends whole numbers of variable length: one, or those packed in bytes.
fn whole(field: WireField<'_>, out: &mut Vec<f64>) {
    match field {
        WireField::Number(value) => out.push(value as i64 as f64),
        WireField::Bytes(mut packed) => {
            while let Some(value) = varint(&mut packed) {
                out.push(value as i64 as f64);
            }
        }
    }
}

/// Appends numbers of four bytes each.
fn floats(bytes: &[u8], out: &mut Vec<f64>) {
    out.extend(
        bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|b| f64::from(f32::from_le_bytes(*b))),
    );
}

/// Appends numbers of eight bytes each.
fn doubles(bytes: &[u8], out: &mut Vec<f64>) {
    out.extend(bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)));
}

/// Returns the numbers of a tensor, if it holds a short list of `float`, `double`, `int32` or `int64`.
pub(super) fn of_tensor(tensor: &[u8]) -> Option<ShortTensor> {
    let (mut values, mut raw, mut kind) = (Vec::new(), &[][..], 0);
    for (number, field) in fields(tensor) {
        match (number, field) {
            (2, WireField::Number(found)) => kind = found,
            (4, WireField::Bytes(data)) => floats(data, &mut values),
            (5 | 7, field) => whole(field, &mut values),
            (9, WireField::Bytes(data)) => raw = data,
            (10, WireField::Bytes(data)) => doubles(data, &mut values),
            _ => {}
        }
    }
    match kind {
        1 => floats(raw, &mut values),
        6 => values.extend(raw.as_chunks::<4>().0.iter().map(|b| f64::from(i32::from_le_bytes(*b)))),
        7 => values.extend(raw.as_chunks::<8>().0.iter().map(|b| i64::from_le_bytes(*b) as f64)),
        11 => doubles(raw, &mut values),
        _ => return None,
    }
    let whole = kind == 6 || kind == 7;
    (values.len() <= LIST).then_some(ShortTensor { values, whole })
}

/// Returns the name of an attribute of an operator.
pub(super) fn name(attribute: &[u8]) -> &str {
    let name = parts(attribute, 1).first().copied().unwrap_or_default();
    std::str::from_utf8(name).unwrap_or_default()
}

/// Returns the numbers of an attribute that are not in a tensor.
pub(super) fn of_attribute(attribute: &[u8]) -> ShortTensor {
    let (mut values, mut is_whole) = (Vec::new(), true);
    for (number, field) in fields(attribute) {
        match (number, field) {
            (2 | 7, WireField::Bytes(data)) => {
                is_whole = false;
                floats(data, &mut values);
            }
            (3 | 8, field) => whole(field, &mut values),
            _ => {}
        }
    }
    let whole = is_whole;
    ShortTensor { values, whole }
}

/// Returns the output of an operator without inputs, if it is a short list of numbers: the value of a `Constant`.
pub(super) fn of_constant(node: &[u8]) -> Option<ShortTensor> {
    if parts(node, 4).first().copied() != Some(b"Constant") {
        return None;
    }
    let value = |attribute: &[u8]| match name(attribute) {
        "value" => parts(attribute, 5).first().copied().and_then(of_tensor),
        "value_int" | "value_ints" | "value_float" | "value_floats" => Some(of_attribute(attribute)),
        _ => None,
    };
    let found = parts(node, 5).into_iter().find_map(value);
    found.filter(|numbers| numbers.values.len() <= LIST)
}

//! How much a model would make: sizes that stand in it are bounded before it is loaded.
//!
//! The runtime allocates what a model asks for, and a failure to allocate ends the process. The file is protobuf; what is
//! read here are the constants of the main graph (`onnx.proto`: `ModelProto.graph`, `GraphProto.initializer`,
//! `NodeProto`, `TensorProto`). Sizes that the model computes are not seen.

use std::collections::BTreeMap;

use super::wire::{self, Field, varint};

/// Greatest number of values that one operator may make.
const MOST: u128 = 1 << 26;
/// Longest list of sizes.
const LIST: usize = 64;

/// Lists the fields of a message that was looked through.
fn fields(bytes: &[u8]) -> Vec<(u64, Field<'_>)> {
    wire::fields(bytes).unwrap_or_default()
}

/// Lists the messages, texts or bytes in a field.
fn parts(bytes: &[u8], number: u64) -> Vec<&[u8]> {
    let one = |(n, field)| match field {
        Field::Bytes(data) if n == number => Some(data),
        _ => None,
    };
    fields(bytes).into_iter().filter_map(one).collect()
}

/// Returns the 64-bit integers of a tensor, if it holds a short list of them.
fn integers(tensor: &[u8]) -> Option<Vec<i64>> {
    let mut values = Vec::new();
    let mut is_int = false;
    for (number, field) in fields(tensor) {
        match (number, field) {
            (2, Field::Number(kind)) => is_int = kind == 7,
            (7, Field::Number(value)) => values.push(value as i64),
            (7, Field::Bytes(mut packed)) => {
                while let Some(value) = varint(&mut packed) {
                    values.push(value as i64);
                }
            }
            (9, Field::Bytes(raw)) => values.extend(raw.as_chunks::<8>().0.iter().map(|b| i64::from_le_bytes(*b))),
            _ => {}
        }
    }
    (is_int && values.len() <= LIST).then_some(values)
}

/// Returns the place of the input that says how much an operator makes.
fn size_input(operator: &[u8]) -> Option<usize> {
    match operator {
        b"ConstantOfShape" => Some(0),
        b"Expand" | b"Tile" | b"Pad" | b"Range" | b"OneHot" => Some(1),
        b"Resize" => Some(3),
        _ => None,
    }
}

/// Checks the bytes of a model and the sizes in it; the error says which operator makes too much.
pub(super) fn check(model: &[u8]) -> Result<(), String> {
    wire::check(model)?;
    for graph in parts(model, 7) {
        let nodes = parts(graph, 1);
        let mut constants: BTreeMap<&[u8], Vec<i64>> = BTreeMap::new();
        for tensor in parts(graph, 5) {
            if let (Some(&name), Some(values)) = (parts(tensor, 8).first(), integers(tensor)) {
                constants.insert(name, values);
            }
        }
        for node in &nodes {
            let value = parts(node, 5)
                .into_iter()
                .flat_map(|attribute| parts(attribute, 5))
                .find_map(integers);
            if let (Some(&output), Some(values)) = (parts(node, 2).first(), value) {
                constants.insert(output, values);
            }
        }
        for node in &nodes {
            let operator = parts(node, 4).first().copied().unwrap_or_default();
            let input = size_input(operator).and_then(|k| parts(node, 1).get(k).copied());
            let Some(sizes) = input.and_then(|name| constants.get(name)) else {
                continue;
            };
            let product = sizes
                .iter()
                .fold(1, |n: u128, s| n.saturating_mul(u128::from(s.unsigned_abs().max(1))));
            if product > MOST {
                let operator = String::from_utf8_lossy(operator);
                return Err(format!(
                    "the operator {operator} would make values of the sizes {sizes:?}, more than {MOST}"
                ));
            }
        }
    }
    Ok(())
}

//! How much a model would make: sizes that stand in it are bounded before it is loaded.
//!
//! The runtime allocates what a model asks for, and a failure to allocate ends the process. The file is protobuf; what is
//! read here are the constants and attributes of its graphs (`onnx.proto`: `ModelProto.graph`, `GraphProto.initializer`,
//! `NodeProto`, `TensorProto`). Sizes that the model computes are not seen.

use std::collections::BTreeMap;

use super::wire::{self, Field, varint};

/// Greatest number of values that one operator may make.
const MOST: u128 = 1 << 26;
/// Greatest factor by which convolution or pooling may enlarge an image.
const MOST_LARGER: u128 = 1 << 16;
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

/// Returns the name of an attribute and its list of integers, if that is one of those with which an image grows; and how much
/// larger it could become.
fn growth(attribute: &[u8]) -> Option<(&str, Vec<i64>, u128)> {
    let name = std::str::from_utf8(parts(attribute, 1).first()?).ok()?;
    if !["pads", "strides", "output_padding", "output_shape"].contains(&name) {
        return None;
    }
    let mut values = Vec::new();
    for (number, field) in fields(attribute) {
        match (number, field) {
            (8, Field::Number(value)) => values.push(value as i64),
            (8, Field::Bytes(mut packed)) => {
                while let Some(value) = varint(&mut packed) {
                    values.push(value as i64);
                }
            }
            _ => {}
        }
    }
    let size = |value: &i64| u128::from(value.unsigned_abs());
    let by = match name {
        // of each axis: those before, then those behind
        "pads" => {
            let (before, behind) = values.split_at(values.len() / 2);
            let both = before.iter().zip(behind).map(|(a, b)| 1 + size(a) + size(b));
            both.fold(1, u128::saturating_mul)
        }
        _ => values
            .iter()
            .map(|value| size(value).max(1))
            .fold(1, u128::saturating_mul),
    };
    Some((name, values, by))
}

/// Checks the attributes of an operator.
fn check_attributes(node: &[u8]) -> Result<(), String> {
    let grown = parts(node, 5).into_iter().filter_map(growth);
    for (name, values, by) in grown {
        if by > MOST_LARGER || values.len() > LIST {
            let operator = String::from_utf8_lossy(parts(node, 4).first().copied().unwrap_or_default()).into_owned();
            let values = &values[..values.len().min(LIST)];
            return Err(format!(
                "the operator {operator} has {name} of {values:?}, with which images could be more than {MOST_LARGER} times as large"
            ));
        }
    }
    Ok(())
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

/// Constants by name: of a graph, after those of the graphs around it.
type Constants<'m> = Vec<BTreeMap<&'m [u8], Vec<i64>>>;

/// Checks the bytes of a model and the sizes in it; the error says which operator makes too much.
pub(super) fn check(model: &[u8]) -> Result<(), String> {
    wire::check(model)?;
    let mut constants = Vec::new();
    parts(model, 7)
        .into_iter()
        .try_for_each(|graph| check_graph(graph, &mut constants))
}

/// Checks a graph, and those in its operators; how deep they are was checked before.
fn check_graph<'m>(graph: &'m [u8], constants: &mut Constants<'m>) -> Result<(), String> {
    let nodes = parts(graph, 1);
    let mut own = BTreeMap::new();
    for tensor in parts(graph, 5) {
        if let (Some(&name), Some(values)) = (parts(tensor, 8).first(), integers(tensor)) {
            own.insert(name, values);
        }
    }
    for node in &nodes {
        let value = parts(node, 5)
            .into_iter()
            .flat_map(|attribute| parts(attribute, 5))
            .find_map(integers);
        if let (Some(&output), Some(values)) = (parts(node, 2).first(), value) {
            own.insert(output, values);
        }
    }
    constants.push(own);
    for node in nodes {
        check_attributes(node)?;
        check_sizes(node, constants)?;
        for inner in parts(node, 5).into_iter().flat_map(|attribute| parts(attribute, 6)) {
            check_graph(inner, constants)?;
        }
    }
    constants.pop();
    Ok(())
}

/// Checks the sizes that an operator is given.
fn check_sizes(node: &[u8], constants: &Constants<'_>) -> Result<(), String> {
    let operator = parts(node, 4).first().copied().unwrap_or_default();
    let input = size_input(operator).and_then(|k| parts(node, 1).get(k).copied());
    let found = |name: &[u8]| constants.iter().rev().find_map(|graph| graph.get(name));
    let Some(sizes) = input.and_then(found) else {
        return Ok(());
    };
    let product = sizes
        .iter()
        .fold(1, |n: u128, s| n.saturating_mul(u128::from(s.unsigned_abs().max(1))));
    if product > MOST {
        Err(format!(
            "the operator {} would make values of the sizes {sizes:?}, more than {MOST}",
            String::from_utf8_lossy(operator)
        ))
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a field with bytes in it, fewer than 128.
    fn field(number: u8, bytes: &[u8]) -> Vec<u8> {
        [&[number << 3 | 2, bytes.len() as u8], bytes].concat()
    }

    #[test]
    fn images_do_not_grow_without_limit() {
        let model = |operator: &str, name: &str, values: &[u64]| {
            let mut list = field(1, name.as_bytes());
            for &value in values {
                list.push(8 << 3);
                let mut rest = value;
                while rest > 0x7f {
                    list.push(rest as u8 | 0x80);
                    rest >>= 7;
                }
                list.push(rest as u8);
            }
            let node = [field(4, operator.as_bytes()), field(5, &list)].concat();
            field(7, &field(1, &node))
        };
        for (values, fits) in [
            (&[1, 1, 1, 1][..], true),
            (&[127, 127, 127, 127], true),
            (&[30_000, 0, 30_000, 0], true),
            (&[30_000, 30_000, 30_000, 30_000], false),
            (&[0, 0, 0, 1 << 40], false),
            (&[u64::MAX; 2], true),
            (&[1 << 63; 4], false),
        ] {
            for operator in ["Conv", "MaxPool", "AveragePool"] {
                assert_eq!(
                    check(&model(operator, "pads", values)).is_ok(),
                    fits,
                    "{operator} {values:?}"
                );
            }
        }
        assert!(check(&model("ConvTranspose", "strides", &[2, 2])).is_ok());
        let refused = check(&model("ConvTranspose", "strides", &[1 << 20, 1 << 20])).expect_err("large strides");
        assert!(
            refused.contains("ConvTranspose has strides of [1048576, 1048576]"),
            "{refused}"
        );
        assert!(check(&model("Conv", "dilations", &[1 << 40])).is_ok());
        // the graph of a branch
        let inner = model("Conv", "pads", &[1 << 40; 4]);
        let [_, _, graph @ ..] = &inner[..] else {
            panic!("a graph")
        };
        let branch = field(7, &field(1, &field(5, &field(6, graph))));
        assert!(check(&branch).is_err_and(|e| e.contains("the operator Conv has pads of")));
    }
}

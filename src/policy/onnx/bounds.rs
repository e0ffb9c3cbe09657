//! Bounds on a model's sizes, checked before it is loaded.
//!
//! The runtime allocates what a model asks for, and a failed allocation ends the process. The file is protobuf. This reads the constants
//! and attributes of its graphs (`onnx.proto`: `ModelProto.graph`, `GraphProto.initializer`, `NodeProto`, `TensorProto`). It does not see
//! sizes that the model computes.

use std::collections::BTreeMap;

use super::constants::{LIST, ShortTensor, name, of_attribute, of_constant, of_tensor, parts};
use super::{runtime, wire};

/// Greatest number of values that one operator may produce.
const MOST: f64 = (1 << 26) as f64;
/// Greatest factor by which one operator may enlarge its input.
const MOST_LARGER: f64 = (1 << 16) as f64;
/// Greatest number of iterations of a loop.
const MOST_TURNS: f64 = (1 << 20) as f64;
/// Greatest nesting depth of graphs. The runtime plans the graph of an operator several times whenever it plans the operator, so time and memory are
/// multiplied with each level: two kilobytes with twelve levels would take gigabytes.
const NESTED: usize = 4;

/// Lists numbers in the form of an error message.
fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().take(LIST).map(f64::to_string).collect();
    format!("[{}]", values.join(", "))
}

/// Returns the name of an operator.
fn operator(node: &[u8]) -> String {
    String::from_utf8_lossy(parts(node, 4).first().copied().unwrap_or_default()).into_owned()
}

/// Multiplies sizes; those below 1, and NaN, do not reduce the product.
fn product(sizes: impl IntoIterator<Item = f64>) -> f64 {
    sizes.into_iter().map(|size| size.abs().max(1.0)).product()
}

/// Checks an attribute of an operator that could enlarge an image, or that is the shape of its output.
fn check_attribute(node: &[u8], attribute: &[u8]) -> Result<(), String> {
    let (name, values) = (name(attribute), of_attribute(attribute).values);
    let by = match name {
        // of each axis: those before, then those behind
        "pads" => {
            let (before, behind) = values.split_at(values.len() / 2);
            product(before.iter().zip(behind).map(|(a, b)| 1.0 + a.abs() + b.abs()))
        }
        "strides" | "output_padding" | "output_shape" => product(values.iter().copied()),
        "shape" => return check_shape(node, &values),
        _ => return Ok(()),
    };
    if by > MOST_LARGER || values.len() > LIST {
        return Err(format!(
            "the operator {} has {name} of {}, with which images could be more than {MOST_LARGER} times as large",
            operator(node),
            list(&values)
        ));
    }
    Ok(())
}

/// Checks the sizes of an operator's output.
fn check_shape(node: &[u8], sizes: &[f64]) -> Result<(), String> {
    if product(sizes.iter().copied()) > MOST {
        return Err(format!(
            "the operator {} would make values of the sizes {}, more than {MOST}",
            operator(node),
            list(sizes)
        ));
    }
    Ok(())
}

/// Checks the factors by which an operator enlarges its input.
fn check_factors(node: &[u8], factors: &[f64]) -> Result<(), String> {
    if product(factors.iter().copied()) > MOST_LARGER {
        return Err(format!(
            "the operator {} would make what it is given {} times as large, more than {MOST_LARGER}",
            operator(node),
            list(factors)
        ));
    }
    Ok(())
}

/// Checks a range of numbers from a start to a limit: their count, and that each step makes progress.
fn check_range([start, limit, step]: [Option<&ShortTensor>; 3]) -> Result<(), String> {
    let Some(limit) = limit else { return Ok(()) };
    let one = |numbers: Option<&ShortTensor>, or| numbers.and_then(|n| n.values.first().copied()).unwrap_or(or);
    let (from, to, by) = (one(start, 0.0), one(Some(limit), 0.0), one(step, 1.0));
    let count = (to - from) / by;
    // whole numbers of 32 bits end, and floats of 32 bits get no further where a step is less than their last bit
    let stays = if limit.whole {
        to.abs() + by.abs() > f64::from(i32::MAX)
    } else {
        from.abs().max(to.abs()) > f64::from(1 << 24) * by.abs() && count > 0.0
    };
    if count > MOST || stays {
        return Err(format!(
            "the operator Range would go from {from} to {to} by {by}: more than {MOST} numbers, or without end"
        ));
    }
    Ok(())
}

/// Constants by name: of a graph, after those of the graphs around it.
type ConstantScopes<'m> = Vec<BTreeMap<&'m [u8], ShortTensor>>;

/// Checks the bytes of a model and the sizes in it, and returns the number of operators in its graph; the error names the operator that produces too
/// much.
pub(super) fn check(model: &[u8]) -> Result<usize, String> {
    wire::check(model)?;
    let mut constants = Vec::new();
    let mut most = 0;
    for graph in parts(model, 7) {
        most = most.max(parts(graph, 1).len());
        check_graph(graph, runtime::MOST, &mut constants)?;
    }
    Ok(most)
}

/// Checks a graph and the graphs in its operators within a limit of operators; their depth was checked before.
fn check_graph<'m>(graph: &'m [u8], most: usize, constants: &mut ConstantScopes<'m>) -> Result<(), String> {
    let nodes = parts(graph, 1);
    // there is an entry for each graph around it
    if constants.len() > NESTED {
        return Err(format!("it nests graphs more than {NESTED} deep"));
    }
    if nodes.len() > most {
        return Err(format!(
            "one of its graphs has {} operators, more than {most}",
            nodes.len()
        ));
    }
    let mut own = BTreeMap::new();
    for tensor in parts(graph, 5) {
        if let (Some(&name), Some(values)) = (parts(tensor, 8).first(), of_tensor(tensor)) {
            own.insert(name, values);
        }
    }
    for node in &nodes {
        let passed = || {
            let name = *parts(node, 1).first()?;
            let found = own
                .get(name)
                .or_else(|| constants.iter().rev().find_map(|graph| graph.get(name)));
            found.filter(|_| passes_on(node)).cloned()
        };
        if let (Some(&output), Some(values)) = (parts(node, 2).first(), of_constant(node).or_else(passed)) {
            own.insert(output, values);
        }
    }
    constants.push(own);
    for node in nodes {
        for attribute in parts(node, 5) {
            check_attribute(node, attribute)?;
        }
        check_inputs(node, constants)?;
        for inner in parts(node, 5).into_iter().flat_map(|attribute| parts(attribute, 6)) {
            // the runtime plans these on threads of its own, whose stacks are small
            check_graph(inner, runtime::SHALLOW, constants)?;
        }
    }
    constants.pop();
    Ok(())
}

/// Returns whether an operator only changes the form of its input.
fn passes_on(node: &[u8]) -> bool {
    let same: [&[u8]; 6] = [b"Cast", b"Flatten", b"Identity", b"Reshape", b"Squeeze", b"Unsqueeze"];
    parts(node, 4).first().is_some_and(|operator| same.contains(operator))
}

/// Checks the sizes that an operator is given.
fn check_inputs(node: &[u8], constants: &ConstantScopes<'_>) -> Result<(), String> {
    let names = parts(node, 1);
    let input = |k: usize| {
        let name = names.get(k)?;
        constants.iter().rev().find_map(|graph| graph.get(name))
    };
    let values = |k: usize| input(k).map_or(&[][..], |numbers| &numbers.values);
    match parts(node, 4).first().copied().unwrap_or_default() {
        b"ConstantOfShape" => check_shape(node, values(0)),
        b"Expand" | b"Tile" | b"Pad" | b"OneHot" => check_shape(node, values(1)),
        b"TopK" | b"Upsample" => check_factors(node, values(1)),
        b"Resize" => check_factors(node, values(2)).and_then(|()| check_shape(node, values(3))),
        b"Range" => check_range([input(0), input(1), input(2)]),
        b"Loop" if values(0).iter().any(|&turns| turns > MOST_TURNS) => Err(format!(
            "the operator Loop would take {} turns, more than {MOST_TURNS}",
            list(values(0))
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a field that contains bytes, of any length.
    fn field_of(number: u8, bytes: &[u8]) -> Vec<u8> {
        let mut out = vec![number << 3 | 2];
        let mut rest = bytes.len();
        while rest > 0x7f {
            out.push(rest as u8 | 0x80);
            rest >>= 7;
        }
        out.push(rest as u8);
        [&out, bytes].concat()
    }

    /// Returns a field that contains fewer than 128 bytes.
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

    /// A list of numbers of a type, with its name.
    fn tensor(name: &str, kind: u8, raw: &[u8]) -> Vec<u8> {
        let fields = [vec![2 << 3, kind], field(8, name.as_bytes()), field(9, raw)].concat();
        field(5, &fields)
    }

    #[test]
    fn rows_of_numbers_end() {
        let model = |kind: u8, numbers: [f64; 3]| {
            let raw = |v: f64| match kind {
                1 => (v as f32).to_le_bytes().to_vec(),
                6 => (v as i32).to_le_bytes().to_vec(),
                _ => (v as i64).to_le_bytes().to_vec(),
            };
            let constants: Vec<u8> = ["a", "b", "c"]
                .iter()
                .zip(numbers)
                .flat_map(|(name, v)| tensor(name, kind, &raw(v)))
                .collect();
            let node = [field(1, b"a"), field(1, b"b"), field(1, b"c"), field(4, b"Range")].concat();
            field(7, &[field(1, &node), constants].concat())
        };
        for (kind, numbers, fits) in [
            (1, [0.0, 44.0, 1.0], true),
            (1, [0.0, -44.0, 1.0], true),
            (1, [10.0, 0.0, -0.5], true),
            (1, [0.0, 1e10, 1.0], false),
            (1, [0.0, 1.0, 1e-9], false),
            (1, [1e9, 1e9 + 1000.0, 1.0], false),
            (1, [0.0, f64::INFINITY, 1.0], false),
            (7, [0.0, 44.0, 1.0], true),
            (7, [1e9, 1e9 + 5.0, 1.0], true),
            (7, [0.0, 1e12, 1.0], false),
            (6, [2_147_483_640.0, 2_147_483_647.0, 10.0], false),
        ] {
            assert_eq!(check(&model(kind, numbers)).is_ok(), fits, "{kind} {numbers:?}");
        }
    }

    #[test]
    fn factors_and_turns_are_bounded() {
        let model = |operator: &str, place: usize, kind: u8, raw: &[u8]| {
            let inputs: Vec<u8> = (0..=place)
                .flat_map(|k| field(1, if k == place { b"s" } else { b"" }))
                .collect();
            let node = [inputs, field(4, operator.as_bytes())].concat();
            field(7, &[field(1, &node), tensor("s", kind, raw)].concat())
        };
        let large = [1.0f32, 1.0, 1e5, 1e5].map(f32::to_le_bytes).concat();
        let double = [1.0f32, 1.0, 2.0, 2.0].map(f32::to_le_bytes).concat();
        for (operator, place) in [("Resize", 2), ("Upsample", 1)] {
            let refused = check(&model(operator, place, 1, &large)).expect_err("large factors");
            assert!(refused.contains("[1, 1, 100000, 100000] times as large"), "{refused}");
            assert_eq!(check(&model(operator, place, 1, &double)), Ok(1));
        }
        for (operator, place) in [("TopK", 1), ("Loop", 0)] {
            let refused = check(&model(operator, place, 7, &(1i64 << 62).to_le_bytes())).expect_err("a large number");
            assert!(refused.contains("4611686018427388000"), "{refused}");
            assert_eq!(check(&model(operator, place, 7, &44i64.to_le_bytes())), Ok(1));
        }
    }

    #[test]
    fn graphs_have_a_length_that_a_stack_holds() {
        let graph = |n: usize| field_of(7, &field(1, &field(4, b"Identity")).repeat(n));
        assert_eq!(check(&graph(runtime::MOST)), Ok(runtime::MOST));
        assert!(check(&graph(25_000)).is_err_and(|e| e.contains("25000 operators")));
        let branch = |n: usize| {
            let inside = field_of(6, &field(1, &field(4, b"Identity")).repeat(n));
            field_of(7, &field_of(1, &field_of(5, &inside)))
        };
        assert_eq!(check(&branch(runtime::SHALLOW)), Ok(1));
        assert!(check(&branch(runtime::SHALLOW + 1)).is_err());
    }

    #[test]
    fn graphs_are_not_nested_deeply() {
        let nested = |levels: usize| {
            let leaf = field(1, &field(4, b"Identity"));
            let around = |inside: Vec<u8>, _| field_of(1, &field_of(5, &field_of(6, &inside)));
            field_of(7, &(0..levels).fold(leaf, around))
        };
        assert_eq!(check(&nested(NESTED)), Ok(1));
        let refused = check(&nested(NESTED + 1)).expect_err("too deep");
        assert!(refused.contains("nests graphs more than 4 deep"), "{refused}");
    }
}

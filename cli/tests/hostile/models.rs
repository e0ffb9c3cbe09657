//! ONNX models as policies.

use crate::bytes::{field, number};
use crate::case::{Case, Content};
use crate::runs::quick;

fn case(name: &str, model: impl Into<Content>) -> Case {
    let call = "evaluate --config c.yml --episodes 1 --duration 2 --no-render --quiet --policy m.onnx";
    quick(format!("ONNX: {name}"), call).file("m.onnx", model)
}

/// A node of a graph.
fn node(operator: &str, inputs: &[&str], outputs: &[&str], attributes: &[Vec<u8>]) -> Vec<u8> {
    let names = |n: u64, names: &[&str]| {
        names
            .iter()
            .flat_map(|name| field(n, name.as_bytes()))
            .collect::<Vec<u8>>()
    };
    let attributes: Vec<u8> = attributes.iter().flat_map(|a| field(5, a)).collect();
    [
        names(1, inputs),
        names(2, outputs),
        field(4, operator.as_bytes()),
        attributes,
    ]
    .concat()
}

/// A list of whole numbers.
fn constant(name: &str, values: &[i64]) -> Vec<u8> {
    let raw: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
    tensor(name, 7, Some(values.len() as u64), &raw)
}

/// Numbers of a type (1 for `f32`, 6 for `i32`, 7 for `i64`, 9 for a flag), a list or a single one.
fn tensor(name: &str, kind: u64, length: Option<u64>, raw: &[u8]) -> Vec<u8> {
    let length = length.map(|n| number(1, n)).unwrap_or_default();
    [length, number(2, kind), field(8, name.as_bytes()), field(9, raw)].concat()
}

/// An input or output of numbers of a type (1 for `f32`) and a shape.
fn value(name: &str, kind: u64, shape: &[u64]) -> Vec<u8> {
    let dimensions: Vec<u8> = shape.iter().flat_map(|&n| field(1, &number(1, n))).collect();
    let tensor = [number(1, kind), field(2, &dimensions)].concat();
    [field(1, name.as_bytes()), field(2, &field(1, &tensor))].concat()
}

fn model_of(nodes: &[Vec<u8>], constants: &[Vec<u8>], input: &[u8]) -> Vec<u8> {
    let all = |n: u64, parts: &[Vec<u8>]| parts.iter().flat_map(|p| field(n, p)).collect::<Vec<u8>>();
    let output = field(12, &value("action", 1, &[1, 44]));
    let graph = [
        all(1, nodes),
        field(2, b"g"),
        all(5, constants),
        field(11, input),
        output,
    ]
    .concat();
    [
        number(1, 8),
        field(7, &graph),
        field(8, &[field(1, b""), number(2, 17)].concat()),
    ]
    .concat()
}

/// A model of one operator whose second input, or only one, are these sizes.
fn sized(operator: &str, inputs: &[&str], sizes: &[i64]) -> Vec<u8> {
    let input = value("observation", 1, &[1, OBSERVATION]);
    model_of(
        &[node(operator, inputs, &["action"], &[])],
        &[constant("s", sizes)],
        &input,
    )
}

/// Numbers in the observation of the quick configuration.
const OBSERVATION: u64 = 292;

/// A chain of operators that pass on what is observed.
fn chain(length: usize) -> Vec<u8> {
    let names: Vec<String> = (0..length).map(|k| format!("x{k}")).collect();
    let mut from = "observation";
    let mut nodes = Vec::new();
    for name in &names {
        nodes.push(node("Identity", &[from], &[name], &[]));
        from = name;
    }
    nodes.push(node("Relu", &[from], &["action"], &[]));
    model_of(&nodes, &[], &value("observation", 1, &[1, OBSERVATION]))
}

/// Models whose sizes stand in constants of other types, on which the runtime panics, or whose
/// choices it takes long to plan.
fn by_the_runtime() -> Vec<Case> {
    let observation = value("observation", 1, &[1, OBSERVATION]);
    let single = |name: &str, v: f32| tensor(name, 1, None, &v.to_le_bytes());
    let to_float = [field(1, b"to"), number(3, 1)].concat();
    let quotient = [
        node("Div", &["least", "minus"], &["q"], &[]),
        node("Cast", &["q"], &["action"], &[to_float]),
    ];
    let least = i32::MIN.to_le_bytes().repeat(44);
    let divided = [
        tensor("least", 6, Some(44), &least),
        tensor("minus", 6, None, &(-1i32).to_le_bytes()),
    ];
    let enlarged = [
        node("Unsqueeze", &["observation", "u"], &["image"], &[]),
        node("Resize", &["image", "", "scales"], &["action"], &[]),
    ];
    let scales: Vec<u8> = [1.0f32, 1.0, 1e5, 1e5].iter().flat_map(|v| v.to_le_bytes()).collect();
    let scales = [constant("u", &[0, 1]), tensor("scales", 1, Some(4), &scales)];
    let same = |name: &str| {
        let graph = [
            field(1, &node("Identity", &["observation"], &[name], &[])),
            field(12, field(1, name.as_bytes()).as_slice()),
        ];
        graph.concat()
    };
    let branch = |name: &str, graph: &[u8]| [field(1, name.as_bytes()), field(6, graph)].concat();
    let chosen = |graph: &[u8], name: &str| {
        let attributes = [branch("then_branch", graph), branch("else_branch", &same("e"))];
        node("If", &["c"], &[name], &attributes)
    };
    let nested = |levels: usize| {
        let graph = (0..levels).fold(same("y"), |graph, k| {
            let name = format!("y{k}");
            [
                field(1, &chosen(&graph, &name)),
                field(12, field(1, name.as_bytes()).as_slice()),
            ]
            .concat()
        });
        model_of(&[chosen(&graph, "action")], &[tensor("c", 9, None, &[1])], &observation)
    };
    vec![
        case(
            "the 2^62 largest of an observation",
            sized("TopK", &["observation", "s"], &[1 << 62]),
        ),
        case("image 10^10 times as large", model_of(&enlarged, &scales, &observation)),
        case(
            "ten billion numbers in a row",
            model_of(
                &[node("Range", &["from", "to", "by"], &["action"], &[])],
                &[single("from", 0.0), single("to", 1e10), single("by", 1.0)],
                &observation,
            ),
        ),
        case(
            "least number divided by -1",
            model_of(&quotient, &divided, &observation),
        ),
        case("choices in choices", nested(3)),
        case("a choice in twelve choices", nested(12)),
        case("25,000 operators in a row", chain(25_000)),
        case("9,999 operators in a row", chain(9_998)),
    ]
}

pub fn cases() -> Vec<Case> {
    [broken(), by_the_runtime()].concat()
}

fn broken() -> Vec<Case> {
    let observation = value("observation", 1, &[1, OBSERVATION]);
    let identity = node("Identity", &["observation"], &["action"], &[]);
    let of = |node: Vec<u8>| model_of(&[node], &[], &observation);
    let loops = node("Identity", &["action"], &["action"], &[]);
    let slice = |to: i64| {
        let parts = [constant("a", &[0]), constant("b", &[to]), constant("c", &[1])];
        model_of(
            &[node("Slice", &["observation", "a", "b", "c"], &["action"], &[])],
            &parts,
            &observation,
        )
    };
    let big = sized("Identity", &["observation"], &[]);
    let zeros = vec![0u8; 4096];
    let deep = (0..5000).fold(Vec::new(), |inner: Vec<u8>, _| field(7, &inner));
    vec![
        case("empty", ""),
        case("text", "no model"),
        case("zeros", &zeros),
        case("cut", &big[..big.len() / 2]),
        case("messages in messages", deep),
        case("length beyond the file", b"\x3a\xff\xff\xff\xff\x0f"),
        case("number of eleven bytes", [0xff; 11]),
        case(
            "number of eleven bytes in a graph",
            [number(1, 8), field(7, &field(5, &field(7, &[0xff; 11])))].concat(),
        ),
        case("graphs in graphs", {
            let node = |graph: &[u8]| field(1, &field(5, &[field(1, b"body"), field(6, graph)].concat()));
            let graph = (0..3000).fold(Vec::new(), |graph: Vec<u8>, _| node(&graph));
            [number(1, 8), field(7, &graph)].concat()
        }),
        case(
            "text longer than the file",
            [number(1, 8), vec![0x3a, 6, 0x0a, 0xff, 0xff, 0xff, 0xff, 0x0f]].concat(),
        ),
        case("no graph", number(1, 8)),
        case("no input", {
            let graph = [field(1, &identity), field(12, &value("action", 1, &[1, 44]))].concat();
            [number(1, 8), field(7, &graph)].concat()
        }),
        case("no output", {
            let graph = [field(1, &identity), field(11, &observation)].concat();
            [number(1, 8), field(7, &graph)].concat()
        }),
        case(
            "unknown operator",
            of(node("Summon", &["observation"], &["action"], &[])),
        ),
        case(
            "operator with escape sequences",
            of(node("\u{1b}[2J", &["observation"], &["action"], &[])),
        ),
        case("operator without inputs", of(node("Add", &[], &["action"], &[]))),
        case(
            "input that is not there",
            of(node("Relu", &["smell"], &["action"], &[])),
        ),
        case("operator that feeds itself", of(loops)),
        case(
            "input of another length",
            model_of(std::slice::from_ref(&identity), &[], &value("observation", 1, &[1, 7])),
        ),
        case(
            "input of 2^63 numbers",
            model_of(
                std::slice::from_ref(&identity),
                &[],
                &value("observation", 1, &[u64::MAX >> 1]),
            ),
        ),
        case(
            "input of whole numbers",
            model_of(
                std::slice::from_ref(&identity),
                &[],
                &value("observation", 7, &[1, OBSERVATION]),
            ),
        ),
        case("action of another length", of(identity.clone())),
        case(
            "40 billion numbers",
            sized("ConstantOfShape", &["s"], &[1, 40_000_000_000]),
        ),
        case(
            "product of sizes that overflows",
            sized("ConstantOfShape", &["s"], &[1 << 31, 1 << 31, 1 << 31]),
        ),
        case("negative size", sized("ConstantOfShape", &["s"], &[-5, 3])),
        case("no numbers", sized("ConstantOfShape", &["s"], &[0])),
        case(
            "observation, 100 million times",
            sized("Expand", &["observation", "s"], &[100_000_000, OBSERVATION as i64]),
        ),
        case(
            "tiles, 2^40 times",
            sized("Tile", &["observation", "s"], &[1 << 20, 1 << 20]),
        ),
        case(
            "padding of a terabyte",
            sized("Pad", &["observation", "s"], &[1 << 40, 0, 0, 0]),
        ),
        case(
            "gather beyond the end",
            sized("Gather", &["observation", "s"], &[99_999_999_999]),
        ),
        case(
            "reshape to what does not fit",
            sized("Reshape", &["observation", "s"], &[7, 7]),
        ),
        case(
            "reshape to two unknowns",
            sized("Reshape", &["observation", "s"], &[-1, -1]),
        ),
        case("slice of nothing", slice(0)),
        case("slice beyond the end", slice(i64::MAX)),
        case("a pipe", Content::Pipe),
        case("a device", Content::Link("/dev/zero")),
        case("a folder", Content::Folder),
        case("2 GiB of zeros", Content::Zeros(2 << 30)),
    ]
}

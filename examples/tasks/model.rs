//! Linear policies as ONNX models: for each sense that is used a product with a matrix; their sum is the action.

/// A sense and its weights.
pub struct Sense {
    /// Its key in the observation, which is the name of the model's input.
    pub key: &'static str,
    /// Weights, a row of the action's length for each number of the sense.
    pub weights: Vec<f32>,
}

/// Types of a tensor's elements (`TensorProto.DataType`).
const FLOAT: u64 = 1;
/// Version of the format, and of the operators.
const FORMAT: u64 = 8;
const OPERATORS: u64 = 17;

/// Writes the model whose action is `offset` plus the products of all senses with their weights.
pub fn bytes(senses: &[Sense], offset: &[f32]) -> Vec<u8> {
    let n = offset.len();
    let mut graph = Message::default();
    let mut sum = "offset".to_string();
    for (k, sense) in senses.iter().enumerate() {
        let (product, weights) = (format!("product_{}", sense.key), format!("weights_{}", sense.key));
        graph.message(1, &node("MatMul", &[sense.key, &weights], &product));
        let last = k + 1 == senses.len();
        let next = if last { "action".to_string() } else { format!("sum_{k}") };
        graph.message(1, &node("Add", &[&sum, &product], &next));
        sum = next;
    }
    graph.text(2, "policy");
    graph.message(5, &tensor("offset", &[1, n], offset));
    for sense in senses {
        let rows = sense.weights.len() / n.max(1);
        graph.message(
            5,
            &tensor(&format!("weights_{}", sense.key), &[rows, n], &sense.weights),
        );
    }
    for sense in senses {
        graph.message(11, &value(sense.key, &[1, sense.weights.len() / n.max(1)]));
    }
    graph.message(12, &value("action", &[1, n]));
    let mut operators = Message::default();
    operators.text(1, "");
    operators.number(2, OPERATORS);
    let mut model = Message::default();
    model.number(1, FORMAT);
    model.text(2, "babybench");
    model.message(7, &graph);
    model.message(8, &operators);
    model.0
}

/// Returns an operator with its inputs and its output.
fn node(operator: &str, inputs: &[&str], output: &str) -> Message {
    let mut node = Message::default();
    for input in inputs {
        node.text(1, input);
    }
    node.text(2, output);
    node.text(3, output);
    node.text(4, operator);
    node
}

/// Returns constant numbers.
fn tensor(name: &str, shape: &[usize], numbers: &[f32]) -> Message {
    let mut tensor = Message::default();
    for &size in shape {
        tensor.number(1, size as u64);
    }
    tensor.number(2, FLOAT);
    tensor.text(8, name);
    let bytes: Vec<u8> = numbers.iter().flat_map(|v| v.to_le_bytes()).collect();
    tensor.bytes(9, &bytes);
    tensor
}

/// Returns the name and the type of an input or an output.
fn value(name: &str, shape: &[usize]) -> Message {
    let mut dimensions = Message::default();
    for &size in shape {
        let mut dimension = Message::default();
        dimension.number(1, size as u64);
        dimensions.message(1, &dimension);
    }
    let (mut tensor, mut kind, mut value) = (Message::default(), Message::default(), Message::default());
    tensor.number(1, FLOAT);
    tensor.message(2, &dimensions);
    kind.message(1, &tensor);
    value.text(1, name);
    value.message(2, &kind);
    value
}

/// A message of Protocol Buffers.
#[derive(Default)]
struct Message(Vec<u8>);

impl Message {
    fn varint(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.0.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.0.push(value as u8);
    }

    fn number(&mut self, field: u64, value: u64) {
        self.varint(field << 3);
        self.varint(value);
    }

    fn bytes(&mut self, field: u64, bytes: &[u8]) {
        self.varint(field << 3 | 2);
        self.varint(bytes.len() as u64);
        self.0.extend_from_slice(bytes);
    }

    fn text(&mut self, field: u64, text: &str) {
        self.bytes(field, text.as_bytes());
    }

    fn message(&mut self, field: u64, message: &Self) {
        self.bytes(field, &message.0);
    }
}

//! Logs that are nearly right.

use babybench::formats::pickle::{self, Value};

/// Makes a training log whose numbers come from `data`.
pub fn training(data: &[u8]) -> Vec<u8> {
    let mut bytes = data.iter().copied();
    let mut records = Vec::new();
    while let Some(kind) = bytes.next() {
        let mut byte = || bytes.next().unwrap_or(0);
        let mut number = || match byte() {
            255 => Value::Int(i64::MAX),
            254 => Value::Int(i64::MIN),
            253 => Value::Float(f64::NAN),
            252 => Value::Int(19_999),
            251 => Value::Int(1 << 40),
            n => Value::Int(i64::from(n)),
        };
        let mut list = |n: u8| Value::list((0..n % 6).map(|_| number()).collect::<Vec<_>>());
        let record = match kind % 4 {
            0 => Value::dict([
                ("right_hand_touches", list(kind / 4)),
                ("left_hand_touches", list(kind / 24)),
                ("steps", number()),
            ]),
            1 => Value::dict([
                ("right_eye_right_hand", number()),
                ("right_eye_left_hand", number()),
                ("left_eye_right_hand", number()),
                ("left_eye_left_hand", number()),
                ("steps", number()),
            ]),
            2 => Value::dict([("steps", number())]),
            _ => list(kind),
        };
        records.push(record);
    }
    pickle::to_bytes(&Value::list(records)).expect("a pickle")
}

//! Pickles: what is read survives being written.
#![no_main]

use babybench::Limits;
use babybench::formats::pickle::{self, Value};
use libfuzzer_sys::fuzz_target;

/// Counts values, up to a bound, as a small file may share a list many times; `None` for one that is not equal to itself.
fn size(value: &Value, left: usize) -> Option<usize> {
    let left = left.checked_sub(1)?;
    match value {
        Value::Float(v) if v.is_nan() => None,
        Value::List(list) => list.iter().try_fold(left, |left, v| size(v, left)),
        Value::Dict(pairs) => pairs.iter().try_fold(left, |left, (_, v)| size(v, left)),
        Value::Array(array) if array.data.iter().any(|v| v.is_nan()) => None,
        Value::Array(array) => left.checked_sub(array.data.len()),
        _ => Some(left),
    }
}

fuzz_target!(|data: &[u8]| {
    let limits = Limits {
        pickle_numbers: 1 << 16,
        pickle_objects: 1 << 14,
        ..Limits::default()
    };
    let Ok(value) = pickle::from_bytes_with(data, &limits) else {
        return;
    };
    if size(&value, 5000).is_none() {
        return;
    }
    if let Ok(bytes) = pickle::to_bytes(&value) {
        let back = pickle::from_bytes(&bytes).expect("it reads what it writes");
        assert!(back == value, "written and read: {value:?} {back:?}");
    }
});

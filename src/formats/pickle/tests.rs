use testkit::Rng;
use testkit::mutation::mutate;

use super::*;
use crate::limits::Limits;

fn sample() -> Value {
    let array = |shape: &[usize], data: &[f64]| {
        let (shape, data) = (shape.to_vec(), data.to_vec());
        Value::Array(Arc::new(Array { shape, data }))
    };
    let ints = [0, 255, 256, 65535, 65536, -1, -129, 1 << 40, i64::MIN, i64::MAX].map(Value::Int);
    Value::dict([
        (
            "qpos",
            Value::list([array(&[3], &[0.1, -2.5, 1e-300]), array(&[2, 2], &[1.0, 2.0, 3.0, 4.0])]),
        ),
        (
            "info",
            Value::list([
                Value::dict([("steps", Value::Int(1))]),
                Value::dict([("steps", Value::Int(2))]),
            ]),
        ),
        ("ints", Value::list(ints)),
        ("empty", Value::list([])),
        (
            "scalars",
            Value::list([Value::None, Value::Bool(true), Value::Bool(false), Value::Float(0.5)]),
        ),
        ("text", Value::Text("é".repeat(300).into())),
        ("long", array(&[100], &[0.25; 100])),
    ])
}

#[test]
fn what_is_written_reads_back() {
    let value = sample();
    assert_eq!(from_bytes(&to_bytes(&value).unwrap()).unwrap(), value);
    let many = Value::list((0..300).map(|k| Value::dict([(format!("key{k}").as_str(), Value::Int(k))])));
    let both = Value::list([many.clone(), many]);
    assert_eq!(from_bytes(&to_bytes(&both).unwrap()).unwrap(), both);
}

#[test]
fn a_list_written_item_by_item_is_the_same_list() {
    let mut writer = ListWriter::with_capacity(0);
    assert_eq!(writer.as_bytes(), to_bytes(&Value::list([])).unwrap());
    // more than are appended at once
    let long = |k: i64| if k == 7 { 2500 } else { k % 3 };
    for k in 0..2500 {
        writer.push(|dict| {
            dict.ints("list", (0..long(k)).map(|n| n * k));
            dict.int("int", k - 300);
            dict.float("float", k as f64 / 3.0);
            dict.bool("bool", k % 2 == 0);
            dict.text("text", &"x".repeat(k as usize % 300));
        });
    }
    let list = Value::list((0..2500).map(|k| {
        Value::dict([
            ("list", Value::list((0..long(k)).map(|n| Value::Int(n * k)))),
            ("int", Value::Int(k - 300)),
            ("float", Value::Float(k as f64 / 3.0)),
            ("bool", Value::Bool(k % 2 == 0)),
            ("text", Value::Text("x".repeat(k as usize % 300).into())),
        ])
    }));
    assert!(writer.as_bytes() == to_bytes(&list).unwrap());
    assert!(from_bytes(writer.as_bytes()).unwrap() == list);
}

#[test]
fn nothing_is_looked_up_or_called() {
    for (bytes, name) in [
        (&b"\x80\x02cos\nsystem\nX\x02\0\0\0ls\x85R."[..], "os.system"),
        (b"\x80\x04\x8c\x08builtins\x8c\x04eval\x93.", "builtins.eval"),
        (b"\x80\x04cnumpy\nload\n.", "numpy.load"),
    ] {
        let Err(PickleError::Global { name: found, .. }) = from_bytes(bytes) else {
            panic!("{name} is refused");
        };
        assert_eq!(found, name);
    }
    for opcode in [
        b'i', b'o', b'P', b'Q', 0x81, 0x92, 0x82, b'0', b'2', b'I', b'F', b'S', b'V',
    ] {
        let bytes = [0x80, 4, opcode, b'.'];
        assert_eq!(from_bytes(&bytes), Err(PickleError::Opcode { at: 2, opcode }));
    }
}

#[test]
fn truncated_pickles_say_so() {
    let bytes = to_bytes(&sample()).unwrap();
    for n in 0..bytes.len() {
        assert!(from_bytes(&bytes[..n]).is_err(), "{n} of {} bytes", bytes.len());
    }
    assert_eq!(from_bytes(b""), Err(PickleError::Truncated { at: 0 }));
}

#[test]
fn values_that_contain_themselves_or_unfold_without_end_are_refused() {
    assert!(from_bytes(b"\x80\x04]\x94h\0a.").is_err());
    // each list holds the one before twice: 2^n leaves
    let mut bytes = b"\x80\x04]\x94".to_vec();
    for k in 0..200_u8 {
        bytes.extend([b']', 0x94, b'(', b'h', k, b'h', k, b'e']);
    }
    bytes.push(b'\x86');
    assert!(from_bytes(&bytes).is_err());
    // flat at every point of the way, deep in all
    let mut deep = b"\x80\x04](".to_vec();
    deep.extend(b"]\x94");
    for k in 0..250_u8 {
        deep.extend([b']', 0x94, b'h', k, b'a']);
    }
    deep.extend(b"e.");
    let what = "levels of nesting";
    assert_eq!(from_bytes(&deep), Err(PickleError::Limit { what, limit: 32 }));
    let nested = (0..40).fold(Value::None, |v, _| Value::list([v]));
    assert!(to_bytes(&nested).is_err());
}

#[test]
fn mutated_pickles_are_read_or_refused_but_never_panic() {
    let opcodes = b"\x80\x95(NJKMG\x88\x89\x8a\x8c\x8dXCB\x8e\x96]})aesut\x85\x86\x87\x94qrhjc\x93Rb.";
    // as NumPy 2 under protocol 5
    let mut five =
        b"\x80\x05}\x94\x8c\x01q\x94\x8c\x13numpy._core.numeric\x94\x8c\x0b_frombuffer\x94\x93\x94(\x96".to_vec();
    five.extend(8_u64.to_le_bytes());
    five.extend(1.5_f64.to_le_bytes());
    five.extend(
        b"\x94\x8c\x05numpy\x94\x8c\x05dtype\x94\x93\x94\x8c\x02f8\x94\x89\x88\x87\x94R\x94(K\x03\x8c\x01<\x94NNN",
    );
    five.extend(b"J\xff\xff\xff\xffJ\xff\xff\xff\xffK\x00t\x94bK\x01\x85\x94\x8c\x01C\x94t\x94R\x94s.");
    let one = Value::Array(Arc::new(Array {
        shape: vec![1],
        data: vec![1.5],
    }));
    assert_eq!(from_bytes(&five).unwrap(), Value::dict([("q", one)]));
    let seeds = [to_bytes(&sample()).unwrap(), five];
    let opcodes: Vec<&[u8]> = opcodes.chunks(1).collect();
    let mut rng = Rng::with_seed(1);
    let mut read = 0;
    for round in 0..60_000 {
        let bytes = mutate(&seeds[round % 2], &opcodes, &mut rng);
        read += usize::from(from_bytes(&bytes).is_ok());
    }
    println!("{read} of 60000 mutated pickles are still logs");
    assert!(read > 0);
}

/// Each limit that a caller sets takes effect.
#[test]
fn limits_are_the_callers() {
    let array = Value::Array(Arc::new(Array {
        shape: vec![1, 2],
        data: vec![1.0, 2.0],
    }));
    let value = Value::list([array, Value::list([Value::Int(1)])]);
    let bytes = to_bytes(&value).unwrap();
    let default = Limits::default;
    assert_eq!(from_bytes_with(&bytes, &default()), Ok(value));
    let cases = [
        (
            Limits {
                pickle_bytes: 10,
                ..default()
            },
            "bytes",
            10,
        ),
        (
            Limits {
                pickle_numbers: 1,
                ..default()
            },
            "numbers",
            1,
        ),
        (
            Limits {
                pickle_objects: 2,
                ..default()
            },
            "values",
            2,
        ),
        (
            Limits {
                pickle_depth: 0,
                ..default()
            },
            "levels of nesting",
            0,
        ),
    ];
    for (limits, what, limit) in cases {
        assert_eq!(
            from_bytes_with(&bytes, &limits),
            Err(PickleError::Limit { what, limit })
        );
    }
    let flat = Limits {
        pickle_dimensions: 1,
        ..default()
    };
    assert!(matches!(
        from_bytes_with(&bytes, &flat),
        Err(PickleError::Malformed { .. })
    ));
}

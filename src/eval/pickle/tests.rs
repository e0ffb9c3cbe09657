use super::*;

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
    assert_eq!(from_bytes(&deep), Err(PickleError::Limit { what, limit: MAX_DEPTH }));
    let nested = (0..40).fold(Value::None, |v, _| Value::list([v]));
    assert!(to_bytes(&nested).is_err());
}

/// SplitMix64, so that a failure can be repeated.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
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
    let mut random = Random(1);
    let mut read = 0;
    for round in 0..60_000 {
        let mut bytes = seeds[round % 2].clone();
        for _ in 0..=random.below(4) {
            let at = random.below(bytes.len());
            let end = (at + random.below(9)).min(bytes.len());
            match random.below(5) {
                0 if at < bytes.len() => bytes[at] = random.below(256) as u8,
                1 if at < bytes.len() => bytes[at] = opcodes[random.below(opcodes.len())],
                2 => bytes.insert(at, opcodes[random.below(opcodes.len())]),
                3 => drop(bytes.drain(at..end)),
                _ => {
                    let piece = bytes[at..end].to_vec();
                    let to = random.below(bytes.len());
                    bytes.splice(to..to, piece);
                }
            }
        }
        read += usize::from(from_bytes(&bytes).is_ok());
    }
    println!("{read} of 60000 mutated pickles are still logs");
    assert!(read > 0);
}

use super::*;
use crate::limits::Limits;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use std::io::Write;

fn open(bytes: Vec<u8>) -> Result<Npz, NpzError> {
    Npz::from_bytes(bytes, "a.npz")
}

/// Builds an archive of one stored member.
fn member(path: &str, data: &[u8]) -> Vec<u8> {
    let mut archive = ZipArchiveWriter::new(Vec::new());
    let (mut entry, config) = archive
        .new_file(path)
        .compression_method(CompressionMethod::STORE)
        .start()
        .unwrap();
    let mut writer = config.wrap(&mut entry);
    writer.write_all(data).unwrap();
    let (_, descriptor) = writer.finish().unwrap();
    entry.finish(descriptor).unwrap();
    archive.finish().unwrap()
}

/// Builds an `.npy` file with this dictionary.
fn npy(dictionary: &str, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((dictionary.len() as u16).to_le_bytes());
    bytes.extend(dictionary.as_bytes());
    bytes.extend(data);
    bytes
}

/// Reads the array `a` of this dictionary and data.
fn summary(dictionary: &str, data: &[u8]) -> String {
    match open(member("a.npy", &npy(dictionary, data))).and_then(|npz| npz.get_f64("a")) {
        Ok(array) => format!("{:?} {:?}", array.shape, array.data),
        Err(error) => error.to_string(),
    }
}

#[track_caller]
fn check(dictionary: &str, data: &[u8], expect: &str) {
    assert_eq!(summary(dictionary, data), expect, "{dictionary}");
}

fn of(dtype: &str, shape: &str) -> String {
    format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': {shape}, }}\n")
}

/// Builds an archive with an array of every type and of several shapes.
fn every_type() -> NpzWriter {
    let mut writer = NpzWriter::new();
    writer
        .add("f64", &[2, 2], &[0.1, -0.0, f64::INFINITY, f64::MIN_POSITIVE])
        .unwrap();
    writer.add("f32", &[3], &[0.5_f32, -1.25, f32::MAX]).unwrap();
    writer.add("i32", &[1, 2, 1], &[i32::MIN, 7]).unwrap();
    writer.add("i64", &[], &[i64::MAX]).unwrap();
    writer.add("u8", &[2, 1, 3], &[0_u8, 1, 2, 253, 254, 255]).unwrap();
    writer.add("none", &[0, 4], &[0.0; 0]).unwrap();
    writer
        .add("long", &[40, 100], &(0..4_000).map(f64::from).collect::<Vec<_>>())
        .unwrap();
    writer
}

#[test]
fn every_type_and_shape_comes_back() {
    let bytes = every_type().finish().unwrap();
    assert_eq!(
        bytes,
        every_type().finish().unwrap(),
        "the same arrays give other bytes"
    );
    let npz = open(bytes).unwrap();
    let list: Vec<String> = npz
        .arrays()
        .map(|array| format!("{} {} {:?}", array.name, array.dtype, array.shape))
        .collect();
    let expect = [
        "f64 <f8 [2, 2]",
        "f32 <f4 [3]",
        "i32 <i4 [1, 2, 1]",
        "i64 <i8 []",
        "u8 |u1 [2, 1, 3]",
        "none <f8 [0, 4]",
        "long <f8 [40, 100]",
    ];
    assert_eq!(list, expect);
    let f64s = npz.get_f64("f64").unwrap().data;
    assert_eq!(
        f64s.iter().map(|x| x.to_bits()).collect::<Vec<_>>(),
        [
            0.1_f64.to_bits(),
            (-0.0_f64).to_bits(),
            f64::INFINITY.to_bits(),
            f64::MIN_POSITIVE.to_bits()
        ]
    );
}

#[test]
fn every_type_and_shape_is_read() {
    let npz = open(every_type().finish().unwrap()).unwrap();
    assert_eq!(npz.get_f64("f32").unwrap().data, [0.5, -1.25, f64::from(f32::MAX)]);
    assert_eq!(
        npz.get_i64("i32").unwrap(),
        Array {
            shape: vec![1, 2, 1],
            data: vec![i64::from(i32::MIN), 7]
        }
    );
    assert_eq!(npz.get_f64("i32").unwrap().data, [-2_147_483_648.0, 7.0]);
    assert_eq!(
        npz.get_i64("i64").unwrap(),
        Array {
            shape: vec![],
            data: vec![i64::MAX]
        }
    );
    assert_eq!(
        npz.get_u8("u8").unwrap(),
        Array {
            shape: vec![2, 1, 3],
            data: vec![0, 1, 2, 253, 254, 255]
        }
    );
    assert_eq!(
        npz.get_f64("none").unwrap(),
        Array {
            shape: vec![0, 4],
            data: vec![]
        }
    );
    assert_eq!(npz.get_f64("long").unwrap().data[3_999], 3_999.0);
}

#[test]
fn numbers_that_do_not_fit_are_refused() {
    let npz = open(every_type().finish().unwrap()).unwrap();
    let error = |result: Result<(), NpzError>| result.unwrap_err().to_string();
    assert_eq!(
        error(npz.get_f64("i64").map(drop)),
        "a.npz: array `i64` of <i8 cannot be read as f64"
    );
    assert_eq!(
        error(npz.get_i64("f32").map(drop)),
        "a.npz: array `f32` of <f4 cannot be read as i64"
    );
    assert_eq!(
        error(npz.get_u8("i32").map(drop)),
        "a.npz: array `i32` of <i4 cannot be read as u8"
    );
    assert_eq!(error(npz.get_u8("qpos").map(drop)), "a.npz: has no array `qpos`");
}

#[test]
fn other_types_and_orders_are_read() {
    check(&of(">f8", "(1,)"), &1.5_f64.to_be_bytes(), "[1] [1.5]");
    check(&of(">i2", "(2,)"), &[1, 0, 255, 255], "[2] [256.0, -1.0]");
    check(&of("<u2", "(1,)"), &[0, 1], "[1] [256.0]");
    check(&of("|b1", "(2,)"), &[0, 1], "[2] [0.0, 1.0]");
    check(&of("|i1", "()"), &[255], "[] [-1.0]");
    check(
        "{\"shape\":(2,3),\"fortran_order\":True,\"descr\":\"|u1\"}",
        &[1, 4, 2, 5, 3, 6],
        "[2, 3] [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]",
    );
    let mut version_2 = b"\x93NUMPY\x02\x00".to_vec();
    version_2.extend((of("|u1", "(1,)").len() as u32).to_le_bytes());
    version_2.extend(of("|u1", "(1,)").as_bytes());
    version_2.push(9);
    let npz = open(member("a.npy", &version_2)).unwrap();
    assert_eq!(npz.get_u8("a").unwrap().data, [9]);
    assert_eq!(open(member("notes.txt", b"text")).unwrap().arrays().count(), 0);
}

#[test]
fn damaged_arrays_are_refused_by_name() {
    let a = "a.npz: array `a`: ";
    check(
        &of("<f8", "(2,)"),
        &[0; 8],
        &format!("{a}holds fewer than the 16 bytes of its shape [2]"),
    );
    check(
        &of("<f8", "(1,)"),
        &[0; 9],
        &format!("{a}holds more than the 8 bytes of its shape [1]"),
    );
    check(
        &of("<f8", "(999999999999,)"),
        &[0; 8],
        &format!("{a}shape [999999999999] needs more than 1073741824 bytes"),
    );
    let huge = "(4294967296, 4294967296, 4294967296)";
    let lengths = "[4294967296, 4294967296, 4294967296]";
    check(
        &of("|u1", huge),
        &[0; 8],
        &format!("{a}shape {lengths} needs more than 1073741824 bytes"),
    );
    // Bytes that would fit, but not as f64.
    check(
        &of("|u1", "(200000000,)"),
        &[0; 8],
        &format!("{a}shape [200000000] needs more than 1073741824 bytes"),
    );
}

#[test]
fn damaged_headers_are_refused_by_name() {
    let a = "a.npz: array `a`: ";
    check(
        &of("|O", "(1,)"),
        &[0; 8],
        &format!("{a}numbers of type |O are not supported"),
    );
    let fields = "{'descr': [('x', '<f8', (2,))], 'fortran_order': False, 'shape': (1,), }";
    check(
        fields,
        &[0; 16],
        &format!("{a}numbers of type [('x', '<f8', (2,))] are not supported"),
    );
    let no_dictionary = [
        "",
        "{",
        "{}",
        "None",
        "{'descr': '<f8', 'fortran_order': False, }",
        "{'descr': '<f8', 'fortran_order': 0, 'shape': (1,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999999,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1 2), }",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (1,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), 'more': 1, }",
        "{'descr': [[[, 'fortran_order': False, 'shape': (1,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), } x",
    ];
    for dictionary in no_dictionary {
        check(
            dictionary,
            &[0; 8],
            &format!("{a}the header is not the dictionary of an npy file"),
        );
    }
    let error = |data: &[u8]| open(member("a.npy", data)).map(drop).unwrap_err().to_string();
    assert_eq!(error(b"no numpy file"), format!("{a}does not begin like an npy file"));
    assert_eq!(error(b"\x93NUMPY\x07\x00\x00\x00"), format!("{a}unknown npy version 7"));
    assert!(error(b"\x93NUMPY\x01\x00\xff").starts_with(&format!("{a}header cut short")));
    assert_eq!(
        error(b"\x93NUMPY\x02\x00\xff\xff\xff\xff"),
        format!("{a}the header has 4294967295 bytes; the limit is 16384")
    );
}

#[test]
fn what_cannot_be_written_is_refused() {
    let mut writer = NpzWriter::new();
    writer.add("a", &[1], &[1.0]).unwrap();
    let mut refused = |name: &str, shape: &[usize]| writer.add(name, shape, &[1.0]).unwrap_err().to_string();
    assert_eq!(refused("a", &[1]), "cannot write array `a`: this name is already used");
    assert_eq!(
        refused("b", &[2]),
        "cannot write array `b`: 1 numbers do not have the shape [2]"
    );
    assert_eq!(
        refused("c", &[usize::MAX, 2]),
        format!(
            "cannot write array `c`: 1 numbers do not have the shape [{}, 2]",
            usize::MAX
        )
    );
    for name in ["", "../a", "a\\b", "a\n"] {
        assert!(
            refused(name, &[1]).contains("a name must have 1 to 1000 bytes"),
            "{name}"
        );
    }
}

#[test]
fn a_file_is_replaced_whole_and_leaves_nothing_beside_it() {
    let folder = std::env::temp_dir().join(format!("babybench-npz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("log.npz");
    std::fs::write(folder.join(".log.npz.0.tmp"), b"left by a killed process").unwrap();
    for round in 0..2 {
        let mut writer = NpzWriter::new();
        writer.add("round", &[], &[round]).unwrap();
        writer.write(&path).unwrap();
        assert_eq!(
            Npz::open(&path).unwrap().get_i64("round").unwrap().data,
            [i64::from(round)]
        );
    }
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
    std::fs::remove_dir_all(&folder).unwrap();
    for error in [every_type().write(&path), Npz::open(&path).map(drop)] {
        assert!(
            matches!(&error, Err(NpzError::Io { file, .. }) if file.ends_with("log.npz")),
            "{error:?}"
        );
    }
}

#[test]
fn damaged_files_never_panic_nor_read_wrong_numbers() {
    let good = every_type().finish().unwrap();
    let mut random = 0x2545_f491_4f6c_dd1d_u64;
    let mut next = |below: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % below as u64) as usize
    };
    let whole = open(good.clone()).unwrap();
    let mut refused = 0;
    for _ in 0..3000 {
        let mut bytes = good.clone();
        match next(3) {
            0 => bytes.truncate(next(bytes.len())),
            1 => drop(bytes.drain(next(good.len() / 2)..next(good.len() / 2) + good.len() / 2)),
            _ => {
                for _ in 0..=next(3) {
                    let at = next(bytes.len());
                    bytes[at] ^= 1 << next(8);
                }
            }
        }
        let Ok(npz) = open(bytes) else {
            refused += 1;
            continue;
        };
        for array in npz.arrays() {
            // The checksum guards the data, so what still reads is right (its name may have changed).
            match (npz.get_f64(&array.name), whole.get_f64(&array.name)) {
                (Ok(read), Ok(original)) => assert_eq!(read, original),
                (Err(_), _) => refused += 1,
                (Ok(_), Err(_)) => {}
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}

/// Each limit that a caller sets takes effect.
#[test]
fn limits_are_the_callers() {
    let mut writer = NpzWriter::new();
    writer.add("a", &[2], &[1.0, 2.0]).unwrap();
    writer.add("b", &[1], &[1_i64]).unwrap();
    let bytes = writer.finish().unwrap();
    let read = |limits: Limits| {
        let npz = Npz::from_bytes_with(bytes.clone(), "a.npz", &limits)?;
        npz.get_f64("a").map(|array| array.data)
    };
    let told = |limits: Limits| read(limits).unwrap_err().to_string();
    let default = Limits::default;
    assert_eq!(read(default()).unwrap(), [1.0, 2.0]);
    let few = told(Limits {
        npz_arrays: 1,
        ..default()
    });
    assert!(few.ends_with("more than 1 arrays"), "{few}");
    let header = told(Limits {
        npz_header_bytes: 10,
        ..default()
    });
    assert!(header.ends_with("the limit is 10"), "{header}");
    let array = told(Limits {
        npz_array_bytes: 15,
        ..default()
    });
    assert!(array.ends_with("needs more than 15 bytes"), "{array}");
    let path = std::env::temp_dir().join(format!("babybench_npz_limits_{}.npz", std::process::id()));
    std::fs::write(&path, &bytes).unwrap();
    let file = Npz::open_with(
        &path,
        &Limits {
            npz_bytes: 20,
            ..default()
        },
    );
    std::fs::remove_file(&path).unwrap();
    assert!(file.unwrap_err().to_string().ends_with("more than 20 bytes"));
}

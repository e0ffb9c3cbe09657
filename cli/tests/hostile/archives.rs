//! NumPy archives: recordings that are replayed.

use crate::bytes::{array, npy, zip};
use crate::case::{Case, Content};
use crate::runs::quick;

fn case(name: &str, archive: impl Into<Content>) -> Case {
    quick(
        format!("archive: {name}"),
        "replay --config c.yml --recording r.npz --out o",
    )
    .file("r.npz", archive)
}

/// An archive whose first array is this.
fn first(name: &str, positions: Vec<u8>) -> Case {
    case(
        name,
        zip(&[
            ("actions.npy", array("<f4", "(1, 44)", &[0; 176])),
            ("qpos0.npy", positions),
        ]),
    )
}

/// A header with these parts.
fn header(descr: &str, order: &str, shape: &str) -> Vec<u8> {
    npy(
        &format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}"),
        &[0; 64],
    )
}

pub fn cases() -> Vec<Case> {
    let sound = zip(&[
        ("actions.npy", array("<f4", "(1, 44)", &[0; 176])),
        ("qpos0.npy", array("<f8", "(3,)", &[0; 24])),
    ]);
    let end = sound.len() - 22;
    let changed = |at: usize, bytes: &[u8]| {
        let mut out = sound.clone();
        out[at..at + bytes.len()].copy_from_slice(bytes);
        out
    };
    let nan = |n: usize| f64::NAN.to_le_bytes().repeat(n);
    // MIMo v1 on the floor: 54 positions of 53 degrees of freedom, 44 actions
    let whole = |qpos: Vec<u8>, actions: Vec<u8>| {
        zip(&[
            ("qpos0.npy", array("<f8", "(54,)", &qpos)),
            ("qvel0.npy", array("<f8", "(53,)", &[0; 424])),
            ("actions.npy", array("<f4", "(1, 44)", &actions)),
        ])
    };
    vec![
        case("empty", ""),
        case("text", "no archive"),
        case("pickle", b"\x80\x04]."),
        case("only the end", b"PK\x05\x06\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"),
        case("cut in the middle", &sound[..sound.len() / 2]),
        case("cut before its end", &sound[..end]),
        case("cut in its end", &sound[..end + 10]),
        case("directory beyond the file", changed(end + 16, &[0xff; 4])),
        case("more files than there are", changed(end + 8, &[0xff; 4])),
        case("directory of 4 GB", changed(end + 12, &[0xff; 4])),
        case("wrong checksum", changed(100, b"\x01")),
        case(
            "array longer than the file",
            changed(18, &[0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0x7f]),
        ),
        case("compressed by an unknown method", changed(8, b"\x63\x00")),
        case("65,536 arrays and more", zip(&vec![("a.npy", Vec::new()); 65_000])),
        case("no arrays", zip(&[("readme.txt", b"hello".to_vec())])),
        case(
            "array twice",
            zip(&[
                ("qpos0.npy", array("<f8", "(1,)", &[0; 8])),
                ("qpos0.npy", array("<f8", "(2,)", &[0; 16])),
            ]),
        ),
        case(
            "name with escape sequences",
            zip(&[("\u{1b}[2J.npy", array("<f8", "(1,)", &[0; 8]))]),
        ),
        case(
            "name above the folder",
            zip(&[("../../qpos0.npy", array("<f8", "(1,)", &[0; 8]))]),
        ),
        first("no header", b"\x93NUMPY".to_vec()),
        first("other magic", b"NUMPY\x93\x01\x00\x00\x00".to_vec()),
        first("version 9", b"\x93NUMPY\x09\x00\x02\x00{}".to_vec()),
        first("header longer than the array", b"\x93NUMPY\x01\x00\xff\xff{}".to_vec()),
        first("header of 4 GB", b"\x93NUMPY\x02\x00\xff\xff\xff\xff{}".to_vec()),
        first("header that is not a dictionary", npy("[1, 2]", &[])),
        first("header that is open", npy("{'descr': '<f8'", &[])),
        first(
            "header without a shape",
            npy("{'descr': '<f8', 'fortran_order': False}", &[]),
        ),
        first(
            "header with another key",
            npy(
                "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), 'x': 1}",
                &[0; 8],
            ),
        ),
        first(
            "header of nested tuples",
            npy(&format!("{{'shape': {}", "(".repeat(10_000)), &[]),
        ),
        first("objects", header("'|O'", "False", "(1,)")),
        first("array of text", header("'<U8'", "False", "(1,)")),
        first("complex numbers", header("'<c16'", "False", "(1,)")),
        first("structure", header("[('a', '<f8')]", "False", "(1,)")),
        first("numbers of 3 bytes", header("'<f3'", "False", "(1,)")),
        first("negative shape", header("'<f8'", "False", "(-1,)")),
        first("shape of numbers with a point", header("'<f8'", "False", "(1.5,)")),
        first(
            "shape beyond 64 bits",
            header("'<f8'", "False", "(99999999999999999999,)"),
        ),
        first(
            "shape whose product overflows",
            header("'<f8'", "False", "(4294967296, 4294967296)"),
        ),
        first(
            "shape of nothing, 10^18 times",
            header("'<f8'", "False", "(1000000000000000000, 0)"),
        ),
        first("shape of a terabyte", header("'<f8'", "False", "(137438953472,)")),
        first(
            "shape of 33 dimensions",
            header("'<f8'", "False", &format!("({})", "1,".repeat(33))),
        ),
        first(
            "shape of 1,000 dimensions",
            header("'<f8'", "False", &format!("({})", "1,".repeat(1000))),
        ),
        first("fewer numbers than its shape", array("<f8", "(54,)", &[0; 8])),
        first("more numbers than its shape", array("<f8", "(1,)", &[0; 80])),
        first("order that is neither", header("'<f8'", "Maybe", "(1,)")),
        first("positions of another model", array("<f8", "(3,)", &[0; 24])),
        first("positions in two dimensions", array("<f8", "(1, 54)", &[0; 432])),
        case("no actions", zip(&[("qpos0.npy", array("<f8", "(54,)", &[0; 432]))])),
        case(
            "actions of another model",
            zip(&[("actions.npy", array("<f4", "(1, 3)", &[0; 12]))]),
        ),
        case(
            "actions of one dimension",
            zip(&[("actions.npy", array("<f4", "(44,)", &[0; 176]))]),
        ),
        case(
            "10^18 steps of no numbers",
            zip(&[("actions.npy", header("'<f8'", "False", "(1000000000000000000, 0)"))]),
        ),
        case("positions nan", whole(nan(54), vec![0; 176])),
        case("all positions zero, quaternions too", whole(vec![0; 432], vec![0; 176])),
        case(
            "positions beyond all bounds",
            whole(1e300f64.to_le_bytes().repeat(54), vec![0; 176]),
        ),
        case(
            "actions nan",
            whole(1f64.to_le_bytes().repeat(54), f32::NAN.to_le_bytes().repeat(44)),
        ),
        case("a device", Content::Link("/dev/zero")),
        case("a pipe", Content::Pipe),
        case("5 GiB of zeros", Content::Zeros(5 << 30)),
        case("3 GiB of zeros", Content::Zeros(3 << 30)),
    ]
}

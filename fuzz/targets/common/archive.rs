//! Archives that are nearly recordings.

use babybench::Env;

/// An array of an archive: name, shape, numbers.
type Entry = (&'static str, Vec<usize>, Vec<f64>);

/// Makes a recording of at most two steps, with numbers from `data` added to those of the current state. It may have several episodes.
pub fn from(data: &[u8], env: &Env) -> Vec<u8> {
    let (model, state) = (env.model(), env.state());
    let (na, mut bytes) = (env.action_space().len(), data.iter().copied());
    let mut byte = || bytes.next().unwrap_or(0);
    let kind = byte();
    let steps = usize::from(kind % 3);
    // every power of ten, and what is not a number
    let mut number = || match byte() {
        0 => 0.0,
        1 => f64::NAN,
        2 => f64::INFINITY,
        n => 10f64.powi(i32::from(n) - 128) * (f64::from(byte()) - 128.0),
    };
    let mut some = |start: &[f64]| -> Vec<f64> { start.iter().map(|v| v + number()).collect() };
    let rows = |row: &[f64]| row.repeat(steps);
    let mut arrays: Vec<Entry> = vec![
        ("qpos0", vec![model.nq], some(&state.qpos)),
        ("qvel0", vec![model.nv], some(&state.qvel)),
        ("actions", vec![steps, na], some(&vec![0.0; steps * na])),
        ("qpos", vec![steps, model.nq], some(&rows(&state.qpos))),
        ("qvel", vec![steps, model.nv], some(&rows(&state.qvel))),
    ];
    if kind & 0x40 != 0 {
        let muscles = state.act.len();
        arrays.extend([
            ("activity0", vec![muscles], some(&state.act)),
            ("qacc", vec![steps, model.nv], some(&rows(&state.qacc))),
            ("activity", vec![steps, muscles], some(&rows(&state.act))),
        ]);
    }
    if kind & 0x80 != 0 {
        let (goal, ball) = (env.goal().desired.len(), [0.05, 0.2, 2e-4, 2e-4, 2e-4, 5.0, 500.0]);
        arrays.extend([
            ("reset_row", vec![steps], (0..steps).map(|k| k as f64).collect()),
            ("reset_qpos", vec![steps, model.nq], some(&rows(&state.qpos))),
            ("reset_qvel", vec![steps, model.nv], some(&rows(&state.qvel))),
            ("reset_warm", vec![steps, model.nv], some(&rows(&state.qacc))),
            ("reset_desired_goal", vec![steps, goal], some(&vec![0.1; steps * goal])),
            ("reset_ball", vec![steps, ball.len()], some(&rows(&ball))),
        ]);
    }
    stored(&arrays)
}

/// Writes an archive without compression, which costs less than reading it.
fn stored(arrays: &[Entry]) -> Vec<u8> {
    let (mut out, mut directory) = (Vec::new(), Vec::new());
    for (name, shape, values) in arrays {
        let at = out.len() as u32;
        let name = format!("{name}.npy");
        let bytes = array(shape, values, name == "reset_row.npy");
        let mut about = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
        for number in [crc32(&bytes), bytes.len() as u32, bytes.len() as u32] {
            about.extend(number.to_le_bytes());
        }
        about.extend((name.len() as u32).to_le_bytes());
        out.extend(b"PK\x03\x04");
        out.extend(&about);
        out.extend(name.as_bytes());
        out.extend(bytes);
        directory.extend(b"PK\x01\x02\x14\0");
        directory.extend(&about);
        directory.extend([0; 10]);
        directory.extend(at.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let count = (arrays.len() as u16).to_le_bytes();
    let (at, length) = ((out.len() as u32).to_le_bytes(), (directory.len() as u32).to_le_bytes());
    out.extend(directory);
    out.extend(b"PK\x05\x06\0\0\0\0");
    out.extend([count, count].concat());
    out.extend([length, at].concat());
    out.extend([0; 2]);
    out
}

/// Writes an array as NumPy does.
fn array(shape: &[usize], values: &[f64], whole: bool) -> Vec<u8> {
    let (dtype, lengths) = (if whole { "<i8" } else { "<f8" }, shape.iter().map(|n| format!("{n},")));
    let shape: String = lengths.collect();
    let header = format!("{{'descr': '{dtype}', 'fortran_order': False, 'shape': ({shape}), }}\n");
    let mut out = b"\x93NUMPY\x01\0".to_vec();
    out.extend((header.len() as u16).to_le_bytes());
    out.extend(header.as_bytes());
    for &value in values {
        out.extend(if whole {
            (value as i64).to_le_bytes()
        } else {
            value.to_le_bytes()
        });
    }
    out
}

/// The checksum of an entry of an archive.
fn crc32(bytes: &[u8]) -> u32 {
    const TABLE: [u32; 256] = {
        let mut table = [0; 256];
        let mut k = 0;
        while k < 256 {
            let (mut value, mut bit) = (k as u32, 0);
            while bit < 8 {
                value = if value & 1 == 1 {
                    0xedb8_8320 ^ value >> 1
                } else {
                    value >> 1
                };
                bit += 1;
            }
            table[k] = value;
            k += 1;
        }
        table
    };
    !bytes
        .iter()
        .fold(!0, |sum, byte| TABLE[usize::from(sum as u8 ^ byte)] ^ sum >> 8)
}

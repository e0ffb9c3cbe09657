//! Archives that are nearly recordings.

use babybench::Env;
use babybench::formats::npz::NpzWriter;

/// Makes a recording of at most two steps, with numbers out of `data` added to those of the present state.
pub fn from(data: &[u8], env: &Env) -> Vec<u8> {
    let (model, state) = (env.model(), env.state());
    let (na, mut bytes) = (env.action_space().len(), data.iter().copied());
    let mut byte = || bytes.next().unwrap_or(0);
    let steps = usize::from(byte() % 3);
    // every power of ten, and what is no number
    let mut number = || match byte() {
        0 => 0.0,
        1 => f64::NAN,
        2 => f64::INFINITY,
        n => 10f64.powi(i32::from(n) - 128) * (f64::from(byte()) - 128.0),
    };
    let mut some = |start: &[f64]| -> Vec<f64> { start.iter().map(|v| v + number()).collect() };
    let rows = |row: &[f64]| row.repeat(steps);
    let arrays: [(&str, Vec<usize>, Vec<f64>); 5] = [
        ("qpos0", vec![model.nq], some(&state.qpos)),
        ("qvel0", vec![model.nv], some(&state.qvel)),
        ("actions", vec![steps, na], some(&vec![0.0; steps * na])),
        ("qpos", vec![steps, model.nq], some(&rows(&state.qpos))),
        ("qvel", vec![steps, model.nv], some(&rows(&state.qvel))),
    ];
    let mut writer = NpzWriter::new();
    for (name, shape, values) in &arrays {
        writer.add(name, shape, values).expect("an array");
    }
    writer.finish().expect("an archive")
}

//! NumPy archives. The length of every array matches its shape.
#![no_main]

use babybench::Limits;
use babybench::formats::npz::{Array, Npz, NpzError};
use libfuzzer_sys::fuzz_target;

fn check<T>(array: Result<Array<T>, NpzError>) {
    match array {
        Ok(array) => {
            let product = array.shape.iter().try_fold(1usize, |n, &k| n.checked_mul(k));
            assert_eq!(product, Some(array.data.len()));
        }
        Err(e) => assert!(e.to_string().starts_with("f.npz"), "{e}"),
    }
}

fuzz_target!(|data: &[u8]| {
    // small arrays: filling a gibibyte hides everything else
    let limits = Limits {
        npz_array_bytes: 1 << 20,
        ..Limits::default()
    };
    let npz = match Npz::from_bytes_with(data.to_vec(), "f.npz", &limits) {
        Ok(npz) => npz,
        Err(e) => return assert!(e.to_string().starts_with("f.npz"), "{e}"),
    };
    let names: Vec<String> = npz.arrays().take(8).map(|a| a.name.clone()).collect();
    for name in &names {
        check(npz.get_f64(name));
        check(npz.get_i64(name));
        check(npz.get_u8(name));
    }
});

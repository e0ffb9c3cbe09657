//! Prints checksums of short episodes, to compare with those of another target.
//!
//! ```sh
//! cargo run --release --example checksum
//! cargo build --release --example checksum_wasm --target wasm32-unknown-unknown
//! node examples/checksum/run.mjs target/wasm32-unknown-unknown/release/examples/checksum_wasm.wasm
//! ```

mod episode;

fn main() {
    for (index, (name, _)) in episode::CONFIGURATIONS.iter().enumerate() {
        for steps in [0, 10, 60] {
            println!("{name} {steps} {:016x}", episode::checksum(index, steps));
        }
    }
}

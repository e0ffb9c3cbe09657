//! Nothing: without it the features of `[build-dependencies]` would not count.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
}

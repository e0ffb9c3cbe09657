//! Bounds the memory of the module, so that larger requests fail with an error instead of crashing the browser.

/// Largest memory that the module may take, bytes. Scenes need 20 to 60 MB; many environments more.
const MAX_MEMORY: u32 = 1 << 30;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|arch| arch == "wasm32") {
        println!("cargo::rustc-link-arg-cdylib=--max-memory={MAX_MEMORY}");
    }
}

//! Meshes in the format of this name, as `common/mesh.rs` says.
#![no_main]

use babybench::formats::mesh::MeshFormat;
use libfuzzer_sys::fuzz_target;

#[path = "common/mesh.rs"]
mod mesh;

fuzz_target!(|data: &[u8]| mesh::check(data, MeshFormat::Stl, "a.stl"));

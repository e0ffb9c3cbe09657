//! Meshes in the format of this name: what is read names what is there, takes memory in proportion to the file, and makes a model or an
//! error that names the file.
#![no_main]

use babybench::Limits;
use babybench::formats::mesh::{MeshFormat, NONE, Triangles};
use libfuzzer_sys::fuzz_target;

#[path = "common/mesh.rs"]
mod mesh;

fuzz_target!(|data: &[u8]| {
    let limits = Limits {
        mesh_elements: 1 << 16,
        ..Limits::default()
    };
    let Ok(read) = Triangles::read(data, MeshFormat::Stl, data.len() % 2 == 1, &limits) else {
        return;
    };
    assert!(read.elements() <= limits.mesh_elements);
    let within = |corners: &[[u32; 3]], count: usize, may_lack: bool| {
        let mut all = corners.as_flattened().iter();
        all.all(|&i| (i as usize) < count || may_lack && i == NONE)
    };
    assert!(within(&read.face, read.vert.len(), false));
    assert!(within(&read.facenormal, read.normal.len(), true));
    assert!(within(&read.facetexcoord, read.texcoord.len(), true));
    mesh::compile(data, "a.stl");
});

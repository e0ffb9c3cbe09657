//! Meshes. What is read refers only to existing vertices, takes memory in proportion to the file, and makes a model or an error that
//! names the file.

use babybench::assets::MemoryAssets;
use babybench::formats::mesh::{MeshFormat, NONE, Triangles};
use babybench::render::Scenery;
use babybench::{Limits, mjcf_loader, physics};

/// Larger files are skipped, because their cost hides that of others.
const LARGE: usize = 1 << 14;

/// Reads a file, and compiles a model of it.
pub fn check(data: &[u8], format: MeshFormat, name: &str) {
    let limits = Limits {
        mesh_elements: 1 << 16,
        ..Limits::default()
    };
    // the length decides about a flag, so that both ways are tried
    let Ok(read) = Triangles::read(data, format, data.len() % 2 == 1, &limits) else {
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
    compile(data, name);
}

/// Compiles a document with the mesh, solid and touching.
fn compile(file: &[u8], name: &str) {
    if file.len() > LARGE {
        return;
    }
    let mut assets = MemoryAssets::new();
    assets.insert(name, file).expect("a plain name");
    let text = format!(
        "<mujoco><asset><mesh name='m' file='{name}'/></asset><worldbody><geom type='plane' size='1 1 1'/>
         <body><freejoint/><geom type='mesh' mesh='m'/></body></worldbody></mujoco>"
    );
    let model = match mjcf_loader::load_str(&text, "m.xml", &assets).and_then(physics::compile) {
        Ok(model) => model,
        Err(e) => {
            let said = e.to_string();
            assert!(said.contains("m.xml") && said.len() < 1000, "{said}");
            assert!(!said.chars().any(char::is_control), "{said:?}");
            return;
        }
    };
    let numbers = model
        .body_inertia
        .iter()
        .chain(&model.geom_pos)
        .flatten()
        .chain(&model.body_mass);
    assert!(numbers.into_iter().all(|v| v.is_finite()), "a number is not finite");
    let _ = Scenery::new(&model, &assets);
}

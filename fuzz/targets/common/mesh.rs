//! A model of one mesh.

use babybench::assets::MemoryAssets;
use babybench::render::Scenery;
use babybench::{mjcf_loader, physics};

/// Larger files are left alone: their cost hides others.
const LARGE: usize = 1 << 14;

/// Compiles a document with the mesh, solid and touching.
pub fn compile(file: &[u8], name: &str) {
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

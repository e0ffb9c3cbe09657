//! Heights in both formats. What is read has the announced number of values, within the limits, and makes a model or an error that names
//! the document.
#![no_main]

use babybench::assets::MemoryAssets;
use babybench::formats::heights::{HeightFormat, Heights};
use babybench::render::Scenery;
use babybench::{Limits, mjcf_loader, physics};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let limits = Limits {
        mesh_elements: 1 << 16,
        ..Limits::default()
    };
    let (name, format) = if data.starts_with(b"\x89PNG") {
        ("a.png", HeightFormat::Png)
    } else {
        ("a.hf", HeightFormat::Custom)
    };
    let Ok(read) = Heights::read(data, format, &limits) else {
        return;
    };
    assert!(read.data.len() <= limits.mesh_elements);
    assert_eq!(read.data.len(), read.nrow * read.ncol);
    assert!(read.data.iter().all(|v| v.is_finite()));
    let mut assets = MemoryAssets::new();
    assets.insert(name, data).expect("a plain name");
    let text = format!(
        "<mujoco><asset><hfield name='h' file='{name}' size='1 1 .2 .1'/></asset><worldbody><geom type='hfield' hfield='h'/>
         <body pos='0 0 .1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>"
    );
    let model = match mjcf_loader::load_str(&text, "m.xml", &assets).and_then(physics::compile) {
        Ok(model) => model,
        Err(e) => {
            let said = e.to_string();
            assert!(said.contains("m.xml") && said.len() < 1000, "{said}");
            return;
        }
    };
    assert!(
        model.hfields[0].data.iter().all(|v| (0.0..=1.0).contains(v)),
        "heights are not scaled"
    );
    let _ = Scenery::new(&model, &assets);
});

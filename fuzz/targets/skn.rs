//! Skins in MuJoCo's format: what is read takes memory in proportion to the file, and makes a model that can be drawn, or an error that
//! names the document.
#![no_main]

use babybench::assets::MemoryAssets;
use babybench::formats::skn::SkinFile;
use babybench::physics::{Engine, SoftEngine, SoftOptions};
use babybench::render::{Poses, RenderRequest, Renderer, Scenery, View};
use babybench::{Limits, mjcf_loader, physics};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = SkinFile::read(data) else { return };
    assert!(read.elements() <= data.len(), "more than a number for each byte");
    assert!(read.bones.iter().all(|bone| bone.vertid.len() == bone.vertweight.len()));
    // the length decides, so that both ways are tried
    let inflate = if data.len() % 2 == 1 { "0" } else { ".01" };
    let text = format!(
        "<mujoco><asset><skin name='s' file='a.skn' inflate='{inflate}'/></asset><worldbody><camera name='c' pos='0 0 3'/>
         <body name='a'><freejoint/><geom size='.1'/><body name='b' pos='.2 0 0'><joint/><geom size='.1'/></body></body></worldbody></mujoco>"
    );
    let mut assets = MemoryAssets::new();
    assets.insert("a.skn", data).expect("a plain name");
    let model = match mjcf_loader::load_str(&text, "m.xml", &assets).and_then(physics::compile) {
        Ok(model) => model,
        Err(e) => {
            let said = e.to_string();
            assert!(said.contains("m.xml") && said.len() < 1000, "{said}");
            assert!(!said.chars().any(char::is_control), "{said:?}");
            return;
        }
    };
    assert!(read.elements() <= Limits::default().mesh_elements);
    let scenery = Scenery::new(&model, &assets).expect("nothing else is drawn");
    let view = View {
        camera: model.camera("c").expect("it is there"),
        width: 16,
        height: 16,
    };
    let mut engine = SoftEngine::new(model.into(), SoftOptions::default());
    let mut state = engine.new_state();
    engine.forward(&mut state).expect("two balls");
    let mut image = vec![0; view.rgb_len()];
    let poses = Poses::from(&state);
    let mut renderer = Renderer::cpu(scenery.into());
    renderer
        .rgb(&[RenderRequest { poses, view }], [&mut image[..]])
        .expect("a picture");
});

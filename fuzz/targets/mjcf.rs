//! MJCF with an include and a picture: documents are separated by a zero byte. What loads is compiled and made ready to be
//! drawn, and all its numbers are finite; what is refused names its file.
#![no_main]

use babybench::assets::MemoryAssets;
use babybench::render::Scenery;
use babybench::{mjcf_loader, physics};
use libfuzzer_sys::fuzz_target;

/// Larger models are skipped, because their cost hides that of others.
const LARGE: usize = 200;

fuzz_target!(|data: &[u8]| {
    let mut parts = data.splitn(3, |&byte| byte == 0);
    let mut part = || parts.next().unwrap_or_default();
    let Ok(text) = std::str::from_utf8(part()) else { return };
    let mut assets = MemoryAssets::new();
    for (name, bytes) in [("other.xml", part()), ("a.png", part())] {
        assets.insert(name, bytes).expect("a plain name");
    }
    let check = |e: mjcf_loader::LoadError| {
        let said = e.to_string();
        // Any of the three can be at fault: a document may include the picture too.
        assert!(
            ["m.xml", "other.xml", "a.png"].iter().any(|file| said.contains(file)),
            "{said}"
        );
        assert!(said.len() < 4000 && !said.contains("Some("), "{said}");
        assert!(!said.chars().any(char::is_control), "{said:?}");
    };
    let spec = match mjcf_loader::load_str(text, "m.xml", &assets) {
        Ok(spec) if spec.nv() < LARGE && spec.nbody() < LARGE => spec,
        Ok(_) => return,
        Err(e) => return check(e),
    };
    let model = match physics::compile(spec) {
        Ok(model) => model,
        Err(e) => return check(e),
    };
    let triples = [
        &model.body_ipos,
        &model.body_pos,
        &model.geom_size,
        &model.geom_pos,
        &model.jnt_axis,
    ];
    let numbers = triples.into_iter().flat_map(|list| list.as_flattened());
    let more = [
        &model.body_mass,
        &model.geom_rbound,
        &model.qpos0,
        &model.dof_invweight0,
    ];
    let mut numbers = numbers.chain(more.into_iter().flatten());
    assert!(numbers.all(|v| v.is_finite()), "a number is not finite");
    let _ = Scenery::new(&model, &assets);
});

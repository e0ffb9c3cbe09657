//! Input that no one would write: it must be refused or give a sane model, never a panic.

use babybench::Model;
use babybench::assets::{AssetSource, DirAssets, MemoryAssets, Overlay};
use babybench::mjcf_loader::load_str;
use babybench::model::EqualityKind;
use babybench::physics::compile;
use testkit::harness::Trial;
use testkit::mutation::{mutate_document, mutate_text};
use testkit::yardsticks::{KIT, kit_assets, workspace};
use testkit::{Rng, show, trials};

pub fn trials() -> Vec<Trial> {
    [
        trials![
            mutations_of_a_small_document_never_panic,
            mutations_of_our_files_never_panic
        ],
        trials![needs KIT: mutations_of_the_original_files_never_panic],
    ]
    .concat()
}

const SMALL: &str = r#"<mujoco model="m"><compiler angle="degree"/><option timestep="0.01" cone="elliptic"/>
<default><geom friction="1 .1"/><default class="c"><joint damping="1"/><motor ctrlrange="-1 1"/></default></default>
<asset><texture name="t" type="2d" builtin="flat" width="2" height="2"/><material name="m" texture="t"/></asset>
<worldbody><light/><geom type="plane" size="1 1 1" material="m"/><include file="other.xml"/>
<body name="a" childclass="c" euler="10 20 30"><joint name="j" range="-10 20"/><geom name="g" type="capsule"
size=".1" fromto="0 0 0 1 1 1"/><geom type="box" size="1 2 3" mass="2"/><site name="s" size=".1"/>
<body name="b" pos="0 1 0"><inertial pos="0 0 0" mass="1" fullinertia="1 1 1 .1 0 0"/><joint name="k" type="slide"/>
</body></body><body name="f"><freejoint/><geom name="h" size=".5"/><camera mode="targetbody" target="a"/></body>
</worldbody><contact><pair geom1="g" geom2="h"/><exclude body1="a" body2="f"/></contact>
<equality><weld body1="f" body2="b" anchor="1 0 0"/><joint joint1="j" joint2="k"/></equality>
<tendon><fixed name="t" range="-1 1"><joint joint="j" coef="1"/></fixed></tendon>
<actuator><motor class="c" joint="j" user="1"/><position joint="k" kp="3"/></actuator>
<sensor><gyro site="s"/></sensor></mujoco>"#;

/// Asserts that a loaded model is finite, of unit length where it is a direction, and points backwards along the tree.
fn assert_sane(model: &Model) {
    let reals = model
        .body_mass
        .iter()
        .chain(model.body_inertia.iter().flatten())
        .chain(model.body_ipos.iter().flatten());
    assert!(
        reals
            .chain(&model.geom_rbound)
            .chain(&model.qpos0)
            .all(|value| value.is_finite())
    );
    let quats = model
        .body_quat
        .iter()
        .chain(&model.body_iquat)
        .chain(&model.geom_quat)
        .chain(&model.site_quat);
    let unit = |square: f64| (square - 1.0).abs() < 1e-9;
    assert!(
        quats
            .chain(&model.cam_quat)
            .all(|q| unit(q.iter().map(|v| v * v).sum()))
    );
    assert!(model.jnt_axis.iter().all(|axis| unit(axis.iter().map(|v| v * v).sum())));
    for kind in &model.eq_kind {
        if let EqualityKind::Weld { relpos, relquat, .. } = kind {
            // a zero quaternion stands for the pose at `qpos0`
            let square = relquat.iter().map(|v| v * v).sum();
            assert!(relpos.iter().all(|v| v.is_finite()) && (unit(square) || square == 0.0));
        }
    }
    assert!(
        model
            .body_parentid
            .iter()
            .enumerate()
            .all(|(id, &parent)| parent < id.max(1))
    );
    assert_eq!((model.qpos0.len(), model.dof_bodyid.len()), (model.nq, model.nv));
}

/// Damages bytes and, every other time, one thing of a document that stays mostly well-formed.
fn damaged(text: &str, round: usize, rng: &mut Rng) -> String {
    match round % 2 {
        0 => mutate_text(text, rng),
        _ => mutate_document(text, rng),
    }
}

fn mutations_of_a_small_document_never_panic() {
    let mut assets = MemoryAssets::new();
    assets
        .insert("other.xml", "<a><geom size='1'/></a>")
        .expect("a valid name");
    load_str(SMALL, "m.xml", &assets).expect("the document itself loads");
    let mut rng = Rng::with_seed(1);
    let mut loaded = 0;
    for round in 0..4000 {
        let loaded_one = load_str(&damaged(SMALL, round, &mut rng), "m.xml", &assets);
        if let Ok(model) = loaded_one.and_then(compile) {
            assert_sane(&model);
            loaded += 1;
        }
    }
    show!("{loaded} of 4000 mutations load");
    // most mutations are refused, and enough load to show that they reach the compiler
    assert!((300..3700).contains(&loaded), "{loaded}");
}

fn mutations_of_our_files_never_panic() {
    never_panic(&DirAssets::new(workspace().join("assets")).expect("a folder"), 2);
}

fn mutations_of_the_original_files_never_panic() {
    never_panic(&DirAssets::new(kit_assets().expect("needed")).expect("a folder"), 3);
}

fn never_panic(originals: &DirAssets, seed: u64) {
    let scene = "<mujoco><worldbody><body name='mimo_location'><freejoint/><include file='mimo_v2.xml'/>\
                 </body></worldbody><include file='base.xml'/><include file='meta_v2.xml'/><include file='motor_fingers_v2.xml'/>\
                 <include file='cubes.xml'/></mujoco>";
    let files = ["mimo_v2", "base", "meta_v2", "motor_fingers_v2", "cubes"].map(|name| format!("babybench/{name}.xml"));
    load_str(scene, "babybench/scene.xml", originals).expect("the files themselves load");
    let mut rng = Rng::with_seed(seed);
    let mut loaded = 0;
    for round in 0..300 {
        let path = &files[round % files.len()];
        let bytes = originals.read(path).expect("a file of the scene");
        let mut changed = MemoryAssets::new();
        let text = damaged(&String::from_utf8_lossy(&bytes), round, &mut rng);
        changed.insert(path, text).expect("a valid name");
        let source = Overlay::new(originals.clone()).with(changed);
        if let Ok(model) = load_str(scene, "babybench/scene.xml", &source).and_then(compile) {
            assert_sane(&model);
            loaded += 1;
        }
    }
    show!("{loaded} of 300 mutations load");
    assert!((30..270).contains(&loaded), "{loaded}");
}

//! Input that no one would write: it must be refused or give a sane model, never a panic.

use super::*;

/// A small generator, so that a failure can be repeated.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
}

const NASTY: &[&str] = &[
    "nan",
    "-1",
    "1e308",
    "-1e308",
    "1e-320",
    "0",
    "",
    "<",
    ">",
    "\"",
    "'",
    "&",
    "/>",
    "<!--",
    "-->",
    "<body>",
    "</body>",
    "99999999999999999999",
    "\u{0}",
    "\u{fffd}",
    "<include file=\"m.xml\"/>",
    "<default>",
    "auto",
    "\n",
    "<!DOCTYPE",
];

fn mutate(text: &str, random: &mut Random) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..=random.below(3) {
        let at = random.below(bytes.len());
        let end = (at + random.below(12)).min(bytes.len());
        match random.below(10) {
            0 if !bytes.is_empty() => bytes[at] ^= 1 << random.below(8),
            1 => bytes.truncate(at),
            2 => drop(bytes.drain(at..end)),
            3 => drop(bytes.splice(at..end, NASTY[random.below(NASTY.len())].bytes())),
            // A quoted value becomes something else, which gets past the syntax.
            4 => {
                let quotes: Vec<usize> = (at..bytes.len()).filter(|&k| bytes[k] == b'"').take(2).collect();
                if let [from, to] = quotes[..] {
                    drop(bytes.splice(from + 1..to, NASTY[random.below(NASTY.len())].bytes()));
                }
            }
            5 => {
                let copy = bytes[at..end].to_vec();
                let to = random.below(bytes.len());
                drop(bytes.splice(to..to, copy));
            }
            // Another digit, which mostly gets past every check of form.
            _ => {
                if let Some(digit) = bytes[at..].iter_mut().find(|byte| byte.is_ascii_digit()) {
                    *digit = b'0' + random.below(10) as u8;
                }
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
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

/// What loads must be finite, of unit length where it is a direction, and must point backwards along the tree.
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
        if let crate::model::EqualityKind::Weld { relpos, relquat, .. } = kind {
            assert!(relpos.iter().all(|v| v.is_finite()) && unit(relquat.iter().map(|v| v * v).sum()));
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

#[test]
fn mutations_of_a_small_document_never_panic() {
    let mut assets = MemoryAssets::new();
    assets.insert("other.xml", "<a><geom size='1'/></a>").unwrap();
    load_str(SMALL, "m.xml", &assets).unwrap();
    let mut random = Random(1);
    let mut loaded = 0;
    for _ in 0..4000 {
        if let Ok(model) = load_str(&mutate(SMALL, &mut random), "m.xml", &assets) {
            assert_sane(&model);
            loaded += 1;
        }
    }
    // 661 when written: most mutations are refused, and enough load to show that the mutations reach the compiler.
    assert!((100..3900).contains(&loaded), "{loaded}");
}

#[test]
fn mutations_of_the_original_files_never_panic() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/reference/mjcf");
    let Ok(originals) = DirAssets::new(&root) else {
        crate::files::skipped("mutations of the original files", &root);
        return;
    };
    let scene = "<mujoco><worldbody><body name='mimo_location'><freejoint/><include file='mimo_v2.xml'/>\
                 </body></worldbody><include file='base.xml'/><include file='meta_v2.xml'/><include file='motor_fingers_v2.xml'/>\
                 <include file='cubes.xml'/></mujoco>";
    let files = ["mimo_v2", "base", "meta_v2", "motor_fingers_v2", "cubes"].map(|name| format!("babybench/{name}.xml"));
    load_str(scene, "babybench/scene.xml", &originals).unwrap();
    let mut random = Random(2);
    for round in 0..300 {
        let path = &files[round % files.len()];
        let text = String::from_utf8(originals.read(path).unwrap().into_owned()).unwrap();
        let mut changed = MemoryAssets::new();
        changed.insert(path, mutate(&text, &mut random)).unwrap();
        if let Ok(model) = load_str(scene, "babybench/scene.xml", &Overlay::new(vec![&changed, &originals])) {
            assert_sane(&model);
        }
    }
}

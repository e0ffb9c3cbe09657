//! Models that are made of others, by `<asset><model>` and `<attach>`; cables; shells; free bodies whose frames are moved.

use babybench::assets::MemoryAssets;
use babybench::mjcf_loader::{load_str, load_str_with};
use babybench::physics::compile;
use babybench::{Limits, Model};

const ARM: &str = r#"<mujoco model="arm"><compiler angle="radian"/>
    <default><default class="thin"><geom size=".02 .1"/></default></default>
    <asset><material name="red" rgba="1 0 0 1"/></asset>
    <worldbody><body name="arm" pos="1 0 0"><joint name="swing" range="-1 1" ref=".5"/><geom name="bone" class="thin" type="capsule" material="red"/></body>
        <body name="other"><geom size=".1"/></body></worldbody>
    <contact><exclude body1="world" body2="arm"/><exclude body1="arm" body2="other"/></contact>
    <actuator><motor name="pull" joint="swing"/></actuator>
    <sensor><jointpos joint="swing"/><framepos objtype="body" objname="other"/></sensor>
    <keyframe><key name="up" qpos=".25" ctrl="3"/></keyframe></mujoco>"#;

fn assets() -> MemoryAssets {
    let mut assets = MemoryAssets::new();
    assets.insert("parts/arm.xml", ARM).expect("a path");
    assets
}

/// Compiles a document with a body `P` and what `attach` puts into the world.
fn made(attach: &str, rest: &str) -> Result<Model, String> {
    let text = format!(
        r#"<mujoco>{rest}<worldbody><body name="P"><joint name="own"/><geom name="G" size=".1"/></body>{attach}</worldbody>
        <asset><model file="parts/arm.xml"/></asset><keyframe><key name="home"/></keyframe></mujoco>"#
    );
    let spec = load_str(&text, "m.xml", &assets()).map_err(|e| e.to_string())?;
    compile(spec).map_err(|e| e.to_string())
}

const BOTH: &str = r#"<attach model="arm" body="arm" prefix="l_"/>
    <frame pos="0 1 0"><attach model="arm" body="arm" prefix="r_"/></frame>"#;

#[test]
fn a_body_brings_along_what_refers_to_nothing_else() {
    let model = made(BOTH, r#"<actuator><motor name="first" joint="r_swing"/></actuator>"#).expect("attached");
    assert_eq!(model.body_name, ["world", "P", "l_arm", "r_arm"]);
    assert_eq!(
        (model.body_pos[2], model.body_pos[3]),
        ([1.0, 0.0, 0.0], [1.0, 1.0, 0.0])
    );
    // in radians, as their own model says
    assert_eq!((model.jnt_range[2], model.qpos0[2]), ([-1.0, 1.0], 0.5));
    assert_eq!(model.actuator_name, ["first", "l_pull", "r_pull"]);
    // of two sensors one is of a body that stays behind
    assert_eq!(model.nsensor(), 2);
    let keys: Vec<_> = model
        .keys
        .iter()
        .map(|key| (key.name.as_str(), key.qpos.as_slice(), key.ctrl.as_slice()))
        .collect();
    assert_eq!(keys[0], ("home", [0.0, 0.5, 0.5].as_slice(), [0.0; 3].as_slice()));
    assert_eq!(
        keys[1],
        ("l_up", [0.0, 0.25, 0.5].as_slice(), [0.0, 3.0, 0.0].as_slice())
    );
    assert_eq!(
        keys[2],
        ("r_up", [0.0, 0.5, 0.25].as_slice(), [0.0, 0.0, 3.0].as_slice())
    );
}

#[test]
fn what_cannot_be_attached_is_an_error() {
    for (attach, expected) in [
        (
            r#"<attach model="leg" body="arm" prefix=""/>"#,
            r#"there is no model "leg""#,
        ),
        (
            r#"<attach model="arm" body="leg" prefix=""/>"#,
            r#"there is no body "leg""#,
        ),
        (
            r#"<attach model="arm" body="arm"/>"#,
            r#"attribute "prefix" is required"#,
        ),
        (
            r#"<attach model="arm" body="arm" prefix="a"/><attach model="arm" body="other" prefix="a"/>"#,
            "may take for it",
        ),
        (
            r#"<body name="other"/><attach model="arm" body="arm" prefix="a"/>"#,
            "which MuJoCo 3.3.0 may take for it",
        ),
    ] {
        let error = made(attach, "").expect_err(attach);
        assert!(error.contains(expected), "{attach}: {error}");
    }
}

#[test]
fn models_within_models_end() {
    let refused = |text: &str, limits: &Limits| {
        let mut assets = assets();
        assets.insert("m.xml", text).expect("a path");
        load_str_with(text, "m.xml", &assets, limits)
            .err()
            .map(|e| e.to_string())
    };
    let itself = r#"<mujoco><asset><model file="./m.xml"/></asset></mujoco>"#;
    let error = refused(itself, &Limits::default()).expect("a cycle");
    assert!(
        error.ends_with(r#"the model of file "m.xml" cannot be a part of itself"#),
        "{error}"
    );
    let many = r#"<attach model="arm" body="other" prefix=""/>"#.repeat(3);
    let many = format!(r#"<mujoco><asset><model file="parts/arm.xml"/></asset><worldbody>{many}</worldbody></mujoco>"#);
    let limits = Limits {
        elements: 30,
        ..Limits::default()
    };
    let error = refused(&many, &limits).expect("too many");
    assert!(error.ends_with("more than 30 elements of attached models"), "{error}");
    // models in between count, too, and so do the numbers of what comes along each time
    let mut assets = assets();
    let each: String = (0..5)
        .map(|k| format!(r#"<attach model="arm" body="arm" prefix="{k}"/>"#))
        .collect();
    let between = format!(r#"<mujoco><asset><model file="arm.xml"/></asset><worldbody>{each}</worldbody></mujoco>"#);
    assets.insert("parts/between.xml", between.as_str()).expect("a path");
    let mesh = r#"<mujoco model="mesh"><asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset><worldbody><body name="b"/></worldbody></mujoco>"#;
    assets.insert("parts/mesh.xml", mesh).expect("a path");
    let told = |text: &str, limits: &Limits| load_str_with(text, "m.xml", &assets, limits).map_err(|e| e.to_string());
    let both = r#"<mujoco><asset><model name="a" file="parts/between.xml"/><model name="b" file="parts/between.xml"/></asset></mujoco>"#;
    let limits = Limits {
        elements: 80,
        ..Limits::default()
    };
    let one = both.replace(r#"<model name="b" file="parts/between.xml"/>"#, "");
    assert!(told(&one, &limits).is_ok());
    let error = told(both, &limits).expect_err("too many");
    assert!(error.ends_with("elements of attached models"), "{error}");
    let meshes = |count: usize| {
        let each = (0..count).map(|k| format!(r#"<attach model="mesh" body="b" prefix="{k}"/>"#));
        let each: String = each.collect();
        format!(r#"<mujoco><asset><model file="parts/mesh.xml"/></asset><worldbody>{each}</worldbody></mujoco>"#)
    };
    let limits = Limits {
        mesh_elements: 40,
        ..Limits::default()
    };
    assert!(told(&meshes(3), &limits).is_ok());
    let error = told(&meshes(4), &limits).expect_err("too many numbers");
    assert!(
        error.ends_with("more than 40 numbers in assets of attached models"),
        "{error}"
    );
    let none = Limits {
        include_depth: 0,
        ..Limits::default()
    };
    let error = refused(&many, &none).expect("too deep");
    assert!(error.ends_with("more than 0 models within models"), "{error}");
    let mesh = r#"<mujoco><asset><model file="parts/arm.obj"/></asset></mujoco>"#;
    let error = refused(mesh, &Limits::default()).expect("no document");
    assert!(error.contains("a model is an MJCF document"), "{error}");
}

const CABLE: &str = r#"<composite prefix="c" type="cable" curve="s" count="5" size="1" initial="free"><geom type="capsule" size=".02"/>
    <joint kind="main" damping=".1"/></composite>"#;

#[test]
fn a_cable_is_a_chain_of_bodies() {
    let model = made(CABLE, "").expect("a cable");
    assert_eq!(model.body_name[2..], ["cB_first", "cB_1", "cB_2", "cB_last"]);
    assert_eq!((model.nq(), model.nv()), (1 + 7 + 12, 1 + 6 + 9));
    assert_eq!(model.site_name, ["cS_first", "cS_last"]);
    assert_eq!(model.body_pos[3], [0.25, 0.0, 0.0]);
    // the free joint has no damping
    assert_eq!((model.dof_damping[1], model.dof_damping[7]), (0.0, 0.1));
    for (from, to, expected) in [
        ("cable", "grid", "makes only cables"),
        ("count=\"5\"", "count=\"3\"", "a cable of two bodies"),
        ("count=\"5\"", "count=\"5 5\"", "one dimension"),
        ("count=\"5\"", "count=\"20000\"", "at most 1001 points"),
        ("curve=\"s\"", "curve=\"s tan(s)\"", "the parts of a curve"),
        ("capsule", "sphere", "capsules, cylinders or boxes"),
    ] {
        let error = made(&CABLE.replace(from, to), "").expect_err(to);
        assert!(error.contains(expected), "{to}: {error}");
    }
    let limits = Limits {
        bodies: 5,
        ..Limits::default()
    };
    let text = format!(
        "<mujoco><worldbody>{}{CABLE}</worldbody></mujoco>",
        CABLE.replace("\"c\"", "\"d\"")
    );
    let error = load_str_with(&text, "m.xml", &assets(), &limits).expect_err("many cables");
    assert!(error.to_string().ends_with("more than 5 bodies"), "{error}");
    let copies = format!("<replicate count=\"2\">{}</replicate>", CABLE.replace("free", "none"));
    let error = made(&copies, "").expect_err("lost");
    assert!(error.contains("put a body around it"), "{error}");
}

/// A skin that is divided has vertices on curves through the ends of the boxes, and is no larger than the limits allow.
#[test]
fn the_skin_of_a_cable_is_divided() {
    let cable = |subgrid: &str| {
        let skin = format!("<skin texcoord=\"true\" subgrid=\"{subgrid}\"/></composite>");
        let boxes = CABLE.replace(r#"type="capsule" size=".02""#, r#"type="box" size=".1 .02 .02""#);
        boxes.replace("</composite>", &skin)
    };
    for (subgrid, vertices) in [("-1", 20), ("0", 20), ("1", 2 * 9 * 5), ("2", 2 * 13 * 7)] {
        let model = made(&cable(subgrid), "").expect(subgrid);
        let skin = &model.skins[0];
        assert_eq!(
            (skin.vert.len(), skin.texcoord.len()),
            (vertices, vertices),
            "{subgrid}"
        );
        // it is closed
        assert_eq!(skin.face.len(), 2 * vertices - 4, "{subgrid}");
        let mut total = vec![0.0; vertices];
        for bone in &skin.bones {
            for (&vertex, weight) in bone.vertid.iter().zip(&bone.vertweight) {
                total[vertex as usize] += weight;
            }
        }
        assert!(
            total.iter().all(|sum| (sum - 1.0_f32).abs() < 1e-6),
            "{subgrid}: {total:?}"
        );
    }
    for subgrid in ["2000", "2147483647"] {
        let error = made(&cable(subgrid), "").expect_err(subgrid);
        assert!(
            error.ends_with("more than 4194304 vertices, texture coordinates, faces and weights of skins"),
            "{error}"
        );
    }
    let few = Limits {
        mesh_elements: 3000,
        ..Limits::default()
    };
    let text = format!(
        "<mujoco><worldbody>{}{}</worldbody></mujoco>",
        cable("2"),
        cable("2").replace("prefix=\"c\"", "prefix=\"d\"")
    );
    let error = load_str_with(&text, "m.xml", &assets(), &few).expect_err("two skins");
    assert!(error.to_string().ends_with("weights of skins"), "{error}");
}

#[test]
fn shells_weigh_by_their_area_and_free_bodies_can_be_aligned() {
    let shell = r#"<body pos="0 0 1"><freejoint/><geom size=".1" pos=".3 0 0" shellinertia="true"/><site/></body>"#;
    let model = made(shell, "").expect("a shell");
    let mass = 1000.0 * 4.0 * std::f64::consts::PI * 0.1 * 0.1;
    assert!((model.body_mass[2] - mass).abs() < 1e-12 * mass);
    assert_eq!((model.body_ipos[2], model.qpos0[1]), ([0.3, 0.0, 0.0], 0.0));
    let aligned = made(shell, r#"<compiler alignfree="true"/>"#).expect("aligned");
    assert_eq!(
        (aligned.body_ipos[2], aligned.qpos0[1], aligned.site_pos[0]),
        ([0.0; 3], 0.3, [-0.3, 0.0, 0.0])
    );
    let held = shell.replace("<freejoint/>", "<freejoint align=\"false\"/>");
    let held = made(&held, r#"<compiler alignfree="true"/>"#).expect("held");
    assert_eq!(held.body_ipos[2], [0.3, 0.0, 0.0]);
}

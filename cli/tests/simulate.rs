//! `babybench simulate`: models without an infant.

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use babybench::formats::npz::Npz;
use common::Folder;
use program::*;

const MODEL: &str = r#"<mujoco model="cart">
  <option timestep="0.01" integrator="RK4"/>
  <worldbody>
    <light pos="0 0 3"/><geom type="plane" size="2 2 .1" rgba=".8 .9 .8 1"/><camera name="side" pos="0 -3 1" zaxis="0 -1 0"/>
    <body name="cart" pos="0 0 .5"><joint name="slider" type="slide" axis="1 0 0" damping=".1"/><geom type="box" size=".1 .1 .05"/>
      <body name="pole"><joint name="hinge" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0 0 .6" size=".03"/></body></body>
  </worldbody>
  <actuator><motor joint="slider" ctrlrange="-2 2" gear="5"/></actuator>
  <sensor><jointpos name="angle" joint="hinge"/><clock/></sensor>
  <keyframe><key name="tilted" qpos="0 .3" ctrl="1"/></keyframe>
</mujoco>"#;

fn folder(name: &str) -> Folder {
    let folder = Folder::new(name);
    folder.file("cart.xml", MODEL);
    folder
}

fn said(folder: &Folder, arguments: &[&str], works: bool) -> String {
    let out = babybench(folder.path(), arguments);
    let said = text(&out);
    assert_eq!(out.status.success(), works, "{arguments:?}: {said}");
    assert!(!said.contains("panicked"), "{said}");
    said
}

#[test]
fn a_model_is_simulated_from_a_keyframe_and_its_motion_written() {
    let folder = folder("simulate");
    let arguments = [
        "simulate",
        "cart.xml",
        "--keyframe",
        "tilted",
        "--policy",
        "keyframe",
        "--steps",
        "50",
        "--out",
        "cart.npz",
    ];
    let printed = said(&folder, &arguments, true);
    for part in [
        "2 bodies, 2 joints (nq 2, nv 2), 3 geoms, 1 actuators, 2 sensors, 1 keyframes",
        "50 steps of 0.01 s",
        "At 0.5000 s",
        "joint hinge: ",
        "sensor angle: ",
        "sensor clock: 0.5",
        "wrote cart.npz",
    ] {
        assert!(printed.contains(part), "no {part:?} in {printed}");
    }
    let archive = Npz::open(folder.path().join("cart.npz")).expect("an archive");
    let qpos = archive.get_f64("qpos").expect("positions");
    assert_eq!((qpos.shape, &qpos.data[..2]), (vec![50, 2], &[0.0, 0.3][..]));
    assert!(qpos.data[98..].iter().all(|q| q.is_finite() && *q != 0.0));
    let ctrl = archive.get_f64("ctrl").expect("controls");
    assert_eq!(ctrl.data, [1.0; 50]);
    // the same seed, the same bits
    for file in ["a.npz", "b.npz"] {
        said(
            &folder,
            &[
                "simulate", "cart.xml", "--policy", "random", "--seed", "7", "--out", file,
            ],
            true,
        );
    }
    let [a, b] = ["a.npz", "b.npz"].map(|file| std::fs::read(folder.path().join(file)).expect("a file"));
    assert_eq!(a, b);
}

#[test]
fn a_model_is_filmed() {
    let folder = folder("simulate_video");
    let printed = said(
        &folder,
        &[
            "simulate", "cart.xml", "--video", "cart.avi", "--size", "64", "--camera", "side",
        ],
        true,
    );
    assert!(printed.contains("wrote cart.avi"), "{printed}");
    let video = std::fs::read(folder.path().join("cart.avi")).expect("a video");
    assert_eq!((&video[..4], &video[8..12]), (&b"RIFF"[..], &b"AVI "[..]));
    assert!(!folder.path().join("cart.avi.part").exists());
}

#[test]
fn mistakes_are_named() {
    let folder = folder("simulate_mistakes");
    folder.file(
        "bad.xml",
        "<mujoco><worldbody><body><joint/></body></worldbody></mujoco>",
    );
    folder.file("fast.xml", MODEL.replace(r#"gear="5""#, r#"gear="1e14""#));
    for (arguments, parts) in [
        (&["simulate", "none.xml"][..], &["none.xml"][..]),
        (
            &["simulate", "bad.xml"],
            &["bad.xml", "a moving body must have mass and inertia"],
        ),
        (
            &["simulate", "cart.xml", "--keyframe", "up"],
            &["--keyframe up", "it has 1, numbered from 0: tilted"],
        ),
        (
            &["simulate", "cart.xml", "--policy", "keyframe"],
            &["say which with --keyframe"],
        ),
        (
            &["simulate", "cart.xml", "--video", "v.avi", "--camera", "top"],
            &["--camera top", "side"],
        ),
        (
            &["simulate", "cart.xml", "--video", "v.avi", "--size", "100000"],
            &["100000"],
        ),
        (
            &["simulate", "fast.xml", "--policy", "random"],
            &["fast.xml", "diverged"],
        ),
    ] {
        let printed = said(&folder, arguments, false);
        for part in parts {
            assert!(printed.contains(part), "{arguments:?}: no {part:?} in {printed}");
        }
    }
}

#[test]
fn documents_name_files_above_them_and_by_absolute_path() {
    let folder = Folder::new("above");
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    let part = r#"<mujoco><asset><mesh name="t" file="t.obj"/></asset></mujoco>"#;
    folder.file("robot/meshes/t.obj", mesh);
    folder.file("robot/part.xml", part);
    let absolute = folder.path().join("robot/meshes");
    let document = |meshdir: &str, asset: &str| {
        format!(
            "<mujoco><compiler meshdir='{meshdir}'/>{asset}<worldbody><body><freejoint/><geom type='mesh' mesh='t'/></body></worldbody></mujoco>"
        )
    };
    let above = document("../meshes", r#"<include file="../part.xml"/>"#);
    let file = format!("<asset><mesh name='t' file='{}/t.obj'/></asset>", absolute.display());
    for (name, text) in [("above", above), ("absolute", document("nowhere", &file))] {
        folder.file("robot/rooms/room.xml", text);
        let printed = said(&folder, &["simulate", "robot/rooms/room.xml", "--steps", "2"], true);
        assert!(printed.contains("1 geoms"), "{name}: {printed}");
    }
    folder.file(
        "robot/rooms/room.xml",
        document("../../meshes", r#"<include file="../part.xml"/>"#),
    );
    let printed = said(&folder, &["simulate", "robot/rooms/room.xml"], false);
    assert!(
        printed.contains("file \"../../meshes/t.obj\" does not exist"),
        "{printed}"
    );
}

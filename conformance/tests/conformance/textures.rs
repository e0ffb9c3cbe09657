//! Textures beside MuJoCo 3.3.0: how many numbers a pixel may have.

use babybench::assets::MemoryAssets;
use conformance::loading::{Outcome, compare_bytes};
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::Trial;
use testkit::trials;

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: channels_of_textures_are_taken_alike]
}

/// What is taken has MuJoCo's number of channels. Of what is refused, MuJoCo takes some, and draws noise or nothing; it is not asked about
/// builtin patterns of fewer than three channels, for which it writes beyond its memory.
fn channels_of_textures_are_taken_alike() {
    // two by two pixels of four channels
    const PICTURE: [u8; 83] = [
        137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 2, 0, 0, 0, 2, 8, 6, 0, 0, 0, 114, 182,
        13, 36, 0, 0, 0, 26, 73, 68, 65, 84, 120, 218, 99, 96, 144, 179, 137, 226, 210, 112, 75, 97, 96, 148, 183, 141,
        230, 214, 116, 79, 5, 0, 25, 94, 3, 41, 237, 11, 79, 203, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130,
    ];
    let mut assets = MemoryAssets::new();
    assets.insert("a.png", PICTURE).expect("a name of a file");
    let outcome = |texture: &str| {
        let text = format!(
            r#"<mujoco><asset><texture name="t" {texture}/><material name="m" texture="t"/><material name="n">
            <layer role="rgba" texture="t"/></material></asset><worldbody><geom size="1" material="m"/></worldbody></mujoco>"#
        );
        let files = [("m.xml", text.as_bytes()), ("a.png", PICTURE.as_slice())];
        compare_bytes(needed(), ("m.xml", &text), &files, &assets)
    };
    let file = r#"type="2d" file="a.png""#;
    let cube = r#"builtin="gradient" width="4" mark="cross""#;
    let flat = r#"type="2d" builtin="flat" width="4" height="4""#;
    for (texture, channels, taken) in [
        (file, "3", Some(true)),
        (file, "4", Some(true)),
        (file, "-1", None),
        (file, "0", None),
        (file, "1", None),
        (file, "2", None),
        (file, "5", None),
        (flat, "3", Some(true)),
        (flat, "4", Some(false)),
        (flat, "5", Some(false)),
        (cube, "3", Some(true)),
        (cube, "4", Some(true)),
        (cube, "5", Some(false)),
        (r#"file="a.png""#, "3", Some(true)),
        (r#"file="a.png""#, "4", Some(false)),
        (r#"type="skybox" builtin="flat" width="4""#, "4", Some(true)),
        (file, "x", None),
    ] {
        let told = match outcome(&format!(r#"{texture} nchannel="{channels}""#)) {
            Outcome::Equal => Some(true),
            Outcome::Stricter(_) => Some(false),
            Outcome::Rejected => None,
            Outcome::Fault(fault) => panic!("{fault}: {texture} {channels}"),
        };
        assert_eq!(told, taken, "{texture} {channels}");
    }
}

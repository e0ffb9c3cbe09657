//! Scenes of one's own on the command line.

#[path = "../../tests/common/mod.rs"]
mod common;
#[path = "common/program.rs"]
mod program;

use common::Folder;
use program::*;

/// Runs the program, which succeeds, and returns what it said.
fn done(folder: &Folder, arguments: &[&str]) -> String {
    let out = babybench(folder.path(), arguments);
    let said = text(&out);
    assert!(out.status.success(), "{arguments:?}: {said}");
    said
}

/// Runs the program, which fails with all of `parts`.
fn refused(folder: &Folder, arguments: &[&str], parts: &[&str]) {
    let out = babybench(folder.path(), arguments);
    let said = text(&out);
    assert!(
        !out.status.success() && !said.contains("panicked"),
        "{arguments:?}: {said}"
    );
    for part in parts {
        assert!(said.contains(part), "{arguments:?}: no {part:?} in {said}");
    }
}

/// Observed images are drawn as observed: in the eyes' resolution, and blurred as the configuration says.
#[test]
fn what_he_observes_is_drawn_as_he_sees_it() {
    let folder = Folder::new("observed");
    let picture = |name: &str, keys: &str| {
        let config = folder.file(
            name,
            format!("scene: cubes\ntouch_active: false\nvision_resolution: 32\n{keys}"),
        );
        let out = format!("{name}.png");
        let arguments = [
            "render",
            "--config",
            &config.display().to_string(),
            "--observed",
            "--out",
            &out,
        ];
        let result = babybench(folder.path(), &arguments);
        (
            result.status.success(),
            text(&result),
            std::fs::read(folder.path().join(out)).ok(),
        )
    };
    let (fine, said, sharp) = picture("sharp", "");
    assert!(
        fine && said.contains("64 x 32 pixels, left and right eye as observed"),
        "{said}"
    );
    let sharp = sharp.expect("a picture");
    let size = [&sharp[16..20], &sharp[20..24]].map(|bytes| u32::from_be_bytes(bytes.try_into().expect("four bytes")));
    assert_eq!(size, [64, 32]);
    let blurred = picture("blurred", "age: 0\nvision_acuity: true\n")
        .2
        .expect("a picture");
    let grown = picture("grown", "age: 0\n").2.expect("a picture");
    assert_ne!(blurred, grown, "a newborn sees sharply");
    let (fine, said, _) = picture("blind", "vision_active: false\n");
    assert!(!fine && said.contains("it needs vision_active: true"), "{said}");
}

#[test]
fn a_new_room_is_checked_drawn_run_trained_in_and_reported() {
    let folder = Folder::new("new_room");
    let said = done(&folder, &["scene", "new", "my room"]);
    assert!(
        said.contains("next: babybench scene check 'my room/room.yml'"),
        "{said}"
    );
    refused(&folder, &["scene", "new", "my room"], &["my room/room.xml", "already"]);
    let checked = done(&folder, &["scene", "check", "my room/room.yml"]);
    for part in [
        "my room/room.xml: MIMo v1 for behavior self_touch",
        "actuators       44      44",
        "cameras: corner, eye_left, eye_right",
        "\"ball\" of body \"ball\" with all of his geoms",
        "Overlaps at the start\n  nothing",
        "Without effect here\n  nothing",
    ] {
        assert!(checked.contains(part), "no {part:?} in {checked}");
    }
    // faster, and into a folder of its own
    let yml = folder.path().join("my room/room.yml");
    let mut keys = std::fs::read_to_string(&yml).expect("it was written");
    keys = keys.replace("max_episode_steps: 1000", "max_episode_steps: 5");
    keys += "save_dir: run\nvision_active: false\ntouch_scale: 3\nsave_logs_every: 1\n";
    std::fs::write(&yml, keys).expect("a file");
    let config = ["--config", "my room/room.yml"];
    let with = |command: &'static str, rest: &[&'static str]| [&[command][..], &config, rest].concat();
    done(&folder, &with("run", &["--quiet"]));
    done(&folder, &with("inspect", &[]));
    done(&folder, &with("render", &["--size", "32", "--out", "room.png"]));
    done(&folder, &with("render", &["--age", "0,12", "--out", "ages.svg"]));
    done(&folder, &with("train", &["--train-for", "10", "--quiet"]));
    done(&folder, &["report", "run"]);
    let page = std::fs::read_to_string(folder.path().join("run/report.html")).expect("the page");
    assert!(page.contains("Self-touch in my room/room.xml"));
    // the logs are of this room
    let xml = folder.path().join("my room/room.xml");
    let room = std::fs::read_to_string(&xml).expect("it was written");
    std::fs::write(&xml, room.replace("name=\"block\"", "name=\"brick\"")).expect("a file");
    refused(
        &folder,
        &with("evaluate", &["--episodes", "1", "--duration", "3", "--no-render"]),
        &[
            "scene.xml",
            "the scene my room/room.xml with MIMo v1",
            "save_dir of its own",
        ],
    );
}

#[test]
fn what_is_in_each_other_and_what_is_ignored_is_told() {
    let folder = Folder::new("checked_room");
    done(&folder, &["scene", "new", "."]);
    let xml = folder.path().join("room.xml");
    let room = std::fs::read_to_string(&xml).expect("it was written");
    let sunk = room.replace("pos=\"0.1 0.3 0.06\"", "pos=\"0.1 0.3 0.04\"");
    let sunk = sunk.replace("<light ", "<light castshadow=\"false\" ");
    std::fs::write(&xml, sunk).expect("a file");
    let said = done(&folder, &["scene", "check", "room.xml"]);
    for part in [
        "room.xml: MIMo v1 for behavior none",
        "\"floor\" of body \"world\" and \"ball\" of body \"ball\", 20.00 mm: they will fly apart; move one of them",
        "mujoco/worldbody/light: castshadow: Whether it casts shadows, which are not drawn.",
    ] {
        assert!(said.contains(part), "no {part:?} in {said}");
    }
    std::fs::write(&xml, room.replace("<include file=\"mimo_settings.xml\"/>", "")).expect("a file");
    refused(
        &folder,
        &["scene", "check", "room.xml"],
        &["room.xml: <include file=\"mimo_settings.xml\"/> is missing in <mujoco>"],
    );
    refused(
        &folder,
        &["scene", "check", "rom.xml"],
        &["`scene` is rom.xml", "does not exist"],
    );
    refused(&folder, &["scene", "check", "rom.yml"], &["rom.yml", "hint"]);
}

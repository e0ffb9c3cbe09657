//! Other things than files where a file is needed.

use crate::case::{Case, Content};
use crate::runs::{QUICK, quick, run};

pub fn cases() -> Vec<Case> {
    let configuration = |name: &str, content: Content| {
        Case::new(
            format!("file: configuration that is {name}"),
            "run --config c.yml --steps 1 --quiet",
        )
        .file("c.yml", content)
    };
    let scene = |name: &str, content: Content| {
        run(Case::new(format!("file: scene that is {name}"), "score run")).file("run/scene.xml", content)
    };
    let assets = |name: &str| {
        let call = "run --config c.yml --assets assets --steps 1 --quiet";
        quick(format!("file: assets: {name}"), call)
    };
    let room = |name: &str| {
        Case::new(format!("file: room: {name}"), "run --config c.yml --steps 1 --quiet")
            .file("c.yml", "scene: room.xml\n")
    };
    vec![
        configuration("a pipe", Content::Pipe),
        configuration("a device", Content::Link("/dev/zero")),
        configuration("the terminal", Content::Link("/dev/tty")),
        configuration("a folder", Content::Folder),
        configuration("a link to nothing", Content::Link("nothing")),
        configuration("a link in a circle", Content::Link("c.yml")),
        configuration("8 GiB of zeros", Content::Zeros(8 << 30)),
        configuration("a file of the system", Content::Link("/proc/self/mem")), // on every Linux, unlike /proc/kcore
        scene("a pipe", Content::Pipe),
        scene("a device", Content::Link("/dev/zero")),
        scene("a folder", Content::Folder),
        scene("8 GiB of zeros", Content::Zeros(8 << 30)),
        scene("a link out of the run", Content::Link("/etc/passwd")),
        room("not there"),
        room("a folder").file("room.xml", Content::Folder),
        room("a pipe").file("room.xml", Content::Pipe),
        room("a device").file("room.xml", Content::Link("/dev/zero")),
        room("empty").file("room.xml", ""),
        room("no MIMo").file("room.xml", "<mujoco/>"),
        room("itself").file("room.xml", "<mujoco><include file='room.xml'/></mujoco>"),
        room("a file of the system").file("room.xml", "<mujoco><include file='../../etc/passwd'/></mujoco>"),
        room("an absolute path").file("room.xml", "<mujoco><include file='/etc/passwd'/></mujoco>"),
        room("a link out of the folder")
            .file("room.xml", "<mujoco><include file='walls.xml'/></mujoco>")
            .file("walls.xml", Content::Link("/etc/passwd")),
        room("the library's name")
            .file("room.xml", "<mujoco><include file='mimo.xml'/></mujoco>")
            .file("mimo.xml", "<mujoco/>"),
        assets("not there"),
        assets("a file").file("assets", ""),
        assets("an empty folder").file("assets", Content::Folder),
        assets("a folder of empty files").file("assets/babybench/base.xml", ""),
        assets("a document that is none")
            .with_assets()
            .file("assets/babybench/base.xml", "<mujoco><mesh/></mujoco>"),
        assets("a document of another scene")
            .with_assets()
            .file("assets/babybench/mimo_v1.xml", "<mujoco/>"),
        assets("a document that includes itself").with_assets().file(
            "assets/babybench/base.xml",
            "<mujoco><include file='base.xml'/></mujoco>",
        ),
        assets("a document that is a pipe")
            .with_assets()
            .file("assets/babybench/base.xml", Content::Pipe),
        assets("a document that is a device")
            .with_assets()
            .file("assets/babybench/base.xml", Content::Link("/dev/zero")),
        assets("a document that leads out of the folder")
            .with_assets()
            .file("assets/babybench/base.xml", Content::Link("/etc/passwd")),
        quick(
            "file: recording that is a folder",
            "replay --config c.yml --recording c --out o",
        )
        .file("c", Content::Folder),
        quick(
            "file: picture of a recording that is a pipe",
            "render --config c.yml --state p --out a.png",
        )
        .file("p", Content::Pipe),
        quick(
            "file: picture into a pipe that nobody reads",
            "render --config c.yml --size 8 --out p.png",
        )
        .file("p.png", Content::Folder),
        Case::new(
            "file: script for a configuration",
            "run --config c.sh --steps 1 --quiet",
        )
        .file("c.sh", "#!/bin/sh\nrm -rf run\n"),
        Case::new(
            "file: configuration through a file",
            "run --config c.yml/d.yml --steps 1",
        )
        .file("c.yml", QUICK),
    ]
}

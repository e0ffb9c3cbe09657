//! MJCF: the scene of a run, which `score` reads for the names of its parts.

use crate::case::{Case, Content};
use crate::runs::run;

/// Contents of `<worldbody>`, by their fault.
const WORLDS: &[(&str, &str)] = &[
    ("unknown element", "<mesh/>"),
    ("unknown attribute", "<geom size='1' colour='red'/>"),
    ("no size", "<geom/>"),
    ("negative size", "<geom size='-1'/>"),
    ("size nan", "<geom size='nan'/>"),
    ("size infinity", "<geom size='inf'/>"),
    ("size too large", "<geom size='1e31'/>"),
    ("size too small", "<geom size='1e-400'/>"),
    ("too many sizes", "<geom size='1 2 3 4'/>"),
    ("box with one size", "<geom type='box' size='1'/>"),
    ("size in words", "<geom size='big'/>"),
    ("unknown shape", "<geom type='torus' size='1'/>"),
    ("condim 2", "<geom size='1' condim='2'/>"),
    ("condim 7", "<geom size='1' condim='7'/>"),
    ("priority beyond 32 bits", "<geom size='1' priority='2147483648'/>"),
    ("bits beyond 32 bits", "<geom size='1' contype='4294967296'/>"),
    ("group 6", "<geom size='1' group='6'/>"),
    ("material that is not there", "<geom size='1' material='gold'/>"),
    ("zero quaternion", "<geom size='1' quat='0 0 0 0'/>"),
    ("zero axis", "<body><joint axis='0 0 0'/><geom size='1'/></body>"),
    ("two orientations", "<geom size='1' quat='1 0 0 0' euler='0 0 1'/>"),
    (
        "fromto of no length",
        "<geom type='capsule' size='1' fromto='0 0 0 0 0 0'/>",
    ),
    ("fromto of a sphere", "<geom size='1' fromto='0 0 0 1 0 0'/>"),
    ("name twice", "<geom name='a' size='1'/><geom name='a' size='1'/>"),
    ("body without mass", "<body><freejoint/></body>"),
    ("negative mass", "<body><freejoint/><geom size='1' mass='-1'/></body>"),
    ("no mass", "<body><freejoint/><geom size='1' mass='0'/></body>"),
    (
        "mass beyond all bounds",
        "<body><freejoint/><geom size='1' mass='1e30'/></body>",
    ),
    (
        "huge density",
        "<body><freejoint/><geom size='1e10' density='1e30'/></body>",
    ),
    (
        "negative inertia",
        "<body><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 -1'/></body>",
    ),
    (
        "inertia of no body",
        "<body><freejoint/><inertial pos='0 0 0' mass='1' diaginertia='1 1 9'/></body>",
    ),
    ("inertia without mass", "<body><inertial pos='0 0 0'/></body>"),
    (
        "free joint in a body that moves",
        "<body><joint/><geom size='1'/><body><freejoint/><geom size='1'/></body></body>",
    ),
    (
        "free joint and another",
        "<body><freejoint/><joint/><geom size='1'/></body>",
    ),
    ("joint in the world", "<joint/>"),
    ("free joint in the world", "<freejoint/>"),
    (
        "inertia in the world",
        "<inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>",
    ),
    (
        "ball joint",
        "<body><joint type='ball' range='10 60'/><geom size='1'/></body>",
    ),
    (
        "range upside down",
        "<body><joint range='1 -1' limited='true'/><geom size='1'/></body>",
    ),
    (
        "limited without range",
        "<body><joint limited='true'/><geom size='1'/></body>",
    ),
    ("negative damping", "<body><joint damping='-1'/><geom size='1'/></body>"),
    (
        "wrong solref",
        "<body><joint solreflimit='-1 1'/><geom size='1'/></body>",
    ),
    (
        "moving body in a plane",
        "<body><freejoint/><geom type='plane' size='1 1 1'/></body>",
    ),
    ("camera without field of view", "<camera fovy='0'/>"),
    ("camera that sees behind", "<camera fovy='180'/>"),
    (
        "camera of a body that is not there",
        "<camera mode='targetbody' target='x'/>",
    ),
    ("light of no direction", "<light dir='0 0 0'/>"),
    ("site without size", "<site size='0'/>"),
    ("class that is not there", "<geom class='none' size='1'/>"),
    ("childclass that is not there", "<body childclass='none'/>"),
    ("body named world", "<body name='world'/>"),
    ("text in an element", "<body>hello</body>"),
    ("escape sequences in a name", "<geom name='&#27;[2J' size='x'/>"),
    ("attribute twice", "<geom size='1' size='2'/>"),
    ("attribute without value", "<geom size/>"),
    ("attribute without quotes", "<geom size=1/>"),
    ("open element", "<body>"),
    ("crossed elements", "<body><geom size='1'></body></geom>"),
    ("open attribute", "<geom size='1"),
    ("unknown entity", "<geom name='&gt;&nope;' size='1'/>"),
    ("character that is none", "<geom name='&#0;' size='1'/>"),
    ("surrogate", "<geom name='&#xd800;' size='1'/>"),
    ("CDATA", "<![CDATA[<geom/>]]>"),
    ("processing instruction", "<?php die() ?>"),
    ("comment that is open", "<!-- <geom size='1'/>"),
    ("two hyphens in a comment", "<!-- a -- b -->"),
];

/// Whole documents.
const DOCUMENTS: &[(&str, &str)] = &[
    ("empty", ""),
    ("only a declaration", "<?xml version='1.0'?>"),
    ("no XML", "behavior: none"),
    ("HTML", "<!DOCTYPE html><html/>"),
    ("other root", "<robot name='mimo'/>"),
    ("two roots", "<mujoco/><mujoco/>"),
    (
        "entities of entities",
        "<!DOCTYPE m [<!ENTITY a 'aaaa'><!ENTITY b '&a;&a;&a;'>]><mujoco model='&b;'/>",
    ),
    (
        "external entity",
        "<!DOCTYPE m [<!ENTITY a SYSTEM 'file:///etc/passwd'>]><mujoco model='&a;'/>",
    ),
    (
        "two worlds with a floor each",
        "<mujoco><worldbody><geom name='f' size='1'/></worldbody><worldbody><geom name='f' size='1'/></worldbody></mujoco>",
    ),
    ("includes itself", "<mujoco><include file='scene.xml'/></mujoco>"),
    ("include of nothing", "<mujoco><include/></mujoco>"),
    ("include of no name", "<mujoco><include file=''/></mujoco>"),
    (
        "include that is not there",
        "<mujoco><include file='none.xml'/></mujoco>",
    ),
    (
        "include above the folder",
        "<mujoco><include file='../c.yml'/></mujoco>",
    ),
    (
        "include by an absolute path",
        "<mujoco><include file='/etc/passwd'/></mujoco>",
    ),
    ("include by a drive", "<mujoco><include file='c:\\a.xml'/></mujoco>"),
    ("include of a folder", "<mujoco><include file='logs'/></mujoco>"),
    (
        "include of a log",
        "<mujoco><include file='logs/training.pkl'/></mujoco>",
    ),
    ("negative time step", "<mujoco><option timestep='-1'/></mujoco>"),
    ("no time step", "<mujoco><option timestep='0'/></mujoco>"),
    ("unknown integrator", "<mujoco><option integrator='Verlet'/></mujoco>"),
    ("other cone", "<mujoco><option cone='round'/></mujoco>"),
    (
        "iterations without end",
        "<mujoco><option iterations='2147483648'/></mujoco>",
    ),
    ("gravity of two numbers", "<mujoco><option gravity='0 0'/></mujoco>"),
    ("unknown angle", "<mujoco><compiler angle='gradian'/></mujoco>"),
    ("unknown order of angles", "<mujoco><compiler eulerseq='abc'/></mujoco>"),
    (
        "class twice",
        "<mujoco><default><default class='a'/><default class='a'/></default></mujoco>",
    ),
    ("class without name", "<mujoco><default><default/></default></mujoco>"),
    (
        "excluded body that is not there",
        "<mujoco><contact><exclude body1='a' body2='b'/></contact></mujoco>",
    ),
    (
        "pair of geoms that are not there",
        "<mujoco><contact><pair geom1='a' geom2='b'/></contact></mujoco>",
    ),
    ("weld of nothing", "<mujoco><equality><weld/></equality></mujoco>"),
    (
        "motor of no joint",
        "<mujoco><actuator><motor joint='a'/></actuator></mujoco>",
    ),
    ("tendon of nothing", "<mujoco><tendon><fixed/></tendon></mujoco>"),
    (
        "sensor of no site",
        "<mujoco><sensor><gyro site='a'/></sensor></mujoco>",
    ),
    ("spatial tendon", "<mujoco><tendon><spatial/></tendon></mujoco>"),
    ("plugin", "<mujoco><extension><plugin plugin='a'/></extension></mujoco>"),
    (
        "texture of no size",
        "<mujoco><asset><texture name='t' type='2d' builtin='flat' width='0' height='0'/></asset></mujoco>",
    ),
    (
        "huge texture",
        "<mujoco><asset><texture name='t' type='2d' builtin='flat' width='16385' height='16385'/></asset></mujoco>",
    ),
    (
        "texture twice",
        "<mujoco><asset><texture name='t' builtin='flat' width='8' height='8'/><texture name='t' builtin='flat' width='8' height='8'/></asset></mujoco>",
    ),
    (
        "material of no texture",
        "<mujoco><asset><material name='m' texture='t'/></asset></mujoco>",
    ),
    (
        "model that is huge by statistic",
        "<mujoco><statistic extent='1e30' meansize='-1'/></mujoco>",
    ),
];

/// A run whose scene this is.
pub fn scene(name: &str, text: impl Into<Content>) -> Case {
    run(Case::new(format!("MJCF: {name}"), "score run")).file("run/scene.xml", text)
}

fn world(name: &str, inside: &str) -> Case {
    scene(
        name,
        format!("<mujoco>\n<worldbody>\n{inside}\n</worldbody>\n</mujoco>"),
    )
}

/// Bodies in bodies.
fn nested(depth: usize) -> String {
    format!("{}{}", "<body>".repeat(depth), "</body>".repeat(depth))
}

pub fn cases() -> Vec<Case> {
    let ball = "<body><freejoint/><geom size='.1'/></body>";
    let unseen = "<body><freejoint/><geom size='.1' contype='0' conaffinity='0'/></body>";
    let heap = |n: usize| format!("<body><freejoint/>{}</body>", "<geom size='.1'/>".repeat(n));
    let excludes = |n: usize| {
        let one = "<exclude body1='a' body2='b'/>";
        let bodies = "<worldbody><body name='a'/><body name='b'/></worldbody>";
        format!("<mujoco>{bodies}<contact>{}</contact></mujoco>", one.repeat(n))
    };
    let chain = |n: usize| {
        let files = (0..n).map(|k| {
            (
                format!("run/i{k}.xml"),
                format!("<mujoco><include file='i{}.xml'/></mujoco>", k + 1),
            )
        });
        let start = scene("a chain of includes", "<mujoco><include file='i0.xml'/></mujoco>");
        files.fold(start, |case, (path, text)| case.file(&path, text))
    };
    let made = vec![
        world("70,000 geoms", &"<geom size='.1'/>".repeat(70_000)),
        world("3,000 geoms that may all touch", &heap(1500).repeat(2)),
        world("20,000 free bodies that touch nothing", &unseen.repeat(20_000)),
        world("3,000 free bodies", &ball.repeat(3000)),
        scene("90,000 excludes", excludes(90_000)),
        world("99 bodies in bodies", &nested(90)),
        world("101 bodies in bodies", &nested(101)),
        world("100,000 bodies in bodies", &nested(100_000)),
        world("100,000 open bodies", &"<body>".repeat(100_000)),
        world("100,001 elements", &"<site/>".repeat(100_001)),
        world(
            "65 attributes",
            &format!("<geom {}/>", (0..65).map(|k| format!("a{k}='1' ")).collect::<String>()),
        ),
        world("long name", &format!("<geom name='{}' size='1'/>", "n".repeat(257))),
        world("long attribute", &format!("<geom {}='1'/>", "n".repeat(100_000))),
        world("long number", &format!("<geom size='{}'/>", "9".repeat(100_000))),
        world("100,000 numbers", &format!("<geom size='{}'/>", "1 ".repeat(100_000))),
        world("long element", &format!("<{}/>", "n".repeat(100_000))),
        world("body with a megabyte of text", &"x".repeat(1 << 20)),
        scene("5 MiB", Content::Zeros(5 << 20)),
        scene("not UTF-8", b"<mujoco model='\xff'/>"),
        scene("UTF-16", b"\xff\xfe<\0m\0u\0j\0o\0c\0o\0/\0>\0"),
        scene("zero bytes", b"<mujoco>\0</mujoco>"),
        scene(
            "1,001 classes",
            format!(
                "<mujoco><default>{}</default></mujoco>",
                (0..1001)
                    .map(|k| format!("<default class='c{k}'/>"))
                    .collect::<String>()
            ),
        ),
        chain(20),
        scene("two includes of each other", "<mujoco><include file='a.xml'/></mujoco>")
            .file("run/a.xml", "<mujoco><include file='b.xml'/></mujoco>")
            .file("run/b.xml", "<mujoco><include file='a.xml'/></mujoco>"),
        scene(
            "include twice",
            "<mujoco><include file='a.xml'/><include file='a.xml'/></mujoco>",
        )
        .file("run/a.xml", "<mujoco/>"),
        scene("include of an empty file", "<mujoco><include file='a.xml'/></mujoco>").file("run/a.xml", ""),
        scene(
            "include of an unknown element",
            "<mujoco>\n<include file='a.xml'/></mujoco>",
        )
        .file("run/a.xml", "<mujoco>\n\n<mesh/></mujoco>"),
        scene("include with another root", "<mujoco><include file='a.xml'/></mujoco>").file("run/a.xml", "<robot/>"),
        scene(
            "include through a link that leaves the folder",
            "<mujoco><include file='a.xml'/></mujoco>",
        )
        .file("run/a.xml", Content::Link("/etc/passwd")),
        scene(
            "include through a link in a circle",
            "<mujoco><include file='a.xml'/></mujoco>",
        )
        .file("run/a.xml", Content::Link("a.xml")),
        scene("include of a pipe", "<mujoco><include file='a.xml'/></mujoco>").file("run/a.xml", Content::Pipe),
        scene("include of a device", "<mujoco><include file='a.xml'/></mujoco>")
            .file("run/a.xml", Content::Link("/dev/zero")),
    ];
    let worlds = WORLDS.iter().map(|(name, inside)| world(name, inside));
    let documents = DOCUMENTS.iter().map(|(name, text)| scene(name, text));
    worlds.chain(documents).chain(made).collect()
}

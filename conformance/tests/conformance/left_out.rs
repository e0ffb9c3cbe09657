//! `discardvisual`: what is only drawn is left out, beside MuJoCo.

use conformance::differential::compare::{Sides, Taken};
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::Trial;
use testkit::trials;

use crate::agreement::agrees;

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: what_is_only_drawn_is_left_out_as_in_mujoco, what_mujoco_loses_is_refused]
}

/// What is only drawn.
const DRAWN: &str = "contype='0' conaffinity='0'";

/// Settings before the world, parts of a free body after its geoms `a` and `drawn`, the rest of the document, and the geoms and meshes that
/// are left.
const DOCUMENTS: [(&str, &str, &str, [usize; 2]); 14] = [
    ("", "", "", [2, 0]),
    (
        "<compiler inertiafromgeom='true' settotalmass='3'/>",
        "<inertial pos='0 0 1' mass='2' diaginertia='1 1 1'/>",
        "",
        [2, 0],
    ),
    ("", "<inertial pos='0 0 .1' mass='2' diaginertia='1 1 1'/>", "", [2, 0]),
    (
        "",
        "<geom size='.1' contype='2' conaffinity='0' user='1'/><geom size='.1' user='1 2 3' DRAWN/>",
        "",
        [3, 0],
    ),
    (
        "<asset><texture name='t' type='2d' file='not_there.png'/><material name='m' texture='t' rgba='1 0 0 1'/></asset>",
        "<geom size='.1' pos='0 .3 0' material='m'/><geom size='.1' material='nowhere' DRAWN/>",
        "",
        [3, 0],
    ),
    (
        "",
        "<geom name='b' size='.1' DRAWN/>",
        "<contact><pair geom1='drawn' geom2='floor'/></contact>",
        [3, 0],
    ),
    (
        "",
        "",
        "<sensor><framepos objtype='geom' objname='drawn'/></sensor>",
        [3, 0],
    ),
    (
        "",
        "",
        "<sensor><framepos objtype='body' objname='free' reftype='geom' refname='floor'/></sensor>",
        [2, 0],
    ),
    (
        "",
        "",
        "<custom><tuple name='t'><element objtype='geom' objname='drawn'/></tuple></custom>",
        [3, 0],
    ),
    (
        "",
        "<site name='s' pos='.3 0 0'/>",
        "<tendon><spatial limited='true' range='0 .5'><site site='s'/><geom geom='drawn'/><site site='far'/></spatial></tendon>",
        [3, 0],
    ),
    (
        "MESHES",
        "<geom type='mesh' mesh='one' pos='0 0 .2'/><geom type='mesh' mesh='two' DRAWN/><geom type='box' mesh='three'/>",
        "",
        [4, 2],
    ),
    (
        "MESHES",
        "<geom type='box' mesh='two' pos='.1 0 0' DRAWN/><geom type='mesh' mesh='two' pos='.1 0 .2' euler='10 0 0'/>",
        "",
        [3, 1],
    ),
    (
        "<asset><hfield name='h' nrow='2' ncol='2' size='1 1 1 1'/></asset>",
        "",
        "<worldbody><geom type='hfield' hfield='h' DRAWN/></worldbody>",
        [2, 0],
    ),
    (
        "<compiler fusestatic='true'/>",
        "<body pos='0 0 .4'><geom type='box' size='.1 .2 .3' DRAWN/><geom size='.05'/></body>",
        "",
        [3, 0],
    ),
];

const MESHES: &str = "<asset><mesh name='one' vertex='0 0 0 .2 0 0 0 .2 0 0 0 .3'/><mesh name='two' vertex='0 0 0 .3 0 0 0 .2 0 0 0 .4'/>\
    <mesh name='three' vertex='0 0 0 .1 0 0 0 .4 0 0 0 .3'/></asset>";

fn document(settings: &str, part: &str, rest: &str) -> String {
    let world = "<worldbody><geom name='floor' type='plane' size='1 1 1'/><geom size='.1' DRAWN/><site name='far' pos='0 1 1'/>\
        <body name='free' pos='0 0 .5'><freejoint/>";
    let own = "<geom name='a' size='.1'/><geom name='drawn' type='cylinder' size='.05 .2' pos='.2 .1 0' euler='30 0 0' DRAWN/>";
    let text = format!(
        "<mujoco><compiler discardvisual='true'/>{settings}{world}{own}{part}</body></worldbody>{rest}</mujoco>"
    );
    text.replace("MESHES", MESHES).replace("DRAWN", DRAWN)
}

fn what_is_only_drawn_is_left_out_as_in_mujoco() {
    for (settings, part, rest, [geoms, meshes]) in DOCUMENTS {
        let text = document(settings, part, rest);
        let mut sides = match Sides::load(needed(), &text) {
            Taken::Both(sides) => sides,
            _ => panic!("one side refuses {text}"),
        };
        let model = &sides.model;
        assert_eq!([model.ngeom(), model.nmesh()], [geoms, meshes], "{text}");
        assert_eq!((model.materials.len(), model.textures.len()), (0, 0), "{text}");
        agrees(&mut sides, &text);
    }
}

fn what_mujoco_loses_is_refused() {
    for (part, rest) in [
        ("<site material='m'/>", ""),
        (
            "",
            "<tendon><spatial material='m'><site site='far'/><site site='far'/></spatial></tendon>",
        ),
        (
            "",
            "<sensor><framepos objtype='body' objname='free' reftype='geom' refname='a'/></sensor>",
        ),
        ("", "<sensor><distance geom1='floor' geom2='drawn'/></sensor>"),
        ("<geom name='twin' size='.1'/><geom name='twin' size='.1' DRAWN/>", ""),
        ("<geom type='box' size='.1' DRAWN/>", ""),
        ("", "<contact><pair geom1='nobody' geom2='a'/></contact>"),
        ("", "<asset><material name='m'/></asset>"),
        (
            "",
            "<asset><texture name='t' type='cube' builtin='flat' width='2'/><texture name='t' type='cube' builtin='flat' width='2'/></asset>",
        ),
        (
            "<geom type='mesh' mesh='one' DRAWN/>",
            "MESHES<custom><tuple name='t'><element objtype='mesh' objname='one'/></tuple></custom>",
        ),
    ] {
        let text = document("<asset><material name='m'/></asset>", part, rest);
        assert!(
            matches!(Sides::load(needed(), &text), Taken::Refused(_)),
            "one side takes {text}"
        );
    }
}

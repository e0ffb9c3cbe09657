//! Every kind of error with its message, paths and limits.

use super::*;
use crate::assets::{DirAssets, EmbeddedAssets, MemoryAssets, Overlay};

pub(super) fn source(files: &[(&str, &str)]) -> MemoryAssets {
    let mut assets = MemoryAssets::new();
    for (path, text) in files {
        assets.insert(path, *text).unwrap();
    }
    assets
}

/// Returns the message of loading `text` as `m.xml`; empty when it loads. `other.xml` and `t.png` exist beside it.
pub(super) fn outcome(text: &str) -> String {
    let other = "<mujocoinclude><worldbody><geom name=\"other\" size='1'/></worldbody></mujocoinclude>";
    let assets = source(&[("other.xml", other), ("t.png", "")]);
    load_str(text, "m.xml", &assets).map_or_else(|error| error.to_string(), |_| String::new())
}

/// Asserts that a document with the sections `input` gives the message `expect`, without file and position.
pub(super) fn check(input: &str, expect: &str) {
    let message = outcome(&format!("<mujoco>{input}</mujoco>"));
    let told = message.split_once(": ").map_or("", |(_, told)| told);
    assert_eq!(told, expect, "{input}");
}

/// Asserts that a document whose world contains `input` gives the message `expect`; see [`check`].
fn check_world(input: &str, expect: &str) {
    let expect = if expect.is_empty() {
        String::new()
    } else {
        format!("mujoco/worldbody/{expect}")
    };
    check(&format!("<worldbody>{input}</worldbody>"), &expect);
}

/// Asserts the message of `input` after a world of two bodies; see [`check`].
///
/// They are a free ball `b` and a hinged body `h` with joint `j`; the geoms are `g1` and `g2`, the site is `s`.
fn check_with_bodies(input: &str, expect: &str) {
    let world = "<worldbody><body name='b'><freejoint name='f'/><geom name='g1' size='1'/></body>\
                 <body name='h'><joint name='j'/><geom name='g2' size='1'/><site name='s'/></body></worldbody>";
    check(&format!("{world}{input}"), expect);
}

#[test]
fn message_has_file_line_column_and_path() {
    let text = "<mujoco>\n  <worldbody>\n    <geom size='1'/> <geom foo='1'/></worldbody></mujoco>";
    assert_eq!(
        outcome(text),
        "m.xml:3:22: mujoco/worldbody/geom: unknown attribute \"foo\""
    );
    let included = "<mujoco>\n<body><geom foo='1'/></body></mujoco>";
    let text = "<mujoco><worldbody><include file='in/i.xml'/></worldbody></mujoco>";
    let error = load_str(text, "kit/m.xml", &source(&[("kit/in/i.xml", included)])).unwrap_err();
    assert_eq!(
        error.to_string(),
        "kit/in/i.xml:2:7: mujoco/body/geom: unknown attribute \"foo\""
    );
    let text = "<mujoco><!-- \u{e4}\u{20ac} --><geom/></mujoco>";
    assert_eq!(outcome(text), "m.xml:1:20: mujoco/geom: unknown element \"geom\"");
}

#[test]
fn broken_xml_is_an_error() {
    for text in [
        "",
        " ",
        "text",
        "<mujoco>",
        "<mujoco><a></mujoco>",
        "<mujoco/><mujoco/>",
        "<mujoco/></mujoco>",
    ] {
        assert!(!outcome(text).is_empty(), "{text}");
    }
    for text in [
        "<mujoco a=b/>",
        "<mujoco model='&unknown;'/>",
        "<mujoco model=\"x/>",
        "<mujoco <a/>",
        "<!--",
    ] {
        assert!(outcome(text).contains("XML"), "{text}: {}", outcome(text));
    }
    assert_eq!(
        outcome("<mujoco>"),
        "m.xml:1:9: mujoco: malformed XML: the file ends inside an element"
    );
    assert_eq!(
        outcome("<mujoco/><a/>"),
        "m.xml:1:10: malformed XML: there is a second root element"
    );
    assert_eq!(outcome(""), "m.xml:1:1: malformed XML: there is no root element");
    assert_eq!(
        outcome("<urdf/>"),
        "m.xml:1:1: urdf: the root element is \"urdf\", not \"mujoco\""
    );
    let dtd = "<!DOCTYPE a [<!ENTITY b 'c'>]><mujoco/>";
    assert_eq!(outcome(dtd), "m.xml:1:1: a document type is not allowed; remove it");
    // as in MuJoCo, text within elements says nothing
    check("some text", "");
    check("&amp;", "");
    assert_eq!(outcome("<mujoco/>text"), "m.xml:1:10: text is not allowed; remove it");
    check("<![CDATA[x]]>", "mujoco: a CDATA section is not allowed; remove it");
    check("<?php ?>", "mujoco: a processing instruction is not allowed; remove it");
    check(
        "<option timestep='1' timestep='2'/>",
        "mujoco/option: attribute \"timestep\" is given twice",
    );
    assert_eq!(
        outcome("\u{feff}<?xml version='1.0'?><!-- a --><mujoco model='&lt;&#65;'/>"),
        ""
    );
}

#[test]
fn values_are_checked() {
    check_world("<geom size='a'/>", "geom: size: \"a\" is not a finite number");
    check_world("<geom size='nan'/>", "geom: size: \"nan\" is not a finite number");
    check_world("<geom size='1e999'/>", "geom: size: \"1e999\" is not a finite number");
    check_world("<geom pos='0 0 -inf'/>", "geom: pos: \"-inf\" is not a finite number");
    check_world("<geom size='-1'/>", "geom: size: -1 must be at least 0");
    check_world("<geom size='0'/>", "geom: size: 0 must be positive");
    check_world("<geom size=''/>", "geom: size: 0 values, expected 1 to 3");
    check_world("<geom size='1 1 1 1'/>", "geom: size: 4 values, expected 1 to 3");
    check_world("<geom size='1' pos='1 2'/>", "geom: pos: 2 values, expected 3 to 3");
    check_world("<geom size='1' rgba='1 1 1 2'/>", "");
    check(
        "<asset><material name='m' shininess='2'/></asset>",
        "mujoco/asset/material: shininess: 2 must be between 0 and 1",
    );
    check_world(
        "<geom size='1' contype='-1'/>",
        "geom: contype: -1 must be from 0 to 4294967295",
    );
    check_world(
        "<geom size='1' contype='1.5'/>",
        "geom: contype: \"1.5\" is not a finite number",
    );
    check_world("<geom size='1' condim='2'/>", "geom: condim must be 1, 3, 4 or 6");
    check_world("<geom size='1' type='box'/>", "geom: size: 0 must be positive");
    check_world(
        "<geom pos='0 0 -2e30'/>",
        &format!("geom: pos: {} must be at most 1e30 in magnitude", -2e30),
    );
    check_world(
        "<body><joint/><geom size='1e30 1e30 1e30' type='box' density='1e30' quat='1e30 0 0 1e-30'/></body>",
        "",
    );
    check_world(
        "<geom type='torus'/>",
        "geom: type=\"torus\": not one of plane, hfield, sphere, capsule, ellipsoid, cylinder, box, mesh",
    );
    check("<option timestep='0'/>", "mujoco/option: timestep: 0 must be positive");
    check(
        "<option cone='round'/>",
        "mujoco/option: cone=\"round\": not one of pyramidal, elliptic",
    );
    check(
        "<compiler autolimits='1'/>",
        "mujoco/compiler: autolimits=\"1\": not one of false, true",
    );
    check(
        "<compiler eulerseq='xya'/>",
        "mujoco/compiler: eulerseq must be three letters of xyzXYZ",
    );
    check(
        "<size nuser_actuator='65'/>",
        "mujoco/size: nuser_actuator: 65 must be from -1 to 64",
    );
    check("<extension/>", "mujoco/extension: unknown element \"extension\"");
}

#[test]
fn orientations_are_checked() {
    check_world(
        "<geom size='1' quat='0 0 0 0'/>",
        "geom: a zero quaternion is not an orientation",
    );
    check_world(
        "<geom size='1' quat='1 0 0 0' euler='1 2 3'/>",
        "geom: attributes \"quat\" and \"euler\" are mutually exclusive",
    );
    check_world(
        "<geom size='1' axisangle='0 0 0 1'/>",
        "geom: the axis of axisangle is too short",
    );
    check_world("<geom size='1' zaxis='0 0 0'/>", "geom: zaxis is too short");
    check_world(
        "<geom size='1' xyaxes='0 0 0 1 0 0'/>",
        "geom: the x axis of xyaxes is too short",
    );
    check_world(
        "<geom size='1' xyaxes='1 0 0 1 0 0'/>",
        "geom: the y axis of xyaxes is too short or parallel to the x axis",
    );
    check_world(
        "<geom size='1' fromto='0 0 0 1 1 1'/>",
        "geom: fromto needs a capsule, cylinder, box or ellipsoid",
    );
    check_world(
        "<geom type='box' size='1' fromto='0 0 0 0 0 0'/>",
        "geom: the points of fromto are too close",
    );
}

#[test]
fn bodies_are_checked() {
    check_world(
        "<body><joint/></body>",
        "body: a moving body must have mass and inertia",
    );
    check_world("<body><joint/><body><geom size='1'/></body></body>", "");
    check_world(
        "<body><body><freejoint/><geom size='1'/></body></body>",
        "body/body/freejoint: a free joint can only be in a child of the world",
    );
    check_world(
        "<body><joint/><freejoint/><geom size='1'/></body>",
        "body/freejoint: a free joint must be the only joint of its body",
    );
    check_world(
        &format!("<body>{}<geom size='1'/></body>", "<joint/>".repeat(7)),
        "body: a body can have at most 6 degrees of freedom",
    );
    check_world(
        "<body><joint/><geom size='1'/><body><geom type='plane' size='1 1 1'/></body></body>",
        "body/body/geom: a plane can only be in a body that does not move",
    );
    check_world("<joint/>", "joint: unknown element \"joint\"");
    check_world(
        "<body><joint axis='0 0 0'/><geom size='1'/></body>",
        "body/joint: the axis is too short",
    );
    check_world(
        "<body><joint limited='true' range='2 1'/><geom size='1'/></body>",
        "body/joint: range: 1 must be greater than the lower end of the range",
    );
    check(
        "<compiler autolimits='false'/><worldbody><body><joint range='1 2'/><geom size='1'/></body></worldbody>",
        "mujoco/worldbody/body/joint: a range is given, but autolimits is off: set limited to true or false",
    );
    check_world(
        "<body><inertial pos='0 0 0'/></body>",
        "body/inertial: attribute \"mass\" is required",
    );
    check_world(
        "<body><inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/></body>",
        "body: the principal moments must satisfy A + B >= C; correct them, or set balanceinertia in <compiler>",
    );
    check_world(
        "<body><inertial pos='0 0 0' mass='1' fullinertia='1 1 -1 0 0 0'/></body>",
        "body/inertial: the inertia must have positive principal moments",
    );
    check_world(
        "<body><inertial pos='0 0 0' mass='1'/><inertial pos='0 0 0' mass='1'/></body>",
        "body/inertial: element \"inertial\" is given twice",
    );
    check_world(
        "<camera mode='targetbody'/>",
        "camera: attribute \"target\" is required",
    );
    check_world("<camera fovy='180'/>", "camera: fovy: 180 must be below 180 degrees");
    check_world("<light dir='0 0 0'/>", "light: the direction is too short");
}

#[test]
fn names_and_classes_are_resolved() {
    check_world(
        "<body name='a'/><body name='a'/>",
        "body: body name \"a\" is used twice",
    );
    check_world("<body name='world'/>", "body: body name \"world\" is used twice");
    check_world("<geom size='1' class='c'/>", "geom: unknown default class \"c\"");
    check_world("<body childclass='c'/>", "body: unknown default class \"c\"");
    check_world(
        "<geom size='1' material='m'/>",
        "geom: material: there is no material \"m\"",
    );
    check_world(
        "<camera mode='targetbody' target='x'/>",
        "camera: target: there is no body \"x\"",
    );
    check(
        "<default><default class='a'/><default class='a'/></default>",
        "mujoco/default/default: default class \"a\" is declared twice",
    );
    check(
        "<default><default/></default>",
        "mujoco/default/default: attribute \"class\" is required",
    );
    check(
        "<default class='x'/>",
        "mujoco/default: the top default class is \"main\"",
    );
    check(
        "<default><geom name='x'/></default>",
        "mujoco/default/geom: unknown attribute \"name\"",
    );
    check(
        "<asset><material name='m' texture='t'/></asset>",
        "mujoco/asset/material: texture: there is no texture \"t\"",
    );
    let two = "<sensor><gyro name='a' site='s'/><torque name='a' site='s'/></sensor>";
    check_with_bodies(two, "mujoco/sensor/torque: sensor name \"a\" is used twice");
}

#[test]
fn actuators_are_checked() {
    let told = |of: &str, expect: &str| {
        let element = of.split(' ').next().unwrap();
        let expect = match expect {
            "" => String::new(),
            _ => format!("mujoco/actuator/{element}: {expect}"),
        };
        check_with_bodies(&format!("<actuator><{of}/></actuator>"), &expect);
    };
    told("general", "attribute \"joint\" is required");
    told(
        "general joint='j' jointinparent='j'",
        "attributes \"joint\" and \"jointinparent\" are mutually exclusive",
    );
    told("velocity jointinparent='x'", "jointinparent: there is no joint \"x\"");
    told("motor joint='j' actrange='0 1'", "unknown attribute \"actrange\"");
    told(
        "general joint='j' dyntype='user'",
        "dyntype=\"user\": not one of none, integrator, filter, filterexact, muscle",
    );
    told("general joint='j' actrange='0 1'", NO_ACTIVATION);
    told("general joint='j' actrange='0 1' actlimited='false'", "");
    told(
        "intvelocity joint='j'",
        "actrange: 0 must be greater than the lower end of the range",
    );
    told(
        "general joint='j' actdim='1'",
        "actdim must be 0 or left out where dyntype is none",
    );
    let one = "actdim must be 1 or left out: each activation is one number";
    told("general joint='j' dyntype='filter' actdim='0'", one);
    told("general joint='j' dyntype='filter' actdim='2'", one);
    told(
        "damper joint='j' ctrlrange='-1 1'",
        "the ctrlrange of a damper must not be negative",
    );
    let twice = "are two ways to say the same: give one of them";
    told(
        "position joint='j' kv='1' dampratio='1'",
        &format!("kv and dampratio {twice}"),
    );
    told(
        "position joint='j' ctrlrange='0 1' inheritrange='1'",
        &format!("ctrlrange and inheritrange {twice}"),
    );
    told(
        "intvelocity joint='j' actrange='0 1' inheritrange='1'",
        &format!("actrange and inheritrange {twice}"),
    );
    told(
        "position joint='j' inheritrange='1'",
        "inheritrange is used, but the joint or the tendon has no range",
    );
    told(
        "position jointinparent='j' inheritrange='1'",
        "inheritrange needs the attribute joint or tendon",
    );
    // a class is wrong even where nothing takes its defaults from it
    check(
        "<default><motor ctrlrange='-1 1'/><damper/></default>",
        "mujoco/default/damper: the ctrlrange of a damper must not be negative",
    );
}

const NO_ACTIVATION: &str = "actrange applies, but the actuator has no activation: set dyntype, or actlimited to false";

#[test]
fn constraints_are_checked() {
    let pair = "mujoco/contact/pair: ";
    check_with_bodies(
        "<contact><pair geom1='g1'/></contact>",
        &format!("{pair}attribute \"geom2\" is required"),
    );
    let input = "<contact><pair geom1='g1' geom2='x'/></contact>";
    check_with_bodies(input, &format!("{pair}geom2: there is no geom \"x\""));
    let input = "<contact><pair geom1='g1' geom2='g1'/></contact>";
    check_with_bodies(input, &format!("{pair}a geom cannot pair with itself"));
    let free = "only hinge and slide joints can be used here, not ball and free joints";
    check_with_bodies(
        "<equality><joint joint1='f'/></equality>",
        &format!("mujoco/equality/joint: {free}"),
    );
    let input = "<tendon><fixed><joint joint='f' coef='1'/></fixed></tendon>";
    check_with_bodies(input, &format!("mujoco/tendon/fixed/joint: {free}"));
    check_with_bodies(
        "<tendon><fixed/></tendon>",
        "mujoco/tendon/fixed: the tendon has no joints",
    );
    let input = "<size nuser_actuator='1'/><actuator><motor joint='j' user='1 2'/></actuator>";
    check_with_bodies(
        input,
        "mujoco/actuator/motor: user has 2 values, more than nuser_actuator in <size>",
    );
    check_with_bodies(
        "<sensor><gyro site='x'/></sensor>",
        "mujoco/sensor/gyro: site: there is no site \"x\"",
    );
    check_with_bodies(
        "<equality><weld body1='h'/></equality><sensor><gyro site='s'/></sensor>",
        "",
    );
}

#[test]
fn frames_place_what_they_hold() {
    let text = "<mujoco><worldbody><frame pos='1 0 0' euler='0 0 90'><geom name='g' size='1' pos='1 0 0'/><frame pos='0 0 2'>
        <body name='b' pos='1 0 0'><frame euler='0 0 90'><joint pos='1 0 0' axis='1 0 0'/><inertial pos='1 0 0' mass='1' diaginertia='1 1 1'/>
        </frame></body></frame></frame></worldbody></mujoco>";
    let arrays = load_str(text, "m.xml", &source(&[]))
        .map(|spec| spec.arrays)
        .expect("valid");
    let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-15);
    assert!(near(arrays.geom_pos[0], [1.0, 1.0, 0.0]), "{:?}", arrays.geom_pos[0]);
    assert!(near(arrays.body_pos[1], [1.0, 1.0, 2.0]), "{:?}", arrays.body_pos[1]);
    assert!(near(arrays.jnt_pos[0], [0.0, 1.0, 0.0]) && near(arrays.jnt_axis[0], [0.0, 1.0, 0.0]));
    assert_eq!(arrays.body_ipos[1], [1.0, 0.0, 0.0], "an inertial stays in its body");
    check_world(
        "<frame><joint/></frame>",
        "frame/joint: the world has no joints and no inertia",
    );
    check_world("<frame childclass='x'/>", "frame: unknown default class \"x\"");
    let twice = "<body><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/><frame><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></frame></body>";
    check_world(twice, "body/frame/inertial: element \"inertial\" is given twice");
}

#[test]
fn textures_are_recipes_with_normalised_paths() {
    let texture = |attributes: &str| {
        let text = format!("<mujoco><asset><texture {attributes}/></asset></mujoco>");
        let assets = source(&[("tex/a.png", ""), ("kit/b.png", "")]);
        load_str(&text, "kit/m.xml", &assets)
            .map(|spec| spec.arrays.textures[0].clone())
            .map_err(|e| e.kind.to_string())
    };
    let found = texture("name='t' fileup='../tex/a.png' filedown='b.png'").unwrap();
    assert_eq!(found.cube_files[2].as_deref(), Some("tex/a.png"));
    assert_eq!(found.cube_files[3].as_deref(), Some("kit/b.png"));
    assert_eq!(texture("type='2d' file='./b.png'").unwrap().name, "b");
    let grid = texture("file='b.png' gridsize='2 3' gridlayout='.ULFRB'").unwrap();
    assert_eq!(grid.gridsize, [2, 3]);
    assert_eq!(grid.gridlayout, [None, Some(2), Some(1), Some(4), Some(0), Some(5)]);
    let error = |attributes| texture(attributes).unwrap_err();
    assert_eq!(error("name='t' file='a.png'"), "file \"kit/a.png\" does not exist");
    assert_eq!(
        error("file='b.png' gridsize='2 3' gridlayout='.U'"),
        "gridlayout must have a letter for each square of gridsize, row by row"
    );
    assert_eq!(
        error("file='b.png' gridsize='2 7'"),
        "gridsize must be two whole numbers, of no more than 12 squares in all"
    );
    assert_eq!(
        error("file='b.png' gridsize='1 2' gridlayout='.Q'"),
        "gridlayout may have the letters R, L, U, D, F and B, and dots"
    );
    let outside = "path \"../../a.png\" is not a relative path inside the asset source";
    assert_eq!(error("name='t' file='../../a.png'"), outside);
    assert_eq!(error("name='t'"), "the texture has neither a builtin nor a file");
    assert_eq!(
        error("name='t' builtin='flat'"),
        "a builtin texture needs a width, and if it is flat a height"
    );
    assert_eq!(
        error("type='2d' builtin='flat' width='1' height='1'"),
        "attribute \"name\" is required"
    );
    assert_eq!(error("name='t' width='20000'"), "width: 20000 must be from 0 to 16384");
}

#[test]
fn includes_splice_and_are_bounded() {
    assert_eq!(outcome("<mujoco><include file='other.xml'/></mujoco>"), "");
    check(
        "<include file='m.xml'/>",
        "mujoco/include: file \"m.xml\" is already included",
    );
    check(
        "<include file='other.xml'/><include file='./other.xml'/>",
        "mujoco/include: file \"other.xml\" is already included",
    );
    check(
        "<include file='none.xml'/>",
        "mujoco/include: file \"none.xml\" does not exist",
    );
    check("<include/>", "mujoco/include: attribute \"file\" is required");
    check(
        "<include file='other.xml' a='b'/>",
        "mujoco/include: unknown attribute \"a\"",
    );
    check(
        "<include file='other.xml'><geom/></include>",
        "mujoco/include/geom: unknown element \"geom\"",
    );
    for path in ["/etc/passwd", "../m.xml", "a/../../m.xml", "c:/x", "a\\b", ""] {
        let message = format!("mujoco/include: path \"{path}\" is not a relative path inside the asset source");
        check(&format!("<include file='{path}'/>"), &message);
    }
    let chain: Vec<(String, String)> = (0..20)
        .map(|k| (format!("{k}.xml"), format!("<a><include file='{}.xml'/></a>", k + 1)))
        .collect();
    let files: Vec<(&str, &str)> = chain
        .iter()
        .map(|(path, text)| (path.as_str(), text.as_str()))
        .collect();
    let error = load_str("<mujoco><include file='0.xml'/></mujoco>", "m.xml", &source(&files)).unwrap_err();
    assert_eq!(error.to_string(), "15.xml:1:4: a/include: more than 16 nested includes");
    let broken = source(&[("a.xml", "<a model='x' b='c'/>"), ("b.xml", "<a>")]);
    let error = |file: &str| {
        let text = format!("<mujoco><include file='{file}'/></mujoco>");
        load_str(&text, "m.xml", &broken).unwrap_err().to_string()
    };
    assert_eq!(error("a.xml"), "a.xml:1:1: a: unknown attribute \"b\"");
    assert_eq!(
        error("b.xml"),
        "b.xml:1:4: a: malformed XML: the file ends inside an element"
    );
}

#[test]
fn layers_and_embedded_files_are_found() {
    static FILES: &[(&str, &[u8])] = &[("kit/a.xml", b"<mujoco model='embedded'/>"), ("b.xml", b"\xff")];
    let below = EmbeddedAssets(FILES);
    let above = source(&[("kit/c.xml", "<mujoco model='above'/>")]);
    let both = Overlay::new(below).with(above);
    assert_eq!(load(&both, "kit/./a.xml").unwrap().name(), "embedded");
    assert_eq!(load(&both, "x/../kit/c.xml").unwrap().name(), "above");
    assert_eq!(load(&both, "b.xml").unwrap_err().to_string(), "b.xml: not UTF-8 text");
    assert_eq!(
        load(&both, "d.xml").unwrap_err().to_string(),
        "d.xml: file \"d.xml\" does not exist"
    );
    assert!(both.contains("b.xml") && !both.contains("d.xml"));
}

#[cfg(unix)]
#[test]
fn directories_do_not_leak() {
    let base = std::env::temp_dir().join(format!("babybench-assets-{}", std::process::id()));
    let root = base.join("root");
    std::fs::create_dir_all(root.join("kit")).unwrap();
    std::fs::write(base.join("secret.xml"), "<mujoco/>").unwrap();
    std::fs::write(root.join("kit/a.xml"), "<mujoco/>").unwrap();
    std::os::unix::fs::symlink(base.join("secret.xml"), root.join("kit/link.xml")).unwrap();
    std::os::unix::fs::symlink(root.join("kit/a.xml"), root.join("inner.xml")).unwrap();
    let assets = DirAssets::new(&root).unwrap();
    let small = DirAssets::with_limits(
        &root,
        &Limits {
            asset_bytes: 8,
            ..Limits::default()
        },
    )
    .unwrap();
    let too_large = small.read("kit/a.xml").unwrap_err().to_string();
    let outcomes = [
        "kit/a.xml",
        "inner.xml",
        "kit/link.xml",
        "../secret.xml",
        "kit",
        "none.xml",
        "kit/a.xml/b",
    ]
    .map(|path| assets.read(path).map(|bytes| bytes.len()).map_err(|e| e.to_string()));
    std::fs::remove_dir_all(&base).unwrap();
    assert_eq!(too_large, "file \"kit/a.xml\" is larger than 8 bytes");
    assert_eq!(outcomes[..2], [Ok(9), Ok(9)]);
    for (outcome, word) in outcomes[2..].iter().zip([
        "leads out of the folder",
        "inside",
        "a folder, not a regular file",
        "exist",
        "exist",
    ]) {
        assert!(outcome.as_ref().unwrap_err().contains(word), "{outcome:?}");
    }
}

#[test]
fn lights_follow_and_cameras_carry_numbers() {
    let modes = "not one of fixed, track, trackcom, targetbody, targetbodycom";
    check_world("<light mode='follow'/>", &format!("light: mode=\"follow\": {modes}"));
    check_world("<body name='a'/><light mode='targetbody' target='a'/>", "");
    check_world(
        "<light mode='targetbody' target='a'/>",
        "light: target: there is no body \"a\"",
    );
    check(
        "<default><light target='a'/></default>",
        "mujoco/default/light: unknown attribute \"target\"",
    );
    check_world("<camera user='1 2'/>", "");
    check(
        "<size nuser_cam='1'/><worldbody><camera user='1 2'/></worldbody>",
        "mujoco/worldbody/camera: user has 2 values, more than nuser_cam in <size>",
    );
    check("<visual><rgba contactforce='1 0 0 2'/></visual>", "");
    check(
        "<visual><rgba contactforce='1 0 0'/></visual>",
        "mujoco/visual/rgba: contactforce: 3 values, expected 4 to 4",
    );
    check(
        "<visual><rgba sky='1 0 0 1'/></visual>",
        "mujoco/visual/rgba: unknown attribute \"sky\"",
    );
}

#[test]
fn the_listing_explains_every_attribute() {
    let listed = elements();
    for (k, element) in listed.iter().enumerate() {
        assert!(
            listed[..k].iter().all(|other| other.path != element.path),
            "{}",
            element.path
        );
        for (k, a) in element.attributes.iter().enumerate() {
            let name = format!("{}/{}", element.path, a.name);
            assert!(a.meaning.ends_with('.') && !a.values.is_empty(), "{name}");
            assert!(
                element.attributes[..k].iter().all(|other| other.name != a.name),
                "{name}"
            );
        }
    }
    let find = |path: &str, name: &str| {
        let element = listed.iter().find(|element| element.path == path).unwrap();
        let found = element.attributes.iter().find(|attribute| attribute.name == name);
        let a = found.unwrap();
        (a.values.as_str(), a.default.as_str(), a.required, a.in_default)
    };
    let body = "worldbody/body";
    let of = |element: &str, name| find(&format!("{body}/{element}"), name);
    assert_eq!(
        of("geom", "friction"),
        ("1 to 3 numbers, at least 0", "1 0.005 0.0001", false, true)
    );
    assert_eq!(of("geom", "quat"), ("4 numbers, not all 0", "1 0 0 0", false, true));
    assert_eq!(of("geom", "name"), ("text", "", false, false));
    assert_eq!(of("inertial", "pos"), ("3 numbers", "", true, false));
    assert_eq!(of("site", "type").0, "sphere, capsule, ellipsoid, cylinder, box");
    assert_eq!(of("joint", "limited"), ("false, true, auto", "auto", false, true));
    assert_eq!(of("freejoint", "group"), ("whole number, 0 to 5", "0", false, false));
    assert_eq!(find("compiler", "angle"), ("radian, degree", "degree", false, false));
    assert_eq!(find("size", "nuser_cam"), ("whole number from -1", "", false, false));
}

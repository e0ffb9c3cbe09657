//! Every kind of error with its message, paths and limits.

mod bodies;
mod files;

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
    for text in ["<mujoco a=b/>", "<mujoco model=\"x/>", "<mujoco <a/>", "<!--"] {
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
    assert_eq!(
        outcome(dtd),
        "m.xml:1:1: a document type with entities is not allowed; remove it"
    );
    assert_eq!(outcome("<!DOCTYPE mujoco><?xml-stylesheet a?><mujoco/>"), "");
    // as in MuJoCo, text within elements says nothing
    check("some text", "");
    check("&amp;", "");
    assert_eq!(outcome("<mujoco/>text"), "m.xml:1:10: text is not allowed; remove it");
    check("<![CDATA[x]]>", "");
    // an ampersand that begins nothing is itself
    let named = load_str(
        "<mujoco model='a&b &nbsp; &#z; &amp;&#65;&#x42;&lt;'>a & b</mujoco>",
        "m.xml",
        &source(&[]),
    );
    assert_eq!(named.expect("loads").arrays.name, "a&b &nbsp; &#z; &AB<");
    check("<!-- \0 -->", "mujoco: a null character is not allowed; remove it");
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
    told(
        "motor joint='j' ctrlranges='0 1'",
        "unknown attribute \"ctrlranges\"; did you mean \"ctrlrange\"?",
    );
    told("motr joint='j'", "unknown element \"motr\"; did you mean \"motor\"?");
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
fn names_with_typing_errors_are_suggested() {
    let hand = "<worldbody><body name='left_hand'><geom size='1'/></body></worldbody>";
    check(
        &format!("{hand}<contact><exclude body1='left_hnad' body2='world'/></contact>"),
        "mujoco/contact/exclude: body1: there is no body \"left_hnad\"; did you mean \"left_hand\"?",
    );
    check(
        "<default><default class='smooth'/></default><worldbody><geom class='smoth' size='1'/></worldbody>",
        "mujoco/worldbody/geom: unknown default class \"smoth\"; did you mean \"smooth\"?",
    );
}

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
    check_with_bodies("<tendon><fixed><joint joint='f' coef='1'/></fixed></tendon>", "");
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
    assert_eq!(
        of("freejoint", "group"),
        ("whole number, -2147483648 to 2147483647", "0", false, false)
    );
    assert_eq!(find("compiler", "angle"), ("radian, degree", "degree", false, false));
    assert_eq!(find("size", "nuser_cam"), ("whole number from -1", "", false, false));
}

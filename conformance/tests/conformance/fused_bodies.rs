//! `fusestatic`: bodies without joints become part of what carries them, beside MuJoCo.

use conformance::differential::compare::{Sides, Taken};
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::Trial;
use testkit::trials;

use crate::agreement::agrees;

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: bodies_are_fused_as_in_mujoco, what_vanishes_is_checked_as_in_mujoco]
}

/// An arm with fixed parts: one in another, one with a mass of its own, one between two joints, one after what moves; one of the world.
const ARM: &str = "<worldbody><geom name='floor' type='plane' size='1 1 1'/>\
    <body name='arm' pos='0 0 1' euler='10 0 20'><joint/><joint type='slide' axis='1 0 1'/><geom name='own' size='.1'/><site name='first'/>\
    <body name='plate' pos='.3 0 0' euler='0 0 30'><site name='mark' pos='.1 0 0' euler='5 0 0'/>\
    <geom name='flat' type='box' size='.1 .05 .02' pos='.1 0 0' euler='0 20 0' margin='.01'/>\
    <body pos='.1 .1 0' euler='40 0 0' gravcomp='1'><geom type='capsule' size='.03 .1'/><inertial pos='.1 0 0' mass='2' diaginertia='1 .9 .8'/></body>\
    <body name='hand' pos='0 .2 0' euler='0 50 0'><joint axis='1 0 0' springdamper='.5 1'/><geom size='.05' pos='.1 0 0'/>\
    <body name='finger' pos='.1 .05 0'><geom name='tip' size='.02 .05 .03' type='ellipsoid'/></body></body></body>\
    <body pos='0 -.2 0'><joint/><geom name='last' size='.05 .1' type='cylinder'/></body><geom name='end' size='.02' pos='.2 0 .1'/></body>\
    <body name='post' pos='1 0 .5' euler='0 0 45'><geom name='pole' type='box' size='.1 .1 .5' contype='2'/>\
    <body name='bell' pos='.2 .1 .4'><joint type='ball'/><geom size='.05' pos='0 .1 -.1'/></body></body>\
    <body pos='0 3 0' euler='0 30 0'><body pos='1 0 0'><body pos='0 0 1'><free/><geom type='box' size='.1 .2 .3'/></body></body></body>\
    <body name='target' mocap='true' pos='0 1 0'><geom size='.1' contype='0' conaffinity='0'/></body></worldbody>";

/// Rests of the document, each with the number of bodies that are left: everything that may name a body keeps all of them.
const RESTS: [(&str, usize); 12] = [
    ("", 7),
    (
        "<keyframe><key qpos='.1 .2 .3 .4 1 0 0 0 1 2 3 1 0 0 0' mpos='1 2 3'/></keyframe>",
        7,
    ),
    (
        "<custom><numeric name='n' data='1'/><text name='t' data='x'/></custom>",
        6,
    ),
    ("<compiler settotalmass='5' boundmass='.01'/>", 7),
    ("<actuator><motor joint='swing'/></actuator>", 13),
    ("<sensor><clock/></sensor>", 13),
    ("<contact><exclude body1='arm' body2='hand'/></contact>", 13),
    ("<contact><pair geom1='tip' geom2='floor'/></contact>", 13),
    ("<equality><joint joint1='swing'/></equality>", 13),
    ("<tendon><fixed><joint joint='swing' coef='1'/></fixed></tendon>", 13),
    ("<worldbody><camera/></worldbody>", 13),
    ("<worldbody><light/></worldbody>", 13),
];

fn bodies_are_fused_as_in_mujoco() {
    let arm = ARM.replacen("<joint/>", "<joint name='swing'/>", 1);
    for (rest, bodies) in RESTS {
        // a free joint may be in a fixed body that vanishes
        let free = if bodies == 7 { "<freejoint/>" } else { "" };
        let arm = arm.replace("<free/>", free);
        let text = format!("<mujoco><compiler fusestatic='true'/>{arm}{rest}</mujoco>");
        let mut sides = match Sides::load(needed(), &text) {
            Taken::Both(sides) => sides,
            _ => panic!("one side refuses {text}"),
        };
        assert_eq!(sides.model.nbody(), bodies, "{rest}");
        agrees(&mut sides, rest);
    }
}

fn what_vanishes_is_checked_as_in_mujoco() {
    for (settings, part) in [
        ("<size nuser_body='2'/>", "<body user='1 2 3'><geom size='.1'/></body>"),
        (
            "",
            "<body><geom size='.1'/><body mocap='true'><geom size='.1'/></body></body>",
        ),
        ("", "<body><body mocap='true'><joint/><geom size='.1'/></body></body>"),
        ("", "<body><geom type='box' size='.1'/></body>"),
        ("", "<body><inertial pos='0 0 0' mass='1' diaginertia='1 1 5'/></body>"),
        ("", "<body quat='0 0 0 0'><geom size='.1'/></body>"),
    ] {
        let text = format!("<mujoco><compiler fusestatic='true'/>{settings}<worldbody>{part}</worldbody></mujoco>");
        let taken = Sides::load(needed(), &text);
        assert!(matches!(taken, Taken::Refused(_)), "one side takes {text}");
    }
}

//! Bodies and what hangs on them: values, orientations, frames, lights and cameras.

use super::*;

#[test]
fn values_are_checked() {
    check_world("<geom size='a'/>", "geom: size: \"a\" is not a finite number");
    check_world("<geom size='nan'/>", "geom: size: \"nan\" is not a finite number");
    check_world("<geom size='1e999'/>", "geom: size: \"1e999\" is not a finite number");
    check_world("<geom pos='0 0 -inf'/>", "geom: pos: \"-inf\" is not a finite number");
    check_world("<geom size='-1'/>", "geom: size: -1 must be at least 0");
    let missing = "geom: size: 0 must be positive (number";
    check_world("<geom size='0'/>", &format!("{missing} 1 of 1 for a sphere)"));
    check_world("<geom size=''/>", &format!("{missing} 1 of 1 for a sphere)"));
    check_world(
        "<geom size='.1 .1' type='box'/>",
        &format!("{missing} 3 of 3 for a box)"),
    );
    check_world("<geom size='1 1 1 1'/>", "geom: size: 4 values, expected 1 to 3");
    check_world("<geom size='1' pos='1 2'/>", "geom: pos: 2 values, expected 3");
    check_world("<geom size='1' rgba='1 1 1 2'/>", "");
    check(
        "<asset><material name='m' shininess='2'/></asset>",
        "mujoco/asset/material: shininess: 2 must be between 0 and 1",
    );
    check_world("<geom size='1' contype='-1'/>", "");
    check_world(
        "<geom size='1' contype='2147483648'/>",
        "geom: contype: 2147483648 must be from -2147483648 to 2147483647",
    );
    check_world(
        "<geom size='1' contype='1.5'/>",
        "geom: contype: \"1.5\" is not a finite number",
    );
    check_world("<geom size='1' condim='2'/>", "geom: condim must be 1, 3, 4 or 6");
    check_world("<geom size='1' type='box'/>", &format!("{missing} 2 of 3 for a box)"));
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
        "<size nuser_actuator='257'/>",
        "mujoco/size: nuser_actuator: 257 must be from -1 to 256",
    );
    check("<extension/>", "");
    let plugin = "<extension><plugin plugin='mujoco.pid'/></extension>";
    check(
        plugin,
        "mujoco/extension/plugin: plugin \"mujoco.pid\" is a program of MuJoCo's own, which is not run here: write actuators of position, and of \
         intvelocity for the integral",
    );
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
    check_world("<camera mode='targetbody'/>", "");
    check_world("<camera fovy='180'/>", "camera: fovy: 180 must be below 180 degrees");
    check_world("<light dir='0 0 0'/>", "light: the direction is too short");
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
        "mujoco/visual/rgba: contactforce: 3 values, expected 4",
    );
    check(
        "<visual><rgba sky='1 0 0 1'/></visual>",
        "mujoco/visual/rgba: unknown attribute \"sky\"",
    );
}

#[test]
fn what_is_only_drawn_is_left_out_and_still_weighs() {
    let world = "<asset><texture name='t' type='2d' file='not_there.png'/><material name='m' texture='t'/></asset>\
        <worldbody><body><freejoint/><geom name='a' size='.1' material='m'/>\
        <geom name='drawn' size='.2' contype='0' conaffinity='0'/><geom size='.3' contype='0'/></body></worldbody>";
    let load = |compiler: &str| {
        let text = format!(
            "<mujoco>{compiler}{}</mujoco>",
            world.replace(" file='not_there.png'", " builtin='flat' width='4' height='4'")
        );
        load_str(&text, "m.xml", &source(&[])).unwrap().arrays
    };
    let (all, left) = (load(""), load("<compiler discardvisual='true'/>"));
    assert_eq!((all.geom_name.len(), left.geom_name.len()), (3, 2));
    assert_eq!(
        (left.materials.len(), left.textures.len(), left.geom_matid[0]),
        (0, 0, None)
    );
    assert_eq!((left.body_mass, left.body_inertia), (all.body_mass, all.body_inertia));

    let left_out = format!("<compiler discardvisual='true'/>{world}");
    check(&left_out, "");
    check(
        &format!(
            "{left_out}<sensor><framepos objtype='body' objname='world' reftype='geom' refname='drawn'/></sensor>"
        ),
        "mujoco/sensor/framepos: discardvisual=\"true\" leaves out geoms in front of the one to which this sensor refers, of which \
         MuJoCo loses count: refer to a site or a body, or leave discardvisual out",
    );
    check(
        &format!("{left_out}<worldbody><site material='m'/></worldbody>"),
        "mujoco/worldbody/site: discardvisual=\"true\" leaves out all materials, and MuJoCo then finds none but those of geoms: remove \
         this material",
    );
}

#[test]
fn groups_of_any_sign_and_unknown_attributes_of_frames_are_taken() {
    let world = "<geom size='1' group='-3'/><site group='7'/><frame foo='a'><geom size='1'/></frame>\
        <replicate count='2' prefix='a'><geom name='g' size='1'/></replicate>";
    let text = format!("<mujoco><worldbody>{world}</worldbody></mujoco>");
    let arrays = load_str(&text, "m.xml", &source(&[])).expect("loads").arrays;
    assert_eq!((arrays.geom_group, arrays.site_group), (vec![-3, 0, 0, 0], vec![7]));
    assert_eq!(arrays.geom_name[2..], ["g0", "g1"]);
    check_world("<frame pos='a'/>", "frame: pos: 1 value, expected 3");
}

#[test]
fn names_beside_copies_are_used_once() {
    let lost = "<worldbody><replicate count='2'><site name='a'/></replicate><site name='b'/></worldbody>\
        <tendon><spatial name='t'><site site='a'/><site site='b'/></spatial></tendon>\
        <actuator><motor name='m' tendon='t0'/><motor name='m' tendon='t1'/></actuator>";
    check(lost, "mujoco/actuator/motor: actuator name \"m\" is used twice");
}

#[test]
fn zeros_and_negative_counts_say_nothing() {
    let servo = |attributes: &str| {
        let text = format!(
            "<mujoco><size nkey='-5'/><worldbody><body><joint name='j'/><geom size='1'/></body></worldbody>\
             <actuator><position joint='j' kp='3' {attributes}/></actuator></mujoco>"
        );
        let arrays = load_str(&text, "m.xml", &source(&[])).expect("loads").arrays;
        assert!(arrays.keys.is_empty());
        arrays.actuator_biasprm[0][2]
    };
    assert_eq!(servo("kv='1' dampratio='0'"), -1.0);
    assert_eq!(servo("kv='0' dampratio='1'"), 1.0);
    assert_eq!(servo("kv='0\u{b}' dampratio='0'"), 0.0);
    check_with_bodies(
        "<actuator><position joint='j' kv='1' dampratio='1'/></actuator>",
        "mujoco/actuator/position: kv and dampratio are two ways to say the same: give one of them",
    );
}

//! Flexes beside MuJoCo 3.3.0: what is taken, the compiled arrays, steps from random states.

use conformance::differential::compare::{Sides, Stepped, Taken};
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::Trial;
use testkit::{Rng, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: shapes_of_flexcomps_agree, flexes_of_bodies_agree, faults_of_flexes_are_refused_alike,
        flexes_touch_geoms_alike, parameters_of_contacts_agree, flexes_touch_each_other_alike,
        flexes_touch_themselves_alike]
}

/// Bits that no geom meets; without any MuJoCo 3.3.0 crashes.
const ALONE: &str = "<contact contype='2' conaffinity='0' selfcollide='none' internal='false'/>";
const HELD: &str = "<edge equality='true' solref='.01 .8' solimp='.8 .9 .01 .4 3' damping='.01'/>";
const SOFT: &str = "<elasticity young='3e2' poisson='.2' thickness='1e-2' damping='.002'/>";

/// Checks that all compiled arrays agree, and steps from states out of balance: at rest the constraints consist of rounding errors. Returns
/// how many contacts the states have together.
fn agrees(sides: &mut Sides, what: &str) -> usize {
    let mut touching = 0;
    for measured in sides.arrays() {
        assert!(measured.agrees(), "{what}: {measured:?}");
    }
    for seed in 0..10 {
        let (mut state, mut rng) = (sides.new_state(), Rng::with_seed(seed));
        state.qpos.iter_mut().for_each(|v| *v += 0.02 * rng.f64() - 0.01);
        state.qvel.iter_mut().for_each(|v| *v = 0.6 * rng.f64() - 0.3);
        let Stepped::Compared { measured, contacts, .. } = sides.step_from(&state) else {
            panic!("{what}: state {seed} is not compared");
        };
        touching += contacts;
        measured
            .iter()
            .for_each(|measured| assert!(measured.agrees(), "{what}: state {seed}, {measured:?}"));
    }
    touching
}

fn compare(world: &str, behind: &str) -> usize {
    let defaults = "<option timestep='.001'/><default><joint damping='.05' armature='.01'/></default>";
    compare_document(&format!(
        "<mujoco>{defaults}<worldbody>{world}</worldbody>{behind}</mujoco>"
    ))
}

fn compare_document(text: &str) -> usize {
    let mut sides = match Sides::load(needed(), text) {
        Taken::Both(sides) => sides,
        Taken::ByOne(measured) => panic!("{measured:?}: {text}"),
        Taken::Refused(why) => panic!("{why}: {text}"),
        Taken::Stricter(why) => panic!("{why}: {text}"),
    };
    assert!(sides.model.nflex() > 0, "{text}");
    agrees(&mut sides, text)
}

/// A `<flexcomp>` with a mass of 2 kg, of points 10 cm apart or so.
fn comp(attributes: &str, inside: &str) -> String {
    format!("<flexcomp name='c' mass='2' spacing='.1 .12 .08' {attributes}>{ALONE}{inside}</flexcomp>")
}

fn shapes_of_flexcomps_agree() {
    for (attributes, inside) in [
        (
            "type='grid' dim='1' count='8 1 1'",
            "<edge stiffness='10' damping='.1'/><pin id='0'/>",
        ),
        ("type='grid' dim='1' count='8 1 1' pos='0 0 1' euler='10 20 30'", HELD),
        ("type='circle' dim='1' count='9 1 1'", HELD),
        (
            "dim='2' count='5 4 1' group='1' rgba='1 0 .5 .3'",
            "<pin gridrange='0 0 0 3'/>",
        ),
        ("dim='2' count='5 4 1' flatskin='true'", "<pin grid='0 0 4 3'/>"),
        (
            "type='square' count='4 4 1' axisangle='0 1 0 20'",
            "<pin id='1 3'/><pin range='5 7'/>",
        ),
        ("type='disc' count='5 5 1'", ""),
        ("type='box' count='4 3 5' pos='0 0 1'", ""),
        ("type='cylinder' count='4 3 5' pos='0 0 1'", "<pin id='0 4'/>"),
        ("type='ellipsoid' count='4 3 5' pos='0 0 1'", ""),
        (
            "dim='3' count='3 4 3' pos='0 0 1' inertiabox='.02'",
            "<pin gridrange='0 0 0 0 3 2' grid='2 2 2'/>",
        ),
        ("dim='3' count='4 4 4'", "<pin grid='1 1 1'/>"),
        ("type='ellipsoid' dof='radial' count='4 3 5'", ""),
        (
            "type='direct' point='0 0 0 1 0 0 1 1 0 0 1 0 5 5 5 2 0 .5' element='0 1 2 0 2 3 1 5 2' scale='.1 .2 .3'",
            "",
        ),
        (
            "type='direct' dim='3' point='0 0 0 1 0 0 0 1 0 0 0 1 1 1 1' element='0 1 2 3 4 3 2 1' texcoord='0 0 1 0 1 1 0 1 .5 .5'",
            "<pin id='1'/>",
        ),
    ] {
        let lines = attributes.contains("dim='1'");
        let own = if lines && inside.contains("<edge") { "" } else { HELD };
        let whole = comp(attributes, &format!("{own}{inside}"));
        compare(&whole, "");
        if !lines {
            compare(&comp(attributes, &format!("{SOFT}{inside}")), "");
        }
        // on a body that moves
        let body = format!(
            "<body name='p' pos='0 0 1'><joint type='ball'/><geom size='.05' pos='.1 0 0'/>{whole}<body><joint/><geom size='.02'/></body></body>"
        );
        compare(&body, "");
    }
    let rigid = comp("type='box' count='3 3 3' rigid='true'", "");
    compare(
        &format!("<body name='p'><freejoint/><geom size='.05'/>{rigid}</body>"),
        "",
    );
    let textured = "<asset><material name='m'/></asset>";
    for shape in [
        "type='box' count='3 4 3'",
        "dim='2' count='3 4 1'",
        "dim='3' count='3 4 2'",
    ] {
        compare(&comp(&format!("{shape} material='m'"), ""), textured);
    }
}

fn flexes_of_bodies_agree() {
    let bodies: String = (0..5)
        .map(|i| {
            format!("<body name='b{i}' pos='.{i} 0 1'><joint type='ball'/><geom size='.03' pos='0 .05 0'/></body>")
        })
        .collect();
    let flexes = format!(
        "<deformable><flex name='f' dim='1' body='b0 b1 b2 b3 b4' vertex='0 .1 0 0 .1 0 0 .1 0 0 .1 0 0 .1 .02'
         element='0 1 1 2 2 3 3 4'>{ALONE}<edge stiffness='20' damping='.5'/></flex>
         <flex name='g' body='b0 b1 b2 world' element='0 1 2 1 2 3' vertex='0 .1 0 0 .1 .1 0 .1 0 .3 .1 1.1'>{ALONE}{SOFT}<edge damping='.5'/></flex>
         <flex name='h' dim='3' body='b0' element='0 1 2 3' vertex='0 .1 0 0 .1 .1 0 .1 .3 .3 .1 1.1'>{ALONE}</flex></deformable>"
    );
    compare(&bodies, &flexes);
    let held = "<equality><flex flex='f' solref='.02 1' active='false'/><flex name='e' flex='g'/></equality>";
    let sensors = "<sensor><e_potential/></sensor>";
    compare(&bodies, &format!("{flexes}{held}{sensors}"));
}

fn faults_of_flexes_are_refused_alike() {
    for flexcomp in [
        "count='1 1 1'",
        "count='3 3'",
        "count='3 3 0'",
        "count='3 3 3'",
        "spacing='.001 .1 .1' count='3 3 1'",
        "count='3 3 1' mass='0'",
        "count='3 3 1' inertiabox='-1'",
        "count='3 3 1' dim='4'",
        "count='3 3 1' dim='2' texcoord='0 0'",
        "type='direct' point='0 0 0 1 0 0' element='0 1'",
        "type='direct' point='0 0 0 1 0 0 1 1 0' element='0 1 3'",
        "type='direct' point='0 0 0 1 0 0 1 1 0' element='0 1 1'",
        "type='mesh'",
        "type='mesh' file='none.stl'",
        "type='ball'",
        "type='direct' point='0 0 0 1 0 0 1 1 0' element='0 1 2' material='none'",
    ] {
        refused(&format!("<flexcomp name='c' {flexcomp}>{ALONE}</flexcomp>"));
    }
    for inside in [
        "<pin id='9'/>",
        "<pin id='-1'/>",
        "<pin range='1'/>",
        "<pin grid='1'/>",
        "<pin grid='1 3'/>",
        "<pin gridrange='0 0 1'/>",
        "<edge stiffness='1'/>",
        "<edge equality='true'/><elasticity young='1'/>",
        "<elasticity young='1' poisson='.5' thickness='1'/>",
        "<edge/><edge/>",
    ] {
        refused(&format!("<flexcomp name='c' count='3 3 1'>{ALONE}{inside}</flexcomp>"));
    }
    refused("<flexcomp count='3 3 1'/>");
    refused("<body><geom size='.1'/><flexcomp name='c' count='3 3 1'/></body>");
}

fn refused(world: &str) {
    let text = format!("<mujoco><worldbody>{world}</worldbody></mujoco>");
    let taken = Sides::load(needed(), &text);
    assert!(matches!(taken, Taken::Refused(_)), "one side takes {text}");
}

const CLOTH: &str = "dim='2' count='4 4 1' mass='.2' spacing='.05 .05 .05' radius='.01'";
const ROPE: &str = "dim='1' count='6 1 1' mass='.2' spacing='.05 .05 .05' radius='.01'";
const CUBE: &str = "dim='3' count='3 3 3' mass='.2' spacing='.05 .05 .05' radius='.005'";
const PLANE: &str = "<geom type='plane' size='1 1 1'/>";
const OUTSIDE: &str = "selfcollide='none' internal='false'";

/// A flex at a place, with the attributes of its contacts.
fn touching(name: &str, shape: &str, place: &str, contact: &str) -> String {
    let elastic = if shape.contains("dim='3'") {
        "<elasticity young='1e3' poisson='.1' damping='.01'/>"
    } else {
        "<edge equality='true' damping='.01'/>"
    };
    format!("<flexcomp name='{name}' {shape} {place}><contact {contact}/>{elastic}</flexcomp>")
}

/// Compares a document whose flexes touch something.
fn collide(options: &str, world: &str, behind: &str) {
    let text = format!("<mujoco>{options}<worldbody>{world}</worldbody>{behind}</mujoco>");
    assert!(compare_document(&text) > 0, "nothing touches: {text}");
}

fn flexes_touch_geoms_alike() {
    let assets = "<asset><mesh name='m' vertex='-.1 -.1 -.1 .1 -.1 -.1 0 .1 -.1 0 0 .1 .1 .1 .05'/></asset>";
    for (geom, height) in [
        ("type='plane' size='1 1 1' euler='2 3 0'", 0.01),
        ("type='sphere' size='.08'", 0.08),
        ("type='capsule' size='.05 .08' euler='20 70 0'", 0.06),
        ("type='box' size='.08 .07 .06' euler='5 8 0'", 0.07),
        ("type='cylinder' size='.08 .06' euler='5 8 0'", 0.07),
        ("type='ellipsoid' size='.08 .06 .1'", 0.1),
        ("type='mesh' mesh='m'", 0.06),
    ] {
        for (shape, above) in [(CLOTH, 0.0), (ROPE, 0.0), (CUBE, 0.05)] {
            let place = format!("pos='0 0 {}'", height + above);
            for condim in [1, 3] {
                let flex = touching("c", shape, &place, &format!("condim='{condim}' {OUTSIDE}"));
                let geom = format!("<geom condim='{condim}' {geom}/>");
                collide("", &format!("{geom}{flex}"), assets);
                if !geom.contains("plane") && condim == 3 {
                    collide("", &format!("<body><freejoint/>{geom}</body>{flex}"), assets);
                }
            }
        }
    }
}

fn parameters_of_contacts_agree() {
    let contact = format!(
        "friction='.4 .01 .001' margin='.01' gap='.004' solref='.03 1' solimp='.8 .9 .01' solmix='2' {OUTSIDE}"
    );
    let solid = "<geom type='box' size='.08 .07 .06' friction='.7 .02 .002' margin='.005' solref='.01 .9'/>";
    let cloth = touching("c", CLOTH, "pos='0 0 .07'", &contact);
    for options in [
        "<option cone='elliptic'/>",
        "<option jacobian='dense'/>",
        "<option jacobian='sparse' cone='elliptic' impratio='3'/>",
        "<option><flag midphase='disable'/></option>",
        "<option><flag nativeccd='disable'/></option>",
        "<option timestep='.001' integrator='RK4'/>",
        "<option integrator='implicitfast'/>",
    ] {
        collide(options, &format!("{solid}{cloth}"), "");
    }
    let cube = touching("c", CUBE, "pos='0 0 .12'", "priority='2' friction='.1 .01 .001'");
    collide("", &format!("{solid}{PLANE}{cube}"), "");
    for layers in [1, 2] {
        let contact = format!("activelayers='{layers}' {OUTSIDE}");
        let large = CUBE.replace("3 3 3", "4 4 4");
        let cube = touching("c", &large, "pos='0 0 .08'", &contact);
        collide("", &format!("{solid}{cube}"), "");
    }
    // bits that meet in one direction alone
    let cloth = touching(
        "c",
        CLOTH,
        "pos='0 0 .07'",
        &format!("contype='4' conaffinity='2' {OUTSIDE}"),
    );
    let alone = solid.replace("<geom", "<geom contype='2' conaffinity='8'");
    collide("", &format!("{alone}{cloth}"), "");
    let felt =
        "<body><freejoint/><geom type='box' size='.08 .07 .06'/><site name='s' type='box' size='.1 .1 .1'/></body>";
    let sensors = "<sensor><touch site='s'/><force site='s'/><torque site='s'/><accelerometer site='s'/></sensor>";
    let cloth = touching("c", CLOTH, "pos='0 0 .07'", OUTSIDE);
    collide("", &format!("{felt}{cloth}"), sensors);
}

fn flexes_touch_each_other_alike() {
    let above = |shape: &str| if shape == CUBE { 0.05 } else { 0.0 };
    for first in [CLOTH, ROPE, CUBE] {
        for second in [CLOTH, ROPE, CUBE] {
            let place = format!("pos='.01 .02 {}' euler='0 0 30'", 0.01 + above(first) + above(second));
            for condim in [1, 3] {
                let contact = format!("condim='{condim}' {OUTSIDE}");
                let one = touching("c", first, "pos='0 0 0'", &contact);
                let other = touching("e", second, &place, &contact);
                collide("", &format!("{one}{other}"), "");
            }
        }
    }
    let one = touching("c", CUBE, "pos='0 0 .05'", OUTSIDE);
    let other = touching("e", CLOTH, "pos='0 0 .11'", OUTSIDE);
    collide("", &format!("{PLANE}{one}{other}"), "");
    let rigid = format!(
        "<body name='a'><freejoint/><geom size='.02'/><flexcomp name='r' {CUBE} rigid='true'><contact {OUTSIDE}/></flexcomp></body>"
    );
    collide("", &format!("{rigid}{other}{PLANE}"), "");
}

fn flexes_touch_themselves_alike() {
    // points are hardly farther apart than they are thick
    let near = |shape: &str| shape.replace(".05 .05 .05", ".03 .03 .03").replace("='.005'", "='.01'");
    // pairs that MuJoCo finds in its tree come in another order: `bvh`, and `auto` of a cube
    for way in ["narrow", "sap", "auto"] {
        for shape in [CLOTH, ROPE, CUBE]
            .into_iter()
            .filter(|shape| way != "auto" || *shape != CUBE)
        {
            for condim in [1, 3] {
                let contact = format!("condim='{condim}' selfcollide='{way}' internal='false'");
                collide("", &touching("c", &near(shape), "", &contact), "");
            }
        }
    }
    for shape in [CLOTH, ROPE, CUBE] {
        let inside = touching("c", &near(shape), "pos='0 0 .05'", "internal='true' selfcollide='none'");
        collide("", &format!("{inside}<geom type='sphere' size='.03'/>"), "");
        if shape == CUBE {
            continue;
        }
        // as it is without attributes
        let both = touching("c", &near(shape), "pos='0 0 .02'", "");
        collide("", &format!("{PLANE}{both}"), "");
    }
}

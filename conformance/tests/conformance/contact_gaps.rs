//! Contacts of geoms that hardly touch, or nearly: MuJoCo's routines find some where there is a gap, and its boxes leave those of bodies with several
//! geoms out.

use babybench::physics::Engine;
use conformance::differential::compare::{Sides, Taken};
use conformance::differential::dice::{Dice, numbers};
use conformance::mujoco::{MUJOCO, Mujoco, needed};
use testkit::harness::Trial;
use testkit::trials;

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: gaps_are_those_of_mujoco, trees_leave_out_the_same_contacts]
}

/// Distances between the surfaces beyond the margin, m: from clear penetration to a clear gap, across the tolerance of 1e-6 m.
const GAPS: [f64; 11] = [-1e-3, -1e-6, -1e-9, 2e-9, 1e-7, 2.5e-7, 6e-7, 9e-7, 1.1e-6, 1e-5, 1e-3];

/// The upper body: its geom, and how far its lowest point is below its centre.
const UPPER: [(&str, f64); 5] = [
    ("type='cylinder' size='.2 .25'", 0.25),
    ("type='box' size='.2 .2 .25'", 0.25),
    ("type='ellipsoid' size='.2 .2 .25'", 0.25),
    ("type='capsule' size='.1 .15'", 0.25),
    ("type='sphere' size='.25'", 0.25),
];

/// Another geom of a body, out of the way, which turns its axes of inertia.
const MORE: &str = "<geom size='.05' pos='2 1 .5' mass='3'/>";

fn document(upper: &str, [below, above]: [bool; 2], [lower_margin, upper_margin]: [f64; 2]) -> String {
    let more = |given: bool| if given { MORE } else { "" };
    format!(
        "<mujoco><worldbody>\
         <body euler='20 -10 30'><geom type='cylinder' size='.3 .25' margin='{lower_margin}'/>{}</body>\
         <body euler='20 -10 30'><freejoint/><geom {upper} margin='{upper_margin}'/>{}</body></worldbody></mujoco>",
        more(below),
        more(above),
    )
}

fn gaps_are_those_of_mujoco() {
    let api = needed();
    let mut with_gap = 0;
    for (upper, low) in UPPER {
        for several in [[false, false], [true, false], [false, true], [true, true]] {
            for margins in [[0.0, 0.0], [0.01, 0.0], [0.01, 0.02]] {
                let sides = load(api, &document(upper, several, margins));
                with_gap += compare(sides, low, margins[0].max(margins[1]));
            }
        }
    }
    assert!(with_gap >= 3, "MuJoCo finds contacts in {with_gap} gaps alone");
}

fn load(api: &'static Mujoco, text: &str) -> Sides {
    match Sides::load(api, text) {
        Taken::Both(sides) => *sides,
        _ => panic!("one side refuses {text}"),
    }
}

/// Compares all gaps; returns the number of contacts where there is a gap beyond the margin.
fn compare(mut sides: Sides, low: f64, margin: f64) -> usize {
    let model = sides.model.clone();
    let upper = (0..model.ngeom())
        .find(|&g| model.geom_bodyid[g] == 2)
        .expect("its geom");
    let mut found = 0;
    for gap in GAPS {
        let mut state = sides.new_state();
        sides.engine().forward(&mut state).expect("finite");
        // along the axis of the lower cylinder, a little off it
        let axis = |k: usize| (0..3).map(|row| state.geom_xmat[0][3 * row + k]).collect::<Vec<_>>();
        let (x, z) = (axis(0), axis(2));
        let mut start = sides.new_state();
        for k in 0..3 {
            start.qpos[k] = state.geom_xpos[0][k] + 0.013 * x[k] + (0.25 + low + margin + gap) * z[k];
        }
        assert!(sides.step_mujoco(&start));
        let theirs: Vec<f64> = sides.simulation().contacts().iter().map(|c| c.dist).collect();
        let mut ours = sides.new_state();
        ours.copy_dynamic_from(&start);
        sides.engine().step(&mut ours).expect("steps");
        let ours: Vec<f64> = ours.contact.iter().map(|c| c.dist).collect();
        assert_eq!(
            ours, theirs,
            "{:?}, margin {margin}, gap {gap:e}",
            model.geom_type[upper]
        );
        found += usize::from(gap > 0.0) * ours.len();
    }
    found
}

/// Two bodies of some boxes each, over a floor with others, near enough to each other for the routine for two boxes to find contacts beyond the margin.
fn boxes(dice: &mut Dice, midphase: &str) -> String {
    let part = |dice: &mut Dice| {
        let margin = dice.pick(&[0.0, 0.05, 0.2]);
        let size = (0..3).map(|_| dice.uniform(0.05, 0.3)).collect::<Vec<_>>();
        format!(
            "<geom type='box' size='{}' pos='{}' quat='{}' margin='{margin}'/>",
            numbers(&size),
            numbers(&dice.vector(3, 0.1)),
            numbers(&dice.vector(4, 1.0)),
        )
    };
    let mut parts = |count: usize| (0..count).map(|_| part(dice)).collect::<String>();
    let (world, bodies) = (parts(2), [parts(1), parts(2), parts(5)]);
    let bodies = bodies.map(|parts| format!("<body><freejoint/>{parts}</body>")).concat();
    format!(
        "<mujoco><option><flag midphase='{midphase}'/></option><worldbody>\
         <geom type='plane' size='0 0 1' pos='0 0 -1' euler='10 20 0'/>{world}{bodies}</worldbody></mujoco>"
    )
}

fn trees_leave_out_the_same_contacts() {
    let (api, mut left_out) = (needed(), 0);
    for seed in 0..1000 {
        let mut counts = ["enable", "disable"].map(|midphase| {
            let mut dice = Dice::new(seed);
            let mut sides = load(api, &boxes(&mut dice, midphase));
            let mut counts = Vec::new();
            for _ in 0..20 {
                let mut start = sides.new_state();
                for body in start.qpos.chunks_mut(7) {
                    body[..3].copy_from_slice(&dice.vector(3, 0.7));
                    body[3..].copy_from_slice(&dice.vector(4, 1.0));
                }
                assert!(sides.step_mujoco(&start));
                let theirs: Vec<[usize; 2]> = sides.simulation().contacts().iter().map(|c| c.geom).collect();
                let mut ours = sides.new_state();
                ours.copy_dynamic_from(&start);
                sides.engine().step(&mut ours).expect("steps");
                let ours: Vec<[usize; 2]> = ours.contact.iter().map(|c| c.geom).collect();
                assert_eq!(ours, theirs, "seed {seed}, midphase {midphase}");
                counts.push(theirs.len());
            }
            counts
        });
        let [with, without] = &mut counts;
        left_out += without.iter().sum::<usize>() - with.iter().sum::<usize>();
    }
    assert!(left_out >= 2, "the trees leave {left_out} contacts out alone");
}

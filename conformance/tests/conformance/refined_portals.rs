//! Convex collision by Minkowski portal refinement (`nativeccd="disable"`), beside MuJoCo's, which calls libccd: contacts and distances of
//! every pair of shapes, in any pose and in those in which farthest points are not single.

use babybench::physics::{Engine, State};
use conformance::differential::compare::{Sides, Taken};
use conformance::differential::dice::{Dice, numbers};
use conformance::measure::{max_abs, relative};
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        needs MUJOCO: contacts_of_pairs_are_those_of_mujoco,
        contacts_with_height_fields_are_those_of_mujoco,
        limits_of_the_search_are_those_of_mujoco,
        special_poses_are_those_of_mujoco,
        the_flag_makes_a_difference
    ]
}

/// Kinds of geoms; meshes with few corners, with a face that is level, and round.
const KINDS: [&str; 8] = [
    "sphere",
    "capsule",
    "ellipsoid",
    "cylinder",
    "box",
    "chip",
    "crate",
    "globe",
];

/// Documents of each pair of kinds, and poses in each.
const DOCUMENTS: u64 = 5;
const POSES: usize = 40;

/// Largest distance of what sensors measure, m: points are calculated from the bits of contacts in another order.
const DISTANCE: f64 = 1e-12;

/// Largest relative distance of accelerations, which a solver ends with.
const MOTION: f64 = 1e-7;

/// Flags with which contacts are found so.
const FLAGS: [&str; 2] = ["nativeccd='disable'", "nativeccd='disable' multiccd='enable'"];

/// Writes the points of a mesh.
fn vertices(dice: &mut Dice, kind: &str) -> String {
    let size: Vec<f64> = (0..3).map(|_| dice.uniform(0.06, 0.2)).collect();
    let mut points = match kind {
        "chip" => {
            let corners = [1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0, 1.0, -1.0, -1.0, -1.0, 1.0];
            let moved = dice.vector(12, 0.4);
            corners.iter().zip(moved).map(|(x, by)| x + by).collect()
        }
        "crate" => (0..24)
            .map(|k| if ((k / 3) >> (k % 3)) & 1 == 1 { 1.0 } else { -1.0 })
            .collect(),
        _ => dice.vector(120, 1.0),
    };
    for point in points.chunks_mut(3) {
        let norm = if kind == "globe" {
            point.iter().map(|x| x * x).sum::<f64>().sqrt()
        } else {
            1.0
        };
        (0..3).for_each(|k| point[k] *= size[k] / norm);
    }
    numbers(&points)
}

/// Writes a geom of a kind, whose mesh has its name.
fn geom(dice: &mut Dice, kind: &str, name: &str) -> String {
    let size: Vec<f64> = (0..3).map(|_| dice.uniform(0.04, 0.2)).collect();
    let margin = dice.pick(&[0.0, 0.0, 0.02]);
    let shape = match kind {
        "chip" | "crate" | "globe" => format!("type='mesh' mesh='{name}'"),
        _ => format!("type='{kind}' size='{}'", numbers(&size)),
    };
    format!("<geom name='{name}' {shape} margin='{margin}' condim='4'/>")
}

fn mesh(dice: &mut Dice, kind: &str, name: &str) -> String {
    match kind {
        "chip" | "crate" | "globe" => format!("<mesh name='{name}' vertex='{}'/>", vertices(dice, kind)),
        _ => String::new(),
    }
}

/// Writes a document of two bodies, with sensors of their distance.
fn document(dice: &mut Dice, flags: &str, [a, b]: [&str; 2]) -> String {
    let sensor = |kind: &str, geoms: &str, cutoff: f64| format!("<{kind} {geoms} cutoff='{cutoff}'/>");
    let sensors: String = ["distance", "normal", "fromto"]
        .iter()
        .flat_map(|kind| {
            let orders = ["geom1='a' geom2='b'", "geom1='b' geom2='a'"];
            orders.map(|order| sensor(kind, order, 0.3))
        })
        .collect();
    let assets = mesh(dice, a, "a") + &mesh(dice, b, "b");
    let geoms = [geom(dice, a, "a"), geom(dice, b, "b")];
    format!(
        "<mujoco><option><flag {flags}/></option><asset>{assets}</asset><worldbody>{}</worldbody><sensor>{sensors}</sensor></mujoco>",
        geoms.map(|geom| format!("<body><freejoint/>{geom}</body>")).concat()
    )
}

/// Writes a document of a body over a height field.
fn terrain(dice: &mut Dice, flags: &str, kind: &str) -> String {
    // where it is level, farthest points of a box on it are not single
    let level = dice.chance(0.4);
    let heights: Vec<f64> = (0..30)
        .map(|_| if level { 0.5 } else { dice.uniform(0.0, 1.0) })
        .collect();
    let euler = if level { "0 0 0" } else { "10 5 30" };
    let (mesh, geom) = (mesh(dice, kind, "b"), geom(dice, kind, "b"));
    format!(
        "<mujoco><option><flag {flags}/></option><asset>{mesh}\
         <hfield name='h' nrow='5' ncol='6' size='0.4 0.3 0.1 0.05' elevation='{heights}'/></asset><worldbody>\
         <geom name='a' type='hfield' hfield='h' pos='0.02 0.01 -0.05' euler='{euler}'/>\
         <body><freejoint/>{geom}</body></worldbody></mujoco>",
        heights = numbers(&heights),
    )
}

/// Puts bodies anywhere near the origin, or beside each other with axes that are parallel.
fn place(dice: &mut Dice, state: &mut State) {
    let aligned = dice.chance(0.3);
    for pose in state.qpos.chunks_mut(7) {
        let pos = dice.vector(3, 0.14);
        if aligned {
            pose[..3].copy_from_slice(&pos.iter().map(|x| (x * 32.0).round() / 32.0).collect::<Vec<_>>());
            pose[3..].copy_from_slice(&dice.pick(&[[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.5, 0.5, 0.5, -0.5]]));
        } else {
            pose[..3].copy_from_slice(&pos);
            pose[3..].copy_from_slice(&dice.vector(4, 1.0));
        }
    }
}

/// Loads a document on both sides.
fn load(text: &str) -> Sides {
    match Sides::load(needed(), text) {
        Taken::Both(sides) => *sides,
        Taken::Refused(e) => panic!("both sides refuse: {e}: {text}"),
        _ => panic!("one side refuses {text}"),
    }
}

/// Steps both sides from a state, in which contacts must have the same bits; returns the number of contacts.
fn compare(sides: &mut Sides, start: &State, what: &str) -> usize {
    assert!(sides.step_mujoco(start), "{what}: MuJoCo gives up");
    let mut ours = sides.new_state();
    ours.copy_dynamic_from(start);
    sides.engine().step(&mut ours).expect("steps");
    let theirs = sides.simulation().contacts();
    let found = |geom: [usize; 2], dist: f64, pos: [f64; 3], frame: [f64; 9]| (geom, dist, pos, frame);
    let ours_found: Vec<_> = ours
        .contact
        .iter()
        .map(|c| found(c.geom, c.dist, c.pos, c.frame))
        .collect();
    let theirs_found: Vec<_> = theirs.iter().map(|c| found(c.geom, c.dist, c.pos, c.frame)).collect();
    assert_eq!(ours_found, theirs_found, "{what}: contacts at {:?}", &start.qpos[..]);
    let distances = max_abs(&ours.sensordata, sides.simulation().sensordata());
    assert!(
        distances <= DISTANCE,
        "{what}: distances are {distances:e} apart at {:?}",
        &start.qpos[..]
    );
    let motion = relative(&ours.qacc, sides.simulation().qacc());
    assert!(motion <= MOTION, "{what}: accelerations are {motion:e} apart");
    theirs.len()
}

fn contacts_of_pairs_are_those_of_mujoco() {
    for flags in FLAGS {
        let mut contacts = 0;
        for (i, a) in KINDS.into_iter().enumerate() {
            for b in &KINDS[i..] {
                for seed in 0..DOCUMENTS {
                    let mut dice = Dice::new(seed * KINDS.len() as u64 + i as u64);
                    let mut sides = load(&document(&mut dice, flags, [a, b]));
                    for pose in 0..POSES {
                        let mut start = sides.new_state();
                        place(&mut dice, &mut start);
                        contacts += compare(&mut sides, &start, &format!("{flags}: {a} {b}, {seed}, {pose}"));
                    }
                }
            }
        }
        show!("{flags}: {contacts} contacts of all pairs");
        assert!(contacts > 5000);
    }
}

fn contacts_with_height_fields_are_those_of_mujoco() {
    let mut contacts = 0;
    for kind in KINDS {
        for seed in 0..DOCUMENTS {
            let mut dice = Dice::new(seed);
            let mut sides = load(&terrain(&mut dice, FLAGS[seed as usize % 2], kind));
            for pose in 0..POSES {
                let mut start = sides.new_state();
                place(&mut dice, &mut start);
                contacts += compare(&mut sides, &start, &format!("{kind} on terrain, {seed}, {pose}"));
            }
        }
    }
    show!("{contacts} contacts with height fields");
    assert!(contacts > 1000);
}

fn limits_of_the_search_are_those_of_mujoco() {
    for limits in [
        "ccd_iterations='3'",
        "ccd_iterations='0'",
        "ccd_tolerance='0.01'",
        "ccd_tolerance='1e-14'",
    ] {
        for pair in [["ellipsoid", "cylinder"], ["capsule", "globe"], ["crate", "chip"]] {
            let mut dice = Dice::new(3);
            let option = format!("<option {limits}>");
            let mut sides = load(&document(&mut dice, FLAGS[0], pair).replace("<option>", &option));
            for pose in 0..POSES {
                let mut start = sides.new_state();
                place(&mut dice, &mut start);
                compare(&mut sides, &start, &format!("{limits}: {pair:?}, {pose}"));
            }
        }
    }
}

/// Geoms whose centres coincide, which leaves MPR without a ray, and that touch at a point.
fn special_poses_are_those_of_mujoco() {
    for a in KINDS {
        for b in KINDS {
            let mut dice = Dice::new(5);
            let mut sides = load(&document(&mut dice, FLAGS[0], [a, b]));
            for (pose, x) in [0.0, 1e-17, 1e-15, 1e-9, 1e-4, 0.05].into_iter().enumerate() {
                for turned in [false, true] {
                    let mut start = sides.new_state();
                    start.qpos[7..10].copy_from_slice(&[0.0, 0.0, x]);
                    if turned {
                        start.qpos[10..14].copy_from_slice(&dice.vector(4, 1.0));
                    }
                    compare(&mut sides, &start, &format!("{a} {b}: pose {pose}"));
                }
            }
        }
    }
}

fn the_flag_makes_a_difference() {
    let depths = ["nativeccd='enable'", FLAGS[0]].map(|flags| {
        let mut dice = Dice::new(1);
        let mut sides = load(&document(&mut dice, flags, ["cylinder", "ellipsoid"]));
        let mut depths = Vec::new();
        for _ in 0..POSES {
            let mut state = sides.new_state();
            place(&mut dice, &mut state);
            sides.engine().step(&mut state).expect("steps");
            depths.extend(state.contact.iter().map(|c| c.dist));
        }
        depths
    });
    assert!(depths[0].len() > 10 && depths[0] != depths[1]);
}

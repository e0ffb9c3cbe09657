//! Reflexes that touch elicits.

use super::*;
use babybench::config::{Behavior, Part, SpringModel, StrengthModel};
use babybench::math::{Vec3, add, add_scaled, column, mat_vec, quat_mul, scale, sub};

/// Half the thickness of a rod, m, and half its length.
const ROD: [f64; 2] = [0.005, 0.03];

/// How deep the rod is pressed into the palm before it is let go, m: with about 2 N.
const PRESSED: f64 = 0.003;

/// A rod of 200 g that lies loose, and what holds MIMo by his hip.
const TOYS: &str = "<body name='rod' pos='2 0 .1'><freejoint/>\
                    <geom name='rod' type='capsule' size='.005 .03' mass='.2' friction='1 .005 .0002' condim='4'/></body>\
                    <body name='holder' mocap='true' pos='0 0 1'/>\
                    <equality><weld name='held' body1='hip' body2='holder' relpose='0 0 0 1 0 0 0' active='false'/></equality>";

/// An infant with the strength of his age, held with his arms locked.
fn held(age: f64, v2: bool, reflexes: &[Reflex], model: ActuationModel) -> Env {
    let mut config = infant(reflexes);
    config.age = Some(age);
    (config.strength, config.springs) = (StrengthModel::Infant, SpringModel::Weight);
    config.actuation_model = model;
    config.scene_extra = TOYS.to_owned();
    if v2 {
        config.behavior = Behavior::HandRegard;
    }
    let mut env = started(config);
    for part in [Part::Arms, Part::Hands, Part::Body, Part::Head, Part::Legs] {
        env.mimo_mut().lock(part, 0.0).expect("a lock");
    }
    env
}

/// Puts the free joint of a body at a pose, at rest.
fn put(env: &mut Env, body: &str, pose: &[f64; 7]) {
    let model = env.model().clone();
    let joint = model.body_jntadr[model.body(body).expect("the body")];
    let (qpos, dof) = (model.jnt_qposadr[joint], model.jnt_dofadr[joint]);
    let state = env.state_mut();
    state.qpos[qpos..qpos + 7].copy_from_slice(pose);
    state.qvel[dof..dof + 6].fill(0.0);
}

/// Holds MIMo by his hip at a pose.
fn carry(env: &mut Env, pose: &[f64; 7]) {
    let [x, y, z, turn @ ..] = *pose;
    // the hip is the body of the free joint, at its origin
    put(env, "mimo_location", pose);
    env.by_hand().set_mocap("holder", [x, y, z], turn).expect("a holder");
    let model = env.model().clone();
    let weld = model.eq_name.iter().position(|name| name == "held").expect("a weld");
    env.state_mut().params.eq_active[weld] = true;
}

/// Lays a rod across the right palm, lets it go after a second, and returns for how long he holds it, s, up to 10.
fn hold(age: f64, v2: bool, reflexes: &[Reflex], model: ActuationModel) -> f64 {
    let mut env = held(age, v2, reflexes, model);
    let hand = env.model().body("right_hand").expect("a hand");
    let mut pose = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    // the locks move the arm first, then the palm is turned down
    for _ in 0..3 {
        carry(&mut env, &pose);
        for _ in 0..200 {
            rest(&mut env);
        }
        let palm = scale(column(&env.state().xmat[hand], 1), -1.0);
        let turn = rotation(palm, [0.0, 0.0, -1.0]);
        let now = [pose[3], pose[4], pose[5], pose[6]];
        pose[3..7].copy_from_slice(&quat_mul(turn, now));
    }
    let rod = env.model().body("rod").expect("a rod");
    let fell = |env: &Env| {
        let state = env.state();
        state.xpos[hand][2] - state.xpos[rod][2] > 0.08
    };
    let place = |env: &Env| {
        let (at, frame) = (env.state().xpos[hand], env.state().xmat[hand]);
        let (palm, across, along) = (scale(column(&frame, 1), -1.0), column(&frame, 0), column(&frame, 2));
        let geom = env.model().body_geomadr[hand];
        let thick = env.model().geom_size[geom][1];
        let palm_end = env.model().geom_size[geom][2];
        let middle = add(at, mat_vec(&frame, env.model().geom_pos[geom]));
        let point = add_scaled(
            add_scaled(middle, palm, thick + ROD[0] - PRESSED),
            along,
            0.8 * palm_end,
        );
        let turn = rotation([0.0, 0.0, 1.0], across);
        [point[0], point[1], point[2], turn[0], turn[1], turn[2], turn[3]]
    };
    for _ in 0..200 {
        let toy = place(&env);
        put(&mut env, "rod", &toy);
        rest(&mut env);
    }
    for k in 0..2000 {
        rest(&mut env);
        if fell(&env) {
            return 0.005 * f64::from(k);
        }
    }
    10.0
}

/// Returns the shortest rotation from a unit vector to another.
fn rotation(from: Vec3, to: Vec3) -> [f64; 4] {
    let axis = [
        from[1] * to[2] - from[2] * to[1],
        from[2] * to[0] - from[0] * to[2],
        from[0] * to[1] - from[1] * to[0],
    ];
    let w = 1.0 + from[0] * to[0] + from[1] * to[1] + from[2] * to[2];
    if w < 1e-9 {
        return [0.0, 1.0, 0.0, 0.0];
    }
    let q = [w, axis[0], axis[1], axis[2]];
    let norm = q.iter().map(|v| v * v).sum::<f64>().sqrt();
    q.map(|v| v / norm)
}

#[test]
fn a_newborn_holds_a_toy_that_is_laid_into_his_palm() {
    for model in [ActuationModel::SpringDamper, ActuationModel::Muscle] {
        let with = hold(0.0, true, &[Reflex::PalmarGrasp], model);
        let without = hold(0.0, true, &[], model);
        assert!(with >= 10.0 && without < 1.0, "{model}: {with} s, {without} s without");
    }
}

#[test]
fn servos_and_mittens_hold_it_too() {
    for (v2, model) in [
        (true, ActuationModel::Positional),
        (false, ActuationModel::Positional),
        (false, ActuationModel::SpringDamper),
        (false, ActuationModel::Muscle),
    ] {
        let with = hold(0.0, v2, &[Reflex::PalmarGrasp], model);
        assert!(with >= 10.0, "five fingers: {v2}, {model}: {with} s");
    }
}

/// Pokes beside the mouth, and returns the angle of the head half a second after the poke, degrees, positive to the left.
fn poke(seed: u64, side: f64) -> f64 {
    let mut config = infant(&[Reflex::Rooting]);
    config.age = Some(1.0);
    config.scene_extra =
        "<body name='finger' mocap='true' pos='2 0 2'><geom name='finger' size='.008'/></body>".to_owned();
    let mut env = Env::new(config).expect("an environment");
    env.reset(Some(seed)).expect("a start");
    let head = env.model().body("head").expect("a head");
    let skull = env.model().body_geomadr[head];
    let radius = env.model().geom_size[skull][0];
    let mut action = Vec::new();
    // each infant lies otherwise
    for _ in 0..20 {
        env.sample_action(&mut action);
        env.step(&action).expect("a step");
    }
    for _ in 0..100 {
        rest(&mut env);
    }
    let before = angle(&env, "robot:head_swivel");
    for k in 0..200 {
        let (centre, frame) = (env.state().geom_xpos[skull], env.state().xmat[head]);
        // 20 degrees beside the mouth
        let spot = mat_vec(&frame, [0.77, side * 0.34, -0.54]);
        let touch = if k < 100 { radius + 0.007 } else { 1.0 };
        env.by_hand()
            .set_mocap("finger", add_scaled(centre, spot, touch), [1.0, 0.0, 0.0, 0.0])
            .expect("a finger");
        rest(&mut env);
        if k == 150 {
            break;
        }
    }
    (angle(&env, "robot:head_swivel") - before).to_degrees()
}

#[test]
fn the_head_turns_to_a_touch_beside_the_mouth() {
    for seed in 0..10 {
        for side in [1.0, -1.0] {
            let turned = side * poke(seed, side);
            assert!(turned > 5.0, "{turned} degrees to side {side}, seed {seed}");
        }
    }
}

/// Holds an infant upright with his feet on the floor, and returns the angles of both hips over five seconds, degrees.
fn stand(age: f64, reflexes: &[Reflex], model: ActuationModel) -> Vec<[f64; 2]> {
    let mut config = infant(reflexes);
    (config.age, config.actuation_model, config.springs) = (Some(age), model, SpringModel::Weight);
    config.scene_extra = TOYS.to_owned();
    let mut env = started(config);
    for part in [Part::Body, Part::Head, Part::Arms] {
        env.mimo_mut().lock(part, 0.0).expect("a lock");
    }
    let feet = ["left_foot", "right_foot"].map(|foot| env.model().body(foot).expect("a foot"));
    // his feet reach the floor with straight legs
    let mut pose = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0];
    carry(&mut env, &pose);
    for _ in 0..100 {
        rest(&mut env);
    }
    let lowest = env.state().xpos[feet[0]][2].min(env.state().xpos[feet[1]][2]);
    let sole = env.model().geom_size[env.model().body_geomadr[feet[0]]][1];
    pose[2] -= lowest - sole + 0.005;
    carry(&mut env, &pose);
    let mut path = Vec::new();
    for _ in 0..1000 {
        rest(&mut env);
        path.push(["robot:left_hip1", "robot:right_hip1"].map(|joint| angle(&env, joint).to_degrees()));
    }
    path
}

#[test]
fn loaded_soles_step_in_turn() {
    let mut wrong = Vec::new();
    for model in MODELS {
        let path = stand(0.5, &[Reflex::Stepping], model);
        let early = stand(0.5, &[], model);
        let range = |path: &[[f64; 2]], k: usize| {
            let all = path.iter().map(|hips| hips[k]);
            [
                all.clone().fold(f64::INFINITY, f64::min),
                all.fold(f64::NEG_INFINITY, f64::max),
            ]
        };
        let mut turns = Vec::new();
        for hips in &path[200..] {
            let ahead = if hips[0] < hips[1] - 5.0 {
                0
            } else if hips[1] < hips[0] - 5.0 {
                1
            } else {
                continue;
            };
            if turns.last() != Some(&ahead) {
                turns.push(ahead);
            }
        }
        let still = range(&early, 0);
        // four seconds are two and a half cycles, and without the reflex the legs hang
        if turns.len() < 5 || range(&path, 0)[0] > still[0] - 10.0 {
            wrong.push(model);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Presses a ball behind the toes, and returns by how much they bend, degrees.
fn press(age: f64, reflexes: &[Reflex], model: ActuationModel) -> f64 {
    let mut config = infant(reflexes);
    (config.age, config.actuation_model) = (Some(age), model);
    config.scene_extra =
        "<body name='finger' mocap='true' pos='2 0 2'><geom name='finger' size='.008'/></body>".to_owned();
    let mut env = started(config);
    env.mimo_mut().lock(Part::Legs, 0.0).expect("a lock");
    let [foot, toes] = ["right_foot", "right_toes"].map(|body| env.model().body(body).expect("a foot"));
    for k in 0..200 {
        let (at, frame) = (env.state().xpos[foot], env.state().xmat[foot]);
        let ball = scale(env.model().body_pos[toes], 0.75);
        let sole = env.model().geom_size[env.model().body_geomadr[foot]][1];
        let point = add_scaled(add(at, mat_vec(&frame, ball)), column(&frame, 2), -(sole + 0.007));
        let point = if k > 50 { point } else { sub(point, [0.0, 0.0, 1.0]) };
        env.by_hand()
            .set_mocap("finger", point, [1.0, 0.0, 0.0, 0.0])
            .expect("a finger");
        rest(&mut env);
    }
    -angle(&env, "robot:right_toes").to_degrees()
}

#[test]
fn pressure_behind_the_toes_bends_them() {
    for model in MODELS {
        let (with, without, late) = (
            press(1.0, &[Reflex::PlantarGrasp], model),
            press(1.0, &[], model),
            press(12.0, &[Reflex::PlantarGrasp], model),
        );
        assert!(
            with > 10.0 && without.abs() < 1.0 && late.abs() < 1.0,
            "{model}: {with}, {without}, {late}"
        );
    }
}

//! The sense of touch against the reference: sensor positions, contacts to values, single responses, recordings.

use std::sync::Arc;

use babybench::Model;
use babybench::config::{ActuationModel, Behavior, Compat, Config, TouchFunction, TouchResponse};
use babybench::math::{MAT3_ID, Mat3, Vec3};
use babybench::mimo::{build_model, embedded};
use babybench::physics::Contact;
use babybench::runs::{Recording, replay};
use babybench::sensors::{SkinLayout, Touch};
use conformance::data;
use conformance::measure::{max_abs, only_print, relative};
use conformance::recordings::golden;
use serde_json::Value;
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        sensors_are_where_the_references_are,
        contact_situations_give_the_recorded_values,
        responses_are_the_recorded_ones,
        recordings_feel_the_same_step_by_step
    ]
}

fn numbers<const N: usize>(v: &Value) -> [f64; N] {
    std::array::from_fn(|k| v[k].as_f64().expect("a number"))
}

fn text(v: &Value) -> &str {
    v.as_str().expect("a text")
}

fn int(v: &Value) -> usize {
    v.as_u64().expect("an integer") as usize
}

fn items(v: &Value) -> &[Value] {
    v.as_array().expect("a list")
}

fn model(behavior: Behavior, scene: babybench::config::Scene) -> (Model, Config) {
    let config = Config {
        behavior,
        scene,
        ..Config::default()
    };
    (
        build_model(&config, &embedded()).expect("the embedded assets load"),
        config,
    )
}

/// Positions and counts at `touch_scale: 1` for both versions. Positions were within 8.3e-17 m when written.
fn sensors_are_where_the_references_are() {
    for (behavior, version) in [(Behavior::SelfTouch, "v1"), (Behavior::HandRegard, "v2")] {
        let layout = data::json(&format!("touch/layout_{version}.json.gz"));
        let positions = data::npz(&format!("touch/sensor_positions_{version}.npz"));
        let (m, config) = model(behavior, babybench::config::Scene::Cubes);
        let skin = SkinLayout::new(&m, &config).expect("valid");
        assert_eq!(skin.len(), int(&layout["total"]));
        let recorded = items(&layout["bodies"]);
        assert_eq!(skin.bodies().len(), recorded.len());
        let mut worst = 0.0_f64;
        for (ours, theirs) in skin.bodies().iter().zip(recorded) {
            let name = text(&theirs["name"]);
            assert_eq!((ours.name.as_str(), ours.body), (name, int(&theirs["body"])));
            assert_eq!(ours.spacing, theirs["scale"].as_f64().expect("a number"), "{name}");
            assert_eq!(
                (ours.offset, ours.len()),
                (int(&theirs["offset"]), int(&theirs["n_sensors"])),
                "{name}"
            );
            let geoms: Vec<[usize; 3]> = ours.geoms.iter().map(|g| [g.geom, g.points, g.sensors.len()]).collect();
            let expect: Vec<[usize; 3]> = items(&theirs["geoms"])
                .iter()
                .map(|g| [&g["geom"], &g["mesh_vertices"], &g["active"]].map(int))
                .collect();
            assert_eq!(geoms, expect, "{name}: geom, points, sensors");
            let theirs = positions.get_f64(name).expect("recorded").data;
            worst = worst.max(max_abs(&ours.positions().concat(), &theirs));
        }
        show!("{version}: {} sensors, positions within {worst:.1e} m", skin.len());
        assert!(worst <= 8e-16 || only_print(), "{version}");
    }
}

fn contact(c: &Value) -> Contact {
    let f: [f64; 3] = numbers(&c["force"]);
    Contact {
        geom: [int(&c["geom1"]), int(&c["geom2"])],
        dist: c["dist"].as_f64().expect("a number"),
        pos: numbers(&c["pos"]),
        frame: numbers(&c["frame"]),
        dim: int(&c["dim"]),
        friction: [0.0; 5],
        solref: [0.0; 2],
        solreffriction: [0.0; 2],
        solimp: [0.0; 5],
        includemargin: 0.0,
        efc_address: None,
        force: [f[0], f[1], f[2], 0.0, 0.0, 0.0],
    }
}

/// The dump has eight significant digits of each value, twelve decimals of points: all were within 4.9e-8 when written.
fn contact_situations_give_the_recorded_values() {
    let situations = data::json("touch/contact_situations_v1_crib.json.gz");
    let (m, config) = model(Behavior::SelfTouch, babybench::config::Scene::Crib);
    let layout = Arc::new(SkinLayout::new(&m, &config).expect("valid"));
    let body = |name: &str| m.body(name).expect("a body");
    let (mut worst, mut worst_each, mut results) = (0.0_f64, 0.0_f64, 0);
    for situation in items(&situations) {
        let mut xpos: Vec<Vec3> = vec![[0.0; 3]; m.nbody()];
        let mut xmat: Vec<Mat3> = vec![MAT3_ID; m.nbody()];
        for (name, pose) in situation["bodies"].as_object().expect("bodies") {
            (xpos[body(name)], xmat[body(name)]) = (numbers(&pose["xpos"]), numbers(&pose["xmat"]));
        }
        let mut contacts = Vec::new();
        for c in items(&situation["contacts"]) {
            contacts.push(contact(c));
            for (geom, name) in [("geom1", "body1"), ("geom2", "body2")] {
                assert_eq!(
                    m.geom_bodyid[int(&c[geom])],
                    body(text(&c[name])),
                    "geom ids are the recorded ones"
                );
            }
        }
        for (key, expect) in situation["result"].as_object().expect("results") {
            let (function, response) = key.split_once('/').expect("function/response");
            let mut touch = Touch::new(
                layout.clone(),
                TouchFunction::from_name(function).expect("a function"),
                TouchResponse::from_name(response).expect("a response"),
                Compat::Reference,
            );
            touch.sense(&m, &contacts, &xpos, &xmat);
            let ours: Vec<f64> = touch.values().iter().map(|v| f64::from(*v)).collect();
            let mut theirs = vec![0.0; ours.len()];
            for entry in items(expect) {
                let skin = layout.body(body(text(&entry[0]))).expect("feels");
                let at = 3 * (skin.offset + int(&entry[1]));
                for k in 0..3 {
                    theirs[at + k] = entry[2 + k].as_f64().expect("a number");
                }
                worst_each = worst_each.max(relative(&ours[at..at + 3], &theirs[at..at + 3]));
            }
            assert_eq!(
                touch.active().count(),
                items(expect).len(),
                "{key}: sensors that respond"
            );
            worst = worst.max(relative(&ours, &theirs));
            results += 1;
        }
    }
    show!("{results} results: within {worst:.1e} of the largest value, each sensor within {worst_each:.1e} of its own");
    assert_eq!(results, 42);
    assert!((worst <= 4e-7 && worst_each <= 4e-7) || only_print());
}

fn responses_are_the_recorded_ones() {
    let cases = data::json("touch/response_cases_v1.json.gz");
    let (m, config) = model(Behavior::SelfTouch, babybench::config::Scene::Crib);
    let layout = Arc::new(SkinLayout::new(&m, &config).expect("valid"));
    let new = |response| Touch::new(layout.clone(), TouchFunction::ForceVector, response, Compat::Reference);
    let (mut nearest, mut spread) = (new(TouchResponse::Nearest), new(TouchResponse::SpreadLinear));
    let (mut worst, mut lost) = (0.0_f64, 0);
    for case in items(&cases) {
        let body = m.body(text(&case["body"])).expect("a body");
        let (point, force) = (numbers(&case["point"]), numbers(&case["force"]));
        nearest.clear();
        nearest.press(body, point, force);
        let felt: Vec<usize> = nearest.active().map(|a| a.index).collect();
        assert_eq!(felt, [int(&case["nearest"])]);
        spread.clear();
        spread.press(body, point, force);
        let ours: Vec<f64> = spread.body_values(body).iter().map(|v| f64::from(*v)).collect();
        let mut theirs = vec![0.0; ours.len()];
        for entry in items(&case["spread"]) {
            for k in 0..3 {
                theirs[3 * int(&entry[0]) + k] = entry[1 + k].as_f64().expect("a number");
            }
        }
        lost += usize::from(items(&case["spread"]).is_empty());
        worst = worst.max(relative(&ours, &theirs));
    }
    let n = items(&cases).len();
    show!("{n} cases, {lost} of them lost for want of an x component: within {worst:.1e} of the largest value");
    assert_eq!(n, 36);
    assert!(worst <= 4e-7 || only_print());
}

/// One step from every recorded state: the touch that follows. All were within 5.2e-8, the rounding of single precision, and
/// of the same sensors when written.
fn recordings_feel_the_same_step_by_step() {
    for actuation in ActuationModel::NAMES {
        for g in golden(actuation) {
            if !g.config.touch_enabled() {
                continue;
            }
            let mut env = g.env();
            let recording = Recording::read(&g.npz, &env).expect("the recording fits");
            let ours = replay(&mut env, &recording, true)
                .expect("the replay runs")
                .touch
                .expect("touch is on");
            let integers = |name: &str| g.npz.get_i64(name).expect("recorded").data;
            let (idx, ptr) = (integers("touch_idx"), integers("touch_ptr"));
            let val = g.npz.get_f64("touch_val").expect("recorded").data;
            let n = integers("touch_len")[0];
            assert_eq!((ours.len, ours.ptr.len()), (n, ptr.len()), "{}", g.name);
            let (mut near, mut same, mut errors) = (0, 0, Vec::new());
            let steps = ptr.len() - 1;
            for t in 0..steps {
                let (a, b) = (
                    ours.ptr[t] as usize..ours.ptr[t + 1] as usize,
                    ptr[t] as usize..ptr[t + 1] as usize,
                );
                let (mut x, mut y) = (vec![0.0; n as usize], vec![0.0; n as usize]);
                a.clone().for_each(|k| x[ours.idx[k] as usize] = f64::from(ours.val[k]));
                b.clone().for_each(|k| y[idx[k] as usize] = val[k]);
                let error = relative(&x, &y);
                near += usize::from(error <= 5e-7);
                let sensors = |v: &[f64]| v.chunks(3).map(|v| v.iter().any(|v| *v != 0.0)).collect::<Vec<_>>();
                same += usize::from(sensors(&x) == sensors(&y));
                errors.push(error);
            }
            let (near, same) = (near as f64 / steps as f64, same as f64 / steps as f64);
            show!(
                "{:24} {steps} steps, {} values: within 5e-7 in {:.2} %, same sensors in {:.2} % of steps; {}",
                g.name,
                val.len(),
                100.0 * near,
                100.0 * same,
                conformance::measure::Summary::new(errors)
            );
            assert!((near == 1.0 && same == 1.0) || only_print(), "{}", g.name);
        }
    }
}

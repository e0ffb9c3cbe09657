//! MIMo from birth to 24 months, against the models of MIMo's authors.

use std::time::Instant;

use babybench::config::{Behavior, Config, Scene};
use babybench::mimo::{BodyFigures, MimoJoints, Version, build_model, embedded, held_posture};
use babybench::{Blueprint, Env, Model};
use conformance::data;
use conformance::measure::{only_print, relative_each};
use serde_json::Value;
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        sizes_masses_and_strength_are_the_published_ones,
        compiled_models_are_mujocos,
        figures_are_the_published_ones,
        every_age_has_a_body_that_is_its_own_mirror_image,
        no_age_floats_or_sinks
    ]
}

const BEHAVIORS: [Behavior; 2] = [Behavior::SelfTouch, Behavior::HandRegard];

fn at(behavior: Behavior, scene: Scene, age: f64) -> Config {
    Config {
        behavior,
        scene,
        age: Some(age),
        ..Config::default()
    }
}

fn model(behavior: Behavior, age: f64) -> Model {
    build_model(&at(behavior, Scene::Base, age), &embedded()).expect("MIMo grows")
}

/// Returns the geom of a name of the published tables: `lb`, `left_uarm1`, `geom:left_hand2`.
fn published_geom(model: &Model, name: &str) -> usize {
    let (body, index) = match name {
        "lb" => ("hip", 0),
        "cb" => ("lower_body", 0),
        "head" => ("head", 0),
        "left_uarm1" => ("left_upper_arm", 0),
        "left_larm" => ("left_lower_arm", 0),
        _ => match name.strip_prefix("ub") {
            Some(k) => ("upper_body", k.parse::<usize>().expect("a number") - 1),
            None => {
                let (body, k) = name["geom:".len()..].split_at(name.len() - "geom:".len() - 1);
                (body, k.parse::<usize>().expect("a number") - 1)
            }
        },
    };
    model.body_geomadr[model.body(body).expect(name)] + index
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().map(|v| v.as_f64().expect("a number")).collect(),
        one => vec![one.as_f64().expect("a number")],
    }
}

/// The largest relative difference was below 1e-15 when written.
fn sizes_masses_and_strength_are_the_published_ones() {
    let published = data::json("growth_expected.json.gz");
    for behavior in BEHAVIORS {
        let version = Version::of(behavior).name();
        let ages = published[version].as_object().expect("ages");
        for (age, body) in ages {
            let model = model(behavior, age.parse().expect("an age"));
            let mut worst: f64 = 0.0;
            let mut compare = |what: &str, ours: &[f64], theirs: &Value| {
                let theirs = numbers(theirs);
                let far = relative_each(&ours[..theirs.len()], &theirs);
                assert!(
                    only_print() || far <= 1e-12,
                    "{version} {age} {what}: {ours:?}, published {theirs:?}"
                );
                worst = worst.max(far);
            };
            for (name, geom) in body["geoms"].as_object().expect("geoms") {
                let g = published_geom(&model, name);
                compare(name, &model.geom_size[g], &geom["size"]);
                compare(name, &model.geom_pos[g], &geom["pos"]);
            }
            for (name, pos) in body["bodies"].as_object().expect("bodies") {
                compare(name, &model.body_pos[model.body(name).expect(name)], pos);
            }
            for (name, pos) in body["joints"].as_object().expect("joints") {
                compare(name, &model.jnt_pos[model.joint(name).expect(name)], pos);
            }
            for (name, pos) in body["sites"].as_object().expect("sites") {
                compare(name, &model.site_pos[model.site(name).expect(name)], pos);
            }
            for (name, gear) in body["motors"].as_object().expect("motors") {
                compare(name, &[model.actuator_gear[model.actuator(name).expect(name)]], gear);
            }
            show!("{version} {age:>4} months: {worst:.1e}");
        }
    }
}

/// The largest relative difference was 2.8e-14 when written.
fn compiled_models_are_mujocos() {
    let compiled = data::npz("growth_compiled.npz");
    let names = &data::json("growth_expected.json.gz")["actuators"];
    for behavior in BEHAVIORS {
        let version = Version::of(behavior).name();
        for age in [0, 1, 3, 6, 9, 12, 18, 24] {
            let model = model(behavior, f64::from(age));
            let array = |what: &str| compiled.get_f64(&format!("{version}_{age}_{what}")).expect(what).data;
            let hip = model.body("hip").expect("MIMo");
            let bodies: Vec<usize> = (0..model.nbody()).filter(|&b| model.in_subtree(b, hip)).collect();
            let MimoJoints {
                joint: joints,
                dof: dofs,
                ..
            } = MimoJoints::new(&model);
            let geoms: Vec<usize> = (0..model.ngeom())
                .filter(|&g| bodies.contains(&model.geom_bodyid[g]))
                .collect();
            let names = names[version].as_array().expect("names").iter();
            let names = names.map(|name| name.as_str().expect("a name"));
            let motors: Vec<usize> = names.map(|name| model.actuator(name).expect(name)).collect();
            fn all<const N: usize>(ids: &[usize], of: &[[f64; N]]) -> Vec<f64> {
                ids.iter().flat_map(|&k| of[k]).collect()
            }
            let each = |ids: &[usize], of: &[f64]| -> Vec<f64> { ids.iter().map(|&k| of[k]).collect() };
            let ours = [
                ("body_pos", all(&bodies, &model.body_pos)),
                ("body_mass", each(&bodies, &model.body_mass)),
                ("body_inertia", all(&bodies, &model.body_inertia)),
                ("body_ipos", all(&bodies, &model.body_ipos)),
                ("body_iquat", all(&bodies, &model.body_iquat)),
                ("body_subtreemass", each(&bodies, &model.body_subtreemass)),
                ("body_invweight0", all(&bodies, &model.body_invweight0)),
                ("jnt_pos", all(&joints, &model.jnt_pos)),
                ("dof_invweight0", each(&dofs, &model.dof_invweight0)),
                ("dof_M0", each(&dofs, &model.dof_m0)),
                ("geom_size", all(&geoms, &model.geom_size)),
                ("geom_pos", all(&geoms, &model.geom_pos)),
                ("geom_quat", all(&geoms, &model.geom_quat)),
                ("geom_rbound", each(&geoms, &model.geom_rbound)),
                ("gear", each(&motors, &model.actuator_gear)),
            ];
            let mut worst: f64 = 0.0;
            for (what, ours) in &ours {
                let theirs = array(what);
                assert_eq!(ours.len(), theirs.len(), "{version} {age} {what}");
                let far = relative_each(ours, &theirs);
                assert!(
                    only_print() || far <= 1e-12,
                    "{version} at {age} months: {what} is {far:e} away"
                );
                worst = worst.max(far);
            }
            show!("{version} {age:>4} months: {worst:.1e} in {} arrays", ours.len());
        }
    }
}

/// Statures, masses and the radius of the head, with the digits that were published.
fn figures_are_the_published_ones() {
    let published = [
        (0.0, 0.504571, 2.91003),
        (1.0, 0.583757, 4.96126),
        (3.0, 0.633258, 6.52359),
        (6.0, 0.676997, 7.9207),
        (9.0, 0.709922, 8.95753),
        (12.0, 0.737805, 9.82818),
        (17.5, 0.781606, 11.196),
        (18.0, 0.785258, 11.3106),
        (24.0, 0.826056, 12.6038),
    ];
    for (age, stature, mass) in published {
        let found = BodyFigures::of(&model(Behavior::SelfTouch, age)).expect("MIMo");
        show!(
            "{age} months: {:.6} m, {:.5} kg, centre of mass {:.4} m above the soles",
            found.stature,
            found.mass,
            found.center_of_mass
        );
        assert!((found.stature - stature).abs() < 1e-5 && (found.mass - mass).abs() < 1e-4);
        assert!((0.45..0.65).contains(&(found.center_of_mass / found.stature)));
    }
}

/// Every tenth of a month.
fn every_age_has_a_body_that_is_its_own_mirror_image() {
    for behavior in BEHAVIORS {
        let (mut slowest, mut lightest, mut heaviest) = (0.0_f64, f64::INFINITY, 0.0_f64);
        for tenth in 0..=240 {
            let started = Instant::now();
            let model = model(behavior, f64::from(tenth) / 10.0);
            slowest = slowest.max(started.elapsed().as_secs_f64());
            let hip = model.body("hip").expect("MIMo");
            for body in (0..model.nbody()).filter(|&b| model.in_subtree(b, hip)) {
                assert!(model.body_mass[body] > 0.0);
                let name = &model.body_name[body];
                let Some(plain) = name.strip_prefix("left_") else {
                    continue;
                };
                let other = model.body(&format!("right_{plain}")).expect(plain);
                let ([x, y, z], [a, b, c]) = (model.body_pos[body], model.body_pos[other]);
                assert_eq!([x, y, z], [a, -b, c], "{name}");
                assert_eq!(model.body_mass[body], model.body_mass[other], "{name}");
            }
            let mass = model.body_subtreemass[hip];
            (lightest, heaviest) = (lightest.min(mass), heaviest.max(mass));
        }
        let version = Version::of(behavior).name();
        show!(
            "{version}: {lightest:.3} to {heaviest:.3} kg, compiled in at most {:.0} ms",
            1e3 * slowest
        );
        assert!(2.8 < lightest && heaviest < 12.7);
    }
}

/// Returns the name of the body that a degree of freedom moves fastest, and its speed, m/s or rad/s.
fn fastest(env: &Env) -> (String, f64) {
    let (model, speeds) = (env.model(), &env.state().qvel);
    let dof = (0..speeds.len()).max_by(|&a, &b| speeds[a].abs().total_cmp(&speeds[b].abs()));
    let dof = dof.expect("a joint");
    (model.body_name[model.dof_bodyid[dof]].clone(), speeds[dof].abs())
}

/// Returns the deepest contact of MIMo, m: how deep, with what.
fn deepest(env: &Env) -> (f64, String) {
    let (model, hip) = (env.model(), env.model().body("hip").expect("MIMo"));
    let name = |geom: usize| &model.body_name[model.geom_bodyid[geom]];
    let own = |geom: &usize| model.in_subtree(model.geom_bodyid[*geom], hip);
    let contacts = env.state().contact.iter().filter(|c| c.geom.iter().any(own));
    let deepest = contacts.min_by(|a, b| a.dist.total_cmp(&b.dist));
    deepest.map_or((0.0, "nothing".to_string()), |c| {
        (c.dist, format!("{} and {}", name(c.geom[0]), name(c.geom[1])))
    })
}

/// At every age MIMo starts where he neither floats nor sinks, and his weight is on what is below him after settling.
fn no_age_floats_or_sinks() {
    for scene in [Scene::Base, Scene::Crib, Scene::Cubes] {
        for behavior in BEHAVIORS {
            for age in [
                None,
                Some(0.0),
                Some(3.0),
                Some(6.0),
                Some(12.0),
                Some(18.0),
                Some(24.0),
            ] {
                let config = Config {
                    age,
                    vision_active: false,
                    touch_active: false,
                    ..at(behavior, scene.clone(), 0.0)
                };
                let blueprint = Blueprint::new(config).expect("MIMo grows");
                let mut env = blueprint.env().expect("an environment");
                let posture = held_posture(blueprint.model());
                let rest = vec![0.0; blueprint.model().nv];
                env.by_hand().reset_to(&posture, &rest).expect("a reset");
                let (start, with) = deepest(&env);
                env.by_hand()
                    .reset_to(blueprint.init_qpos(), blueprint.init_qvel())
                    .expect("a reset");
                let (settled, on) = deepest(&env);
                let (body, speed) = fastest(&env);
                show!(
                    "{} {scene} {age:?}: at the start {:.1} mm ({with}), settled {:.2} mm ({on}), fastest {body} {speed:.2}",
                    Version::of(behavior).name(),
                    1e3 * start,
                    1e3 * settled
                );
                assert!(settled < 0.0 && settled > -0.01);
            }
        }
    }
}

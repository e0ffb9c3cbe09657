//! The mirror of a scene in Rapier: it has the state's poses, its collision pipeline finds the solver's contacts, and its
//! queries see what is there.

use std::collections::BTreeMap;

use crate::common::*;
use babybench::Env;
use babybench::config::{Behavior, Scene};
use babybench::math::{Vec3, column, norm, sub};
use babybench::model::GeomType;
use babybench::physics::{EngineError, FreeBody};
use babybench::rapier::RapierScene;
use babybench::rapier::rapier3d_f64::prelude::{ColliderHandle, QueryFilter, Ray, Vector};
use babybench::spaces::NumpyRng;

/// Steps of every model that the tests look at.
const STEPS: usize = if cfg!(debug_assertions) { 40 } else { 300 };

/// Runs every model with random actions; `look` sees the environment after each step, and its mirror.
fn visit(steps: usize, mut look: impl FnMut(&str, usize, &mut Env, &RapierScene)) {
    for (behavior, scene) in MODELS {
        let mut env = env(free(behavior, scene.clone()));
        env.reset(Some(0)).expect("no divergence");
        let mut mirror = mirror(&env);
        let name = format!("{behavior}/{scene}");
        for k in 0..steps {
            random_steps(&mut env, 1);
            mirror.sync(env.state()).expect("its own state");
            look(&name, k, &mut env, &mirror);
        }
    }
}

fn mirror(env: &Env) -> RapierScene {
    env.blueprint().rapier_scene(env.state()).expect("its own state")
}

#[test]
fn colliders_and_bodies_have_the_poses_of_the_state() {
    let mut worst = 0.0_f64;
    visit(STEPS / 2, |name, k, env, scene| {
        let (model, s) = (env.model(), env.state());
        for g in 0..model.ngeom() {
            let collider = &scene.colliders()[scene.collider_handle(g).expect("every geom has a collider")];
            assert_eq!(scene.collider_handle(g).and_then(|c| scene.geom_of(c)), Some(g));
            let p = collider.position();
            let t = p.translation;
            worst = worst.max(norm(sub([t.x, t.y, t.z], s.geom_xpos[g])));
            // Parry's cylinders stand along y: x stays, the geom's z is the collider's y
            let axes = match model.geom_type[g] {
                GeomType::Cylinder => [Vector::X, -Vector::Z, Vector::Y],
                _ => [Vector::X, Vector::Y, Vector::Z],
            };
            for (i, axis) in axes.into_iter().enumerate() {
                let a = p.rotation * axis;
                worst = worst.max(norm(sub([a.x, a.y, a.z], column(&s.geom_xmat[g], i))));
            }
            assert!(worst < 1e-14, "{name}, step {k}, geom {g}: {worst:e}");
        }
        for b in 1..model.nbody() {
            let body = &scene.bodies()[scene.body_handle(b).expect("every body has one")];
            let t = body.translation();
            worst = worst.max(norm(sub([t.x, t.y, t.z], s.xpos[b])));
            assert!(worst < 1e-14, "{name}, step {k}, body {b}: {worst:e}");
        }
    });
    println!("poses agree to {worst:.1e} m");
}

/// Distances by unordered geom pair.
type ByPair = BTreeMap<[usize; 2], Vec<f64>>;

fn by_pair(contacts: impl Iterator<Item = ([usize; 2], f64)>) -> ByPair {
    let mut out = ByPair::new();
    for ([a, b], dist) in contacts {
        out.entry([a.min(b), a.max(b)]).or_default().push(dist);
    }
    out.values_mut().for_each(|d| d.sort_by(f64::total_cmp));
    out
}

#[test]
fn the_collision_pipeline_finds_the_contacts_of_the_solver() {
    let (mut states, mut points, mut missing, mut counts, mut depths, mut worst) = (0, 0, 0, 0, 0, 0.0_f64);
    let mut curved_only = true;
    visit(STEPS, |name, k, env, scene| {
        let ours = by_pair(env.state().contact.iter().map(|c| (c.geom, c.dist)));
        let theirs = by_pair(scene.contacts().into_iter().map(|c| (c.geom, c.dist)));
        let model = env.model().clone();
        states += 1;
        points += env.state().contact.len();
        let kinds = |p: &[usize; 2]| format!("{:?}-{:?}", model.geom_type[p[0]], model.geom_type[p[1]]);
        let mut report = |what: &str, pair: &[usize; 2], a: &[f64], b: &[f64]| {
            println!(
                "{name}, step {k}: {what} {pair:?} {}: solver {a:?}, pipeline {b:?}",
                kinds(pair)
            );
            curved_only &= pair.iter().any(|&g| model.geom_type[g] == GeomType::Cylinder);
        };
        for (pair, a) in &ours {
            match theirs.get(pair) {
                None => {
                    missing += 1;
                    report("missing", pair, a, &[]);
                }
                Some(b) if a.len() != b.len() => {
                    counts += 1;
                    report("other number of points", pair, a, b);
                }
                Some(b) => {
                    let error = a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
                    if error > 1e-9 {
                        depths += 1;
                        report("other depth", pair, a, b);
                    } else {
                        worst = worst.max(error);
                    }
                }
            }
        }
        for (pair, b) in theirs.iter().filter(|t| !ours.contains_key(t.0)) {
            missing += 1;
            report("extra", pair, &[], b);
        }
    });
    println!(
        "{states} states, {points} contacts: {missing} pairs on one side only, {counts} with another number of points, \
         {depths} with another depth; otherwise within {worst:.1e} m"
    );
    // ties between the faces, edges and caps of cylinders, and contacts at a distance of 0, may fall either way
    assert!(missing + counts + depths <= points / 1000, "too many to be ties");
    assert!(curved_only, "a pair without a cylinder differs");
}

#[test]
fn contacts_do_not_depend_on_the_past() {
    let (mut differing, mut used) = (0, BTreeMap::new());
    visit(STEPS, |name, k, env, scene| {
        if k % 10 != 9 {
            return;
        }
        // contacts belong to the start of the step, so compare after a fresh look at the present
        let mut now = env.state().clone();
        let mut fresh = env.blueprint().engine();
        fresh.forward(&mut now).expect("no divergence");
        let mut again = env.state().clone();
        // one that has seen the moments before this
        let engine = used.entry(name.to_string()).or_insert_with(|| env.blueprint().engine());
        engine.forward(&mut again).expect("no divergence");
        assert_eq!(now.contact, again.contact, "{name}, step {k}: solver");
        let (old, new) = (scene.contacts(), mirror(env).contacts());
        if old != new {
            differing += 1;
            println!(
                "{name}, step {k}: the pipeline finds {} contacts, a fresh one {}",
                old.len(),
                new.len()
            );
        }
    });
    assert_eq!(differing, 0, "states in which Rapier's pipeline depends on the past");
}

#[test]
fn rays_hit_the_nearest_geom() {
    let (mut rays, mut hits) = (0, 0);
    let mut rng = NumpyRng::seed(1);
    visit(STEPS, |name, k, env, scene| {
        if k % 20 != 19 {
            return;
        }
        let centre = env.state().xpos[2];
        for _ in 0..100 {
            let mut at = |scale: f64| -> Vec3 { std::array::from_fn(|_| scale * (2.0 * rng.uniform() - 1.0)) };
            let (offset, aim) = (at(0.6), at(0.3));
            let origin = Vector::new(
                centre[0] + offset[0],
                centre[1] + offset[1],
                centre[2] + 0.3 + offset[2].abs(),
            );
            let target = Vector::new(centre[0] + aim[0], centre[1] + aim[1], centre[2] + aim[2]);
            let ray = Ray::new(origin, (target - origin).normalize());
            for solid in [true, false] {
                let nearest = scene
                    .colliders()
                    .iter()
                    .filter_map(|(h, c)| c.shape().cast_ray(c.position(), &ray, 10.0, solid).map(|t| (h, t)))
                    .min_by(|a, b| a.1.total_cmp(&b.1));
                let found: Option<(ColliderHandle, f64)> =
                    scene.queries(QueryFilter::default()).cast_ray(&ray, 10.0, solid);
                rays += 1;
                hits += usize::from(found.is_some());
                match (found, nearest) {
                    (None, None) => {}
                    (Some(f), Some(n)) => assert_eq!(f.1, n.1, "{name}, step {k}: {f:?} instead of {n:?}"),
                    other => panic!("{name}, step {k}: {other:?}"),
                }
            }
        }
    });
    println!("{rays} rays, {hits} hits");
    assert!(hits * 2 > rays);
}

#[test]
fn every_body_and_geom_can_be_found_in_the_scene() {
    let env = env(free(Behavior::None, Scene::Crib));
    let scene = mirror(&env);
    assert_eq!(scene.bodies().len(), env.model().nbody());
    assert_eq!(scene.colliders().len(), env.model().ngeom());
    assert_eq!(scene.collider_handle(env.model().ngeom()), None);
    assert_eq!(scene.body_handle(env.model().nbody()), None);
    assert_eq!(scene.geom_of(ColliderHandle::invalid()), None);
}

#[test]
fn a_fresh_scene_stands_at_qpos0() {
    let env = env(free(Behavior::None, Scene::Cubes));
    let mut engine = env.blueprint().engine();
    let mut start = engine.new_state();
    engine.forward(&mut start).expect("no divergence");
    let scene = RapierScene::new(env.model().clone(), Default::default());
    for b in 0..env.model().nbody() {
        let t = scene.bodies()[scene.body_handle(b).expect("every body has one")].translation();
        let error = norm(sub([t.x, t.y, t.z], start.xpos[b]));
        assert!(error < 1e-14, "{}: {error:e} m", env.model().body_name[b]);
    }
}

#[test]
fn a_scene_follows_another_size() {
    let mut env = env(free(Behavior::None, Scene::Cubes));
    env.reset(Some(0)).expect("no divergence");
    let model = env.model().clone();
    let ball = model.body("red_sphere").expect("a ball");
    let mut scene = mirror(&env);
    env.state_mut()
        .set_free_body(&model, ball, FreeBody::sphere(1.0, 0.3))
        .expect("free");
    scene.sync(env.state()).expect("its own state");
    let [x, y, z] = env.state().xpos[ball];
    let ray = Ray::new(Vector::new(x, y, z + 2.0), -Vector::Z);
    let (collider, distance) = scene
        .queries(QueryFilter::default())
        .cast_ray(&ray, 10.0, true)
        .expect("a hit");
    assert_eq!(scene.geom_of(collider), Some(model.body_geomadr[ball]));
    assert!((distance - 1.7).abs() < 1e-12, "{distance}");
}

#[test]
fn a_scene_refuses_states_of_other_models() {
    let (crib, cubes) = (
        env(free(Behavior::None, Scene::Crib)),
        env(free(Behavior::None, Scene::Cubes)),
    );
    let before = mirror(&crib).contacts();
    let mut scene = mirror(&crib);
    let error = scene.sync(cubes.state()).expect_err("another model");
    assert!(matches!(error, EngineError::Shape { .. }), "{error}");
    assert_eq!(scene.contacts(), before, "nothing is changed");
}

//! Numbers of the model that a program changes while an environment lives.

use crate::common::*;
use babybench::config::{ActuationModel, Behavior, EngineKind, Scene};
use babybench::env::{ModelChangeError, SnapshotError};
use babybench::model::Arrays;
use babybench::{Config, Env, EnvError};

fn started(config: &Config) -> Env {
    let mut env = env(config.clone());
    env.reset(Some(5)).expect("no divergence");
    random_steps(&mut env, 3);
    env
}

/// Positions after some steps with random actions.
fn course(env: &mut Env, steps: usize) -> Vec<u64> {
    random_steps(env, steps);
    env.state().qpos.iter().map(|q| q.to_bits()).collect()
}

/// The effect of a change on a model.
type Edit = fn(&mut Arrays);

/// A change of each kind of number.
const EDITS: [(&str, Edit); 20] = [
    ("opt.gravity", |m| m.opt.gravity[2] = -1.62),
    ("opt.timestep", |m| m.opt.timestep = 0.004),
    ("opt.impratio", |m| m.opt.impratio = 2.0),
    ("opt.density", |m| {
        (m.opt.density, m.opt.viscosity, m.opt.wind[0]) = (1000.0, 0.001, 1.0)
    }),
    ("body_mass", |m| m.body_mass.iter_mut().for_each(|mass| *mass *= 1.1)),
    ("body_inertia", |m| m.body_inertia.iter_mut().for_each(|i| i[0] *= 1.1)),
    ("body_invweight0", |m| {
        m.body_invweight0.iter_mut().for_each(|w| w[0] *= 1.1)
    }),
    ("dof_damping", |m| m.dof_damping.iter_mut().for_each(|d| *d *= 1.1)),
    ("dof_armature", |m| m.dof_armature.iter_mut().for_each(|a| *a += 0.001)),
    ("dof_frictionloss", |m| {
        m.dof_frictionloss.iter_mut().for_each(|f| *f += 0.01)
    }),
    ("jnt_stiffness", |m| {
        m.jnt_stiffness.iter_mut().for_each(|s| *s = 1.1 * *s + 0.1)
    }),
    ("actuator_gear", |m| m.actuator_gear.iter_mut().for_each(|g| *g *= 1.1)),
    ("geom_size", |m| m.geom_size.iter_mut().for_each(|s| s[0] *= 1.02)),
    ("geom_friction", |m| {
        m.geom_friction.iter_mut().for_each(|f| f[0] *= 0.5)
    }),
    ("geom_solref", |m| m.geom_solref.iter_mut().for_each(|s| s[0] = 0.03)),
    ("geom_solimp", |m| m.geom_solimp.iter_mut().for_each(|s| s[0] = 0.8)),
    ("body_pos", |m| m.body_pos.iter_mut().skip(2).for_each(|p| p[2] *= 1.02)),
    ("body_quat", |m| {
        m.body_quat.iter_mut().skip(2).for_each(|q| q[1] += 0.01)
    }),
    ("geom_pos", |m| m.geom_pos.iter_mut().for_each(|p| p[2] += 0.005)),
    ("jnt_range", |m| {
        m.jnt_range.iter_mut().for_each(|r| *r = [0.2 * r[0], 0.2 * r[1]])
    }),
];

#[test]
fn a_look_changes_pictures_alone() {
    let config = free(Behavior::SelfTouch, Scene::Crib);
    let (mut plain, mut painted) = (started(&config), started(&config));
    painted
        .model_mut()
        .paint(|model| {
            model.geom_rgba.iter_mut().for_each(|rgba| *rgba = [1.0, 0.0, 0.0, 1.0]);
            model.cam_fovy[0] = 30.0;
        })
        .expect("a look");
    assert_eq!(painted.snapshot(), plain.snapshot());
    assert_eq!(course(&mut painted, 5), course(&mut plain, 5));
    assert!(painted.blueprint().model_changes().is_empty());
    let drawn = painted.blueprint().scenery().expect("textures");
    assert_eq!(drawn.cameras[0].fovy, 30.0);
    assert_ne!(plain.blueprint().scenery().expect("textures").cameras[0].fovy, 30.0);
    assert!(painted.model_mut().paint(|model| model.opt.gravity[2] = 0.0).is_err());
    assert!(painted.model_mut().paint(|model| model.body_pos[1][0] += 1.0).is_err());
}

#[test]
fn equalities_are_switched_for_later_episodes_too() {
    let mut env = started(&free(Behavior::SelfTouch, Scene::Crib));
    let held = vec![true; env.model().neq()];
    env.model_mut().set_equalities(&held).expect("one flag for each");
    assert_eq!(env.state().params.eq_active, held);
    env.reset(Some(6)).expect("no divergence");
    assert_eq!(env.state().params.eq_active, held);
    assert!(env.model_mut().set_equalities(&held[1..]).is_err());
}

#[test]
fn what_is_changed_acts_in_the_next_steps_and_in_later_episodes_until_it_is_changed_back() {
    let config = free(Behavior::SelfTouch, Scene::Crib);
    let (mut plain, mut later) = (started(&config), started(&config));
    let before = course(&mut plain, 10);
    plain.reset(Some(6)).expect("no divergence");
    let then = course(&mut plain, 5);
    for (name, edit) in EDITS {
        let mut changed = started(&config);
        changed.model_mut().change(edit).expect(name);
        assert_ne!(course(&mut changed, 10), before, "{name} does not act");
        changed.reset(Some(6)).expect("no divergence");
        assert_ne!(course(&mut changed, 5), then, "{name} is forgotten by a reset");
        let original = later.blueprint().model_arrays();
        changed.model_mut().change(|model| *model = original).expect(name);
        assert!(
            changed.blueprint().model_changes().is_empty(),
            "{name}: {:?}",
            changed.blueprint().model_changes()
        );
        changed.reset(Some(6)).expect("no divergence");
        assert_eq!(course(&mut changed, 5), then, "{name} does not come back");
    }
    // one after the other, as at once
    for (_, edit) in EDITS {
        later.model_mut().change(edit).expect("it can be changed");
    }
    let mut at_once = started(&config);
    at_once
        .model_mut()
        .change(|m| EDITS.iter().for_each(|(_, edit)| edit(m)))
        .expect("it can be changed");
    assert_eq!(later.blueprint().model_arrays(), at_once.blueprint().model_arrays());
    assert_eq!(course(&mut later, 10), course(&mut at_once, 10));
}

#[test]
fn a_changed_model_steps_as_one_that_a_document_has() {
    let config = free(Behavior::None, Scene::Base);
    let document = edited(&config, |xml| {
        assert!(xml.contains("<option"), "the document has options");
        xml.replacen("<option", "<option gravity=\"0.5 0 -3\" density=\"2\"", 1)
    });
    let mut changed = env(config);
    changed
        .model_mut()
        .change(|model| (model.opt.gravity, model.opt.density) = ([0.5, 0.0, -3.0], 2.0))
        .expect("it can be changed");
    assert_eq!(changed.blueprint().model_arrays().opt, document.opt);
    let mut engine = changed.blueprint().engine();
    let mut other = babybench::physics::SoftEngine::new(
        std::sync::Arc::new(document),
        babybench::physics::SoftOptions::default(),
    );
    let (mut a, mut b) = (changed.state().clone(), changed.state().clone());
    for _ in 0..20 {
        engine.step(&mut a).expect("no divergence");
        babybench::physics::Engine::step(&mut other, &mut b).expect("no divergence");
    }
    assert_same_bits(&a, &b, "a changed model");
}

#[test]
fn gravity_changes_with_both_engines() {
    for engine in [EngineKind::Soft, EngineKind::Rapier] {
        if engine == EngineKind::Rapier && cfg!(not(feature = "rapier")) {
            continue;
        }
        let config = Config {
            engine,
            ..free(Behavior::None, Scene::Base)
        };
        let mut env = env(config);
        env.model_mut()
            .change(|model| model.opt.gravity = [0.0, 0.0, 9.81])
            .expect("it can be changed");
        env.reset(Some(0)).expect("no divergence");
        let before = env.state().qpos[2];
        let still = vec![0.0; env.action_space().len()];
        for _ in 0..100 {
            env.step(&still).expect("no divergence");
        }
        assert!(env.state().qpos[2] > before + 0.5, "MIMo falls upwards with {engine:?}");
    }
}

#[test]
fn what_cannot_be_changed_is_refused_and_changes_nothing() {
    let config = free(Behavior::SelfTouch, Scene::Base);
    let mut env = started(&config);
    let before = env.snapshot();
    let refused = |env: &mut Env, edit: Edit| match env.model_mut().change(edit) {
        Err(EnvError::ModelChange(e)) => e,
        other => panic!("{other:?}"),
    };
    assert_eq!(refused(&mut env, |m| m.nq += 1), ModelChangeError::Fixed);
    assert_eq!(refused(&mut env, |m| m.body_ipos[1][0] += 1.0), ModelChangeError::Fixed);
    assert_eq!(refused(&mut env, |m| m.body_mass.clear()), ModelChangeError::Fixed);
    for (said, edit) in [
        (
            "opt.timestep, number 0, is 0: it must be above 0",
            (|m| m.opt.timestep = 0.0) as Edit,
        ),
        ("body_mass, number 3, is -1: it must be above 0", |m| {
            m.body_mass[3] = -1.0
        }),
        ("geom_friction, number 3, is -0.5: it must be 0 or more", |m| {
            m.geom_friction[1][0] = -0.5
        }),
        (
            "opt.gravity, number 1, is NaN: the model has finite numbers only",
            |m| m.opt.gravity[1] = f64::NAN,
        ),
    ] {
        assert_eq!(refused(&mut env, edit).to_string(), said);
    }
    assert_eq!(env.snapshot(), before);
    let mut muscles = started(&Config {
        actuation_model: ActuationModel::Muscle,
        ..config
    });
    assert_eq!(
        refused(&mut muscles, |m| m.actuator_gear[0] *= 2.0),
        ModelChangeError::Muscles
    );
    // the muscles' own stiffness and damping are what is seen
    assert!(
        muscles
            .blueprint()
            .model_arrays()
            .jnt_stiffness
            .iter()
            .all(|s| *s == 0.0)
    );
    muscles
        .model_mut()
        .change(|m| m.opt.gravity[2] = -5.0)
        .expect("it can be changed");
    assert_eq!(muscles.blueprint().model_changes(), ["opt.gravity"]);
}

#[test]
fn snapshots_fit_environments_with_the_same_changes() {
    let config = free(Behavior::SelfTouch, Scene::Crib);
    let edit: Edit = |model| (model.opt.gravity[2], model.dof_armature[7]) = (-5.0, 0.5);
    let mut env = started(&config);
    env.model_mut().change(edit).expect("it can be changed");
    random_steps(&mut env, 3);
    let snapshot = env.snapshot();
    let go_on = |env: &mut Env| {
        let first = course(env, 4);
        env.reset(None).expect("no divergence");
        (first, course(env, 4))
    };
    let expected = go_on(&mut env);
    let mut other = started(&config);
    let refused = other.restore(&snapshot).expect_err("another model");
    let differences = "model.dof_armature was another one; model.opt.gravity was another one".to_string();
    assert_eq!(refused, SnapshotError::OtherConfiguration { differences });
    other.model_mut().change(edit).expect("it can be changed");
    other.restore(&snapshot).expect("the same model");
    assert_eq!(go_on(&mut other), expected);
    let mut copy = env.blueprint().env().expect("an environment");
    copy.restore(&snapshot).expect("a blueprint carries the changes");
    assert_eq!(go_on(&mut copy), expected);
}

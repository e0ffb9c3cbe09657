//! The actuation models, locks, and the typed view of proprioception.

mod locks;
mod noise;

use std::sync::Arc;

use crate::allocations;
use crate::common::*;
use babybench::actuation::{Actuation, ActuationError, MuscleModel, MuscleParams, PositionalModel, build};
use babybench::config::{ActuationModel, Behavior, Compat, Part, Scene};
use babybench::mimo::{LockError, build_model, embedded};
use babybench::physics::{Engine, SoftEngine, SoftOptions, State};
use babybench::sensors::ProprioceptionComponent;
use babybench::{Config, Env, EnvError, Model};

fn config(actuation_model: ActuationModel, behavior: Behavior, scene: Scene, compat: Compat) -> Config {
    Config {
        actuation_model,
        compat,
        ..free(behavior, scene.clone())
    }
}

/// A model, an actuation model and a state at `qpos0`, without an environment.
fn parts(kind: ActuationModel, compat: Compat) -> (Arc<Model>, Box<dyn Actuation>, State) {
    let config = config(kind, Behavior::None, Scene::Base, compat);
    let model = Arc::new(build_model(&config, &embedded()).expect("the assets load"));
    let actuation = build(&model, &config).expect("the actuators fit");
    let mut state = SoftEngine::new(model.clone(), SoftOptions::default()).new_state();
    actuation.prepare(&model, &mut state);
    (model, actuation, state)
}

fn close(a: f64, b: f64, what: &str) {
    assert!((a - b).abs() <= 1e-12, "{what}: {a} is not {b}");
}

fn actuator(model: &Model, name: &str) -> usize {
    model.actuator(name).expect("an actuator of MIMo")
}

#[test]
fn cost_of_the_motors() {
    let (model, motors, mut state) = parts(ActuationModel::SpringDamper, Compat::Reference);
    let gears: f64 = model.actuator_gear.iter().sum();
    assert!((gears - 127.849).abs() < 1e-9, "{gears}");
    motors.set_action(&model, &mut state, &[2.0; 44]);
    close(motors.cost(&model, &state), 0.018_984_121_896_841_625, "cost of 2");
    let mut seen = vec![0.0; motors.observation_len()];
    motors.observe(&model, &state, &mut seen);
    for (name, control, torque) in [
        ("act:hip_bend", 0.764_999_985_694_885_3, 8.093_699_848_7),
        ("act:head_tilt", 0.550_000_011_920_929, 1.815_000_039_3),
    ] {
        let i = actuator(&model, name);
        close(seen[i], control, name);
        assert!((seen[44 + i] - torque).abs() < 1e-10, "{name}: {}", seen[44 + i]);
    }
    motors.set_action(&model, &mut state, &[0.5; 44]);
    close(motors.cost(&model, &state), 0.005_628_431_696_885_323, "cost of .5");

    // within the motors' limits both ways are one
    motors.set_action(&model, &mut state, &[0.25; 44]);
    let (_, api, mut other) = parts(ActuationModel::SpringDamper, Compat::Api);
    api.set_action(&model, &mut other, &[0.25; 44]);
    assert_eq!(other.ctrl, state.ctrl);
    assert_eq!(api.cost(&model, &other), motors.cost(&model, &state));
}

#[test]
fn muscles_change_the_joints() {
    let (model, _, state) = parts(ActuationModel::Muscle, Compat::Api);
    for j in 0..model.njnt() {
        let d = model.jnt_dofadr[j];
        let own = model.jnt_name[j].starts_with("robot:");
        let divisor = if own { 20.0 } else { 1.0 };
        assert_eq!(state.params.dof_damping[d], model.dof_damping[d] / divisor);
        let stiffness = if own { 0.0 } else { model.jnt_stiffness[j] };
        assert_eq!(state.params.jnt_stiffness[j], stiffness);
    }
    assert!(state.params.actuator_forcelimited.iter().all(|on| !on));
}

#[test]
fn muscles_pull_passively_at_the_reference_pose() {
    let (model, muscles, mut state) = parts(ActuationModel::Muscle, Compat::Reference);
    muscles.set_action(&model, &mut state, &[0.0; 88]);
    for (i, name) in model.actuator_name.iter().enumerate() {
        let expect = match name.split_once('_').map_or("", |n| n.1) {
            "elbow" => -0.003_122_432,
            "fingers" => -0.000_384_525,
            "hip_flex" => -0.000_120_847,
            "knee" => -0.006_472_925,
            _ => 0.0,
        };
        let torque = state.muscle_torque[i];
        assert!((torque - expect).abs() < 1e-9, "{name}: {torque}");
        assert_eq!(state.ctrl[i], 1.0);
    }
}

#[test]
fn muscles_are_activated_in_every_physics_step() {
    for frame_skip in [1, 3] {
        let base = config(ActuationModel::Muscle, Behavior::None, Scene::Base, Compat::Api);
        let mut env = env(Config { frame_skip, ..base });
        env.reset(Some(0)).expect("no divergence");
        env.step(&[1.0; 88]).expect("no divergence");
        let expect = if frame_skip == 3 { 0.875 } else { 0.5 };
        assert!(env.state().act.iter().all(|a| *a == expect));
        let range = env
            .senses()
            .proprioception()
            .range(ProprioceptionComponent::Actuation)
            .expect("on");
        let seen = &env.observation().proprioception[range];
        assert_eq!((seen.len(), seen[0], seen[87]), (176, expect, expect));
        // sum |a^2 F| / (2n sum F)
        close(
            env.blueprint().actuation().cost(env.model(), env.state()),
            expect * expect / 88.0,
            "cost",
        );
    }
}

#[test]
fn forces_are_observed_in_newton_metres_per_moment() {
    let (model, muscles, mut state) = parts(ActuationModel::Muscle, Compat::Api);
    let i = actuator(&model, "act:right_elbow");
    let mut action = [0.0; 88];
    action[i] = 1.0;
    muscles.set_action(&model, &mut state, &action);
    close(state.muscle_torque[i], -2.001_684_006_927_329_3, "torque");
    let mut seen = vec![0.0; 176];
    muscles.observe(&model, &state, &mut seen);
    assert_eq!((seen[i], seen[44 + i]), (0.5, 0.0));
    close(
        seen[88 + i],
        f64::from(0.496_315_029_707_061_f64 as f32) * 35.43,
        "force 1",
    );
    assert_eq!(seen[132 + i], 0.0);
    let names = muscles.observation_names(&model);
    assert_eq!(names[88 + i], "act:right_elbow muscle 1 force");
    assert_eq!(muscles.action_names(&model)[44 + i], "act:right_elbow muscle 2");
}

/// Under `reference` the first observation of `behavior: none` is without muscle torque: controls 0, torques (the gears that
/// the reference shows) of the last step. Under `api` the passive torques act from the start.
#[test]
fn muscles_after_a_reset() {
    for compat in [Compat::Reference, Compat::Api] {
        let mut env = env(config(ActuationModel::Muscle, Behavior::None, Scene::Base, compat));
        for _ in 0..2 {
            env.reset(Some(0)).expect("no divergence");
            random_steps(&mut env, 5);
        }
        let torque = env.state().muscle_torque.clone();
        env.reset(Some(0)).expect("no divergence");
        let s = env.state();
        assert!(env.state().act.iter().all(|a| *a == 0.0));
        assert_eq!(s.muscle_torque == torque, compat == Compat::Reference);
        assert_eq!(
            (s.reference_gear(), &s.params.actuator_gear),
            (&s.muscle_torque[..], &env.model().actuator_gear)
        );
        assert_eq!(max_abs(&s.ctrl), if compat == Compat::Reference { 0.0 } else { 1.0 });
        assert_eq!(max_abs(&s.qfrc_actuator) == 0.0, compat == Compat::Reference);
        let knee = actuator(env.model(), "act:right_knee");
        let range = env
            .senses()
            .proprioception()
            .range(ProprioceptionComponent::Actuation)
            .expect("on");
        let force = env.observation().proprioception[range.start + 88 + knee];
        let p = MuscleParams::of_actuator(env.model(), knee).expect("a muscle");
        let q = env.model().jnt_qposadr[env.model().actuator_trnid[knee]];
        let angle = if compat == Compat::Reference { 0.0 } else { s.qpos[q] };
        assert_eq!(force, f64::from(p.forces(angle, 0.0, [0.0; 2])[0] as f32) * p.fmax[0]);
    }
}

#[test]
fn servos_hold_their_target_for_all_substeps_except_in_the_reference() {
    for (compat, frame_skip) in [
        (Compat::Api, 1),
        (Compat::Api, 4),
        (Compat::Reference, 1),
        (Compat::Reference, 4),
    ] {
        let base = config(ActuationModel::Positional, Behavior::None, Scene::Base, compat);
        let mut env = env(Config { frame_skip, ..base });
        env.reset(Some(0)).expect("no divergence");
        let elbow = actuator(env.model(), "act:right_elbow");
        let mut action = vec![0.0; 44];
        action[elbow] = -9.0;
        env.step(&action).expect("no divergence");
        let lost = compat == Compat::Reference && frame_skip > 1;
        let expect = if lost {
            0.0
        } else {
            f64::from(-146f64.to_radians() as f32)
        };
        assert_eq!(env.state().ctrl[elbow], expect, "{compat} {frame_skip}");
        let range = env
            .senses()
            .proprioception()
            .range(ProprioceptionComponent::Actuation)
            .expect("on");
        assert_eq!(env.observation().proprioception[range][elbow], expect);
        assert_eq!(env.blueprint().actuation().cost(env.model(), env.state()), 0.0);
    }
}

#[test]
fn servos_of_held_joints_stay_at_0() {
    let mut env = env(Config {
        lock: babybench::config::BodyParts {
            arms: true,
            ..Default::default()
        },
        ..config(
            ActuationModel::Positional,
            Behavior::SelfTouch,
            Scene::Cubes,
            Compat::Api,
        )
    });
    env.reset(Some(0)).expect("no divergence");
    let action: Vec<f32> = env.action_space().high().to_vec();
    env.step(&action).expect("no divergence");
    let range = env
        .senses()
        .proprioception()
        .range(ProprioceptionComponent::Actuation)
        .expect("on");
    let seen: Vec<f32> = env.observation().proprioception[range]
        .iter()
        .map(|v| *v as f32)
        .collect();
    assert_eq!(seen, action, "the observation is the action of held joints too");
    for (name, held) in [
        ("act:right_elbow", true),
        ("act:right_knee", true),
        ("act:right_hand_flex", false),
    ] {
        let Some(i) = env.model().actuator(name) else { continue };
        assert_eq!(env.state().ctrl[i] == 0.0, held, "{name}");
    }
    env.mimo_mut().unlock("robot:right_elbow").expect("a lock");
    env.step(&action).expect("no divergence");
    let elbow = actuator(env.model(), "act:right_elbow");
    assert_eq!(env.state().ctrl[elbow], f64::from(action[elbow]));
}

/// The scene of a configuration with another attribute of the element in whose tag `mark` stands.
fn changed(config: &Config, mark: &str, attribute: &str, value: &str) -> Model {
    let change = |line: &str| {
        let start = format!(" {attribute}=\"");
        if !line.contains(mark) {
            return format!("{line}\n");
        }
        let line = match line.split_once(&start) {
            Some((before, rest)) => format!("{before}{}", rest.split_once('"').expect("well formed").1),
            None => line.to_string(),
        };
        line.replacen(mark, &format!("{attribute}=\"{value}\" {mark}"), 1) + "\n"
    };
    edited(config, |xml| xml.lines().map(change).collect())
}

#[test]
fn illegal_muscles_are_named() {
    let base = config(ActuationModel::Muscle, Behavior::None, Scene::Base, Compat::Api);
    let good = build_model(&base, &embedded()).expect("the assets load");
    let elbow = actuator(&good, "act:right_elbow");
    assert!(MuscleModel::new(&good, Compat::Api).is_ok());
    let mut bad = Vec::new();
    for (k, value) in [(0, 0.0), (0, -1.0), (1, -1.0)] {
        let mut user = good.actuator_user[elbow].clone();
        user[k] = value;
        let user = user.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
        bad.push(changed(&base, "name=\"act:right_elbow\"", "user", &user));
    }
    // the joint has a class, the equality of the same name has not
    let joint = format!("name=\"{}\" class=", good.jnt_name[good.actuator_trnid[elbow]]);
    let unlimited = changed(&base, &joint, "limited", "false");
    assert!(!unlimited.jnt_limited[good.actuator_trnid[elbow]]);
    bad.push(unlimited);
    for model in bad {
        let error = build(&model, &base).err().expect("an error");
        assert!(
            matches!(&error, ActuationError::Parameter { actuator, .. } if actuator == "act:right_elbow"),
            "{error}"
        );
        assert!(error.to_string().contains("act:right_elbow"));
        println!("{error}");
    }
    let kind = PositionalModel::new(&good, Compat::Api).expect_err("motors");
    assert!(matches!(kind, ActuationError::Kind { .. }), "{kind}");
    let positional = config(ActuationModel::Positional, Behavior::None, Scene::Base, Compat::Api);
    let servos = build_model(&positional, &embedded()).expect("the assets load");
    assert!(matches!(
        MuscleModel::new(&servos, Compat::Api),
        Err(ActuationError::Kind { .. })
    ));
}

#[test]
fn bad_actions_change_nothing_and_wild_ones_are_clipped() {
    for &kind in ActuationModel::ALL {
        let shared = blueprint(config(kind, Behavior::None, Scene::Base, Compat::Api));
        let [mut env, mut tame] = [0, 1].map(|_| shared.env().expect("available"));
        env.reset(Some(0)).expect("no divergence");
        tame.reset(Some(0)).expect("no divergence");
        let n = env.action_space().len();
        let before = env.snapshot();
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut action = vec![0.0; n];
            action[n - 1] = bad;
            assert!(matches!(env.step(&action), Err(EnvError::ActionNotFinite { .. })));
        }
        assert!(matches!(
            env.step(&vec![0.0; n + 1]),
            Err(EnvError::ActionLength { .. })
        ));
        assert_eq!(env.snapshot(), before);
        env.step(&vec![f32::MAX; n]).expect("clipped");
        let high = env.action_space().high().to_vec();
        tame.step(&high).expect("no divergence");
        assert_same_bits(env.state(), tame.state(), "clipped");
    }
}

#[test]
fn actuation_allocates_nothing() {
    for &kind in ActuationModel::ALL {
        for compat in [Compat::Api, Compat::Reference] {
            let (model, actuation, mut state) = parts(kind, compat);
            let action = vec![0.3; actuation.action_space().len()];
            let mut seen = vec![0.0; actuation.observation_len()];
            let calls = allocations::of_this_thread();
            for _ in 0..3 {
                actuation.set_action(&model, &mut state, &action);
                actuation.substep(&model, &mut state);
                actuation.observe(&model, &state, &mut seen);
                std::hint::black_box(actuation.cost(&model, &state));
                actuation.reset(&model, &mut state);
            }
            assert_eq!(allocations::of_this_thread() - calls, 0, "{kind} {compat}");
        }
    }
}

#[test]
fn every_number_of_proprioception_has_a_name() {
    for &kind in ActuationModel::ALL {
        for compat in [Compat::Api, Compat::Reference] {
            let mut env = env(config(kind, Behavior::HandRegard, Scene::Base, compat));
            env.reset(Some(0)).expect("no divergence");
            let (p, model) = (env.senses().proprioception(), env.model());
            let entries = p.entries(model, env.blueprint().actuation());
            let mut end = 0;
            let mut names = std::collections::BTreeSet::new();
            for e in &entries {
                assert_eq!(e.range.start, end);
                end = e.range.end;
                assert!(
                    p.range(e.component)
                        .is_some_and(|r| r.start <= e.range.start && e.range.end <= r.end)
                );
                assert!(
                    names.insert(format!("{:?} {}", e.component, e.name)),
                    "{e:?} stands twice"
                );
                if e.component != ProprioceptionComponent::Actuation {
                    assert_eq!(p.find(model, e.component, &e.name), Some(e.range.clone()));
                }
            }
            assert_eq!(end, p.len());
            assert_eq!(p.find(model, ProprioceptionComponent::Angles, "robot:tail"), None);
            assert_eq!(
                env.blueprint().actuation().action_names(model).len(),
                env.action_space().len()
            );
        }
    }
}

#[test]
fn actuation_models_change_without_building_the_scene_again() {
    let motors = blueprint(config(
        ActuationModel::SpringDamper,
        Behavior::SelfTouch,
        Scene::Crib,
        Compat::Api,
    ));
    for &kind in ActuationModel::ALL {
        let other = motors.with_actuation(kind).expect("the embedded assets");
        assert_eq!(
            Arc::ptr_eq(other.model(), motors.model()),
            kind != ActuationModel::Positional,
            "{kind}"
        );
        let fresh = blueprint(config(kind, Behavior::SelfTouch, Scene::Crib, Compat::Api));
        assert_eq!(other.model(), fresh.model());
        assert_eq!(
            (other.init_qpos(), other.init_qvel()),
            (fresh.init_qpos(), fresh.init_qvel())
        );
        assert_eq!((other.params(), other.config()), (fresh.params(), fresh.config()));
        let back = other
            .with_actuation(ActuationModel::SpringDamper)
            .expect("the embedded assets");
        assert_eq!((back.init_qpos(), back.model()), (motors.init_qpos(), motors.model()));
    }
}

#[test]
fn states_and_activities_are_set_and_checked() {
    let mut env = env(config(ActuationModel::Muscle, Behavior::None, Scene::Base, Compat::Api));
    env.reset(Some(0)).expect("no divergence");
    random_steps(&mut env, 3);
    let (mut qpos, qvel) = (env.state().qpos.clone(), env.state().qvel.clone());
    let before = env.snapshot();
    assert!(matches!(
        env.by_hand().set_state(&qpos[1..], &qvel),
        Err(EnvError::StateLength { what: "qpos", .. })
    ));
    assert!(matches!(
        env.by_hand().set_state(&qpos, &[]),
        Err(EnvError::StateLength { what: "qvel", .. })
    ));
    assert!(env.by_hand().set_state(&vec![f64::NAN; qpos.len()], &qvel).is_err());
    assert!(matches!(
        env.by_hand().set_activity(&[0.0; 3]),
        Err(EnvError::StateLength { .. })
    ));
    assert!(env.by_hand().set_activity(&[f64::NAN; 88]).is_err());
    assert_eq!(env.snapshot(), before);
    qpos[2] += 1.0;
    env.by_hand().set_state(&qpos, &qvel).expect("a state");
    assert_eq!(env.state().qpos, qpos);
    assert_eq!(env.state().xpos[1][2], qpos[2], "poses are brought up to date");
    env.by_hand().set_activity(&[2.0; 88]).expect("clipped");
    assert!(env.state().act.iter().all(|a| *a == 1.0));
    let mut motors = crate::common::env(free(Behavior::None, Scene::Base));
    assert!(motors.by_hand().set_activity(&[]).is_ok() && motors.by_hand().set_activity(&[0.0]).is_err());
    assert!(motors.state().act.is_empty());
}

#[test]
fn servos_of_every_age_pull_to_the_angle_of_the_action() {
    // without gravity, springs alone keep a joint from it, which weaken less than a servo while he is small
    for age in [Some(0.0), Some(6.0), None] {
        let config = Config {
            age,
            actuation_model: ActuationModel::Positional,
            ..free(Behavior::None, Scene::Base)
        };
        let model = blueprint(config).model().clone();
        for name in ["act:left_eye_horizontal", "act:left_elbow"] {
            let servo = model.actuator(name).expect("a servo");
            assert_eq!(model.actuator_gear[servo], 1.0, "{name} at {age:?} months");
            let [gain, bias] = [model.actuator_gainprm[servo][0], model.actuator_biasprm[servo][1]];
            assert!(gain > 0.0 && gain == -bias, "{name} at {age:?} months");
        }
    }
}

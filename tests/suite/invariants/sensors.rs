//! Invariants 9 and 12: sensors lag by one physics step, and every part works without the environment.

use std::sync::Arc;

use babybench::actuation::{self, Actuation, SpringDamperModel};
use babybench::config::{ActuationModel, Behavior, Compat, Scene};
use babybench::mimo::{build_model, embedded};
use babybench::model::SensorType;
use babybench::physics::{Engine, SoftEngine, SoftOptions, State};
use babybench::sensors::{Proprioception, ProprioceptionComponent, Vestibular};
use babybench::{Config, Env, Model};

use crate::common::*;

/// Values of the sensors of one kind, one after the other.
fn sensors(model: &Model, s: &State, pick: impl Fn(SensorType) -> bool) -> Vec<f64> {
    (0..model.nsensor())
        .filter(|&i| pick(model.sensor_type[i]))
        .flat_map(|i| s.sensordata[model.sensor_adr[i]..][..3].iter().copied())
        .collect()
}

fn component(env: &Env, component: ProprioceptionComponent) -> &[f64] {
    &env.observation().proprioception[env
        .senses()
        .proprioception()
        .range(component)
        .expect("the component is on")]
}

#[test]
fn invariant_9_forces_lag_and_positions_do_not() {
    for frame_skip in [1, 3] {
        for (name, _) in EXAMPLES {
            let mut env = env(Config {
                frame_skip,
                vestibular_active: true,
                ..body_only(name)
            });
            env.reset(Some(0)).expect("no divergence");
            let model = env.model().clone();
            let mut engine = env.blueprint().engine();
            let mut action = Vec::new();
            for k in 0..10 {
                let mut past = env.state().clone();
                env.sample_action(&mut action);
                env.step(&action).expect("no divergence");
                let now = env.state();
                // the start of the last substep, seen with the control of this step
                past.ctrl.copy_from_slice(&now.ctrl);
                for _ in 1..frame_skip {
                    engine.step(&mut past).expect("no divergence");
                }
                engine.forward(&mut past).expect("no divergence");
                let at = format!("{name}, step {k}");
                let torques = sensors(&model, &past, |t| t == SensorType::Torque);
                let balance = sensors(&model, &past, |t| t != SensorType::Torque);
                assert_eq!(
                    component(&env, ProprioceptionComponent::Torques),
                    torques,
                    "{at}: torques"
                );
                assert_eq!(env.observation().vestibular, Some(&balance[..]), "{at}: vestibular");
                assert!(
                    past.contact == now.contact && past.geom_xpos == now.geom_xpos && past.cam_xmat == now.cam_xmat,
                    "{at}"
                );
                let joints = env.senses().proprioception().joints();
                let of = |values: &[f64], index: &[usize]| index.iter().map(|&i| values[i]).collect::<Vec<_>>();
                assert_eq!(
                    component(&env, ProprioceptionComponent::Angles),
                    of(&now.qpos, &joints.qpos),
                    "{at}: angles"
                );
                assert_eq!(
                    component(&env, ProprioceptionComponent::Velocities),
                    of(&now.qvel, &joints.dof),
                    "{at}: velocities"
                );
                assert_ne!(now.qpos, past.qpos, "{at}: nothing moved");
            }
        }
    }
}

#[test]
fn after_a_reset_without_start_actions_everything_is_of_one_moment() {
    let mut env = env(body_only("test_installation"));
    env.reset(Some(0)).expect("no divergence");
    let model = env.model().clone();
    let mut now = env.state().clone();
    now.qacc_warmstart.fill(0.0);
    env.blueprint().engine().forward(&mut now).expect("no divergence");
    assert_eq!(
        component(&env, ProprioceptionComponent::Torques),
        sensors(&model, &now, |t| t == SensorType::Torque)
    );
    assert_eq!(
        env.observation().vestibular,
        Some(&sensors(&model, &now, |t| t != SensorType::Torque)[..])
    );
}

/// The configuration with its switches of proprioception set by four bits, under either `compat`, and the components it has.
fn switched(base: &Config, flags: u32) -> [(Config, Vec<ProprioceptionComponent>); 2] {
    use ProprioceptionComponent::*;
    let on = |bit: u32| flags >> bit & 1 == 1;
    let api = Config {
        proprio_velocity: on(0),
        proprio_torque: on(1),
        proprio_limits: on(2),
        proprio_actuation: on(3),
        ..base.clone()
    };
    let reference = Config {
        compat: Compat::Reference,
        ..api.clone()
    };
    let page = [
        (Angles, true),
        (Velocities, on(0)),
        (Torques, on(1)),
        (Limits, on(2)),
        (Actuation, on(3)),
    ];
    let page = page.into_iter().filter_map(|(c, on)| on.then_some(c)).collect();
    [
        (api, page),
        (reference, vec![Actuation, Limits, Angles, Velocities, Torques]),
    ]
}

#[test]
fn the_observation_has_the_documented_length_and_order() {
    use ProprioceptionComponent::*;
    for (behavior, joints, torques, actuators) in [(Behavior::None, 47, 21, 44), (Behavior::HandRegard, 91, 53, 88)] {
        for kind in ActuationModel::ALL.iter().copied() {
            let per_actuator = match kind {
                ActuationModel::SpringDamper => 2,
                ActuationModel::Muscle => 4,
                ActuationModel::Positional => 1,
            };
            let base = Config {
                actuation_model: kind,
                ..free(behavior, Scene::Base)
            };
            let model = build_model(&base, &embedded()).expect("the assets load");
            let actuation = actuation::build(&model, &base).expect("every actuation model fits");
            assert_eq!(model.nu(), actuators);
            let len = |c: &ProprioceptionComponent| match c {
                Angles | Velocities | Limits => joints,
                Torques => 3 * torques,
                Actuation => per_actuator * actuators,
            };
            for flags in 0..16 {
                for (config, expect) in switched(&base, flags) {
                    let p = Proprioception::new(&model, &config, actuation.observation_len());
                    let mut start = 0;
                    let layout: Vec<_> = expect
                        .iter()
                        .map(|c| {
                            start += len(c);
                            (*c, start - len(c)..start)
                        })
                        .collect();
                    assert_eq!(p.layout(), layout, "{behavior} {kind} flags {flags:04b}");
                    assert_eq!(p.len(), start);
                }
            }
        }
    }
    for (name, expect) in [("self_touch", 264), ("hand_regard", 466), ("test_installation", 292)] {
        let mut env = env(body_only(name));
        assert_eq!(
            env.reset(Some(0)).expect("no divergence").proprioception.len(),
            expect,
            "{name}"
        );
    }
}

#[test]
fn invariant_12_parts_without_the_environment_give_the_same_observation() {
    let config = free(Behavior::None, Scene::Base);
    let mut env = env(config.clone());
    env.reset(Some(0)).expect("no divergence");

    let model = Arc::new(build_model(&config, &embedded()).expect("the assets load"));
    let mut engine = SoftEngine::new(model.clone(), SoftOptions::default());
    let mut state = engine.new_state();
    let motors = SpringDamperModel::new(&model, config.compat);
    let proprioception = Proprioception::new(&model, &config, motors.observation_len());
    let vestibular = Vestibular::new(&model);
    let (mut body, mut balance) = (vec![0.0; proprioception.len()], vec![0.0; vestibular.len()]);

    motors.reset(&model, &mut state);
    state.qpos.copy_from_slice(env.blueprint().init_qpos());
    state.qvel.copy_from_slice(env.blueprint().init_qvel());
    engine.forward(&mut state).expect("no divergence");
    let mut action = Vec::new();
    for _ in 0..20 {
        env.sample_action(&mut action);
        let observation = env.step(&action).expect("no divergence").observation;
        motors.set_action(&model, &mut state, &action);
        engine.step(&mut state).expect("no divergence");
        proprioception.observe(&model, &state, &motors, &mut body);
        vestibular.observe(&state, &mut balance);
        assert_eq!(observation.proprioception, body);
        assert_eq!(observation.vestibular, Some(&balance[..]));
    }
}

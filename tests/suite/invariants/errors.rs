//! Invariant 8: a bad action leaves the state untouched, a diverged state is an error and never an observation.

use babybench::config::{ActuationModel, Behavior, Config};
use babybench::physics::{EngineError, State};
use babybench::{Env, EnvError};

use crate::common::*;

fn started(name: &str) -> Env {
    let mut env = env(body_only(name));
    env.reset(Some(0)).expect("no divergence");
    random_steps(&mut env, 3);
    env
}

#[test]
fn invariant_8_actions_that_are_not_finite_leave_the_state_untouched() {
    let mut env = started("self_touch");
    let before = env.state().clone();
    let (observation, info) = (env.observation().proprioception.to_vec(), env.info().clone());
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for index in [0, 7, env.action_space().len() - 1] {
            let mut action = vec![0.5; env.action_space().len()];
            action[index] = value;
            let name = env.model().actuator_name[index].clone();
            let error = env.step(&action).expect_err("not finite");
            assert!(error.to_string().contains(&name), "{error} does not name {name}");
            match error {
                EnvError::ActionNotFinite {
                    index: i,
                    actuator,
                    value: v,
                } => {
                    assert_eq!((i, actuator, v.to_bits()), (index, name, value.to_bits()));
                }
                other => panic!("{other:?}"),
            }
            assert_same_bits(env.state(), &before, "after a bad action");
        }
    }
    assert_eq!(env.observation().proprioception, observation);
    assert_eq!(*env.info(), info);
    random_steps(&mut env, 1);
}

#[test]
fn invariant_8_actions_of_wrong_length_leave_the_state_untouched() {
    let mut env = started("hand_regard");
    let before = env.state().clone();
    let expected = env.action_space().len();
    for found in [0, 1, expected - 1, expected + 1, 2 * expected] {
        match env.step(&vec![0.5; found]).expect_err("wrong length") {
            EnvError::ActionLength { found: f, expected: e } => assert_eq!((f, e), (found, expected)),
            other => panic!("{other:?}"),
        }
        assert_same_bits(env.state(), &before, "after an action of wrong length");
    }
}

#[test]
fn a_step_before_reset_is_an_error() {
    let mut env = env(body_only("self_touch"));
    let before = env.state().clone();
    let action = vec![0.0; env.action_space().len()];
    assert!(matches!(env.step(&action), Err(EnvError::NotReset)));
    assert_same_bits(env.state(), &before, "step before reset");
}

#[test]
fn actions_out_of_range_are_clipped() {
    let shared = blueprint(body_only("test_installation"));
    let [mut wild, mut tame] = [0, 1].map(|_| shared.env().expect("available"));
    wild.reset(Some(0)).expect("no divergence");
    tame.reset(Some(0)).expect("no divergence");
    let n = wild.action_space().len();
    let values = |k: usize| [f32::MAX, 2.0, -2.0, f32::MIN, 1.0, -0.25][k % 6];
    for shift in 0..6 {
        let action: Vec<f32> = (0..n).map(|i| values(i + shift)).collect();
        let clipped: Vec<f32> = action
            .iter()
            .enumerate()
            .map(|(i, &a)| tame.action_space().clip(i, a))
            .collect();
        assert!(tame.action_space().contains(&clipped));
        wild.step(&action).expect("clipped");
        tame.step(&clipped).expect("in range");
        assert_same_bits(wild.state(), tame.state(), "clipping");
    }
}

/// Something done to a state.
type Change = Box<dyn Fn(&mut State)>;

/// Spoils a running environment; returns the error of the next step, after checking that the environment then wants a
/// reset and is as good as new after it.
fn spoil(name: &str, change: impl FnOnce(&mut State)) -> EngineError {
    let shared = blueprint(body_only(name));
    let mut env = shared.env().expect("available");
    env.reset(Some(6)).expect("no divergence");
    random_steps(&mut env, 4);
    change(env.state_mut());
    let action = vec![0.0; env.action_space().len()];
    let error = match env.step(&action).expect_err("spoiled") {
        EnvError::Engine(e) => e,
        other => panic!("{other:?}"),
    };
    assert!(
        env.observation().proprioception.iter().all(|v| v.is_finite()),
        "the last good observation stays"
    );
    assert!(
        matches!(env.step(&action), Err(EnvError::NotReset)),
        "a reset is needed"
    );
    env.reset(Some(6)).expect("a reset repairs everything");
    random_steps(&mut env, 4);
    let mut fresh = shared.env().expect("available");
    fresh.reset(Some(6)).expect("no divergence");
    random_steps(&mut fresh, 4);
    assert_same_bits(env.state(), fresh.state(), &format!("{name}: after {error}"));
    error
}

#[test]
fn invariant_8_numbers_that_are_not_finite_are_typed_errors() {
    for value in [f64::NAN, f64::INFINITY] {
        for at in [0, 4, 20] {
            let error = spoil("self_touch", |s| s.qpos[at] = value);
            assert!(
                matches!(error, EngineError::NotFinite { what: "qpos", index, .. } if index == at),
                "{error:?}"
            );
            let error = spoil("self_touch", |s| s.qvel[at] = value);
            assert!(
                matches!(error, EngineError::NotFinite { what: "qvel", index, .. } if index == at),
                "{error:?}"
            );
        }
        let error = spoil("self_touch", |s| s.params.jnt_stiffness[27] = value);
        let what = "params.jnt_stiffness";
        assert!(
            matches!(error, EngineError::NotFinite { what: w, index: 27, .. } if w == what),
            "{error:?}"
        );
        let error = spoil("self_touch", |s| s.qfrc_applied[9] = value);
        assert!(
            matches!(
                error,
                EngineError::NotFinite {
                    what: "qfrc_applied",
                    index: 9,
                    ..
                }
            ),
            "{error:?}"
        );
    }
}

#[test]
fn invariant_8_divergence_names_step_and_joint() {
    let steps_before = 10 + 4;
    let model = blueprint(body_only("self_touch")).model().clone();
    let joint = model.joint("robot:left_elbow").expect("MIMo has elbows");
    let (q, d) = (model.jnt_qposadr[joint], model.jnt_dofadr[joint]);
    let changes: [(&str, Change); 3] = [
        ("qvel", Box::new(move |s| s.qvel[d] = 1e11)),
        ("qpos", Box::new(move |s| s.qpos[q] = -1e11)),
        ("force", Box::new(move |s| s.qfrc_applied[d] = 1e30)),
    ];
    for (what, change) in changes {
        match spoil("self_touch", change) {
            EngineError::Diverged {
                step,
                joint,
                what: quantity,
                value,
                ..
            } => {
                println!("{what:10} -> step {step}, joint {joint}, {quantity} = {value:e}");
                assert_eq!(step, steps_before);
                assert!(model.joint(&joint).is_some(), "{joint:?} is not a joint");
                if what != "force" {
                    assert_eq!((joint.as_str(), quantity), ("robot:left_elbow", what));
                }
            }
            other => panic!("{what}: {other:?}"),
        }
    }
}

#[test]
fn a_spoiled_warm_start_does_no_harm() {
    for value in [f64::NAN, f64::INFINITY, 1e300] {
        let mut env = started("hand_regard");
        env.state_mut().qacc_warmstart.fill(value);
        let action = vec![0.0; env.action_space().len()];
        let step = env.step(&action).expect("the solver starts elsewhere");
        assert!(step.observation.proprioception.iter().all(|v| v.is_finite()));
    }
}

#[test]
fn a_state_of_another_shape_is_a_typed_error() {
    for (what, change) in [
        ("qpos", (|s: &mut State| s.qpos.truncate(1)) as fn(&mut State)),
        ("qvel", |s| s.qvel.push(0.0)),
        ("ctrl", |s| s.ctrl.clear()),
        ("qfrc_applied", |s| s.qfrc_applied.truncate(1)),
        ("qacc_warmstart", |s| s.qacc_warmstart.clear()),
        ("params.eq_active", |s| s.params.eq_active.clear()),
        ("params.eq_offset", |s| s.params.eq_offset.clear()),
        ("params.jnt_stiffness", |s| s.params.jnt_stiffness.push(0.0)),
        ("params.dof_damping", |s| s.params.dof_damping.clear()),
        ("muscle_torque", |s| s.muscle_torque.push(0.0)),
        ("params.actuator_gear", |s| s.params.actuator_gear.clear()),
        ("params.actuator_forcelimited", |s| {
            s.params.actuator_forcelimited.clear()
        }),
        ("xfrc_applied", |s| s.xfrc_applied.clear()),
        ("params.geom_size", |s| s.params.geom_size.clear()),
        ("xpos", |s| s.xpos.clear()),
        ("xanchor", |s| s.xanchor.truncate(3)),
        ("geom_xmat", |s| s.geom_xmat.clear()),
        ("cam_xpos", |s| s.cam_xpos.clear()),
        ("cdof", |s| s.cdof.clear()),
        ("qacc", |s| s.qacc.push(0.0)),
        ("cfrc_int", |s| s.cfrc_int.clear()),
        ("sensordata", |s| s.sensordata.clear()),
    ] {
        let mut engine = blueprint(body_only("self_touch")).engine();
        let mut state = engine.new_state();
        change(&mut state);
        let error = engine.step(&mut state).expect_err("wrong shape");
        assert!(
            matches!(error, EngineError::Shape { what: w, .. } if w == what),
            "{error:?}"
        );
    }
}

/// Every public vector of a state, each cleared.
const CLEARED: &[fn(&mut State)] = &[
    |s| s.qpos.clear(),
    |s| s.qvel.clear(),
    |s| s.ctrl.clear(),
    |s| s.act.clear(),
    |s| s.actuator_target.clear(),
    |s| s.muscle_force.clear(),
    |s| s.muscle_torque.clear(),
    |s| s.qfrc_applied.clear(),
    |s| s.xfrc_applied.clear(),
    |s| s.qacc_warmstart.clear(),
    |s| s.params.eq_active.clear(),
    |s| s.params.eq_offset.clear(),
    |s| s.params.jnt_stiffness.clear(),
    |s| s.params.dof_damping.clear(),
    |s| s.params.dof_invweight0.clear(),
    |s| s.params.actuator_gear.clear(),
    |s| s.params.actuator_forcelimited.clear(),
    |s| s.params.body_mass.clear(),
    |s| s.params.body_subtreemass.clear(),
    |s| s.params.body_inertia.clear(),
    |s| s.params.body_invweight0.clear(),
    |s| s.params.geom_size.clear(),
    |s| s.params.geom_rbound.clear(),
    |s| s.xpos.clear(),
    |s| s.xquat.clear(),
    |s| s.xmat.clear(),
    |s| s.xipos.clear(),
    |s| s.ximat.clear(),
    |s| s.xanchor.clear(),
    |s| s.xaxis.clear(),
    |s| s.geom_xpos.clear(),
    |s| s.geom_xmat.clear(),
    |s| s.site_xpos.clear(),
    |s| s.site_xmat.clear(),
    |s| s.cam_xpos.clear(),
    |s| s.cam_xmat.clear(),
    |s| s.subtree_com.clear(),
    |s| s.cdof.clear(),
    |s| s.contact.clear(),
    |s| s.cvel.clear(),
    |s| s.qfrc_bias.clear(),
    |s| s.qfrc_passive.clear(),
    |s| s.actuator_force.clear(),
    |s| s.qfrc_actuator.clear(),
    |s| s.qfrc_smooth.clear(),
    |s| s.qacc_smooth.clear(),
    |s| s.qfrc_constraint.clear(),
    |s| s.qacc.clear(),
    |s| s.cacc.clear(),
    |s| s.cfrc_ext.clear(),
    |s| s.cfrc_int.clear(),
    |s| s.sensordata.clear(),
];

/// Clears each public vector of the state in turn; `goes_on` are those without which a step goes on.
fn clear_each(config: Config, goes_on: &[usize]) {
    let blueprint = blueprint(config);
    let mut env = blueprint.env().expect("an environment");
    let action = vec![0.1; env.action_space().len()];
    for (k, clear) in CLEARED.iter().enumerate() {
        env.reset(Some(0)).expect("a reset makes the state whole again");
        let before = env.snapshot();
        clear(env.state_mut());
        let stepped = env.step(&action).map(drop);
        match stepped {
            Ok(()) => assert!(goes_on.contains(&k), "vector {k} is not missed"),
            Err(EnvError::Engine(EngineError::Shape { found: 0, .. })) => {
                assert!(env.by_hand().observe().is_err(), "vector {k}");
                let [mut left, mut right] = [0, 1].map(|_| vec![0; 16 * 16]);
                assert!(
                    env.senses_mut().eye_gray([&mut left, &mut right]).is_err(),
                    "vector {k}"
                );

                let start = [env.blueprint().init_qpos(), env.blueprint().init_qvel()].map(<[f64]>::to_vec);
                assert!(env.by_hand().set_state(&start[0], &start[1]).is_err(), "vector {k}");
                env.restore(&before).expect("room for what it holds");
                env.step(&action).expect("a state that is whole again");
            }
            Err(other) => panic!("vector {k}: {other}"),
        }
    }
}

#[test]
fn a_vector_of_the_state_that_is_cleared_is_a_typed_error() {
    let config = Config {
        vision_resolution: 16,
        ..Config::of(Behavior::HandRegard)
    };
    let by_motors = [3, 4, 5, 6, 38]; // what muscles have, and contacts
    clear_each(config.clone(), &by_motors);
    let actuation_model = ActuationModel::Muscle;
    // what the actuation of a step makes anew
    clear_each(
        Config {
            actuation_model,
            ..config
        },
        &by_motors,
    );
}

#[test]
fn a_control_that_is_not_finite_is_a_typed_error() {
    let mut engine = blueprint(body_only("self_touch")).engine();
    let mut state = engine.new_state();
    state.ctrl[5] = f64::NAN;
    let error = engine.forward(&mut state).expect_err("not finite");
    assert!(
        matches!(
            error,
            EngineError::NotFinite {
                what: "ctrl",
                index: 5,
                ..
            }
        ),
        "{error:?}"
    );
}

#[test]
fn reset_to_refuses_states_that_do_not_fit() {
    let mut env = env(body_only("self_touch"));
    let (qpos, qvel) = (
        env.blueprint().init_qpos().to_vec(),
        env.blueprint().init_qvel().to_vec(),
    );
    assert!(matches!(
        env.by_hand().reset_to(&qpos[1..], &qvel),
        Err(EnvError::StateLength { what: "qpos", .. })
    ));
    assert!(matches!(
        env.by_hand().reset_to(&qpos, &qvel[1..]),
        Err(EnvError::StateLength { what: "qvel", .. })
    ));
    let mut bad = qpos.clone();
    bad[10] = f64::NAN;
    assert!(matches!(
        env.by_hand().reset_to(&bad, &qvel),
        Err(EnvError::Engine(EngineError::NotFinite { .. }))
    ));
    let action = vec![0.0; env.action_space().len()];
    assert!(matches!(env.step(&action), Err(EnvError::NotReset)));
    env.by_hand().reset_to(&qpos, &qvel).expect("the settled state");
    env.step(&action).expect("no divergence");
}

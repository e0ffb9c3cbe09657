//! The `rapier` engine behind the same environment.
//!
//! `BABYBENCH_LONG=1` makes the endurance tests as long as those of the default engine: 100,000 steps per scene.

use std::sync::Arc;

use babybench::assets::MemoryAssets;
use babybench::config::{Behavior, EngineKind, Part, Scene};
use babybench::math::mat_t_vec;
use babybench::mimo::{build_model, embedded};
use babybench::mjcf_loader::load_str;
use babybench::physics::{Engine, EngineError, SoftEngine, SoftOptions, State, compile};
use babybench::rapier::{RapierEngine, RapierModel, RapierOptions};
use babybench::{Blueprint, Config, Env, EnvError, Model};

use crate::common::*;

fn rapier(config: Config) -> Config {
    Config {
        engine: EngineKind::Rapier,
        ..config
    }
}

fn rapier_env(behavior: Behavior, scene: Scene) -> Env {
    env(rapier(free(behavior, scene.clone())))
}

#[test]
fn every_scene_resets_steps_and_truncates() {
    for (behavior, scene) in MODELS {
        let mut env = env(rapier(Config {
            max_episode_steps: 5,
            ..free(behavior, scene.clone())
        }));
        assert!(matches!(env.step(&[]), Err(EnvError::NotReset)));
        env.reset(Some(3)).expect("no divergence");
        let mut action = Vec::new();
        for k in 1..=5 {
            env.sample_action(&mut action);
            let step = env.step(&action).expect("no divergence");
            assert!(step.observation.proprioception.iter().all(|v| v.is_finite()));
            assert_eq!(step.truncated, k == 5);
        }
        let found = env
            .blueprint()
            .rapier_scene(env.state())
            .expect("its own state")
            .contacts()
            .len();
        let felt = env.state().contact.iter().filter(|c| c.force[0] > 0.0).count();
        println!("{behavior}/{scene}: {found} contacts in the scene, {felt} with a force");
        assert!(found > 0 && felt > 0, "{behavior}/{scene}");
    }
}

/// The largest difference of accelerations of both engines along a run of the soft one, relative to the largest.
fn distance(model: Model, contacts: bool) -> Vec<f64> {
    let model = Arc::new(model);
    let (disable_contacts, soft, options) = (!contacts, SoftOptions::default(), RapierOptions::default());
    let mut soft = SoftEngine::new(
        model.clone(),
        SoftOptions {
            disable_contacts,
            ..soft
        },
    );
    let options = RapierOptions {
        disable_contacts,
        ..options
    };
    let mut rapier = RapierEngine::new(model.clone(), options).expect("a model for Rapier");
    let (mut ours, mut theirs) = (soft.new_state(), rapier.new_state());
    let mut errors = Vec::new();
    for k in 0..60 {
        for (i, ctrl) in ours.ctrl.iter_mut().enumerate() {
            *ctrl = (0.3 * (k * 7 + i * 13) as f64).sin();
        }
        theirs.copy_dynamic_from(&ours);
        soft.step(&mut ours).expect("no divergence");
        rapier.step(&mut theirs).expect("no divergence");
        let scale = max_abs(&ours.qacc);
        let difference = ours
            .qacc
            .iter()
            .zip(&theirs.qacc)
            .map(|(x, y)| x - y)
            .collect::<Vec<f64>>();
        errors.push(max_abs(&difference) / scale);
    }
    errors.sort_by(f64::total_cmp);
    errors
}

/// The scene of a configuration without limits, dry friction and equalities.
fn unconstrained(config: &Config) -> Model {
    let constraints = [
        (" range=\"", "\""),
        (" limited=\"", "\""),
        (" frictionloss=\"", "\""),
        ("<equality>", "</equality>"),
    ];
    let model = edited(config, |mut xml| {
        for (start, end) in constraints {
            while let Some((before, rest)) = xml.split_once(start) {
                let (_, after) = rest.split_once(end).expect("well formed");
                xml = format!("{before}{after}");
            }
        }
        xml
    });
    let all = build_model(config, &embedded()).expect("the assets load");
    assert_eq!((model.nv, model.nu(), model.neq()), (all.nv, all.nu(), 0));
    assert!(!model.jnt_limited.contains(&true) && !model.tendon_limited.contains(&true));
    assert!(model.dof_frictionloss.iter().all(|&loss| loss == 0.0));
    model
}

#[test]
fn without_contacts_accelerations_are_those_of_the_soft_engine() {
    for (behavior, scene) in MODELS {
        let config = crate::common::free(behavior, scene.clone());
        let model = build_model(&config, &embedded()).expect("the assets load");
        let (free, joints) = (distance(unconstrained(&config), false), distance(model, false));
        let at = |e: &[f64], q: f64| e[((e.len() - 1) as f64 * q) as usize];
        println!(
            "{behavior}/{scene}: without constraints max {:.1e}; with joints, tendons, welds p50 {:.1e} p90 {:.1e} max {:.1e}",
            at(&free, 1.0),
            at(&joints, 0.5),
            at(&joints, 0.9),
            at(&joints, 1.0)
        );
        assert!(at(&free, 1.0) < 4e-13, "{behavior}/{scene}");
        assert!(
            at(&joints, 0.5) < 0.025 && at(&joints, 0.9) < 0.15,
            "{behavior}/{scene}"
        );
    }
}

/// Upward force of the world's geoms on MIMo, N.
fn support(model: &Model, s: &State) -> f64 {
    let world = |g: usize| model.body_weldid[model.geom_bodyid[g]] == 0;
    let up = |c: &babybench::physics::Contact| mat_t_vec(&c.frame, [c.force[0], c.force[1], c.force[2]])[2];
    let sign = |c: &babybench::physics::Contact| f64::from(i32::from(world(c.geom[0])) - i32::from(world(c.geom[1])));
    s.contact.iter().map(|c| sign(c) * up(c)).sum()
}

#[test]
fn the_floor_carries_mimos_weight() {
    let mut env = rapier_env(Behavior::None, Scene::Base);
    env.reset(Some(0)).expect("no divergence");
    let model = env.model().clone();
    let weight = model.body_subtreemass[1] * -model.opt.gravity[2];
    let action = vec![0.0; env.action_space().len()];
    let (settling, steps) = if cfg!(debug_assertions) { (200, 50) } else { (1000, 350) };
    repeat(&mut env, &action, settling);
    let (mut mean, mut worst) = (0.0, 0.0_f64);
    for _ in 0..steps {
        repeat(&mut env, &action, 1);
        let share = support(&model, env.state()) / weight;
        mean += share / f64::from(steps);
        worst = worst.max((share - 1.0).abs());
    }
    println!(
        "the floor carries {mean:.6} of the weight over {steps} steps, off by {worst:.1e} at most; max |qvel| {:.1e}",
        max_abs(&env.state().qvel)
    );
    assert!((mean - 1.0).abs() < 5e-6 && worst < 0.3);
    // what lies on the floor feels it
    let mut env = rapier_touch();
    let action = vec![0.0; env.action_space().len()];
    repeat(&mut env, &action, 50);
    let touch = env.senses().touch().expect("touch is active");
    let felt = touch.values().iter().filter(|v| **v > 0.0).count();
    println!("{felt} of {} touch values are above 0", touch.values().len());
    assert!(felt > 10);
}

fn rapier_touch() -> Env {
    let mut env = env(rapier(Config {
        touch_active: true,
        ..free(Behavior::None, Scene::Base)
    }));
    env.reset(Some(0)).expect("no divergence");
    env
}

#[test]
fn locks_hold() {
    let mut env = rapier_env(Behavior::None, Scene::Base);
    env.reset(Some(0)).expect("no divergence");
    let report = env.mimo_mut().lock(Part::Head, 0.0).expect("can be locked");
    let elbow = env.mimo_mut().lock("robot:right_elbow", -1.2).expect("can be locked");
    assert!(elbow.held.is_empty() && !report.changed.is_empty());
    let zero = vec![0.0; env.action_space().len()];
    repeat(&mut env, &zero, 200);
    let at = |env: &Env, j: usize| env.state().qpos[env.model().jnt_qposadr[j]];
    let mut worst = [0.0_f64; 2];
    let mut action = Vec::new();
    for phase in 0..2 {
        for _ in 0..50 {
            if phase == 1 {
                env.sample_action(&mut action);
                env.step(&action).expect("no divergence");
            } else {
                repeat(&mut env, &zero, 1);
            }
            worst[phase] = worst[phase].max((at(&env, elbow.changed[0]) + 1.2).abs());
            for &j in report.changed.iter().filter(|j| !report.beyond_limits.contains(j)) {
                worst[phase] = worst[phase].max(at(&env, j).abs());
            }
        }
    }
    println!(
        "locks give way by {:.1e} rad at rest, {:.1e} under random torques",
        worst[0], worst[1]
    );
    assert!(worst[0] < 0.01 && worst[1] < 0.04);
    env.mimo_mut().unlock("robot:right_elbow").expect("can be unlocked");
    let push = vec![0.5; env.action_space().len()];
    repeat(&mut env, &push, 50);
    assert!((at(&env, elbow.changed[0]) + 1.2).abs() > 0.05);
}

#[test]
fn a_restored_environment_and_a_fresh_one_continue_with_the_same_bits() {
    for (behavior, scene) in [(Behavior::None, Scene::Base), (Behavior::HandRegard, Scene::Cubes)] {
        let shared: Blueprint = blueprint(rapier(free(behavior, scene.clone())));
        let mut first = shared.env().expect("available");
        first.reset(Some(1)).expect("no divergence");
        random_steps(&mut first, 10);
        let snapshot = first.snapshot();
        random_steps(&mut first, 10);
        // another one, with a past
        let mut second = shared.env().expect("available");
        second.reset(Some(9)).expect("no divergence");
        random_steps(&mut second, 3);
        second.restore(&snapshot).expect("the same environment");
        random_steps(&mut second, 10);
        assert_same_bits(first.state(), second.state(), &format!("{behavior}/{scene}"));
        assert_eq!(first.observation(), second.observation());
        // a copied state on an engine of its own, in another thread
        let state = first.state().clone();
        random_steps(&mut first, 1);
        let expect = (first.state().ctrl.clone(), first.state().qvel.clone());
        let qvel = std::thread::spawn(move || {
            let mut engine = shared.engine();
            let mut copy = engine.new_state();
            copy.copy_dynamic_from(&state);
            copy.ctrl.copy_from_slice(&expect.0);
            engine.step(&mut copy).expect("no divergence");
            assert_eq!(copy.qvel, expect.1);
        });
        qvel.join().expect("the same bits");
    }
    // a snapshot of another engine
    let mut soft = env(free(Behavior::None, Scene::Base));
    soft.reset(Some(0)).expect("no divergence");
    let mut other = rapier_env(Behavior::None, Scene::Base);
    assert!(other.restore(&soft.snapshot()).is_err());
}

#[test]
fn divergence_and_bad_input_are_errors() {
    let mut env = rapier_env(Behavior::None, Scene::Base);
    env.reset(Some(0)).expect("no divergence");
    let zero = vec![0.0; env.action_space().len()];
    for speed in [1e3, 1e6, 1e9, 1e12, 1e300] {
        env.reset(Some(0)).expect("no divergence");
        env.state_mut().qvel.fill(speed);
        let mut result = Ok(());
        for _ in 0..20 {
            result = env
                .step(&zero)
                .map(|s| assert!(s.observation.proprioception.iter().all(|v| v.is_finite())));
            if result.is_err() {
                break;
            }
        }
        println!(
            "qvel {speed:e}: {}",
            result
                .as_ref()
                .map_or_else(|e| e.to_string(), |()| "20 steps".to_string())
        );
        if speed > 1e10 {
            assert!(matches!(result, Err(EnvError::Engine(EngineError::Diverged { .. }))));
        }
    }
    let mut fresh = rapier_env(Behavior::None, Scene::Base);
    env.reset(Some(5)).expect("no divergence");
    fresh.reset(Some(5)).expect("no divergence");
    assert_same_bits(env.state(), fresh.state(), "after divergence");
    env.state_mut().qpos[9] = f64::NAN;
    assert!(matches!(
        env.step(&zero),
        Err(EnvError::Engine(EngineError::NotFinite {
            what: "qpos",
            index: 9,
            ..
        }))
    ));
}

/// Returns the error of the first step that fails, and what the steps before leave in contacts.
fn diverge(engine: &mut dyn Engine) -> EngineError {
    let mut state = engine.new_state();
    for _ in 0..20 {
        if let Err(error) = engine.step(&mut state) {
            return error;
        }
        for c in &state.contact {
            assert!(
                c.dist.is_finite() && c.pos.iter().chain(&c.force).all(|v| v.is_finite()),
                "{c:?}"
            );
        }
    }
    panic!("20 steps without an error");
}

#[test]
fn a_contact_that_is_no_number_is_an_error_that_names_its_geoms() {
    // A box of 1e23 m and more: MuJoCo's edges of boxes have no numbers for where it touches.
    let boxes = |size: &str| format!(r#"<freejoint/><geom type="box" size="{size}"/>"#);
    let xml = format!(
        r#"<mujoco><option cone="elliptic"/><worldbody><geom type="plane" size="0 1 1"/><body pos="0 0 .1">{}</body><body pos="0 0 .2"><freejoint/>
        <geom type="sphere" size=".6"/></body><body pos="0 0 .3">{}</body></worldbody></mujoco>"#,
        boxes(".1 .2 .1"),
        boxes(".1 .1 .21e30")
    );
    let model = Arc::new(
        load_str(&xml, "m.xml", &MemoryAssets::new())
            .and_then(compile)
            .expect("a valid model"),
    );
    let mut rapier = RapierEngine::new(model.clone(), RapierOptions::default()).expect("a rig");
    let error = diverge(&mut rapier);
    println!("{error}");
    assert!(
        matches!(&error, EngineError::DivergedContact { step: 2, .. }),
        "{error:?}"
    );
    println!("{}", diverge(&mut SoftEngine::new(model, SoftOptions::default())));
}

/// A pendulum of two hinges that carries `extra`.
fn pendulum(joint: &str, extra: &str) -> Model {
    let xml = format!(
        r#"<mujoco><worldbody><body name="upper" pos="0 0 1"><joint name="shoulder" type="hinge" axis="0 1 0"/>
        <geom type="capsule" size="0.02 0.1" mass="0.3"/><body name="lower" pos="0 0 -0.3"><joint name="elbow" {joint}/>
        <geom type="sphere" size="0.03" mass="0.1"/><body name="tool" pos="0 0.05 0">
        <geom type="box" size="0.01 0.02 0.03" mass="0.05"/></body></body></body></worldbody>{extra}</mujoco>"#
    );
    load_str(&xml, "pendulum.xml", &MemoryAssets::new())
        .and_then(compile)
        .expect("a valid model")
}

#[test]
fn a_model_that_does_not_fit_is_an_error_that_names_the_element() {
    let hinge = r#"type="hinge" axis="1 0 0""#;
    let good = pendulum(hinge, "");
    let free = distance(good, true);
    println!("a pendulum with a fixed part: max {:.1e}", free[free.len() - 1]);
    assert!(free[free.len() - 1] < 8e-12);
    let tendon =
        r#"<tendon><fixed name="string" limited="true" range="-1 1"><joint joint="elbow" coef="1"/></fixed></tendon>"#;
    for (joint, extra, name) in [
        (r#"type="slide" axis="1 0 0""#, "", "\"elbow\""),
        (hinge, tendon, "\"string\""),
    ] {
        let error = RapierModel::new(Arc::new(pendulum(joint, extra)), RapierOptions::default()).expect_err("refused");
        println!("{error}");
        assert!(error.to_string().contains(name));
    }
}

#[test]
fn geoms_that_start_deep_in_each_other_have_finite_forces() {
    let body =
        |z: f64, geom: &str| format!("<body pos='0 0 {z}'><freejoint/><geom type='{geom}' size='.1 .1 .1'/></body>");
    let tower = [
        body(0.1, "box"),
        body(0.2, "sphere"),
        body(0.3, "capsule"),
        body(0.4, "cylinder"),
        body(0.5, "box"),
    ];
    for cone in ["pyramidal", "elliptic"] {
        let text = format!(
            "<mujoco><option cone='{cone}'/><worldbody><geom type='plane' size='1 1 1'/>{}</worldbody></mujoco>",
            tower.concat()
        );
        let spec = load_str(&text, "tower.xml", &MemoryAssets::new()).expect("it is valid");
        let model = Arc::new(compile(spec).expect("it is valid"));
        let mut engine = RapierModel::new(model, RapierOptions::default())
            .expect("all are supported")
            .engine();
        let mut state = engine.new_state();
        for step in 0..20 {
            engine.step(&mut state).expect("no divergence");
            let forces: Vec<f64> = state.efc_rows().map(|row| row.force).collect();
            assert!(forces.iter().all(|f| f.is_finite()), "{cone}, step {step}: {forces:?}");
        }
    }
}

/// A block whose shape is a mesh lies on the floor and carries a ball.
#[test]
fn meshes_touch_as_their_hulls() {
    let text = "<mujoco><asset><mesh name='m' vertex='-.1 -.1 -.1 .1 -.1 -.1 -.1 .1 -.1 .1 .1 -.1 -.1 -.1 .1 .1 -.1 .1 -.1 .1 .1 .1 .1 .1'/></asset>\
        <worldbody><geom type='plane' size='1 1 1'/>\
        <body pos='0 0 .1'><freejoint/><geom type='mesh' mesh='m' mass='1'/></body>\
        <body pos='0 0 .25'><freejoint/><geom size='.05' mass='.5'/></body></worldbody></mujoco>";
    let model = load_str(text, "m.xml", &MemoryAssets::new())
        .and_then(compile)
        .expect("a model");
    let model = Arc::new(model);
    let mut engine = RapierEngine::new(model.clone(), RapierOptions::default()).expect("a model for Rapier");
    let mut state = engine.new_state();
    let mut carried = 0.0;
    for step in 0..500 {
        engine.step(&mut state).expect("no divergence");
        let of_floor = state.contact.iter().filter(|contact| contact.geom[0] == 0);
        carried += if step < 400 {
            0.0
        } else {
            of_floor.map(|contact| contact.force[0]).sum()
        };
    }
    let weight = 1.5 * 9.81;
    assert!(
        (0.01 * carried / weight - 1.0).abs() < 0.02,
        "{} N of {weight} N",
        0.01 * carried
    );
    assert!(
        (state.xpos[1][2] - 0.1).abs() < 2e-3 && (state.xpos[2][2] - 0.25).abs() < 4e-3,
        "{:?}",
        state.xpos
    );
}

fn endure(behavior: Behavior, scene: Scene, steps: usize) {
    let long = std::env::var_os("BABYBENCH_LONG").is_some_and(|v| v == "1");
    let steps = if long {
        100_000
    } else {
        steps / if cfg!(debug_assertions) { 10 } else { 1 }
    };
    let mut env = rapier_env(behavior, scene.clone());
    env.reset(Some(0)).expect("no divergence");
    let mut action = Vec::new();
    let mut fastest = 0.0_f64;
    for k in 0..steps {
        // the last third holds each action for 20 steps
        if k < steps - steps / 3 || k % 20 == 0 {
            env.sample_action(&mut action);
        }
        let step = env
            .step(&action)
            .unwrap_or_else(|e| panic!("{behavior}/{scene}, step {k}: {e}"));
        assert!(
            step.observation.proprioception.iter().all(|v| v.is_finite()),
            "step {k}"
        );
        fastest = fastest.max(max_abs(&env.state().qvel));
    }
    println!("{behavior}/{scene}: {steps} steps (BABYBENCH_LONG=1 for 100000), max |qvel| {fastest:.1}");
}

#[test]
fn random_actions_do_not_diverge_on_the_floor() {
    endure(Behavior::None, Scene::Base, 1000);
}

#[test]
fn random_actions_do_not_diverge_in_the_crib() {
    endure(Behavior::None, Scene::Crib, 1000);
}

#[test]
fn random_actions_do_not_diverge_among_the_cubes() {
    endure(Behavior::HandRegard, Scene::Cubes, 200);
}

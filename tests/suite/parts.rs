//! The parts of a reset and of a step, put together by hand, and blueprints of other assets.

use crate::common::*;
use babybench::assets::{AssetSource, MemoryAssets, Overlay};
use babybench::config::{ActuationModel, Behavior, Compat, Scene};
use babybench::env::BlueprintOptions;
use babybench::mimo::embedded;
use babybench::{Blueprint, Config, Env, EnvError};

fn config(actuation_model: ActuationModel) -> Config {
    Config {
        actuation_model,
        compat: Compat::Reference,
        frame_skip: 3,
        ..free(Behavior::SelfTouch, Scene::Crib)
    }
}

/// Does what [`Env::step`] does with an action, part by part.
fn step(env: &mut Env, action: &[f32]) {
    env.by_hand().set_action(action).expect("an action of the space");
    for k in 0..env.config().frame_skip {
        if k > 0 {
            env.by_hand().substep();
        }
        env.by_hand().physics_step().expect("no divergence");
    }
    env.by_hand().observe().expect("nothing to draw");
    env.by_hand().track();
}

#[test]
fn the_parts_of_a_reset_and_of_a_step_are_a_reset_and_a_step() {
    for &kind in ActuationModel::ALL {
        let blueprint = blueprint(config(kind));
        let (mut whole, mut apart) = (blueprint.env().expect("bodies"), blueprint.env().expect("bodies"));
        let (qpos, qvel) = (blueprint.init_qpos().to_vec(), blueprint.init_qvel().to_vec());
        let mut action = Vec::new();
        for episode in 0..2 {
            whole.by_hand().reset_to(&qpos, &qvel).expect("no divergence");
            apart.by_hand().reset_data();
            assert_eq!(apart.state().qpos, apart.model().qpos0);
            assert_eq!(apart.state().time, 0.0);
            apart.by_hand().forward(&qpos, &qvel).expect("no divergence");
            apart.by_hand().clear_info();
            apart.by_hand().observe().expect("nothing to draw");
            assert_eq!(whole.observation(), apart.observation());
            for k in 0..4 {
                whole.sample_action(&mut action);
                whole.step(&action).expect("no divergence");
                step(&mut apart, &action);
                assert_same_bits(
                    whole.state(),
                    apart.state(),
                    &format!("{kind}, episode {episode}, step {k}"),
                );
                assert_eq!(whole.observation(), apart.observation());
                assert_eq!(whole.info().behavior, apart.info().behavior);
            }
        }
    }
}

#[test]
fn parts_refuse_what_does_not_fit_and_change_nothing() {
    let mut env = env(config(ActuationModel::SpringDamper));
    env.reset(Some(0)).expect("no divergence");
    let (before, qvel) = (env.state().qpos.clone(), env.state().qvel.clone());
    let mut broken = before.clone();
    broken[3] = f64::NAN;
    assert!(env.by_hand().forward(&before[1..], &qvel).is_err());
    assert!(env.by_hand().set_position(&broken, &qvel).is_err());
    let action = vec![f32::NAN; env.action_space().len()];
    assert!(matches!(
        env.by_hand().set_action(&action),
        Err(EnvError::ActionNotFinite { .. })
    ));
    assert!(env.by_hand().set_action(&[0.0]).is_err());
    assert_eq!(env.state().qpos, before);
    assert!(env.by_hand().ready());
}

#[test]
fn blueprints_of_other_assets_change_their_actuators_and_their_age() {
    let config = config(ActuationModel::SpringDamper);
    let mut changed = MemoryAssets::new();
    let crib = embedded().read("babybench/crib.xml").expect("embedded").into_owned();
    changed.insert("babybench/crib.xml", crib).expect("a path");
    let options = BlueprintOptions::default().with_assets(Overlay::new(embedded()).with(changed));
    let kept = Blueprint::with(config.clone(), options).expect("the assets load");
    let own = blueprint(config);
    assert_eq!((kept.model(), kept.init_qpos()), (own.model(), own.init_qpos()));
    let servos = kept.with_actuation(ActuationModel::Positional).expect("servos");
    assert_eq!(servos.config().actuation_model, ActuationModel::Positional);
    let newborn = kept.with_age(Some(0.0)).expect("he grows");
    assert_eq!(newborn.model().body_name, own.model().body_name);
    assert!(newborn.model().body_mass < own.model().body_mass);
    assert!(kept.scenery().is_ok_and(|look| !look.textures.is_empty()));
}

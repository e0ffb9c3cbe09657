//! Pictures that are drawn when somebody asks for them.

use babybench::config::{Compat, Delays, NoiseLevels, TouchFunction, VisionOutput, VisionOutputs};
use babybench::env::draw_eyes;
use babybench::sensors::transform::{Sense, Signal, Transform};
use babybench::spaces::NumpyRng;
use babybench::vector::{Buffers, VectorError};
use babybench::{AutoresetMode, Config, Env, VectorEnv, VectorOptions};

use super::{everything, seen};
use crate::common::*;

/// Eyes that make of each picture what they make of it at three months, and nothing that a later one depends on.
fn eager() -> Config {
    let mut config = everything();
    config.eyes.acuity_left = Some(3.0);
    config.eyes.foveation = 5.0;
    config.vision_outputs = VisionOutputs::new([VisionOutput::Rgb, VisionOutput::Depth]);
    config
}

fn lazy(config: Config) -> Config {
    Config {
        vision_lazy: true,
        ..config
    }
}

/// The senses of a moment, with pictures.
fn looked(env: &mut Env) -> Vec<String> {
    env.senses_mut().look().expect("a renderer");
    seen(env)
}

#[test]
fn what_is_asked_for_has_the_bits_of_every_step_and_the_rest_is_not_drawn() {
    let mut every = env(eager());
    every.reset(Some(2)).expect("no divergence");
    for period in [1, 3, 7] {
        let mut some = env(lazy(eager()));
        every.reset(Some(2)).expect("no divergence");
        some.reset(Some(2)).expect("no divergence");
        let spaces = every.observation_space();
        assert_eq!(some.observation_space(), spaces);
        let mut looks = 0;
        for step in 0..21 {
            if step % period == 0 {
                assert!(looked(&mut some) == seen(&every), "step {step} of every {period}th");
                assert!(looked(&mut some) == seen(&every), "twice");
                looks += 1;
            } else {
                let (some, every) = (some.observation(), every.observation());
                assert_eq!((some.eye_left, some.eye_right_depth), (None, None));
                assert_eq!((some.proprioception, some.touch), (every.proprioception, every.touch));
            }
            assert_eq!(some.senses().pictures_drawn(), looks, "step {step} of every {period}th");
            random_steps(&mut every, 1);
            random_steps(&mut some, 1);
            assert_eq!(some.info(), every.info());
        }
        assert_eq!(some.observation_space(), spaces);
        assert!(some.snapshot() == every.snapshot());
    }
}

#[test]
fn snapshots_of_one_fit_the_other() {
    let (mut every, mut some) = (env(eager()), env(lazy(eager())));
    every.reset(Some(5)).expect("no divergence");
    some.reset(Some(5)).expect("no divergence");
    random_steps(&mut every, 3);
    random_steps(&mut some, 3);
    let (of_every, of_some) = (every.snapshot(), some.snapshot());
    assert!(
        looked(&mut some) == seen(&every),
        "a snapshot draws nothing and forgets nothing"
    );
    every.restore(&of_some).expect("it fits");
    some.restore(&of_every).expect("it fits");
    assert!(looked(&mut some) == seen(&every) && some.observation().eye_left.is_none());
    every.by_hand().refresh().expect("no divergence");
    some.by_hand().refresh().expect("no divergence");
    assert!(looked(&mut some) == seen(&every), "refreshed");
    every.by_hand().resume(&of_some).expect("it fits");
    some.by_hand().resume(&of_every).expect("it fits");
    let mut copy = some.clone();
    assert!(looked(&mut some) == seen(&every), "resumed");
    assert!(looked(&mut copy) == seen(&every), "a copy looks by itself");
    random_steps(&mut every, 2);
    random_steps(&mut some, 2);
    assert!(looked(&mut some) == seen(&every), "what follows");
}

#[test]
fn a_picture_is_gone_when_the_scene_has_moved_on() {
    let mut env = env(lazy(eager()));
    assert!(
        env.observation().eye_left.is_some(),
        "before the first reset there is nothing to draw"
    );
    env.reset(Some(1)).expect("no divergence");
    let action = vec![0.5; env.action_space().len()];
    let mut parts = env.by_hand();
    parts.set_action(&action).expect("a valid action");
    parts.physics_step().expect("no divergence");
    assert!(env.senses_mut().look().expect("a renderer").eye_left.is_none());
    env.by_hand().observe().expect("a renderer");
    assert!(env.senses_mut().look().expect("a renderer").eye_left.is_some());
    let (qpos, qvel) = (env.state().qpos.clone(), env.state().qvel.clone());
    env.by_hand().set_state(&qpos, &qvel).expect("no divergence");
    let picture = env
        .clone()
        .senses_mut()
        .look()
        .expect("a renderer")
        .eye_left
        .map(<[u8]>::to_vec);
    env.model_mut()
        .change(|model| model.geom_size.iter_mut().for_each(|size| size[0] *= 1.1))
        .expect("they may change");
    assert_eq!(
        env.observation().eye_left,
        picture.as_deref(),
        "geoms of other sizes come later"
    );
    assert_eq!(env.senses().pictures_drawn(), 2);
}

/// A number from the generator for each picture.
#[derive(Clone)]
struct Draws;

impl Transform for Draws {
    fn describe(&self) -> String {
        "draws".to_string()
    }
    fn apply(&mut self, _: Signal<'_>, rng: &mut NumpyRng) {
        rng.uniform();
    }
}

#[test]
fn what_a_later_picture_depends_on_is_drawn_in_every_step() {
    let delayed = Config {
        delays: Delays {
            vision: Some(2.0),
            ..Delays::default()
        },
        ..eager()
    };
    let noisy = Config {
        noise: NoiseLevels {
            vision: 3.0,
            ..NoiseLevels::default()
        },
        ..eager()
    };
    let rated = Config {
        vision_rate: Some(50.0),
        ..eager()
    };
    for config in [delayed, noisy, rated, infant()] {
        let (mut every, mut some) = (env(config.clone()), env(lazy(config)));
        assert!(!some.senses().vision_is_lazy());
        every.reset(Some(4)).expect("no divergence");
        some.reset(Some(4)).expect("no divergence");
        for step in 0..12 {
            assert!(seen(&every) == seen(&some), "step {step}");
            random_steps(&mut every, 1);
            random_steps(&mut some, 1);
        }
        assert_eq!(every.senses().pictures_drawn(), some.senses().pictures_drawn());
    }
    let [mut every, mut some] = [eager(), lazy(eager())].map(env);
    for env in [&mut every, &mut some] {
        env.senses_mut()
            .add_transform(Sense::EyeRight, Box::new(Draws))
            .expect("an eye");
        env.reset(Some(4)).expect("no divergence");
        random_steps(env, 3);
    }
    assert!(seen(&every) == seen(&some));
}

#[test]
fn the_same_environment_is_named_whichever_came_back_first() {
    let options = VectorOptions {
        threads: 1,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(&blueprint(lazy(eager())), 3, options).expect("a vector");
    envs.reset(0).expect("no divergence");
    let mut actions = Vec::new();
    envs.sample_actions(&mut actions).expect("all are at home");
    envs.send(&actions, &[2, 0, 1]).expect("valid actions");
    envs.recv(3).expect("three were sent");
    envs.send(&actions, &[0, 1, 2]).expect("valid actions");
    let refused = envs.look().map(|_| ());
    assert!(matches!(refused, Err(VectorError::InFlight { env: 0 })), "{refused:?}");
}

#[test]
fn the_reference_draws_in_every_step() {
    let config = Config {
        compat: Compat::Reference,
        touch_function: TouchFunction::ForceVector,
        ..lazy(everything())
    };
    let error = config.validate().expect_err("refused").to_string();
    assert!(error.contains("vision_lazy") && error.contains("every step"), "{error}");
    let blind = Config {
        vision_active: false,
        ..lazy(everything())
    };
    let error = blind.validate().expect_err("refused").to_string();
    assert!(error.contains("vision_active: true"), "{error}");
}

#[test]
fn a_vector_draws_for_those_who_ask() {
    let short = Config {
        max_episode_steps: 5,
        ..eager()
    };
    for (threads, mode) in [(1, AutoresetMode::SameStep), (3, AutoresetMode::NextStep)] {
        let [mut every, mut some] = [short.clone(), lazy(short.clone())].map(|config| {
            let options = VectorOptions {
                threads,
                autoreset: mode,
                ..VectorOptions::default()
            };
            let mut envs = VectorEnv::new(&blueprint(config), 3, options).expect("they fit");
            envs.reset(9).expect("no divergence");
            envs
        });
        assert!(some.batch().observation.eye_left.is_none());
        let mut actions = Vec::new();
        for step in 0..12 {
            every.sample_actions(&mut actions).expect("all are here");
            every.step(&actions).expect("valid actions");
            assert!(
                some.step(&actions)
                    .expect("valid actions")
                    .observation
                    .eye_left
                    .is_none()
            );
            assert_eq!(some.batch().rewards, every.batch().rewards);
            assert_eq!(
                some.finals().map(|f| f.observation),
                every.finals().map(|f| f.observation)
            );
            if step % 3 == 0 {
                let batch = some.look().expect("a renderer");
                assert!(batch.observation == every.batch().observation, "step {step}");
                assert_eq!(batch.truncated, every.batch().truncated);
            }
        }
        // into memory of the caller's, and while others are under way
        every.send(&actions, &[0, 1, 2]).expect("all are here");
        some.send(&actions, &[0, 1, 2]).expect("all are here");
        every.recv(3).expect("they were sent");
        let ids = some.recv(2).expect("they were sent").ids.to_vec();
        let pixels = every.batch().row(0).and_then(|o| o.eye_right).map_or(0, <[u8]>::len);
        let mut right = vec![0; 2 * pixels];
        let buffers = Buffers {
            eye_right: Some(&mut right),
            ..Buffers::default()
        };
        some.look_into(buffers).expect("a renderer");
        for (row, env) in ids.iter().enumerate() {
            let at = every.batch().ids.iter().position(|id| id == env).expect("received");
            let whole = every.batch().row(at).and_then(|o| o.eye_right);
            assert_eq!(whole, Some(&right[row * pixels..(row + 1) * pixels]));
        }
        let width = some.single_action_space().len();
        some.send(&actions[..width], &ids[..1]).expect("it is here");
        let error = some.look().expect_err("it has been sent on").to_string();
        assert!(error.contains(&ids[0].to_string()), "{error}");
    }
}

#[test]
fn eyes_that_are_drawn_together_are_drawn_once() {
    let mut envs: Vec<Env> = (0..2).map(|_| env(lazy(eager()))).collect();
    for env in &mut envs {
        env.reset(Some(3)).expect("no divergence");
    }
    draw_eyes(&mut envs).expect("a renderer");
    draw_eyes(&mut envs).expect("a renderer");
    for env in &mut envs {
        assert!(env.senses_mut().look().expect("a renderer").eye_left.is_some());
        assert_eq!(env.senses().pictures_drawn(), 1);
    }
}

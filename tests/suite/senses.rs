//! Senses that mature: what lies between a sense and the observation.

use babybench::config::{
    Behavior, Compat, DelayUnit, Delays, NoiseLevels, PainOptions, Scene, TouchFunction, VisionOutputs,
};
use babybench::env::Snapshot;
use babybench::math::{add, norm};
use babybench::sensors::EyeImages;
use babybench::sensors::transform::{Acuity, AcuityOptions, Foveation, Sense, Signal, Transform, acuity_cutoff};
use babybench::spaces::NumpyRng;
use babybench::vector::Buffers;
use babybench::{AutoresetMode, Blueprint, Config, Env, EnvError, VectorEnv, VectorOptions};

use crate::common::*;

/// All senses that there are, in a scene with contacts.
fn everything() -> Config {
    Config {
        behavior: Behavior::None,
        scene: Scene::Crib,
        touch_scale: 2.0,
        touch_pooled: true,
        pain_active: true,
        pain: PainOptions {
            threshold: 0.2,
            slope: 1.0,
            ..PainOptions::default()
        },
        vision_resolution: 12,
        ..Config::default()
    }
}

/// Each sense of a moment, as text.
fn seen(env: &Env) -> Vec<String> {
    let o = env.observation();
    vec![
        format!("{:?}", o.proprioception),
        format!("{:?}", o.touch),
        format!("{:?}", o.touch_pooled),
        format!("{:?}", o.pain),
        format!("{:?}", o.vestibular),
        format!("{:?} {:?}", o.eye_left, o.eye_right),
    ]
}

/// Resets two environments and lets them do the same; returns what each sensed.
fn side_by_side(a: Config, b: Config, steps: usize) -> [Vec<Vec<String>>; 2] {
    let mut envs = [env(a), env(b)];
    let mut all = [Vec::new(), Vec::new()];
    let mut rng = NumpyRng::seed(5);
    for (env, all) in envs.iter_mut().zip(&mut all) {
        env.reset(Some(0)).expect("no divergence");
        all.push(seen(env));
    }
    for _ in 0..steps {
        let mut action = Vec::new();
        envs[0].action_space().sample(&mut rng, &mut action);
        for (env, all) in envs.iter_mut().zip(&mut all) {
            env.step(&action).expect("no divergence");
            all.push(seen(env));
        }
    }
    all
}

#[test]
fn a_delay_of_d_steps_shows_what_was_d_steps_ago() {
    for (compat, by) in [(Compat::Api, 0), (Compat::Reference, 1)] {
        let now = Config {
            compat,
            touch_function: TouchFunction::ForceVector,
            ..everything()
        };
        let later = Config {
            delays: Delays {
                sensory: 3.0,
                vision: Some(2.0),
                touch: Some(5.0),
                vestibular: Some(0.0),
                ..Delays::default()
            },
            ..now.clone()
        };
        let [now, later] = side_by_side(now, later, 14);
        let delays: [usize; 6] = [3, 5, 5, 5, 0, 2];
        for (k, later) in later.iter().enumerate() {
            for (sense, delay) in delays.into_iter().enumerate() {
                let then = k.saturating_sub(delay.saturating_sub(by));
                assert_eq!(
                    later[sense], now[then][sense],
                    "{compat}: sense {sense} in observation {k}"
                );
            }
        }
        let moved = |sense: usize| now.iter().any(|seen| seen[sense] != now[0][sense]);
        assert!((0..delays.len()).all(moved), "every sense changes");
    }
}

#[test]
fn actions_reach_the_actuators_later() {
    let late = Config {
        delays: Delays {
            unit: DelayUnit::Ms,
            motor: 14.0, // three steps of 5 ms
            ..Delays::default()
        },
        ..free(Behavior::None, Scene::Base)
    };
    let (mut late, mut plain) = (env(late), env(free(Behavior::None, Scene::Base)));
    let rest = vec![0.0; late.action_space().len()];
    let mut rng = NumpyRng::seed(1);
    for episode in 0..2 {
        late.reset(Some(episode)).expect("no divergence");
        plain.reset(Some(episode)).expect("no divergence");
        let mut given = vec![rest.clone(); 3];
        for k in 0..8 {
            let mut action = Vec::new();
            late.action_space().sample(&mut rng, &mut action);
            given.push(action.clone());
            late.step(&action).expect("no divergence");
            plain.step(&given[k]).expect("no divergence");
            assert_eq!(bits(late.state()), bits(plain.state()), "episode {episode}, step {k}");
        }
    }
    assert_eq!((late.motor_delay(), plain.motor_delay()), (3, 0));
}

#[test]
fn under_reference_the_actions_of_a_reset_come_out_first() {
    let reference = |motor: f64| Config {
        compat: Compat::Reference,
        delays: Delays {
            motor,
            ..Delays::default()
        },
        ..free(Behavior::SelfTouch, Scene::Crib)
    };
    let (mut late, mut plain) = (env(reference(2.0)), env(reference(0.0)));
    let len = late.action_space().len();
    let action = |k: usize| vec![0.1 * k as f32 - 0.5; len];
    let starts: Vec<f32> = (0..3).flat_map(action).collect();
    late.reset_with(&starts).expect("no divergence");
    // one step late: the first comes out twice
    let shifted: Vec<f32> = [0, 0, 1].into_iter().flat_map(action).collect();
    plain.reset_with(&shifted).expect("no divergence");
    assert_eq!(bits(late.state()), bits(plain.state()));
    for k in 3..6 {
        late.step(&action(k)).expect("no divergence");
        plain.step(&action(k - 1)).expect("no divergence");
        assert_eq!(bits(late.state()), bits(plain.state()), "step {k}");
    }
}

/// `n` random steps: everything that comes out of them, as text.
fn course(env: &mut Env, n: usize) -> Vec<String> {
    let mut action = Vec::new();
    let mut step = || {
        env.sample_action(&mut action);
        let step = env.step(&action).expect("no divergence");
        format!("{:?} {:?}", step.observation, step.info)
    };
    (0..n).map(|_| step()).collect()
}

#[test]
fn a_copy_of_an_infant_continues_with_the_same_bits() {
    let blueprint = blueprint(infant());
    let mut first = blueprint.env().expect("an environment");
    first.reset(Some(3)).expect("no divergence");
    random_steps(&mut first, 7);
    let snapshot = first.snapshot();
    let expect = course(&mut first, 9);
    first.restore(&snapshot).expect("its own snapshot");
    assert_eq!(first.snapshot(), snapshot);
    assert!(course(&mut first, 9) == expect, "the same environment");
    let mut other = blueprint.env().expect("an environment");
    let kept = Snapshot::from_bytes(snapshot.as_bytes().to_vec()).expect("whole");
    other.restore(&kept).expect("of the same blueprint");
    assert!(course(&mut other, 9) == expect, "another environment");
    let without = Config {
        delays: Delays::default(),
        ..infant()
    };
    assert!(env(without).restore(&snapshot).is_err());
}

#[test]
fn a_reset_forgets_the_last_episode() {
    let mut used = env(infant());
    used.reset(Some(1)).expect("no divergence");
    random_steps(&mut used, 15);
    let mut fresh = env(infant());
    used.reset(Some(4)).expect("no divergence");
    fresh.reset(Some(4)).expect("no divergence");
    assert_eq!(used.observation(), fresh.observation());
    assert!(course(&mut used, 8) == course(&mut fresh, 8));
}

#[test]
fn infants_in_a_vector_are_as_if_alone() {
    const ENVS: usize = 3;
    let blueprint = blueprint(infant());
    let mut alone: Vec<Env> = (0..ENVS).map(|_| blueprint.env().expect("an environment")).collect();
    let options = VectorOptions {
        threads: 2,
        autoreset: AutoresetMode::SameStep,
        ..VectorOptions::default()
    };
    let mut envs = VectorEnv::new(&blueprint, ENVS, options).expect("memory");
    envs.reset(9).expect("no divergence");
    for (seed, env) in (9..).zip(&mut alone) {
        env.reset(Some(seed)).expect("no divergence");
    }
    let mut actions = Vec::new();
    let (mut pooled, mut pain) = (Vec::new(), Vec::new());
    for step in 0..25 {
        envs.sample_actions(&mut actions).expect("all are here");
        let len = actions.len() / ENVS;
        let batch = envs.step(&actions).expect("no divergence");
        for (k, env) in alone.iter_mut().enumerate() {
            let mut action = Vec::new();
            env.sample_action(&mut action);
            assert_eq!(action, actions[k * len..(k + 1) * len], "environment {k}, step {step}");
            let truncated = env.step(&action).expect("no divergence").truncated;
            if truncated {
                let last = batch
                    .finals
                    .and_then(|finals| finals.row(k))
                    .expect("the end of an episode");
                assert_eq!(last, env.observation(), "environment {k}, the last of step {step}");
                env.reset(None).expect("no divergence");
            }
            assert_eq!(batch.row(k), Some(env.observation()), "environment {k}, step {step}");
        }
        pooled.resize(batch.observation.touch_pooled.map_or(0, <[f64]>::len), 0.0);
        pain.resize(batch.observation.pain.map_or(0, <[f32]>::len), 0.0);
    }
    let buffers = Buffers {
        touch_pooled: Some(&mut pooled),
        pain: Some(&mut pain),
        ..Buffers::default()
    };
    envs.step_into(&actions, buffers).expect("room for all");
    assert!(pooled.iter().any(|v| *v != 0.0));
    assert!(pain.iter().any(|v| *v != 0.0));
}

#[test]
fn eyes_drawn_later_are_transformed_too() {
    let (mut direct, mut deferred) = (env(infant()), env(infant()));
    deferred.defer_vision(true);
    for env in [&mut direct, &mut deferred] {
        env.reset(Some(2)).expect("no divergence");
    }
    Env::draw_eyes([&mut deferred]).expect("a renderer");
    let mut action = Vec::new();
    for step in 0..8 {
        assert_eq!(direct.observation(), deferred.observation(), "before step {step}");
        for env in [&mut direct, &mut deferred] {
            env.sample_action(&mut action);
            env.step(&action).expect("no divergence");
        }
        Env::draw_eyes([&mut deferred]).expect("a renderer");
    }
}

#[test]
fn noise_has_its_deviation_and_the_generator_of_the_environment() {
    let noise = NoiseLevels {
        proprioception: 0.5,
        touch: 0.25,
        vestibular: 2.0,
        vision: 8.0,
    };
    let noisy = Config { noise, ..everything() };
    let run = |config: &Config, seed: u64| {
        let mut env = env(config.clone());
        env.reset(Some(seed)).expect("no divergence");
        env
    };
    let (clean, one, again, other) = (run(&everything(), 1), run(&noisy, 1), run(&noisy, 1), run(&noisy, 2));
    assert_eq!(seen(&one), seen(&again));
    assert_ne!(seen(&one), seen(&other));
    assert_eq!(bits(one.state()), bits(clean.state()), "noise is not in the world");
    let (c, n) = (clean.observation(), one.observation());
    let spread =
        |differences: Vec<f64>| (differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64).sqrt();
    let off = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<_>>();
    let body = spread(off(n.proprioception, c.proprioception));
    let bytes = |image: Option<&[u8]>| image.expect("eyes").iter().map(|&v| f64::from(v)).collect::<Vec<_>>();
    // of pixels that noise cannot clip
    let (before, after) = (bytes(c.eye_left), bytes(n.eye_left));
    let middle = (0..before.len()).filter(|&k| (40.0..215.0).contains(&before[k]));
    let eye = spread(middle.map(|k| after[k] - before[k]).collect());
    println!(
        "{} numbers: {body:.3} of 0.5; bytes: {eye:.3} of 8",
        c.proprioception.len()
    );
    assert!((0.42..0.58).contains(&body), "{body}");
    assert!((7.0..9.0).contains(&eye), "{eye}");
    let (felt, noisy) = (c.touch.expect("touch"), n.touch.expect("touch"));
    assert!(felt.iter().any(|v| *v != 0.0));
    for (felt, noisy) in felt.iter().zip(noisy) {
        assert!(
            *noisy >= 0.0 && (*felt != 0.0 || *noisy == 0.0),
            "{felt} became {noisy}"
        );
    }
    assert_eq!(c.touch_pooled, n.touch_pooled, "what is pooled has no noise");
}

#[test]
fn pooled_touch_is_the_sum_of_the_sensors() {
    for function in [TouchFunction::Normal, TouchFunction::ForceVector] {
        let mut env = env(Config {
            touch_function: function,
            ..everything()
        });
        env.reset(Some(0)).expect("no divergence");
        random_steps(&mut env, 30);
        let (touch, pool) = (env.touch().expect("touch"), env.touch_pool().expect("pooled"));
        let pooled = env.observation().touch_pooled.expect("pooled");
        assert!(pool.bodies().is_sorted() && pooled.len() == 5 * pool.bodies().len());
        let mut pressed = 0;
        for (&body, pooled) in pool.bodies().iter().zip(pooled.chunks_exact(5)) {
            let sensors = touch.body_values(body).chunks_exact(touch.width());
            let active = sensors.clone().filter(|v| v.iter().any(|v| *v != 0.0)).count();
            assert_eq!(pooled[1], active as f64);
            let felt = touch.contacts().iter().filter(|c| c.body == body && c.felt);
            let normal: f64 = felt.clone().map(|c| c.normal).sum();
            assert!((pooled[0] - normal).abs() < 1e-9);
            if function == TouchFunction::Normal {
                let sum: f64 = sensors.map(|v| f64::from(v[0])).sum();
                assert!((pooled[0] - sum).abs() < 1e-4, "{sum} N, pooled {pooled:?}");
            }
            let world = felt.fold([0.0; 3], |sum, c| add(sum, c.force));
            assert!((norm([pooled[2], pooled[3], pooled[4]]) - norm(world)).abs() < 1e-9);
            pressed += usize::from(active > 0);
        }
        assert!(pressed > 0, "something is pressed");
    }
}

/// The pain of each sensor, worked out from the contacts.
fn pain_of(env: &Env, options: &PainOptions, before: &[f32]) -> Vec<f64> {
    let touch = env.touch().expect("touch");
    let new = touch.values().iter().map(|&force| {
        let pain = match env.config().compat {
            Compat::Api => options.slope * (f64::from(force) - options.threshold),
            Compat::Reference => options.slope * f64::from(force) - options.threshold,
        };
        pain.max(0.0).min(options.limit.unwrap_or(f64::INFINITY)) * options.decay_new
    });
    new.zip(before)
        .map(|(new, old)| new.max(f64::from(*old) * options.decay_old))
        .collect()
}

#[test]
fn pain_begins_at_the_threshold_and_fades() {
    let pain = PainOptions {
        threshold: 0.05,
        slope: 2.0,
        limit: Some(1.5),
        decay_old: 0.8,
        decay_new: 0.5,
    };
    let config = Config { pain, ..everything() };
    let mut env = env(config);
    env.reset(Some(0)).expect("no divergence");
    let mut before = vec![0.0; env.observation().pain.expect("pain").len()];
    let (mut hurting, mut limited) = (0, 0);
    for step in 0..40 {
        let expect = pain_of(&env, &pain, &before);
        let found = env.observation().pain.expect("pain");
        for (k, (found, expect)) in found.iter().zip(&expect).enumerate() {
            let off = (f64::from(*found) - expect).abs();
            assert!(
                off <= 1e-6 * (1.0 + expect),
                "sensor {k}, step {step}: {found}, expected {expect}"
            );
        }
        hurting = hurting.max(found.iter().filter(|p| **p > 0.0).count());
        limited = limited.max(found.iter().filter(|p| **p == 0.75).count());
        before = found.to_vec();
        random_steps(&mut env, 1);
    }
    println!("{hurting} sensors hurt, {limited} as much as they can");
    assert!(hurting > 0 && limited > 0);
    // soft things do not hurt
    env.pain_mut().expect("pain").softness_mut().fill(0.0);
    for _ in 0..60 {
        random_steps(&mut env, 1);
    }
    let most = env
        .observation()
        .pain
        .expect("pain")
        .iter()
        .fold(0.0_f32, |most, p| most.max(*p));
    assert!(most < 1e-5, "{most} is left");
}

/// Counts and marks.
struct Marks {
    applied: f64,
}

impl Transform for Marks {
    fn describe(&self) -> String {
        "marks".to_string()
    }

    fn apply(&mut self, signal: Signal<'_>, _: &mut NumpyRng) {
        self.applied += 1.0;
        match signal {
            Signal::Numbers(values) => values[0] = self.applied,
            Signal::Skin(values) => values.of_mut(3)[0] = self.applied as f32,
            Signal::Eye { images, .. } => images.rgb[0] = self.applied as u8,
            _ => {}
        }
    }

    fn reset(&mut self) {
        self.applied = 0.0;
    }
}

#[test]
fn a_user_adds_a_transform() {
    let mut env = env(Config {
        delays: Delays {
            sensory: 1.0,
            ..Delays::default()
        },
        ..everything()
    });
    for sense in [Sense::Proprioception, Sense::Touch, Sense::EyeRight] {
        env.add_transform(sense, Box::new(Marks { applied: 0.0 }))
            .expect("it is on");
    }
    let chain = |env: &Env| -> Vec<String> {
        let (_, chain) = env.pipeline().find(|(sense, _)| *sense == Sense::Touch).expect("touch");
        chain.map(|transform| transform.describe()).collect()
    };
    assert_eq!(chain(&env), ["delay of 1 step (5 ms)", "marks"]);
    env.reset(Some(0)).expect("no divergence");
    for k in 1..5_u8 {
        let o = env.observation();
        assert_eq!(o.proprioception[0], f64::from(k));
        assert_eq!(o.touch.expect("touch")[3], f32::from(k));
        assert_eq!(o.eye_right.expect("an eye")[0], k);
        random_steps(&mut env, 1);
    }
    assert!(env.touch().expect("touch").values()[3] != 5.0, "the skin itself stays");
    env.set_age(Some(6.0)).expect("he grows");
    assert_eq!(chain(&env), ["delay of 1 step (5 ms)", "marks"]);

    let mut blind = crate::common::env(body_only("self_touch"));
    let error = blind
        .add_transform(Sense::Pain, Box::new(Marks { applied: 0.0 }))
        .expect_err("it is off");
    assert!(matches!(error, EnvError::SenseOff { sense: Sense::Pain }));
    assert!(error.to_string().contains("pain_active"), "{error}");
}

/// A picture of random bytes.
fn picture(rng: &mut NumpyRng, height: usize, width: usize) -> EyeImages {
    let mut images = EyeImages::new(VisionOutputs::default(), height * width);
    images.rgb.iter_mut().for_each(|v| *v = (256.0 * rng.uniform()) as u8);
    images
}

fn apply(transform: &mut dyn Transform, images: &mut EyeImages, height: usize, width: usize) {
    transform.apply(Signal::Eye { images, height, width }, &mut NumpyRng::seed(0));
}

fn mean(image: &EyeImages) -> f64 {
    image.rgb.iter().map(|&v| f64::from(v)).sum::<f64>() / image.rgb.len() as f64
}

fn contrast(image: &EyeImages) -> f64 {
    let mean = mean(image);
    image.rgb.iter().map(|&v| (f64::from(v) - mean).powi(2)).sum()
}

#[test]
fn acuity_keeps_the_mean_and_grows_with_age() {
    let mut rng = NumpyRng::seed(2);
    for (height, width) in [(64, 64), (48, 64), (31, 17), (1, 5)] {
        let image = picture(&mut rng, height, width);
        let mut before = 0.0;
        for age in [0.0, 1.0, 3.0, 9.0, 24.0, 36.0] {
            for reference in [false, true] {
                let options = AcuityOptions {
                    age,
                    fovy: 60.0,
                    reference,
                };
                let mut acuity = Acuity::new(options, height, width);
                let mut even = picture(&mut rng, height, width);
                even.rgb.fill(201);
                apply(&mut acuity, &mut even, height, width);
                assert!(even.rgb.iter().all(|v| *v == 201), "{height} x {width}: {:?}", even.rgb);
            }
            let mut blurred = image.clone();
            let options = AcuityOptions {
                age,
                fovy: 60.0,
                reference: false,
            };
            apply(&mut Acuity::new(options, height, width), &mut blurred, height, width);
            assert!((mean(&blurred) - mean(&image)).abs() < 1.0, "{age} months");
            let contrast = contrast(&blurred);
            assert!(
                (before..=self::contrast(&image)).contains(&contrast),
                "{height} x {width}, {age} months"
            );
            before = contrast;
        }
    }
    assert!((0..360).all(|k| acuity_cutoff(f64::from(k) / 10.0) <= acuity_cutoff(f64::from(k + 1) / 10.0)));
}

#[test]
fn foveation_enlarges_the_middle_and_keeps_the_corner() {
    let mut rng = NumpyRng::seed(3);
    for (height, width) in [(64, 64), (20, 33)] {
        let image = picture(&mut rng, height, width);
        let mut same = image.clone();
        apply(&mut Foveation::new(0.0, height, width), &mut same, height, width);
        assert_eq!(same, image, "strength 0 does nothing");
        for strength in [0.1, 2.0, 10.0, 1000.0] {
            let mut warped = image.clone();
            apply(&mut Foveation::new(strength, height, width), &mut warped, height, width);
            assert_eq!(warped.rgb[..3], image.rgb[..3], "the corner stays");
            let middle = 3 * ((height / 2) * width + width / 2);
            if height % 2 + width % 2 == 0 {
                assert_eq!(
                    warped.rgb[middle..middle + 3],
                    image.rgb[middle..middle + 3],
                    "the middle stays"
                );
            }
            let mut even = image.clone();
            even.rgb.fill(77);
            apply(&mut Foveation::new(strength, height, width), &mut even, height, width);
            assert!(even.rgb.iter().all(|v| *v == 77));
        }
    }
}

#[test]
fn each_environment_of_a_vector_has_its_own_age() {
    let config = Config {
        age: Some(12.0),
        touch_grows: true,
        touch_scale: 2.0,
        vision_active: false,
        ..Config::default()
    };
    let make = |config: Config| VectorEnv::new(&blueprint(config), 3, VectorOptions::default()).expect("memory");
    let mut envs = make(config.clone());
    for (env, age) in [(0, Some(0.5)), (2, Some(24.0))] {
        envs.set_age(env, age).expect("the spaces stay");
    }
    envs.reset(1).expect("no divergence");
    let mut actions = Vec::new();
    envs.sample_actions(&mut actions).expect("all are here");
    envs.step(&actions).expect("no divergence");
    let masses: Vec<f64> = (0..3)
        .map(|k| envs.env(k).expect("it is here").model().body_mass.iter().sum())
        .collect();
    assert!(
        masses.is_sorted() && masses[0] < 5.0 && masses[2] > 12.0,
        "{masses:?} kg"
    );
    let len = actions.len() / 3;
    for (k, age) in [(0, 0.5), (2, 24.0)] {
        let mut alone = env(Config {
            age: Some(age),
            ..config.clone()
        });
        alone.reset(Some(1 + k as u64)).expect("no divergence");
        alone.step(&actions[k * len..(k + 1) * len]).expect("no divergence");
        assert_eq!(envs.batch().row(k), Some(alone.observation()), "{age} months");
    }

    let mut shrinking = make(Config {
        touch_grows: false,
        ..config
    });
    shrinking.reset(0).expect("no divergence");
    let error = shrinking
        .set_age(1, Some(3.0))
        .expect_err("less skin has fewer sensors")
        .to_string();
    assert!(error.contains("environment 1") && error.contains("touch"), "{error}");
    assert!(error.contains("touch_grows"), "{error}");
    assert_eq!(shrinking.env(1).expect("it is here").config().age, Some(12.0));
    assert!(shrinking.set_age(1, Some(99.0)).is_err() && shrinking.set_age(9, None).is_err());
}

#[test]
fn a_blueprint_of_an_infant_makes_infants() {
    let grown: Vec<f64> = [None, Some(0.0), Some(24.0)]
        .into_iter()
        .map(|age| {
            let blueprint = Blueprint::new(infant())
                .and_then(|b| b.with_age(age))
                .expect("he grows");
            let env = blueprint.env().expect("an environment");
            let (_, mut chain) = env
                .pipeline()
                .find(|(sense, _)| *sense == Sense::EyeRight)
                .expect("an eye");
            let acuity = chain.next().expect("acuity").describe();
            let age = acuity.split(' ').nth(2).expect("an age");
            age.parse::<f64>().expect("a number")
        })
        .collect();
    assert_eq!(grown, [18.0, 0.0, 24.0], "the acuity is that of the age");
}

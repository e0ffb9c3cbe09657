//! Noise, and transforms that a program adds.

use babybench::config::{Delays, NoiseLevels};
use babybench::sensors::transform::{Sense, Signal, Transform};
use babybench::spaces::NumpyRng;
use babybench::{Config, Env, EnvError};

use super::{everything, seen};
use crate::common::*;

#[test]
fn noise_has_its_deviation_and_the_generator_of_the_environment() {
    let noise = NoiseLevels {
        proprioception: 0.5,
        touch: 0.25,
        vestibular: 2.0,
        vision: 8.0,
        motor: 0.0,
        motor_color: None,
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

/// Counts and marks.
#[derive(Clone)]
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
        env.senses_mut()
            .add_transform(sense, Box::new(Marks { applied: 0.0 }))
            .expect("it is on");
    }
    let chain = |env: &Env| -> Vec<String> {
        let (_, chain) = env
            .senses()
            .transforms()
            .find(|(sense, _)| *sense == Sense::Touch)
            .expect("touch");
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
    assert!(
        env.senses().touch().expect("touch").values()[3] != 5.0,
        "the skin itself stays"
    );
    env.mimo_mut().set_age(Some(6.0)).expect("he grows");
    assert_eq!(chain(&env), ["delay of 1 step (5 ms)", "marks"]);

    let mut blind = crate::common::env(body_only("self_touch"));
    let error = blind
        .senses_mut()
        .add_transform(Sense::Pain, Box::new(Marks { applied: 0.0 }))
        .expect_err("it is off");
    assert!(matches!(error, EnvError::SenseOff { sense: Sense::Pain }));
    assert!(error.to_string().contains("pain_active"), "{error}");
}

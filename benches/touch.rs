//! Measures the cost of touch: `cargo bench --bench touch`.
//!
//! Contacts come from a run of the self-touch example with random actions; each recorded step is felt again and again.
//! A straight line through the times of steps with few and many felt sides gives the cost of a step and of a side.
//! Figures are medians.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use babybench::config::{Behavior, BodyParts, Compat, Scene, TouchFunction, TouchResponse};
use babybench::math::{Mat3, Vec3};
use babybench::physics::Contact;
use babybench::sensors::{SkinLayout, Touch};
use babybench::{Blueprint, Config, Model};

const EXAMPLE: &str = include_str!("../configs/config_selftouch.yml");

/// Contacts of a step, with the poses at the same instant.
type Recorded = (Vec<Contact>, Vec<Vec3>, Vec<Mat3>);

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Returns the time of one call, ns: the median of `samples` means over `repeat` calls.
fn time(samples: usize, repeat: usize, mut work: impl FnMut()) -> f64 {
    work();
    let sample = |_| {
        let start = Instant::now();
        (0..repeat).for_each(|_| work());
        start.elapsed().as_nanos() as f64 / repeat as f64
    };
    median((0..samples).map(sample).collect())
}

/// Prints the time to place the sensors of either version of MIMo.
fn construction() {
    println!("construction at touch_scale 1");
    for behavior in [Behavior::SelfTouch, Behavior::HandRegard] {
        let config = Config {
            behavior,
            scene: Scene::Crib,
            ..Config::default()
        };
        let model = babybench::mimo::build_model(&config, &babybench::mimo::embedded()).expect("the assets load");
        let ns = time(15, 1, || {
            black_box(SkinLayout::new(&model, &config).expect("valid"));
        });
        let n = SkinLayout::new(&model, &config).expect("valid").len();
        println!("  {:12} {n} sensors: {:.2} ms", behavior.name(), ns / 1e6);
    }
}

/// Records every fifth step of a run with random actions.
fn record(blueprint: &Blueprint) -> Vec<Recorded> {
    let mut env = blueprint.env().expect("available");
    env.reset(Some(0)).expect("no divergence");
    let mut steps = Vec::new();
    let mut action = Vec::new();
    for k in 0..2000 {
        if k % 10 == 0 {
            env.sample_action(&mut action);
        }
        env.step(&action).expect("no divergence");
        if k % 5 == 0 {
            let s = env.state();
            steps.push((s.contact.clone(), s.xpos.clone(), s.xmat.clone()));
        }
    }
    steps
}

/// Prints the time to sense the recorded steps.
fn sense(
    model: &Model,
    layout: &Arc<SkinLayout>,
    steps: &[Recorded],
    function: TouchFunction,
    response: TouchResponse,
) {
    let mut touch = Touch::new(layout.clone(), function, response, Compat::Api);
    let (mut sides, mut active) = (0, 0);
    for (contacts, xpos, xmat) in steps {
        touch.sense(model, contacts, xpos, xmat);
        sides += touch.contacts().len();
        active += touch.active().count();
    }
    let all = time(21, 5, || {
        for (contacts, xpos, xmat) in steps {
            touch.sense(model, contacts, xpos, xmat);
            black_box(touch.values());
        }
    });
    let none = time(21, 5, || {
        for (_, xpos, xmat) in steps {
            touch.sense(model, &[], xpos, xmat);
            black_box(touch.values());
        }
    });
    let n = steps.len() as f64;
    println!(
        "{:20} {:14} {:4.1} sides and {:5.1} sensors per step: {:7.3} us per step; {:6.3} us \
         without contacts, {:6.3} us per side",
        function.name(),
        response.name(),
        sides as f64 / n,
        active as f64 / n,
        all / n / 1e3,
        none / n / 1e3,
        (all - none) / sides as f64 / 1e3
    );
}

fn main() {
    let mut config = Config::from_yaml(EXAMPLE, "example").expect("the examples are valid");
    config.vision_active = false;
    config.touch = BodyParts::all(true);
    let blueprint = Blueprint::new(config).expect("available");
    let layout = blueprint.skin().expect("touch is on");
    construction();
    let steps = record(&blueprint);
    for &function in TouchFunction::ALL.iter().filter(|&&f| f != TouchFunction::NormalForce) {
        for &response in TouchResponse::ALL {
            sense(blueprint.model(), layout, &steps, function, response);
        }
    }
    let bytes = layout.len() * (6 * 8 + 4);
    println!("tables shared by all environments: about {} KiB", bytes / 1024);
}

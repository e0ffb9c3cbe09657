//! MIMo in a Rapier world: he sits on its ground, and balls fall on him. The example then measures the cost of a step, alternating with his own
//! scene.
//!
//! ```sh
//! cargo run --release --features rapier --example rapier_world
//! ```

use std::time::{Duration, Instant};

use babybench::config::{Behavior, Scene};
use babybench::env::Infant;
use babybench::rapier::rapier3d_f64::prelude::*; // the version of Rapier that the library is built with
use babybench::rapier::{CouplingOptions, WorldSets};
use babybench::{Config, Env};

type Error = Box<dyn std::error::Error>;

/// Bodies of the world far from him.
const FAR: usize = 100;

fn config() -> Config {
    Config {
        behavior: Behavior::None,
        scene: Scene::Base,
        vision_active: false,
        touch_active: false,
        ..Config::default()
    }
}

/// A world with a ground, and boxes that are not near him.
fn world() -> PhysicsWorld {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, 0.0, -9.81);
    world.integration_parameters.dt = 0.005;
    world.insert_collider(
        ColliderBuilder::new(SharedShape::halfspace(Vector::Z)).friction(1.0),
        None,
    );
    for k in 0..FAR {
        let place = Vector::new(5.0 + 0.3 * (k % 10) as f64, 0.3 * (k / 10) as f64, 0.1);
        world.insert(
            RigidBodyBuilder::dynamic().translation(place).can_sleep(false),
            ColliderBuilder::cuboid(0.1, 0.1, 0.1),
        );
    }
    world
}

fn play() -> Result<(), Error> {
    let mut world = world();
    let config = Config {
        touch_active: true,
        ..config()
    };
    let (here, options) = (Pose::IDENTITY, CouplingOptions::default());
    let mut infant = Infant::join(&mut WorldSets::from(&mut world), config, here, options)?;
    let hip = infant.env().model().body("hip").ok_or("he has a hip")?;
    let [x, y, z] = infant.env().state().xpos[hip];
    let mut balls = Vec::new();
    for k in 0..3 {
        let place = Vector::new(x + 0.05, y, z + 0.4 + 0.4 * f64::from(k));
        let ball = RigidBodyBuilder::dynamic().translation(place);
        balls.push(world.insert(ball, ColliderBuilder::ball(0.04).density(400.0)).0);
    }
    let mut action = Vec::new();
    for k in 0..200 {
        infant.env_mut().sample_action(&mut action);
        let step = infant.step(&mut WorldSets::from(&mut world), &action)?;
        let felt = step
            .observation
            .touch
            .map_or(0, |touch| touch.iter().filter(|v| **v != 0.0).count());
        world.step();
        if k % 20 == 0 {
            let heights: Vec<String> = balls
                .iter()
                .map(|&b| format!("{:.2}", world.bodies[b].translation().z))
                .collect();
            let near = infant.coupling().neighbors().count();
            println!(
                "{:.2} s: {near} bodies near, {felt} numbers felt, balls at {} m",
                0.005 * f64::from(k),
                heights.join(", ")
            );
        }
    }
    Ok(())
}

/// Compares the time of a step of both with that of his own scene and that of the world without him.
fn compare() -> Result<(), Error> {
    let (mut with, mut without) = (world(), world());
    let (here, options) = (Pose::IDENTITY, CouplingOptions::default());
    let mut infant = Infant::join(&mut WorldSets::from(&mut with), config(), here, options)?;
    let mut alone = Env::new(config())?;
    alone.reset(Some(0))?;
    for world in [&mut with, &mut without] {
        for k in 0..4 {
            let place = Vector::new(0.3 + 0.15 * f64::from(k), 0.1, 0.05);
            let ball = RigidBodyBuilder::dynamic().translation(place).can_sleep(false);
            world.insert(ball, ColliderBuilder::ball(0.05));
        }
    }
    let (mut coupled, mut own, mut rapier) = (Vec::new(), Vec::new(), Vec::new());
    let mut action = Vec::new();
    for _ in 0..60 {
        let mut spent = [Duration::ZERO; 3];
        for _ in 0..20 {
            alone.sample_action(&mut action);
            let start = Instant::now();
            infant.step(&mut WorldSets::from(&mut with), &action)?;
            with.step();
            let first = Instant::now();
            alone.step(&action)?;
            let second = Instant::now();
            without.step();
            for (sum, part) in spent.iter_mut().zip([first - start, second - first, second.elapsed()]) {
                *sum += part;
            }
        }
        for (all, part) in [&mut coupled, &mut own, &mut rapier].into_iter().zip(spent) {
            all.push(part.as_secs_f64() / 20.0 * 1e6);
        }
    }
    let median = |values: &mut Vec<f64>| {
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let [coupled, own, rapier] = [&mut coupled, &mut own, &mut rapier].map(median);
    println!("a step of both: {coupled:.0} us; his own scene {own:.0} us, the world without him {rapier:.0} us");
    println!(
        "ratio {:.2}, with {} bodies near him and {FAR} elsewhere",
        coupled / (own + rapier),
        infant.coupling().neighbors().count()
    );
    Ok(())
}

fn main() -> Result<(), Error> {
    play()?;
    compare()
}

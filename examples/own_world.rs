//! Adds MIMo to a Rapier world and solves him with Rapier's pipeline, for comparison: `examples/rapier_world.rs` keeps this library's
//! engine. A ball falls on MIMo.
//!
//! ```sh
//! cargo run --release --features rapier --example own_world
//! ```

use std::sync::Arc;

use babybench::Config;
use babybench::config::{Behavior, Scene};
use babybench::mimo::{build_model, embedded};
use babybench::rapier::rapier3d_f64::prelude::*; // the version of Rapier that the library is built with
use babybench::rapier::{Bridge, RapierOptions, RapierSets};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let config = Config {
        behavior: Behavior::None,
        scene: Scene::Base,
        ..Config::default()
    };
    let model = Arc::new(build_model(&config, &embedded())?);

    // the world, with MIMo in it
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, 0.0, -9.81);
    let mut bridge = Bridge::insert(
        model.clone(),
        RapierOptions::default(),
        &mut RapierSets::from(&mut world),
    )?;
    let mut state = bridge.new_state();
    bridge.configure(&mut world);

    // a ball above MIMo's trunk
    let above = state.qpos[..3].to_vec();
    let (ball, collider) = world.insert(
        RigidBodyBuilder::dynamic().translation(Vector::new(above[0], above[1], above[2] + 0.8)),
        ColliderBuilder::ball(0.05).density(500.0),
    );

    let mut hits = 0;
    for step in 0..400 {
        // advances the world and takes MIMo's state out of it, for the senses to read
        bridge.step(&mut state, &mut world, &())?;

        let touched: Vec<&str> = world
            .narrow_phase
            .contact_pairs_with(collider)
            .filter(|pair| pair.has_any_active_contact())
            .filter_map(|pair| {
                let other = if pair.collider1 == collider {
                    pair.collider2
                } else {
                    pair.collider1
                };
                let body = model.geom_bodyid[bridge.rig().geom_of(other)?];
                Some(model.body_name[body].as_str())
            })
            .collect();
        hits += usize::from(!touched.is_empty());
        if step % 40 == 0 {
            println!(
                "{:.2} s: ball at {:.3} m, hip at {:.3} m, the ball touches {touched:?}",
                state.time,
                world.bodies[ball].translation().z,
                model.body("hip").map_or(0.0, |b| state.xpos[b][2]),
            );
        }
    }
    println!("the ball touched something of the model in {hits} of 400 steps");
    Ok(())
}

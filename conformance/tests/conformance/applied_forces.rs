//! Forces on bodies, beside MuJoCo 3.3.0's `mj_applyFT` and `xfrc_applied`.

use babybench::Model;
use babybench::physics::State;
use conformance::live::{Case, Drive, Motion};
use conformance::measure::{only_print, relative};
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: forces_at_points_are_mujocos]
}

/// Steps of each scene.
const STEPS: usize = if cfg!(debug_assertions) { 10 } else { 100 };

/// Draws a force, a torque and a point near a body that moves.
fn draw(drive: &mut Drive, model: &Model, s: &State) -> (usize, [[f64; 3]; 3]) {
    let moving: Vec<usize> = (1..model.nbody()).filter(|&b| model.body_weldid[b] != 0).collect();
    let rng = drive.rng();
    let body = moving[rng.usize(..moving.len())];
    let mut triple = |size: f64| [0; 3].map(|_| size * (2.0 * rng.f64() - 1.0));
    let (force, torque, arm) = (triple(5.0), triple(0.2), triple(0.1));
    let point = [0, 1, 2].map(|k| s.xpos[body][k] + arm[k]);
    (body, [force, torque, point])
}

/// The worst over the six models, when written: what a force does to the joints, and the accelerations and sensors that follow.
fn forces_at_points_are_mujocos() {
    let api = needed();
    let mut worst = [0.0_f64; 3];
    for case in Case::all() {
        let mut simulation = case.simulation(api).expect("MuJoCo loads our scenes");
        let mut engine = case.soft();
        let mut s = engine.new_state();
        let mut drive = Drive::new(&case.model, Motion::Random, 7);
        for k in 0..STEPS {
            s.release_forces();
            drive.set(k, &mut s.ctrl);
            engine.forward(&mut s).expect("no divergence");
            let free = s.qfrc_smooth.clone();
            let (body, [force, torque, point]) = draw(&mut drive, &case.model, &s);
            s.apply_force(body, force, torque, point)
                .expect("a body and finite numbers");
            simulation.set_state(&case.model, &s);
            simulation.forward();
            engine.forward(&mut s).expect("no divergence");
            let ours: Vec<f64> = s
                .qfrc_smooth
                .iter()
                .zip(&free)
                .map(|(with, without)| with - without)
                .collect();
            let theirs = simulation.apply_ft(body, force, torque, point);
            let errors = [
                relative(&ours, &theirs),
                relative(&s.qacc, simulation.qacc()),
                relative(&s.sensordata, simulation.sensordata()),
            ];
            worst = std::array::from_fn(|i| worst[i].max(errors[i]));
            engine.step(&mut s).expect("no divergence");
        }
    }
    show!("qfrc {:.1e}, qacc {:.1e}, sensors {:.1e}", worst[0], worst[1], worst[2]);
    let good = worst
        .iter()
        .zip([1e-10, 1e-4, 1e-4])
        .all(|(error, limit)| *error <= limit);
    assert!(only_print() || good, "{worst:?}");
}

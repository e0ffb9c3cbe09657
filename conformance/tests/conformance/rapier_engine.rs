//! Distance of the `rapier` engine to recordings of MuJoCo 3.3.0, beside that of the `soft` engine, and its cost.
//!
//! Assertions are generous: both engines simulate the same thing. The figures are printed.

use std::time::Instant;

use babybench::config::EngineKind;
use conformance::measure::only_print;
use conformance::recordings::{Golden, golden};
use conformance::replays::{one_step, open_loop};
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![one_step_from_every_recorded_state, open_loop_stays_near_the_recording]
}

/// The recordings with torque motors, for an engine.
fn recordings(engine: EngineKind) -> Vec<Golden> {
    let mut all = golden("spring_damper");
    all.iter_mut().for_each(|g| g.config.engine = engine);
    all
}

/// Velocities after one step were off by 3 to 60 % of their largest change (median) when written.
fn one_step_from_every_recorded_state() {
    for (g, soft) in recordings(EngineKind::Rapier).iter().zip(recordings(EngineKind::Soft)) {
        let (step, reference) = (one_step(g), one_step(&soft));
        show!("{:24} rapier qvel {}   qacc {}", g.name, step.qvel, step.qacc);
        show!("{:24} soft   qvel {}   qacc {}", "", reference.qvel, reference.qacc);
        for (part, s) in &step.outputs {
            show!("    {part:10} {s}");
        }
        let contacts = step.contacts.expect("the contacts of the recording");
        show!("    contact forces {}", contacts.force);
        if !only_print() {
            let angles = step.outputs.iter().find(|o| o.0 == "angles").expect("recorded").1;
            assert!(angles.p50 < 0.01 && angles.p90 < 0.1, "{}: angles {angles}", g.name);
            assert!(contacts.force.p50 < 0.7, "{}: forces {}", g.name, contacts.force);
            for (what, error) in step.controls {
                assert!(error == 0.0, "{}: {what} {error:e}", g.name);
            }
        }
    }
}

/// After 100 steps joints were 0.007 to 0.2 rad (rms) away when written.
fn open_loop_stays_near_the_recording() {
    for (g, soft) in recordings(EngineKind::Rapier).iter().zip(recordings(EngineKind::Soft)) {
        let time = |g: &Golden| {
            let start = Instant::now();
            let rms = open_loop(g);
            (rms, start.elapsed().as_secs_f64())
        };
        let ((rms, took), (reference, soft_took)) = (time(g), time(&soft));
        let mut line = format!("{:24}", g.name);
        for k in [1, 10, 30, 100, 200, 400].map(|k: usize| k.min(rms.len())) {
            line += &format!("  {k}: {:.1e} ({:.1e})", rms[k - 1], reference[k - 1]);
        }
        show!("{line}  time {:.1} x soft", took / soft_took);
        if let (Some(rms), false) = (rms.get(99.min(rms.len() - 1)), only_print()) {
            assert!(*rms < 0.4, "{}: {rms:e} rad after 100 steps", g.name);
        }
    }
}

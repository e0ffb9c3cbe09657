//! Replays of the reference's recordings with torque motors, one step at a time and open loop.

use conformance::measure::only_print;
use conformance::recordings::golden;
use conformance::replays::{one_step, open_loop};

#[test]
fn one_step_from_every_recorded_state() {
    for g in golden("spring_damper") {
        let step = one_step(&g);
        let (name, qvel) = (&g.name, step.qvel);
        println!("{name:24} qvel {qvel}   qacc {}", step.qacc);
        for (what, error) in step.controls {
            assert!(error <= 1e-9, "{name}: {what} {error:e}");
        }
        let contacts = step.contacts.expect("the same contacts as recorded");
        println!(
            "    {} contacts, {} distances bit-identical; positions within {:.1e}, frames within {:.1e}",
            contacts.number, contacts.identical, contacts.pos, contacts.frame
        );
        println!("    contact forces {}", contacts.force);
        for (part, s) in &step.outputs {
            println!("    {part:10} {s}");
        }
        if only_print() {
            continue;
        }
        assert!(
            qvel.p50 <= 1e-8 && qvel.p90 <= 1e-6 && qvel.max <= 1e-2,
            "{name}: qvel {qvel}"
        );
        for (part, s) in step.outputs {
            assert!(s.p90 <= 1e-5, "{name}: {part} {s}");
        }
    }
}

#[test]
fn open_loop_stays_near_the_recording() {
    for g in golden("spring_damper") {
        let rms = open_loop(&g);
        let floor = g.floor.as_ref().expect("recorded floor");
        let mut line = format!("{:24}", g.name);
        for k in [1, 10, 30, 100, 200, 300, 400].map(|k: usize| k.min(rms.len())) {
            line += &format!("  {k}: {:.1e} ({:.1e})", rms[k - 1], floor[k - 1]);
        }
        println!("{line}");
        if let (Some(rms), Some(floor), false) = (rms.get(99), floor.get(99), only_print()) {
            assert!(
                *rms <= 10.0 * floor,
                "{}: {rms:e} rad after 100 steps, floor {floor:e}",
                g.name
            );
        }
    }
}

//! Replays of the reference's recordings of every actuation model, one step at a time and open loop.

use babybench::config::ActuationModel;
use conformance::measure::only_print;
use conformance::recordings::{Golden, golden};
use conformance::replays::{one_step, open_loop};
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![one_step_from_every_recorded_state, open_loop_stays_near_the_recording]
}

fn recordings() -> impl Iterator<Item = Golden> {
    ActuationModel::NAMES.iter().flat_map(|model| golden(model))
}

/// Over all recordings the worst were, when written: qvel 1.3e-11 (median), 9.5e-9 (90 %), 1.0e-7; qacc 4.7e-10 (90 %), 2.0e-8;
/// contact forces 2.3e-10 (90 %), 5.3e-8; parts of the observation 4.8e-10 (90 %), 1.1e-8; places of contacts 8.6e-10 m,
/// their frames 3.1e-8 (both one contact of a muscle recording, all others 3.9e-16 and 4.5e-12); controls and gears 0.
fn one_step_from_every_recorded_state() {
    let mut missed = Vec::new();
    for g in recordings() {
        let step = one_step(&g);
        let (name, qvel, qacc) = (&g.name, step.qvel, step.qacc);
        show!("{name:24} qvel {qvel}   qacc {qacc}");
        let Some(contacts) = step.contacts else {
            missed.push(format!("{name}: other contacts than recorded"));
            continue;
        };
        show!(
            "    {} contacts, {} distances bit-identical; positions within {:.1e}, frames within {:.1e}",
            contacts.number,
            contacts.identical,
            contacts.pos,
            contacts.frame
        );
        show!("    contact forces {}", contacts.force);
        let mut figures = vec![
            ("median of qvel", qvel.p50, 1e-10),
            ("90th percentile of qvel", qvel.p90, 9e-8),
            ("maximum of qvel", qvel.max, 1e-6),
            ("90th percentile of qacc", qacc.p90, 4e-9),
            ("maximum of qacc", qacc.max, 2e-7),
            ("90th percentile of contact forces", contacts.force.p90, 2e-9),
            ("maximum of contact forces", contacts.force.max, 5e-7),
            ("places of contacts", contacts.pos, 8e-9),
            ("frames of contacts", contacts.frame, 3e-7),
        ];
        figures.extend(step.controls.map(|(what, error)| (what, error, 0.0)));
        for (part, s) in step.outputs {
            show!("    {part:10} {s}");
            figures.extend([(part, s.p90, 4e-9), (part, s.max, 1e-7)]);
        }
        let over = figures.iter().filter(|(_, value, limit)| value > limit);
        missed.extend(over.map(|(what, value, limit)| format!("{name}: {what} {value:e} > {limit:e}")));
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

/// Up to step 100 the worst was 1.9 floors when written: torque motors among the cubes, where contacts are many.
fn open_loop_stays_near_the_recording() {
    for g in recordings() {
        let rms = open_loop(&g);
        let floor = &g.floor;
        let length = rms.len().min(floor.len());
        let mut line = format!("{:24}", g.name);
        for k in [1, 10, 30, 100, 200, 300, 400].into_iter().filter(|&k| k <= length) {
            let (ours, floor) = (rms[k - 1], floor[k - 1]);
            line += &format!("  {k}: {ours:.1e} ({floor:.1e})");
            assert!(
                only_print() || k > 100 || ours <= 5.0 * floor,
                "{}: {ours:e} rad after {k} steps, floor {floor:e}",
                g.name
            );
        }
        show!("{line}");
    }
}

//! 1000 steps of motion without contacts, with the scene's constraints (`cf`) and with every third joint locked (`cfl`),
//! against MuJoCo 3.3.0 for all six models.

use conformance::measure::only_print;
use conformance::motion::contact_free;
use conformance::reference::Reference;
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![joints_stay_within_three_picoradians_of_mujoco]
}

/// The worst was 3.0e-13 rad when written.
fn joints_stay_within_three_picoradians_of_mujoco() {
    for reference in Reference::all() {
        for run in ["cf", "cfl"] {
            show!(
                "{} {run}: largest error of joints (rad), of MIMo's place, of objects, of velocities",
                reference.name
            );
            for drift in contact_free(&reference, run) {
                let joints = drift.summary().max;
                let (step, root, objects, qvel) = (drift.step, drift.root, drift.objects, drift.qvel);
                show!("    {step:4} steps  {joints:8.1e} {root:8.1e} {objects:8.1e} {qvel:8.1e}");
                assert!(
                    only_print() || joints <= 3e-12,
                    "{} {run} step {step}: {joints:e} rad",
                    reference.name
                );
            }
        }
    }
}

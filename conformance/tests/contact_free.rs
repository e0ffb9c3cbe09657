//! 1000 steps of motion without contacts, with the scene's constraints (`cf`) and with every third joint locked (`cfl`),
//! against MuJoCo 3.3.0 for all six models.

use conformance::measure::only_print;
use conformance::motion::contact_free;
use conformance::reference::Reference;

/// The worst was 3.0e-13 rad when written.
#[test]
fn joints_stay_within_ten_picoradians_of_mujoco() {
    for reference in Reference::all() {
        for run in ["cf", "cfl"] {
            println!(
                "{} {run}: largest error of joints (rad), of MIMo's place, of objects, of velocities",
                reference.name
            );
            for drift in contact_free(&reference, run) {
                let joints = drift.summary().max;
                let (step, root, objects, qvel) = (drift.step, drift.root, drift.objects, drift.qvel);
                println!("    {step:4} steps  {joints:8.1e} {root:8.1e} {objects:8.1e} {qvel:8.1e}");
                assert!(
                    only_print() || joints <= 1e-11,
                    "{} {run} step {step}: {joints:e} rad",
                    reference.name
                );
            }
        }
    }
}

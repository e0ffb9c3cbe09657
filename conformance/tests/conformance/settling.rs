//! 100 steps from the initial pose with contacts, against MuJoCo 3.3.0 and against the reference's environments; and the
//! first steps of episodes.

use babybench::config::Scene;
use conformance::example_runs::{Moment, example_runs};
use conformance::measure::{line, only_print};
use conformance::motion::{Drift, settling};
use conformance::reference::Reference;
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        models_settle_as_in_mujoco,
        example_configurations_settle_as_in_the_reference,
        example_episodes_start_as_in_the_reference
    ]
}

fn print(name: &str, d: &Drift) {
    let (step, joints) = (d.step, d.summary());
    show!(
        "{name:30} {step:4} steps  joints {joints}  place {:.1e}  objects {:.1e}  qvel {:.1e}",
        d.root,
        d.objects,
        d.qvel
    );
}

/// The worst were 4.3e-10 rad in base and crib, 1.6e-9 rad in cubes when written.
fn models_settle_as_in_mujoco() {
    for reference in Reference::all() {
        for drift in settling(&reference) {
            print(&reference.name, &drift);
            let joints = drift.summary().max;
            let limit = if reference.scene == Scene::Cubes { 1.5e-8 } else { 4e-9 };
            assert!(only_print() || joints <= limit, "{}: {joints:e} rad", reference.name);
        }
    }
}

/// The worst were 1.1e-9 rad in base and crib, 6.2e-7 rad in cubes when written, where MIMo's legs start deep in
/// the floor and leave it through more than a hundred contacts.
fn example_configurations_settle_as_in_the_reference() {
    for run in example_runs() {
        let drift = run.settled(&run.blueprint());
        print(&run.name, &drift);
        let joints = drift.summary().max;
        let limit = if run.config.scene == Scene::Cubes { 6e-6 } else { 1e-8 };
        assert!(only_print() || joints <= limit, "{}: {joints:e} rad", run.name);
    }
}

/// The worst up to k = 4 were 2.9e-10 rad, 5.5e-9 for velocities and 1.9e-9 for outputs when written.
fn example_episodes_start_as_in_the_reference() {
    for run in example_runs() {
        for moment in run.run(&run.blueprint()) {
            print(&run.name, &moment.drift);
            let Moment {
                k,
                drift,
                outputs,
                counts,
            } = &moment;
            show!("    k {k:?}  {}  contacts, rows {counts:?}", line(outputs));
            if only_print() || *k == Some(19) {
                continue;
            }
            let joints = drift.summary().max;
            assert!(joints <= 2.5e-9, "{} k {k:?}: {joints:e} rad", run.name);
            assert!(drift.qvel <= 5e-8, "{} k {k:?}: velocities {:e}", run.name, drift.qvel);
            for (name, error) in outputs {
                assert!(*error <= 1.5e-8, "{} k {k:?}: {name} {error:e}", run.name);
            }
            assert!(counts.iter().all(|c| c.0 == c.1), "{} k {k:?}: {counts:?}", run.name);
        }
    }
}

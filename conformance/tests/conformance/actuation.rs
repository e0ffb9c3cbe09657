//! Actuation models against the reference: life cycle, parameters of muscles. `replay.rs` has their steps.

use babybench::actuation::{Actuation, MuscleModel, MuscleParams};
use babybench::config::{ActuationModel, Behavior, Compat, Config, Scene};
use babybench::mimo::{Version, build_model, embedded};
use conformance::data;
use conformance::example_runs::{example_runs, numbers};
use conformance::measure::{max_abs, only_print, relative};
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![resets_are_those_of_the_reference, parameters_of_all_muscles]
}

/// Whole resets with seed 0 of the action space, from our own settled state: start actions, controls, observation. The worst
/// were 5e-15 for controls and, for observations and positions, 1.4e-8 on the floor and in the crib and 1.6e-6 among the cubes
/// when written.
fn resets_are_those_of_the_reference() {
    for run in example_runs() {
        let after = run.after_reset();
        let mut env = run.blueprint().env().expect("the environment builds");
        env.by_hand().seed_action_space(0);
        env.reset(None).expect("no divergence");
        let ctrl = max_abs(&env.state().ctrl, &numbers(&after["ctrl"]));
        let observation = relative(env.observation().proprioception, &numbers(&after["obs"]));
        let qpos = max_abs(&env.state().qpos, &numbers(&after["qpos"]));
        let time = (env.state().time - after["time"].as_f64().expect("a number")).abs();
        show!(
            "{:30} ctrl {ctrl:.1e}  observation {observation:.1e}  qpos {qpos:.1e}  time {time:.1e}",
            run.name
        );
        if only_print() {
            continue;
        }
        assert!(
            ctrl <= 5e-14 && time <= 1e-14,
            "{}: ctrl {ctrl:e}, time {time:e}",
            run.name
        );
        // resting cubes magnify the last bits
        let limit = if run.config.scene == Scene::Cubes { 1.5e-5 } else { 1e-7 };
        assert!(
            observation <= limit && qpos <= limit,
            "{}: {observation:e} {qpos:e}",
            run.name
        );
    }
}

fn parameters_of_all_muscles() {
    for behavior in [Behavior::None, Behavior::HandRegard] {
        let config = Config {
            behavior,
            actuation_model: ActuationModel::Muscle,
            ..Config::default()
        };
        let model = build_model(&config, &embedded()).expect("the embedded assets load");
        let muscles = MuscleModel::new(&model, Compat::Reference).expect("legal muscles");
        let version = Version::of(behavior).name();
        let table = data::text(&format!("muscles/{version}_muscle_params.tsv"));
        let rows: Vec<Vec<&str>> = table.lines().skip(1).map(|l| l.split('\t').collect()).collect();
        assert_eq!((rows.len(), muscles.params().len()), (model.nu(), model.nu()));
        let mut worst = 0.0_f64;
        for (i, (row, p)) in rows.iter().zip(muscles.params()).enumerate() {
            assert_eq!(row[1], model.actuator_name[i]);
            let MuscleParams {
                moment,
                lce_ref,
                vmax,
                fmax,
                ..
            } = *p;
            let ours = [moment[0], lce_ref[0], lce_ref[1], vmax, fmax[0], fmax[1]];
            let theirs: Vec<f64> = row[5..11].iter().map(|v| v.parse().expect("a number")).collect();
            worst = worst.max(max_abs(&ours, &theirs));
        }
        show!("{version}: {} actuators, within {worst:.1e}", rows.len());
        assert!(only_print() || worst <= 1e-11, "{version}: {worst:e}");
        assert_eq!(muscles.action_space().len(), 2 * model.nu());
    }
}

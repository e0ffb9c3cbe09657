//! Muscles and position servos against the reference: replays, life cycle, parameters.

use std::fs::read_to_string;

use babybench::actuation::{Actuation, Muscle, MuscleParams};
use babybench::config::{ActuationModel, Behavior, Compat, Config};
use babybench::mimo::{Version, build_model, embedded};
use conformance::example_runs::example_runs;
use conformance::measure::{max_abs, only_print, relative};
use conformance::recordings::{golden, shared};
use conformance::replays::{one_step, open_loop};
use serde_json::Value;

const MODELS: [&str; 2] = ["muscle", "positional"];

#[test]
fn one_step_from_every_recorded_state() {
    for g in MODELS.iter().flat_map(|m| golden(m)) {
        let step = one_step(&g);
        let (name, qvel) = (&g.name, step.qvel);
        println!("{name:24} qvel {qvel}   qacc {}", step.qacc);
        for (what, error) in step.controls {
            println!("    {what:10} within {error:.1e}");
            assert!(only_print() || error <= 1e-9, "{name}: {what} {error:e}");
        }
        match &step.contacts {
            Some(c) => println!(
                "    {} contacts, {} bit-identical, forces {}",
                c.number, c.identical, c.force
            ),
            None => println!("    the contacts are not those recorded"),
        }
        for (part, s) in &step.outputs {
            println!("    {part:10} {s}");
        }
        if only_print() {
            continue;
        }
        assert!(step.contacts.is_some(), "{name}: contacts");
        assert!(qvel.p50 <= 1e-8 && qvel.p90 <= 1e-6, "{name}: qvel {qvel}");
        for (part, s) in step.outputs {
            assert!(s.p90 <= 1e-5, "{name}: {part} {s}");
        }
    }
}

#[test]
fn open_loop_stays_near_the_recording() {
    for g in MODELS.iter().flat_map(|m| golden(m)) {
        let rms = open_loop(&g);
        let floor = g.floor.as_ref().expect("recorded floor");
        let at = |k: usize| (rms[k.min(rms.len()) - 1], floor[k.min(floor.len()) - 1]);
        let figures: String = [1, 10, 30, 100, 200, 300, 400]
            .map(|k| format!("  {k}: {:.1e} ({:.1e})", at(k).0, at(k).1))
            .concat();
        println!("{:24}{figures}", g.name);
        let (ours, floor) = at(100);
        assert!(
            only_print() || ours <= 10.0 * floor,
            "{}: {ours:e} rad, floor {floor:e}",
            g.name
        );
    }
}

/// Whole resets with seed 0 of the action space, from our own settled state: start actions, controls, observation.
#[test]
fn resets_are_those_of_the_reference() {
    let Some(dir) = shared().map(|d| d.join("reference/mimo_tables")) else {
        eprintln!("SKIPPED resets: no directory ../shared beside the repository");
        return;
    };
    for run in example_runs() {
        let text = read_to_string(dir.join(format!("golden_{}.json", run.name))).expect("readable run");
        let json: Value = serde_json::from_str(&text).expect("valid JSON");
        let numbers = |v: &Value| -> Vec<f64> {
            v.as_array()
                .expect("a list")
                .iter()
                .map(|x| x.as_f64().expect("a number"))
                .collect()
        };
        let after = &json["after_reset"];
        let mut env = run.blueprint().env().expect("the environment builds");
        env.seed_action_space(0);
        env.reset(None).expect("no divergence");
        let ctrl = max_abs(&env.state().ctrl, &numbers(&after["ctrl"]));
        let observation = relative(env.observation().observation, &numbers(&after["obs"]));
        let qpos = max_abs(&env.state().qpos, &numbers(&after["qpos"]));
        let time = (env.state().time - after["time"].as_f64().expect("a number")).abs();
        println!(
            "{:30} ctrl {ctrl:.1e}  observation {observation:.1e}  qpos {qpos:.1e}",
            run.name
        );
        if only_print() {
            continue;
        }
        assert!(
            ctrl <= 1e-9 && time <= 1e-12,
            "{}: ctrl {ctrl:e}, time {time:e}",
            run.name
        );
        assert!(
            observation <= 1e-4 && qpos <= 1e-4,
            "{}: {observation:e} {qpos:e}",
            run.name
        );
    }
}

#[test]
fn parameters_of_all_muscles() {
    let Some(dir) = shared().map(|d| d.join("reference/mimo_tables")) else {
        eprintln!("SKIPPED muscle parameters: no directory ../shared beside the repository");
        return;
    };
    for behavior in [Behavior::None, Behavior::HandRegard] {
        let config = Config {
            behavior,
            actuation_model: ActuationModel::Muscle,
            ..Config::default()
        };
        let model = build_model(&config, &embedded()).expect("the embedded assets load");
        let muscles = Muscle::new(&model, Compat::Reference).expect("legal muscles");
        let version = Version::of(behavior).name();
        let table = read_to_string(dir.join(format!("{version}_muscle_params.tsv"))).expect("readable table");
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
        println!("{version}: {} actuators, within {worst:.1e}", rows.len());
        assert!(only_print() || worst <= 1e-11, "{version}: {worst:e}");
        assert_eq!(muscles.action_space().len(), 2 * model.nu());
    }
}

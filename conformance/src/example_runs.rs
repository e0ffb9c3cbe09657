//! Short runs of the example configurations, in a directory `shared/reference` beside the repository: the settled state,
//! the state after a reset with listed start actions, and 20 steps with actions from a formula.

use std::fs::read_to_string;

use babybench::config::{ActuationModel, Compat, Config};
use babybench::{Blueprint, Env};
use serde_json::Value;

use crate::measure::relative;
use crate::motion::Drift;
use crate::recordings::{NO_SHARED, shared};
use crate::statics::sensors;

/// A recorded run.
pub struct ExampleRun {
    /// Configuration, scene and actuation model: `golden_NAME.json`.
    pub name: String,
    /// Its configuration, under `compat: reference`, without vision and touch.
    pub config: Config,
    json: Value,
}

/// Distance of a run to the recording at one moment.
pub struct Moment {
    /// Step of the formula; `None` is after the reset.
    pub k: Option<usize>,
    /// Positions and velocities.
    pub drift: Drift,
    /// Largest error of each kind of output, relative to its largest value.
    pub outputs: Vec<(&'static str, f64)>,
    /// Numbers of contacts and of constraint rows: ours, the recorded.
    pub counts: [(usize, usize); 2],
}

/// All runs. Says so when there are none.
pub fn example_runs() -> Vec<ExampleRun> {
    let Some(dir) = shared().map(|d| d.join("reference")) else {
        crate::skipped("example runs", NO_SHARED);
        return Vec::new();
    };
    let mut names: Vec<String> = std::fs::read_dir(dir.join("mimo_tables"))
        .into_iter()
        .flatten()
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter_map(|file| Some(file.strip_prefix("golden_")?.strip_suffix(".json")?.to_string()))
        .collect();
    names.sort();
    assert!(!names.is_empty(), "{} holds no run", dir.display());
    let mut runs = Vec::new();
    for name in names {
        let text = read_to_string(dir.join("mimo_tables").join(format!("golden_{name}.json"))).expect("readable run");
        let json: Value = serde_json::from_str(&text).expect("valid JSON");
        let word = |key: &str| json[key].as_str().expect("a name").to_string();
        let file = format!("config_{}.yml", word("config"));
        let text = read_to_string(dir.join("configs").join(&file)).expect("readable configuration");
        let base = Config {
            compat: Compat::Reference,
            ..Config::default()
        };
        let config = Config {
            vision_active: false,
            touch_active: false,
            actuation_model: ActuationModel::from_name(&word("actuation")).expect("an actuation model"),
            ..base.overlay_yaml(&text, &file).expect("valid configuration")
        };
        runs.push(ExampleRun { name, config, json });
    }
    runs
}

impl ExampleRun {
    /// What environments of the run share.
    pub fn blueprint(&self) -> Blueprint {
        Blueprint::new(self.config.clone()).expect("the environment builds")
    }

    /// Distance of the settled state.
    pub fn settled(&self, blueprint: &Blueprint) -> Drift {
        let (qpos, qvel) = (numbers(&self.json["init_qpos"]), numbers(&self.json["init_qvel"]));
        Drift::new(
            blueprint.model(),
            100,
            (blueprint.init_qpos(), blueprint.init_qvel()),
            (&qpos, &qvel),
        )
    }

    /// Distances after the reset and at the recorded steps, from the recorded settled state and with the recorded start
    /// actions.
    pub fn run(&self, blueprint: &Blueprint) -> Vec<Moment> {
        let mut env = blueprint.env().expect("the environment builds");
        env.reset_to(&numbers(&self.json["init_qpos"]), &numbers(&self.json["init_qvel"]))
            .expect("a recorded state");
        for action in self.json["reset_actions"].as_array().expect("a list") {
            let action: Vec<f32> = numbers(action).iter().map(|&v| v as f32).collect();
            env.step(&action).expect("a recorded step");
        }
        let mut moments = vec![moment(&env, None, &self.json["after_reset"])];
        for k in 0..20 {
            let action = formula(&env, k);
            env.step(&action).expect("a recorded step");
            if let Some(step) = self.json["steps"]
                .as_array()
                .expect("a list")
                .iter()
                .find(|s| s["k"] == k)
            {
                let recorded = numbers(&step["action"]);
                let same = action
                    .iter()
                    .zip(&recorded)
                    .all(|(a, b)| (f64::from(*a) - b).abs() <= 1e-7);
                assert!(same, "{}: the formula gives another action {k}", self.name);
                moments.push(moment(&env, Some(k), step));
            }
        }
        moments
    }
}

/// The action of step `k`.
fn formula(env: &Env, k: usize) -> Vec<f32> {
    let space = env.action_space();
    let bounds = space.low().iter().zip(space.high()).enumerate();
    bounds
        .map(|(i, (&low, &high))| {
            let (low, high) = (f64::from(low), f64::from(high));
            (low + (high - low) * (0.5 + 0.5 * (0.3 * k as f64 + 0.7 * i as f64).sin())) as f32
        })
        .collect()
}

fn numbers(json: &Value) -> Vec<f64> {
    json.as_array()
        .expect("a list")
        .iter()
        .map(|v| v.as_f64().expect("a number"))
        .collect()
}

fn moment(env: &Env, k: Option<usize>, recorded: &Value) -> Moment {
    let (model, s, observation) = (env.model(), env.state(), env.observation());
    let (qpos, qvel) = (numbers(&recorded["qpos"]), numbers(&recorded["qvel"]));
    let mut outputs = vec![
        (
            "observation",
            relative(observation.observation, &numbers(&recorded["obs"])),
        ),
        (
            "sensordata",
            relative(&sensors(model, s), &numbers(&recorded["sensordata"])),
        ),
    ];
    if let Some(vestibular) = observation.vestibular {
        outputs.push(("vestibular", relative(vestibular, &numbers(&recorded["vestibular"]))));
    }
    let count = |key: &str| recorded[key].as_u64().expect("a number") as usize;
    Moment {
        k,
        drift: Drift::new(model, k.map_or(0, |k| k + 1), (&s.qpos, &s.qvel), (&qpos, &qvel)),
        outputs,
        counts: [(s.contacts.len(), count("ncon")), (s.efc.nefc(), count("nefc"))],
    }
}

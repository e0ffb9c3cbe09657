//! Short runs of the example configurations, in `data/example_runs`: the settled state, the state after a reset with
//! listed start actions, and 20 steps with actions from a formula.

use babybench::config::{ActuationModel, Compat, Config};
use babybench::{Blueprint, Env};
use serde_json::Value;
use testkit::yardsticks::workspace;

use crate::data;
use crate::measure::relative;
use crate::motion::Drift;

/// A recorded run.
pub struct ExampleRun {
    /// Configuration, scene and actuation model.
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

/// Reads all runs.
pub fn example_runs() -> Vec<ExampleRun> {
    data::names("example_runs", ".json.gz")
        .into_iter()
        .map(ExampleRun::read)
        .collect()
}

impl ExampleRun {
    fn read(name: String) -> Self {
        let json = data::json(&format!("example_runs/{name}.json.gz"));
        let word = |key: &str| json[key].as_str().expect("a name").to_string();
        let file = format!("config_{}.yml", word("config"));
        let text = std::fs::read_to_string(workspace().join("configs").join(&file)).expect("an example configuration");
        let config = Config {
            compat: Compat::Reference,
            vision_active: false,
            touch_active: false,
            actuation_model: ActuationModel::from_name(&word("actuation")).expect("an actuation model"),
            ..Config::from_yaml(&text, &file).expect("a valid configuration")
        };
        Self { name, config, json }
    }

    /// Returns what was recorded after the reset.
    pub fn after_reset(&self) -> &Value {
        &self.json["after_reset"]
    }

    /// Builds the blueprint that environments of the run share.
    pub fn blueprint(&self) -> Blueprint {
        Blueprint::new(self.config.clone()).expect("the environment builds")
    }

    /// Measures how far our settled state is from the recorded one.
    pub fn settled(&self, blueprint: &Blueprint) -> Drift {
        let (qpos, qvel) = (numbers(&self.json["init_qpos"]), numbers(&self.json["init_qvel"]));
        Drift::new(
            blueprint.model(),
            100,
            (blueprint.init_qpos(), blueprint.init_qvel()),
            (&qpos, &qvel),
        )
    }

    /// Measures distances after the reset and at the recorded steps.
    ///
    /// The run starts at the recorded settled state, with the recorded start actions.
    pub fn run(&self, blueprint: &Blueprint) -> Vec<Moment> {
        let mut env = blueprint.env().expect("the environment builds");
        env.by_hand()
            .reset_to(&numbers(&self.json["init_qpos"]), &numbers(&self.json["init_qvel"]))
            .expect("a recorded state");
        for action in self.json["reset_actions"].as_array().expect("a list") {
            let action: Vec<f32> = numbers(action).iter().map(|&v| v as f32).collect();
            env.step(&action).expect("a recorded step");
        }
        let mut moments = vec![moment(&env, None, self.after_reset())];
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

/// Computes the action of step `k`.
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

/// Returns a list of numbers.
pub fn numbers(json: &Value) -> Vec<f64> {
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
            relative(observation.proprioception, &numbers(&recorded["obs"])),
        ),
        ("sensordata", relative(&s.sensordata, &numbers(&recorded["sensordata"]))),
    ];
    if let Some(vestibular) = observation.vestibular {
        outputs.push(("vestibular", relative(vestibular, &numbers(&recorded["vestibular"]))));
    }
    let count = |key: &str| recorded[key].as_u64().expect("a number") as usize;
    Moment {
        k,
        drift: Drift::new(model, k.map_or(0, |k| k + 1), (&s.qpos, &s.qvel), (&qpos, &qvel)),
        outputs,
        counts: [(s.contact.len(), count("ncon")), (s.nefc(), count("nefc"))],
    }
}

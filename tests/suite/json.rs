//! Every byte of JSON that the program writes is JSON.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use crate::common::*;
use babybench::config::{Behavior, Compat, Scene};
use babybench::env::{
    BehaviorInfo, EYE_HAND_PAIRS, Info, InfoDetails, InfoWithDetails, PerEyeAndHand, PerHand, SnapshotInfo,
};
use babybench::eval::{Plan, Score, ScoreParts, TouchableGeoms, run_episodes};
use babybench::policy::PolicySource;
use babybench::runs::{Recording, replay};
use babybench::spaces::NumpyRng;
use babybench::{Blueprint, Config, Env, make_env};
use serde_json::Value;

/// Text that is hard to write: combining characters, quotes, control characters, what ends lines in other languages.
const HARD: [&str; 12] = [
    "e\u{301}",
    "\"",
    "\\",
    "\n",
    "\u{0}",
    "\u{7f}",
    "\u{1b}[31m",
    "\u{2028}",
    "\u{200d}",
    "\u{feff}",
    "\u{1f476}",
    "plain",
];
/// Numbers that are hard to write.
const NUMBERS: [f64; 9] = [
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    -0.0,
    5e-324,
    f64::MAX,
    1e16,
    1e-7,
    0.1 + 0.2,
];

struct Source(NumpyRng);

impl Source {
    fn below(&mut self, n: usize) -> usize {
        (self.0.uniform() * n as f64) as usize
    }

    fn whole(&mut self) -> u64 {
        let bits = 64.0 * self.0.uniform();
        (self.0.uniform() * bits.exp2()) as u64
    }

    fn text(&mut self) -> String {
        (0..self.below(5)).map(|_| HARD[self.below(HARD.len())]).collect()
    }

    fn number(&mut self) -> f64 {
        match self.below(3) {
            0 => f64::from_bits((self.0.uniform() * u64::MAX as f64) as u64),
            _ => NUMBERS[self.below(NUMBERS.len())],
        }
    }

    fn list<T>(&mut self, mut item: impl FnMut(&mut Self) -> T) -> Vec<T> {
        (0..self.below(4)).map(|_| item(self)).collect()
    }

    fn info(&mut self) -> Info {
        let behavior = match self.below(3) {
            0 => BehaviorInfo::None,
            1 => BehaviorInfo::SelfTouch {
                touches: PerHand::from_fn(|_| self.list(|s| s.below(1000))),
            },
            _ => BehaviorInfo::HandRegard {
                counts: PerEyeAndHand::from_fn(|_, _| self.whole()),
            },
        };
        let touched_parts = PerHand::from_fn(|_| self.list(|s| Arc::<str>::from(s.text())));
        let gaze_angles = PerEyeAndHand::from_fn(|_, _| self.number());
        Info {
            steps: self.whole(),
            behavior,
            details: InfoDetails {
                reflexes: None,
                touched_parts: (self.below(3) > 0).then_some(touched_parts),
                gaze_angles: (self.below(3) > 0).then_some(gaze_angles),
                age: (self.below(3) > 0).then(|| self.number()),
                vision_age: (self.below(3) > 0).then(|| self.number()),
                regards: None,
            },
        }
    }
}

fn json(text: &str) -> Value {
    assert!(!text.contains('\n'), "one line: {text}");
    serde_json::from_str(text).unwrap_or_else(|e| panic!("{e}: {text}"))
}

/// Whether a number was written to the bit, and one that is not finite as null.
fn same(written: &Value, number: f64) -> bool {
    if number.is_finite() {
        written.as_f64().is_some_and(|w| w.to_bits() == number.to_bits())
    } else {
        written.is_null()
    }
}

/// The keys of an object in the order in which they are written.
fn keys_in_order(line: &str, keys: &[&str]) {
    let places: Vec<_> = keys.iter().filter_map(|k| line.find(&format!("\"{k}\": "))).collect();
    assert!(places.is_sorted(), "{line}");
}

#[test]
fn information_is_json_whatever_it_holds() {
    let mut source = Source(NumpyRng::seed(11));
    for _ in 0..2000 {
        let info = source.info();
        let (plain, line) = (info.to_json(), info.to_detailed_json());
        let (plain, detailed) = (json(&plain), json(&line));
        assert_eq!(plain["steps"], info.steps);
        for read in [serde_json::from_value(plain.clone()), serde_json::from_str(&line)] {
            let Info { steps, behavior, .. } = read.expect("an Info; details are ignored");
            assert_eq!((steps, &behavior), (info.steps, &info.behavior));
        }
        for (key, value) in plain.as_object().expect("an object") {
            assert_eq!(&detailed[key], value);
        }
        if let Some(parts) = &info.details.touched_parts {
            for (key, names) in ["right_hand_parts", "left_hand_parts"]
                .into_iter()
                .zip(parts.each_ref())
            {
                let names: Vec<&str> = names.iter().map(|n| &**n).collect();
                assert_eq!(detailed[key], serde_json::json!(names));
            }
        }
        if let Some(angles) = info.details.gaze_angles {
            for (key, angle) in EYE_HAND_PAIRS.iter().zip(angles.to_array()) {
                assert!(same(&detailed["gaze_angles"][key], angle), "{angle}: {line}");
            }
        }
        keys_in_order(
            &line,
            &[
                "right_hand_touches",
                "left_hand_touches",
                "right_hand_parts",
                "left_hand_parts",
                "steps",
            ],
        );
        let only = serde_json::to_value(&info.details).expect("JSON");
        let beside = InfoWithDetails {
            info: &Info::default(),
            details: Some(&info.details),
        };
        let mut beside = serde_json::to_value(beside).expect("JSON");
        beside.as_object_mut().and_then(|o| o.remove("steps")).expect("steps");
        assert_eq!(only, beside);
    }
}

#[test]
fn scores_are_json_whatever_they_hold() {
    let mut source = Source(NumpyRng::seed(12));
    let hard = "t\u{301}&quot;\\\u{2028}\u{1f476}oes";
    let model = edited(&free(Behavior::SelfTouch, Scene::Base), |xml| xml.replace("toes", hard));
    assert!(model.body("left_t\u{301}\"\\\u{2028}\u{1f476}oes").is_some());
    let skin = TouchableGeoms::new(&model).expect("MIMo");
    for _ in 0..200 {
        let ngeom = model.ngeom();
        let parts = match source.below(2) {
            0 => ScoreParts::SelfTouch {
                touched: PerHand::from_fn(|_| source.list(|s| s.below(ngeom + 9))),
            },
            _ => ScoreParts::HandRegard {
                counts: PerEyeAndHand::from_fn(|_, _| source.whole()),
            },
        };
        let score = Score {
            value: source.number(),
            episodes: source.below(1000),
            steps: source.below(2) as u64 * source.whole(),
            parts_per_episode: (source.below(2) == 0).then(|| source.number()),
            parts,
        };
        let (line, plain) = (score.to_json(Some(&skin)), json(&score.to_json(None)));
        let named = json(&line);
        assert!(same(&named["score"], score.value), "{line}");
        match score.parts_per_episode {
            Some(number) => assert!(same(&named["parts_per_episode"], number), "{line}"),
            None => assert_eq!(named.get("parts_per_episode"), None),
        }
        assert_eq!(plain, serde_json::to_value(&score).expect("JSON"));
        keys_in_order(&line, &["behavior", "score", "episodes", "steps"]);
        match &score.parts {
            ScoreParts::SelfTouch { touched } => {
                for (hand, touched) in ["right_hand", "left_hand"].into_iter().zip(touched.each_ref()) {
                    let names: Vec<String> = touched.iter().map(|&g| skin.name(g).to_string()).collect();
                    assert_eq!(named[hand]["touched_names"], serde_json::json!(names));
                    assert_eq!(plain[hand]["touched"], serde_json::json!(touched));
                }
            }
            ScoreParts::HandRegard { counts } => {
                for (key, count) in EYE_HAND_PAIRS.iter().zip(counts.to_array()) {
                    assert_eq!(named[key]["steps"], count);
                    assert!(
                        same(&named[key]["fraction"], count as f64 / score.steps as f64),
                        "{line}"
                    );
                }
            }
        }
        let parts = serde_json::to_value(&score.parts).expect("JSON");
        assert_eq!(
            parts.as_object().map(serde_json::Map::len),
            Some(if plain["right_hand"].is_null() { 4 } else { 2 })
        );
    }
}

/// Reads every line of the `.jsonl` files in a folder.
fn lines(folder: &Path) -> Vec<Value> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.expect("an entry").path())
        .filter(|p| p.extension().is_some_and(|e| e == "jsonl"))
        .collect();
    files.sort();
    let texts = files.iter().map(|p| std::fs::read_to_string(p).expect("UTF-8"));
    texts.flat_map(|t| t.lines().map(json).collect::<Vec<_>>()).collect()
}

/// The messages that a policy gets in a run, as it writes them down.
#[cfg(unix)]
fn listening(folder: &Folder, actions: usize) -> String {
    let answer = vec!["0"; actions].join(",");
    let heard = folder.path().join("heard.jsonl");
    let body = format!("printf '%s\\n' \"$line\" >> {}; echo '[{answer}]'", heard.display());
    let path = folder.file("listen.sh", format!("while read -r line; do\n{body}\ndone\n"));
    format!("sh {}", path.display())
}

/// Trains, evaluates and replays in a folder, and reads every line of JSON that this leaves there.
#[cfg(unix)]
fn check_run(folder: &Folder, config: Config) {
    let mut env = make_env(config.clone(), true).expect("the folder can be made");
    for _ in 0..3 {
        env.reset(None).expect("no divergence");
        for _ in 0..4 {
            let action = vec![0.5; env.action_space().len()];
            env.step(&action).expect("no divergence");
        }
    }
    env.finish_training().expect("the log can be written");
    let blueprint = Blueprint::new(config).expect("a scene");
    let command = listening(folder, env.action_space().len());
    for policy in ["random", "zero", command.as_str()] {
        let plan = Plan {
            episodes: 2,
            duration: 4,
            render: false,
            fps: 60,
            jobs: 1,
        };
        let source = PolicySource::new(policy);
        let limit = Duration::from_secs(60);
        run_episodes(&blueprint, &plan, &|| source.open(limit), &|| ControlFlow::Continue(())).expect("episodes");
    }
    let logged = lines(&folder.path().join("logs"));
    assert_eq!(logged.len(), 2 * 4 + 3);
    assert!(logged.iter().all(|l| l["steps"].is_u64()));
    let mut env = blueprint.env().expect("an environment");
    check_heard(&lines(folder.path()), &mut env);

    let recording = Recording {
        qpos0: env.state().qpos.clone(),
        qvel0: env.state().qvel.clone(),
        activity0: Vec::new(),
        actions: vec![0.25; 3 * env.action_space().len()],
        len: 3,
        qpos: Vec::new(),
        qvel: Vec::new(),
        qacc: Vec::new(),
        activity: Vec::new(),
        episodes: Vec::new(),
    };
    let done = replay(&mut env, &recording, false).expect("a replay");
    let out = folder.path().join("replay");
    done.write(&out, &recording).expect("the files can be written");
    assert_eq!(lines(&out).len(), 3);
}

/// Compares what a policy was told with an environment.
#[cfg(unix)]
fn check_heard(heard: &[Value], env: &mut Env) {
    assert_eq!(heard.len(), 2 * 4);
    let seed = env.config().seed;
    env.reset(Some(seed)).expect("no divergence");
    let observation = heard[0]["observation"].as_array().expect("numbers");
    assert_eq!(observation.len(), env.observation().proprioception.len());
    for (written, &number) in observation.iter().zip(env.observation().proprioception) {
        assert!(same(written, number), "{written}, not {number}");
    }
    let active = [
        ("touch", env.config().touch_enabled()),
        ("eye_left", env.config().vision_active),
    ];
    for (key, active) in active {
        assert_eq!(!heard[0][key].is_null(), active, "{key}");
    }
}

#[cfg(unix)]
#[test]
fn every_line_of_a_run_is_json() {
    for (behavior, compat) in [
        (Behavior::SelfTouch, Compat::Api),
        (Behavior::HandRegard, Compat::Api),
        (Behavior::HandRegard, Compat::Reference),
        (Behavior::None, Compat::Api),
    ] {
        let folder = Folder::new(&format!("json_{behavior}_{compat}"));
        let config = Config {
            save_dir: folder.text(),
            compat,
            touch_active: behavior == Behavior::SelfTouch,
            touch_scale: 4.0,
            vision_active: behavior == Behavior::HandRegard,
            vision_resolution: 8,
            max_episode_steps: 4,
            ..free(behavior, Scene::Crib)
        };
        check_run(&folder, config);
    }
}

#[test]
fn snapshots_say_what_they_are() {
    let mut env = env(free(Behavior::SelfTouch, Scene::Base));
    env.reset(Some(5)).expect("no divergence");
    random_steps(&mut env, 3);
    let snapshot = env.snapshot();
    let info = snapshot.info();
    assert_eq!((info.steps, info.seed, info.ready), (3, 5, true));
    assert_eq!(info.bytes, snapshot.as_bytes().len() as u64);
    assert!(info.drawn > 0 && info.physics_steps >= 3 && info.version > 0);
    let text = serde_json::to_string(&info).expect("JSON");
    assert_eq!(serde_json::from_str::<SnapshotInfo>(&text).expect("the same"), info);
    let other = blueprint(free(Behavior::None, Scene::Base))
        .env()
        .expect("an environment")
        .snapshot()
        .info();
    assert_ne!(other.fingerprint, info.fingerprint);
    assert!(!other.ready);
}

//! Policies of evaluations: other programs, and ONNX models.

use std::ops::ControlFlow;
use std::time::Duration;

use crate::common::*;
use babybench::Blueprint;
use babybench::config::{Behavior, BodyParts, Config, Scene};
use babybench::env::Info;
use babybench::eval::{EpisodeError, Plan, run_episodes};
use babybench::policy::PolicySource;
use babybench::runs::EvaluationLog;
use babybench::runs::logs::evaluation_path;
use babybench::spaces::Noise;

/// Steps of an episode.
const DURATION: u64 = 6;

/// Six actions, and every sense small: 47 angles, 6 numbers of balance, eyes of 8 x 8 pixels.
fn small(folder: &Folder, vision: bool) -> Blueprint {
    let config = Config {
        save_dir: folder.text(),
        vision_active: vision,
        vision_resolution: 8,
        proprio_velocity: false,
        proprio_torque: false,
        proprio_limits: false,
        proprio_actuation: false,
        act: BodyParts {
            eyes: true,
            ..BodyParts::all(false)
        },
        ..free(Behavior::SelfTouch, Scene::Crib)
    };
    let blueprint = blueprint(config);
    let env = blueprint.env().expect("an environment");
    assert_eq!(env.action_space().len(), 6);
    blueprint
}

/// Evaluates the policy of a name in two episodes; commands have little time.
fn evaluate(blueprint: &Blueprint, policy: &str, jobs: usize) -> Result<Vec<Info>, EpisodeError> {
    let plan = Plan {
        episodes: 2,
        duration: DURATION,
        render: false,
        fps: 60,
        jobs,
    };
    let (source, limit) = (
        PolicySource::new(policy),
        Duration::from_secs(if policy.starts_with("sleep") { 1 } else { 60 }),
    );
    run_episodes(blueprint, &plan, &|| source.open(limit), &|| ControlFlow::Continue(()))
}

fn refused(blueprint: &Blueprint, policy: &str, parts: &[&str]) {
    let error = evaluate(blueprint, policy, 2).expect_err(policy).to_string();
    println!("{error}");
    for part in parts {
        assert!(error.contains(part), "{policy}: {error}: no {part:?}");
    }
}

fn logs(folder: &Folder) -> [EvaluationLog; 2] {
    [0, 1].map(|k| EvaluationLog::read(evaluation_path(folder.path(), k)).expect("a log"))
}

#[test]
fn a_policy_has_a_name() {
    for (text, source) in [
        ("random", PolicySource::Random),
        (" zero ", PolicySource::Zero),
        ("white", PolicySource::Random),
        ("pink", PolicySource::Noise(Noise::Pink)),
        (" held:0.1 ", PolicySource::Noise(Noise::Held { seconds: 0.1 })),
        ("held:never", PolicySource::Command("held:never".into())),
        ("a/c.ONNX", PolicySource::Onnx("a/c.ONNX".into())),
        ("'a b/c.onnx'", PolicySource::Onnx("a b/c.onnx".into())),
        (
            "python3 run.py c.onnx",
            PolicySource::Command("python3 run.py c.onnx".into()),
        ),
        (
            "python3 policy.py --fast",
            PolicySource::Command("python3 policy.py --fast".into()),
        ),
    ] {
        assert_eq!(PolicySource::new(text), source);
    }
    let folder = Folder::new("a b");
    let model = folder.file("c d.onnx", "");
    assert_eq!(
        PolicySource::new(&model.display().to_string()),
        PolicySource::Onnx(model)
    );
}

#[test]
fn noises_move_him_each_in_its_way_whatever_the_number_of_jobs() {
    let folder = Folder::new("noises");
    let blueprint = small(&folder, false);
    let mut all = Vec::new();
    for noise in ["random", "held:0.05", "ou", "pink", "oscillators"] {
        evaluate(&blueprint, noise, 1).expect("episodes");
        let alone = logs(&folder);
        evaluate(&blueprint, noise, 2).expect("episodes");
        assert_eq!(alone, logs(&folder), "{noise}");
        assert_ne!(alone[0].qpos, alone[1].qpos, "{noise}: both episodes are alike");
        all.push(alone);
    }
    for (k, one) in all.iter().enumerate() {
        assert!(
            all[..k].iter().all(|other| other != one),
            "noise {k} moves him as another does"
        );
    }
}

#[cfg(unix)]
mod commands {
    use base64::Engine as _;
    use base64::engine::general_purpose::STANDARD;

    use super::*;

    /// A shell script that answers each line, which is in `$line`, by `body`.
    fn script(folder: &Folder, name: &str, body: &str) -> String {
        let text = format!("while read -r line; do\n{body}\ndone\n");
        format!("sh {}", folder.file(name, text).display())
    }

    #[test]
    fn other_programs_can_be_policies() {
        let folder = Folder::new("command");
        let blueprint = small(&folder, false);
        let zeros = script(&folder, "zeros.sh", "echo '[0, 0.0, -0, 0e3, 0, 0]'");
        let infos = evaluate(&blueprint, &zeros, 2).expect("episodes");
        let piped = logs(&folder);
        assert_eq!(evaluate(&blueprint, "zero", 1).expect("episodes"), infos);
        assert_eq!(piped, logs(&folder));
    }

    /// A policy that goes by the number of the episode, in one program for both episodes and in one for each.
    #[test]
    fn the_number_of_an_episode_does_not_depend_on_the_number_of_jobs() {
        let folder = Folder::new("numbers");
        let blueprint = small(&folder, false);
        let body = r#"case "$line" in *'"episode": 1,'*) a=1;; *) a=-1;; esac; echo "[$a, $a, $a, $a, $a, $a]""#;
        let policy = script(&folder, "numbers.sh", body);
        evaluate(&blueprint, &policy, 1).expect("episodes");
        let alone = logs(&folder);
        assert_ne!(alone[0], alone[1]);
        evaluate(&blueprint, &policy, 2).expect("episodes");
        assert_eq!(alone, logs(&folder));
    }

    #[test]
    fn words_in_quotes_stay_together() {
        let folder = Folder::new("quoted words");
        let blueprint = small(&folder, false);
        let text = "while read -r line; do echo \"$1\"; done";
        let path = folder.file("the policy.sh", text);
        let policy = format!("sh '{}' \"[0, 0, 0, 0, 0, 0]\"", path.display());
        let infos = evaluate(&blueprint, &policy, 1).expect("episodes");
        assert_eq!(evaluate(&blueprint, "zero", 1).expect("episodes"), infos);
    }

    /// The value of a key in a line: a list of numbers, or the text of an object.
    fn member<'l>(line: &'l str, key: &str) -> &'l str {
        let (_, rest) = line.split_once(&format!("\"{key}\": ")).expect(key);
        match rest.as_bytes()[0] {
            b'{' => &rest[..=rest.find('}').expect("an end")],
            b'[' => &rest[..=rest.find(']').expect("an end")],
            _ => rest.split([',', '}']).next().expect("a value"),
        }
    }

    fn numbers(list: &str) -> Vec<f64> {
        let inside = list.trim_matches(['[', ']']).split(", ");
        inside.map(|n| n.parse().expect("a number")).collect()
    }

    #[test]
    fn other_programs_are_told_every_sense() {
        let folder = Folder::new("senses");
        let blueprint = small(&folder, true);
        let heard = folder.path().join("heard");
        let policy = script(
            &folder,
            "heard.sh",
            &format!("printf '%s\\n' \"$line\" >> {}; echo '[0,0,0,0,0,0]'", heard.display()),
        );
        evaluate(&blueprint, &policy, 1).expect("episodes");
        let lines = std::fs::read_to_string(heard).expect("what was told");
        assert_eq!(lines.lines().count() as u64, 2 * DURATION);
        let mut lines = lines.lines();
        for episode in 0..2_u64 {
            let mut env = blueprint.env().expect("an environment");
            env.reset(Some(blueprint.config().seed + episode))
                .expect("no divergence");
            for step in 0..DURATION {
                let (line, o) = (lines.next().expect("a line"), env.observation());
                assert_eq!(member(line, "episode"), episode.to_string());
                assert_eq!(member(line, "step"), step.to_string());
                assert_eq!(line.contains("\"action_space\": {\"low\": [-1.0, "), step == 0);
                assert_eq!(numbers(member(line, "observation")), o.proprioception);
                assert_eq!(Some(&numbers(member(line, "vestibular"))[..]), o.vestibular);
                for (eye, image) in [("eye_left", o.eye_left), ("eye_right", o.eye_right)] {
                    let told = member(line, eye);
                    assert!(told.starts_with("{\"shape\": [8, 8, 3], \"data\": \""), "{told}");
                    let data = told.split('"').nth(5).expect("data");
                    assert_eq!(STANDARD.decode(data).expect("base64"), image.expect("an image"));
                }
                env.step(&[0.0; 6]).expect("no divergence");
            }
        }
    }

    /// A program that goes on after the end of its input is killed, and with it what it has started.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_program_that_is_killed_takes_its_children_with_it() {
        let folder = Folder::new("children");
        let blueprint = small(&folder, false);
        let pid = folder.path().join("pid");
        let body = "while read -r line; do echo '[0, 0, 0, 0, 0, 0]'; done";
        let text = format!("sleep 1000 & echo $! > '{}'\n{body}\nsleep 1000\n", pid.display());
        let program = folder.file("parent.sh", text);
        evaluate(&blueprint, &format!("sh '{}'", program.display()), 1).expect("episodes");
        let pid = std::fs::read_to_string(pid).expect("a process").trim().to_string();
        let stat = std::path::Path::new("/proc").join(&pid).join("stat");
        // a zombie is dead, though nobody has asked how it ended
        let lives =
            || std::fs::read_to_string(&stat).is_ok_and(|stat| stat.contains("(sleep)") && !stat.contains(") Z"));
        let asked = std::time::Instant::now();
        while lives() && asked.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(10));
        }
        assert!(!lives(), "process {pid} outlives the policy that started it");
    }

    #[test]
    fn broken_programs_are_named() {
        let folder = Folder::new("broken");
        let blueprint = small(&folder, false);
        let refused = |policy: &str, parts: &[&str]| refused(&blueprint, policy, parts);
        refused(
            "no-such-program --at-all",
            &["cannot start", "an .onnx file, or a command"],
        );
        refused("", &["cannot start", "it is empty"]);
        refused(
            "sh 'my script.sh",
            &["cannot start", "a quote is not closed", "'my policy.py'"],
        );
        refused("true", &["ended (exit status: 0) at step 0 of episode"]);
        refused("cat", &["answered \"{", "not a list", "list of 6 numbers"]);
        refused("sleep 30", &["no action within 1 s at step 0", "--policy-timeout"]);
        let third = "n=$((n + 1)); [ $n = 4 ] && exit 3; echo '[0,0,0,0,0,0]'";
        refused(
            &script(&folder, "crash.sh", third),
            &["ended (exit status: 3) at step 3 of episode"],
        );
        refused(&script(&folder, "short.sh", "echo '[1, 2]'"), &["it has 2 numbers"]);
        refused(
            &script(&folder, "nan.sh", "echo '[0, NaN, 0, 0, 0, 0]'"),
            &["number 1 is not finite"],
        );
        refused(&script(&folder, "bytes.sh", "printf '\\377\\376\\n'"), &["not a list"]);
        refused(
            &script(&folder, "endless.sh", "yes '[' | tr -d '\\n'"),
            &["answered \"[[[", "it has more than 1048576 bytes"],
        );
        let unasked = ["answered \"[0, 0", "more lines came than observations went"];
        refused("yes '[0, 0, 0, 0, 0, 0]'", &unasked);
        let twice = script(&folder, "twice.sh", "printf '[0, 0, 0, 0, 0, 0]\\n%.0s' 1 2");
        refused(&twice, &unasked);
        refused(
            &script(&folder, "words.sh", "echo loading a model"),
            &["\"loading a model\""],
        );
    }
}

#[cfg(feature = "onnx")]
mod onnx {
    use babybench::Env;
    use babybench::policy::{OnnxPolicy, Policy, PolicyError};
    use babybench::spaces::NumpyRng;

    use super::*;

    fn model(name: &str) -> String {
        format!("{}/tests/data/policies/{name}.onnx", env!("CARGO_MANIFEST_DIR"))
    }

    /// Actions of a model along an episode with random actions, each beside the expected one.
    fn compare(name: &str, vision: bool, tolerance: f32, expected: &dyn Fn(&Env) -> Vec<f32>) {
        let folder = Folder::new(name);
        let mut env = small(&folder, vision).env().expect("an environment");
        let mut policy = OnnxPolicy::open(model(name)).expect("a model");
        let mut action = Vec::new();
        env.reset(Some(0)).expect("no divergence");
        policy.begin(&mut env, 0).expect("a fitting model");
        let (mut different, mut told) = (0.0_f32, false);
        for _ in 0..10 {
            policy.act(&mut env, &mut action).expect("an action");
            let wanted = expected(&env);
            assert_eq!(action.len(), wanted.len());
            for (k, (a, b)) in action.iter().zip(&wanted).enumerate() {
                assert!((a - b).abs() <= tolerance, "{name}: number {k} is {a}, not {b}");
                different = different.max((a - b).abs());
            }
            told |= wanted.iter().any(|w| *w != wanted[0]);
            random_steps(&mut env, 3);
        }
        assert!(told, "{name}: no action tells anything");
        println!("{name}: actions differ by {different:.1e} at most");
    }

    #[test]
    fn a_network_computes_what_its_weights_say() {
        compare("network", false, 1e-6, &|env| {
            let o = env.observation();
            let all: Vec<f64> = [o.proprioception, o.vestibular.expect("balance")].concat();
            let weight = |i: usize, j: usize| ((7 * i + 3 * j) % 11) as f64 / 64.0 - 5.0 / 64.0;
            let sum = |j: usize| -> f64 { all.iter().enumerate().map(|(i, x)| x * weight(i, j)).sum() };
            (0..6).map(|j| (sum(j) + j as f64 / 16.0).tanh() as f32).collect()
        });
    }

    #[test]
    fn images_go_in_as_bytes_or_floats_in_either_order() {
        compare("eyes", true, 1e-6, &|env| {
            let o = env.observation();
            let mean = |image: &[u8], c: usize| {
                image.iter().skip(c).step_by(3).map(|&v| f64::from(v)).sum::<f64>() / (64.0 * 255.0)
            };
            let eyes = [o.eye_left.expect("an image"), o.eye_right.expect("an image")];
            eyes.iter()
                .flat_map(|eye| (0..3).map(|c| mean(eye, c) as f32))
                .collect()
        });
    }

    #[test]
    fn one_input_gets_all_senses_in_alphabetical_order() {
        compare("flat", true, 1e-6, &|env| {
            let o = env.observation();
            let (left, right) = (o.eye_left.expect("an image"), o.eye_right.expect("an image"));
            let balance = o.vestibular.expect("balance");
            let chosen = [
                f64::from(left[5]),
                f64::from(right[7]),
                o.proprioception[0],
                o.proprioception[46],
                balance[0],
                balance[5],
            ];
            chosen.iter().map(|x| (x / 255.0) as f32).collect()
        });
    }

    #[test]
    fn actions_are_clipped() {
        compare("large", false, 0.0, &|env| {
            let space = env.action_space();
            (0..6)
                .map(|k| if k % 2 == 0 { space.high()[k] } else { space.low()[k] })
                .collect()
        });
    }

    #[test]
    fn models_are_policies_of_evaluations() {
        let folder = Folder::new("models");
        let blueprint = small(&folder, false);
        let infos = evaluate(&blueprint, &model("network"), 1).expect("episodes");
        let one = logs(&folder);
        assert_eq!(evaluate(&blueprint, &model("network"), 2).expect("episodes"), infos);
        assert_eq!(one, logs(&folder));
        evaluate(&blueprint, "zero", 1).expect("episodes");
        assert_ne!(one, logs(&folder));
    }

    #[test]
    fn misfits_say_what_is_expected() {
        let folder = Folder::new("misfits");
        let blueprint = small(&folder, false);
        let refused = |name: &str, parts: &[&str]| refused(&blueprint, &model(name), parts);
        refused("no_such_model", &["no_such_model.onnx", "cannot load"]);
        refused("wrong_name", &["\"obs\"", "\"observation\", \"vestibular\""]);
        refused("wrong_shape", &["\"observation\"", "[1, 48]", "[1, 47] or [47]"]);
        refused("wrong_action", &["\"action\" has 5 numbers", "6 numbers"]);
        refused("not_finite", &["\"action\" is not finite: number 0 is -inf"]);
        refused("whole_numbers", &["whole numbers", "(f32)"]);
        refused(
            "takes_whole_numbers",
            &["\"observation\" has the type tensor(i32) but must be f32"],
        );
        refused("eyes", &["\"eye_left\"", "not an active sense"]);
        refused(
            "flat",
            &[
                "[437]",
                "[1, 53] or [53]",
                "all active senses",
                "observation, vestibular",
            ],
        );
        let text = folder.file("text.onnx", "this is no model");
        super::refused(&blueprint, &text.display().to_string(), &["text.onnx", "cannot load"]);
        let folder = Folder::new("misfits_vision");
        let mut config = small(&folder, true).config().clone();
        config.vision_resolution = 16;
        let blueprint = Blueprint::new(config).expect("a scene");
        super::refused(
            &blueprint,
            &model("eyes"),
            &[
                "[batch, 3, 8, 8]",
                "[1, 16, 16, 3] or [16, 16, 3] or [1, 3, 16, 16] or [3, 16, 16]",
            ],
        );
    }

    #[test]
    fn damaged_models_never_panic() {
        let folder = Folder::new("damaged");
        let mut env = small(&folder, true).env().expect("an environment");
        env.reset(Some(0)).expect("no divergence");
        let mut rng = NumpyRng::seed(9);
        let (mut acted, n) = (0, 600);
        for name in ["network", "eyes", "flat"] {
            let whole = std::fs::read(model(name)).expect("a model");
            for _ in 0..n / 3 {
                let mut bytes = whole.clone();
                for _ in 0..1 + (rng.uniform() * 4.0) as usize {
                    let at = (rng.uniform() * bytes.len() as f64) as usize;
                    bytes[at] = (rng.uniform() * 256.0) as u8;
                }
                if rng.uniform() < 0.2 {
                    bytes.truncate((rng.uniform() * bytes.len() as f64) as usize);
                }
                let path = folder.file("damaged.onnx", bytes);
                let mut action = Vec::new();
                let done = OnnxPolicy::open(&path).and_then(|mut p| p.act(&mut env, &mut action));
                match done {
                    Ok(()) => acted += 1,
                    Err(e) => assert!(matches!(e, PolicyError::Onnx { .. }), "{e}"),
                }
            }
        }
        println!("{acted} of {n} damaged models still act");
    }
}

//! Policies that are programs.

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
    let lives = || std::fs::read_to_string(&stat).is_ok_and(|stat| stat.contains("(sleep)") && !stat.contains(") Z"));
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

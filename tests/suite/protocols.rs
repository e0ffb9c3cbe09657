//! Protocols: their documents, short runs with the same bytes, published numbers beside ours, the yoked control.

use std::ops::ControlFlow;
use std::path::Path;

use babybench::eval::protocol::{Protocol, ProtocolPlan, ProtocolResult, PublishedRow};
use babybench::mimo::Version;
use babybench::runs::Record;
use babybench::{Blueprint, Env};

use crate::common::milestones::{infant, pull_to_sit, supported_sitting};
use crate::common::*;

/// Checksums of the measures of short runs with held noise.
const GOLDEN: &str = include_str!("../data/protocols.txt");

fn protocol(name: &str) -> Protocol {
    Protocol::named(name).expect("a protocol of the library")
}

fn run(protocol: &Protocol, plan: &ProtocolPlan, folder: &Path, jobs: usize) -> ProtocolResult {
    let result = protocol.run(plan, folder, jobs, &|| ControlFlow::Continue(()));
    result.unwrap_or_else(|error| panic!("{}: {error}", protocol.name))
}

/// A plan of one age that takes seconds.
fn short(age: f64) -> ProtocolPlan {
    ProtocolPlan {
        ages: Some(vec![age]),
        length: 0.01,
        ..ProtocolPlan::default()
    }
}

#[test]
fn every_protocol_builds_at_all_its_ages() {
    let mut found = 0;
    for name in Protocol::names() {
        let protocol = protocol(name);
        for condition in &protocol.conditions {
            for &age in &protocol.ages {
                let config = protocol.configured(condition, "", Some(age)).expect("allowed");
                assert_eq!(config.age, Some(age));
                let made = Blueprint::new(config);
                made.unwrap_or_else(|error| panic!("{name} at {age} months: {error}"));
                found += 1;
            }
        }
    }
    assert!(found > 60, "{found}");
}

#[test]
fn published_rows_have_sources_and_marks() {
    for name in Protocol::names() {
        let protocol = protocol(name);
        let text = protocol.to_text();
        assert!(!protocol.published.is_empty(), "{name}");
        for row in &protocol.published {
            assert!(row.source.len() > 5 && row.says.len() > 5, "{name}: {row:?}");
            assert!(PublishedRow::MARKS.iter().any(|(mark, _)| *mark == row.mark));
            assert!(
                text.contains(&row.source) && text.contains(&row.text()),
                "{name}: {row:?}"
            );
            if row.range().is_none() {
                assert_eq!(row.text(), "not found");
            }
            // what has no source is no number
            assert!(row.mark != "u" || row.range().is_none(), "{name}: {row:?}");
        }
    }
}

#[test]
fn short_runs_have_the_numbers_of_the_golden_ones() {
    let mut found = String::new();
    for (name, age) in [
        ("pull_to_sit", 3.0),
        ("supported_sit", 6.0),
        ("kick", 3.0),
        ("self_touch", 3.0),
        ("roll_over", 6.0),
        ("mobile", 3.0),
    ] {
        let folder = Folder::new("protocol_golden");
        let result = run(&protocol(name), &short(age), folder.path(), 1);
        let values: Vec<_> = result.runs.iter().map(|run| &run.values).collect();
        let json = serde_json::to_string(&values).expect("JSON");
        found.push_str(&format!("{name} {:08x}\n", crc32fast::hash(json.as_bytes())));
        println!("{json}");
    }
    assert_eq!(found, GOLDEN, "tests/data/protocols.txt has other checksums");
}

#[test]
fn the_same_plan_gives_the_same_bytes_in_any_number_of_threads_and_again() {
    let kick = protocol("kick");
    let plan = ProtocolPlan {
        seeds: 2,
        ages: Some(vec![1.0, 4.0]),
        policies: vec!["held".to_string(), "color:0.69".to_string()],
        ..short(0.0)
    };
    let files = ["protocol.md", "protocol.json", "figure.svg", "manifest.json"];
    let mut found = Vec::new();
    let folders = [Folder::new("protocol_one"), Folder::new("protocol_two")];
    // the third time the runs of the first one are read
    for (folder, jobs) in [(&folders[0], 1), (&folders[1], 3), (&folders[0], 2)] {
        let result = run(&kick, &plan, folder.path(), jobs);
        result.write(folder.path()).expect("files");
        assert_eq!(result.runs.len(), 8);
        assert!(!folder.path().join("records").exists(), "records are kept");
        found.push(files.map(|file| std::fs::read(folder.path().join(file)).expect("a file")));
    }
    assert!(found[0] == found[1], "results depend on the number of threads");
    assert!(found[0] == found[2], "results depend on what is read");
    let [table, json, figure, manifest] = found[0].clone().map(|bytes| String::from_utf8(bytes).expect("text"));
    assert!(
        table.contains("| `held` | 1 |") && table.contains("| `color:0.69` | 4 |"),
        "{table}"
    );
    assert!(
        table.contains("0.23 to 0.33 s (s; doi:") && table.contains("not found"),
        "{table}"
    );
    assert!(figure.starts_with("<svg") && figure.contains("infants, published"));
    let manifest: serde_json::Value = serde_json::from_str(&manifest).expect("JSON");
    assert_eq!(manifest["format"], "babybench protocol");
    assert_eq!(manifest["configurations"]["policy"]["strength"], "infant");
    assert_eq!(manifest["files"]["protocol.json"], crc32fast::hash(json.as_bytes()));
    for line in table.lines().filter(|line| !line.starts_with('|')) {
        assert!(line.chars().count() <= 160, "{line}");
    }
}

/// With a policy that does nothing, the fixtures are those of the milestones.
#[test]
fn fixtures_measure_what_milestones_measure() {
    let folder = Folder::new("protocol_fixtures");
    let plan = ProtocolPlan {
        policies: vec!["zero".to_string()],
        ages: Some(vec![1.0, 6.0]),
        length: 0.1,
        ..ProtocolPlan::default()
    };
    let result = run(&protocol("pull_to_sit"), &plan, &folder.path().join("pull"), 2);
    for run in &result.runs {
        let [at_45, at_90] = pull_to_sit(&infant(Version::V1, run.age));
        for (name, expected) in [("at_45", at_45), ("at_90", at_90)] {
            let found = run.value("controller", "pull", name).expect("a lag");
            assert!(
                (found - expected).abs() < 1e-6,
                "{name} at {}: {found}, {expected}",
                run.age
            );
        }
        let limp = run.value("policy", "pull", "at_45").expect("a lag");
        assert!(limp > 45.0, "a limp neck lags by {limp} degrees");
    }
    let result = run(&protocol("supported_sit"), &plan, &folder.path().join("sit"), 2);
    for run in &result.runs {
        let expected = supported_sitting(&infant(Version::V1, run.age));
        let found = run.value("controller", "tilt", "gives_way").expect("a tilt");
        assert!((found - expected).abs() < 1e-6, "at {}: {found}, {expected}", run.age);
    }
    let sits = result
        .comparisons
        .iter()
        .find(|c| c.published.value == Some(6.0))
        .expect("a row");
    let ours = sits.ours.expect("between the ages").mean;
    let difference = sits.difference.expect("a number");
    assert_eq!(difference.absolute, ours - 6.0);
    assert_eq!(difference.deviations, Some((ours - 6.0) / 1.1));
}

#[test]
fn a_yoked_mobile_repeats_another_infants() {
    let folder = Folder::new("protocol_yoked");
    let plan = ProtocolPlan {
        length: 0.02,
        keep_records: true,
        ..short(3.0)
    };
    let result = run(&protocol("mobile"), &plan, folder.path(), 1);
    let name = &result.runs[0].name;
    let open =
        |condition: &str| Record::open(folder.path().join("records").join(name).join(condition)).expect("a record");
    let [own, yoked] = ["contingent", "yoked"].map(open);
    // positions of the mobile and of the right knee in the first part of learning, the fourth episode
    let paths = |record: &Record| {
        let env = Env::new(record.manifest().configuration.clone()).expect("an environment");
        let model = env.model();
        let qpos = record.npz(3).expect("an archive").get_f64("qpos").expect("positions");
        let path = |joint: &str| -> Vec<f64> {
            let at = model.jnt_qposadr[model.joint(joint).expect("a joint")];
            qpos.data.iter().skip(at).step_by(model.nq).copied().collect()
        };
        [path("mobile_bounce"), path("robot:right_knee")]
    };
    let ([mobile, knee], [repeated, other]) = (paths(&own), paths(&yoked));
    let far = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let span = far(&mobile, &vec![mobile[0]; mobile.len()]);
    println!(
        "mobile moves by {span:.4} m and differs by {:.4} m",
        far(&mobile, &repeated)
    );
    assert!(span > 0.01 && far(&mobile, &repeated) < 0.25 * span);
    assert!(far(&knee, &other) > 0.1, "the other infant moves as he likes");
    // a time until he learns is that of nine minutes
    let waits = result
        .comparisons
        .iter()
        .filter(|c| c.missing == "needs the whole length");
    assert_eq!(waits.count(), 3);
    // the task's own counter agrees with the parts of the record
    let info = &own.manifest().episodes.last().expect("episodes").info;
    let counted = info["right_foot_movements_reinforcement"].as_f64().expect("a counter");
    let rate = result.runs[0]
        .value("contingent", "learn", "right_foot_movements")
        .expect("a rate");
    let measured = rate * 540.0 * 0.02 / 60.0;
    assert!(
        (measured - counted).abs() <= 10.0,
        "{measured} movements, the task counts {counted}"
    );
}

#[test]
fn faults_say_where_and_names_that_are_near() {
    let error = Protocol::named("kicks").expect_err("no such protocol").to_string();
    assert!(
        error.contains("did you mean \"kick\"") && error.contains("pull_to_sit"),
        "{error}"
    );
    let folder = Folder::new("protocol_faults");
    let good = "title: A\nconfig: {behavior: none}\nages: [3]\nphases: [{name: p, seconds: 1}]\nmeasures: [{name: exponent}]\npublished: []\n";
    let read = |text: &str| Protocol::from_file(folder.file("own.yml", text));
    assert_eq!(read(good).expect("a protocol").name, "own");
    for (from, to, part) in [
        ("title: A\n", "", "no `title`"),
        ("title: A", "titles: A", "no `title`"),
        ("behavior: none", "behaviour: none", "did you mean `behavior`"),
        ("ages: [3]", "ages: [30]", "months from 0 to 24"),
        ("seconds: 1", "seconds: 0", "own.yml:4: `seconds` is above 0"),
        ("name: exponent", "name: e, mean_off: [a]", "did you mean `mean_of`"),
        (
            "name: exponent",
            "name: e, ratio_of: x, over: q",
            "`q`, which is not a phase",
        ),
        (
            "published: []",
            "published: [{says: x, unit: s, mark: z, source: y}]",
            "`mark` is r (read)",
        ),
        (
            "published: []",
            "published: [{says: x, measure: m, unit: s, mark: s, source: y}]",
            "names `m`, which does not exist",
        ),
    ] {
        let error = read(&good.replace(from, to)).expect_err(to).to_string();
        assert!(error.contains(part) && error.contains("own.yml"), "{to}: {error}");
    }
    let kick = protocol("kick");
    for (plan, part) in [
        (
            ProtocolPlan {
                length: 0.0,
                ..short(3.0)
            },
            "length is 0",
        ),
        (
            ProtocolPlan {
                length: f64::NAN,
                ..short(3.0)
            },
            "length is NaN",
        ),
        (ProtocolPlan { seeds: 0, ..short(3.0) }, "seeds is 0"),
        (
            ProtocolPlan {
                policies: vec![],
                ..short(3.0)
            },
            "policies is a list of 0",
        ),
        (short(25.0), "from 0 to 24"),
        (
            ProtocolPlan {
                keys: "strengths: infant\n".to_string(),
                ..short(3.0)
            },
            "did you mean `strength`",
        ),
    ] {
        let out = folder.path().join("never");
        let error = kick
            .run(&plan, &out, 1, &|| ControlFlow::Continue(()))
            .expect_err(part)
            .to_string();
        assert!(error.contains(part), "{part}: {error}");
        assert!(!out.exists());
    }
}

//! Random legal documents, and one for each attribute and value, beside MuJoCo.

use std::collections::{BTreeMap, BTreeSet};

use conformance::differential::language::Language;
use conformance::differential::single::{base_meaning, outcome, singles};
use conformance::differential::{document, run, seed_of};
use conformance::live::parallel;
use conformance::measure::only_print;
use conformance::mujoco::{MUJOCO, needed};
use testkit::harness::{TIME, Trial};
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    [
        trials![
            every_attribute_of_the_loader_is_drawn_or_changes_no_physics,
            generated_documents_use_every_element_and_attribute
        ],
        trials![needs MUJOCO: every_attribute_and_value_agrees],
        trials![needs MUJOCO, TIME: generated_documents_agree],
    ]
    .concat()
}

/// Documents that are generated for a release.
const DOCUMENTS: u64 = 400;

/// The version of babybench, as its manifest gives it.
fn version() -> &'static str {
    let manifest = include_str!("../../../Cargo.toml");
    let line = manifest.lines().find_map(|line| line.strip_prefix("version = \""));
    line.and_then(|rest| rest.split('"').next())
        .expect("Cargo.toml has a version")
}

fn every_attribute_of_the_loader_is_drawn_or_changes_no_physics() {
    let language = Language::new().unwrap_or_else(|e| panic!("{e}"));
    let attributes: usize = language.elements().map(|(_, attributes)| attributes.len()).sum();
    show!("{attributes} attributes change physics");
    assert!(attributes > 100, "{attributes}");
    let stale = conformance::differential::language::stale();
    assert!(stale.is_empty(), "the loader knows nothing of {stale:?}");
}

/// An attribute that is drawn must be seen in documents, in an element of its kind.
fn generated_documents_use_every_element_and_attribute() {
    let language = Language::new().unwrap_or_else(|e| panic!("{e}"));
    let mut seen: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for seed in 0..1500 {
        let document = document(&language, seed);
        document.visit(&mut Vec::new(), &mut |above, node| {
            let names = seen
                .entry(conformance::differential::single::listed(above))
                .or_default();
            names.extend(node.attributes.iter().map(|(name, _)| name.clone()));
        });
    }
    let mut missing = Vec::new();
    for (path, attributes) in language.elements() {
        let Some(names) = seen.get(path) else {
            missing.push(path.to_owned());
            continue;
        };
        let unseen = attributes.iter().filter(|attribute| !names.contains(attribute.name));
        missing.extend(unseen.map(|attribute| format!("{path}@{}", attribute.name)));
    }
    assert!(
        missing.is_empty(),
        "conformance/src/differential/document.rs never writes {missing:?}"
    );
}

fn generated_documents_agree() {
    let seed = seed_of(version());
    let tally = run(needed(), seed, DOCUMENTS).unwrap_or_else(|e| panic!("{e}"));
    show!(
        "{DOCUMENTS} documents of seed {seed}, that of version {}\n\n{tally}",
        version()
    );
    for finding in tally.findings() {
        let place: String = finding.place.chars().take(120).collect();
        show!("{}: error {:.1e}, ours {place}", finding.quantity, finding.error);
    }
    assert!(
        tally.counted("documents that both take") > 200,
        "too few documents are legal"
    );
    assert!(tally.counted("states compared") > 500, "too few states are compared");
    assert!(
        only_print() || tally.differences() == 0,
        "seed {seed}: {} differences; cargo run --release -p conformance -- differential --count {DOCUMENTS} --seed {seed} \
         --keep FOLDER writes small documents that differ",
        tally.differences()
    );
}

fn every_attribute_and_value_agrees() {
    let api = needed();
    let language = Language::new().unwrap_or_else(|e| panic!("{e}"));
    let all = singles(&language).unwrap_or_else(|e| panic!("{e}"));
    let base = base_meaning(api).unwrap_or_else(|e| panic!("{e}"));
    let outcomes = parallel(&all, || (), |(), single| outcome(api, &base, single));
    let (mut wrong, mut states) = (Vec::new(), 0);
    // whether a value of it is taken, and whether one changes what MuJoCo does
    let mut attributes: BTreeMap<&str, [bool; 2]> = BTreeMap::new();
    for (single, outcome) in all.iter().zip(&outcomes) {
        states += outcome.states;
        let [taken, matters] = attributes.entry(&single.attribute).or_default();
        *taken |= outcome.taken;
        *matters |= outcome.matters || single.alone;
        let worst = outcome.differences.iter().max_by(|a, b| a.error.total_cmp(&b.error));
        if let Some(m) = worst {
            wrong.push(format!(
                "{}: {}: error {:.1e}, ours {}",
                single.what, m.quantity, m.error, m.place
            ));
        }
    }
    show!(
        "{} documents of {} attributes, {states} states",
        all.len(),
        attributes.len()
    );
    wrong
        .iter()
        .for_each(|line| show!("{}", line.chars().take(200).collect::<String>()));
    let idle: Vec<&str> = attributes
        .iter()
        .filter(|(_, both)| **both != [true; 2])
        .map(|(name, _)| *name)
        .collect();
    show!("attributes that change nothing here: {idle:?}");
    assert!(
        only_print() || wrong.is_empty(),
        "{} documents differ, the first: {}",
        wrong.len(),
        wrong[0]
    );
    assert!(idle.is_empty(), "{idle:?}");
}

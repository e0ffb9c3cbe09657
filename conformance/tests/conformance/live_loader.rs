//! Thousands of mutated documents: MuJoCo 3.3.0 and our loader accept and reject alike, and compile the same model.

use std::collections::BTreeMap;
use std::path::Path;

use babybench::assets::{AssetSource, MemoryAssets};
use babybench::config::{Behavior, Config, Scene};
use babybench::mimo::{DOCUMENT, embedded, scene_xml};
use conformance::data;
use conformance::loading::{Outcome, compare};
use conformance::measure::only_print;
use conformance::mujoco::{MUJOCO, Mujoco, needed};
use testkit::harness::Trial;
use testkit::mutation::{generate, mutate_document as mutate};
use testkit::{Rng, show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO: mutations_of_all_features_are_taken_alike, small_documents_are_taken_alike, mutations_of_the_scenes_are_taken_alike]
}

/// A document with every supported element: that of `data/compiled_features.npz`.
fn features() -> String {
    let bytes = data::npz("compiled_features.npz")
        .get_f64("xml")
        .expect("committed data")
        .data;
    bytes.iter().map(|&b| char::from(b as u8)).collect()
}

/// Counts outcomes and keeps the faults.
struct Tally {
    seed: u64,
    counts: BTreeMap<String, usize>,
    faults: Vec<String>,
}

impl Tally {
    fn new(seed: u64) -> (Self, Rng) {
        let (counts, faults) = (BTreeMap::new(), Vec::new());
        // other documents with another CONFORMANCE_SEED
        let other = std::env::var("CONFORMANCE_SEED").map_or(0, |n| n.parse().expect("CONFORMANCE_SEED is a number"));
        (Self { seed, counts, faults }, Rng::with_seed(seed + 10 * other))
    }

    /// Counts an outcome; `part` is what was changed. With `CONFORMANCE_KEEP=DIR` faulty documents are kept there.
    fn add(&mut self, outcome: Outcome, document: &str, part: &str) {
        let key = match &outcome {
            Outcome::Equal => "equal models".to_string(),
            Outcome::Rejected => "rejected by both".to_string(),
            Outcome::Stricter(why) => format!("only MuJoCo: {why}"),
            Outcome::Fault(_) => "faults".to_string(),
        };
        *self.counts.entry(key).or_default() += 1;
        if let Outcome::Fault(fault) = outcome {
            if let Ok(folder) = std::env::var("CONFORMANCE_KEEP") {
                let path = Path::new(&folder).join(format!("{}_{}.xml", self.seed, self.faults.len()));
                std::fs::write(path, document).expect("CONFORMANCE_KEEP is a folder");
            }
            self.faults.push(format!("{fault}\n        {part}"));
        }
    }

    fn judge(&self, what: &str) {
        show!("{what}: {:?}", self.counts);
        self.faults.iter().take(40).for_each(|f| show!("    {f}"));
        assert!(
            only_print() || self.faults.is_empty(),
            "{what}: {} faults, the first: {}",
            self.faults.len(),
            self.faults[0]
        );
    }
}

/// Returns where a document and its mutation differ, as text.
fn change(from: &str, to: &str) -> String {
    let (a, b) = (from.as_bytes(), to.as_bytes());
    let first = a.iter().zip(b).take_while(|(x, y)| x == y).count();
    let start = from[..first].rfind('<').unwrap_or(0);
    let end = to[first.min(to.len())..].find('>').map_or(to.len(), |k| first + k + 1);
    to.get(start..end.max(start))
        .unwrap_or(to)
        .replace('\n', " ")
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

fn flat(api: &'static Mujoco, text: &str) -> Outcome {
    compare(api, "m.xml", &[("m.xml", text)], &MemoryAssets::new())
}

fn mutations_of_all_features_are_taken_alike() {
    let api = needed();
    let (mut tally, mut rng) = Tally::new(1);
    let features = features();
    tally.add(flat(api, &features), &features, "the document itself");
    for _ in 0..2000 {
        let text = mutate(&features, &mut rng);
        tally.add(flat(api, &text), &text, &change(&features, &text));
    }
    tally.judge("features");
}

fn small_documents_are_taken_alike() {
    let api = needed();
    let (mut tally, mut rng) = Tally::new(2);
    for _ in 0..1000 {
        let text = generate(&mut rng);
        tally.add(flat(api, &text), &text, &text);
        let mutation = mutate(&text, &mut rng);
        tally.add(flat(api, &mutation), &mutation, &mutation);
    }
    tally.judge("small documents");
}

/// Without the elements and attributes that name textures: these cost most of the time and are not changed.
fn without_textures(text: &str) -> String {
    let mut text = text.to_string();
    for (open, close) in [("<texture", "/>"), ("<material", "/>"), (" material=\"", "\"")] {
        while let Some(at) = text.find(open) {
            let from = at + open.len();
            let end = text[from..].find(close).map_or(text.len(), |k| from + k + close.len());
            text.replace_range(at..end, "");
        }
    }
    text
}

fn mutations_of_the_scenes_are_taken_alike() {
    let api = needed();
    let (mut tally, mut rng) = Tally::new(3);
    for round in 0..500_usize {
        let behavior = [Behavior::None, Behavior::HandRegard][round % 2];
        let config = Config {
            behavior,
            scene: Scene::BABYBENCH[round % 3].clone(),
            ..Config::default()
        };
        let xml = scene_xml(&config);
        let mut files = vec![("scene.xml".to_string(), xml)];
        for (path, bytes) in embedded().0 {
            if let Some(name) = path.strip_prefix(DOCUMENT.trim_end_matches("scene.xml")) {
                files.push((name.to_string(), without_textures(&String::from_utf8_lossy(bytes))));
            }
        }
        let used: Vec<usize> = (1..files.len()).filter(|&k| included(&files, &files[k].0)).collect();
        let k = used[rng.usize(..used.len())];
        let before = files[k].1.clone();
        if round > 5 {
            files[k].1 = mutate(&before, &mut rng);
        }
        let mut assets = MemoryAssets::new();
        files
            .iter()
            .for_each(|(name, text)| assets.insert(name, text.clone()).expect("a valid name"));
        assert!(assets.contains("scene.xml"));
        let given: Vec<(&str, &str)> = files
            .iter()
            .map(|(name, text)| (name.as_str(), text.as_str()))
            .collect();
        let outcome = compare(api, "scene.xml", &given, &assets);
        tally.add(
            outcome,
            &files[k].1,
            &format!("{}: {}", files[k].0, change(&before, &files[k].1)),
        );
    }
    tally.judge("scenes");
}

fn included(files: &[(String, String)], name: &str) -> bool {
    let text = format!("\"{name}\"");
    files
        .iter()
        .any(|(other, content)| content.contains(&text) && (other == "scene.xml" || included(files, other)))
}

//! Random legal documents compared with MuJoCo 3.3.0, one step from random states each.
//!
//! Documents follow from the loader's own list of elements and attributes ([`language`]) and from a line for each of
//! them that says how ([`rules`]), so that a new attribute is either drawn or a test fails. [`document`] puts the elements together,
//! [`state`] the states, [`compare`] steps both sides, [`measured`] tells how far they are apart, [`reduce`] makes what differs small, [`table`] counts. Many documents run in [`processes`] of their own. [`single`] has one
//! document for each attribute and value.

pub mod compare;
mod contacts;
pub mod dice;
mod document;
pub mod language;
mod matrix;
pub mod measured;
pub mod node;
pub mod reduce;
pub mod rules;
pub mod single;
pub mod slack;
pub mod state;
pub mod table;

pub use document::document;

use std::ops::Range;
use std::process::Command;

use crate::live::parallel;
use crate::mujoco::Mujoco;
use crate::processes::{self, Ran, ranges};
use compare::{Sides, Stepped, Taken, Why};
use language::Language;
use measured::Measured;
use reduce::Finding;
use state::{Recipe, hash};
use table::Tally;

/// States of each document.
const STATES: u64 = 3;

/// Returns the seed for a version, so that each release is tested on different documents.
pub fn seed_of(version: &str) -> u64 {
    hash(0, version)
}

/// The number of documents on which MuJoCo crashed.
const FELL: &str = "documents at which MuJoCo falls (invalid access to memory)";

/// Compares documents `0..count` of a seed, in threads.
///
/// # Errors
/// Attributes without a rule.
pub fn run(api: &'static Mujoco, seed: u64, count: u64) -> Result<Tally, String> {
    let language = Language::new()?;
    let parts = parallel(
        &ranges(count, 50),
        || (),
        |(), range| Tally::of(range.clone().map(|k| numbered(api, &language, seed, k))),
    );
    Ok(Tally::of(parts))
}

/// Compares documents `0..count` of a seed, in processes: `child` makes the command that calls [`in_child`] for a range.
///
/// # Errors
/// As [`processes::run`].
pub fn run_in_processes(count: u64, child: impl Fn(&Range<u64>) -> Command + Sync) -> Result<Tally, String> {
    let ran = processes::run(count, 500, child)?;
    Ok(Tally::of(ran.into_iter().map(|ran| match ran {
        Ran::Done(tally) => tally,
        Ran::Fell => {
            let mut tally = Tally::default();
            tally.count("documents");
            tally.count(FELL);
            tally
        }
    })))
}

/// Compares the documents of a range in this process, and reports to its parent.
///
/// # Errors
/// Attributes without a rule, a closed output.
pub fn in_child(api: &'static Mujoco, seed: u64, range: Range<u64>) -> Result<(), String> {
    let language = Language::new()?;
    processes::in_child(range, |k| numbered(api, &language, seed, k))
}

/// Compares a document of a seed.
fn numbered(api: &'static Mujoco, language: &Language, seed: u64, k: u64) -> Tally {
    let mut tally = Tally::default();
    one(api, language, hash(seed, &k.to_string()), &mut tally);
    tally
}

/// Compares the document of a seed.
fn one(api: &'static Mujoco, language: &Language, seed: u64, tally: &mut Tally) {
    let document = document(language, seed);
    tally.count("documents");
    let mut sides = match Sides::load(api, &document.to_string()) {
        Taken::Refused(_) => return tally.count("documents that neither takes"),
        Taken::Stricter(reason) => {
            tally.count(reason);
            return tally.count("documents that ours refuses on purpose");
        }
        Taken::ByOne(measured) => return tally.add(&measured, &document, None),
        Taken::Both(sides) => sides,
    };
    tally.count("documents that both take");
    tally.add(&Measured::taken(), &document, None);
    for measured in sides.arrays() {
        if measured.agrees() {
            tally.add(
                &Measured {
                    quantity: "compiled arrays",
                    ..measured
                },
                &document,
                None,
            )
        } else {
            tally.add(&measured, &document, None)
        }
    }
    for k in 0..STATES {
        let recipe = Recipe::new(hash(seed, &format!("state {k}")));
        match sides.step(&recipe) {
            Stepped::Diverged => tally.count("states in which MuJoCo diverges"),
            Stepped::Noise => tally.count("states in which MuJoCo's own numbers are noise"),
            Stepped::Compared { why: Why::Jump, .. } => tally.count("states in which MuJoCo jumps by itself"),
            Stepped::Compared { why: Why::Cut, .. } => {
                tally.count("states in which conjugate gradients end early, at the limit of iterations, and apart")
            }
            Stepped::Compared {
                measured,
                contacts,
                rows,
                why: Why::Ours,
            } => {
                tally.count("states compared");
                tally.count_many("contacts compared", contacts);
                tally.count_many("rows compared", rows);
                measured
                    .iter()
                    .for_each(|measured| tally.add(measured, &document, Some(recipe)));
            }
        }
    }
}

/// Returns the finding as a document with its state in a comment, for both sides to load.
pub fn write_finding(finding: &Finding) -> String {
    let mut text = finding.document.to_string();
    text += &format!(
        "<!-- {}: error {:.1e}; ours {} -->\n",
        finding.quantity,
        finding.error,
        finding.place.replace("--", "- -")
    );
    if let (Some(recipe), Ok(model)) = (&finding.recipe, compare::our_model(&text)) {
        text += &format!(
            "<!-- state: {} -->\n",
            compare::describe_state(&model.into(), recipe).replace("--", "- -")
        );
    }
    text
}

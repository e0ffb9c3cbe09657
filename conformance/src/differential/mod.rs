//! Random legal documents beside MuJoCo 3.3.0, one step from random states each.
//!
//! Documents follow from the loader's own list of elements and attributes ([`language`]) and from a line for each of
//! them that says how ([`rules`]), so that a new attribute is either drawn or a test fails. [`document`] puts the elements together,
//! [`state`] the states, [`compare`] steps both sides, [`measured`] tells how far they are apart, [`reduce`] makes what differs small, [`table`] counts. Many documents run in [`processes`] of their own. [`single`] has one
//! document for each attribute and value.

pub mod compare;
pub mod dice;
mod document;
pub mod language;
mod matrix;
pub mod measured;
pub mod node;
pub mod processes;
pub mod reduce;
pub mod rules;
pub mod single;
pub mod slack;
pub mod state;
pub mod table;

pub use document::document;

use std::ops::Range;

use crate::live::parallel;
use crate::mujoco::Mujoco;
use compare::{Sides, Stepped, Taken, Why};
use language::Language;
use measured::Measured;
use reduce::Finding;
use state::{Recipe, hash};
use table::Tally;

/// States of each document.
const STATES: u64 = 3;

/// Returns the seed that stands for a version, so that each release is tested on documents of its own.
pub fn seed_of(version: &str) -> u64 {
    hash(0, version)
}

/// Compares documents `0..count` of a seed, in threads.
///
/// # Errors
/// Attributes without a rule.
pub fn run(api: &'static Mujoco, seed: u64, count: u64) -> Result<Tally, String> {
    let language = Language::new()?;
    let parts = parallel(
        &batches(count, 50),
        || (),
        |(), batch| {
            let mut tally = Tally::default();
            for k in batch.clone() {
                one(api, &language, hash(seed, &k.to_string()), &mut tally);
            }
            tally
        },
    );
    Ok(Tally::of(parts))
}

/// Splits documents `0..count` into ranges: long enough for a thread to be worth its while, short enough to end together.
fn batches(count: u64, length: u64) -> Vec<Range<u64>> {
    let starts = (0..count).step_by(length as usize);
    starts.map(|k| k..count.min(k + length)).collect()
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

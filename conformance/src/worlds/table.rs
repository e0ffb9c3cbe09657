//! The comparison of documents with MuJoCo, as a table for people and as JSON for programs.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use serde_json::{Value, json};

use super::{Figures, Outcome, World};

/// Returns the name of a folder.
fn name(folder: &Path) -> String {
    folder.file_name().map_or_else(
        || folder.display().to_string(),
        |name| name.to_string_lossy().into_owned(),
    )
}

/// Returns a reason without the place in the text, so that equal ones can be counted.
fn without_place(reason: &str) -> &str {
    let after = reason.split_once(": ").map_or(reason, |(_, after)| after);
    after.split_once(": ").map_or(after, |(_, after)| after)
}

fn short(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.1e}")
    } else {
        "-".to_owned()
    }
}

/// Writes the totals, the documents that crash MuJoCo, those that both load, and the reasons for refusals.
pub fn text(worlds: &[World]) -> String {
    totals(worlds) + &fallen(worlds) + &taken(worlds) + &reasons(worlds)
}

/// Returns the place of a document.
fn place(world: &World) -> String {
    format!("{}/{}", name(&world.folder), world.path)
}

fn fallen(worlds: &[World]) -> String {
    let mut out = String::new();
    for world in worlds.iter().filter(|world| matches!(world.outcome, Outcome::Fell)) {
        let _ = writeln!(out, "\nMuJoCo falls (invalid access to memory): {}", place(world));
    }
    out
}

fn totals(worlds: &[World]) -> String {
    let mut folders: BTreeMap<String, [usize; 4]> = BTreeMap::new();
    for world in worlds {
        let counts = folders.entry(name(&world.folder)).or_default();
        match &world.outcome {
            Outcome::NoDocument | Outcome::Fell => {}
            Outcome::OursAlone(_) => counts[3] += 1,
            Outcome::Refused(_) => counts[0] += 1,
            Outcome::Both(figures) => {
                counts[0] += 1;
                counts[1] += 1;
                counts[2] += usize::from(figures.agrees());
            }
        }
    }
    let mut out =
        "| folder | MuJoCo takes | both take | agree | ours alone takes |\n|---|--:|--:|--:|--:|\n".to_owned();
    let mut sum = [0; 4];
    for (folder, counts) in &folders {
        let [mujoco, both, agree, alone] = counts;
        let _ = writeln!(out, "| {folder} | {mujoco} | {both} | {agree} | {alone} |");
        sum.iter_mut().zip(counts).for_each(|(sum, n)| *sum += n);
    }
    let [mujoco, both, agree, alone] = sum;
    let _ = writeln!(out, "| all | {mujoco} | {both} | {agree} | {alone} |");
    out
}

fn taken(worlds: &[World]) -> String {
    let columns = [
        "document",
        "nv",
        "contacts",
        "other contacts",
        "compiled arrays",
        "qacc p50",
        "p90",
        "max",
        "unexplained",
        "100 steps",
        "floor",
        "CPU time",
    ];
    let mut out = format!(
        "\n| {} |\n|---|{}\n",
        columns.join(" | "),
        "--:|".repeat(columns.len() - 1)
    );
    let (mut notes, mut above) = (String::new(), String::new());
    for world in worlds {
        let Outcome::Both(f) = &world.outcome else { continue };
        let place = place(world);
        // a row for the folder and short rows for its documents, so that rows fit on a screen
        let (folder, file) = place.rsplit_once('/').unwrap_or(("", &place));
        if folder != above {
            let _ = writeln!(out, "| {folder}/ |{}", "|".repeat(columns.len() - 1));
            above = folder.to_owned();
        }
        let [ours, floor] = f.rollout.map_or([f64::NAN; 2], |rollout| [rollout.ours, rollout.floor]);
        let figures = [f.arrays, f.qacc.p50, f.qacc.p90, f.qacc.max, f.unexplained, ours, floor].map(short);
        let cpu = if f.cpu.is_nan() {
            "-".to_owned()
        } else {
            format!("{:.2}", f.cpu)
        };
        let _ = writeln!(
            out,
            "| {file} | {} | {:.1} | {} of {} | {} | {cpu} |",
            f.nv,
            f.contacts,
            f.other_contacts,
            f.states,
            figures.join(" | ")
        );
        if f.arrays > 1.0 {
            let _ = writeln!(notes, "- {place}: {}", f.farthest_array);
        }
        if let Some(failure) = &f.failure {
            let _ = writeln!(notes, "- {place}: {failure}");
        }
    }
    if !notes.is_empty() {
        let _ = write!(out, "\n{notes}");
    }
    out
}

fn reasons(worlds: &[World]) -> String {
    let mut reasons: BTreeMap<&str, usize> = BTreeMap::new();
    for world in worlds {
        if let Outcome::Refused(reason) = &world.outcome {
            *reasons.entry(without_place(reason)).or_default() += 1;
        }
    }
    let mut reasons: Vec<(&str, usize)> = reasons.into_iter().collect();
    reasons.sort_by_key(|(_, n)| std::cmp::Reverse(*n));
    let mut out = "\n| first reason why ours refuses | documents |\n|---|--:|\n".to_owned();
    for (reason, n) in reasons {
        let _ = writeln!(out, "| {} | {n} |", reason.replace('|', "\\|"));
    }
    out
}

/// Returns a number, or nothing if it is not finite.
fn number(value: f64) -> Value {
    if value.is_finite() { json!(value) } else { Value::Null }
}

fn figures(f: &Figures) -> Value {
    json!({
        "nv": f.nv,
        "agrees": f.agrees(),
        "states": f.states,
        "contacts": number(f.contacts),
        "other_contacts": f.other_contacts,
        "arrays": number(f.arrays),
        "farthest_array": f.farthest_array,
        "qacc": { "p50": number(f.qacc.p50), "p90": number(f.qacc.p90), "max": number(f.qacc.max) },
        "unexplained": number(f.unexplained),
        "rollout": f.rollout.map(|rollout| json!({ "ours": number(rollout.ours), "floor": number(rollout.floor) })),
        "cpu": number(f.cpu),
        "failure": f.failure,
    })
}

/// Returns everything for programs.
pub fn json(worlds: &[World]) -> Value {
    let one = |world: &World| {
        let (outcome, detail) = match &world.outcome {
            Outcome::NoDocument => ("none", Value::Null),
            Outcome::OursAlone(reason) => ("ours alone", json!(reason)),
            Outcome::Refused(reason) => ("refused", json!(reason)),
            Outcome::Both(f) => ("both", figures(f)),
            Outcome::Fell => ("MuJoCo falls", Value::Null),
        };
        json!({ "folder": name(&world.folder), "path": world.path, "outcome": outcome, "detail": detail })
    };
    Value::Array(worlds.iter().map(one).collect())
}

/// Counts the documents on which the sides disagree, or that only ours accepts.
pub fn faults(worlds: &[World]) -> usize {
    let fault = |world: &&World| match &world.outcome {
        Outcome::OursAlone(_) => true,
        Outcome::Both(f) => !f.agrees(),
        Outcome::NoDocument | Outcome::Refused(_) | Outcome::Fell => false,
    };
    worlds.iter().filter(fault).count()
}

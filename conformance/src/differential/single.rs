//! Documents for each attribute and value that changes physics: a document with all elements, in which one of them gets the attribute,
//! and the same by a default class if the attribute is allowed there.

use super::compare::{Sides, Stepped, Taken, Why};
use super::dice::Dice;
use super::language::{Attribute, Language};
use super::measured::Measured;
use super::node::Node;
use super::rules::{How, RIVALS};
use super::state::{Recipe, hash};
use crate::mujoco::Mujoco;

/// A document with all elements.
const BASE: &str = include_str!("base.xml");

/// Number of values drawn for a numeric attribute.
const DRAWN: u64 = 4;

/// States from which each document is stepped.
const STATES: u64 = 12;

/// A document with one attribute set.
pub struct Single {
    /// Attribute and value, for display: `worldbody/body/geom@condim="4"`, with `default/` before it where a class sets it.
    pub what: String,
    /// The attribute alone, and whether a class sets it.
    pub attribute: String,
    /// Whether the attribute has no other value.
    pub alone: bool,
    /// The document.
    pub document: Node,
}

/// The comparison of a document.
pub struct Outcome {
    /// Quantities that differ between the sides.
    pub differences: Vec<Measured>,
    /// Whether MuJoCo accepts it.
    pub taken: bool,
    /// Whether MuJoCo's model or its step differs from those without the attribute.
    pub matters: bool,
    /// States compared.
    pub states: usize,
}

/// Returns the path under which the loader lists an element.
pub fn listed(above: &[&str]) -> String {
    let mut path: Vec<&str> = above.iter().copied().filter(|name| *name != "mujoco").collect();
    path.dedup_by(|a, b| a == b && ["body", "default"].contains(a));
    if let ["worldbody", inner] = path[..]
        && inner != "body"
    {
        path.insert(1, "body");
    }
    path.join("/")
}

/// Returns the values to try.
fn values(path: &str, attribute: &Attribute) -> Vec<String> {
    if !attribute.words.is_empty() {
        return attribute.words.clone();
    }
    match attribute.how {
        How::Placed(given) => given.iter().map(|value| (*value).to_owned()).collect(),
        How::Drawn(_, draw) => {
            let value = |k| draw(&mut Dice::new(hash(k, &format!("{path}@{}", attribute.name))));
            let mut all: Vec<String> = (0..DRAWN).map(value).collect();
            if attribute.infinite {
                all.extend(["-inf inf", "-0.3 inf", "-INFINITY .2"].map(str::to_owned));
            }
            all.sort();
            all.dedup();
            all
        }
        How::Word(_) | How::Nothing => Vec::new(),
    }
}

/// Removes the marks of the elements that are tried.
fn unmarked(mut base: Node) -> Node {
    for k in 0..base.count() {
        if let Some(node) = base.nth_mut(k) {
            node.unset("probe");
        }
    }
    base
}

/// Sets an attribute and removes its rivals.
fn set(node: &mut Node, name: &str, value: &str) {
    for group in RIVALS.iter().filter(|group| group.contains(&name)) {
        group.iter().for_each(|rival| node.unset(rival));
    }
    match (name, value.split_whitespace().count()) {
        // a shape and its size go together
        ("size", n @ 1..=3) => node.set("type", ["sphere", "capsule", "box"][n - 1]),
        ("fromto", _) => node.set("type", "capsule"),
        ("fluidcoef", _) => node.set("fluidshape", "ellipsoid"),
        // a matrix has no orientation of its own
        ("fullinertia", _) => RIVALS[0].iter().for_each(|rival| node.unset(rival)),
        _ => {}
    }
    node.set(name, value);
}

/// Gives a body impossible principal moments, for the one attribute that concerns them.
fn unbalance(document: &mut Node) {
    for k in 0..document.count() {
        if let Some(node) = document.nth_mut(k)
            && node.get("diaginertia").is_some()
        {
            node.set("diaginertia", "0.003 0.004 0.02");
        }
    }
}

/// Makes copies of the elements in a `<replicate>`.
fn make_copies(document: &mut Node, at: usize) {
    if let Some(node) = document.nth_mut(at)
        && node.get("count") == Some("0")
    {
        node.set("count", "2");
    }
}

/// Lists the documents of all attributes.
///
/// # Errors
/// The document with all elements lacks one.
pub fn singles(language: &Language) -> Result<Vec<Single>, String> {
    let base = Node::parse(BASE)?;
    let (mut probes, mut k) = (Vec::new(), 0);
    base.visit(&mut Vec::new(), &mut |above, node| {
        if let Some(names) = node.get("probe") {
            probes.push((listed(above), names, k));
        }
        k += 1;
    });
    let mut all = Vec::new();
    // MuJoCo hangs where the simulations diverge that look for lengths of muscles, so here all lengths are given; `length_ranges` of the suite
    // compares these settings
    let compared = |path: &str| path != "compiler/lengthrange";
    for (path, attributes) in language.elements().filter(|(path, _)| compared(path)) {
        for attribute in attributes {
            let name = attribute.name;
            let named = |names: &str| names.split_whitespace().any(|other| other == name);
            let of_path = || probes.iter().filter(|(other, ..)| other == path);
            let found = of_path().find(|(_, names, _)| named(names));
            let found = found.or_else(|| of_path().find(|(_, names, _)| names.is_empty()));
            let Some((.., at)) = found else {
                return Err(format!(
                    "conformance/src/differential/base.xml has no {path} with probe=\"\""
                ));
            };
            for value in values(path, attribute) {
                let mut document = base.clone();
                if let Some(node) = document.nth_mut(*at) {
                    set(node, name, &value);
                }
                if name == "balanceinertia" {
                    unbalance(&mut document);
                }
                if path.ends_with("/replicate") {
                    make_copies(&mut document, *at);
                }
                all.push(Single {
                    what: format!("{path}@{name}=\"{value}\""),
                    attribute: format!("{path}@{name}"),
                    alone: attribute.words.len() == 1,
                    document: unmarked(document),
                });
                if attribute.in_default && !matches!(attribute.how, How::Placed(_)) {
                    all.push(Single {
                        what: format!("default/{path}@{name}=\"{value}\""),
                        attribute: format!("default/{path}@{name}"),
                        alone: attribute.words.len() == 1,
                        document: by_default(base.clone(), *at, path, name, &value),
                    });
                }
            }
        }
    }
    Ok(all)
}

/// Moves an attribute from the element into the default class `stiff`.
fn by_default(mut document: Node, at: usize, path: &str, name: &str, value: &str) -> Node {
    if let Some(node) = document.nth_mut(at) {
        set(node, name, value);
        node.unset(name);
        node.set("class", "stiff");
    }
    let element = match path.split('/').collect::<Vec<_>>()[..] {
        ["equality", _] => "equality",
        ["tendon", _] => "tendon",
        [.., last] => last,
        [] => path,
    };
    for k in 0..document.count() {
        let Some(node) = document.nth_mut(k) else { break };
        if node.name == "default" && node.get("class") == Some("stiff") {
            match node.children.iter_mut().find(|child| child.name == element) {
                Some(child) => set(child, name, value),
                None => node.children.push(Node::new(element).with(name, value)),
            }
        }
    }
    unmarked(document)
}

/// MuJoCo's reading of a document: its model, and its steps.
#[derive(PartialEq)]
pub struct Meaning {
    model: Vec<Vec<f64>>,
    steps: Vec<Vec<f64>>,
}

/// Returns the model that MuJoCo compiles from the document without the attribute.
///
/// # Errors
/// One side refuses it.
pub fn base_meaning(api: &'static Mujoco) -> Result<Meaning, String> {
    let base = unmarked(Node::parse(BASE)?);
    match Sides::load(api, &base.to_string()) {
        Taken::Both(mut sides) => Ok(compare(&mut sides).0),
        Taken::ByOne(measured) => Err(measured.place),
        Taken::Refused(e) => Err(e),
        Taken::Stricter(reason) => Err(reason.to_owned()),
    }
}

/// Steps both sides from all states.
fn compare(sides: &mut Sides) -> (Meaning, Vec<Measured>, usize) {
    let mut differences: Vec<Measured> = sides.arrays().into_iter().filter(|m| !m.agrees()).collect();
    let (mut steps, mut states) = (Vec::new(), 0);
    for k in 0..STATES {
        let mut recipe = Recipe::new(hash(7, &format!("state {k}")));
        recipe.apart = recipe.apart.min(0.3);
        recipe.speed = recipe.speed.min(2.0);
        if let Stepped::Compared {
            measured,
            why: Why::Ours,
            ..
        } = sides.step(&recipe)
        {
            differences.extend(measured.into_iter().filter(|m| !m.agrees()));
            states += 1;
        }
        let simulation = sides.simulation();
        steps.push([simulation.qacc(), simulation.sensordata(), simulation.qvel()].concat());
    }
    let model = sides.simulation().all_model_values();
    (Meaning { model, steps }, differences, states)
}

/// Compares a document on both sides.
pub fn outcome(api: &'static Mujoco, base: &Meaning, single: &Single) -> Outcome {
    let none = |taken, matters| Outcome {
        differences: Vec::new(),
        taken,
        matters,
        states: 0,
    };
    match Sides::load(api, &single.document.to_string()) {
        Taken::Refused(_) => none(false, true),
        Taken::Stricter(_) => none(true, true),
        Taken::ByOne(measured) => Outcome {
            differences: vec![measured],
            ..none(true, true)
        },
        Taken::Both(mut sides) => {
            let (meaning, differences, states) = compare(&mut sides);
            Outcome {
                differences,
                taken: true,
                matters: meaning != *base,
                states,
            }
        }
    }
}

//! The smallest document that still differs.

use serde::{Deserialize, Serialize};

use super::compare::{Sides, Stepped, Taken, Why};
use super::node::Node;
use super::state::Recipe;
use crate::mujoco::Mujoco;

/// A difference to keep while a document shrinks: a quantity, far enough apart, in the step from a state.
#[derive(Clone, Serialize, Deserialize)]
pub struct Finding {
    /// The document.
    pub document: Node,
    /// The state, for quantities of a step.
    pub recipe: Option<Recipe>,
    /// Name of the quantity that differs.
    pub quantity: String,
    /// By how much.
    pub error: f64,
    /// Values of both sides.
    pub place: String,
}

/// Looks for a quantity that differs; returns by how much, and the values. Both sides must still accept the document.
fn differs(api: &'static Mujoco, document: &Node, recipe: Option<&Recipe>, quantity: &str) -> Option<(f64, String)> {
    let mut sides = match Sides::load(api, &document.to_string()) {
        Taken::Both(sides) => sides,
        Taken::ByOne(measured) => return (quantity == measured.quantity).then_some((measured.error, measured.place)),
        Taken::Refused(_) | Taken::Stricter(_) => return None,
    };
    let measured = match recipe {
        None => sides.arrays(),
        Some(recipe) => match sides.step(recipe) {
            Stepped::Compared {
                measured,
                why: Why::Ours,
                ..
            } => measured,
            _ => return None,
        },
    };
    let found = measured.into_iter().find(|m| m.quantity == quantity && !m.agrees());
    found.map(|m| (m.error, m.place))
}

/// Maximum number of smaller documents tried for a finding, enough for all except those with hundreds of attributes.
pub const ATTEMPTS: usize = 600;

/// Removes what the difference does not need, until nothing more can go or [`ATTEMPTS`] smaller documents were tried.
pub fn reduce(api: &'static Mujoco, finding: &Finding) -> Finding {
    let mut best = finding.clone();
    // a difference that shrinks to rounding is another one
    let enough = 0.01 * finding.error.min(1.0);
    let mut left = ATTEMPTS;
    let mut attempt = |best: &mut Finding, document: Node, recipe: Option<Recipe>| {
        if left == 0 {
            return false;
        }
        left -= 1;
        let found = differs(api, &document, recipe.as_ref(), &best.quantity);
        let Some((error, place)) = found.filter(|(error, _)| *error >= enough) else {
            return false;
        };
        (best.document, best.recipe, best.error, best.place) = (document, recipe, error, place);
        true
    };
    loop {
        let mut changed = without_elements(&mut best, &mut attempt);
        changed |= without_attributes(&mut best, &mut attempt);
        for simpler in best.recipe.map_or(Vec::new(), |recipe| recipe.simpler()) {
            let document = best.document.clone();
            changed |= attempt(&mut best, document, Some(simpler));
        }
        if !changed {
            return best;
        }
    }
}

/// Tries to make a finding smaller.
type Attempt<'a> = &'a mut dyn FnMut(&mut Finding, Node, Option<Recipe>) -> bool;

fn without_elements(best: &mut Finding, attempt: Attempt) -> bool {
    let (mut changed, mut k) = (false, 1);
    while k < best.document.count() {
        let mut smaller = best.document.clone();
        smaller.remove_nth(k);
        let recipe = best.recipe;
        if attempt(best, smaller, recipe) {
            changed = true;
        } else {
            k += 1;
        }
    }
    changed
}

fn without_attributes(best: &mut Finding, attempt: Attempt) -> bool {
    let mut changed = false;
    for k in 0..best.document.count() {
        let names = |document: &mut Node| document.nth_mut(k).map_or(Vec::new(), |node| node.attributes.clone());
        for (name, value) in names(&mut best.document) {
            let mut smaller = best.document.clone();
            let Some(node) = smaller.nth_mut(k) else { break };
            node.unset(&name);
            let recipe = best.recipe;
            if attempt(best, smaller, recipe) {
                changed = true;
                continue;
            }
            for rounder in rounder(&value) {
                let mut smaller = best.document.clone();
                let Some(node) = smaller.nth_mut(k) else { break };
                node.set(&name, rounder);
                if attempt(best, smaller, recipe) {
                    changed = true;
                    break;
                }
            }
        }
    }
    changed
}

/// Returns numbers with fewer digits, the roundest first.
fn rounder(value: &str) -> Vec<String> {
    let numbers: Option<Vec<f64>> = value.split_whitespace().map(|word| word.parse().ok()).collect();
    let Some(numbers) = numbers else { return Vec::new() };
    let round = |digits: i32| {
        let one = |v: &f64| match v.abs() {
            0.0 => 0.0,
            size => {
                let unit = 10.0_f64.powi(size.log10().floor() as i32 - digits);
                // through text, which drops what rounding left in the last bits
                format!("{:.6e}", (v / unit).round() * unit).parse().unwrap_or(*v)
            }
        };
        numbers.iter().map(|v| one(v).to_string()).collect::<Vec<_>>().join(" ")
    };
    let all = [0, 1, 2].map(round);
    all.into_iter().filter(|text| text.len() < value.len()).collect()
}

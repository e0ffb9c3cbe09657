//! The elements that the loader understands, joined with the rules by which their attributes are drawn.

use babybench::mjcf_loader::{AttributeInfo, elements};

use super::dice::Dice;
use super::node::Node;
use super::rules::{How, RIVALS, RULES, how, is_without_physics};

/// An attribute that changes physics.
#[derive(Clone)]
pub struct Attribute {
    /// Its name.
    pub name: &'static str,
    /// The way of drawing its values.
    pub how: How,
    /// The attribute's words, if it has words.
    pub words: Vec<String>,
    /// Whether its numbers may be infinite.
    pub infinite: bool,
    /// Whether a default class may set it.
    pub in_default: bool,
}

/// The elements that change physics, with their attributes.
pub struct Language {
    elements: Vec<(String, Vec<Attribute>)>,
}

/// Returns the words of an attribute; `None` for attributes with other values.
fn words(info: &AttributeInfo) -> Vec<String> {
    let word = |text: &str| !text.is_empty() && !text.contains(' ') && !["text", "numbers"].contains(&text);
    let all: Vec<String> = info.values.split(", ").map(str::to_owned).collect();
    if all.iter().all(|text| word(text)) {
        all
    } else {
        Vec::new()
    }
}

/// Lists the lines of the rules that have no counterpart in the loader's list.
pub fn stale() -> Vec<String> {
    let listed = elements();
    let mut stale = Vec::new();
    for (path, groups) in RULES {
        let element = listed.iter().find(|element| element.path == *path);
        let known = |name: &str| element.is_some_and(|element| element.attributes.iter().any(|info| info.name == name));
        let rules = groups.iter().flat_map(|group| group.iter());
        stale.extend(
            rules
                .filter(|(name, _)| !known(name))
                .map(|(name, _)| format!("{path}@{name}")),
        );
        if element.is_none() {
            stale.push((*path).to_owned());
        }
    }
    stale
}

impl Language {
    /// Joins the loader's list with the rules.
    ///
    /// # Errors
    /// The attributes that no rule knows.
    pub fn new() -> Result<Self, String> {
        let (mut known, mut missing) = (Vec::new(), Vec::new());
        for element in elements() {
            if is_without_physics(&element.path) {
                continue;
            }
            let mut attributes = Vec::new();
            for info in &element.attributes {
                match how(&element.path, info.name) {
                    None => missing.push(format!("{}@{}", element.path, info.name)),
                    Some(How::Nothing) => {}
                    Some(how) => attributes.push(Attribute {
                        name: info.name,
                        how,
                        words: words(info),
                        infinite: info.values.contains("infinities"),
                        in_default: info.in_default,
                    }),
                }
            }
            known.push((element.path, attributes));
        }
        if missing.is_empty() {
            Ok(Self { elements: known })
        } else {
            Err(format!(
                "conformance/src/differential/rules.rs does not say how these are drawn: {}",
                missing.join(", ")
            ))
        }
    }

    /// Returns all elements that change physics, by path.
    pub fn elements(&self) -> impl Iterator<Item = (&str, &[Attribute])> {
        self.elements.iter().map(|(path, all)| (path.as_str(), all.as_slice()))
    }

    /// Returns the attributes of an element that change physics.
    pub fn attributes(&self, path: &str) -> &[Attribute] {
        let found = self.elements.iter().find(|(other, _)| other == path);
        found.map_or(&[], |(_, attributes)| attributes)
    }

    /// Draws the missing attributes of an element; in a default class, only those allowed there.
    pub fn dress(&self, node: &mut Node, path: &str, in_default: bool, dice: &mut Dice) {
        let mut attributes: Vec<&Attribute> = self.attributes(path).iter().collect();
        dice.rng.shuffle(&mut attributes);
        for attribute in attributes {
            let rival = |(other, _): &(String, String)| {
                let both = |group: &&[&str]| group.contains(&attribute.name) && group.contains(&other.as_str());
                other == attribute.name || RIVALS.iter().any(both)
            };
            if in_default && !attribute.in_default || node.attributes.iter().any(rival) {
                continue;
            }
            match attribute.how {
                How::Drawn(odds, draw) if dice.chance(odds) => node.set(attribute.name, draw(dice)),
                How::Word(odds) if dice.chance(odds) => {
                    let word = &attribute.words[dice.rng.usize(..attribute.words.len())];
                    node.set(attribute.name, word.as_str());
                }
                _ => {}
            }
        }
    }
}

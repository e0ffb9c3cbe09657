//! The set of reflexes of a configuration.

use super::choices::Reflex;

/// A set of reflexes (`reflexes`): none, a list of names, or those of MIMo's age.
///
/// ```
/// use babybench::config::{Reflex, ReflexSet};
/// use babybench::Config;
///
/// let config = Config::from_yaml("reflexes: [vor, stretch]", "example.yml")?;
/// assert_eq!(config.reflexes.set, ReflexSet::new([Reflex::Stretch, Reflex::Vor]));
/// assert!(!config.reflexes.set.contains(Reflex::Moro));
/// # Ok::<(), babybench::config::ConfigError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ReflexSet {
    named: [bool; Reflex::ALL.len()],
    by_age: bool,
}

impl ReflexSet {
    /// The reflexes that are present at MIMo's age.
    pub const BY_AGE: Self = Self {
        named: [false; Reflex::ALL.len()],
        by_age: true,
    };
    /// The names in a configuration file.
    pub const NAMES: &'static [&'static str] = &{
        let mut names = [BY_AGE; Reflex::ALL.len() + 1];
        let mut k = 0;
        while k < Reflex::ALL.len() {
            names[k] = Reflex::NAMES[k];
            k += 1;
        }
        names
    };

    /// Creates a set of named reflexes.
    pub fn new(reflexes: impl IntoIterator<Item = Reflex>) -> Self {
        let mut set = Self::default();
        for reflex in reflexes {
            set.named[reflex as usize] = true;
        }
        set
    }

    /// Returns whether there are no reflexes at any age.
    pub fn is_empty(self) -> bool {
        self == Self::default()
    }

    /// Returns whether the set follows MIMo's age.
    pub const fn follows_age(self) -> bool {
        self.by_age
    }

    /// Returns whether a reflex is named.
    pub const fn contains(self, reflex: Reflex) -> bool {
        self.named[reflex as usize]
    }

    /// Returns whether a reflex is named, or may be among those of an age.
    pub(super) fn may_have(self, reflex: Reflex) -> bool {
        self.by_age || self.contains(reflex)
    }

    /// Returns whether reflexes are named in addition to those of the age. That combination has no meaning.
    pub(super) fn is_mixed(self) -> bool {
        self.by_age && self.named.contains(&true)
    }

    /// Lists the names.
    pub(super) fn names(self) -> Vec<&'static str> {
        let named = Reflex::ALL.iter().filter(|&&reflex| self.contains(reflex));
        let mut names: Vec<_> = named.map(|reflex| reflex.name()).collect();
        if self.by_age {
            names.push(BY_AGE);
        }
        names
    }

    /// Creates a set from names; `None` if one is unknown.
    pub(super) fn from_names(names: &[&str]) -> Option<Self> {
        let mut set = Self::default();
        for name in names {
            if *name == BY_AGE {
                set.by_age = true;
            } else {
                set.named[Reflex::from_name(name)? as usize] = true;
            }
        }
        Some(set)
    }
}

/// The name of the set that follows MIMo's age.
const BY_AGE: &str = "by_age";

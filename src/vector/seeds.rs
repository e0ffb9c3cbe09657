//! Seeds of a reset.

/// Seeds of all environments, as Gymnasium's `reset(seed=...)` takes them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Seeds<'a> {
    /// No seed: every environment continues with its generator.
    #[default]
    Keep,
    /// One seed: environment i gets the seed plus i.
    From(u64),
    /// A seed, or none, for each environment (N).
    Each(&'a [Option<u64>]),
}

impl Seeds<'_> {
    /// Returns the seed of an environment.
    pub(super) fn of(&self, env: usize) -> Option<u64> {
        match self {
            Self::Keep => None,
            Self::From(seed) => Some(seed.wrapping_add(env as u64)),
            Self::Each(list) => list.get(env).copied().flatten(),
        }
    }
}

impl From<u64> for Seeds<'_> {
    fn from(seed: u64) -> Self {
        Self::From(seed)
    }
}

impl From<Option<u64>> for Seeds<'_> {
    fn from(seed: Option<u64>) -> Self {
        seed.map_or(Self::Keep, Self::From)
    }
}

impl<'a> From<&'a [Option<u64>]> for Seeds<'a> {
    fn from(list: &'a [Option<u64>]) -> Self {
        Self::Each(list)
    }
}

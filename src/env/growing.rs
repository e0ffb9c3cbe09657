//! Growth by a schedule of ages.

use super::{Blueprint, Env, EnvError, Snapshot};
use crate::spaces::{BoxSpace, ObservationSpace};

/// The greatest number of steps of an environment: no run reaches it, and counting from it cannot overflow.
const MAX_STEPS: u64 = 1 << 62;

impl Env {
    /// Returns the number of steps since the environment was made, over all episodes, which a schedule of ages counts.
    pub(crate) fn lifetime_steps(&self) -> u64 {
        self.episode.earlier_steps + self.episode.steps
    }

    /// Sets the number of steps before the current episode; `false` if it is out of range.
    pub(crate) fn set_earlier_steps(&mut self, steps: u64) -> bool {
        let fits = steps <= MAX_STEPS;
        if fits {
            self.episode.earlier_steps = steps;
        }
        fits
    }

    /// Returns whether MIMo grows by a schedule.
    pub(crate) fn grows(&self) -> bool {
        !self.config().age_schedule.is_empty()
    }

    /// Lets MIMo grow to the age at which an episode begins now, if that differs from his age.
    ///
    /// # Errors
    /// As [`Blueprint::with_age`]; [`EnvError::Spaces`]. They change nothing.
    pub(crate) fn grow(&mut self) -> Result<(), EnvError> {
        let config = self.config();
        let due = config.age_schedule.at(self.lifetime_steps(), config.age_grid);
        if due.is_none() || due == config.age {
            return Ok(());
        }
        let blueprint = self.blueprint.at_age(due)?;
        self.grow_into(&blueprint).map(drop)
    }

    /// Lets a MIMo with a schedule grow to the age of an episode that is repeated.
    ///
    /// # Errors
    /// As [`Env::grow`].
    #[cfg(all(feature = "eval", feature = "npz"))]
    pub(crate) fn grow_to(&mut self, age: Option<f64>) -> Result<(), EnvError> {
        let blueprint = self.blueprint.at_age(age)?;
        self.grow_into(&blueprint).map(drop)
    }

    /// Becomes an environment of a blueprint of another age. Returns the previous one.
    fn grow_into(&mut self, blueprint: &Blueprint) -> Result<Self, EnvError> {
        let grown = blueprint.env()?;
        let spaces = self.observation_space();
        if let Some((what, before, after)) = space_difference(self.action_space(), &spaces, &grown) {
            let age = blueprint.config().age.unwrap_or_default();
            return Err(EnvError::Spaces {
                age,
                what,
                before,
                after,
            });
        }
        Ok(self.become_grown(grown))
    }

    /// Lets MIMo grow to the age of a snapshot that was taken on his schedule. Returns the previous environment, if it changed.
    pub(super) fn grow_for(&mut self, snapshot: &Snapshot, keys: &str) -> Option<Self> {
        if !self.grows() || snapshot.fingerprint() == Some(self.blueprint.identity().fingerprint) {
            return None;
        }
        // a snapshot is not trusted: an age that the configuration excludes is an error of the blueprint
        let age = keys.lines().find_map(|line| line.strip_prefix("age: "))?.parse().ok()?;
        let blueprint = self.blueprint.at_age(Some(age)).ok()?;
        if snapshot.fingerprint() != Some(blueprint.identity().fingerprint) {
            return None;
        }
        self.grow_into(&blueprint).ok()
    }

    /// Becomes the environment that [`Env::grow_for`] returned.
    pub(super) fn shrink_back(&mut self, before: Self) {
        let episode = before.episode;
        self.become_grown(before);
        // `become_grown` counts the steps of this episode as earlier ones, as if it had ended
        self.episode = episode;
    }
}

/// A difference between the spaces of an environment and those of others: the space, their value, its own.
pub(crate) type SpaceDifference = (String, String, String);

/// Returns how an environment differs from those with which it will share arrays.
pub(crate) fn space_difference(a: &BoxSpace, spaces: &[ObservationSpace], env: &Env) -> Option<SpaceDifference> {
    let b = env.action_space();
    if a.len() != b.len() {
        let shapes = [a, b].map(|space| format!("[{}]", space.len()));
        let [expected, found] = shapes;
        return Some(("the action space".to_string(), expected, found));
    }
    let bounds = |s: &BoxSpace, k: usize| (s.low()[k], s.high()[k]);
    if let Some(k) = (0..a.len()).find(|&k| bounds(a, k) != bounds(b, k)) {
        let [expected, found] = [a, b].map(|space| format!("{:?}", bounds(space, k)));
        return Some((format!("the bounds of action[{k}]"), expected, found));
    }
    let own = env.observation_space();
    let describe = |s: Option<&ObservationSpace>| match s {
        Some(s) => format!("{:?} of {:?} in [{}, {}]", s.shape, s.dtype, s.low, s.high),
        None => "none".to_string(),
    };
    spaces.iter().chain(&own).map(|s| s.key).find_map(|key| {
        let [a, b] = [spaces, &own].map(|spaces| spaces.iter().find(|s| s.key == key));
        (a != b).then(|| (format!("the observation {key:?}"), describe(a), describe(b)))
    })
}

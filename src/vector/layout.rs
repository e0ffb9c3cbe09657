//! The lengths of a vector's rows.

use crate::config::Reflex;
use crate::env::Env;
use crate::sensors::ObservationEntry;
use crate::sensors::transform::Sense;

/// Lengths of the rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct RowLayout {
    pub action: usize,
    /// Length of each entry of the observation, in the order of [`ObservationEntry::ALL`]; `None` for missing entries.
    pub entries: [Option<usize>; ObservationEntry::ALL.len()],
    /// Number of touch sensors.
    pub sensors: usize,
    /// Number of geoms of the largest scene, if any environment's behavior is `self_touch`.
    pub geoms: Option<usize>,
    /// Whether any environment's behavior is `hand_regard`.
    pub regards: bool,
    /// Whether the eyes have their own rate.
    pub ages: bool,
    /// Whether any MIMo has a schedule of ages.
    pub grows: bool,
    /// The reflexes that any environment has.
    pub reflexes: [bool; Reflex::ALL.len()],
    /// Number of terms of the rewards, if the tasks report outcomes.
    pub terms: Option<usize>,
}

impl RowLayout {
    /// Computes the layout of environments whose spaces are the same.
    pub fn new<'e>(envs: impl IntoIterator<Item = &'e Env>) -> Self {
        let mut layout = Self::default();
        for env in envs {
            layout.action = env.action_space().len();
            layout.entries = env.observation().values().map(|values| values.map(|v| v.len()));
            layout.sensors = env.senses().touch().map_or(0, |touch| touch.layout().len());
            layout.regards |= env.info().behavior.regards().is_some();
            layout.ages |= env.config().vision_active && env.config().vision_rate.is_some();
            layout.grows |= env.grows();
            for reflex in env.reflexes() {
                layout.reflexes[reflex as usize] = true;
            }
            layout.terms = env.info().behavior.task().is_some().then(|| env.goal().terms.len());
            if env.info().behavior.touches().is_some() {
                layout.geoms = layout.geoms.max(Some(env.model().ngeom()));
            }
        }
        layout
    }

    /// Returns the length of touch, if it is observed.
    pub fn touch(&self) -> Option<usize> {
        let at = ObservationEntry::ALL
            .iter()
            .position(|entry| entry.sense == Some(Sense::Touch));
        self.entries[at?]
    }

    /// Returns the size of a row of all arrays, bytes.
    pub fn row_bytes(&self) -> usize {
        let entries = ObservationEntry::ALL.iter().zip(self.entries);
        let observed: usize = entries
            .map(|(entry, len)| entry.dtype.bytes() * len.unwrap_or_default())
            .sum();
        let [geoms, terms] = [self.geoms, self.terms].map(Option::unwrap_or_default);
        observed + 8 * terms + 4 * self.sensors + 2 * geoms + 64
    }
}

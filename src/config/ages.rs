//! The keys of a growing MIMo: `age` also accepts a schedule.

use super::kinds::{KeyKind, KeyValue};
use super::schedule::AgeSchedule;
use super::table::{Config, KEYS, Key};

/// The greatest length of ages over steps as text, bytes: that of [`AgeSchedule::MAX_POINTS`] long numbers.
pub(super) const MAX_TEXT: usize = 64 * AgeSchedule::MAX_POINTS;

/// Returns the key of ages over steps.
pub(super) fn schedule() -> &'static Key {
    &KEYS[schedule_index()]
}

/// Returns its index.
pub(super) fn schedule_index() -> usize {
    let mut keys = KEYS.iter();
    let found = keys.position(|key| matches!(key.kind, KeyKind::NoneOrAges { .. }));
    found.unwrap_or_default()
}

/// Returns whether a key may have a mapping of ages over steps.
pub(super) fn takes_ages(key: &Key) -> bool {
    key.name == "age" || matches!(key.kind, KeyKind::NoneOrAges { .. })
}

/// Returns the index of the key that a value belongs to: `age: {0: 1, 500000: 6}` is a schedule.
pub(super) fn of_value(index: usize, value: &KeyValue) -> usize {
    if KEYS[index].name == "age" && matches!(value, KeyValue::Text(_)) {
        schedule_index()
    } else {
        index
    }
}

impl Config {
    /// Gives MIMo an age that he keeps, in place of a schedule.
    pub(crate) fn keep_age(&mut self, age: Option<f64>) {
        let still = Self::default();
        (self.age, self.age_schedule, self.age_grid) = (age, still.age_schedule, still.age_grid);
    }
}

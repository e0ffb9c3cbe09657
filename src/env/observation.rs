//! The results of a step: the observation, and the rest in Gymnasium's order.

use super::Info;
use crate::sensors::{ObservationEntry, observation_entries};
use crate::spaces::{Number, Values};

macro_rules! observation {
    (
        { $(#[$first_doc:meta])* $first:ident: $first_type:ty, $first_bounds:expr, $first_source:expr; }
        $($(#[$doc:meta])* $field:ident: $type:ty, $bounds:expr, $source:expr;)*
    ) => {
        /// The observation: what MIMo senses. The vectors belong to the environment and change with the next step.
        ///
        /// Every entry is a field. [`Observation::entries`] iterates over the existing ones, for programs that treat them alike:
        ///
        /// ```
        /// use babybench::{Config, Env};
        ///
        /// let mut env = Env::new(Config { vision_active: false, ..Config::default() })?;
        /// let keys: Vec<&str> = env.reset(Some(0))?.entries().map(|(entry, _)| entry.key).collect();
        /// assert_eq!(keys, ["observation", "touch", "vestibular"]);
        /// # Ok::<(), babybench::EnvError>(())
        /// ```
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Observation<'a> {
            $(#[$first_doc])*
            pub $first: &'a [$first_type],
            $($(#[$doc])* pub $field: Option<&'a [$type]>,)*
        }

        impl<'a> Observation<'a> {
            /// Makes an observation from the numbers that `values` returns for each entry, in the order of [`ObservationEntry::ALL`].
            /// Numbers whose type differs from the entry's are left out.
            pub fn from_fn(mut values: impl FnMut(&'static ObservationEntry) -> Option<Values<'a>>) -> Self {
                let mut entries = ObservationEntry::ALL.iter();
                let mut next = || entries.next().and_then(&mut values);
                Self {
                    $first: next().and_then(<$first_type>::of).unwrap_or_default(),
                    $($field: next().and_then(<$type>::of),)*
                }
            }

            /// Returns the numbers of each entry, in the order of [`ObservationEntry::ALL`]; `None` for missing entries.
            pub fn values(&self) -> [Option<Values<'a>>; ObservationEntry::ALL.len()] {
                [Some(self.$first.into()), $(self.$field.map(Values::from)),*]
            }
        }
    };
}
observation_entries!(observation);

impl<'a> Observation<'a> {
    /// Iterates over the existing entries and their numbers.
    pub fn entries(&self) -> impl Iterator<Item = (&'static ObservationEntry, Values<'a>)> {
        let all = ObservationEntry::ALL.iter().zip(self.values());
        all.filter_map(|(entry, values)| Some((entry, values?)))
    }

    /// Returns the numbers under a key, if it exists.
    pub fn get(&self, key: &str) -> Option<Values<'a>> {
        self.entries()
            .find(|(entry, _)| entry.key == key)
            .map(|(_, values)| values)
    }

    /// Returns row `row` of observations that are arrays of `rows` rows.
    pub(crate) fn row(&self, row: usize, rows: usize) -> Self {
        let mut values = self.values().into_iter();
        Self::from_fn(|_| Some(values.next()??.row(row, rows)))
    }
}

/// The result of a step, in Gymnasium's order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<'a> {
    /// The observation.
    pub observation: Observation<'a>,
    /// The reward of the task; 0 for BabyBench's behaviors, which have no extrinsic reward.
    pub reward: f64,
    /// Whether the task has succeeded or failed, if `done_active`; false for BabyBench's behaviors.
    pub terminated: bool,
    /// Whether the episode has reached `max_episode_steps`.
    pub truncated: bool,
    /// The information.
    pub info: &'a Info,
}

impl Step<'_> {
    /// Returns whether the episode is over: terminated or truncated.
    pub fn over(&self) -> bool {
        self.terminated || self.truncated
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spaces::Array;

    #[test]
    fn every_entry_is_a_field_of_its_type() {
        let arrays: Vec<Array> = ObservationEntry::ALL
            .iter()
            .enumerate()
            .map(|(k, entry)| Array::zeros(entry.dtype, 2 * (k + 1)))
            .collect();
        let mut all = arrays.iter();
        let observation = Observation::from_fn(|_| all.next().map(Array::values));
        assert_eq!(observation.entries().count(), ObservationEntry::ALL.len());
        for (k, entry) in ObservationEntry::ALL.iter().enumerate() {
            assert_eq!(ObservationEntry::of_key(entry.key), Some(entry));
            let values = observation.get(entry.key).expect(entry.key);
            assert_eq!(
                (values.len(), values.dtype()),
                (2 * (k + 1), entry.dtype),
                "{}",
                entry.key
            );
            let row = observation.row(1, 2).get(entry.key).expect(entry.key);
            assert_eq!(row, arrays[k].first(k + 1), "{}", entry.key);
        }
        let fields = [
            observation.vestibular.map(<[f64]>::len),
            observation.desired_goal.map(<[f64]>::len),
        ];
        let at = |key| ObservationEntry::ALL.iter().position(|entry| entry.key == key);
        assert_eq!(
            fields,
            ["vestibular", "desired_goal"].map(|key| Some(2 * (at(key)? + 1)))
        );
    }

    #[test]
    fn numbers_of_another_type_are_left_out() {
        let numbers = [1.5];
        let observation = Observation::from_fn(|_| Some(Values::F64(&numbers)));
        assert_eq!(
            (observation.touch, observation.eye_left, observation.vestibular),
            (None, None, Some(&numbers[..]))
        );
        assert_eq!(
            Observation::default().entries().count(),
            1,
            "proprioception is always there"
        );
    }
}

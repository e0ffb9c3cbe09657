//! Caller-owned buffers for the results of a step of a vector.

use super::VectorError;
use super::layout::RowLayout;
use crate::env::{Env, Observation};
use crate::sensors::transform::Sense;
use crate::sensors::{ObservationEntry, observation_entries};
use crate::spaces::{Number, ValuesMut};

macro_rules! buffers {
    (
        { $(#[$first_doc:meta])* $first:ident: $first_type:ty, $first_bounds:expr, $first_source:expr; }
        $($(#[$doc:meta])* $field:ident: $type:ty, $bounds:expr, $source:expr;)*
    ) => {
        /// Caller-owned buffers for the results of a step: arrays of N rows each, environment after environment.
        ///
        /// Entries that are `None` are left out.
        #[derive(Debug, Default)]
        pub struct Buffers<'a> {
            #[doc = concat!("[`Observation::", stringify!($first), "`], (N, len).")]
            pub $first: Option<&'a mut [$first_type]>,
            $(
                #[doc = concat!("[`Observation::", stringify!($field), "`], (N, len).")]
                pub $field: Option<&'a mut [$type]>,
            )*
            /// Rewards (N).
            pub rewards: Option<&'a mut [f64]>,
            /// Whether episodes were terminated by success or failure (N).
            pub terminated: Option<&'a mut [bool]>,
            /// Whether episodes were truncated (N).
            pub truncated: Option<&'a mut [bool]>,
            /// For each row of `touch` (N), the sensors that are nonzero there. If you keep both from call to call, only active sensors are written
            /// instead of thousands of zeros. Start with zeros and empty lists.
            pub touched: Option<&'a mut [Vec<u32>]>,
        }

        impl<'a> Buffers<'a> {
            /// Makes buffers from the memory that `values` returns for each entry of the observation, in the order of
            /// [`ObservationEntry::ALL`]. Memory whose type differs from the entry's is left out.
            pub fn from_fn(mut values: impl FnMut(&'static ObservationEntry) -> Option<ValuesMut<'a>>) -> Self {
                let mut entries = ObservationEntry::ALL.iter();
                let mut next = || entries.next().and_then(&mut values);
                Self {
                    $first: next().and_then(<$first_type>::of_mut),
                    $($field: next().and_then(<$type>::of_mut),)*
                    ..Self::default()
                }
            }

            /// Returns the memory for each entry, in the order of [`ObservationEntry::ALL`].
            fn values(&mut self) -> [Option<ValuesMut<'_>>; ObservationEntry::ALL.len()] {
                [self.$first.as_deref_mut().map(ValuesMut::from), $(self.$field.as_deref_mut().map(ValuesMut::from)),*]
            }
        }
    };
}
observation_entries!(buffers);

impl Buffers<'_> {
    /// Checks that every buffer has exactly `n` rows.
    pub(super) fn check(&mut self, n: usize, layout: &RowLayout) -> Result<(), VectorError> {
        fn length<T>(buffer: &Option<&mut [T]>) -> Option<usize> {
            buffer.as_ref().map(|b| b.len())
        }
        let others = [
            ("rewards", length(&self.rewards), Some(1)),
            ("terminated", length(&self.terminated), Some(1)),
            ("truncated", length(&self.truncated), Some(1)),
            ("touched", length(&self.touched), layout.touch().map(|_| 1)),
        ];
        let entries = ObservationEntry::ALL.iter().zip(self.values()).zip(layout.entries);
        let entries = entries.map(|((entry, values), len)| (entry.field, values.map(|v| v.len()), len));
        for (what, found, len) in entries.chain(others) {
            let Some(found) = found else { continue };
            let Some(len) = len else {
                return Err(VectorError::NoSense { what });
            };
            if found != n * len {
                let expected = [n, len];
                return Err(VectorError::Shape { what, expected, found });
            }
        }
        Ok(())
    }

    /// Writes the observation of an environment. Copies only the active touch sensors where that suffices. The
    /// lengths were checked before.
    pub(super) fn write(&mut self, row: usize, env: &Env) {
        let observation = env.observation();
        let (Some(touched), Some(out), Some(touch)) =
            (&mut self.touched, &mut self.touch, env.senses().touch_observed())
        else {
            return self.write_whole(row, &observation);
        };
        let (touched, width, values) = (&mut touched[row], touch.width(), touch.values());
        let out = &mut out[row * values.len()..(row + 1) * values.len()];
        let of = |sensor: u32| width * sensor as usize..width * (sensor as usize + 1);
        for &sensor in &*touched {
            // the caller's lists may hold anything
            if let Some(out) = out.get_mut(of(sensor)) {
                out.fill(0.0);
            }
        }
        touched.clear();
        touched.extend_from_slice(touch.touched());
        for &sensor in &*touched {
            out[of(sensor)].copy_from_slice(&values[of(sensor)]);
        }
        self.write_entries(row, &observation, |entry| entry.sense != Some(Sense::Touch));
    }

    /// Writes a row from an observation that environments no longer hold. Do not mix it with [`Buffers::write`].
    pub(super) fn write_whole(&mut self, row: usize, observation: &Observation<'_>) {
        self.write_entries(row, observation, |_| true);
    }

    /// Writes the images of a row.
    pub(super) fn write_images(&mut self, row: usize, env: &Env) {
        self.write_entries(row, &env.observation(), |entry| entry.image.is_some());
    }

    pub(super) fn write_flags(&mut self, row: usize, reward: f64, terminated: bool, truncated: bool) {
        if let Some(rewards) = &mut self.rewards {
            rewards[row] = reward;
        }
        for (flags, flag) in [(&mut self.terminated, terminated), (&mut self.truncated, truncated)] {
            if let Some(flags) = flags {
                flags[row] = flag;
            }
        }
    }

    /// Writes a row of the chosen entries, if they exist and have buffers.
    fn write_entries(&mut self, row: usize, observation: &Observation<'_>, chosen: impl Fn(&ObservationEntry) -> bool) {
        let observed = ObservationEntry::ALL.iter().zip(observation.values());
        for (out, (entry, values)) in self.values().into_iter().zip(observed) {
            if let (Some(out), Some(values)) = (out, values.filter(|_| chosen(entry))) {
                out.write_row(row, values);
            }
        }
    }
}

//! The values of a sense between two samples, if it samples less often than the environment steps.

use super::{DelayValues, Signal};
use crate::sensors::{EyeImages, SkinValues};

/// The values that a sense had when it last sampled.
#[derive(Clone, Debug)]
pub(crate) struct SampleHold {
    kept: HeldValues,
}

#[derive(Clone, Debug)]
enum HeldValues {
    Numbers(Vec<f64>),
    Skin(Box<SkinValues>),
    Eye(Box<EyeImages>),
}

impl SampleHold {
    /// Reserves signals of the size of `like`, whose values are ignored.
    pub fn new(like: &Signal<'_>) -> Self {
        let kept = match like {
            Signal::Numbers(values) => HeldValues::Numbers(vec![0.0; values.len()]),
            Signal::Skin(values) => HeldValues::Skin(Box::new(SkinValues::new(values.sensors(), values.width()))),
            Signal::Eye { images, .. } => HeldValues::Eye(Box::new(EyeImages::clone(images))),
        };
        Self { kept }
    }

    /// Stores the sample that the sense has just taken.
    pub fn keep(&mut self, signal: &Signal<'_>) {
        match (&mut self.kept, signal) {
            (HeldValues::Numbers(kept), Signal::Numbers(values)) if kept.len() == values.len() => {
                kept.copy_from_slice(values)
            }
            (HeldValues::Skin(kept), Signal::Skin(values)) => kept.copy_from(values),
            (HeldValues::Eye(kept), Signal::Eye { images, .. }) => kept.copy_from(images),
            _ => {}
        }
    }

    /// Replaces the values by the kept ones.
    pub fn show(&self, signal: &mut Signal<'_>) {
        match (&self.kept, signal) {
            (HeldValues::Numbers(kept), Signal::Numbers(values)) if kept.len() == values.len() => {
                values.copy_from_slice(kept)
            }
            (HeldValues::Skin(kept), Signal::Skin(values)) => values.copy_from(kept),
            (HeldValues::Eye(kept), Signal::Eye { images, .. }) => images.copy_from(kept),
            _ => {}
        }
    }

    /// Appends the stored sample, for a snapshot.
    pub fn save(&self, out: &mut Vec<u8>) {
        match &self.kept {
            HeldValues::Numbers(kept) => kept.save(out),
            HeldValues::Skin(kept) => kept.save(out),
            HeldValues::Eye(kept) => kept.save(out),
        }
    }

    /// Restores what [`SampleHold::save`] wrote; `false` if the bytes do not fit.
    pub fn load(&mut self, mut bytes: &[u8]) -> bool {
        let bytes = &mut bytes;
        let loaded = match &mut self.kept {
            HeldValues::Numbers(kept) => kept.load(bytes),
            HeldValues::Skin(kept) => kept.load(bytes),
            HeldValues::Eye(kept) => kept.load(bytes),
        };
        loaded && bytes.is_empty()
    }

    /// Returns the memory that it takes, bytes.
    pub fn memory(&self) -> usize {
        match &self.kept {
            HeldValues::Numbers(kept) => kept.memory(),
            HeldValues::Skin(kept) => kept.memory(),
            HeldValues::Eye(kept) => kept.memory(),
        }
    }
}

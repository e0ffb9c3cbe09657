//! The values of a sense between two samples, if it samples less often than the environment steps.

use super::{Signal, Waiting};
use crate::sensors::{EyeImages, SkinValues};

/// The values that a sense had when it looked last.
#[derive(Clone, Debug)]
pub(crate) struct Hold {
    kept: Kept,
}

#[derive(Clone, Debug)]
enum Kept {
    Numbers(Vec<f64>),
    Skin(Box<SkinValues>),
    Eye(Box<EyeImages>),
}

impl Hold {
    /// Reserves signals of the size of `like`, whose values are ignored.
    pub fn new(like: &Signal<'_>) -> Self {
        let kept = match like {
            Signal::Numbers(values) => Kept::Numbers(vec![0.0; values.len()]),
            Signal::Skin(values) => Kept::Skin(Box::new(SkinValues::new(values.sensors(), values.width()))),
            Signal::Eye { images, .. } => Kept::Eye(Box::new(EyeImages::clone(images))),
        };
        Self { kept }
    }

    /// Keeps what the sense has just seen.
    pub fn keep(&mut self, signal: &Signal<'_>) {
        match (&mut self.kept, signal) {
            (Kept::Numbers(kept), Signal::Numbers(values)) if kept.len() == values.len() => {
                kept.copy_from_slice(values)
            }
            (Kept::Skin(kept), Signal::Skin(values)) => kept.copy_from(values),
            (Kept::Eye(kept), Signal::Eye { images, .. }) => kept.copy_from(images),
            _ => {}
        }
    }

    /// Shows what was kept.
    pub fn show(&self, signal: &mut Signal<'_>) {
        match (&self.kept, signal) {
            (Kept::Numbers(kept), Signal::Numbers(values)) if kept.len() == values.len() => {
                values.copy_from_slice(kept)
            }
            (Kept::Skin(kept), Signal::Skin(values)) => values.copy_from(kept),
            (Kept::Eye(kept), Signal::Eye { images, .. }) => images.copy_from(kept),
            _ => {}
        }
    }

    /// Appends what is kept, for a snapshot.
    pub fn save(&self, out: &mut Vec<u8>) {
        match &self.kept {
            Kept::Numbers(kept) => kept.save(out),
            Kept::Skin(kept) => kept.save(out),
            Kept::Eye(kept) => kept.save(out),
        }
    }

    /// Restores what [`Hold::save`] wrote; `false` if the bytes do not fit.
    pub fn load(&mut self, mut bytes: &[u8]) -> bool {
        let bytes = &mut bytes;
        let loaded = match &mut self.kept {
            Kept::Numbers(kept) => kept.load(bytes),
            Kept::Skin(kept) => kept.load(bytes),
            Kept::Eye(kept) => kept.load(bytes),
        };
        loaded && bytes.is_empty()
    }

    /// Returns the memory that it takes, bytes.
    pub fn memory(&self) -> usize {
        match &self.kept {
            Kept::Numbers(kept) => kept.memory(),
            Kept::Skin(kept) => kept.memory(),
            Kept::Eye(kept) => kept.memory(),
        }
    }
}

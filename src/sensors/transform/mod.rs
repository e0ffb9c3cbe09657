//! Transforms between a sense and the observation, applied one after the other to the sense's values.
//!
//! A transform is a small type that changes the values of one sense in place. The configuration sets up those of this
//! module; [`SensesMut::add_transform`](crate::env::SensesMut::add_transform) adds others, such as eyes that see nothing half of the time:
//!
//! ```
//! use babybench::sensors::transform::{Sense, Signal, Transform};
//! use babybench::spaces::NumpyRng;
//! use babybench::{Config, Env};
//!
//! #[derive(Clone)]
//! struct Blink;
//!
//! impl Transform for Blink {
//!     fn describe(&self) -> String {
//!         "blink".to_string()
//!     }
//!     fn apply(&mut self, signal: Signal<'_>, rng: &mut NumpyRng) {
//!         if let (Signal::Eye { images, .. }, true) = (signal, rng.uniform() < 0.5) {
//!             images.rgb.fill(0);
//!         }
//!     }
//! }
//!
//! let mut env = Env::new(Config { touch_active: false, ..Config::default() })?;
//! env.senses_mut().add_transform(Sense::EyeLeft, Box::new(Blink))?;
//! let black = |env: &Env| env.observation().eye_left.is_some_and(|image| image.iter().all(|&v| v == 0));
//! let blinks = (0..20).filter(|&seed| env.reset(Some(seed)).is_ok() && black(&env)).count();
//! assert!((1..20).contains(&blinks));
//! # Ok::<(), babybench::EnvError>(())
//! ```

mod acuity;
mod delay;
mod fourier;
mod foveation;
mod hold;
mod noise;

pub use acuity::{Acuity, AcuityOptions, acuity_cutoff};
pub(super) use delay::DelayValues;
pub use delay::{Delay, DelayLine};
pub use foveation::Foveation;
pub(crate) use hold::SampleHold;
pub use noise::Noise;

use super::{EyeImages, SkinValues};
pub use crate::sensors::sense::Sense;
use crate::spaces::NumpyRng;

/// The values of a sense in one step, for changes in place.
#[derive(Debug)]
#[non_exhaustive]
pub enum Signal<'a> {
    /// Proprioception, balance, pooled touch.
    Numbers(&'a mut [f64]),
    /// Touch and pain. Sensors that are not in its list are zero.
    Skin(&'a mut SkinValues),
    /// The images of an eye that are observed.
    Eye {
        /// The images; those that are not observed are empty.
        images: &'a mut EyeImages,
        /// Rows.
        height: usize,
        /// Columns.
        width: usize,
    },
}

impl Signal<'_> {
    /// Reborrows the signal for a function that takes ownership of it.
    pub fn reborrow(&mut self) -> Signal<'_> {
        match self {
            Self::Numbers(values) => Signal::Numbers(values),
            Self::Skin(values) => Signal::Skin(values),
            Self::Eye { images, height, width } => Signal::Eye {
                images,
                height: *height,
                width: *width,
            },
        }
    }
}

/// A transform of one sense of one environment. It must not allocate after its first steps.
pub trait Transform: CloneTransform + Send + Sync {
    /// Describes it in a few words, with units, for `inspect`.
    fn describe(&self) -> String;

    /// Changes the values of the sense. Random numbers come from the generator of the environment, so the same seed gives the same bits.
    fn apply(&mut self, signal: Signal<'_>, rng: &mut NumpyRng);

    /// Clears its memory, at the start of an episode.
    fn reset(&mut self) {}

    /// Appends its memory, for a snapshot.
    fn save(&self, out: &mut Vec<u8>) {
        let _ = out;
    }

    /// Restores the memory that [`Transform::save`] wrote. Returns `false` if the bytes do not fit.
    fn load(&mut self, bytes: &[u8]) -> bool {
        bytes.is_empty()
    }

    /// Returns its memory, bytes, from which a vector computes how many environments fit.
    fn memory(&self) -> usize {
        0
    }
}

/// Makes transforms behind a pointer cloneable; every [`Transform`] that is [`Clone`] has it.
pub trait CloneTransform {
    /// Returns a copy with the same memory.
    fn clone_transform(&self) -> Box<dyn Transform>;
}

impl<T: Transform + Clone + 'static> CloneTransform for T {
    fn clone_transform(&self) -> Box<dyn Transform> {
        Box::new(self.clone())
    }
}

impl Clone for Box<dyn Transform> {
    fn clone(&self) -> Self {
        (**self).clone_transform()
    }
}

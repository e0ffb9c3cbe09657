//! The contents of an observation: the senses, and the entries that they report. The types of observations, their arrays in vectors, their
//! keys and types in files, in Python and in JavaScript follow from the two tables here.

use crate::config::latencies;
use crate::config::{Config, VisionOutput};
use crate::spaces::{Dtype, Number};

macro_rules! senses {
    ($($(#[$doc:meta])* $sense:ident = $key:literal, $switch:literal;)*) => {
        /// A sense whose values can be transformed. The order is that in which senses are transformed in each step.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Sense {
            $($(#[$doc])* #[doc = concat!("The key `", $key, "`.")] $sense,)*
        }

        impl Sense {
            /// Every sense, in order.
            pub const ALL: [Self; [$($key),*].len()] = [$(Self::$sense),*];

            /// Returns its key in the observation; for an eye, that of the colour image.
            pub const fn key(self) -> &'static str {
                match self {
                    $(Self::$sense => $key,)*
                }
            }

            /// Returns the key of the configuration that turns it on; proprioception is always on.
            pub const fn switch(self) -> &'static str {
                match self {
                    $(Self::$sense => $switch,)*
                }
            }
        }
    };
}

senses! {
    /// Joints and actuators.
    Proprioception = "observation", "";
    /// The skin.
    Touch = "touch", "touch_active";
    /// The skin, pooled over whole parts.
    TouchPooled = "touch_pooled", "touch_pooled";
    /// Pain.
    Pain = "pain", "pain_active";
    /// Balance.
    Vestibular = "vestibular", "vestibular_active";
    /// The left eye.
    EyeLeft = "eye_left", "vision_active";
    /// The right eye.
    EyeRight = "eye_right", "vision_active";
    /// How strongly reflexes act.
    Reflexes = "reflexes", "reflex_observed";
}

impl Sense {
    /// The two eyes, left and right.
    pub const EYES: [Self; 2] = [Self::EyeLeft, Self::EyeRight];

    /// Returns the standard deviation of the noise that a configuration gives it.
    pub(crate) fn noise(self, config: &Config) -> f64 {
        match self {
            Self::Proprioception => config.noise.proprioception,
            Self::Touch => config.noise.touch,
            Self::TouchPooled | Self::Pain | Self::Reflexes => 0.0,
            Self::Vestibular => config.noise.vestibular,
            Self::EyeLeft | Self::EyeRight => config.noise.vision,
        }
    }

    /// Returns the delay of the sense in a configuration, in steps.
    pub(crate) fn delay(self, config: &Config) -> usize {
        let delays = &config.delays;
        let (own, of_age) = match self {
            Self::Proprioception => (delays.proprioception, latencies::SKIN),
            Self::Touch | Self::TouchPooled | Self::Pain => (delays.touch, latencies::SKIN),
            Self::Vestibular => (delays.vestibular, latencies::BALANCE),
            Self::EyeLeft | Self::EyeRight => (delays.vision, latencies::SIGHT),
            // he knows the commands to his own motors
            Self::Reflexes => return 0,
        };
        config.sense_delay(own, of_age)
    }

    /// Returns the index of the eye (0 left, 1 right), or `None` for other senses.
    pub(crate) fn eye(self) -> Option<usize> {
        Self::EYES.iter().position(|&eye| eye == self)
    }

    /// Returns the rate of the sense in a configuration, Hz, if it has one.
    pub(crate) fn rate(self, config: &Config) -> Option<f64> {
        match self {
            Self::Proprioception | Self::Vestibular | Self::Reflexes => None,
            Self::Touch | Self::TouchPooled | Self::Pain => config.touch_rate,
            Self::EyeLeft | Self::EyeRight => config.vision_rate,
        }
    }
}

/// Passes the entries of an observation to a macro, in their order: first proprioception, which every environment has, then the others,
/// each a field with its documentation, type, bounds and source. The name of a field is its key, except for proprioception.
macro_rules! observation_entries {
    ($apply:ident) => {
        $apply! {
            {
                /// Proprioception, Gymnasium's key `observation`; [`Senses::proprioception`](crate::env::Senses::proprioception)
                /// describes its layout. A task may append to it: the last number of `catch` is the radius of the ball, m.
                proprioception: f64, ANY, sense(Sense::Proprioception);
            }
            /// Touch of the skin, N, if `touch_active`; [`Senses::touch`](crate::env::Senses::touch) describes its layout.
            touch: f32, ANY, sense(Sense::Touch);
            /// Touch of each body with skin, (bodies, 5), if `touch_pooled`: see [`TouchPool`](crate::sensors::TouchPool).
            touch_pooled: f64, ANY, sense(Sense::TouchPooled);
            /// Pain, a number for each touch sensor, if `pain_active`: see [`Pain`](crate::sensors::Pain).
            pain: f32, NOT_NEGATIVE, sense(Sense::Pain);
            /// Image of the left eye, (H, W, 3) bytes from the top, if `vision_active` and `vision_outputs` has `rgb`.
            eye_left: u8, BYTES, eye(Sense::EyeLeft, VisionOutput::Rgb);
            /// Image of the right eye.
            eye_right: u8, BYTES, eye(Sense::EyeRight, VisionOutput::Rgb);
            /// Grey image of the left eye, (H, W) bytes, if `vision_outputs` has `gray`: see
            /// [`SensesMut::eye_gray`](crate::env::SensesMut::eye_gray).
            eye_left_gray: u8, BYTES, eye(Sense::EyeLeft, VisionOutput::Gray);
            /// Grey image of the right eye.
            eye_right_gray: u8, BYTES, eye(Sense::EyeRight, VisionOutput::Gray);
            /// Depth image of the left eye, (H, W), m, if `vision_outputs` has `depth`: see
            /// [`SensesMut::eye_depth`](crate::env::SensesMut::eye_depth).
            eye_left_depth: f32, NOT_NEGATIVE, eye(Sense::EyeLeft, VisionOutput::Depth);
            /// Depth image of the right eye.
            eye_right_depth: f32, NOT_NEGATIVE, eye(Sense::EyeRight, VisionOutput::Depth);
            /// Segmentation image of the left eye, (H, W) geom ids, -1 for none, if `vision_outputs` has `segmentation`: see
            /// [`SensesMut::eye_segmentation`](crate::env::SensesMut::eye_segmentation).
            eye_left_segmentation: i32, IDS, eye(Sense::EyeLeft, VisionOutput::Segmentation);
            /// Segmentation image of the right eye.
            eye_right_segmentation: i32, IDS, eye(Sense::EyeRight, VisionOutput::Segmentation);
            /// Linear acceleration (m/s^2) and angular velocity (rad/s) of the head, if `vestibular_active`.
            vestibular: f64, ANY, sense(Sense::Vestibular);
            /// How strongly each reflex acts, 0 to 1, in the order of [`Reflex::ALL`](crate::config::Reflex::ALL), if `reflex_observed`.
            reflexes: f64, SHARES, sense(Sense::Reflexes);
            /// The achieved goal, if the goals of the task have numbers.
            achieved_goal: f64, ANY, GOAL;
            /// The desired goal, of the same length.
            desired_goal: f64, ANY, GOAL;
        }
    };
}
pub(crate) use observation_entries;

const ANY: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const NOT_NEGATIVE: [f64; 2] = [0.0, f64::INFINITY];
const SHARES: [f64; 2] = [0.0, 1.0];
const BYTES: [f64; 2] = [0.0, u8::MAX as f64];
const IDS: [f64; 2] = [-1.0, i32::MAX as f64];

/// An entry of the observation, with its own key.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ObservationEntry {
    /// Its key in Gymnasium's dictionary, in files and in Python.
    pub key: &'static str,
    /// The field of [`Observation`](crate::Observation) and [`Buffers`](crate::vector::Buffers), and the property in JavaScript: the key,
    /// except for `proprioception`, whose key is `observation`.
    pub field: &'static str,
    /// The sense that reports it; `None` for goals.
    pub sense: Option<Sense>,
    /// The kind of an eye's image; `None` for other entries.
    pub image: Option<VisionOutput>,
    /// Number type.
    pub dtype: Dtype,
    /// Lower bound of every number.
    pub low: f64,
    /// Upper bound of every number.
    pub high: f64,
}

/// The source of an entry: a sense, or an image of an eye.
type EntrySource = (Option<Sense>, Option<VisionOutput>);

const GOAL: EntrySource = (None, None);

const fn sense(sense: Sense) -> EntrySource {
    (Some(sense), None)
}

const fn eye(sense: Sense, image: VisionOutput) -> EntrySource {
    (Some(sense), Some(image))
}

impl ObservationEntry {
    const fn new<T: Number>(
        key: &'static str,
        field: &'static str,
        [low, high]: [f64; 2],
        source: EntrySource,
    ) -> Self {
        let (sense, image) = source;
        Self {
            key,
            field,
            sense,
            image,
            dtype: T::DTYPE,
            low,
            high,
        }
    }

    /// Returns the entry under a key.
    pub fn of_key(key: &str) -> Option<&'static Self> {
        Self::ALL.iter().find(|entry| entry.key == key)
    }
}

macro_rules! table {
    (
        { $(#[$first_doc:meta])* $first:ident: $first_type:ty, $first_bounds:expr, $first_source:expr; }
        $($(#[$doc:meta])* $field:ident: $type:ty, $bounds:expr, $source:expr;)*
    ) => {
        impl ObservationEntry {
            /// Every entry, in order.
            pub const ALL: &[Self] = &[
                Self::new::<$first_type>(Sense::Proprioception.key(), stringify!($first), $first_bounds, $first_source),
                $(Self::new::<$type>(stringify!($field), stringify!($field), $bounds, $source)),*
            ];
        }
    };
}
observation_entries!(table);

//! The table of keys, from which reading, writing, defaults, ranges and documentation all follow.

use super::choices::{
    ActuationModel, Behavior, Compat, EngineKind, RendererKind, Scene, TouchFunction, TouchResponse, VisionOutput,
};
use super::outputs::VisionOutputs;
use super::{Config, MAX_AGE, error};
use crate::spaces::MAX_IMAGE_SIZE;

/// The value of a key.
#[derive(Clone, Debug, PartialEq)]
pub enum KeyValue {
    /// `true` or `false`.
    Bool(bool),
    /// An integer.
    Whole(u64),
    /// A number.
    Number(f64),
    /// One of a few names.
    Choice(&'static str),
    /// Some of a few names.
    List(Vec<&'static str>),
    /// Any text.
    Text(String),
    /// No value: the key is not used.
    None,
}

impl KeyValue {
    /// Writes the value as YAML.
    pub fn to_yaml(&self) -> String {
        match self {
            Self::Bool(on) => on.to_string(),
            Self::Whole(number) => number.to_string(),
            Self::Number(number) => format!("{number:?}"),
            Self::Choice(name) => (*name).to_string(),
            Self::List(names) => format!("[{}]", names.join(", ")),
            Self::Text(text) => quoted(text),
            Self::None => NONE.to_string(),
        }
    }
}

/// The word for a key that is not used.
const NONE: &str = "none";
/// YAML's words for no value.
const NULL: [&str; 5] = ["", "~", "null", "Null", "NULL"];

/// The values that a key accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KeyKind {
    /// `true` or `false`.
    Bool,
    /// An integer in a closed range.
    Whole {
        /// Smallest value.
        min: u64,
        /// Largest value.
        max: u64,
    },
    /// A finite number: 0, or at least the given one.
    ZeroOrAtLeast(f64),
    /// A number in a closed range, or none.
    NoneOr {
        /// Smallest value.
        min: f64,
        /// Largest value.
        max: f64,
    },
    /// One of the given names.
    Choice(&'static [&'static str]),
    /// A list of one or more of the given names, each once.
    List(&'static [&'static str]),
    /// Text of at least one character, without control characters.
    Text,
}

/// A reason why a value does not fit its key.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Misfit {
    Missing,
    WrongType,
    OutOfRange { nearest: Option<&'static str> },
}

const OUT_OF_RANGE: Misfit = Misfit::OutOfRange { nearest: None };

impl KeyKind {
    /// Describes in words what is allowed.
    pub fn expected(&self) -> String {
        match self {
            Self::Bool => "true or false".to_string(),
            Self::Whole { min, max } => format!("a whole number from {min} to {max}"),
            Self::ZeroOrAtLeast(least) => format!("0 or a finite number of at least {least}"),
            Self::NoneOr { min, max } => format!("none or a number from {min} to {max}"),
            Self::Choice(names) => format!("one of {}", names.join(", ")),
            Self::List(names) => format!("a list in brackets of one or more of {}, each once", names.join(", ")),
            Self::Text => {
                "text, at least one character and no control characters (in quotes if it looks like a number, a \
                           boolean or null)"
                    .to_string()
            }
        }
    }

    /// Parses a YAML scalar: `plain` is false for text in quotes, which is text whatever it looks like.
    pub(super) fn parse(&self, text: &str, plain: bool) -> Result<KeyValue, Misfit> {
        if matches!(self, Self::NoneOr { .. }) && (text == NONE || plain && NULL.contains(&text)) {
            return Ok(KeyValue::None);
        }
        if plain && NULL.contains(&text) {
            return Err(Misfit::Missing);
        }
        let value = match self {
            Self::Bool if plain => KeyValue::Bool(boolean(text).ok_or(Misfit::WrongType)?),
            Self::Whole { .. } if plain => KeyValue::Whole(whole(text)?),
            Self::ZeroOrAtLeast(_) | Self::NoneOr { .. } if plain => KeyValue::Number(number(text)?),
            Self::Bool | Self::Whole { .. } | Self::ZeroOrAtLeast(_) | Self::NoneOr { .. } | Self::List(_) => {
                return Err(Misfit::WrongType);
            }
            Self::Choice(names) => KeyValue::Choice(named(text, names)?),
            Self::Text if plain && (boolean(text).is_some() || number(text) != Err(Misfit::WrongType)) => {
                return Err(Misfit::WrongType);
            }
            Self::Text => KeyValue::Text(text.to_string()),
        };
        self.check(&value).map(|()| value)
    }

    /// Parses the next name of a list, after those in `list`.
    pub(super) fn parse_item(&self, text: &str, list: &mut Vec<&'static str>) -> Result<(), Misfit> {
        let Self::List(names) = self else {
            return Err(Misfit::WrongType);
        };
        let name = named(text, names)?;
        if list.contains(&name) {
            return Err(OUT_OF_RANGE);
        }
        list.push(name);
        Ok(())
    }

    /// Checks that a value of the right type is allowed.
    pub(super) fn check(&self, value: &KeyValue) -> Result<(), Misfit> {
        let fits = match (self, value) {
            (Self::Bool, KeyValue::Bool(_)) => true,
            (Self::Whole { min, max }, KeyValue::Whole(number)) => (min..=max).contains(&number),
            (Self::ZeroOrAtLeast(least), KeyValue::Number(number)) => {
                number.is_finite() && (*number == 0.0 || number >= least)
            }
            (Self::NoneOr { .. }, KeyValue::None) => true,
            (Self::NoneOr { min, max }, KeyValue::Number(number)) => (min..=max).contains(&number),
            (Self::Choice(names), KeyValue::Choice(name)) => names.contains(name),
            (Self::List(names), KeyValue::List(list)) => {
                let once = |(at, name): (usize, &&str)| names.contains(name) && !list[..at].contains(name);
                !list.is_empty() && list.iter().enumerate().all(once)
            }
            (Self::Text, KeyValue::Text(text)) => !text.is_empty() && !text.chars().any(char::is_control),
            _ => return Err(Misfit::WrongType),
        };
        if fits { Ok(()) } else { Err(OUT_OF_RANGE) }
    }
}

/// Finds one of some names.
fn named(text: &str, names: &[&'static str]) -> Result<&'static str, Misfit> {
    let nearest = || error::nearest(text, names.iter().copied());
    let found = names.iter().find(|name| **name == text).copied();
    found.ok_or_else(|| Misfit::OutOfRange { nearest: nearest() })
}

/// Parses YAML 1.1's words for true and false, which PyYAML reads; `y` and `n` are text to it and so here.
fn boolean(text: &str) -> Option<bool> {
    match text {
        "true" | "True" | "TRUE" | "yes" | "Yes" | "YES" | "on" | "On" | "ON" => Some(true),
        "false" | "False" | "FALSE" | "no" | "No" | "NO" | "off" | "Off" | "OFF" => Some(false),
        _ => None,
    }
}

/// Parses decimal digits with an optional sign and `_` between digits. A leading zero is refused: YAML 1.1 and 1.2 read
/// it as different numbers.
fn whole(text: &str) -> Result<u64, Misfit> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    let decimal = digits.starts_with(|c: char| c.is_ascii_digit())
        && digits.bytes().all(|b| b.is_ascii_digit() || b == b'_')
        && (digits.len() == 1 || !digits.starts_with('0'));
    if !decimal {
        return Err(Misfit::WrongType);
    }
    let number = digits.replace('_', "").parse().map_err(|_| OUT_OF_RANGE)?;
    if text.starts_with('-') && number != 0 {
        Err(OUT_OF_RANGE)
    } else {
        Ok(number)
    }
}

/// Parses an integer, or digits with a point or an exponent.
fn number(text: &str) -> Result<f64, Misfit> {
    let unsigned = text.strip_prefix(['+', '-']).unwrap_or(text);
    if matches!(unsigned, ".inf" | ".Inf" | ".INF" | ".nan" | ".NaN" | ".NAN") {
        return Err(OUT_OF_RANGE);
    }
    let float = unsigned.starts_with(|c: char| c.is_ascii_digit() || c == '.')
        && unsigned.bytes().all(|b| b.is_ascii_digit() || b"._eE+-".contains(&b))
        && unsigned.bytes().any(|b| b".eE".contains(&b));
    if !float && whole(text) == Err(Misfit::WrongType) {
        return Err(Misfit::WrongType);
    }
    let number: f64 = text.replace('_', "").parse().map_err(|_| Misfit::WrongType)?;
    Ok(number + 0.0) // -0 becomes 0
}

/// Writes text in YAML's double quotes, with everything unusual escaped.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            ' '..='~' => out.push(c),
            _ if c.is_alphanumeric() => out.push(c),
            _ => out.push_str(&format!("\\U{:08X}", u32::from(c))),
        }
    }
    out.push('"');
    out
}

/// A field of [`Config`] that converts to and from a [`KeyValue`].
trait Field: Sized {
    fn to_value(&self) -> KeyValue;
    fn from_value(value: &KeyValue) -> Option<Self>;
}

macro_rules! field {
    ($($type:ty, $variant:ident, $value:ident => $back:expr, |$field:ident| $there:expr;)*) => {$(
        impl Field for $type {
            fn to_value(&self) -> KeyValue {
                let $field = self;
                KeyValue::$variant($there)
            }
            fn from_value(value: &KeyValue) -> Option<Self> {
                match value {
                    KeyValue::$variant($value) => $back,
                    _ => None,
                }
            }
        }
    )*};
}

field! {
    bool, Bool, v => Some(*v), |f| *f;
    u32, Whole, v => u32::try_from(*v).ok(), |f| u64::from(*f);
    u64, Whole, v => Some(*v), |f| *f;
    f64, Number, v => Some(*v), |f| *f;
    String, Text, v => Some(v.clone()), |f| f.clone();
    Behavior, Choice, v => Self::from_name(v), |f| f.name();
    Scene, Choice, v => Self::from_name(v), |f| f.name();
    ActuationModel, Choice, v => Self::from_name(v), |f| f.name();
    TouchFunction, Choice, v => Self::from_name(v), |f| f.name();
    TouchResponse, Choice, v => Self::from_name(v), |f| f.name();
    Compat, Choice, v => Self::from_name(v), |f| f.name();
    EngineKind, Choice, v => Self::from_name(v), |f| f.name();
    RendererKind, Choice, v => Self::from_name(v), |f| f.name();
    VisionOutputs, List, v => Self::from_names(v), |f| f.iter().map(VisionOutput::name).collect();
}

impl Field for Option<f64> {
    fn to_value(&self) -> KeyValue {
        self.map_or(KeyValue::None, KeyValue::Number)
    }
    fn from_value(value: &KeyValue) -> Option<Self> {
        match value {
            KeyValue::None => Some(None),
            KeyValue::Number(number) => Some(Some(*number)),
            _ => None,
        }
    }
}

/// One key of the configuration.
#[derive(Debug)]
pub struct Key {
    /// Name in a file.
    pub name: &'static str,
    /// Heading of the section that it belongs to.
    pub section: &'static str,
    /// Values that it accepts.
    pub kind: KeyKind,
    /// Meaning, in one sentence.
    pub doc: &'static str,
    get: fn(&Config) -> KeyValue,
    set: fn(&mut Config, &KeyValue) -> bool,
}

impl Key {
    /// Returns the key with this name; `None` if there is none.
    pub fn named(name: &str) -> Option<&'static Self> {
        KEYS.iter().find(|key| key.name == name)
    }

    /// Returns the value of this key in `config`.
    pub fn value(&self, config: &Config) -> KeyValue {
        (self.get)(config)
    }

    /// Returns the value of this key when a file leaves it out.
    pub fn default_value(&self) -> KeyValue {
        self.value(&Config::default())
    }

    /// Sets the field; `false` if the value is of another type.
    pub(super) fn assign(&self, config: &mut Config, value: &KeyValue) -> bool {
        (self.set)(config, value)
    }
}

/// Defines the table: per section, the key, its field, what it accepts and what it means.
macro_rules! keys {
    ($($section:tt { $($name:ident = $($field:ident).+, $kind:expr, $doc:literal;)* })*) => {
        &[$($(Key {
            name: stringify!($name),
            section: $section,
            kind: $kind,
            doc: $doc,
            get: |config| config.$($field).+.to_value(),
            set: |config, value| Field::from_value(value).map(|new| config.$($field).+ = new).is_some(),
        },)*)*]
    };
}

const fn whole_from_1_to(max: u64) -> KeyKind {
    KeyKind::Whole { min: 1, max }
}

const COUNT: KeyKind = whole_from_1_to(i64::MAX as u64); // steps and episodes are signed integers in numpy's logs
const FRAMES: KeyKind = whole_from_1_to(10_000); // a step cannot be interrupted; these take about a second
const PIXELS: KeyKind = whole_from_1_to(MAX_IMAGE_SIZE as u64);
const SEED: KeyKind = KeyKind::Whole { min: 0, max: u64::MAX };
const SCALE: KeyKind = KeyKind::ZeroOrAtLeast(0.01); // sensors grow with the inverse square: 170 million values at 0.01

const AGE: KeyKind = KeyKind::NoneOr { min: 0.0, max: MAX_AGE };
const CENTIMETRES: KeyKind = KeyKind::NoneOr { min: 0.1, max: 100.0 };
const MILLIMETRES: KeyKind = KeyKind::NoneOr { min: 0.1, max: 100.0 };

use KeyKind::{Bool, Choice, List, Text};

/// The section of the keys that change MIMo's body.
pub(super) const GROWTH: &str = "Growth";

/// Every key, in the order of the API page, with this implementation's own after its general ones.
pub(super) static KEYS: &[Key] = keys! {
    "General" {
        save_dir = save_dir, Text, "The folder of logs, videos and results.";
        behavior = behavior, Choice(Behavior::NAMES), "The behavior that is trained and scored.";
        scene = scene, Choice(Scene::NAMES), "MIMo's surroundings.";
        max_episode_steps = max_episode_steps, COUNT, "Number of steps after which an episode is truncated.";
        frame_skip = frame_skip, FRAMES, "Physics steps of 5 ms per action.";
        render_size = render_size, PIXELS, "Width and height of rendered images, pixels.";
        save_logs_every = save_logs_every, COUNT, "Episodes between two saves of the training log.";
    }
    "This implementation's own keys" {
        compat = compat, Choice(Compat::NAMES), "Which of them to follow where the API page and the Python code disagree.";
        engine = engine, Choice(EngineKind::NAMES), "The physics engine.";
        renderer = renderer, Choice(RendererKind::NAMES), "The renderer of images.";
        seed = seed, SEED, "The seed of all random choices until a reset is given another.";
    }
    GROWTH {
        age = age, AGE, "The age of MIMo's body, months; none for the proportions of the original.";
        strength_age = strength_age, AGE, "The age of MIMo's strength, months; none for that of his body.";
        touch_grows = touch_grows, Bool, "Touch sensors keep their number and grow with the body, instead of keeping their distances.";
        ankle_circumference = measurements.ankle_circumference, CENTIMETRES, "The circumference of the ankle, cm; none for that of the age.";
        calf_circumference = measurements.calf_circumference, CENTIMETRES, "The circumference of the calf, cm; none for that of the age.";
        elbow_hand_length = measurements.elbow_hand_length, CENTIMETRES, "The length from the elbow to the fingertips, cm; none for that of the age.";
        fist_breadth = measurements.fist_breadth, CENTIMETRES, "The breadth of the fist, cm; none for that of the age.";
        foot_breadth = measurements.foot_breadth, CENTIMETRES, "The breadth of the foot, cm; none for that of the age.";
        foot_length = measurements.foot_length, CENTIMETRES, "The length of the foot, cm; none for that of the age.";
        forearm_circumference = measurements.forearm_circumference, CENTIMETRES, "The circumference of the forearm, cm; none for that of the age.";
        hand_breadth = measurements.hand_breadth, CENTIMETRES, "The breadth of the hand, cm; none for that of the age.";
        hand_length = measurements.hand_length, CENTIMETRES, "The length of the hand, cm; none for that of the age.";
        head_circumference = measurements.head_circumference, CENTIMETRES, "The circumference of the head, cm; none for that of the age.";
        hip_breadth = measurements.hip_breadth, CENTIMETRES, "The breadth of the hip, cm; none for that of the age.";
        knee_sole_length = measurements.knee_sole_length, CENTIMETRES, "The length from the knee to the sole, cm; none for that of the age.";
        middle_finger_diameter = measurements.middle_finger_diameter, MILLIMETRES, "The diameter of the middle finger, mm; none for that of the age.";
        rump_knee_length = measurements.rump_knee_length, CENTIMETRES, "The length from the rump to the knee, cm; none for that of the age.";
        shoulder_elbow_length = measurements.shoulder_elbow_length, CENTIMETRES, "The length from the shoulder to the elbow, cm; none for that of the age.";
        thigh_circumference = measurements.thigh_circumference, CENTIMETRES, "The circumference of the thigh, half way, cm; none for that of the age.";
        thumb_diameter = measurements.thumb_diameter, MILLIMETRES, "The diameter of the thumb, mm; none for that of the age.";
        upper_arm_circumference = measurements.upper_arm_circumference, CENTIMETRES, "The circumference of the upper arm, cm; none for that of the age.";
    }
    "Proprioception" {
        proprio_velocity = proprio_velocity, Bool, "Joint velocities are observed.";
        proprio_torque = proprio_torque, Bool, "Joint torques are observed.";
        proprio_limits = proprio_limits, Bool, "How far joints are into their limits is observed.";
        proprio_actuation = proprio_actuation, Bool, "The state of the actuators is observed.";
    }
    "Vestibular" {
        vestibular_active = vestibular_active, Bool, "The head's motion is observed.";
    }
    "Vision" {
        vision_active = vision_active, Bool, "The images of both eyes are observed.";
        vision_resolution = vision_resolution, PIXELS, "Width and height of an eye's image, pixels.";
        vision_outputs = vision_outputs, List(VisionOutput::NAMES), "The images of each eye that are observed.";
    }
    "Touch" {
        touch_active = touch_active, Bool, "Touch is observed.";
        touch_scale = touch_scale, SCALE, "Factor on the distance between sensors; 0 switches touch off.";
        touch_function = touch_function, Choice(TouchFunction::NAMES), "What a sensor reports.";
        touch_response = touch_response, Choice(TouchResponse::NAMES), "How sensors share a force.";
        touch_hands = touch.hands, Bool, "The hands have touch sensors.";
        touch_fingers = touch.fingers, Bool, "The fingers have touch sensors.";
        touch_arms = touch.arms, Bool, "The arms have touch sensors.";
        touch_feet = touch.feet, Bool, "The feet have touch sensors.";
        touch_legs = touch.legs, Bool, "The legs have touch sensors.";
        touch_body = touch.body, Bool, "The trunk has touch sensors.";
        touch_head = touch.head, Bool, "The head has touch sensors.";
        touch_eyes = touch.eyes, Bool, "The eyes have touch sensors.";
    }
    "Actuation" {
        actuation_model = actuation_model, Choice(ActuationModel::NAMES), "How actions become torques.";
        act_hands = act.hands, Bool, "The hands are actuated.";
        act_fingers = act.fingers, Bool, "The fingers are actuated.";
        act_arms = act.arms, Bool, "The arms are actuated.";
        act_feet = act.feet, Bool, "The feet are actuated.";
        act_legs = act.legs, Bool, "The legs are actuated.";
        act_body = act.body, Bool, "The trunk is actuated.";
        act_head = act.head, Bool, "The head is actuated.";
        act_eyes = act.eyes, Bool, "The eyes are actuated.";
    }
    "Locked joints" {
        lock_hands = lock.hands, Bool, "The joints of the hands are locked.";
        lock_fingers = lock.fingers, Bool, "The joints of the fingers are locked.";
        lock_arms = lock.arms, Bool, "The joints of the arms are locked.";
        lock_feet = lock.feet, Bool, "The joints of the feet are locked.";
        lock_legs = lock.legs, Bool, "The joints of the legs are locked.";
        lock_body = lock.body, Bool, "The joints of the trunk are locked.";
        lock_head = lock.head, Bool, "The joints of the head are locked.";
        lock_eyes = lock.eyes, Bool, "The joints of the eyes are locked.";
    }
};

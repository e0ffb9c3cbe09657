//! The table of keys. Reading, writing, defaults, ranges and documentation all come from it.

use super::choices::{ActuationModel, Behavior, Compat, Engine, RendererKind, Scene, TouchFunction, TouchResponse};
use super::{Config, error};
use crate::render::MAX_SIZE;

/// A value of a configuration, as the table of keys handles it.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `true` or `false`.
    Bool(bool),
    /// A whole number.
    Whole(u64),
    /// A number.
    Number(f64),
    /// One of a few names.
    Choice(&'static str),
    /// Free text.
    Text(String),
}

impl Value {
    /// The value as it stands in a YAML file.
    pub fn to_yaml(&self) -> String {
        match self {
            Self::Bool(on) => on.to_string(),
            Self::Whole(number) => number.to_string(),
            Self::Number(number) => format!("{number:?}"),
            Self::Choice(name) => (*name).to_string(),
            Self::Text(text) => quoted(text),
        }
    }
}

/// What a key accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// `true` or `false`.
    Bool,
    /// A whole number in a closed range.
    Whole {
        /// The smallest.
        min: u64,
        /// The largest.
        max: u64,
    },
    /// A finite number: 0, or at least this.
    ZeroOrAtLeast(f64),
    /// One of these names.
    Choice(&'static [&'static str]),
    /// Text of at least one character, without control characters.
    Text,
}

/// Why a value does not fit its key.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Misfit {
    Missing,
    WrongType,
    OutOfRange { nearest: Option<&'static str> },
}

const OUT_OF_RANGE: Misfit = Misfit::OutOfRange { nearest: None };

impl Kind {
    /// What is allowed, in words.
    pub fn expected(&self) -> String {
        match self {
            Self::Bool => "true or false".to_string(),
            Self::Whole { min, max } => format!("a whole number from {min} to {max}"),
            Self::ZeroOrAtLeast(least) => format!("0 or a finite number from {least}"),
            Self::Choice(names) => format!("one of {}", names.join(", ")),
            Self::Text => {
                "text, at least one character and no control characters (in quotes if it looks like a number, a \
                           boolean or null)"
                    .to_string()
            }
        }
    }

    /// The value of a YAML scalar: `plain` is false for text in quotes, which is text whatever it looks like.
    pub(super) fn parse(&self, text: &str, plain: bool) -> Result<Value, Misfit> {
        if plain && matches!(text, "" | "~" | "null" | "Null" | "NULL") {
            return Err(Misfit::Missing);
        }
        let value = match self {
            Self::Bool if plain => Value::Bool(boolean(text).ok_or(Misfit::WrongType)?),
            Self::Whole { .. } if plain => Value::Whole(whole(text)?),
            Self::ZeroOrAtLeast(_) if plain => Value::Number(number(text)?),
            Self::Bool | Self::Whole { .. } | Self::ZeroOrAtLeast(_) => return Err(Misfit::WrongType),
            Self::Choice(names) => match names.iter().find(|name| **name == text) {
                Some(name) => Value::Choice(name),
                None => {
                    return Err(Misfit::OutOfRange {
                        nearest: error::nearest(text, names.iter().copied()),
                    });
                }
            },
            Self::Text if plain && (boolean(text).is_some() || number(text) != Err(Misfit::WrongType)) => {
                return Err(Misfit::WrongType);
            }
            Self::Text => Value::Text(text.to_string()),
        };
        self.check(&value).map(|()| value)
    }

    /// Whether a value of the right type is allowed.
    pub(super) fn check(&self, value: &Value) -> Result<(), Misfit> {
        let fits = match (self, value) {
            (Self::Bool, Value::Bool(_)) => true,
            (Self::Whole { min, max }, Value::Whole(number)) => (min..=max).contains(&number),
            (Self::ZeroOrAtLeast(least), Value::Number(number)) => {
                number.is_finite() && (*number == 0.0 || number >= least)
            }
            (Self::Choice(names), Value::Choice(name)) => names.contains(name),
            (Self::Text, Value::Text(text)) => !text.is_empty() && !text.chars().any(char::is_control),
            _ => return Err(Misfit::WrongType),
        };
        if fits { Ok(()) } else { Err(OUT_OF_RANGE) }
    }
}

/// YAML 1.1's words for true and false, which PyYAML reads; `y` and `n` are text to it and so here.
fn boolean(text: &str) -> Option<bool> {
    match text {
        "true" | "True" | "TRUE" | "yes" | "Yes" | "YES" | "on" | "On" | "ON" => Some(true),
        "false" | "False" | "FALSE" | "no" | "No" | "NO" | "off" | "Off" | "OFF" => Some(false),
        _ => None,
    }
}

/// Decimal digits with an optional sign and `_` between digits. A leading zero is refused: YAML 1.1 and 1.2 read it as
/// different numbers.
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

/// A whole number, or digits with a point or an exponent.
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

/// Text in YAML's double quotes, everything unusual escaped.
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

/// A field of [`Config`] as a [`Value`].
trait Field: Sized {
    fn to_value(&self) -> Value;
    fn from_value(value: &Value) -> Option<Self>;
}

macro_rules! field {
    ($($type:ty, $variant:ident, $value:ident => $back:expr, |$field:ident| $there:expr;)*) => {$(
        impl Field for $type {
            fn to_value(&self) -> Value {
                let $field = self;
                Value::$variant($there)
            }
            fn from_value(value: &Value) -> Option<Self> {
                match value {
                    Value::$variant($value) => $back,
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
    Engine, Choice, v => Self::from_name(v), |f| f.name();
    RendererKind, Choice, v => Self::from_name(v), |f| f.name();
}

/// One key of the configuration.
#[derive(Debug)]
pub struct Key {
    /// Its name in a file.
    pub name: &'static str,
    /// The heading it stands under.
    pub section: &'static str,
    /// What it accepts.
    pub kind: Kind,
    /// What it means, in one sentence.
    pub doc: &'static str,
    get: fn(&Config) -> Value,
    set: fn(&mut Config, &Value) -> bool,
}

impl Key {
    /// The key with this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        KEYS.iter().find(|key| key.name == name)
    }

    /// The value this key has in `config`.
    pub fn value(&self, config: &Config) -> Value {
        (self.get)(config)
    }

    /// The value this key has when a file leaves it out.
    pub fn default_value(&self) -> Value {
        self.value(&Config::default())
    }

    /// Sets the field; `false` if the value is of another type.
    pub(super) fn assign(&self, config: &mut Config, value: &Value) -> bool {
        (self.set)(config, value)
    }
}

/// The table: per section, the key, its field, what it accepts and what it means.
macro_rules! keys {
    ($($section:literal { $($name:ident = $($field:ident).+, $kind:expr, $doc:literal;)* })*) => {
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

const fn whole_from_1_to(max: u64) -> Kind {
    Kind::Whole { min: 1, max }
}

const COUNT: Kind = whole_from_1_to(i64::MAX as u64); // steps and episodes are signed integers in numpy's logs
const FRAMES: Kind = whole_from_1_to(u32::MAX as u64);
const PIXELS: Kind = whole_from_1_to(MAX_SIZE as u64);
const SEED: Kind = Kind::Whole { min: 0, max: u64::MAX };
const SCALE: Kind = Kind::ZeroOrAtLeast(0.01); // sensors grow with the inverse square: 170 million values at 0.01

use Kind::{Bool, Choice, Text};

/// Every key, in the order of the API page, this implementation's own after its general ones.
pub(super) static KEYS: &[Key] = keys! {
    "General" {
        save_dir = save_dir, Text, "The folder of logs, videos and results.";
        behavior = behavior, Choice(Behavior::NAMES), "What is trained and scored.";
        scene = scene, Choice(Scene::NAMES), "What stands around MIMo.";
        max_episode_steps = max_episode_steps, COUNT, "Steps after which an episode is truncated.";
        frame_skip = frame_skip, FRAMES, "Physics steps of 5 ms per action.";
        render_size = render_size, PIXELS, "Width and height of rendered images, pixels.";
        save_logs_every = save_logs_every, COUNT, "Episodes between two saves of the training log.";
    }
    "This implementation's own keys" {
        compat = compat, Choice(Compat::NAMES), "What holds where API page and Python code disagree.";
        engine = engine, Choice(Engine::NAMES), "What moves the bodies.";
        renderer = renderer, Choice(RendererKind::NAMES), "What draws images.";
        seed = seed, SEED, "The seed of every random choice until a reset is given another.";
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
    }
    "Touch" {
        touch_active = touch_active, Bool, "Touch is observed.";
        touch_scale = touch_scale, SCALE, "Factor on the distance between sensors; 0 switches touch off.";
        touch_function = touch_function, Choice(TouchFunction::NAMES), "What a sensor reports.";
        touch_response = touch_response, Choice(TouchResponse::NAMES), "How sensors share a force.";
        touch_hands = touch.hands, Bool, "The hands feel.";
        touch_fingers = touch.fingers, Bool, "The fingers feel.";
        touch_arms = touch.arms, Bool, "The arms feel.";
        touch_feet = touch.feet, Bool, "The feet feel.";
        touch_legs = touch.legs, Bool, "The legs feel.";
        touch_body = touch.body, Bool, "The trunk feels.";
        touch_head = touch.head, Bool, "The head feels.";
        touch_eyes = touch.eyes, Bool, "The eyes feel.";
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
        lock_hands = lock.hands, Bool, "The hands' joints are held.";
        lock_fingers = lock.fingers, Bool, "The fingers' joints are held.";
        lock_arms = lock.arms, Bool, "The arms' joints are held.";
        lock_feet = lock.feet, Bool, "The feet's joints are held.";
        lock_legs = lock.legs, Bool, "The legs' joints are held.";
        lock_body = lock.body, Bool, "The trunk's joints are held.";
        lock_head = lock.head, Bool, "The head's joints are held.";
        lock_eyes = lock.eyes, Bool, "The eyes' joints are held.";
    }
};

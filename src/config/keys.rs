//! Keys, and the macro that reads their table.

use super::choices::{
    ActuationModel, Behavior, Compat, DelayUnit, EngineKind, FacialExpression, Learner, Limb, Proportions, ReflexVor,
    RendererKind, Sex, SpringModel, StartingPosition, StrengthModel, TouchFunction, TouchResponse, VisionOutput,
};
use super::kinds::KeyValue;
use super::outputs::VisionOutputs;
use super::reflexes::ReflexSet;
use super::scene::Scene;
use super::schedule::AgeSchedule;

/// A field of [`Config`](super::Config) that converts to and from a [`KeyValue`].
pub(super) trait ConfigField: Sized {
    fn to_value(&self) -> KeyValue;
    fn from_value(value: &KeyValue) -> Option<Self>;
}

macro_rules! field {
    ($($type:ty, $variant:ident, $value:ident => $back:expr, |$field:ident| $there:expr;)*) => {$(
        impl ConfigField for $type {
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
    FacialExpression, Choice, v => Self::from_name(v), |f| f.name();
    StartingPosition, Choice, v => Self::from_name(v), |f| f.name();
    Learner, Choice, v => Self::from_name(v), |f| f.name();
    Limb, Choice, v => Self::from_name(v), |f| f.name();
    StrengthModel, Choice, v => Self::from_name(v), |f| f.name();
    SpringModel, Choice, v => Self::from_name(v), |f| f.name();
    Proportions, Choice, v => Self::from_name(v), |f| f.name();
    Sex, Choice, v => Self::from_name(v), |f| f.name();
    ActuationModel, Choice, v => Self::from_name(v), |f| f.name();
    TouchFunction, Choice, v => Self::from_name(v), |f| f.name();
    TouchResponse, Choice, v => Self::from_name(v), |f| f.name();
    Compat, Choice, v => Self::from_name(v), |f| f.name();
    EngineKind, Choice, v => Self::from_name(v), |f| f.name();
    RendererKind, Choice, v => Self::from_name(v), |f| f.name();
    ReflexVor, Choice, v => Self::from_name(v), |f| f.name();
    DelayUnit, Choice, v => Self::from_name(v), |f| f.name();
    VisionOutputs, List, v => Self::from_names(v), |f| f.iter().map(VisionOutput::name).collect();
}

impl ConfigField for Scene {
    fn to_value(&self) -> KeyValue {
        match self {
            Self::File(path) => KeyValue::Text(path.clone()),
            known => Self::NAMES
                .iter()
                .find(|name| **name == known.name())
                .map_or(KeyValue::None, |name| KeyValue::Choice(name)),
        }
    }
    fn from_value(value: &KeyValue) -> Option<Self> {
        match value {
            KeyValue::Choice(name) => Self::from_name(name),
            KeyValue::Text(path) => Some(Self::File(path.clone())),
            _ => None,
        }
    }
}

impl ConfigField for AgeSchedule {
    fn to_value(&self) -> KeyValue {
        if self.is_empty() {
            KeyValue::None
        } else {
            KeyValue::Text(self.to_string())
        }
    }
    fn from_value(value: &KeyValue) -> Option<Self> {
        match value {
            KeyValue::None => Some(Self::default()),
            KeyValue::Text(text) => Self::parse(text),
            _ => None,
        }
    }
}

impl ConfigField for ReflexSet {
    fn to_value(&self) -> KeyValue {
        if self.is_empty() {
            KeyValue::None
        } else {
            KeyValue::List(self.names())
        }
    }
    fn from_value(value: &KeyValue) -> Option<Self> {
        match value {
            KeyValue::None => Some(Self::default()),
            KeyValue::List(names) => Self::from_names(names),
            _ => None,
        }
    }
}

impl<T: ConfigField> ConfigField for Option<T> {
    fn to_value(&self) -> KeyValue {
        self.as_ref().map_or(KeyValue::None, T::to_value)
    }
    fn from_value(value: &KeyValue) -> Option<Self> {
        match value {
            KeyValue::None => Some(None),
            value => T::from_value(value).map(Some),
        }
    }
}

/// Defines [`Config`](super::Config), its groups of fields, and the table of their keys, in sections. A key is a field:
/// `name: type = default, accepted values, "meaning";`, where ` + "..."` after the meaning is only for Rust's documentation.
/// A `@group` is a structure of such fields, and `@parts` a switch for each part of the body: `field as key`.
macro_rules! config {
    ($($section:tt {
        $($name:ident: $type:ty = $default:expr, $kind:expr, $doc:literal $(+ $more:literal)?;)*
        $(@group $group:ident: $Group:ident, $group_doc:literal, $about:literal {
            $($field:ident as $key:ident: $field_type:ty = $field_default:expr, $field_kind:expr, $field_doc:literal;)*
        })*
        $(@parts $parts:ident = $parts_default:expr, $parts_doc:literal {
            $($part:ident as $part_key:ident, $part_doc:literal;)*
        })?
    })*) => {
        /// The configuration of an environment.
        ///
        /// [`Config::default`] has the defaults of the API page, and [`Config::keys`] lists the values of each key. After changing
        /// fields, call [`Config::validate`] to check the whole.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Config {
            $(
                $(#[doc = $doc] $(#[doc = "\n\n"] #[doc = $more])? pub $name: $type,)*
                $(#[doc = $group_doc] pub $group: $Group,)*
                $(#[doc = $parts_doc] pub $parts: BodyParts<bool>,)?
            )*
        }

        #[automatically_derived]
        impl Default for Config {
            fn default() -> Self {
                Self {
                    $(
                        $($name: $default,)*
                        $($group: $Group::default(),)*
                        $($parts: $parts_default,)?
                    )*
                }
            }
        }

        $($(
            #[doc = $about]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct $Group {
                $(#[doc = $field_doc] pub $field: $field_type,)*
            }

            #[automatically_derived]
            impl Default for $Group {
                fn default() -> Self {
                    Self { $($field: $field_default,)* }
                }
            }
        )*)*

        pub(super) static KEYS: &[Key] = &[$(
            $(config!(@key $section, $name, $kind, $doc, $name),)*
            $($(config!(@key $section, $key, $field_kind, $field_doc, $group.$field),)*)*
            $($(config!(@key $section, $part_key, KeyKind::Bool, $part_doc, $parts.$part),)*)?
        )*];
    };
    (@key $section:tt, $name:ident, $kind:expr, $doc:literal, $($field:ident).+) => {
        Key {
            name: stringify!($name),
            section: $section,
            kind: $kind,
            doc: $doc,
            get: |config| config.$($field).+.to_value(),
            set: |config, value| ConfigField::from_value(value).map(|new| config.$($field).+ = new).is_some(),
        }
    };
}

pub(super) use config;

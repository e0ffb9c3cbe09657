//! The lines of JSON between an evaluation and a policy in another program.

use std::borrow::Cow;
use std::fmt;

use base64::display::Base64Display;
use base64::engine::general_purpose::STANDARD;
use serde::de::{DeserializeSeed, SeqAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

use super::EvaluationStep;
use crate::config::VisionOutput;
use crate::env::{Env, Observation};
use crate::spaces::{BoxSpace, ObservationSpace, Values};

/// The message to a policy before each action. Senses that are not active are left out.
pub(super) struct ObservationMessage<'a> {
    moment: EvaluationStep,
    /// At the start of an episode.
    action_space: Option<&'a BoxSpace>,
    observation: Observation<'a>,
    /// The spaces of the entries of the observation, in their order.
    spaces: Vec<ObservationSpace>,
}

impl<'a> ObservationMessage<'a> {
    /// Creates the message with the current observation of an environment, and at the start of an episode with the
    /// action space.
    pub fn new(env: &'a Env, moment: EvaluationStep) -> Self {
        Self {
            action_space: (moment.step == 0).then(|| env.action_space()),
            observation: env.observation(),
            spaces: env.observation_space(),
            moment,
        }
    }
}

impl Serialize for ObservationMessage<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("episode", &self.moment.episode)?;
        map.serialize_entry("step", &self.moment.step)?;
        if let Some(space) = self.action_space {
            let (low, high) = (space.low(), space.high());
            map.serialize_entry("action_space", &ActionBounds { low, high })?;
        }
        for ((entry, values), space) in self.observation.entries().zip(&self.spaces) {
            match entry.image {
                Some(output) => map.serialize_entry(entry.key, &ImageMessage::new(output, &space.shape, values))?,
                None => map.serialize_entry(entry.key, &NumberList(values))?,
            }
        }
        map.end()
    }
}

/// The limits of each number of an action.
#[derive(Serialize)]
struct ActionBounds<'a> {
    low: &'a [f32],
    high: &'a [f32],
}

/// Numbers as a list.
struct NumberList<'a>(Values<'a>);

impl Serialize for NumberList<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            Values::F64(values) => values.serialize(serializer),
            Values::F32(values) => values.serialize(serializer),
            Values::U8(values) => values.serialize(serializer),
            Values::I32(values) => values.serialize(serializer),
        }
    }
}

/// An image: its shape, NumPy's name of its type unless it is a colour image, and its data, little-endian, in base64.
#[derive(Serialize)]
struct ImageMessage<'a> {
    shape: &'a [usize],
    #[serde(skip_serializing_if = "Option::is_none")]
    dtype: Option<&'static str>,
    #[serde(serialize_with = "base64")]
    data: Cow<'a, [u8]>,
}

impl<'a> ImageMessage<'a> {
    fn new(output: VisionOutput, shape: &'a [usize], values: Values<'a>) -> Self {
        Self {
            shape,
            dtype: (output != VisionOutput::Rgb).then(|| values.dtype().name()),
            data: match values {
                Values::U8(bytes) => Cow::Borrowed(bytes),
                numbers => Cow::Owned(numbers.to_le_bytes()),
            },
        }
    }
}

fn base64<S: Serializer>(data: &impl AsRef<[u8]>, serializer: S) -> Result<S::Ok, S::Error> {
    let data = data.as_ref();
    serializer.collect_str(&Base64Display::new(data, &STANDARD))
}

/// Reads an answer, a JSON list of `expected` numbers, into `action`, or returns a description of the fault.
pub(super) fn parse(answer: &str, expected: usize, action: &mut Vec<f32>) -> Result<(), String> {
    action.clear();
    if !answer.starts_with('[') {
        return Err("it is not a list in brackets".to_string());
    }
    let mut deserializer = serde_json::Deserializer::from_str(answer);
    let list = ActionSeed {
        action: &mut *action,
        expected,
    };
    let read = list.deserialize(&mut deserializer);
    match read.and_then(|n| deserializer.end().map(|()| n)) {
        Ok(n) if n == expected => Ok(()),
        Ok(n) => Err(format!("it has {n} numbers")),
        Err(_) if ["NaN", "Infinity"].iter().any(|n| answer.contains(n)) => Err(format!(
            "number {} is not finite, which JSON cannot express",
            action.len()
        )),
        Err(e) => Err(format!("after {} numbers: {e}", action.len())),
    }
}

/// Reads numbers into a list that grows to `expected`, and counts the rest.
struct ActionSeed<'a> {
    action: &'a mut Vec<f32>,
    expected: usize,
}

impl<'de> DeserializeSeed<'de> for ActionSeed<'_> {
    type Value = usize;

    fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<usize, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for ActionSeed<'_> {
    type Value = usize;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a list of {} numbers", self.expected)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<usize, A::Error> {
        let mut found = 0;
        while let Some(value) = list.next_element::<f32>()? {
            if !value.is_finite() {
                return Err(serde::de::Error::custom("the next number is too large"));
            }
            if found < self.expected {
                self.action.push(value);
            }
            found += 1;
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::json;
    use crate::spaces::Dtype;

    #[test]
    fn answers_are_lists_of_finite_numbers() {
        let mut action = Vec::new();
        assert_eq!(parse("[1, -2.5e-1,3]", 3, &mut action), Ok(()));
        assert_eq!(action, [1.0, -0.25, 3.0]);
        assert_eq!(parse("[]", 0, &mut action), Ok(()));
        for (answer, part) in [
            ("1, 2", "brackets"),
            ("", "brackets"),
            ("null", "brackets"),
            ("[1, 2", "after 2 numbers: EOF"),
            ("[1]", "it has 1 numbers"),
            ("[]", "it has 0 numbers"),
            ("[1, 2, 3]", "it has 3 numbers"),
            ("[1,]", "after 1 numbers: trailing comma"),
            ("[1, NaN]", "number 1 is not finite"),
            ("[-Infinity, 2]", "number 0 is not finite"),
            ("[1, \"2\"]", "after 1 numbers: invalid type: string"),
            ("[[1, 2]]", "after 0 numbers: invalid type: sequence"),
            ("[1, 1e39]", "after 1 numbers"),
            ("[1, 1e999]", "after 1 numbers: number out of range"),
            ("[1, 2] [3]", "trailing characters"),
        ] {
            let error = parse(answer, 2, &mut action).expect_err(answer);
            assert!(error.contains(part), "{answer}: {error}");
            assert!(action.len() <= 2, "{answer}");
        }
    }

    #[test]
    fn answers_are_read_to_the_bit() {
        let mut rng = crate::spaces::NumpyRng::seed(3);
        let mut action = Vec::new();
        for _ in 0..10_000 {
            let bits = (rng.uniform() * f64::from(u32::MAX)) as u32;
            let value = f32::from_bits(bits);
            if value.is_finite() {
                assert_eq!(parse(&format!("[{value:?}]"), 1, &mut action), Ok(()));
                assert_eq!(action[0].to_bits(), value.to_bits());
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_null() {
        let space = |key, shape: &[usize], dtype| ObservationSpace {
            key,
            shape: shape.to_vec(),
            dtype,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        };
        let line = ObservationMessage {
            moment: EvaluationStep { episode: 0, step: 0 },
            action_space: Some(&BoxSpace::new(vec![f32::NEG_INFINITY], vec![1.5])),
            observation: Observation {
                proprioception: &[f64::NAN, 1e-300, -0.0],
                touch: Some(&[]),
                touch_pooled: Some(&[0.5]),
                eye_left: Some(&[255, 254, 0]),
                eye_right_depth: Some(&[1.5]),
                ..Observation::default()
            },
            spaces: vec![
                space("observation", &[3], Dtype::F64),
                space("touch", &[0], Dtype::F32),
                space("touch_pooled", &[1], Dtype::F64),
                space("eye_left", &[1, 1, 3], Dtype::U8),
                space("eye_right_depth", &[1, 1], Dtype::F32),
            ],
        };
        assert_eq!(
            json::text(&line),
            "{\"episode\": 0, \"step\": 0, \"action_space\": {\"low\": [null], \"high\": [1.5]}, \
             \"observation\": [null, 1e-300, -0.0], \"touch\": [], \"touch_pooled\": [0.5], \
             \"eye_left\": {\"shape\": [1, 1, 3], \"data\": \"//4A\"}, \
             \"eye_right_depth\": {\"shape\": [1, 1], \"dtype\": \"float32\", \"data\": \"AADAPw==\"}}"
        );
    }
}

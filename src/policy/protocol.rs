//! The lines of JSON between an evaluation and a policy in another program.

use std::borrow::Cow;
use std::fmt;

use base64::display::Base64Display;
use base64::engine::general_purpose::STANDARD;
use serde::Serializer;
use serde::de::{DeserializeSeed, SeqAccess, Visitor};

use super::Moment;
use crate::env::{Env, Observation};

/// The message to a policy before each action. Senses that are not active are left out.
#[derive(serde::Serialize)]
pub(super) struct Line<'a> {
    episode: u64,
    step: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    action_space: Option<Bounds<'a>>,
    observation: &'a [f64],
    #[serde(skip_serializing_if = "Option::is_none")]
    touch: Option<&'a [f32]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    touch_pooled: Option<&'a [f64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pain: Option<&'a [f32]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eye_left: Option<Image<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eye_right: Option<Image<'a>>,
    #[serde(flatten)]
    eyes: Eyes<'a>,
    #[serde(skip_serializing_if = "Option::is_none")]
    vestibular: Option<&'a [f64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    achieved_goal: Option<&'a [f64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    desired_goal: Option<&'a [f64]>,
}

/// The limits of each number of an action.
#[derive(serde::Serialize)]
struct Bounds<'a> {
    low: &'a [f32],
    high: &'a [f32],
}

/// An image in bytes: its shape, and its data in base64.
#[derive(serde::Serialize)]
struct Image<'a> {
    shape: [usize; 3],
    #[serde(serialize_with = "base64")]
    data: &'a [u8],
}

/// The eyes' outputs other than colours.
#[derive(Default, serde::Serialize)]
struct Eyes<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    eye_left_gray: Option<Map<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eye_right_gray: Option<Map<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eye_left_depth: Option<Map<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eye_right_depth: Option<Map<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eye_left_segmentation: Option<Map<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    eye_right_segmentation: Option<Map<'a>>,
}

/// An image of one number for each pixel: its shape, NumPy's name of its type, and its data, the lowest byte first, in
/// base64.
#[derive(serde::Serialize)]
struct Map<'a> {
    shape: [usize; 2],
    dtype: &'static str,
    #[serde(serialize_with = "base64")]
    data: Cow<'a, [u8]>,
}

impl<'a> Eyes<'a> {
    fn new(observation: &Observation<'a>, shape: [usize; 2]) -> Self {
        fn pair<'a, T>(values: Option<[&'a [T]; 2]>, map: impl Fn(&'a [T]) -> Map<'a>) -> [Option<Map<'a>>; 2] {
            values.map_or([None, None], |pair| pair.map(|v| Some(map(v))))
        }
        let map = |dtype, data| Map { shape, dtype, data };
        let bytes = |v| map("uint8", Cow::Borrowed(v));
        let floats = |v: &'a [f32]| map("float32", v.iter().flat_map(|x| x.to_le_bytes()).collect());
        let ids = |v: &'a [i32]| map("int32", v.iter().flat_map(|x| x.to_le_bytes()).collect());
        let [eye_left_gray, eye_right_gray] = pair(observation.eye_gray, bytes);
        let [eye_left_depth, eye_right_depth] = pair(observation.eye_depth, floats);
        let [eye_left_segmentation, eye_right_segmentation] = pair(observation.eye_segmentation, ids);
        Self {
            eye_left_gray,
            eye_right_gray,
            eye_left_depth,
            eye_right_depth,
            eye_left_segmentation,
            eye_right_segmentation,
        }
    }
}

fn base64<S: Serializer>(data: &impl AsRef<[u8]>, serializer: S) -> Result<S::Ok, S::Error> {
    let data = data.as_ref();
    serializer.collect_str(&Base64Display::new(data, &STANDARD))
}

impl<'a> Line<'a> {
    /// Takes the present observation of an environment, and the action space at the start of an episode.
    pub fn new(env: &'a Env, Moment { episode, step }: Moment) -> Self {
        let (observation, space) = (env.observation(), env.action_space());
        let shape = env.senses().vision().map_or([0; 3], |v| v.shape());
        let image = |data| Image { shape, data };
        Self {
            episode,
            step,
            action_space: (step == 0).then(|| Bounds {
                low: space.low(),
                high: space.high(),
            }),
            observation: observation.proprioception,
            touch: observation.touch,
            touch_pooled: observation.touch_pooled,
            pain: observation.pain,
            eye_left: observation.eye_left.map(image),
            eye_right: observation.eye_right.map(image),
            eyes: Eyes::new(&observation, [shape[0], shape[1]]),
            vestibular: observation.vestibular,
            achieved_goal: observation.achieved_goal,
            desired_goal: observation.desired_goal,
        }
    }
}

/// Reads an answer, a JSON list of `expected` numbers, into `action`; the error describes the fault.
pub(super) fn parse(answer: &str, expected: usize, action: &mut Vec<f32>) -> Result<(), String> {
    action.clear();
    if !answer.starts_with('[') {
        return Err("it is not a list in brackets".to_string());
    }
    let mut deserializer = serde_json::Deserializer::from_str(answer);
    let list = Numbers {
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
struct Numbers<'a> {
    action: &'a mut Vec<f32>,
    expected: usize,
}

impl<'de> DeserializeSeed<'de> for Numbers<'_> {
    type Value = usize;

    fn deserialize<D: serde::Deserializer<'de>>(self, deserializer: D) -> Result<usize, D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Numbers<'_> {
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
        let line = Line {
            episode: 0,
            step: 0,
            action_space: Some(Bounds {
                low: &[f32::NEG_INFINITY],
                high: &[1.5],
            }),
            observation: &[f64::NAN, 1e-300, -0.0],
            touch: Some(&[]),
            touch_pooled: Some(&[0.5]),
            pain: None,
            eye_left: Some(Image {
                shape: [1, 1, 3],
                data: &[255, 254, 0],
            }),
            eye_right: None,
            eyes: Eyes {
                eye_right_depth: Some(Map {
                    shape: [1, 1],
                    dtype: "float32",
                    data: 1.5f32.to_le_bytes().to_vec().into(),
                }),
                ..Eyes::default()
            },
            vestibular: None,
            achieved_goal: None,
            desired_goal: None,
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

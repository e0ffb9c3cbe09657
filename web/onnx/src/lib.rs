//! ONNX policies for JavaScript. The environment lives in another module, so senses come as arrays.
#![forbid(unsafe_code)]

use babybench::Observation;
use babybench::policy::OnnxPolicy;
use babybench::spaces::{BoxSpace, Dtype, ObservationSpace};
use wasm_bindgen::prelude::*;

/// A model that chooses actions.
#[wasm_bindgen]
pub struct Model {
    policy: OnnxPolicy,
    space: BoxSpace,
    senses: Vec<ObservationSpace>,
    action: Vec<f32>,
}

#[wasm_bindgen]
impl Model {
    /// Reads a model; `name` stands for its file in errors, `low` and `high` are the bounds of actions.
    #[wasm_bindgen(constructor)]
    pub fn new(bytes: Vec<u8>, name: &str, low: Vec<f32>, high: Vec<f32>) -> Result<Model, JsValue> {
        let policy = OnnxPolicy::from_bytes(bytes, name).map_err(error)?;
        Ok(Self {
            policy,
            space: BoxSpace::new(low, high),
            senses: Vec::new(),
            action: Vec::new(),
        })
    }

    /// Tells of a sense that is active: its key, and its length or, for an eye, height, width and 3.
    pub fn sense(&mut self, key: &str, shape: Vec<usize>) -> Result<(), JsValue> {
        let keys = ["observation", "touch", "vestibular", "eye_left", "eye_right"];
        let known = keys.into_iter().find(|k| *k == key);
        let key = known.ok_or_else(|| error(format!("there is no sense {key:?}; senses are {}", keys.join(", "))))?;
        let (dtype, low, high) = match shape.len() {
            3 => (Dtype::U8, 0.0, 255.0),
            _ => (Dtype::F64, f64::NEG_INFINITY, f64::INFINITY),
        };
        self.senses.push(ObservationSpace {
            key,
            shape,
            dtype,
            low,
            high,
        });
        Ok(())
    }

    /// Matches the model's inputs with the senses.
    pub fn connect(&mut self) -> Result<(), JsValue> {
        self.policy.connect(&self.senses).map_err(error)
    }

    /// Returns the action for an observation.
    pub fn act(
        &mut self,
        proprioception: &[f64],
        touch: Option<Vec<f32>>,
        vestibular: Option<Vec<f64>>,
        eye_left: Option<Vec<u8>>,
        eye_right: Option<Vec<u8>>,
    ) -> Result<Vec<f32>, JsValue> {
        let observation = Observation {
            proprioception,
            touch: touch.as_deref(),
            vestibular: vestibular.as_deref(),
            eye_left: eye_left.as_deref(),
            eye_right: eye_right.as_deref(),
            ..Observation::default() // models in pages see in colour
        };
        let decided = self.policy.decide(&observation, &self.space, &mut self.action);
        decided.map_err(error)?;
        Ok(self.action.clone())
    }
}

fn error(error: impl std::fmt::Display) -> JsValue {
    js_sys::Error::new(&error.to_string()).into()
}

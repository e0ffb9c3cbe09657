//! ONNX policies for JavaScript. The environment is in another module, so observations arrive as arrays.
#![forbid(unsafe_code)]

use babybench::policy::OnnxPolicy;
use babybench::sensors::ObservationEntry;
use babybench::spaces::{Array, BoxSpace, Dtype, ObservationSpace};
use babybench::{Observation, spaces::Values};
use js_sys::{Float32Array, Float64Array, Int32Array, Uint8Array};
use wasm_bindgen::prelude::*;

/// A model that chooses actions.
#[wasm_bindgen]
pub struct Model {
    policy: OnnxPolicy,
    space: BoxSpace,
    /// The current and the last observation.
    senses: Vec<(ObservationSpace, Array)>,
    action: Vec<f32>,
}

#[wasm_bindgen]
impl Model {
    /// Reads a model. Errors name `name` as its file; `low` and `high` are the bounds of actions.
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

    /// Adds an entry of the observation: its property, and its shape.
    pub fn sense(&mut self, field: &str, shape: Vec<usize>) -> Result<(), JsValue> {
        let known = ObservationEntry::ALL.iter().find(|entry| entry.field == field);
        let entry = known.ok_or_else(|| error(format!("nothing that is observed is called {field:?}")))?;
        let values = Array::zeros(entry.dtype, shape.iter().product());
        let space = ObservationSpace {
            key: entry.key,
            shape,
            dtype: entry.dtype,
            low: entry.low,
            high: entry.high,
        };
        self.senses.push((space, values));
        Ok(())
    }

    /// Matches the model's inputs with the observations.
    pub fn connect(&mut self) -> Result<(), JsValue> {
        let spaces: Vec<_> = self.senses.iter().map(|(space, _)| space.clone()).collect();
        self.policy.connect(&spaces).map_err(error)
    }

    /// Returns the action for an observation: the arrays of the entries, in the order of the calls of [`Model::sense`].
    pub fn act(&mut self, observed: Vec<JsValue>) -> Result<Vec<f32>, JsValue> {
        for ((space, values), array) in self.senses.iter_mut().zip(observed) {
            let read = match space.dtype {
                Dtype::F64 => Array::F64(Float64Array::new(&array).to_vec()),
                Dtype::F32 => Array::F32(Float32Array::new(&array).to_vec()),
                Dtype::U8 => Array::U8(Uint8Array::new(&array).to_vec()),
                Dtype::I32 => Array::I32(Int32Array::new(&array).to_vec()),
            };
            if read.values().len() != values.values().len() {
                return Err(error(format!(
                    "{} has {} numbers, not the {} of the environment that the model was read for",
                    space.key,
                    read.values().len(),
                    values.values().len()
                )));
            }
            *values = read;
        }
        let seen = |key: &str| self.senses.iter().find(|(space, _)| space.key == key);
        let observation = Observation::from_fn(|entry| -> Option<Values<'_>> { Some(seen(entry.key)?.1.values()) });
        let decided = self.policy.decide(&observation, &self.space, &mut self.action);
        decided.map_err(error)?;
        Ok(self.action.clone())
    }
}

fn error(error: impl std::fmt::Display) -> JsValue {
    js_sys::Error::new(&error.to_string()).into()
}

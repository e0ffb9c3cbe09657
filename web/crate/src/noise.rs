//! Random movements.

use babybench::spaces::{BoxSpace, Noise};
use wasm_bindgen::prelude::*;

use crate::js;

/// Action noise for an action space.
#[wasm_bindgen]
pub struct ActionNoise {
    noise: babybench::spaces::ActionNoise,
    action: Vec<f32>,
}

#[wasm_bindgen]
impl ActionNoise {
    /// Makes a noise by name, for actions between `low` and `high`, `step` seconds apart.
    #[wasm_bindgen(constructor)]
    pub fn new(noise: &str, low: Vec<f32>, high: Vec<f32>, step: f64, seed: u64) -> Result<ActionNoise, JsValue> {
        let noise: Noise = noise.parse().map_err(js::error)?;
        let noise = noise.at_age(None).map_err(js::error)?;
        Ok(Self {
            noise: babybench::spaces::ActionNoise::new(noise, &BoxSpace::new(low, high), step, seed),
            action: Vec::new(),
        })
    }

    /// Returns the next action.
    pub fn sample(&mut self) -> Vec<f32> {
        self.noise.sample(&mut self.action);
        self.action.clone()
    }

    /// Restarts.
    pub fn reset(&mut self, seed: u64) {
        self.noise.reset(seed);
    }
}

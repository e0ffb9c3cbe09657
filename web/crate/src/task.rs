//! Rewards, goals and outcomes of an environment.

use babybench::env::Goal;
use wasm_bindgen::prelude::*;

use crate::env::Core;
use crate::js;

#[wasm_bindgen]
impl Core {
    /// Returns the reward of the last step.
    pub fn reward(&self) -> f64 {
        self.env.last_step().reward
    }

    /// Returns whether the last step ended the episode in success or failure.
    pub fn terminated(&self) -> bool {
        self.env.last_step().terminated
    }

    /// Returns whether the episode has reached its last step.
    pub fn truncated(&self) -> bool {
        self.env.last_step().truncated
    }

    /// Changes the desired goal of the episode.
    #[wasm_bindgen(js_name = setGoal)]
    pub fn set_goal(&mut self, desired: &[f64]) -> Result<(), JsValue> {
        self.env.by_hand().set_goal(desired).map_err(|e| js::env_error(&e))
    }

    /// Computes the rewards of rows of goals and terms.
    #[wasm_bindgen(js_name = computeReward)]
    pub fn compute_reward(
        &self,
        achieved: &[f64],
        desired: &[f64],
        terms: &[f64],
        rows: usize,
    ) -> Result<Vec<f64>, JsValue> {
        let mut rewards = vec![0.0; rows];
        let goals = Goal {
            achieved,
            desired,
            terms,
        };
        let computed = self.env.blueprint().compute_reward(goals, &mut rewards);
        computed.map_err(|e| js_sys::Error::new(&e.to_string()))?;
        Ok(rewards)
    }
}

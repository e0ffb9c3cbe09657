//! Pain: pressure beyond a threshold, and its decay.

use std::sync::Arc;

use super::transform::DelayValues as _;
use super::{SkinLayout, SkinValues, Touch};
use crate::config::{Compat, Config, PainOptions, TouchFunction};
use crate::model::Model;

/// The sense of pain of one environment: a number for each touch sensor.
///
/// The normal force of each contact, times the softness of the body that presses and the sensitivity of the body that
/// is pressed, is shared among the sensors as touch is. What a sensor gets beyond [`PainOptions::threshold`], times
/// [`PainOptions::slope`] and at most [`PainOptions::limit`], is the new pain p; the pain of the step is
/// max([`decay_old`](PainOptions::decay_old) times the pain of the step before, [`decay_new`](PainOptions::decay_new) p).
/// Under `compat: reference` the slope is applied before the threshold, as in the code that the sense is from
/// (`PainTouch`, a class for MIMo), and an episode starts with the pain of the last.
#[derive(Clone, Debug)]
pub struct Pain {
    options: PainOptions,
    compat: Compat,
    /// By body of the model.
    softness: Vec<f64>,
    sensitivity: Vec<f64>,
    /// Shares the forces.
    skin: Touch,
    felt: SkinValues,
}

impl Pain {
    /// Creates the sense for a skin; every body has softness 1 and sensitivity 1.
    pub fn new(model: &Model, layout: Arc<SkinLayout>, config: &Config) -> Self {
        let (compat, response) = (config.compat, config.touch_response);
        Self {
            options: config.pain,
            compat,
            softness: vec![1.0; model.nbody()],
            sensitivity: vec![1.0; model.nbody()],
            felt: SkinValues::new(layout.len(), 1),
            skin: Touch::new(layout, TouchFunction::Normal, response, compat),
        }
    }

    /// Returns the softness of each body, by id, for changes: the factor on the forces with which it presses others.
    pub fn softness_mut(&mut self) -> &mut [f64] {
        &mut self.softness
    }

    /// Returns the sensitivity of each body, by id, for changes: the factor on the forces that press it.
    pub fn sensitivity_mut(&mut self) -> &mut [f64] {
        &mut self.sensitivity
    }

    /// Returns the pain of all sensors.
    pub fn felt(&self) -> &SkinValues {
        &self.felt
    }

    /// Appends softness and sensitivity of bodies, and the memory from step to step.
    pub(crate) fn save(&self, out: &mut Vec<u8>) {
        for factor in self.softness.iter().chain(&self.sensitivity) {
            out.extend_from_slice(&factor.to_le_bytes());
        }
        self.felt.save(out);
    }

    /// Restores what was saved; `false` if the bytes do not fit.
    pub(crate) fn load(&mut self, bytes: &[u8]) -> bool {
        let factors = self.softness.iter_mut().chain(&mut self.sensitivity);
        let Some((saved, mut bytes)) = bytes.split_at_checked(8 * factors.size_hint().0) else {
            return false;
        };
        for (factor, word) in factors.zip(saved.as_chunks::<8>().0) {
            *factor = f64::from_le_bytes(*word);
            if !factor.is_finite() {
                return false;
            }
        }
        self.felt.load(&mut bytes) && bytes.is_empty()
    }

    /// Senses the contacts of touch, which has the same skin, and advances by one step.
    pub fn observe(&mut self, model: &Model, touch: &Touch) {
        let options = self.options;
        self.skin.clear();
        for contact in touch.contacts() {
            let other = contact.other.body(model);
            let factor = self.softness[other] * self.sensitivity[contact.body];
            self.skin
                .press(contact.body, contact.point_body, [contact.normal * factor, 0.0, 0.0]);
        }
        self.felt.for_each_touched(|pain| {
            for p in pain {
                *p = (f64::from(*p) * options.decay_old) as f32;
            }
        });
        for &sensor in self.skin.touched() {
            let force = f64::from(self.skin.felt().of(sensor as usize)[0]);
            let beyond = match self.compat {
                Compat::Api => options.slope * (force - options.threshold),
                Compat::Reference => options.slope * force - options.threshold,
            };
            let new = beyond.max(0.0).min(options.limit.unwrap_or(f64::INFINITY)) * options.decay_new;
            if new > 0.0 {
                let pain = &mut self.felt.of_mut(sensor as usize)[0];
                *pain = pain.max(new as f32);
            }
        }
        self.felt.forget_zeros();
    }

    /// Clears the pain of the last episode.
    pub fn reset(&mut self) {
        if self.compat == Compat::Api {
            self.felt.clear();
        }
    }
}

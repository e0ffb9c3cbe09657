//! The senses of an environment and what they observe.

use crate::actuation::Actuation;
use crate::env::{Blueprint, EnvError, Observation, missing_camera};
use crate::model::Model;
use crate::physics::State;
use crate::sensors::{EYES, Proprioception, Touch, Vestibular, Vision};
use crate::spaces::{Dtype, ObservationSpace};

/// The senses that the configuration turns on, with the vectors of the present observation.
pub(super) struct Senses {
    pub proprioception: Proprioception,
    pub touch: Option<Touch>,
    pub vision: Option<Vision>,
    pub vestibular: Option<Vestibular>,
    pub proprioception_values: Vec<f64>,
    pub vestibular_values: Vec<f64>,
    pub eye_values: [Vec<u8>; 2],
    /// Whether [`super::Env::draw_eyes`] draws what the eyes see, instead of each step.
    pub vision_deferred: bool,
}

impl Senses {
    pub fn new(blueprint: &Blueprint, actuation: &dyn Actuation) -> Result<Self, EnvError> {
        let (config, model) = (blueprint.config(), blueprint.model());
        let proprioception = Proprioception::new(model, config, actuation.observation_len());
        let vestibular = config.vestibular_active.then(|| Vestibular::new(model));
        let vision = if config.vision_active {
            let eyes = Vision::with_renderer(model, blueprint.renderer()?, config.vision_resolution as usize);
            Some(eyes.ok_or_else(|| missing_camera(EYES[0], "vision_active"))?)
        } else {
            None
        };
        let pixels = vision.as_ref().map_or(0, Vision::len);
        Ok(Self {
            proprioception_values: vec![0.0; proprioception.len()],
            vestibular_values: vec![0.0; vestibular.as_ref().map_or(0, Vestibular::len)],
            eye_values: [vec![0; pixels], vec![0; pixels]],
            touch: blueprint.skin().map(|skin| Touch::configured(skin.clone(), config)),
            vision_deferred: false,
            proprioception,
            vision,
            vestibular,
        })
    }

    /// Observes a state.
    pub fn observe(&mut self, model: &Model, state: &State, actuation: &dyn Actuation) -> Result<(), EnvError> {
        self.proprioception
            .observe(model, state, actuation, &mut self.proprioception_values);
        if let Some(t) = &mut self.touch {
            t.observe(model, state);
        }
        if let Some(v) = &self.vestibular {
            v.observe(state, &mut self.vestibular_values);
        }
        if let (Some(v), false) = (&mut self.vision, self.vision_deferred) {
            let [left, right] = &mut self.eye_values;
            v.observe(state, [left, right])?;
        }
        Ok(())
    }

    /// Returns what was observed last.
    pub fn observation(&self) -> Observation<'_> {
        Observation {
            proprioception: &self.proprioception_values,
            touch: self.touch.as_ref().map(Touch::values),
            eye_left: self.vision.as_ref().map(|_| &self.eye_values[0][..]),
            eye_right: self.vision.as_ref().map(|_| &self.eye_values[1][..]),
            vestibular: self.vestibular.as_ref().map(|_| &self.vestibular_values[..]),
        }
    }

    /// Returns keys, shapes, types and bounds of the observation.
    pub fn spaces(&self) -> Vec<ObservationSpace> {
        let vector = |key, len| ObservationSpace {
            key,
            shape: vec![len],
            dtype: Dtype::F64,
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
        };
        let mut spaces = vec![vector("observation", self.proprioception.len())];
        if let Some(t) = &self.touch {
            let dtype = Dtype::F32;
            spaces.push(ObservationSpace {
                dtype,
                ..vector("touch", t.len())
            });
        }
        if let Some(v) = &self.vision {
            spaces.extend(EYES.map(|key| ObservationSpace {
                key,
                shape: v.shape().to_vec(),
                dtype: Dtype::U8,
                low: 0.0,
                high: 255.0,
            }));
        }
        if let Some(v) = &self.vestibular {
            spaces.push(vector("vestibular", v.len()));
        }
        spaces
    }
}

//! The senses of an environment and what they observe.

use crate::actuation::Actuation;
use crate::config::{VisionOutput, VisionOutputs};
use crate::env::{Blueprint, EnvError, Observation, missing_camera};
use crate::model::Model;
use crate::physics::State;
use crate::sensors::{
    EYES, EYES_DEPTH, EYES_GRAY, EYES_SEGMENTATION, EyeImages, Proprioception, Touch, Vestibular, Vision,
};
use crate::spaces::{Dtype, ObservationSpace};

/// The senses that the configuration turns on, with the vectors of the present observation.
pub(super) struct Senses {
    pub proprioception: Proprioception,
    pub touch: Option<Touch>,
    pub vision: Option<Vision>,
    pub vestibular: Option<Vestibular>,
    pub proprioception_values: Vec<f64>,
    pub vestibular_values: Vec<f64>,
    pub eyes: [EyeImages; 2],
    outputs: VisionOutputs,
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
        let pixels = vision.as_ref().map_or(0, |v| v.shape()[0] * v.shape()[1]);
        let images = || EyeImages::new(config.vision_outputs, pixels);
        Ok(Self {
            proprioception_values: vec![0.0; proprioception.len()],
            vestibular_values: vec![0.0; vestibular.as_ref().map_or(0, Vestibular::len)],
            eyes: [images(), images()],
            touch: blueprint.skin().map(|skin| Touch::configured(skin.clone(), config)),
            outputs: config.vision_outputs,
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
            v.draw(state, self.eyes.each_mut().map(EyeImages::buffers))?;
        }
        Ok(())
    }

    /// Returns what was observed last.
    pub fn observation(&self) -> Observation<'_> {
        Observation {
            proprioception: &self.proprioception_values,
            touch: self.touch.as_ref().map(Touch::values),
            vestibular: self.vestibular.as_ref().map(|_| &self.vestibular_values[..]),
            ..Observation::of_eyes(&self.eyes)
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
            for output in self.outputs.iter() {
                spaces.extend((0..EYES.len()).map(|eye| image(output, eye, v.shape())));
            }
        }
        if let Some(v) = &self.vestibular {
            spaces.push(vector("vestibular", v.len()));
        }
        spaces
    }
}

/// Returns the space of an image of an eye.
fn image(output: VisionOutput, eye: usize, [height, width, colours]: [usize; 3]) -> ObservationSpace {
    let shape = vec![height, width];
    let (keys, shape, dtype, low, high) = match output {
        VisionOutput::Rgb => (EYES, vec![height, width, colours], Dtype::U8, 0.0, 255.0),
        VisionOutput::Gray => (EYES_GRAY, shape, Dtype::U8, 0.0, 255.0),
        VisionOutput::Depth => (EYES_DEPTH, shape, Dtype::F32, 0.0, f64::INFINITY),
        VisionOutput::Segmentation => (EYES_SEGMENTATION, shape, Dtype::I32, -1.0, f64::from(i32::MAX)),
    };
    ObservationSpace {
        key: keys[eye],
        shape,
        dtype,
        low,
        high,
    }
}

//! What an environment consists of: spaces, configuration, model, state, engine, senses, pictures.

use std::sync::Arc;

use crate::actuation::Actuation;
use crate::config::Config;
use crate::env::{Blueprint, BoxSpace, Dtype, Env, EnvError, Info, ObservationSpace, missing_camera};
use crate::model::Model;
use crate::physics::{Engine, Probe, State};
use crate::render::{Poses, Shot, View};
use crate::sensors::{EYES, Proprioception, Touch, Vestibular, Vision};

impl Env {
    /// Bounds of actions.
    pub fn action_space(&self) -> &BoxSpace {
        self.actuation.action_space()
    }

    /// Keys, shapes, types and bounds of the observation.
    pub fn observation_space(&self) -> Vec<ObservationSpace> {
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

    /// The information of the last step.
    pub fn info(&self) -> &Info {
        &self.info
    }

    /// How far each hand was off the axis of each eye in the last step, rad, in the order of
    /// [`BehaviorInfo::REGARDS`](crate::env::BehaviorInfo::REGARDS), if the behavior is `hand_regard`. Less than 15 degrees
    /// count.
    pub fn gaze_angles(&self) -> Option<[f64; 4]> {
        self.watcher.gaze_angles(&self.state)
    }

    /// The configuration.
    pub fn config(&self) -> &Config {
        self.blueprint.config()
    }

    /// What this environment was made from.
    pub fn blueprint(&self) -> &Blueprint {
        &self.blueprint
    }

    /// The compiled scene.
    pub fn model(&self) -> &Arc<Model> {
        self.blueprint.model()
    }

    /// The state of the scene.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// The state of the scene, to change positions, velocities, warm start, applied forces or parameters. Quantities that
    /// follow from them are brought up to date by the next step.
    pub fn state_mut(&mut self) -> &mut State {
        &mut self.state
    }

    /// The physics engine, with the live scene in Rapier.
    pub fn engine(&self) -> &dyn Engine {
        &*self.engine
    }

    /// The physics engine, to run queries on the live scene.
    pub fn engine_mut(&mut self) -> &mut dyn Engine {
        &mut *self.engine
    }

    /// Installs or removes a probe that is told when each stage of a step begins and when the step is done.
    pub fn set_probe(&mut self, probe: Option<Probe>) {
        self.engine.set_probe(probe);
    }

    /// The proprioceptive sense: names and ranges of its values.
    pub fn proprioception(&self) -> &Proprioception {
        &self.proprioception
    }

    /// The sense of touch, if it is active: sensor positions, active sensors, contacts and sums of forces.
    pub fn touch(&self) -> Option<&Touch> {
        self.touch.as_ref()
    }

    /// Vision, if it is active.
    pub fn vision(&self) -> Option<&Vision> {
        self.vision.as_ref()
    }

    /// What the eyes see of the present state, left and right, to be drawn by any renderer, if vision is active.
    pub fn eyes(&self) -> Option<[Shot<'_>; 2]> {
        self.vision.as_ref().map(|v| v.shots(&self.state))
    }

    /// A picture of the room, from the camera `corner`, of `render_size` by `render_size` pixels: red, green, blue of each
    /// pixel, rows from the top. Like the eyes it shows the start of the last physics step.
    ///
    /// # Errors
    /// As [`Env::render_camera`].
    pub fn render(&mut self) -> Result<&[u8], EnvError> {
        let size = self.config().render_size as usize;
        self.render_camera("corner", size, size)
    }

    /// A picture from a camera of the scene: `corner`, `top`, `side1`, `side2`, `closeup`, `eye_left` or `eye_right`.
    ///
    /// # Errors
    /// A camera that does not exist, a size that is not allowed, textures that cannot be read, no graphics adapter.
    pub fn render_camera(&mut self, camera: &str, width: usize, height: usize) -> Result<&[u8], EnvError> {
        let camera = self
            .model()
            .camera(camera)
            .ok_or_else(|| missing_camera(camera, "rendering"))?;
        let view = View { camera, width, height };
        view.check()?;
        self.picture.resize(view.rgb_len(), 0);
        let painter = match &mut self.painter {
            Some(painter) => painter,
            None => self.painter.insert(self.blueprint.painter()?),
        };
        let poses = Poses::from(&self.state);
        painter.rgb(&[Shot { poses, view }], [&mut self.picture[..]])?;
        Ok(&self.picture)
    }

    /// The vestibular sense, if it is active.
    pub fn vestibular(&self) -> Option<&Vestibular> {
        self.vestibular.as_ref()
    }

    /// The actuation model.
    pub fn actuation(&self) -> &dyn Actuation {
        &*self.actuation
    }
}

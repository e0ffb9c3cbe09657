//! The second infant of a scene.

use crate::config::ActuationModel;
use crate::env::{Env, EnvError};
use crate::mimo::{JOINT_PREFIX, OTHER_PREFIX, ROOT};
use crate::model::{JointType, Model, SensorType};
use crate::physics::State;
use crate::spaces::BoxSpace;

/// The second infant in the scene of an environment, which a second policy moves and observes: [`Env::others`].
///
/// Its action has a number for each of its motors, in [-1, 1], or for each of its servos (`actuation_model: positional`), an angle in
/// rad. Its observation has, in this order, the angles (rad) and velocities (rad/s) of its joints, the acceleration (m/s^2) and angular
/// velocity (rad/s) of its head, and the torque (N m) on each part, three numbers each.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherInfant {
    space: BoxSpace,
    actuators: Vec<usize>,
    joints: Vec<usize>,
    sensors: Vec<usize>,
}

impl OtherInfant {
    /// Finds the second infant of a scene; `None` if there is none.
    fn of(model: &Model, servos: bool) -> Option<Self> {
        let root = model.body(&format!("{OTHER_PREFIX}{ROOT}"))?;
        let own = |joint: usize| model.in_subtree(model.jnt_bodyid[joint], root);
        let named = |name: &str| {
            name.strip_prefix(OTHER_PREFIX)
                .is_some_and(|name| name.starts_with(JOINT_PREFIX))
        };
        let hinge = |&j: &usize| own(j) && model.jnt_type[j] == JointType::Hinge && named(&model.jnt_name[j]);
        let driven = |&i: &usize| model.actuator_joint(i).is_some_and(own);
        let felt = |&i: &usize| {
            let known = matches!(
                model.sensor_type[i],
                SensorType::Accelerometer | SensorType::Gyro | SensorType::Torque
            );
            known && model.sensor_name[i].starts_with(OTHER_PREFIX)
        };
        let actuators: Vec<usize> = (0..model.nu()).filter(driven).collect();
        let bound = |side: usize| {
            let bounds = actuators.iter().map(|&i| match model.actuator_joint(i) {
                Some(joint) if servos => model.jnt_range[joint][side] as f32,
                _ => [-1.0, 1.0][side],
            });
            bounds.collect::<Vec<f32>>()
        };
        Some(Self {
            space: BoxSpace::new(bound(0), bound(1)),
            actuators,
            joints: (0..model.njnt()).filter(hinge).collect(),
            sensors: (0..model.nsensor()).filter(felt).collect(),
        })
    }

    /// Returns the bounds of an action.
    pub fn action_space(&self) -> &BoxSpace {
        &self.space
    }

    /// Returns its actuators, by id: an action has a number for each.
    pub fn actuators(&self) -> &[usize] {
        &self.actuators
    }

    /// Returns its joints, by id.
    pub fn joints(&self) -> &[usize] {
        &self.joints
    }

    /// Returns the length of an observation.
    pub fn observation_len(&self) -> usize {
        2 * self.joints.len() + 3 * self.sensors.len()
    }

    /// Sets its action, clipped to its space, in the environment that returned it from [`Env::others`]. The action holds until the next
    /// one, or a reset.
    ///
    /// # Errors
    /// An action of wrong length or with numbers that are not finite, which changes nothing.
    pub fn act(&self, env: &mut Env, action: &[f32]) -> Result<(), EnvError> {
        let expected = self.actuators.len();
        if action.len() != expected {
            let found = action.len();
            return Err(EnvError::ActionLength { found, expected });
        }
        if let Some((index, &value)) = action.iter().enumerate().find(|(_, a)| !a.is_finite()) {
            let name = env.model().actuator_name.get(self.actuators[index]);
            let actuator = name.cloned().unwrap_or_default();
            return Err(EnvError::ActionNotFinite { index, actuator, value });
        }
        env.physics.check_shape()?;
        let ctrl = &mut env.physics.state_mut().ctrl;
        for (k, (&i, &value)) in self.actuators.iter().zip(action).enumerate() {
            if let Some(ctrl) = ctrl.get_mut(i) {
                *ctrl = f64::from(self.space.clip(k, value));
            }
        }
        Ok(())
    }

    /// Writes its observation in a state of the scene, replacing the contents of `out`.
    pub fn observe(&self, model: &Model, state: &State, out: &mut Vec<f64>) {
        out.clear();
        out.extend(self.joints.iter().map(|&j| state.qpos[model.jnt_qposadr[j]]));
        out.extend(self.joints.iter().map(|&j| state.qvel[model.jnt_dofadr[j]]));
        for &sensor in &self.sensors {
            let at = model.sensor_adr[sensor];
            out.extend_from_slice(&state.sensordata[at..at + 3]);
        }
    }
}

impl Env {
    /// Lists the other infants in the scene: one, if a custom document includes `other_mimo.xml`. With muscles there are none, because
    /// only the learner has muscles.
    ///
    /// A second policy moves it step by step: [`OtherInfant::act`] before each step of the learner.
    pub fn others(&self) -> Vec<OtherInfant> {
        let model = self.config().actuation_model;
        if model == ActuationModel::Muscle {
            return Vec::new();
        }
        let other = OtherInfant::of(self.model(), model == ActuationModel::Positional);
        other.into_iter().collect()
    }
}

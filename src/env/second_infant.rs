//! The second infant of a scene.

use super::{Blueprint, Env, EnvError, check_numbers};
use crate::actuation::set_controls;
use crate::config::ActuationModel;
use crate::mimo::{MimoBodies, MimoJoints};
use crate::model::{Model, SensorType};
use crate::physics::{EngineError, State};
use crate::spaces::BoxSpace;

/// The second infant in the scene of an environment, which a second policy moves and observes: [`Blueprint::second_infant`].
///
/// Its action has a number for each of its motors, in [-1, 1], or for each of its servos (`actuation_model: positional`), an angle in
/// rad. Its observation has, in this order, the angles (rad) and velocities (rad/s) of its joints, the acceleration (m/s^2) and angular
/// velocity (rad/s) of its head, and the torque (N m) on each part, three numbers each.
#[derive(Clone, Debug, PartialEq)]
pub struct SecondInfant {
    space: BoxSpace,
    actuators: Vec<usize>,
    joints: MimoJoints,
    /// The first value of each sensor in `sensordata`.
    sensor_adr: Vec<usize>,
    /// Numbers of controls, positions, velocities and sensor values of the scene's model.
    sizes: [usize; 4],
}

impl SecondInfant {
    /// Finds the second infant of a scene; `None` if there is none.
    fn new(model: &Model, servos: bool) -> Option<Self> {
        let bodies = MimoBodies::second(model)?;
        let felt = |&i: &usize| {
            matches!(
                model.sensor_type[i],
                SensorType::Accelerometer | SensorType::Gyro | SensorType::Torque
            )
        };
        let actuators = bodies.actuators();
        let bound = |side: usize| {
            let bounds = actuators.iter().map(|&i| match model.actuator_joint(i) {
                Some(joint) if servos => model.jnt_range[joint][side] as f32,
                _ => [-1.0, 1.0][side],
            });
            bounds.collect::<Vec<f32>>()
        };
        let sensors = bodies.sensors().into_iter().filter(felt);
        Some(Self {
            space: BoxSpace::new(bound(0), bound(1)),
            actuators,
            joints: bodies.joints(),
            sensor_adr: sensors.map(|i| model.sensor_adr[i]).collect(),
            sizes: sizes(model),
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

    /// Returns its joints.
    pub fn joints(&self) -> &MimoJoints {
        &self.joints
    }

    /// Returns the length of an observation.
    pub fn observation_len(&self) -> usize {
        2 * self.joints.len() + 3 * self.sensor_adr.len()
    }

    /// Sets its action, clipped to its space, in the environment that returned it from [`Blueprint::second_infant`]. The action holds until
    /// the next one, or a reset.
    ///
    /// # Errors
    /// An action of wrong length or with numbers that are not finite, or an environment with another scene; nothing is changed.
    pub fn act(&self, env: &mut Env, action: &[f32]) -> Result<(), EnvError> {
        let actuator = |index: usize| self.actuators.get(index).copied();
        check_numbers(env.model(), action, self.actuators.len(), actuator)?;
        env.physics.check_shape()?;
        // ids of another scene would drive other actuators
        self.fits(sizes(env.model()))?;
        set_controls(
            &mut env.physics.state_mut().ctrl,
            &self.space,
            &self.actuators,
            0,
            action,
        );
        Ok(())
    }

    /// Writes its observation in a state of the scene, replacing the contents of `out`.
    ///
    /// # Errors
    /// A state of another scene.
    pub fn observe(&self, state: &State, out: &mut Vec<f64>) -> Result<(), EngineError> {
        self.fits([
            state.ctrl.len(),
            state.qpos.len(),
            state.qvel.len(),
            state.sensordata.len(),
        ])?;
        out.clear();
        out.extend(self.joints.qpos.iter().map(|&q| state.qpos[q]));
        out.extend(self.joints.dof.iter().map(|&d| state.qvel[d]));
        for &at in &self.sensor_adr {
            out.extend_from_slice(&state.sensordata[at..at + 3]);
        }
        Ok(())
    }

    /// Checks that these are the sizes of its scene.
    fn fits(&self, found: [usize; 4]) -> Result<(), EngineError> {
        let named = ["ctrl", "qpos", "qvel", "sensordata"].into_iter();
        for ((what, found), expected) in named.zip(found).zip(self.sizes) {
            if found != expected {
                return Err(EngineError::Shape { what, found, expected });
            }
        }
        Ok(())
    }
}

/// Returns the numbers of controls, positions, velocities and sensor values of a model.
fn sizes(model: &Model) -> [usize; 4] {
    [model.nu(), model.nq(), model.nv(), model.nsensordata()]
}

impl Blueprint {
    /// Returns the second infant of the scene, which a custom document adds by including `other_mimo.xml`; `None` without it. There is none with
    /// `actuation_model: muscle` either, because only the learner has muscles.
    ///
    /// A second policy moves it step by step: [`SecondInfant::act`] before each step of the learner.
    pub fn second_infant(&self) -> Option<SecondInfant> {
        match self.config().actuation_model {
            ActuationModel::Muscle => None,
            model => SecondInfant::new(self.model(), model == ActuationModel::Positional),
        }
    }
}

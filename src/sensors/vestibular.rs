//! The vestibular sense: acceleration and rotation of the head.

use std::ops::Range;

use crate::mimo::MimoBodies;
use crate::model::{Model, SensorType};
use crate::physics::State;

/// The vestibular sense: linear acceleration of the head including gravity (m/s^2) and its angular velocity (rad/s), in
/// the frame of the site at the centre of the head; MIMo's accelerometers and gyros, in their order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vestibular {
    sensors: Vec<usize>,
    /// The first value of each sensor.
    adr: Vec<usize>,
}

impl Vestibular {
    /// Finds the vestibular sensors of `model`; sensors of other bodies are left out.
    pub fn new(model: &Model) -> Self {
        let felt = |i: &usize| matches!(model.sensor_type[*i], SensorType::Accelerometer | SensorType::Gyro);
        let sensors: Vec<usize> = MimoBodies::of(model).sensors().into_iter().filter(felt).collect();
        Self {
            adr: sensors.iter().map(|&i| model.sensor_adr[i]).collect(),
            sensors,
        }
    }

    /// Returns the number of values: 6.
    pub fn len(&self) -> usize {
        3 * self.sensors.len()
    }

    /// Returns whether the model has no vestibular sensor.
    pub fn is_empty(&self) -> bool {
        self.sensors.is_empty()
    }

    /// Iterates over the names of the sensors and their ranges in the observation.
    pub fn layout<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = (&'a str, Range<usize>)> {
        self.sensors
            .iter()
            .enumerate()
            .map(|(k, &i)| (model.sensor_name[i].as_str(), 3 * k..3 * k + 3))
    }

    /// Writes the observation, of length [`Self::len`].
    pub fn observe(&self, s: &State, out: &mut [f64]) {
        for (values, &i) in out.chunks_exact_mut(3).zip(&self.adr) {
            values.copy_from_slice(&s.sensordata[i..i + 3]);
        }
    }
}

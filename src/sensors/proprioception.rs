//! Proprioception, MIMo's sense of his own body: joint angles, velocities, torques, limits and the state of the actuators.

use std::ops::Range;

use crate::actuation::Actuation;
use crate::config::{Compat, Config};
use crate::mimo::{MimoBodies, MimoJoints};
use crate::model::{Model, SensorType};
use crate::physics::State;

/// Width of the band before a joint limit in which the limit is felt, rad.
const LIMIT_THRESHOLD: f64 = 0.035;

/// A part of the proprioceptive vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ProprioceptionComponent {
    /// Joint angles, rad.
    Angles,
    /// Joint velocities, rad/s.
    Velocities,
    /// Torque sensors, N m, three values each.
    Torques,
    /// Proximity of each joint to its limits, see [`limit_activation`].
    Limits,
    /// State of the actuators, as defined by the actuation model.
    Actuation,
}

impl ProprioceptionComponent {
    /// Returns the name of the component, for logs and labels.
    pub fn name(self) -> &'static str {
        match self {
            Self::Angles => "angles",
            Self::Velocities => "velocities",
            Self::Torques => "torques",
            Self::Limits => "limits",
            Self::Actuation => "actuation",
        }
    }
}

/// One entry of the proprioceptive vector: a single number, or the three of a torque sensor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ProprioceptionEntry {
    /// Range of the vector.
    pub range: Range<usize>,
    /// Component that it belongs to.
    pub component: ProprioceptionComponent,
    /// Name of the joint for angles, velocities and limits, or of the torque sensor; for actuation, the name that the
    /// actuation model gives.
    pub name: String,
}

/// The layout of the proprioceptive vector: its components and their order.
///
/// Under `compat: api` the order is angles, velocities, torques, limits, actuation, and all but the angles can be turned off. Under
/// `compat: reference` all are on, in the order actuation, limits, angles, velocities, torques.
#[derive(Clone, Debug, PartialEq)]
pub struct Proprioception {
    joints: MimoJoints,
    torque_sensors: Vec<usize>,
    /// The first value of each sensor.
    torque_adr: Vec<usize>,
    layout: Vec<(ProprioceptionComponent, Range<usize>)>,
}

impl Proprioception {
    /// Lays out the observation of `model`, to which actuation contributes `actuation_len` values.
    pub fn new(model: &Model, config: &Config, actuation_len: usize) -> Self {
        use ProprioceptionComponent::*;
        let joints = MimoJoints::new(model);
        let is_torque = |i: &usize| model.sensor_type[*i] == SensorType::Torque;
        let torque_sensors: Vec<usize> = MimoBodies::of(model).sensors().into_iter().filter(is_torque).collect();
        let components: Vec<ProprioceptionComponent> = match config.compat {
            Compat::Reference => vec![Actuation, Limits, Angles, Velocities, Torques],
            Compat::Api => [
                (Angles, true),
                (Velocities, config.proprio_velocity),
                (Torques, config.proprio_torque),
                (Limits, config.proprio_limits),
                (Actuation, config.proprio_actuation),
            ]
            .into_iter()
            .filter_map(|(c, on)| on.then_some(c))
            .collect(),
        };
        let mut start = 0;
        let layout = components
            .into_iter()
            .map(|c| {
                let len = match c {
                    Angles | Velocities | Limits => joints.len(),
                    Torques => 3 * torque_sensors.len(),
                    Actuation => actuation_len,
                };
                start += len;
                (c, start - len..start)
            })
            .collect();
        Self {
            joints,
            torque_adr: torque_sensors.iter().map(|&i| model.sensor_adr[i]).collect(),
            torque_sensors,
            layout,
        }
    }

    /// Returns the length of the vector.
    pub fn len(&self) -> usize {
        self.layout.last().map_or(0, |l| l.1.end)
    }

    /// Returns whether the vector is empty.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the components and their ranges, in order.
    pub fn layout(&self) -> &[(ProprioceptionComponent, Range<usize>)] {
        &self.layout
    }

    /// Returns the range of one component; `None` if it is off.
    pub fn range(&self, component: ProprioceptionComponent) -> Option<Range<usize>> {
        self.layout.iter().find(|l| l.0 == component).map(|l| l.1.clone())
    }

    /// Iterates over the entries of the vector in order: single numbers, and three for each torque sensor. `actuation` is the model for which the
    /// vector was laid out.
    pub fn entries(&self, model: &Model, actuation: &dyn Actuation) -> Vec<ProprioceptionEntry> {
        let mut entries = Vec::new();
        for (component, range) in &self.layout {
            let names: Vec<String> = match component {
                ProprioceptionComponent::Angles
                | ProprioceptionComponent::Velocities
                | ProprioceptionComponent::Limits => self.joint_names(model).map(str::to_string).collect(),
                ProprioceptionComponent::Torques => self.sensor_names(model).map(str::to_string).collect(),
                ProprioceptionComponent::Actuation => actuation.observation_names(model),
            };
            let width = if *component == ProprioceptionComponent::Torques {
                3
            } else {
                1
            };
            entries.extend(names.into_iter().enumerate().map(|(k, name)| ProprioceptionEntry {
                range: range.start + width * k..range.start + width * (k + 1),
                component: *component,
                name,
            }));
        }
        entries
    }

    /// Returns the index of a joint's number in angles, velocities or limits, or of a sensor's three numbers in torques, by name. `None`
    /// for a component that is off, for [`ProprioceptionComponent::Actuation`] (see [`Self::entries`]) and unknown names.
    pub fn find(&self, model: &Model, component: ProprioceptionComponent, name: &str) -> Option<Range<usize>> {
        let start = self.range(component)?.start;
        let (k, width) = match component {
            ProprioceptionComponent::Angles | ProprioceptionComponent::Velocities | ProprioceptionComponent::Limits => {
                (self.joint_names(model).position(|n| n == name)?, 1)
            }
            ProprioceptionComponent::Torques => (self.sensor_names(model).position(|n| n == name)?, 3),
            ProprioceptionComponent::Actuation => return None,
        };
        Some(start + width * k..start + width * (k + 1))
    }

    /// Returns MIMo's joints, in the order of angles, velocities and limits.
    pub fn joints(&self) -> &MimoJoints {
        &self.joints
    }

    /// Iterates over the names of the joints.
    pub fn joint_names<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = &'a str> {
        self.joints.joint.iter().map(|&j| model.jnt_name[j].as_str())
    }

    /// Iterates over the names of the torque sensors.
    pub fn sensor_names<'a>(&'a self, model: &'a Model) -> impl Iterator<Item = &'a str> {
        self.torque_sensors.iter().map(|&i| model.sensor_name[i].as_str())
    }

    /// Writes the vector, of length [`Self::len`]. If `out` has another length, as much as possible is written.
    pub fn observe(&self, model: &Model, s: &State, actuation: &dyn Actuation, out: &mut [f64]) {
        for (component, range) in &self.layout {
            let Some(out) = out.get_mut(range.clone()) else {
                return;
            };
            match component {
                ProprioceptionComponent::Angles => gather(&s.qpos, &self.joints.qpos, out),
                ProprioceptionComponent::Velocities => gather(&s.qvel, &self.joints.dof, out),
                ProprioceptionComponent::Torques => {
                    for (values, &i) in out.chunks_exact_mut(3).zip(&self.torque_adr) {
                        values.copy_from_slice(&s.sensordata[i..i + 3]);
                    }
                }
                ProprioceptionComponent::Limits => {
                    for ((v, &j), &q) in out.iter_mut().zip(&self.joints.joint).zip(&self.joints.qpos) {
                        *v = limit_activation(s.qpos[q], model.jnt_range[j]);
                    }
                }
                ProprioceptionComponent::Actuation => actuation.observe(model, s, out),
            }
        }
    }
}

fn gather(from: &[f64], at: &[usize], out: &mut [f64]) {
    for (v, &k) in out.iter_mut().zip(at) {
        *v = from[k];
    }
}

/// Returns the strength with which a joint limit is felt at angle `q` (rad): 0 inside the range, rising linearly to 1 over the
/// last 0.035 rad before either limit, and further beyond it.
pub fn limit_activation(q: f64, range: [f64; 2]) -> f64 {
    let inside = (q - (range[0] + LIMIT_THRESHOLD)).min((range[1] - LIMIT_THRESHOLD) - q);
    (-(inside / LIMIT_THRESHOLD)).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_of_the_elbow_are_felt_as_specified() {
        let range @ [lo, hi] = [-146f64.to_radians(), 5f64.to_radians()];
        for (q, expect) in [
            (lo + 0.0175, 0.5),
            (lo, 1.0),
            (lo - 0.0175, 1.5),
            (hi - 0.02, 0.428_571_428_571_428_6),
            (hi + 0.01, 1.285_714_285_714_285_7),
            (-1.0, 0.0),
        ] {
            assert!((limit_activation(q, range) - expect).abs() < 1e-12, "{q}");
        }
    }
}

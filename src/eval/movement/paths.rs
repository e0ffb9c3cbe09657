//! The movements of an episode: ends of limbs, segments of the body, joints.

use super::LIMBS;
use crate::env::{Env, EnvError};
use crate::math::{Mat3, Vec3, column, dot, sub};
use crate::physics::kinematics;
use crate::runs::{Record, RecordError};

/// Segments of the body whose turns are followed, in the order of [`BodyPaths::front`].
pub(super) const SEGMENTS: [&str; 5] = ["head", "shoulders", "pelvis", "right_leg", "left_leg"];
/// Their bodies; the chest is a body of its own in MIMo 3, and has the shoulders.
const BODIES: [&[&str]; 5] = [
    &["head"],
    &["chest", "upper_body"],
    &["hip"],
    &["right_upper_leg"],
    &["left_upper_leg"],
];

/// The paths of an episode, a sample for each step.
#[derive(Clone, Debug, Default)]
pub(super) struct BodyPaths {
    /// Time of a step, s.
    pub dt: f64,
    /// Ends of the limbs in the world, m.
    pub world: [Vec<Vec3>; 4],
    /// The same in the frame of the hip.
    pub hip: [Vec<Vec3>; 4],
    /// Left of the hip, at rest, as the sign of its y axis.
    pub left: f64,
    /// Upward component of the direction in which the front of each segment faces: 1 supine, -1 prone.
    pub front: [Vec<f64>; 5],
    /// Names of MIMo's joints, without prefix.
    pub joints: Vec<String>,
    /// Their angles, rad, and velocities, rad/s, by joint.
    pub angle: Vec<Vec<f64>>,
    pub velocity: Vec<Vec<f64>>,
}

impl BodyPaths {
    /// Returns the number of steps.
    pub fn len(&self) -> usize {
        self.world[0].len()
    }

    /// Returns the index of a joint.
    pub fn joint(&self, name: &str) -> Option<usize> {
        self.joints.iter().position(|joint| joint == name)
    }

    /// Computes the paths of an episode from its positions, with the body's age and sizes of that time.
    pub fn of_episode(record: &Record, episode: u64) -> Result<Self, RecordError> {
        let path = record.path(episode)?;
        let unfit = |reason: &str| RecordError::Unfit {
            path: path.clone(),
            reason: reason.to_string(),
        };
        let npz = record.npz(episode)?;
        let (positions, velocities) = (npz.get_f64("qpos")?, npz.get_f64("qvel")?);
        let manifest = record.manifest();
        let mut env = record.env_of(episode)?;
        let [nq, nv] = [env.state().qpos.len(), env.state().qvel.len()];
        let steps = positions.shape.first().copied().unwrap_or(0);
        if positions.shape != [steps, nq] || velocities.shape != [steps, nv] {
            return Err(unfit("its positions do not match its configuration"));
        }
        if !(manifest.dt.is_finite() && manifest.dt > 0.0) {
            return Err(unfit("the time of a step is not a positive number"));
        }
        if manifest.joints.iter().any(|joint| joint.qpos >= nq || joint.dof >= nv) {
            return Err(unfit("its joints do not match its configuration"));
        }
        let column = |data: &[f64], width: usize, at: usize| -> Vec<f64> {
            data.iter().skip(at).step_by(width.max(1)).copied().collect()
        };
        let name = |name: &str| name.strip_prefix("robot:").unwrap_or(name).to_string();
        let mut found = Self {
            dt: manifest.dt,
            joints: manifest.joints.iter().map(|joint| name(&joint.name)).collect(),
            angle: manifest
                .joints
                .iter()
                .map(|j| column(&positions.data, nq, j.qpos))
                .collect(),
            velocity: manifest
                .joints
                .iter()
                .map(|j| column(&velocities.data, nv, j.dof))
                .collect(),
            ..Self::default()
        };
        found.follow(&mut env, &positions.data).map_err(RecordError::Env)?;
        Ok(found)
    }

    /// Follows the bodies through rows of positions.
    fn follow(&mut self, env: &mut Env, rows: &[f64]) -> Result<(), EnvError> {
        let model = env.model().clone();
        let find = |names: &[&str]| names.iter().find_map(|name| model.body(name));
        let missing = |name: &str| EnvError::Missing {
            what: "body",
            name: name.to_string(),
            purpose: "measures of movement",
        };
        let hip = find(&["hip"]).ok_or_else(|| missing("hip"))?;
        let mut limbs = [0; 4];
        for (limb, name) in limbs.iter_mut().zip(LIMBS) {
            *limb = find(&[name]).ok_or_else(|| missing(name))?;
        }
        let mut segments = [0; 5];
        for (segment, names) in segments.iter_mut().zip(BODIES) {
            *segment = find(names).ok_or_else(|| missing(names[names.len() - 1]))?;
        }
        let state = env.state_mut();
        // the directions of the fronts are those of a body whose joints are at 0
        state.qpos.copy_from_slice(&model.qpos0);
        kinematics(&model, state);
        let ahead = column(&state.xmat[hip], 0);
        let fronts = segments.map(|body| local(&state.xmat[body], ahead));
        let across = sub(state.xpos[limbs[1]], state.xpos[hip]);
        self.left = dot(across, column(&state.xmat[hip], 1)).signum();
        for row in rows.chunks_exact(state.qpos.len().max(1)) {
            state.qpos.copy_from_slice(row);
            kinematics(&model, state);
            for (k, &limb) in limbs.iter().enumerate() {
                let place = state.xpos[limb];
                self.world[k].push(place);
                self.hip[k].push(local(&state.xmat[hip], sub(place, state.xpos[hip])));
            }
            for ((out, &body), front) in self.front.iter_mut().zip(&segments).zip(&fronts) {
                // the third row: what of the front is vertical
                let frame = &state.xmat[body];
                out.push((0..3).map(|k| column(frame, k)[2] * front[k]).sum());
            }
        }
        Ok(())
    }
}

/// Returns a direction in the axes of a frame.
fn local(frame: &Mat3, direction: Vec3) -> Vec3 {
    std::array::from_fn(|k| dot(direction, column(frame, k)))
}

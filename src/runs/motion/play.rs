//! Motions played by MIMo.

use super::track::Tracker;
use super::{Motion, MotionError};
use crate::env::Env;
use crate::math::{Quat, Vec3, add_scaled, quat_normalize, rotation_between, scale, sub};
use crate::model::{JointType, Model};
use crate::runs::Recorder;
use crate::text::{nearest, quoted, suggestion};

/// The way of playing a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum MotionMode {
    /// MIMo is moved to each pose, with the velocities that lead from one to the next; nothing acts on him. Everything else stays where
    /// it was, at rest.
    #[default]
    Kinematic,
    /// MIMo's motors follow the angles. Physics moves everything, including the root.
    Tracking,
}

/// Outcome of playing a motion.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct MotionResult {
    /// Number of steps of the environment.
    pub steps: u64,
    /// Distance of the joints from the motion, rad: root mean square over steps and joints. 0 when played kinematically.
    pub error: f64,
    /// The joint with the largest distance, and that distance, rad.
    pub worst: Option<(String, f64)>,
    /// Joints whose range the motion leaves.
    pub beyond_limits: Vec<String>,
}

/// Plays a motion in an environment that was reset, and records what MIMo would feel and see as an episode of a record, if the recorder
/// and the number of the episode are given.
///
/// MIMo starts in the first frame. Step k, from 0, shows the motion `k dt` later, with linear interpolation between frames; tracking aims
/// at the pose `dt` later. Joints that the motion does not name stay as the reset left them, or are held there. Played kinematically,
/// actions are 0. After each step `each` returns whether to continue.
///
/// # Errors
/// Joints or a root that MIMo does not have; muscles, which cannot follow angles; a simulation that diverged; errors of the record.
pub fn play_motion(
    env: &mut Env,
    motion: &Motion,
    playing: MotionMode,
    recorder: Option<(&mut Recorder, u64)>,
    mut each: impl FnMut(&Env) -> bool,
) -> Result<MotionResult, MotionError> {
    let course = MotionTrajectory::new(env, motion)?;
    let dt = env.blueprint().dt();
    // times just below a whole number of steps, by rounding, count as that number
    let steps = (motion.seconds() / dt + 1e-6).floor() as u64 + 1;
    let mut played = MotionResult {
        beyond_limits: course.beyond_limits(env.model()),
        ..MotionResult::default()
    };
    let mut errors = vec![0.0; course.joints.len()];
    let (mut qpos, mut qvel) = (env.state().qpos.clone(), vec![0.0; env.state().qvel.len()]);
    let mut tracker = match playing {
        MotionMode::Kinematic => None,
        MotionMode::Tracking => Some(Tracker::new(env)?),
    };
    // from the start of the motion, so that tracking begins without a jump
    course.at(0.0, dt, &mut qpos, &mut qvel);
    env.by_hand().set_state(&qpos, &qvel)?;
    let mut recorder = recorder.map(|(recorder, episode)| {
        recorder.begin(env, episode);
        recorder
    });
    let still = vec![0.0; env.action_space().len()];
    for step in 0..steps {
        // a tracked step should end where the motion is then; a shown one is the pose itself
        let time = if tracker.is_some() { step + 1 } else { step } as f64 * dt;
        course.at(time.min(motion.seconds()), dt, &mut qpos, &mut qvel);
        match &mut tracker {
            None => {
                env.by_hand().show(&qpos, &qvel)?;
                if let Some(recorder) = &mut recorder {
                    env.senses_mut().look()?;
                    // no action led there, and the archive needs one for each step
                    recorder.note(env, &still)?;
                }
            }
            Some(tracker) => {
                let action = tracker.action(env, &qpos, &qvel);
                follow(env, action, recorder.as_deref_mut())?;
                let found = &env.state().qpos;
                for (error, joint) in errors.iter_mut().zip(&course.joints) {
                    let off = found[joint.qpos] - qpos[joint.qpos];
                    *error += off * off;
                }
            }
        }
        played.steps += 1;
        if !each(env) {
            break;
        }
    }
    if let Some(recorder) = recorder {
        recorder.end(env)?;
    }
    played.conclude(&errors, motion);
    Ok(played)
}

/// Takes a step with an action, and records it if there is a recorder.
fn follow(env: &mut Env, action: &[f32], recorder: Option<&mut Recorder>) -> Result<(), MotionError> {
    match recorder {
        Some(recorder) => recorder.step(env, action)?,
        None => drop(env.step(action)?),
    }
    Ok(())
}

impl MotionResult {
    /// Computes the distances of the joints from the sums of squares.
    fn conclude(&mut self, squares: &[f64], motion: &Motion) {
        let steps = self.steps.max(1) as f64;
        let total: f64 = squares.iter().sum();
        self.error = (total / (steps * squares.len().max(1) as f64)).sqrt();
        let worst = squares.iter().zip(motion.names()).max_by(|a, b| a.0.total_cmp(b.0));
        self.worst = worst
            .filter(|(square, _)| **square > 0.0)
            .map(|(square, name)| (name.clone(), (square / steps).sqrt()));
    }
}

/// A joint that a motion moves.
#[derive(Clone, Copy, Debug)]
struct JointAddress {
    joint: usize,
    qpos: usize,
    dof: usize,
}

/// A motion as positions and velocities of a scene.
struct MotionTrajectory<'m> {
    motion: &'m Motion,
    joints: Vec<JointAddress>,
    /// Indices of the root in positions and velocities.
    root: Option<(usize, usize)>,
}

impl<'m> MotionTrajectory<'m> {
    fn new(env: &Env, motion: &'m Motion) -> Result<Self, MotionError> {
        let model = env.model();
        let own = env.senses().proprioception().joints();
        let find = |name: &String| {
            let found = own.joint.iter().position(|&joint| model.jnt_name[joint] == *name);
            found.ok_or_else(|| MotionError::Joint {
                hint: suggestion(nearest(name, own.joint.iter().map(|&joint| &*model.jnt_name[joint]))),
                name: quoted(name),
            })
        };
        let place = |k: usize| JointAddress {
            joint: own.joint[k],
            qpos: own.qpos[k],
            dof: own.dof[k],
        };
        let joints = motion.names().iter().map(|name| find(name).map(place));
        let root = motion.root().map(|_| free_root(model).ok_or(MotionError::Root));
        Ok(Self {
            motion,
            joints: joints.collect::<Result<_, _>>()?,
            root: root.transpose()?,
        })
    }

    /// Returns the names of the joints whose range the motion leaves.
    fn beyond_limits(&self, model: &Model) -> Vec<String> {
        let (n, mut beyond) = (self.joints.len(), Vec::new());
        for (k, place) in self.joints.iter().enumerate() {
            let [low, high] = model.jnt_range[place.joint];
            let mut angles = self.motion.angles().iter().skip(k).step_by(n.max(1));
            if model.jnt_limited[place.joint] && angles.any(|&angle| angle < low - 1e-3 || angle > high + 1e-3) {
                beyond.push(model.jnt_name[place.joint].clone());
            }
        }
        beyond
    }

    /// Writes positions at a time, s, and their velocities: central differences over the neighbouring steps.
    fn at(&self, time: f64, dt: f64, qpos: &mut [f64], qvel: &mut [f64]) {
        let end = self.motion.seconds();
        // central differences, which become one-sided at both ends of the motion
        let (before, after) = ((time - dt).max(0.0), (time + dt).min(end));
        let span = after - before;
        let per_second = if span > 0.0 { 1.0 / span } else { 0.0 };
        for (k, place) in self.joints.iter().enumerate() {
            qpos[place.qpos] = self.angle(k, time);
            qvel[place.dof] = (self.angle(k, after) - self.angle(k, before)) * per_second;
        }
        let (Some((at, dof)), Some(poses)) = (self.root, self.motion.root()) else {
            return;
        };
        let (pos, quat) = self.pose(poses, time);
        let (first, last) = (self.pose(poses, before), self.pose(poses, after));
        qpos[at..at + 3].copy_from_slice(&pos);
        qpos[at + 3..at + 7].copy_from_slice(&quat);
        qvel[dof..dof + 3].copy_from_slice(&scale(sub(last.0, first.0), per_second));
        qvel[dof + 3..dof + 6].copy_from_slice(&scale(rotation_between(first.1, last.1), per_second));
    }

    /// Returns the frames around a time, and its fraction of the way from the first to the second.
    fn frames(&self, time: f64) -> (usize, usize, f64) {
        let last = self.motion.frames() - 1;
        let at = (time * self.motion.rate()).clamp(0.0, last as f64);
        // times that miss a frame only by rounding are that frame
        let near = at.round();
        if (at - near).abs() < 1e-6 {
            return (near as usize, near as usize, 0.0);
        }
        let first = at.floor() as usize;
        (first, (first + 1).min(last), at - first as f64)
    }

    fn angle(&self, joint: usize, time: f64) -> f64 {
        let (first, second, share) = self.frames(time);
        let (angles, n) = (self.motion.angles(), self.joints.len());
        let (a, b) = (angles[first * n + joint], angles[second * n + joint]);
        a + share * (b - a)
    }

    fn pose(&self, poses: &[(Vec3, Quat)], time: f64) -> (Vec3, Quat) {
        let (first, second, share) = self.frames(time);
        let ((p, q), (r, s)) = (poses[first], poses[second]);
        let along: f64 = q.iter().zip(&s).map(|(a, b)| a * b).sum();
        // both signs of a quaternion are the same rotation; use the nearer one
        let sign = if along < 0.0 { -1.0 } else { 1.0 };
        let turned = std::array::from_fn(|i| q[i] + share * (sign * s[i] - q[i]));
        (add_scaled(p, sub(r, p), share), quat_normalize(turned))
    }
}

/// Returns the indices of MIMo's free joint in positions and velocities, if he has one.
fn free_root(model: &Model) -> Option<(usize, usize)> {
    let mut body = model.body("hip")?;
    // the free joint may be that of a body above the hip, on which MIMo is placed
    while body > 0 {
        let first = model.body_jntadr[body];
        if model.body_jntnum[body] > 0 && model.jnt_type[first] == JointType::Free {
            return Some((model.jnt_qposadr[first], model.jnt_dofadr[first]));
        }
        body = model.body_parentid[body];
    }
    None
}

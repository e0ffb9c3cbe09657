//! The rows of an episode in memory, and its archive.

use super::RecordOptions;
use crate::env::{BehaviorInfo, Env, PerEyeAndHand};
use crate::formats::npz::{Element, Half, NpzError, NpzWriter, Packing};
use crate::sensors::ObservationEntry;
use crate::sensors::transform::Sense;
use crate::spaces::{Array, Values};

/// The names of arrays with their types.
pub(super) type ArrayTypes = Vec<(String, &'static str)>;

/// Nonzero values, step by step.
#[derive(Debug, Default)]
struct SparseRows {
    ptr: Vec<i32>,
    idx: Vec<i32>,
    val: Vec<Half>,
    len: i64,
}

/// The contacts of each step.
#[derive(Debug, Default)]
struct ContactRows {
    ptr: Vec<i32>,
    geom: Vec<u16>,
    pos: Vec<f32>,
    dist: Vec<f32>,
    force: Vec<f32>,
}

/// The counters of the behavior in each step.
#[derive(Debug, Default)]
struct BehaviorRows {
    first_touch_step: Vec<i32>,
    first_touch_hand: Vec<u8>,
    first_touch_geom: Vec<i32>,
    /// Number of parts that each hand had touched before.
    touched: [usize; 2],
    regards: Vec<i32>,
    gaze_angles: Vec<f32>,
    is_success: Vec<u8>,
    is_failure: Vec<u8>,
    episode_return: Vec<f64>,
}

/// Prefix of the names of changed arrays of the model.
pub(super) const MODEL: &str = "model.";

/// An episode that is being recorded.
#[derive(Debug, Default)]
pub(super) struct EpisodeRows {
    dt: f64,
    columns: [usize; 3],
    snapshot: Vec<u8>,
    /// A program's changes of the model.
    changes: Vec<(&'static str, Vec<f64>)>,
    qpos0: Vec<f64>,
    qvel0: Vec<f64>,
    activity0: Vec<f64>,
    drawn: Vec<i64>,
    actions: Vec<f32>,
    qpos: Vec<f32>,
    qvel: Vec<f32>,
    checksum: Vec<i64>,
    touch: Option<SparseRows>,
    contacts: ContactRows,
    reward: Vec<f64>,
    terminated: Vec<u8>,
    truncated: Vec<u8>,
    told: BehaviorRows,
    senses: Vec<(&'static ObservationEntry, Array)>,
    eye_steps: Vec<i32>,
    eye_sizes: [[usize; 2]; 2],
}

impl EpisodeRows {
    /// Starts an episode.
    pub fn new(env: &Env, options: &RecordOptions) -> Self {
        let mut rows = Self::default();
        rows.begin(env, options);
        rows
    }

    /// Starts an episode with the allocations of the last one.
    pub fn begin(&mut self, env: &Env, options: &RecordOptions) {
        // an episode's rows are reused by the next, without new allocations
        self.clear();
        let state = env.state();
        self.dt = env.blueprint().dt();
        self.columns = [env.action_space().len(), state.qpos.len(), state.qvel.len()];
        self.snapshot = env.snapshot().as_bytes().to_vec();
        self.changes = env.blueprint().changed_numbers();
        self.qpos0.clone_from(&state.qpos);
        self.qvel0.clone_from(&state.qvel);
        self.activity0.clone_from(&state.act);
        self.eye_sizes = env.config().eye_sizes();
        if let Some(touch) = env.senses().touch() {
            let sparse = self.touch.get_or_insert_default();
            (sparse.ptr, sparse.len) = (vec![0], touch.len() as i64);
        }
        self.contacts.ptr.push(0);
        self.told.begin(&env.info().behavior);
        let wanted = |entry: &&ObservationEntry| match (entry.sense, entry.image) {
            (Some(Sense::Touch), _) => false,
            (_, Some(_)) => options.eyes_every.is_some(),
            _ => options.senses,
        };
        let spaces = env.observation_space();
        let there = |entry: &&ObservationEntry| spaces.iter().any(|space| space.key == entry.key);
        let entries = ObservationEntry::ALL.iter().filter(wanted).filter(there);
        self.senses = entries.map(|entry| (entry, Array::zeros(entry.dtype, 0))).collect();
    }

    /// Returns the number of steps.
    pub fn len(&self) -> usize {
        self.checksum.len()
    }

    /// Clears the episode but keeps the allocations.
    pub fn clear(&mut self) {
        if let Some(touch) = &mut self.touch {
            touch.ptr.clear();
            touch.idx.clear();
            touch.val.clear();
        }
        let ContactRows {
            ptr,
            geom,
            pos,
            dist,
            force,
        } = &mut self.contacts;
        ptr.clear();
        geom.clear();
        [pos, dist, force].into_iter().for_each(Vec::clear);
        [&mut self.actions, &mut self.qpos, &mut self.qvel]
            .into_iter()
            .for_each(Vec::clear);
        [&mut self.drawn, &mut self.checksum].into_iter().for_each(Vec::clear);
        [&mut self.terminated, &mut self.truncated]
            .into_iter()
            .for_each(Vec::clear);
        self.reward.clear();
        self.told = BehaviorRows::default();
        self.senses.clear();
        self.eye_steps.clear();
    }

    /// Adds a step. `drawn` is the number of values that the generator had drawn before it.
    pub fn push(&mut self, env: &Env, action: &[f32], drawn: u64, options: &RecordOptions) {
        let (state, observation) = (env.state(), env.observation());
        let step = self.len();
        self.drawn.push(drawn as i64);
        self.actions.extend_from_slice(action);
        // for analysis, at half the size; a replay computes the exact numbers, which the checksum checks
        self.qpos.extend(state.qpos.iter().map(|&q| q as f32));
        self.qvel.extend(state.qvel.iter().map(|&q| q as f32));
        if let (Some(touch), Some(values)) = (&mut self.touch, observation.touch) {
            nonzero(values, |index, value| {
                touch.idx.push(index);
                touch.val.push(Half::new(value));
            });
            touch.ptr.push(touch.idx.len() as i32);
        }
        self.contacts.push(env);
        let last = env.last_step();
        self.reward.push(last.reward);
        self.terminated.push(u8::from(last.terminated));
        self.truncated.push(u8::from(last.truncated));
        self.told.push(step, env);
        let pictures = options
            .eyes_every
            .is_some_and(|every| (step as u64).is_multiple_of(every.max(1)));
        if pictures {
            self.eye_steps.push(step as i32);
        }
        for (entry, rows) in &mut self.senses {
            if let Some(values) = observation.get(entry.key).filter(|_| entry.image.is_none() || pictures) {
                rows.extend(values);
            }
        }
        // last, because it covers everything that the step has left
        self.checksum.push(checksum(env));
    }

    /// Returns the checksum of the last step.
    pub fn last_checksum(&self) -> i64 {
        self.checksum.last().copied().unwrap_or(0)
    }

    /// Returns the archive of the episode, and the names of its arrays with their types.
    pub fn archive(&self) -> Result<(NpzWriter, ArrayTypes), NpzError> {
        let mut out = TypedArchive::default();
        let (t, [na, nq, nv]) = (self.len(), self.columns);
        out.put("snapshot", &[self.snapshot.len()], &self.snapshot, Packing::Fast)?;
        for (name, numbers) in &self.changes {
            out.put(&format!("{MODEL}{name}"), &[numbers.len()], numbers, Packing::Fast)?;
        }
        out.put("qpos0", &[nq], &self.qpos0, Packing::Stored)?;
        out.put("qvel0", &[nv], &self.qvel0, Packing::Stored)?;
        out.put("activity0", &[self.activity0.len()], &self.activity0, Packing::Stored)?;
        out.put("drawn", &[t], &self.drawn, Packing::Fast)?;
        let time: Vec<f64> = (1..=t).map(|step| step as f64 * self.dt).collect();
        out.put("time", &[t], &time, Packing::Fast)?;
        out.put("actions", &[t, na], &self.actions, Packing::Fast)?;
        out.put("qpos", &[t, nq], &self.qpos, Packing::Stored)?;
        out.put("qvel", &[t, nv], &self.qvel, Packing::Stored)?;
        out.put("checksum", &[t], &self.checksum, Packing::Stored)?;
        if let Some(touch) = &self.touch {
            out.put("touch_ptr", &[t + 1], &touch.ptr, Packing::Fast)?;
            // indices into a skin of usual size take two bytes
            if touch.len <= 1 << 16 {
                let idx: Vec<u16> = touch.idx.iter().map(|&at| at as u16).collect();
                out.put("touch_idx", &[idx.len()], &idx, Packing::Fast)?;
            } else {
                out.put("touch_idx", &[touch.idx.len()], &touch.idx, Packing::Fast)?;
            }
            out.put("touch_val", &[touch.val.len()], &touch.val, Packing::Stored)?;
            out.put("touch_len", &[], &[touch.len], Packing::Stored)?;
        }
        self.contacts.write(&mut out)?;
        out.put("reward", &[t], &self.reward, Packing::Fast)?;
        out.put("terminated", &[t], &self.terminated, Packing::Fast)?;
        out.put("truncated", &[t], &self.truncated, Packing::Fast)?;
        self.told.write(&mut out, t)?;
        for (entry, rows) in &self.senses {
            let (values, count) = (
                rows.values(),
                if entry.image.is_some() { self.eye_steps.len() } else { t },
            );
            let columns = values.len().checked_div(count).unwrap_or(0);
            let shape: Vec<usize> = match entry.image {
                Some(_) => {
                    let [width, height] = self.eye_sizes[entry.sense.and_then(Sense::eye).unwrap_or_default()];
                    let channels = columns.checked_div(width * height).unwrap_or(0);
                    let mut shape = vec![count, height, width];
                    shape.extend((channels > 1).then_some(channels));
                    shape
                }
                None => vec![count, columns],
            };
            match values {
                Values::F64(v) => out.put(entry.key, &shape, v, Packing::Stored)?,
                Values::F32(v) => out.put(entry.key, &shape, v, Packing::Fast)?,
                Values::U8(v) => out.put(entry.key, &shape, v, Packing::Fast)?,
                Values::I32(v) => out.put(entry.key, &shape, v, Packing::Fast)?,
            }
        }
        if !self.eye_steps.is_empty() {
            out.put("eye_steps", &[self.eye_steps.len()], &self.eye_steps, Packing::Fast)?;
            let [[side, _], _] = self.eye_sizes;
            if self.eye_sizes == [[side; 2]; 2] {
                out.put("eye_size", &[], &[side as i64], Packing::Stored)?;
            }
        }
        Ok((out.npz, out.names))
    }
}

/// An archive with the types of its arrays.
#[derive(Default)]
struct TypedArchive {
    npz: NpzWriter,
    names: ArrayTypes,
}

impl TypedArchive {
    fn put<T: Element>(&mut self, name: &str, shape: &[usize], data: &[T], packing: Packing) -> Result<(), NpzError> {
        self.names.push((name.to_string(), T::dtype()));
        self.npz.add_packed(name, shape, data, packing)
    }
}

impl ContactRows {
    fn push(&mut self, env: &Env) {
        for contact in &env.state().contact {
            self.geom.extend(contact.geom.map(|geom| geom as u16));
            self.pos.extend(contact.pos.map(|x| x as f32));
            self.dist.push(contact.dist as f32);
            self.force.extend(contact.force[..3].iter().map(|&f| f as f32));
        }
        self.ptr.push(self.dist.len() as i32);
    }

    fn write(&self, out: &mut TypedArchive) -> Result<(), NpzError> {
        let n = self.dist.len();
        out.put("contact_ptr", &[self.ptr.len()], &self.ptr, Packing::Fast)?;
        out.put("contact_geom", &[n, 2], &self.geom, Packing::Fast)?;
        out.put("contact_pos", &[n, 3], &self.pos, Packing::Stored)?;
        out.put("contact_dist", &[n], &self.dist, Packing::Stored)?;
        out.put("contact_force", &[n, 3], &self.force, Packing::Stored)
    }
}

impl BehaviorRows {
    /// Records the touches before the first step, for lists that continue from episode to episode.
    fn begin(&mut self, behavior: &BehaviorInfo) {
        self.touched = behavior.touches().map_or([0; 2], |touches| touches.map(<[usize]>::len));
    }

    fn push(&mut self, step: usize, env: &Env) {
        match &env.info().behavior {
            BehaviorInfo::None => {}
            BehaviorInfo::SelfTouch { touches } => {
                for (hand, geoms) in touches.each_ref().into_iter().enumerate() {
                    let known = std::mem::replace(&mut self.touched[hand], geoms.len());
                    for &geom in geoms.get(known..).unwrap_or_default() {
                        self.first_touch_step.push(step as i32);
                        self.first_touch_hand.push(hand as u8);
                        self.first_touch_geom.push(geom as i32);
                    }
                }
            }
            BehaviorInfo::HandRegard { counts } => {
                self.regards.extend(counts.to_array().map(|count| count as i32));
                let angles = env.info().details.gaze_angles;
                let angles = angles.map_or([f64::NAN; 4], PerEyeAndHand::to_array);
                self.gaze_angles.extend(angles.map(|angle| angle as f32));
            }
            BehaviorInfo::Task(info) => {
                self.is_success.push(u8::from(info.outcome.is_success));
                self.is_failure.push(u8::from(info.outcome.is_failure));
                self.episode_return.push(info.episode_return);
            }
        }
    }

    fn write(&self, out: &mut TypedArchive, t: usize) -> Result<(), NpzError> {
        let n = self.first_touch_step.len();
        if self.regards.is_empty() && self.episode_return.is_empty() {
            out.put("first_touch_step", &[n], &self.first_touch_step, Packing::Fast)?;
            out.put("first_touch_hand", &[n], &self.first_touch_hand, Packing::Fast)?;
            out.put("first_touch_geom", &[n], &self.first_touch_geom, Packing::Fast)?;
        }
        if self.regards.len() == 4 * t {
            out.put("regards", &[t, 4], &self.regards, Packing::Fast)?;
            out.put("gaze_angles", &[t, 4], &self.gaze_angles, Packing::Fast)?;
        }
        if self.episode_return.len() == t {
            out.put("is_success", &[t], &self.is_success, Packing::Fast)?;
            out.put("is_failure", &[t], &self.is_failure, Packing::Fast)?;
            out.put("return", &[t], &self.episode_return, Packing::Fast)?;
        }
        Ok(())
    }
}

/// Visits the indices and values that are not zero.
fn nonzero(values: &[f32], mut each: impl FnMut(i32, f32)) {
    const BLOCK: usize = 32;
    for (block, chunk) in values.chunks(BLOCK).enumerate() {
        // nearly all sensors are zero; the shift drops the sign of a zero
        if chunk.iter().fold(0, |any, v| any | (v.to_bits() << 1)) == 0 {
            continue;
        }
        for (k, &value) in chunk.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            each((block * BLOCK + k) as i32, value);
        }
    }
}

/// Computes the checksum of all bits of positions, velocities, observation and reward after a step.
pub(super) fn checksum(env: &Env) -> i64 {
    let mut sum = StateHasher(0xcbf2_9ce4_8422_2325);
    let state = env.state();
    for number in state.qpos.iter().chain(&state.qvel) {
        sum.add(number.to_bits());
    }
    for (_, values) in env.observation().entries() {
        match values {
            Values::F64(values) => values.iter().for_each(|v| sum.add(v.to_bits())),
            // with the index, because zeros are skipped
            Values::F32(values) => nonzero(values, |k, v| sum.add((k as u64) << 32 | u64::from(v.to_bits()))),
            Values::I32(values) => values.iter().for_each(|&v| sum.add(v as u64)),
            Values::U8(values) => {
                let (words, rest) = values.as_chunks::<8>();
                words.iter().for_each(|word| sum.add(u64::from_le_bytes(*word)));
                rest.iter().for_each(|&byte| sum.add(u64::from(byte)));
            }
        }
    }
    sum.add(env.last_step().reward.to_bits());
    sum.0 as i64
}

/// The hash of Fowler, Noll and Vo over words instead of bytes, rotated so that high bits reach low ones.
struct StateHasher(u64);

impl StateHasher {
    #[inline(always)]
    fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(29);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_zero_is_found_in_any_place() {
        let mut values = vec![0.0; 100];
        for (k, v) in [(0, 1.0), (31, -2.0), (32, f32::MIN_POSITIVE), (99, 3.0)] {
            values[k] = v;
        }
        values[50] = -0.0;
        let mut found = Vec::new();
        nonzero(&values, |k, v| found.push((k, v)));
        assert_eq!(found, [(0, 1.0), (31, -2.0), (32, f32::MIN_POSITIVE), (99, 3.0)]);
    }
}

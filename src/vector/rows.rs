//! Arrays over environments: a row for each.

use crate::config::{VisionOutput, VisionOutputs};
use crate::env::{BehaviorInfo, Env, Info, Observation, Outcome};
use crate::sensors::{EYES, EYES_DEPTH, EYES_GRAY, EYES_SEGMENTATION, EyeImages};
use crate::vector::VectorError;

/// Lengths of the rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Layout {
    pub action: usize,
    pub proprioception: usize,
    pub touch: Option<usize>,
    pub sensors: usize,
    pub pooled: Option<usize>,
    pub pain: Option<usize>,
    /// Pixels of an eye.
    pub pixels: Option<usize>,
    pub outputs: VisionOutputs,
    pub vestibular: Option<usize>,
    /// Number of geoms of the largest scene, if any environment's behavior is `self_touch`.
    pub geoms: Option<usize>,
    /// Whether any environment's behavior is `hand_regard`.
    pub regards: bool,
    /// Length of a goal, if the goals of the tasks have numbers.
    pub goal: Option<usize>,
    /// Number of terms of the rewards, if the tasks report outcomes.
    pub terms: Option<usize>,
}

impl Layout {
    /// Computes the layout of environments whose spaces are the same.
    pub fn new<'e>(envs: impl IntoIterator<Item = &'e Env>) -> Self {
        let mut layout = Self::default();
        for env in envs {
            let observation = env.observation();
            layout.action = env.action_space().len();
            layout.proprioception = observation.proprioception.len();
            layout.touch = observation.touch.map(<[f32]>::len);
            layout.sensors = env.senses().touch().map_or(0, |touch| touch.layout().len());
            layout.pooled = observation.touch_pooled.map(<[f64]>::len);
            layout.pain = observation.pain.map(<[f32]>::len);
            layout.pixels = env.senses().vision().map(|v| v.shape()[0] * v.shape()[1]);
            layout.outputs = env.config().vision_outputs;
            layout.vestibular = observation.vestibular.map(<[f64]>::len);
            layout.regards |= env.info().behavior.regards().is_some();
            layout.goal = observation.desired_goal.map(<[f64]>::len);
            layout.terms = env.info().behavior.task().is_some().then(|| env.goal().terms.len());
            if env.info().behavior.touches().is_some() {
                layout.geoms = layout.geoms.max(Some(env.model().ngeom()));
            }
        }
        layout
    }

    /// Returns the length of a row of images of one eye; `None` if they are not observed.
    pub fn eye(&self, output: VisionOutput) -> Option<usize> {
        let colours = if output == VisionOutput::Rgb { 3 } else { 1 };
        let observed = self.pixels.filter(|_| self.outputs.contains(output));
        observed.map(|pixels| pixels * colours)
    }

    /// Returns the size of a row of everything, bytes.
    pub fn row_bytes(&self) -> usize {
        let [touch, pooled, pain] = [self.touch, self.pooled, self.pain].map(Option::unwrap_or_default);
        let [vestibular, geoms] = [self.vestibular, self.geoms].map(Option::unwrap_or_default);
        let eye: usize = self.outputs.iter().map(|output| self.image_bytes(output)).sum();
        let goals = 2 * self.goal.unwrap_or_default() + self.terms.unwrap_or_default();
        let numbers = self.proprioception + pooled + vestibular + goals;
        8 * numbers + 4 * (touch + pain) + 4 * self.sensors + 2 * eye + 2 * geoms + 64
    }

    fn image_bytes(&self, output: VisionOutput) -> usize {
        let each = match output {
            VisionOutput::Rgb | VisionOutput::Gray => 1,
            VisionOutput::Depth | VisionOutput::Segmentation => 4,
        };
        each * self.eye(output).unwrap_or_default()
    }
}

/// Memory of the caller's for what a step returns: arrays of N rows each, environment after environment.
///
/// Senses that are `None` are left out.
#[derive(Debug, Default)]
pub struct Buffers<'a> {
    /// Proprioception, (N, len).
    pub proprioception: Option<&'a mut [f64]>,
    /// What the skins feel, (N, len), N.
    pub touch: Option<&'a mut [f32]>,
    /// What each body with skin feels, (N, bodies 5).
    pub touch_pooled: Option<&'a mut [f64]>,
    /// What hurts, (N, sensors).
    pub pain: Option<&'a mut [f32]>,
    /// What the left eyes see, (N, H W 3).
    pub eye_left: Option<&'a mut [u8]>,
    /// What the right eyes see, (N, H W 3).
    pub eye_right: Option<&'a mut [u8]>,
    /// What both eyes see in grey, left and right, (N, H W) each.
    pub eye_gray: Option<[&'a mut [u8]; 2]>,
    /// How far away it is, left and right, (N, H W) each, m.
    pub eye_depth: Option<[&'a mut [f32]; 2]>,
    /// Which geoms they are, left and right, (N, H W) each.
    pub eye_segmentation: Option<[&'a mut [i32]; 2]>,
    /// Balance, (N, 6), m/s^2 and rad/s.
    pub vestibular: Option<&'a mut [f64]>,
    /// The achieved goals, (N, len).
    pub achieved_goal: Option<&'a mut [f64]>,
    /// The desired goals, (N, len).
    pub desired_goal: Option<&'a mut [f64]>,
    /// Rewards (N).
    pub rewards: Option<&'a mut [f64]>,
    /// Whether episodes have ended in themselves (N).
    pub terminated: Option<&'a mut [bool]>,
    /// Whether episodes were cut off (N).
    pub truncated: Option<&'a mut [bool]>,
    /// For each row of `touch` (N) the sensors that are not zero there, if you keep both from call to call: then only what
    /// feels something is written, instead of thousands of zeros. Start with zeros and empty lists.
    pub touched: Option<&'a mut [Vec<u32>]>,
}

impl Buffers<'_> {
    /// Checks that there is room for exactly `n` rows.
    pub(super) fn check(&self, n: usize, layout: &Layout) -> Result<(), VectorError> {
        fn length<T>(buffer: &Option<&mut [T]>) -> Option<usize> {
            buffer.as_ref().map(|b| b.len())
        }
        fn lengths<T>(buffers: &Option<[&mut [T]; 2]>) -> [Option<usize>; 2] {
            let [left, right] = [0, 1].map(|eye| buffers.as_ref().map(|b| b[eye].len()));
            [left, right]
        }
        let (gray, depth) = (lengths(&self.eye_gray), lengths(&self.eye_depth));
        let geoms = lengths(&self.eye_segmentation);
        let eye = |output| layout.eye(output);
        for (what, found, len) in [
            (
                "proprioception",
                length(&self.proprioception),
                Some(layout.proprioception),
            ),
            ("touch", length(&self.touch), layout.touch),
            ("touch_pooled", length(&self.touch_pooled), layout.pooled),
            ("pain", length(&self.pain), layout.pain),
            (EYES[0], length(&self.eye_left), eye(VisionOutput::Rgb)),
            (EYES[1], length(&self.eye_right), eye(VisionOutput::Rgb)),
            (EYES_GRAY[0], gray[0], eye(VisionOutput::Gray)),
            (EYES_GRAY[1], gray[1], eye(VisionOutput::Gray)),
            (EYES_DEPTH[0], depth[0], eye(VisionOutput::Depth)),
            (EYES_DEPTH[1], depth[1], eye(VisionOutput::Depth)),
            (EYES_SEGMENTATION[0], geoms[0], eye(VisionOutput::Segmentation)),
            (EYES_SEGMENTATION[1], geoms[1], eye(VisionOutput::Segmentation)),
            ("vestibular", length(&self.vestibular), layout.vestibular),
            ("achieved_goal", length(&self.achieved_goal), layout.goal),
            ("desired_goal", length(&self.desired_goal), layout.goal),
            ("rewards", length(&self.rewards), Some(1)),
            ("terminated", length(&self.terminated), Some(1)),
            ("truncated", length(&self.truncated), Some(1)),
            ("touched", length(&self.touched), layout.touch.map(|_| 1)),
        ] {
            let Some(found) = found else { continue };
            let Some(len) = len else {
                return Err(VectorError::NoSense { what });
            };
            if found != n * len {
                let expected = [n, len];
                return Err(VectorError::Shape { what, expected, found });
            }
        }
        Ok(())
    }

    /// Writes what an environment observes. Of thousands of touch sensors only those that feel something are copied, where
    /// that is enough. There is room, which was checked before.
    pub(super) fn write(&mut self, row: usize, env: &Env) {
        let observation = env.observation();
        let (Some(touched), Some(out), Some(touch)) =
            (&mut self.touched, &mut self.touch, env.senses().touch_observed())
        else {
            return self.write_whole(row, &observation);
        };
        let (touched, width, values) = (&mut touched[row], touch.width(), touch.values());
        let out = &mut out[row * values.len()..(row + 1) * values.len()];
        let of = |sensor: u32| width * sensor as usize..width * (sensor as usize + 1);
        for &sensor in &*touched {
            // lists of the caller's may say anything
            if let Some(out) = out.get_mut(of(sensor)) {
                out.fill(0.0);
            }
        }
        touched.clear();
        touched.extend_from_slice(touch.touched());
        for &sensor in &*touched {
            out[of(sensor)].copy_from_slice(&values[of(sensor)]);
        }
        self.write_dense(row, &observation);
    }

    /// Writes a row from an observation that no environment holds any more. Do not mix it with [`Buffers::write`].
    pub(super) fn write_whole(&mut self, row: usize, observation: &Observation<'_>) {
        write(&mut self.touch, row, observation.touch);
        self.write_dense(row, observation);
    }

    pub(super) fn write_flags(&mut self, row: usize, reward: f64, terminated: bool, truncated: bool) {
        write(&mut self.rewards, row, Some(&[reward]));
        write(&mut self.terminated, row, Some(&[terminated]));
        write(&mut self.truncated, row, Some(&[truncated]));
    }

    /// Writes a row of everything but touch.
    fn write_dense(&mut self, row: usize, observation: &Observation<'_>) {
        write(&mut self.proprioception, row, Some(observation.proprioception));
        write(&mut self.touch_pooled, row, observation.touch_pooled);
        write(&mut self.pain, row, observation.pain);
        write(&mut self.eye_left, row, observation.eye_left);
        write(&mut self.eye_right, row, observation.eye_right);
        write_pair(&mut self.eye_gray, row, observation.eye_gray);
        write_pair(&mut self.eye_depth, row, observation.eye_depth);
        write_pair(&mut self.eye_segmentation, row, observation.eye_segmentation);
        write(&mut self.vestibular, row, observation.vestibular);
        write(&mut self.achieved_goal, row, observation.achieved_goal);
        write(&mut self.desired_goal, row, observation.desired_goal);
    }
}

/// Writes a row, if it is there and wanted. The array has room, which was checked before.
fn write<T: Copy>(out: &mut Option<&mut [T]>, row: usize, values: Option<&[T]>) {
    if let (Some(out), Some(values)) = (out, values) {
        let start = row * values.len();
        out[start..start + values.len()].copy_from_slice(values);
    }
}

/// Writes a row for each eye.
fn write_pair<T: Copy>(out: &mut Option<[&mut [T]; 2]>, row: usize, values: Option<[&[T]; 2]>) {
    for (out, values) in out.iter_mut().flatten().zip(values.into_iter().flatten()) {
        let start = row * values.len();
        out[start..start + values.len()].copy_from_slice(values);
    }
}

/// The vector's own arrays.
#[derive(Debug, Default)]
pub(super) struct Rows {
    layout: Layout,
    proprioception: Vec<f64>,
    touch: Vec<f32>,
    touched: Vec<Vec<u32>>,
    pooled: Vec<f64>,
    pain: Vec<f32>,
    eyes: [EyeImages; 2],
    vestibular: Vec<f64>,
    achieved_goal: Vec<f64>,
    desired_goal: Vec<f64>,
    rewards: Vec<f64>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
}

impl Rows {
    pub fn new(n: usize, layout: Layout) -> Self {
        let of = |len: Option<usize>| n * len.unwrap_or_default();
        let images = || EyeImages::new(layout.outputs, of(layout.pixels));
        Self {
            layout,
            proprioception: vec![0.0; n * layout.proprioception],
            touch: vec![0.0; of(layout.touch)],
            touched: match layout.touch {
                Some(_) => (0..n).map(|_| Vec::with_capacity(layout.sensors)).collect(),
                None => Vec::new(),
            },
            pooled: vec![0.0; of(layout.pooled)],
            pain: vec![0.0; of(layout.pain)],
            eyes: [images(), images()],
            vestibular: vec![0.0; of(layout.vestibular)],
            achieved_goal: vec![0.0; of(layout.goal)],
            desired_goal: vec![0.0; of(layout.goal)],
            rewards: vec![0.0; n],
            terminated: vec![false; n],
            truncated: vec![false; n],
        }
    }

    /// Returns the arrays for writing, those of senses that are on.
    pub fn buffers(&mut self) -> Buffers<'_> {
        fn on<T>(values: &mut [T], len: Option<usize>) -> Option<&mut [T]> {
            len.map(|_| values)
        }
        let layout = self.layout;
        let [left, right] = self.eyes.each_mut().map(EyeImages::buffers);
        Buffers {
            proprioception: Some(&mut self.proprioception),
            touch: on(&mut self.touch, layout.touch),
            touch_pooled: on(&mut self.pooled, layout.pooled),
            pain: on(&mut self.pain, layout.pain),
            eye_left: left.rgb,
            eye_right: right.rgb,
            eye_gray: left.gray.zip(right.gray).map(<[_; 2]>::from),
            eye_depth: left.depth.zip(right.depth).map(<[_; 2]>::from),
            eye_segmentation: left.segmentation.zip(right.segmentation).map(<[_; 2]>::from),
            vestibular: on(&mut self.vestibular, layout.vestibular),
            achieved_goal: on(&mut self.achieved_goal, layout.goal),
            desired_goal: on(&mut self.desired_goal, layout.goal),
            rewards: Some(&mut self.rewards),
            terminated: Some(&mut self.terminated),
            truncated: Some(&mut self.truncated),
            touched: on(&mut self.touched, layout.touch),
        }
    }

    /// Returns the observations of the first `n` rows.
    pub fn observation(&self, n: usize) -> Observation<'_> {
        fn on<T>(values: &[T], n: usize, len: Option<usize>) -> Option<&[T]> {
            len.map(|len| &values[..n * len])
        }
        let layout = self.layout;
        fn both<'a, T>(left: &'a [T], right: &'a [T], n: usize, len: Option<usize>) -> Option<[&'a [T]; 2]> {
            len.map(|len| [&left[..n * len], &right[..n * len]])
        }
        let ([left, right], eye) = (&self.eyes, |output| layout.eye(output));
        Observation {
            proprioception: &self.proprioception[..n * layout.proprioception],
            touch: on(&self.touch, n, layout.touch),
            touch_pooled: on(&self.pooled, n, layout.pooled),
            pain: on(&self.pain, n, layout.pain),
            eye_left: on(&left.rgb, n, eye(VisionOutput::Rgb)),
            eye_right: on(&right.rgb, n, eye(VisionOutput::Rgb)),
            eye_gray: both(&left.gray, &right.gray, n, eye(VisionOutput::Gray)),
            eye_depth: both(&left.depth, &right.depth, n, eye(VisionOutput::Depth)),
            eye_segmentation: both(
                &left.segmentation,
                &right.segmentation,
                n,
                eye(VisionOutput::Segmentation),
            ),
            vestibular: on(&self.vestibular, n, layout.vestibular),
            achieved_goal: on(&self.achieved_goal, n, layout.goal),
            desired_goal: on(&self.desired_goal, n, layout.goal),
        }
    }

    pub fn rewards(&self) -> &[f64] {
        &self.rewards
    }

    pub fn terminated(&self) -> &[bool] {
        &self.terminated
    }

    pub fn truncated(&self) -> &[bool] {
        &self.truncated
    }
}

/// Returns a row of arrays of `n` rows.
pub(super) fn row_of<'a>(all: &Observation<'a>, row: usize, n: usize) -> Observation<'a> {
    fn row_in<T>(values: &[T], row: usize, n: usize) -> &[T] {
        let len = values.len() / n.max(1);
        &values[row * len..(row + 1) * len]
    }
    Observation {
        proprioception: row_in(all.proprioception, row, n),
        touch: all.touch.map(|v| row_in(v, row, n)),
        touch_pooled: all.touch_pooled.map(|v| row_in(v, row, n)),
        pain: all.pain.map(|v| row_in(v, row, n)),
        eye_left: all.eye_left.map(|v| row_in(v, row, n)),
        eye_right: all.eye_right.map(|v| row_in(v, row, n)),
        eye_gray: all.eye_gray.map(|pair| pair.map(|v| row_in(v, row, n))),
        eye_depth: all.eye_depth.map(|pair| pair.map(|v| row_in(v, row, n))),
        eye_segmentation: all.eye_segmentation.map(|pair| pair.map(|v| row_in(v, row, n))),
        vestibular: all.vestibular.map(|v| row_in(v, row, n)),
        achieved_goal: all.achieved_goal.map(|v| row_in(v, row, n)),
        desired_goal: all.desired_goal.map(|v| row_in(v, row, n)),
    }
}

/// Information of all environments, as arrays of rows. The lists in the order of first touch, and names, are in
/// [`VectorEnv::env`](super::VectorEnv::env)`(i)?.info()`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Infos<'a> {
    /// Number of steps of each episode (N): see [`Info::steps`].
    pub steps: &'a [u64],
    /// Which geoms the right and the left palm have touched, (N, 2, geoms), 1 or 0, if the behavior is `self_touch`.
    pub touches: Option<&'a [u8]>,
    /// How often hands were in view, (N, 4), in the order of [`EYE_HAND_PAIRS`](crate::env::EYE_HAND_PAIRS), if the
    /// behavior is `hand_regard`.
    pub regards: Option<&'a [u64]>,
    /// Success and failure (N) of tasks that report them.
    pub outcomes: Option<&'a [Outcome]>,
    /// What the rewards of such tasks depend on beside goals, (N, len): [`Goal::terms`](crate::env::Goal::terms).
    pub reward_terms: Option<&'a [f64]>,
}

/// Information as arrays.
#[derive(Debug)]
pub(super) struct InfoRows {
    layout: Layout,
    steps: Vec<u64>,
    touches: Vec<u8>,
    regards: Vec<u64>,
    outcomes: Vec<Outcome>,
    terms: Vec<f64>,
}

impl InfoRows {
    pub fn new(n: usize, layout: Layout) -> Self {
        Self {
            layout,
            steps: vec![0; n],
            touches: vec![0; 2 * n * layout.geoms.unwrap_or_default()],
            regards: vec![0; 4 * n * usize::from(layout.regards)],
            outcomes: vec![Outcome::default(); n * usize::from(layout.terms.is_some())],
            terms: vec![0.0; n * layout.terms.unwrap_or_default()],
        }
    }

    pub fn write(&mut self, row: usize, info: &Info, terms: &[f64]) {
        self.steps[row] = info.steps;
        if let Some(len) = self.layout.terms {
            self.outcomes[row] = info.behavior.task().map(|info| info.outcome).unwrap_or_default();
            self.terms[row * len..(row + 1) * len].copy_from_slice(terms);
        }
        if let Some(geoms) = self.layout.geoms {
            let out = &mut self.touches[2 * geoms * row..2 * geoms * (row + 1)];
            out.fill(0);
            if let BehaviorInfo::SelfTouch { touches } = &info.behavior {
                for (out, touched) in out.chunks_exact_mut(geoms).zip(touches.each_ref()) {
                    touched.iter().for_each(|&geom| out[geom] = 1);
                }
            }
        }
        if self.layout.regards {
            let counts = info.behavior.regards().unwrap_or_default();
            self.regards[4 * row..4 * (row + 1)].copy_from_slice(&counts);
        }
    }

    /// Returns the first `n` rows.
    pub fn infos(&self, n: usize) -> Infos<'_> {
        Infos {
            steps: &self.steps[..n],
            touches: self.layout.geoms.map(|geoms| &self.touches[..2 * geoms * n]),
            regards: self.layout.regards.then(|| &self.regards[..4 * n]),
            outcomes: self.layout.terms.map(|_| &self.outcomes[..n]),
            reward_terms: self.layout.terms.map(|len| &self.terms[..n * len]),
        }
    }
}

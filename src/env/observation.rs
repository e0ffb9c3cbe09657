//! The results of a step: the observation, and the rest in Gymnasium's order.

use crate::env::Info;
use crate::sensors::EyeImages;

/// The observation: what MIMo senses. The vectors belong to the environment and change with the next step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observation<'a> {
    /// Proprioception, Gymnasium's key `observation`; [`Senses::proprioception`](crate::env::Senses::proprioception) tells what stands where. A task may append to it: the
    /// last number of `catch` is the radius of the ball, m.
    pub proprioception: &'a [f64],
    /// What the skin feels, N, if `touch_active`; [`Senses::touch`](crate::env::Senses::touch) tells what stands where.
    pub touch: Option<&'a [f32]>,
    /// What each body with skin feels, (bodies, 5), if `touch_pooled`: see [`TouchPool`](crate::sensors::TouchPool).
    pub touch_pooled: Option<&'a [f64]>,
    /// What hurts, a number for each touch sensor, if `pain_active`: see [`Pain`](crate::sensors::Pain).
    pub pain: Option<&'a [f32]>,
    /// What the left eye sees, (H, W, 3) bytes from the top, if `vision_active` and `vision_outputs` has `rgb`.
    pub eye_left: Option<&'a [u8]>,
    /// What the right eye sees.
    pub eye_right: Option<&'a [u8]>,
    /// What both eyes see in grey, left and right, (H, W) bytes, if `vision_outputs` has `gray`: see [`SensesMut::eye_gray`](crate::env::SensesMut::eye_gray).
    pub eye_gray: Option<[&'a [u8]; 2]>,
    /// How far away it is, left and right, (H, W), m, if `vision_outputs` has `depth`: see [`SensesMut::eye_depth`](crate::env::SensesMut::eye_depth).
    pub eye_depth: Option<[&'a [f32]; 2]>,
    /// Which geoms they are, left and right, (H, W), if `vision_outputs` has `segmentation`: see
    /// [`SensesMut::eye_segmentation`](crate::env::SensesMut::eye_segmentation).
    pub eye_segmentation: Option<[&'a [i32]; 2]>,
    /// Linear acceleration (m/s^2) and angular velocity (rad/s) of the head, if `vestibular_active`.
    pub vestibular: Option<&'a [f64]>,
    /// The goal that is achieved, of tasks whose goals have numbers.
    pub achieved_goal: Option<&'a [f64]>,
    /// The goal that is desired, as long.
    pub desired_goal: Option<&'a [f64]>,
}

impl<'a> Observation<'a> {
    /// Returns what the eyes see, left and right, and nothing else.
    pub(crate) fn of_eyes([left, right]: &'a [EyeImages; 2]) -> Self {
        fn pair<'a, T>(left: &'a [T], right: &'a [T]) -> Option<[&'a [T]; 2]> {
            (!left.is_empty()).then_some([left, right])
        }
        let [eye_left, eye_right] = [left, right].map(|eye| (!eye.rgb.is_empty()).then_some(&eye.rgb[..]));
        Self {
            eye_left,
            eye_right,
            eye_gray: pair(&left.gray, &right.gray),
            eye_depth: pair(&left.depth, &right.depth),
            eye_segmentation: pair(&left.segmentation, &right.segmentation),
            ..Self::default()
        }
    }
}

/// The result of a step, in Gymnasium's order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<'a> {
    /// The observation.
    pub observation: Observation<'a>,
    /// The reward of the task; 0 for BabyBench's behaviors, which have no extrinsic reward.
    pub reward: f64,
    /// Whether the task has succeeded or failed, if `done_active`; false for BabyBench's behaviors.
    pub terminated: bool,
    /// Whether the episode has reached `max_episode_steps`.
    pub truncated: bool,
    /// The information.
    pub info: &'a Info,
}

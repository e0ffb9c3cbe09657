//! The table of keys, from which reading, writing, defaults, ranges and documentation all follow.

use super::choices::{
    ActuationModel, Behavior, Compat, DelayUnit, EngineKind, RendererKind, Scene, StartingPosition, TouchFunction,
    TouchResponse, VisionOutput,
};
use super::kinds::{KeyKind, KeyValue};
use super::outputs::VisionOutputs;
use super::{Config, MAX_AGE};
use crate::spaces::MAX_IMAGE_SIZE;

/// A field of [`Config`] that converts to and from a [`KeyValue`].
trait Field: Sized {
    fn to_value(&self) -> KeyValue;
    fn from_value(value: &KeyValue) -> Option<Self>;
}

macro_rules! field {
    ($($type:ty, $variant:ident, $value:ident => $back:expr, |$field:ident| $there:expr;)*) => {$(
        impl Field for $type {
            fn to_value(&self) -> KeyValue {
                let $field = self;
                KeyValue::$variant($there)
            }
            fn from_value(value: &KeyValue) -> Option<Self> {
                match value {
                    KeyValue::$variant($value) => $back,
                    _ => None,
                }
            }
        }
    )*};
}

field! {
    bool, Bool, v => Some(*v), |f| *f;
    u32, Whole, v => u32::try_from(*v).ok(), |f| u64::from(*f);
    u64, Whole, v => Some(*v), |f| *f;
    f64, Number, v => Some(*v), |f| *f;
    String, Text, v => Some(v.clone()), |f| f.clone();
    Behavior, Choice, v => Self::from_name(v), |f| f.name();
    Scene, Choice, v => Self::from_name(v), |f| f.name();
    StartingPosition, Choice, v => Self::from_name(v), |f| f.name();
    ActuationModel, Choice, v => Self::from_name(v), |f| f.name();
    TouchFunction, Choice, v => Self::from_name(v), |f| f.name();
    TouchResponse, Choice, v => Self::from_name(v), |f| f.name();
    Compat, Choice, v => Self::from_name(v), |f| f.name();
    EngineKind, Choice, v => Self::from_name(v), |f| f.name();
    RendererKind, Choice, v => Self::from_name(v), |f| f.name();
    DelayUnit, Choice, v => Self::from_name(v), |f| f.name();
    VisionOutputs, List, v => Self::from_names(v), |f| f.iter().map(VisionOutput::name).collect();
}

impl Field for Option<f64> {
    fn to_value(&self) -> KeyValue {
        self.map_or(KeyValue::None, KeyValue::Number)
    }
    fn from_value(value: &KeyValue) -> Option<Self> {
        match value {
            KeyValue::None => Some(None),
            KeyValue::Number(number) => Some(Some(*number)),
            _ => None,
        }
    }
}

/// One key of the configuration.
#[derive(Debug)]
pub struct Key {
    /// Name in a file.
    pub name: &'static str,
    /// Heading of the section that it belongs to.
    pub section: &'static str,
    /// Values that it accepts.
    pub kind: KeyKind,
    /// Meaning, in one sentence.
    pub doc: &'static str,
    get: fn(&Config) -> KeyValue,
    set: fn(&mut Config, &KeyValue) -> bool,
}

impl Key {
    /// Returns the key with this name; `None` if there is none.
    pub fn named(name: &str) -> Option<&'static Self> {
        KEYS.iter().find(|key| key.name == name)
    }

    /// Returns the value of this key in `config`.
    pub fn value(&self, config: &Config) -> KeyValue {
        (self.get)(config)
    }

    /// Returns the value of this key when a file leaves it out.
    pub fn default_value(&self) -> KeyValue {
        self.value(&Config::default())
    }

    /// Sets the field; `false` if the value is of another type.
    pub(crate) fn assign(&self, config: &mut Config, value: &KeyValue) -> bool {
        (self.set)(config, value)
    }
}

/// Defines the table: per section, the key, its field, what it accepts and what it means.
macro_rules! keys {
    ($($section:tt { $($name:ident = $($field:ident).+, $kind:expr, $doc:literal;)* })*) => {
        &[$($(Key {
            name: stringify!($name),
            section: $section,
            kind: $kind,
            doc: $doc,
            get: |config| config.$($field).+.to_value(),
            set: |config, value| Field::from_value(value).map(|new| config.$($field).+ = new).is_some(),
        },)*)*]
    };
}

const fn whole_from_1_to(max: u64) -> KeyKind {
    KeyKind::Whole { min: 1, max }
}

const COUNT: KeyKind = whole_from_1_to(i64::MAX as u64); // steps and episodes are signed integers in numpy's logs
const FRAMES: KeyKind = whole_from_1_to(10_000); // a step cannot be interrupted; these take about a second
const PIXELS: KeyKind = whole_from_1_to(MAX_IMAGE_SIZE as u64);
const EYES: KeyKind = whole_from_1_to(2);
const SEED: KeyKind = KeyKind::Whole { min: 0, max: u64::MAX };
const SCALE: KeyKind = KeyKind::ZeroOrAtLeast(0.01); // sensors grow with the inverse square: 170 million values at 0.01

const AGE: KeyKind = KeyKind::NoneOr { min: 0.0, max: MAX_AGE };
const CENTIMETRES: KeyKind = KeyKind::NoneOr { min: 0.1, max: 100.0 };
const DELAY: KeyKind = KeyKind::Number {
    min: 0.0,
    max: 10_000.0,
};
const OWN_DELAY: KeyKind = KeyKind::NoneOr {
    min: 0.0,
    max: 10_000.0,
};
const DEVIATION: KeyKind = KeyKind::Number { min: 0.0, max: 1000.0 };
const ACUITY_AGE: KeyKind = KeyKind::NoneOr { min: 0.0, max: 36.0 };
const STRENGTH: KeyKind = KeyKind::Number { min: 0.0, max: 1000.0 };
const OWN_STRENGTH: KeyKind = KeyKind::NoneOr { min: 0.0, max: 1000.0 };
const SHARE: KeyKind = KeyKind::Number { min: 0.0, max: 1.0 };
const PAIN: KeyKind = KeyKind::Number { min: 0.0, max: 1e6 };
const MOST_PAIN: KeyKind = KeyKind::NoneOr { min: 0.0, max: 1e6 };
const MILLIMETRES: KeyKind = KeyKind::NoneOr { min: 0.1, max: 100.0 };

use KeyKind::{Bool, Choice, List, Text};

/// The section of the keys that change MIMo's body.
pub(super) const GROWTH: &str = "Growth";

/// Every key, in the order of the API page, with this implementation's own after its general ones.
pub(super) static KEYS: &[Key] = keys! {
    "General" {
        save_dir = save_dir, Text, "The folder of logs, videos and results.";
        behavior = behavior, Choice(Behavior::NAMES), "The behavior that is trained and scored, or a task with a goal and a reward, whose other keys have defaults of their own.";
        scene = scene, Choice(Scene::NAMES), "MIMo's surroundings.";
        max_episode_steps = max_episode_steps, COUNT, "Number of steps after which an episode is truncated.";
        frame_skip = frame_skip, FRAMES, "Physics steps of 5 ms per action.";
        render_size = render_size, PIXELS, "Width and height of rendered images, pixels.";
        save_logs_every = save_logs_every, COUNT, "Episodes between two saves of the training log.";
    }
    "This implementation's own keys" {
        compat = compat, Choice(Compat::NAMES), "Which of them to follow where the API page and the Python code disagree.";
        engine = engine, Choice(EngineKind::NAMES), "The physics engine.";
        renderer = renderer, Choice(RendererKind::NAMES), "The renderer of images.";
        seed = seed, SEED, "The seed of all random choices until a reset is given another.";
    }
    "Tasks" {
        done_active = done_active, Bool, "Success and failure of a task terminate the episode.";
        action_penalty = action_penalty, Bool, "The task catch subtracts the cost of an action from the reward.";
        jitter = jitter, Bool, "The task catch disturbs actions, by factors that change now and then.";
        position_inaccurate = position_inaccurate, Bool, "The eyes of the task catch follow a point beside the ball.";
        starting_position = starting_position, Choice(StartingPosition::NAMES), "How MIMo lies at the start of the task roll_over.";
    }
    GROWTH {
        age = age, AGE, "The age of MIMo's body, months; none for the proportions of the original.";
        strength_age = strength_age, AGE, "The age of MIMo's strength, months; none for that of his body.";
        touch_grows = touch_grows, Bool, "Touch sensors keep their number and grow with the body, instead of keeping their distances.";
        ankle_circumference = measurements.ankle_circumference, CENTIMETRES, "The circumference of the ankle, cm; none for that of the age.";
        calf_circumference = measurements.calf_circumference, CENTIMETRES, "The circumference of the calf, cm; none for that of the age.";
        elbow_hand_length = measurements.elbow_hand_length, CENTIMETRES, "The length from the elbow to the fingertips, cm; none for that of the age.";
        fist_breadth = measurements.fist_breadth, CENTIMETRES, "The breadth of the fist, cm; none for that of the age.";
        foot_breadth = measurements.foot_breadth, CENTIMETRES, "The breadth of the foot, cm; none for that of the age.";
        foot_length = measurements.foot_length, CENTIMETRES, "The length of the foot, cm; none for that of the age.";
        forearm_circumference = measurements.forearm_circumference, CENTIMETRES, "The circumference of the forearm, cm; none for that of the age.";
        hand_breadth = measurements.hand_breadth, CENTIMETRES, "The breadth of the hand, cm; none for that of the age.";
        hand_length = measurements.hand_length, CENTIMETRES, "The length of the hand, cm; none for that of the age.";
        head_circumference = measurements.head_circumference, CENTIMETRES, "The circumference of the head, cm; none for that of the age.";
        hip_breadth = measurements.hip_breadth, CENTIMETRES, "The breadth of the hip, cm; none for that of the age.";
        knee_sole_length = measurements.knee_sole_length, CENTIMETRES, "The length from the knee to the sole, cm; none for that of the age.";
        middle_finger_diameter = measurements.middle_finger_diameter, MILLIMETRES, "The diameter of the middle finger, mm; none for that of the age.";
        rump_knee_length = measurements.rump_knee_length, CENTIMETRES, "The length from the rump to the knee, cm; none for that of the age.";
        shoulder_elbow_length = measurements.shoulder_elbow_length, CENTIMETRES, "The length from the shoulder to the elbow, cm; none for that of the age.";
        thigh_circumference = measurements.thigh_circumference, CENTIMETRES, "The circumference of the thigh, half way, cm; none for that of the age.";
        thumb_diameter = measurements.thumb_diameter, MILLIMETRES, "The diameter of the thumb, mm; none for that of the age.";
        upper_arm_circumference = measurements.upper_arm_circumference, CENTIMETRES, "The circumference of the upper arm, cm; none for that of the age.";
    }
    "Delays" {
        delay_unit = delays.unit, Choice(DelayUnit::NAMES), "The unit of delays; milliseconds are rounded to whole steps.";
        delay_sensory = delays.sensory, DELAY, "The delay of senses that have none of their own.";
        delay_motor = delays.motor, DELAY, "The delay of actions.";
        delay_proprioception = delays.proprioception, OWN_DELAY, "The delay of proprioception; none for that of all senses.";
        delay_touch = delays.touch, OWN_DELAY, "The delay of touch and pain; none for that of all senses.";
        delay_vestibular = delays.vestibular, OWN_DELAY, "The delay of the head's motion; none for that of all senses.";
        delay_vision = delays.vision, OWN_DELAY, "The delay of both eyes; none for that of all senses.";
    }
    "Noise" {
        noise_proprioception = noise.proprioception, DEVIATION, "Standard deviation of the noise of proprioception, in the unit of each number.";
        noise_touch = noise.touch, DEVIATION, "Standard deviation of the noise of touch sensors that feel something, N.";
        noise_vestibular = noise.vestibular, DEVIATION, "Standard deviation of the noise of the head's motion, m/s^2 and rad/s.";
        noise_vision = noise.vision, DEVIATION, "Standard deviation of the noise of images, of 255.";
    }
    "Proprioception" {
        proprio_velocity = proprio_velocity, Bool, "Joint velocities are observed.";
        proprio_torque = proprio_torque, Bool, "Joint torques are observed.";
        proprio_limits = proprio_limits, Bool, "How far joints are into their limits is observed.";
        proprio_actuation = proprio_actuation, Bool, "The state of the actuators is observed.";
    }
    "Vestibular" {
        vestibular_active = vestibular_active, Bool, "The head's motion is observed.";
    }
    "Vision" {
        vision_active = vision_active, Bool, "The images of both eyes are observed.";
        vision_resolution = vision_resolution, PIXELS, "Width and height of an eye's image, pixels.";
        vision_outputs = vision_outputs, List(VisionOutput::NAMES), "The images of each eye that are observed.";
        vision_threads = vision_threads, EYES, "Threads that draw the eyes of an environment alone: 2 is faster by the clock, to the same bytes.";
        vision_acuity = eyes.acuity, Bool, "Images are blurred as eyes of MIMo's age see them, or of 18 months if he has none.";
        vision_acuity_left = eyes.acuity_left, ACUITY_AGE, "The age of the left eye's acuity, months; none for that of both eyes.";
        vision_acuity_right = eyes.acuity_right, ACUITY_AGE, "The age of the right eye's acuity, months; none for that of both eyes.";
        vision_foveation = eyes.foveation, STRENGTH, "How much the middle of images is enlarged: 10 is usual, 0 not at all.";
        vision_foveation_left = eyes.foveation_left, OWN_STRENGTH, "The foveation of the left eye; none for that of both eyes.";
        vision_foveation_right = eyes.foveation_right, OWN_STRENGTH, "The foveation of the right eye; none for that of both eyes.";
    }
    "Touch" {
        touch_active = touch_active, Bool, "Touch is observed.";
        touch_scale = touch_scale, SCALE, "Factor on the distance between sensors; 0 switches touch off.";
        touch_function = touch_function, Choice(TouchFunction::NAMES), "What a sensor reports.";
        touch_response = touch_response, Choice(TouchResponse::NAMES), "How sensors share a force.";
        touch_hands = touch.hands, Bool, "The hands have touch sensors.";
        touch_fingers = touch.fingers, Bool, "The fingers have touch sensors.";
        touch_arms = touch.arms, Bool, "The arms have touch sensors.";
        touch_feet = touch.feet, Bool, "The feet have touch sensors.";
        touch_legs = touch.legs, Bool, "The legs have touch sensors.";
        touch_body = touch.body, Bool, "The trunk has touch sensors.";
        touch_head = touch.head, Bool, "The head has touch sensors.";
        touch_eyes = touch.eyes, Bool, "The eyes have touch sensors.";
        touch_pooled = touch_pooled, Bool, "Touch pooled over each body is observed.";
    }
    "Pain" {
        pain_active = pain_active, Bool, "Pain is observed.";
        pain_threshold = pain.threshold, PAIN, "The force on a sensor from which on it hurts, N.";
        pain_slope = pain.slope, PAIN, "The pain for each newton beyond.";
        pain_limit = pain.limit, MOST_PAIN, "The greatest pain of a sensor; none for no limit.";
        pain_decay_old = pain.decay_old, SHARE, "The share of the last step's pain that stays.";
        pain_decay_new = pain.decay_new, SHARE, "The factor on new pain.";
    }
    "Actuation" {
        actuation_model = actuation_model, Choice(ActuationModel::NAMES), "How actions become torques.";
        act_hands = act.hands, Bool, "The hands are actuated.";
        act_fingers = act.fingers, Bool, "The fingers are actuated.";
        act_arms = act.arms, Bool, "The arms are actuated.";
        act_feet = act.feet, Bool, "The feet are actuated.";
        act_legs = act.legs, Bool, "The legs are actuated.";
        act_body = act.body, Bool, "The trunk is actuated.";
        act_head = act.head, Bool, "The head is actuated.";
        act_eyes = act.eyes, Bool, "The eyes are actuated.";
    }
    "Locked joints" {
        lock_hands = lock.hands, Bool, "The joints of the hands are locked.";
        lock_fingers = lock.fingers, Bool, "The joints of the fingers are locked.";
        lock_arms = lock.arms, Bool, "The joints of the arms are locked.";
        lock_feet = lock.feet, Bool, "The joints of the feet are locked.";
        lock_legs = lock.legs, Bool, "The joints of the legs are locked.";
        lock_body = lock.body, Bool, "The joints of the trunk are locked.";
        lock_head = lock.head, Bool, "The joints of the head are locked.";
        lock_eyes = lock.eyes, Bool, "The joints of the eyes are locked.";
    }
};

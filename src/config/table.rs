//! The table of keys: name, type, default, accepted values and meaning. The fields of [`Config`] and of its groups, reading, writing,
//! ranges and documentation all follow from it.

use super::choices::{
    ActuationModel, Behavior, Compat, DelayUnit, EngineKind, FacialExpression, Learner, Limb, Proportions, ReflexVor,
    RendererKind, Sex, SpringModel, StartingPosition, StrengthModel, TouchFunction, TouchResponse, VisionOutput,
};
use super::keys::{ConfigField, config};
use super::kinds::{KeyKind, KeyValue};
use super::outputs::VisionOutputs;
use super::parts::BodyParts;
use super::reflexes::ReflexSet;
use super::scene::Scene;
use super::schedule::AgeSchedule;
use crate::render::MAX_SIZE;

/// Greatest age that MIMo can have, months.
pub const MAX_AGE: f64 = 24.0;

const fn whole_from_1_to(max: u64) -> KeyKind {
    KeyKind::Whole { min: 1, max }
}

const SCENE: KeyKind = KeyKind::ChoiceOrFile {
    names: Scene::NAMES,
    ending: Scene::ENDING,
};
const MIMO_VERSIONS: KeyKind = KeyKind::Whole { min: 2, max: 3 };
const COUNT: KeyKind = whole_from_1_to(i64::MAX as u64); // steps and episodes are signed integers in numpy's logs
const FRAMES: KeyKind = whole_from_1_to(10_000); // a step cannot be interrupted; these take about a second
const PIXELS: KeyKind = whole_from_1_to(MAX_SIZE as u64);
const OWN_PIXELS: KeyKind = KeyKind::NoneOrWhole {
    min: 1,
    max: MAX_SIZE as u64,
};
const FIELD: KeyKind = KeyKind::NoneOr { min: 1.0, max: 170.0 }; // towards 180 the picture plane is infinite
const EYES: KeyKind = whole_from_1_to(2);
const SEED: KeyKind = KeyKind::Whole { min: 0, max: u64::MAX };
const SCALE: KeyKind = KeyKind::ZeroOrAtLeast(0.01); // sensors grow with the inverse square: 170 million values at 0.01

const AGE: KeyKind = KeyKind::NoneOr { min: 0.0, max: MAX_AGE };
const AGES: KeyKind = KeyKind::NoneOrAges { max: MAX_AGE };
const GRID: KeyKind = KeyKind::Number {
    min: 0.01,
    max: MAX_AGE,
};
const SCORE: KeyKind = KeyKind::NoneOr { min: -3.0, max: 3.0 };
const WEEKS: KeyKind = KeyKind::NoneOr { min: 24.0, max: 42.0 };
const SPREAD: KeyKind = KeyKind::Number { min: 0.0, max: 2.0 };
const PLACE: KeyKind = KeyKind::Whole {
    min: 0,
    max: u32::MAX as u64,
};
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
const ACUITY_AGE: KeyKind = KeyKind::NoneOr { min: 0.0, max: 36.0 }; // the table of acuity ends there
const STRENGTH: KeyKind = KeyKind::Number { min: 0.0, max: 1000.0 };
const OWN_STRENGTH: KeyKind = KeyKind::NoneOr { min: 0.0, max: 1000.0 };
const RATE: KeyKind = KeyKind::NoneOr {
    min: 0.01,
    max: 10_000.0,
};
const SHARE: KeyKind = KeyKind::Number { min: 0.0, max: 1.0 };
const PAIN: KeyKind = KeyKind::Number { min: 0.0, max: 1e6 };
const MOST_PAIN: KeyKind = KeyKind::NoneOr { min: 0.0, max: 1e6 };
const COLOR: KeyKind = KeyKind::NoneOr { min: 0.0, max: 2.0 }; // the noise keeps its exponent in this range
const FACTOR: KeyKind = KeyKind::Number { min: 0.0, max: 10.0 };
const OWN_FACTOR: KeyKind = KeyKind::NoneOr { min: 0.0, max: 10.0 };
const REFLEX_DELAY: KeyKind = KeyKind::NoneOr { min: 0.0, max: 1000.0 };
const REFLEXES: KeyKind = KeyKind::NoneOrList(ReflexSet::NAMES);
const MILLIMETRES: KeyKind = KeyKind::NoneOr { min: 0.1, max: 100.0 };

use KeyKind::{Bool, Choice, Document, List, Text};

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
    /// Returns the key with this name, if it exists.
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

/// The section of the keys that change MIMo's body.
pub(super) const GROWTH: &str = "Growth";

// Every key, in the order of the API page, with this implementation's own after its general ones.
config! {
    "General" {
        save_dir: String = "results/test_installation".to_string(), Text, "The folder of logs, videos and results.";
        behavior: Behavior = Behavior::None, Choice(Behavior::NAMES), "The behavior or task." + "A behavior is trained and scored. A task has a goal and a reward, and its own defaults for other keys. Either decides MIMo's version.";
        scene: Scene = Scene::Base, SCENE, "A scene of the library, or a room of your own." + "A room is an MJCF document that includes MIMo. Its path starts at the configuration file's folder.";
        max_episode_steps: u64 = 1000, COUNT, "Number of steps after which an episode is truncated.";
        frame_skip: u32 = 1, FRAMES, "Physics steps of 5 ms per action.";
        render_size: u32 = 480, PIXELS, "Width and height of rendered images, pixels.";
        save_logs_every: u64 = 1000, COUNT, "Episodes between two saves of the training log.";
    }
    "This implementation's own keys" {
        compat: Compat = Compat::Api, Choice(Compat::NAMES), "What to follow where the API page and the Python code disagree.";
        mimo_version: u32 = 2, MIMO_VERSIONS, "MIMo's version: 2, or 3, whose chest is a separate body with two joints.";
        engine: EngineKind = EngineKind::Soft, Choice(EngineKind::NAMES), "The physics engine.";
        renderer: RendererKind = RendererKind::Cpu, Choice(RendererKind::NAMES), "The renderer of images.";
        learner: Learner = Learner::Mimo, Choice(Learner::NAMES), "Which of two infants in a room learns: the one in `mimo_location` or in `other_location`.";
        other_age: Option<f64> = None, AGE, "The age of the other infant in a room, months; none for the original proportions.";
        scene_extra: String = String::new(), Document, "MJCF added to a scene of the library: elements of the world, and sections.";
        mocap_motion: String = String::new(), Document, "The paths of bodies with `mocap=\"true\"`, as a table that starts again at its end." + "Its first line has the names `time,BODY.x,BODY.y,BODY.z` and, for bodies that turn, `BODY.qw` to `BODY.qz`. The other lines have numbers.";
        seed: u64 = 0, SEED, "The seed of all random choices until a reset sets another.";
        facial_expression: FacialExpression = FacialExpression::Default, Choice(FacialExpression::NAMES), "MIMo's face. It changes pictures only.";
    }
    "Tasks" {
        done_active: bool = true, Bool, "Success and failure of a task terminate the episode.";
        @group catch: CatchOptions, "Options of the task catch.", "Options of the task `catch`." {
            action_penalty as action_penalty: bool = true, Bool, "The task catch subtracts the cost of an action from the reward.";
            jitter as jitter: bool = false, Bool, "The task catch disturbs actions by factors that change at random.";
            position_inaccurate as position_inaccurate: bool = false, Bool, "The eyes of the task catch follow a point beside the ball.";
        }
        @group roll_over: RollOverOptions, "Options of the task roll_over.", "Options of the task `roll_over`." {
            starting_position as starting_position: StartingPosition = StartingPosition::Supine, Choice(StartingPosition::NAMES), "How MIMo lies at the start of the task roll_over.";
        }
        @group mobile: MobileOptions, "Options of the task mobile.", "Options of the task `mobile`." {
            limb as mobile_limb: Limb = Limb::RightFoot, Choice(Limb::NAMES), "The limb to which the ribbon of the task mobile is tied.";
            baseline as mobile_baseline: f64 = 0.2, SHARE, "Task mobile: the share of an episode before the mobile is tied to the limb.";
            extinction as mobile_extinction: f64 = 0.2, SHARE, "Task mobile: the share of an episode after the mobile is untied.";
            reward as mobile_reward: bool = false, Bool, "The task mobile rewards each metre by which the mobile moves.";
        }
        @group play: PlayOptions, "Options of the task play.", "Options of the task `play`." {
            reward as play_reward: bool = false, Bool, "The task play rewards each toy with 1 when it is first touched in an episode.";
        }
    }
    GROWTH {
        age: Option<f64> = None, AGE, "The age of MIMo's body, months; none for the original proportions.";
        age_schedule: AgeSchedule = AgeSchedule::default(), AGES, "Ages of a growing MIMo; `age` accepts them, too." + "They are months by steps of the environment, as in `age: {0: 1, 500000: 6}`. Each episode begins at the age of its first step.";
        age_grid: f64 = 0.25, GRID, "Ages between two points of `age_schedule` are multiples of this, months.";
        strength_age: Option<f64> = None, AGE, "The age of MIMo's strength, months; none to follow his body.";
        strength: StrengthModel = StrengthModel::Volume, Choice(StrengthModel::NAMES), "What the strength of motors and muscles follows." + "`volume` follows the part that carries them, `infant` ratios to the torque of gravity at each age, calibrated on what infants can do.";
        springs: SpringModel = SpringModel::Fixed, Choice(SpringModel::NAMES), "What springs and dampers of joints follow." + "`fixed` keeps those of the original proportions, `weight` follows the torque of gravity on each joint.";
        proportions: Proportions = Proportions::Mimo, Choice(Proportions::NAMES), "The source of MIMo's proportions." + "`mimo` are the authors' formulas, `measured` keeps their length and divides it between trunk and legs as in infants.";
        touch_grows: bool = false, Bool, "Touch sensors keep their number and move with the body, instead of keeping their spacing.";
        @group individual: IndividualOptions, "How MIMo differs from other infants of his age (`sex`, `length_z` ...).", "How an infant differs from others of his age, by the standards of growth." {
            sex as sex: Sex = Sex::None, Choice(Sex::NAMES), "The sex by whose growth standards MIMo is sized; none for the authors' formulas.";
            length_z as length_z: Option<f64> = None, SCORE, "The z-score of his length among infants of his sex and age; none for 0, the median.";
            weight_z as weight_z: Option<f64> = None, SCORE, "The z-score of his weight among infants of his sex and age; none for 0, the median.";
            head_z as head_z: Option<f64> = None, SCORE, "The z-score of his head circumference among infants of his sex and age; none for 0, the median.";
            gestation as gestation: Option<f64> = None, WEEKS, "The weeks of pregnancy at his birth, from which `age` counts; none for a birth at term.";
            random as body_random: f64 = 0.0, SPREAD, "Standard deviation of the z-scores of a drawn infant, 1 as in the standards; 0 draws none.";
            seed as body_seed: u64 = 0, SEED, "The seed of the population of `body_random`.";
            number as body_number: u64 = 0, PLACE, "The number of the infant in the population; row i of a vector has the i-th after him.";
        }
        @group strength_factors: StrengthFactors, "Factors on the strength of groups of joints (`strength_neck` ...).", "Factors on the strength of groups of joints by [`StrengthModel::Infant`]." {
            neck as strength_neck: f64 = 1.0, FACTOR, "Factor on the strength of the neck by `strength: infant`.";
            trunk as strength_trunk: f64 = 1.0, FACTOR, "Factor on the strength of the trunk by `strength: infant`.";
            shoulder as strength_shoulder: f64 = 1.0, FACTOR, "Factor on the strength of the shoulders by `strength: infant`.";
            elbow as strength_elbow: f64 = 1.0, FACTOR, "Factor on the strength of the elbows by `strength: infant`.";
            wrist as strength_wrist: f64 = 1.0, FACTOR, "Factor on the strength of the wrists by `strength: infant`.";
            grip as strength_grip: f64 = 1.0, FACTOR, "Factor on the strength of the fingers by `strength: infant`.";
            hip as strength_hip: f64 = 1.0, FACTOR, "Factor on the strength of the hips by `strength: infant`.";
            knee as strength_knee: f64 = 1.0, FACTOR, "Factor on the strength of the knees by `strength: infant`.";
            ankle as strength_ankle: f64 = 1.0, FACTOR, "Factor on the strength of the ankles and toes by `strength: infant`.";
        }
        @group measurements: Measurements, "Measurements that replace those of the age.", "Measurements of an infant's body, as AnthroKids (1977) took them: cm, the two diameters of fingers mm. `None` leaves a measurement to the age." {
            ankle_circumference as ankle_circumference: Option<f64> = None, CENTIMETRES, "The circumference of the ankle, cm; none to follow the age.";
            calf_circumference as calf_circumference: Option<f64> = None, CENTIMETRES, "The circumference of the calf, cm; none to follow the age.";
            elbow_hand_length as elbow_hand_length: Option<f64> = None, CENTIMETRES, "The length from the elbow to the fingertips, cm; none to follow the age.";
            fist_breadth as fist_breadth: Option<f64> = None, CENTIMETRES, "The breadth of the fist, cm; none to follow the age.";
            foot_breadth as foot_breadth: Option<f64> = None, CENTIMETRES, "The breadth of the foot, cm; none to follow the age.";
            foot_length as foot_length: Option<f64> = None, CENTIMETRES, "The length of the foot, cm; none to follow the age.";
            forearm_circumference as forearm_circumference: Option<f64> = None, CENTIMETRES, "The circumference of the forearm, cm; none to follow the age.";
            hand_breadth as hand_breadth: Option<f64> = None, CENTIMETRES, "The breadth of the hand, cm; none to follow the age.";
            hand_length as hand_length: Option<f64> = None, CENTIMETRES, "The length of the hand, cm; none to follow the age.";
            head_circumference as head_circumference: Option<f64> = None, CENTIMETRES, "The circumference of the head, cm; none to follow the age.";
            hip_breadth as hip_breadth: Option<f64> = None, CENTIMETRES, "The breadth of the hip, cm; none to follow the age.";
            knee_sole_length as knee_sole_length: Option<f64> = None, CENTIMETRES, "The length from the knee to the sole, cm; none to follow the age.";
            middle_finger_diameter as middle_finger_diameter: Option<f64> = None, MILLIMETRES, "The diameter of the middle finger, mm; none to follow the age.";
            rump_knee_length as rump_knee_length: Option<f64> = None, CENTIMETRES, "The length from the rump to the knee, cm; none to follow the age.";
            shoulder_elbow_length as shoulder_elbow_length: Option<f64> = None, CENTIMETRES, "The length from the shoulder to the elbow, cm; none to follow the age.";
            thigh_circumference as thigh_circumference: Option<f64> = None, CENTIMETRES, "The circumference of the thigh at its middle, cm; none to follow the age.";
            thumb_diameter as thumb_diameter: Option<f64> = None, MILLIMETRES, "The diameter of the thumb, mm; none to follow the age.";
            upper_arm_circumference as upper_arm_circumference: Option<f64> = None, CENTIMETRES, "The circumference of the upper arm, cm; none to follow the age.";
        }
    }
    "Delays" {
        @group delays: Delays, "Delays of senses and actions (`delay_sensory` ...).", "Delays of senses and actions, in [`Delays::unit`]; 0 is none." {
            unit as delay_unit: DelayUnit = DelayUnit::default(), Choice(DelayUnit::NAMES), "The unit of delays; milliseconds are rounded to whole steps.";
            by_age as delay_by_age: bool = false, Bool, "Senses without a delay of their own have the delay measured in infants of MIMo's age.";
            sensory as delay_sensory: f64 = 0.0, DELAY, "The delay of senses that have none of their own or from MIMo's age.";
            motor as delay_motor: f64 = 0.0, DELAY, "The delay of actions.";
            proprioception as delay_proprioception: Option<f64> = None, OWN_DELAY, "The delay of proprioception; none to follow `delay_by_age` or `delay_sensory`.";
            touch as delay_touch: Option<f64> = None, OWN_DELAY, "The delay of touch and pain; none to follow `delay_by_age` or `delay_sensory`.";
            vestibular as delay_vestibular: Option<f64> = None, OWN_DELAY, "The delay of the head's motion; none to follow `delay_by_age` or `delay_sensory`.";
            vision as delay_vision: Option<f64> = None, OWN_DELAY, "The delay of both eyes; none to follow `delay_by_age` or `delay_sensory`.";
        }
    }
    "Noise" {
        @group noise: NoiseLevels, "Noise of senses and actions (`noise_touch` ...).", "Standard deviations of the noise of senses and actions; 0 is none." {
            proprioception as noise_proprioception: f64 = 0.0, DEVIATION, "Standard deviation of the noise on proprioception, in the unit of each number.";
            touch as noise_touch: f64 = 0.0, DEVIATION, "Standard deviation of the noise on active touch sensors, N.";
            vestibular as noise_vestibular: f64 = 0.0, DEVIATION, "Standard deviation of the noise on the head's motion, m/s^2 and rad/s.";
            vision as noise_vision: f64 = 0.0, DEVIATION, "Standard deviation of the noise on images, on a scale of 255.";
            motor as noise_motor: f64 = 0.0, SHARE, "Standard deviation of the noise on actions, as a share of each number, so that it grows with effort.";
            motor_color as noise_motor_color: Option<f64> = None, COLOR, "The exponent of the colour of `noise_motor`; none for white noise.";
        }
    }
    "Proprioception" {
        proprio_velocity: bool = true, Bool, "Joint velocities are observed.";
        proprio_torque: bool = true, Bool, "Joint torques are observed.";
        proprio_limits: bool = true, Bool, "The distance of joints into their limits is observed.";
        proprio_actuation: bool = true, Bool, "The state of the actuators is observed.";
    }
    "Vestibular" {
        vestibular_active: bool = true, Bool, "The head's motion is observed.";
    }
    "Vision" {
        vision_active: bool = true, Bool, "The images of both eyes are observed.";
        vision_resolution: u32 = 64, PIXELS, "Width and height of an eye's image, pixels, unless the eye has its own keys.";
        vision_outputs: VisionOutputs = VisionOutputs::default(), List(VisionOutput::NAMES), "The kinds of images of each eye that are observed.";
        vision_threads: u32 = 1, EYES, "Threads that draw both eyes of a single environment; 2 takes less wall time and gives the same bytes." + "Vectors have their own threads and draw each environment with one.";
        vision_rate: Option<f64> = None, RATE, "Pictures that each eye sees per second, Hz; none for one per step." + "Between two pictures the last one is observed. Environments with different seeds see pictures in different steps.";
        vision_lazy: bool = false, Bool, "Images are drawn only on request." + "Rust requests them with `SensesMut::look`, Python with `env.eyes()`. All are drawn if a later image depends on each, through noise, a delay or a rate.";
        @group eyes: EyeOptions, "What the eyes see, how sharp, and where (`vision_width` ...).", "What the eyes see, how sharp, and where." {
            width as vision_width: Option<u32> = None, OWN_PIXELS, "The width of an eye's image, pixels; none for `vision_resolution`.";
            width_left as vision_width_left: Option<u32> = None, OWN_PIXELS, "The width of the left eye's image, pixels; none to follow `vision_width`.";
            width_right as vision_width_right: Option<u32> = None, OWN_PIXELS, "The width of the right eye's image, pixels; none to follow `vision_width`.";
            height as vision_height: Option<u32> = None, OWN_PIXELS, "The height of an eye's image, pixels; none for `vision_resolution`.";
            height_left as vision_height_left: Option<u32> = None, OWN_PIXELS, "The height of the left eye's image, pixels; none to follow `vision_height`.";
            height_right as vision_height_right: Option<u32> = None, OWN_PIXELS, "The height of the right eye's image, pixels; none to follow `vision_height`.";
            fovy as vision_fovy: Option<f64> = None, FIELD, "The vertical field of view of an eye, degrees; none for the camera's, 60 by default.";
            fovy_left as vision_fovy_left: Option<f64> = None, FIELD, "The vertical field of view of the left eye, degrees; none to follow `vision_fovy`.";
            fovy_right as vision_fovy_right: Option<f64> = None, FIELD, "The vertical field of view of the right eye, degrees; none to follow `vision_fovy`.";
            acuity as vision_acuity: bool = false, Bool, "Images are blurred to what eyes of MIMo's age see (18 months without an age).";
            acuity_left as vision_acuity_left: Option<f64> = None, ACUITY_AGE, "The age of the left eye's acuity, months; none to follow `vision_acuity`.";
            acuity_right as vision_acuity_right: Option<f64> = None, ACUITY_AGE, "The age of the right eye's acuity, months; none to follow `vision_acuity`.";
            foveation as vision_foveation: f64 = 0.0, STRENGTH, "How strongly the centre of images is enlarged; 10 is usual, 0 is off.";
            foveation_left as vision_foveation_left: Option<f64> = None, OWN_STRENGTH, "The foveation of the left eye; none to follow `vision_foveation`.";
            foveation_right as vision_foveation_right: Option<f64> = None, OWN_STRENGTH, "The foveation of the right eye; none to follow `vision_foveation`.";
        }
    }
    "Touch" {
        touch_active: bool = true, Bool, "Touch is observed." + "See [`Config::touch_enabled`].";
        touch_scale: f64 = 1.0, SCALE, "Factor on the distance between sensors; 0 turns touch off.";
        touch_function: TouchFunction = TouchFunction::Normal, Choice(TouchFunction::NAMES), "What a sensor reports." + "`normal` exists under `compat: api` only, `normal_force` under `compat: reference` only.";
        touch_rate: Option<f64> = None, RATE, "Samples of the skin per second, Hz; none for one per step." + "In between, touch, pain and pooled touch keep their last values.";
        touch_response: TouchResponse = TouchResponse::Nearest, Choice(TouchResponse::NAMES), "How sensors share a force.";
        @parts touch = BodyParts { eyes: false, ..BodyParts::all(true) }, "Parts that have touch sensors (`touch_hands` ...)." {
            hands as touch_hands, "The hands have touch sensors.";
            fingers as touch_fingers, "The fingers have touch sensors.";
            arms as touch_arms, "The arms have touch sensors.";
            feet as touch_feet, "The feet have touch sensors.";
            legs as touch_legs, "The legs have touch sensors.";
            body as touch_body, "The trunk has touch sensors.";
            head as touch_head, "The head has touch sensors.";
            eyes as touch_eyes, "The eyes have touch sensors.";
        }
    }
    // continued, because `config!` takes no keys after `@parts`
    "Touch" {
        touch_pooled: bool = false, Bool, "Touch pooled over each body is observed.";
    }
    "Pain" {
        pain_active: bool = false, Bool, "Pain is observed.";
        @group pain: PainOptions, "What hurts (`pain_threshold` ...).", "The sense of pain." {
            threshold as pain_threshold: f64 = 20.0, PAIN, "The force on a sensor above which it hurts, N.";
            slope as pain_slope: f64 = 0.1, PAIN, "The pain per newton above the threshold.";
            limit as pain_limit: Option<f64> = None, MOST_PAIN, "The greatest pain of a sensor; none means no limit.";
            decay_old as pain_decay_old: f64 = 0.0, SHARE, "The share of the last step's pain that remains.";
            decay_new as pain_decay_new: f64 = 1.0, SHARE, "The factor on new pain.";
        }
    }
    "Actuation" {
        actuation_model: ActuationModel = ActuationModel::SpringDamper, Choice(ActuationModel::NAMES), "How actions become torques.";
        @parts act = BodyParts::all(true), "Parts that are actuated (`act_hands` ...)." {
            hands as act_hands, "The hands are actuated.";
            fingers as act_fingers, "The fingers are actuated.";
            arms as act_arms, "The arms are actuated.";
            feet as act_feet, "The feet are actuated.";
            legs as act_legs, "The legs are actuated.";
            body as act_body, "The trunk is actuated.";
            head as act_head, "The head is actuated.";
            eyes as act_eyes, "The eyes are actuated.";
        }
    }
    // continued, as "Touch" is
    "Actuation" {
        act_others: bool = false, Bool, "The last numbers of an action drive actuators of other bodies, which are also observed." + "The observation has their controls and their joints.";
    }
    "Reflexes" {
        @group reflexes: ReflexOptions, "Reflexes (`reflexes`, `reflex_gain` ...).", "Reflexes of infants." {
            set as reflexes: ReflexSet = ReflexSet::default(), REFLEXES, "MIMo's reflexes.";
            gain as reflex_gain: f64 = 1.0, FACTOR, "Factor on the gains of all reflexes.";
            vor as reflex_vor: ReflexVor = ReflexVor::Replace, Choice(ReflexVor::NAMES), "What the reflex vor does with the action of the eyes.";
            observed as reflex_observed: bool = false, Bool, "How strongly each reflex acts is observed.";
        }
        @group reflex_gains: ReflexGains, "Gains of single reflexes (`reflex_gain_vor` ...).", "Gains of single reflexes, in place of those of MIMo's age." {
            palmar_grasp as reflex_gain_palmar_grasp: Option<f64> = None, OWN_FACTOR, "The gain of the palmar grasp, 1 is full; none to follow MIMo's age.";
            plantar_grasp as reflex_gain_plantar_grasp: Option<f64> = None, OWN_FACTOR, "The gain of the plantar grasp, 1 is full; none to follow MIMo's age.";
            rooting as reflex_gain_rooting: Option<f64> = None, OWN_FACTOR, "The gain of rooting, 1 is full; none to follow MIMo's age.";
            moro as reflex_gain_moro: Option<f64> = None, OWN_FACTOR, "The gain of the Moro reflex, 1 is full; none to follow MIMo's age.";
            atnr as reflex_gain_atnr: Option<f64> = None, OWN_FACTOR, "The gain of the asymmetric tonic neck reflex, 1 is full; none to follow MIMo's age.";
            stepping as reflex_gain_stepping: Option<f64> = None, OWN_FACTOR, "The gain of stepping, 1 is full; none to follow MIMo's age.";
            vor as reflex_gain_vor: Option<f64> = None, OWN_FACTOR, "The gain of the vestibulo-ocular reflex, eyes over head; none to follow MIMo's age.";
            stretch as reflex_gain_stretch: Option<f64> = None, OWN_FACTOR, "The gain of the stretch reflex, 1 is full; none to follow MIMo's age.";
        }
        @group reflex_delays: ReflexDelays, "Delays of single reflexes (`reflex_delay_vor` ...).", "Delays of single reflexes, ms, in place of their own." {
            palmar_grasp as reflex_delay_palmar_grasp: Option<f64> = None, REFLEX_DELAY, "The delay of the palmar grasp, ms; none for the default.";
            plantar_grasp as reflex_delay_plantar_grasp: Option<f64> = None, REFLEX_DELAY, "The delay of the plantar grasp, ms; none for the default.";
            rooting as reflex_delay_rooting: Option<f64> = None, REFLEX_DELAY, "The delay of rooting, ms; none for the default.";
            moro as reflex_delay_moro: Option<f64> = None, REFLEX_DELAY, "The delay of the Moro reflex, ms; none for the default.";
            atnr as reflex_delay_atnr: Option<f64> = None, REFLEX_DELAY, "The delay of the asymmetric tonic neck reflex, ms; none for the default.";
            stepping as reflex_delay_stepping: Option<f64> = None, REFLEX_DELAY, "The delay of stepping, ms; none for the default.";
            vor as reflex_delay_vor: Option<f64> = None, REFLEX_DELAY, "The delay of the vestibulo-ocular reflex, ms; none for the default.";
            stretch as reflex_delay_stretch: Option<f64> = None, REFLEX_DELAY, "The delay of the stretch reflex, ms; none for the default.";
        }
    }
    "Locked joints" {
        @parts lock = BodyParts::all(false), "Parts whose joints are locked (`lock_hands` ...)." {
            hands as lock_hands, "The joints of the hands are locked.";
            fingers as lock_fingers, "The joints of the fingers are locked.";
            arms as lock_arms, "The joints of the arms are locked.";
            feet as lock_feet, "The joints of the feet are locked.";
            legs as lock_legs, "The joints of the legs are locked.";
            body as lock_body, "The joints of the trunk are locked.";
            head as lock_head, "The joints of the head are locked.";
            eyes as lock_eyes, "The joints of the eyes are locked.";
        }
    }
}

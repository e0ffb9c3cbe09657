//! Values of the configuration that exclude each other.

use super::error::Conflict;
use super::{
    ActuationModel, Behavior, Compat, Config, DelayUnit, Delays, KeyValue, Reflex, Sex, StrengthModel, TouchFunction,
    VisionOutput, defaults, latencies, table,
};

/// Greatest delay, steps of the environment.
const MAX_DELAY: usize = 1000;

/// Greatest memory that the images of a delay may take, bytes.
const MAX_WAITING: usize = 1 << 30;

/// The keys of the fields of view of the eyes.
const FIELDS: [&str; 3] = ["vision_fovy", "vision_fovy_left", "vision_fovy_right"];

/// The keys of the sizes of their images.
const SIDES: [&str; 7] = [
    "vision_resolution",
    "vision_width",
    "vision_width_left",
    "vision_width_right",
    "vision_height",
    "vision_height_left",
    "vision_height_right",
];

/// Keys of MIMo's body and motors that the Python code of BabyBench does not have.
const BODY: [&str; 12] = [
    "strength",
    "springs",
    "proportions",
    "sex",
    "length_z",
    "weight_z",
    "head_z",
    "gestation",
    "body_random",
    "noise_motor_color",
    "reflexes",
    "age_schedule",
];

/// Keys that shape a sense, and the remedy when it is off.
struct SenseKeys {
    off: fn(&Config) -> bool,
    keys: &'static [&'static str],
    reason: &'static str,
}

/// The keys that shape senses that can be off, or motors.
const SHAPING: [SenseKeys; 12] = [
    SenseKeys {
        off: |c| c.individual.random == 0.0,
        keys: &["body_seed", "body_number"],
        reason: "it chooses an infant of a population, and there is none; set `body_random` above 0",
    },
    SenseKeys {
        off: |c| c.individual.random == 0.0 && c.individual.sex == Sex::None,
        keys: &["length_z", "weight_z", "head_z", "gestation"],
        reason: "the standards of growth are of boys or of girls; set `sex: boy` or `sex: girl`",
    },
    SenseKeys {
        off: |c| c.measurements.head_circumference.is_some(),
        keys: &["head_z"],
        reason: "`head_circumference` sets the same length; leave one of the two out",
    },
    SenseKeys {
        off: |c| c.age_schedule.is_empty(),
        keys: &["age_grid"],
        reason: "it rounds the ages of `age_schedule`, which is none; set `age: {0: 1, 500000: 6}`",
    },
    SenseKeys {
        off: |c| !c.vision_active,
        keys: &[
            "vision_acuity",
            "vision_acuity_left",
            "vision_acuity_right",
            "vision_foveation",
            "vision_foveation_left",
            "vision_foveation_right",
            "noise_vision",
            "delay_vision",
            "vision_rate",
            "vision_lazy",
        ],
        reason: "it shapes what the eyes see, and they are off; set `vision_active: true`",
    },
    SenseKeys {
        off: |c| {
            ![VisionOutput::Rgb, VisionOutput::Gray]
                .iter()
                .any(|&o| c.vision_outputs.contains(o))
        },
        keys: &[
            "vision_acuity",
            "vision_acuity_left",
            "vision_acuity_right",
            "noise_vision",
        ],
        reason: "it changes images in colour and grey, and neither is observed; add rgb or gray to `vision_outputs`",
    },
    SenseKeys {
        off: |c| !c.touch_enabled(),
        keys: &[
            "touch_pooled",
            "pain_active",
            "noise_touch",
            "delay_touch",
            "touch_rate",
        ],
        reason: "it needs touch, which is off; set `touch_active: true` and a `touch_scale` above 0",
    },
    SenseKeys {
        off: |c| !c.vestibular_active,
        keys: &["noise_vestibular", "delay_vestibular"],
        reason: "it shapes the sense of balance, which is off; set `vestibular_active: true`",
    },
    SenseKeys {
        off: |c| c.actuation_model == ActuationModel::Positional,
        keys: &["noise_motor"],
        reason: "it grows with the effort, and actions of `actuation_model: positional` are angles; choose spring_damper or muscle",
    },
    SenseKeys {
        off: |c| !c.pain_active,
        keys: &[
            "pain_threshold",
            "pain_slope",
            "pain_limit",
            "pain_decay_old",
            "pain_decay_new",
        ],
        reason: "it shapes pain, which is off; set `pain_active: true`",
    },
    SenseKeys {
        off: |c| c.noise.motor == 0.0,
        keys: &["noise_motor_color"],
        reason: "it is the colour of the noise of actions, which is off; set `noise_motor` above 0",
    },
    SenseKeys {
        off: |c| c.strength != StrengthModel::Infant,
        keys: &[
            "strength_neck",
            "strength_trunk",
            "strength_shoulder",
            "strength_elbow",
            "strength_wrist",
            "strength_grip",
            "strength_hip",
            "strength_knee",
            "strength_ankle",
        ],
        reason: "it is a factor on the strength of infants; set `strength: infant`",
    },
];

impl Config {
    /// Returns the first value that another one excludes: key, value, and why.
    pub(super) fn conflict(&self) -> Option<Conflict> {
        self.unused()
            .or_else(|| self.unequal_ages())
            .or_else(|| self.impossible_delay())
            .or_else(|| self.impossible_reflex())
            .or_else(|| defaults::conflict(self))
            .or_else(|| self.unlike_reference())
    }

    /// Returns the first value that `compat` excludes.
    fn unlike_reference(&self) -> Option<Conflict> {
        // keys that shape touch exclude nothing while it is off: files of the kit keep them
        let touch = self.touch_enabled();
        let function = self.touch_function;
        let (key, value, reason) = match self.compat {
            Compat::Api if function == TouchFunction::NormalForce => (
                "touch_function",
                function.to_string(),
                "that is the Python code's name for another quantity; use normal, force_vector or \
                 force_vector_global, or set `compat: reference`",
            ),
            Compat::Api => return None,
            Compat::Reference if touch && function == TouchFunction::Normal => (
                "touch_function",
                function.to_string(),
                "the Python code that `compat: reference` follows does not have it; use force_vector, \
                 force_vector_global or normal_force",
            ),
            // The Python code places touch sensors by the one-finger table, whose fingers MIMo v2 does not have.
            Compat::Reference if touch && self.touch.fingers && self.behavior == Behavior::HandRegard => (
                "touch_fingers",
                self.touch.fingers.to_string(),
                "the Python code that `compat: reference` follows has no finger touch with `behavior: hand_regard`; \
                 set `touch_fingers: false` or `touch_active: false`",
            ),
            Compat::Reference if self.rates().next().is_some() => {
                let (key, rate) = self.rates().next().unwrap_or(("vision_rate", 0.0));
                let reason = "the Python code that `compat: reference` follows samples vision and touch in every step";
                return Some((key, format!("{rate:?}"), reason.to_string()));
            }
            Compat::Reference if self.vision_lazy => (
                "vision_lazy",
                self.vision_lazy.to_string(),
                "the Python code that `compat: reference` follows draws images in every step",
            ),
            Compat::Reference => return self.body_unlike_reference().or_else(|| self.eyes_unlike_reference()),
        };
        Some((key, value, reason.to_string()))
    }

    /// Returns the first value with which observations would change their shape while MIMo grows.
    fn unequal_ages(&self) -> Option<Conflict> {
        if self.age_schedule.is_empty() || !self.touch_enabled() || self.touch_grows {
            return None;
        }
        let reason = "MIMo grows by `age_schedule`, and the number of touch sensors would change with his skin; set `touch_grows: true`, \
                      or `touch_active: false`";
        Some(("touch_grows", self.touch_grows.to_string(), reason.to_string()))
    }

    /// Returns the first key about reflexes that has no meaning beside the others.
    fn impossible_reflex(&self) -> Option<Conflict> {
        let set = self.reflexes.set;
        let refuse = |key: &super::Key, reason: &str| Some((key.name, key.value(self).to_yaml(), reason.to_string()));
        if set.is_mixed() {
            let key = Self::keys().iter().find(|key| key.name == "reflexes")?;
            let reason = "`by_age` is all reflexes of MIMo's age; use it alone, or list names";
            return refuse(key, reason);
        }
        let changed = |key: &&super::Key| key.value(self) != key.default_value();
        let mut keys = Self::keys()
            .iter()
            .filter(|key| key.name.starts_with("reflex_"))
            .filter(changed);
        keys.find_map(|key| {
            let about = key
                .name
                .strip_prefix("reflex_gain_")
                .or_else(|| key.name.strip_prefix("reflex_delay_"));
            let own = match about {
                Some(name) => Reflex::from_name(name),
                None => (key.name == "reflex_vor").then_some(Reflex::Vor),
            };
            match own {
                Some(reflex) if !set.may_have(reflex) => {
                    let reason = format!("that reflex is off; add {reflex} to `reflexes`, or leave this key out");
                    refuse(key, &reason)
                }
                None if set.is_empty() => refuse(key, "it shapes reflexes, which are off; set `reflexes`"),
                _ => None,
            }
        })
    }

    /// Returns the first value of the body that the Python code that `compat: reference` follows cannot have.
    fn body_unlike_reference(&self) -> Option<Conflict> {
        let mut keys = Self::keys().iter().filter(|key| BODY.contains(&key.name));
        let key = keys.find(|key| key.value(self) != key.default_value())?;
        let reason =
            "the Python code that `compat: reference` follows does not have it; leave it out, or set `compat: api`";
        Some((key.name, key.value(self).to_yaml(), reason.to_string()))
    }

    /// Returns the first value of the eyes that the Python code that `compat: reference` follows cannot have.
    fn eyes_unlike_reference(&self) -> Option<Conflict> {
        let conflict = |key: &super::Key, reason: &str| (key.name, key.value(self).to_yaml(), reason.to_string());
        let first = |keys: &[&str], fits: &dyn Fn(KeyValue) -> bool| {
            let mut keys = Self::keys().iter().filter(|key| keys.contains(&key.name));
            keys.find(|key| fits(key.value(self)))
        };
        if let Some(key) = first(&FIELDS, &|value| value != KeyValue::None) {
            let reason = "the Python code that `compat: reference` follows draws what the cameras of the scene see";
            return Some(conflict(key, reason));
        }
        let sides = self.eye_sizes().into_iter().flatten();
        // eyes that are off are never drawn, so their size is free
        let most = sides
            .max()
            .filter(|most| self.vision_active && *most > self.render_size as usize)?;
        let key = first(&SIDES, &|value| value == KeyValue::Whole(most as u64))?;
        let reason =
            "under `compat: reference` an eye's image cannot be larger than `render_size`; raise `render_size`";
        Some(conflict(key, reason))
    }

    /// Returns the first value without effect, because the sense that it shapes is off.
    fn unused(&self) -> Option<Conflict> {
        // a default says nothing of what the user wants, so only values that differ from it are refused
        let set = |key: &&super::Key| key.value(self) != key.default_value();
        let conflict = |key: &super::Key, reason: &str| (key.name, key.value(self).to_yaml(), reason.to_string());
        if self.age.is_none() && self.age_schedule.is_empty() {
            let mut of_growth = Self::keys().iter().filter(|key| key.section == table::GROWTH);
            if let Some(key) = of_growth.find(set) {
                let reason = "it changes MIMo at an age, and `age` is none; set `age`, 0 to 24 months";
                return Some(conflict(key, reason));
            }
        }
        SHAPING
            .iter()
            .filter(|shaping| (shaping.off)(self))
            .find_map(|shaping| {
                let mut keys = Self::keys().iter().filter(|key| shaping.keys.contains(&key.name));
                keys.find(set).map(|key| conflict(key, shaping.reason))
            })
    }

    /// Returns the first delay that is not a whole number of steps, or that needs too much memory.
    fn impossible_delay(&self) -> Option<Conflict> {
        let delays = &self.delays;
        if delays.by_age && self.age.is_none() && self.age_schedule.is_empty() {
            let reason = "it is that of MIMo's age, and `age` is none; set `age`, 0 to 24 months";
            return Some(("delay_by_age", delays.by_age.to_string(), reason.to_string()));
        }
        // either would win in silence over the other
        if delays.by_age && delays.sensory != 0.0 {
            let reason = "with `delay_by_age` each sense has the delay of MIMo's age; leave it out, or give `delay_touch`, `delay_vision`, .. \
                          what they have instead";
            return Some(("delay_sensory", format!("{:?}", delays.sensory), reason.to_string()));
        }
        let each = [
            ("delay_sensory", Some(delays.sensory)),
            ("delay_motor", Some(delays.motor)),
            ("delay_proprioception", delays.proprioception),
            ("delay_touch", delays.touch),
            ("delay_vestibular", delays.vestibular),
            ("delay_vision", delays.vision),
        ];
        for (key, delay) in each {
            let Some(delay) = delay else { continue };
            // milliseconds are rounded to steps, whose length a user need not know; a fraction of a step is a mistake
            if delays.unit == DelayUnit::Steps && delay.fract() != 0.0 {
                let reason = "it is counted in whole steps; use a whole number, or set `delay_unit: ms`";
                return Some((key, format!("{delay:?}"), reason.to_string()));
            }
            // the lines of all delays are allocated when the environment is made
            let steps = delays.steps(delay, self.frame_skip);
            if steps > MAX_DELAY {
                let step = Delays::step_ms(self.frame_skip);
                let reason = format!("that is {steps} steps of {step} ms, and a delay has at most {MAX_DELAY}");
                return Some((key, format!("{delay:?}"), reason));
            }
        }
        let bytes = |output| match output {
            VisionOutput::Rgb => 3,
            VisionOutput::Gray => 1,
            VisionOutput::Depth | VisionOutput::Segmentation => 4,
        };
        // a delay of images is the only one whose memory can exceed a gigabyte within the limit of steps
        let pixels: usize = self.eye_sizes().iter().map(|[width, height]| width * height).sum();
        let images = pixels * self.vision_outputs.iter().map(bytes).sum::<usize>();
        let waiting = self.sense_delay(delays.vision, latencies::SIGHT).saturating_mul(images);
        (self.vision_active && waiting > MAX_WAITING).then(|| {
            let (key, delay) = match delays.vision {
                Some(delay) => ("delay_vision", format!("{delay:?}")),
                None if delays.by_age => ("delay_by_age", delays.by_age.to_string()),
                None => ("delay_sensory", format!("{:?}", delays.sensory)),
            };
            let reason = format!(
                "the delayed images would take {} MB; the limit is {} MB. Lower it, or `vision_resolution`",
                waiting / 1_000_000,
                MAX_WAITING / 1_000_000
            );
            (key, delay, reason)
        })
    }
}

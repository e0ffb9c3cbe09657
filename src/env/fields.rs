//! The keys and values of information. Logs, lines of JSON, serde, snapshots and Python's dictionaries follow from this description.

use std::sync::Arc;

use super::task::measures_of;
use super::{
    BehaviorInfo, EYE_HAND_PAIRS, Info, InfoDetails, Measures, Outcome, PerEyeAndHand, PerHand, RegardCounts, TaskInfo,
};
use crate::config::Reflex;

/// Keys of the geoms that the palms have touched, right and left.
const TOUCHES: [&str; 2] = ["right_hand_touches", "left_hand_touches"];
/// Keys of their names.
pub(crate) const PARTS: [&str; 2] = ["right_hand_parts", "left_hand_parts"];
/// Keys of the report of a task with a goal.
const TASK: [&str; 4] = ["task", "is_success", "is_failure", "return"];
/// Keys of the shares of steps in which reflexes acted, in the order of [`Reflex::ALL`].
const REFLEXES: [&str; Reflex::ALL.len()] = [
    "reflex_palmar_grasp",
    "reflex_plantar_grasp",
    "reflex_rooting",
    "reflex_moro",
    "reflex_atnr",
    "reflex_stepping",
    "reflex_vor",
    "reflex_stretch",
];
/// The key of the number of steps.
pub(crate) const STEPS: &str = "steps";

/// A value of the information.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum InfoValue<'a> {
    /// A number of steps.
    Count(u64),
    /// Geom ids.
    Geoms(&'a [usize]),
    /// The name of a task.
    Name(&'a str),
    /// Success or failure.
    Flag(bool),
    /// A sum of rewards.
    Number(f64),
    /// Names of parts of the body.
    Parts(&'a [Arc<str>]),
    /// Angles of gaze, rad.
    Angles(PerEyeAndHand<f64>),
    /// Numbers of steps.
    Counts(PerEyeAndHand<u64>),
}

/// A key of the information with its value.
pub type InfoField<'a> = (&'static str, InfoValue<'a>);

impl BehaviorInfo {
    /// Iterates over keys and values, in the order of the reference. A task's measures come last.
    ///
    /// ```
    /// use babybench::config::Behavior;
    /// use babybench::{Env, env::InfoValue};
    /// use babybench::Config;
    ///
    /// let mut env = Env::new(Config::of(Behavior::Standup))?;
    /// env.reset(Some(0))?;
    /// let fields: Vec<_> = env.info().behavior.fields().collect();
    /// assert_eq!(fields[0], ("task", InfoValue::Name("standup")));
    /// assert_eq!(fields[1], ("is_success", InfoValue::Flag(false)));
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    pub fn fields(&self) -> impl Iterator<Item = InfoField<'_>> {
        let values: [Option<InfoField<'_>>; 4] = match self {
            Self::None => [None; 4],
            Self::SelfTouch { touches } => {
                let [right, left] = touches.each_ref();
                [
                    Some((TOUCHES[0], InfoValue::Geoms(right))),
                    Some((TOUCHES[1], InfoValue::Geoms(left))),
                    None,
                    None,
                ]
            }
            Self::HandRegard { counts } => {
                let counts = counts.to_array();
                std::array::from_fn(|k| Some((EYE_HAND_PAIRS[k], InfoValue::Count(counts[k]))))
            }
            Self::Task(info) => [
                Some((TASK[0], InfoValue::Name(&info.task))),
                Some((TASK[1], InfoValue::Flag(info.outcome.is_success))),
                Some((TASK[2], InfoValue::Flag(info.outcome.is_failure))),
                Some((TASK[3], InfoValue::Number(info.episode_return))),
            ],
        };
        let measures = self.task().into_iter().flat_map(|info| info.measures.iter());
        let measures = measures.map(|(name, value)| (name, InfoValue::Number(value)));
        values.into_iter().flatten().chain(measures)
    }

    /// Reads the information of the behavior whose keys a source has, in the order in which [`BehaviorInfo::fields`] returns them.
    pub(crate) fn read<S: InfoSource>(source: &mut S) -> Result<Self, S::Error> {
        if source.has(TOUCHES[0]) {
            let [right_hand, left_hand] = [source.geoms(TOUCHES[0])?, source.geoms(TOUCHES[1])?];
            return Ok(Self::SelfTouch {
                touches: PerHand { right_hand, left_hand },
            });
        }
        if source.has(EYE_HAND_PAIRS[0]) {
            let mut counts = [0; 4];
            for (count, key) in counts.iter_mut().zip(EYE_HAND_PAIRS) {
                *count = source.count(key)?;
            }
            return Ok(Self::HandRegard { counts: counts.into() });
        }
        if source.has(TASK[0]) {
            let task = source.name(TASK[0])?;
            let outcome = Outcome {
                is_success: source.flag(TASK[1])?,
                is_failure: source.flag(TASK[2])?,
            };
            let episode_return = source.number(TASK[3])?;
            let names = measures_of(&task);
            let values = names
                .iter()
                .map(|name| source.measure(name))
                .collect::<Result<Vec<_>, _>>()?;
            let mut measures = Measures::default();
            measures.set(names, values);
            return Ok(Self::Task(TaskInfo {
                task,
                outcome,
                episode_return,
                measures,
            }));
        }
        Ok(Self::None)
    }

    /// Returns whether a key is one of those of some behavior.
    #[cfg(feature = "eval")]
    pub(crate) fn is_key(key: &str) -> bool {
        [&TOUCHES[..], &EYE_HAND_PAIRS, &TASK].concat().contains(&key)
    }
}

impl InfoDetails {
    /// Iterates over the keys and values that exist.
    pub fn fields(&self) -> impl Iterator<Item = InfoField<'_>> {
        let parts = self.touched_parts.as_ref().map(PerHand::each_ref);
        let parts = parts.map(|parts| [0, 1].map(|hand| (PARTS[hand], InfoValue::Parts(parts[hand]))));
        let angles = self
            .gaze_angles
            .map(|angles| ("gaze_angles", InfoValue::Angles(angles)));
        let body_age = self.age.map(|age| ("age", InfoValue::Number(age)));
        let age = self.vision_age.map(|age| ("vision_age", InfoValue::Number(age)));
        let regards = self.regards.map(|RegardCounts { page, kit }| {
            [
                ("page_regards", InfoValue::Counts(page)),
                ("kit_regards", InfoValue::Counts(kit)),
            ]
        });
        let reflexes = self.reflexes.into_iter().flat_map(|shares| {
            let each = REFLEXES.into_iter().zip(Reflex::ALL);
            each.filter_map(move |(key, &reflex)| Some((key, InfoValue::Number(shares.get(reflex)?))))
        });
        parts
            .into_iter()
            .flatten()
            .chain(angles)
            .chain(age)
            .chain(body_age)
            .chain(regards.into_iter().flatten())
            .chain(reflexes)
    }
}

impl Info {
    /// Iterates over keys and values in the order in which this library writes them: the behavior's, the details if wanted, `steps`.
    pub fn fields<'a>(&'a self, details: Option<&'a InfoDetails>) -> impl Iterator<Item = InfoField<'a>> {
        let details = details.into_iter().flat_map(InfoDetails::fields);
        let steps = (STEPS, InfoValue::Count(self.steps));
        self.behavior.fields().chain(details).chain([steps])
    }

    /// Reads information, without details.
    #[cfg(feature = "eval")]
    pub(crate) fn read<S: InfoSource>(source: &mut S) -> Result<Self, S::Error> {
        Ok(Self {
            behavior: BehaviorInfo::read(source)?,
            steps: source.count(STEPS)?,
            details: InfoDetails::default(),
        })
    }
}

/// A source of information: values by key.
pub(crate) trait InfoSource {
    /// The reason why a value cannot be read.
    type Error;

    /// Returns whether the value exists.
    fn has(&self, key: &'static str) -> bool;

    /// Reads a number of steps.
    fn count(&mut self, key: &'static str) -> Result<u64, Self::Error>;

    /// Reads geom ids.
    fn geoms(&mut self, key: &'static str) -> Result<Vec<usize>, Self::Error>;

    /// Reads the name of a task.
    fn name(&mut self, key: &'static str) -> Result<Arc<str>, Self::Error>;

    /// Reads a truth value.
    fn flag(&mut self, key: &'static str) -> Result<bool, Self::Error>;

    /// Reads a finite number.
    fn number(&mut self, key: &'static str) -> Result<f64, Self::Error>;

    /// Reads a measure of a task.
    fn measure(&mut self, key: &'static str) -> Result<f64, Self::Error> {
        self.number(key)
    }
}

//! Protocols: experiments with infants, as data. A document has the scene, the phases, the measures and the published numbers; a run prints
//! what MIMo does beside them, for any policy.
//!
//! ```no_run
//! use babybench::eval::protocol::{Protocol, ProtocolPlan};
//!
//! let protocol = Protocol::named("pull_to_sit")?;
//! let plan = ProtocolPlan { ages: Some(vec![0.0, 6.0]), ..ProtocolPlan::default() };
//! let result = protocol.run(&plan, "results/pull_to_sit".as_ref(), 2, &|| std::ops::ControlFlow::Continue(()))?;
//! print!("{}", result.to_markdown());
//! # Ok::<(), babybench::eval::protocol::ProtocolError>(())
//! ```

mod comparison;
mod controls;
mod document;
mod entries;
mod error;
mod figure;
mod fixture;
mod job;
mod observed;
mod plan;
mod published;
mod result;
mod rules;
mod sample;
mod show;
mod table;
mod tree;
mod trial;

use std::path::{Path, PathBuf};

pub use comparison::{Comparison, Difference};
pub use error::ProtocolError;
pub use plan::ProtocolPlan;
pub use published::PublishedRow;
pub use result::{ProtocolResult, ProtocolRow, ProtocolRun};
use serde::Serialize;

use super::movement::MovementOptions;
use crate::config::Config;
use crate::files;
use crate::json;
use crate::limits::Limits;
use crate::text::nearest;

/// An experiment: its scene, phases, measures and published numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Protocol {
    /// Its name.
    pub name: String,
    /// A title.
    pub title: String,
    /// What happens.
    pub about: String,
    /// The configuration, without an age.
    #[serde(skip)]
    pub config: Config,
    /// The keys of the configuration that the document sets, as YAML.
    pub keys: String,
    /// Ages, months.
    pub ages: Vec<f64>,
    /// Number of trials. Each begins with a reset and has all phases.
    pub trials: u32,
    /// The phases of a trial, in order.
    pub phases: Vec<Phase>,
    /// What holds and moves MIMo, if something does.
    pub fixture: Option<Fixture>,
    /// The conditions, in order. Each is run with the same seeds.
    pub conditions: Vec<Condition>,
    /// The camera that sees the movements.
    pub camera: MovementOptions,
    /// The measures, in the order of tables.
    pub measures: Vec<ProtocolMeasure>,
    /// Published numbers.
    pub published: Vec<PublishedRow>,
    /// The document.
    #[serde(skip)]
    text: String,
    /// The folder at which paths of scenes start.
    #[serde(skip)]
    folder: PathBuf,
}

/// A phase of a trial.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Phase {
    /// Its name.
    pub name: String,
    /// What happens in it.
    pub about: String,
    /// Its length, s.
    pub seconds: f64,
    /// Number of equal parts in which it is measured.
    pub parts: u32,
}

/// A body that holds MIMo and turns him about the axis y through his hip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fixture {
    /// Where he starts.
    pub kind: FixtureKind,
    /// The body of MIMo that it holds.
    pub weld: String,
    /// The angle by which it turns in the phase, at constant speed, degrees.
    pub degrees: f64,
    /// The joints whose sum of angles is measured.
    pub joints: Vec<String>,
    /// Angles of the fixture, degrees, at which minus that sum is measured: `at_45`.
    pub at: Vec<f64>,
    /// The sum, degrees, from which he has given way: `gives_way` is the angle of the fixture then.
    pub gives_way: Option<f64>,
}

/// The start of a fixture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FixtureKind {
    /// He lies on his back and is raised.
    Pull,
    /// He is upright in the air, with all joints at 0, and is tilted forward.
    Tilt,
}

/// A condition of an experiment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// Its name.
    pub name: String,
    /// What is different.
    pub about: String,
    /// Keys over those of the configuration, as YAML.
    pub keys: String,
    /// Actuators that the protocol moves instead of the policy.
    pub controls: Vec<Control>,
    /// A joint that repeats what it did in another condition.
    pub yoke: Option<Yoke>,
}

impl Default for Condition {
    fn default() -> Self {
        Self {
            name: "policy".to_string(),
            about: String::new(),
            keys: String::new(),
            controls: Vec::new(),
            yoke: None,
        }
    }
}

/// An actuator that pulls back the sum of some angles.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Control {
    /// The actuator.
    pub actuator: String,
    /// The joints.
    pub joints: Vec<String>,
    /// Share of its torque for each rad; at most the whole torque.
    pub gain: f64,
}

/// A joint that repeats what it did in another condition, so that MIMo has no effect on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Yoke {
    /// The joint.
    pub joint: String,
    /// The earlier condition.
    pub to: String,
    /// The phase.
    pub phase: String,
}

/// A measure of a protocol.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProtocolMeasure {
    /// Its name in files.
    pub name: String,
    /// Its heading in tables.
    pub label: String,
    /// Its unit; empty for ratios.
    pub unit: String,
    /// Number of decimals that tables show.
    pub decimals: usize,
    /// What it is.
    pub meaning: String,
    /// Whether the figure shows it.
    pub figure: bool,
    /// How it follows from others.
    pub rule: MeasureRule,
}

/// How a measure follows from others.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum MeasureRule {
    /// It is measured in each part of a phase: the mean over parts and trials, weighted by time.
    #[default]
    Direct,
    /// The mean of the measures that are defined.
    Mean(Vec<String>),
    /// The number of different orders of these times among the trials that have all of them.
    Orders(Vec<String>),
    /// A measure over its value in another phase.
    Ratio {
        /// The measure.
        of: String,
        /// The other phase.
        over: String,
    },
    /// The end, min from the start of the phase, of the first part whose value is `times` that of another phase.
    Reached {
        /// The measure.
        of: String,
        /// The other phase.
        over: String,
        /// The factor.
        times: f64,
    },
    /// The age, months, at which a measure crosses a level, linear between ages.
    Age {
        /// The measure.
        of: String,
        /// The level.
        level: f64,
        /// Whether it falls below the level; otherwise it rises above it.
        falls: bool,
    },
}

/// Names and documents of the protocols of the library.
const LIBRARY: [(&str, &str); 6] = [
    ("pull_to_sit", include_str!("../../../assets/protocols/pull_to_sit.yml")),
    (
        "supported_sit",
        include_str!("../../../assets/protocols/supported_sit.yml"),
    ),
    ("kick", include_str!("../../../assets/protocols/kick.yml")),
    ("self_touch", include_str!("../../../assets/protocols/self_touch.yml")),
    ("roll_over", include_str!("../../../assets/protocols/roll_over.yml")),
    ("mobile", include_str!("../../../assets/protocols/mobile.yml")),
];

impl Protocol {
    /// Returns the names of the protocols of the library.
    pub fn names() -> impl Iterator<Item = &'static str> {
        LIBRARY.iter().map(|(name, _)| *name)
    }

    /// Returns a protocol of the library, or reads a document whose name ends in `.yml`.
    ///
    /// ```
    /// use babybench::eval::protocol::Protocol;
    ///
    /// let error = Protocol::named("pull_to_sti").unwrap_err();
    /// assert!(error.to_string().contains("did you mean \"pull_to_sit\"?"));
    /// ```
    ///
    /// # Errors
    /// A name that does not exist, with the nearest one; a document that cannot be read or has a fault.
    pub fn named(name: &str) -> Result<Self, ProtocolError> {
        if let Some((name, text)) = LIBRARY.iter().find(|(known, _)| *known == name) {
            let path = PathBuf::from(format!("{name}.yml"));
            return Self::of(name, text, &path, PathBuf::new());
        }
        if name.ends_with(".yml") || name.ends_with(".yaml") {
            return Self::from_file(name);
        }
        Err(ProtocolError::Unknown {
            name: name.to_string(),
            nearest: nearest(name, Self::names()).map(str::to_string),
        })
    }

    /// Reads a document.
    ///
    /// # Errors
    /// A file that cannot be read or has a fault.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, ProtocolError> {
        let path = path.as_ref();
        let bytes = files::read(path, Limits::DEFAULT.config_bytes as u64).map_err(|source| ProtocolError::Io {
            path: path.to_path_buf(),
            source,
        })?;
        let text = String::from_utf8(bytes).map_err(|_| ProtocolError::Document {
            path: path.to_path_buf(),
            line: 1,
            reason: "this is not UTF-8 text".to_string(),
        })?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        Self::of(&name, &text, path, folder)
    }

    fn of(name: &str, text: &str, path: &Path, folder: PathBuf) -> Result<Self, ProtocolError> {
        let file = path.display().to_string();
        Self::parse(name, text, &file, folder).map_err(|fault| ProtocolError::Document {
            path: path.to_path_buf(),
            line: fault.line,
            reason: fault.reason,
        })
    }

    /// Returns the protocol as JSON.
    pub fn to_json(&self) -> String {
        json::text(self)
    }

    /// Returns a measure by its name.
    pub fn measure(&self, name: &str) -> Option<&ProtocolMeasure> {
        self.measures.iter().find(|measure| measure.name == name)
    }
}

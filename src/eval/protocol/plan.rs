//! The plan of a run: policies, ages, seeds, length.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::document::configuration;
use super::{Condition, Protocol, ProtocolError};
use crate::config::{Config, Delays, MAX_AGE};
use crate::policy::DEFAULT_LIMIT;

/// Greatest numbers of seeds, policies and ages.
const MAX_SEEDS: u64 = 1000;
const MAX_ENTRIES: usize = 100;

/// What to run of a protocol: every policy at every age from every seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProtocolPlan {
    /// Policies, as the command line names them.
    pub policies: Vec<String>,
    /// Ages, months; `None` for those of the protocol.
    pub ages: Option<Vec<f64>>,
    /// Number of seeds, which are 0, 1, ...
    pub seeds: u64,
    /// Share of the protocol's length, above 0 and at most 1: of the number of trials if there are several, otherwise of each phase.
    pub length: f64,
    /// Keys over those of the protocol's configuration, as YAML.
    pub keys: String,
    /// Whether the records of the runs are kept.
    pub keep_records: bool,
    /// Time limit of a command for an action.
    #[serde(skip, default = "limit")]
    pub limit: Duration,
}

fn limit() -> Duration {
    DEFAULT_LIMIT
}

impl Default for ProtocolPlan {
    fn default() -> Self {
        Self {
            policies: vec!["held".to_string()],
            ages: None,
            seeds: 1,
            length: 1.0,
            keys: String::new(),
            keep_records: false,
            limit: limit(),
        }
    }
}

/// The numbers of steps of a trial, by phase and part.
pub(super) type TrialSteps = Vec<Vec<u64>>;

impl ProtocolPlan {
    /// Returns the ages of a run, months.
    pub fn ages<'p>(&'p self, protocol: &'p Protocol) -> &'p [f64] {
        self.ages.as_deref().unwrap_or(&protocol.ages)
    }

    /// Checks the numbers of the plan.
    ///
    /// # Errors
    /// A number outside its range, or an empty list.
    pub fn check(&self) -> Result<(), ProtocolError> {
        let wrong =
            |what: &'static str, value: String, expected: String| Err(ProtocolError::Plan { what, value, expected });
        if !(self.length > 0.0 && self.length <= 1.0) {
            let expected = "a share of the protocol's length, above 0 and at most 1".to_string();
            return wrong("length", self.length.to_string(), expected);
        }
        if !(1..=MAX_SEEDS).contains(&self.seeds) {
            let expected = format!("a whole number from 1 to {MAX_SEEDS}");
            return wrong("seeds", self.seeds.to_string(), expected);
        }
        if self.policies.is_empty() || self.policies.len() > MAX_ENTRIES {
            let expected = format!("1 to {MAX_ENTRIES} policies");
            return wrong("policies", format!("a list of {}", self.policies.len()), expected);
        }
        if let Some(twice) = self
            .policies
            .iter()
            .enumerate()
            .find(|(k, policy)| self.policies[..*k].contains(policy))
        {
            let expected = "each policy once".to_string();
            return wrong("policies", twice.1.clone(), expected);
        }
        let ages = self.ages.as_deref().unwrap_or(&[0.0]);
        if let Some(twice) = ages.iter().enumerate().find(|(k, age)| ages[..*k].contains(age)) {
            return wrong("ages", twice.1.to_string(), "each age once".to_string());
        }
        if ages.is_empty() || ages.len() > MAX_ENTRIES || ages.iter().any(|age| !(0.0..=MAX_AGE).contains(age)) {
            let expected = format!("1 to {MAX_ENTRIES} ages in months, from 0 to {MAX_AGE}");
            return wrong("ages", format!("{ages:?}"), expected);
        }
        Ok(())
    }

    /// Returns the number of trials of a run.
    pub(super) fn trials(&self, protocol: &Protocol) -> u32 {
        match protocol.trials {
            1 => 1,
            trials => ((f64::from(trials) * self.length).round() as u32).max(1),
        }
    }

    /// Returns the length of a phase, s.
    pub(super) fn seconds(&self, protocol: &Protocol, seconds: f64) -> f64 {
        if protocol.trials == 1 && protocol.fixture.is_none() {
            seconds * self.length
        } else {
            seconds
        }
    }

    /// Returns the numbers of steps of a trial, for steps of `dt` s.
    pub(super) fn steps(&self, protocol: &Protocol, dt: f64) -> TrialSteps {
        let phases = protocol.phases.iter().map(|phase| {
            let steps = (self.seconds(protocol, phase.seconds) / dt).round();
            let end = |part: u32| (steps * f64::from(part) / f64::from(phase.parts)).round() as u64;
            (0..phase.parts)
                .map(|part| (end(part + 1) - end(part)).max(1))
                .collect()
        });
        phases.collect()
    }

    /// Returns the number of steps of all runs.
    ///
    /// # Errors
    /// A configuration that is not allowed.
    pub fn total_steps(&self, protocol: &Protocol) -> Result<u64, ProtocolError> {
        let mut steps = 0;
        for condition in &protocol.conditions {
            let config = protocol.configured(condition, &self.keys, None)?;
            let trial: u64 = self.steps(protocol, step(&config)).into_iter().flatten().sum();
            steps += trial * u64::from(self.trials(protocol));
        }
        let runs = (self.policies.len() * self.ages(protocol).len()) as u64;
        Ok(steps.saturating_mul(runs).saturating_mul(self.seeds))
    }
}

/// Returns the simulated time of a step, s.
pub(super) fn step(config: &Config) -> f64 {
    Delays::step_ms(config.frame_skip) / 1000.0
}

impl Protocol {
    /// Returns the configuration of a condition, with the keys of a plan over it, at an age.
    ///
    /// # Errors
    /// A key that does not exist, or values that exclude each other.
    pub fn configured(&self, condition: &Condition, keys: &str, age: Option<f64>) -> Result<Config, ProtocolError> {
        let mut config = self.config.clone();
        // some keys need an age, and the one of the run replaces it
        config.keep_age(age.or(self.ages.first().copied()));
        for (text, file) in [(&*condition.keys, "the condition"), (keys, "the keys of the run")] {
            if !text.is_empty() {
                config = configuration(config, text, file, self.folder.clone())
                    .map_err(|reason| ProtocolError::Config { reason })?;
            }
        }
        config.keep_age(age.or(self.ages.first().copied()));
        Ok(config)
    }
}

//! The plan of a benchmark: a small YAML file.

use std::path::{Path, PathBuf};

use granit_parser::{Event, Options, Parser};
use serde::{Deserialize, Serialize};

use super::BenchmarkError;
use crate::config::MAX_AGE;
use crate::files;
use crate::limits::Limits;
use crate::text::quoted;

/// Greatest number of entries of a list.
const MAX_ENTRIES: usize = 1000;
/// Greatest number of seeds.
const MAX_SEEDS: u64 = 1000;
/// Greatest number of steps of a run.
const MAX_STEPS: u64 = 1_000_000_000;

/// The plan of a benchmark: every configuration, at every age, with every policy, from every seed.
///
/// ```yaml
/// name: Noise                                     # a title
/// configs: [config_selftouch.yml]                 # beside the plan
/// ages: [none, 3]                                 # months; none for the configuration's own
/// policies: [random, held, "python3 policy.py"]   # as babybench evaluate takes them
/// seeds: 5                                        # 0, 1, ...
/// steps: 100000                                   # of each run
/// record: 1                                       # episodes of each run that are recorded and measured
/// evaluate: 5                                     # episodes after them, without learning and exploring; none by default
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BenchmarkPlan {
    /// A title.
    pub name: String,
    /// Files of configurations, as the plan names them.
    pub configs: Vec<String>,
    /// Ages, months; `None` for that of the configuration.
    pub ages: Vec<Option<f64>>,
    /// Policies, as the command line names them.
    pub policies: Vec<String>,
    /// Number of seeds, which are 0, 1, ...
    pub seeds: u64,
    /// Number of steps of each run.
    pub steps: u64,
    /// Number of episodes of each run that are recorded and measured, the first ones.
    pub record: u64,
    /// Number of episodes of each run after these steps, in which learning policies apply what they have learned
    /// ([`Policy::settle`](crate::policy::Policy::settle)).
    #[serde(default)]
    pub evaluate: u64,
    /// The folder of the plan, relative to which configuration files are searched for.
    #[serde(skip)]
    pub dir: PathBuf,
}

/// The keys of a plan.
const KEYS: [&str; 8] = [
    "name", "configs", "ages", "policies", "seeds", "steps", "record", "evaluate",
];

impl BenchmarkPlan {
    /// Reads a plan.
    ///
    /// # Errors
    /// A file that cannot be read or is not a plan.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, BenchmarkError> {
        let path = path.as_ref();
        let bytes = files::read(path, Limits::DEFAULT.config_bytes as u64).map_err(|source| BenchmarkError::Io {
            path: path.to_path_buf(),
            source,
        })?;
        let fault = |(line, reason): (u32, String)| BenchmarkError::Plan {
            path: path.to_path_buf(),
            line,
            reason,
        };
        let text = std::str::from_utf8(&bytes).map_err(|_| fault((1, "this is not UTF-8 text".to_string())))?;
        let dir = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        Self::parse(text, dir).map_err(fault)
    }

    fn parse(text: &str, dir: PathBuf) -> Result<Self, (u32, String)> {
        let mut plan = Self {
            name: "Benchmark".to_string(),
            configs: Vec::new(),
            ages: vec![None],
            policies: Vec::new(),
            seeds: 5,
            steps: 100_000,
            record: 1,
            evaluate: 0,
            dir,
        };
        for PlanEntry { key, values, line } in entries(text)? {
            let at = |reason: String| (line, reason);
            match key.as_str() {
                "name" => plan.name = single(&key, &values).map_err(at)?.to_string(),
                "configs" => plan.configs = values,
                "policies" => plan.policies = values,
                "ages" => {
                    plan.ages = values
                        .iter()
                        .map(|text| age(text))
                        .collect::<Result<_, _>>()
                        .map_err(at)?
                }
                "seeds" => plan.seeds = whole(&key, &values, 1, MAX_SEEDS).map_err(at)?,
                "steps" => plan.steps = whole(&key, &values, 1, MAX_STEPS).map_err(at)?,
                "record" => plan.record = whole(&key, &values, 0, MAX_SEEDS).map_err(at)?,
                "evaluate" => plan.evaluate = whole(&key, &values, 0, MAX_SEEDS).map_err(at)?,
                _ => {
                    let known = KEYS.join(", ");
                    return Err(at(format!(
                        "unknown key `{}`; the keys of a plan are {known}",
                        quoted(&key)
                    )));
                }
            }
        }
        for (key, list) in [
            ("configs", plan.configs.len()),
            ("policies", plan.policies.len()),
            ("ages", plan.ages.len()),
        ] {
            if list == 0 {
                return Err((
                    1,
                    format!("`{key}` is empty or missing: name at least one, as in `{key}: [...]`"),
                ));
            }
        }
        Ok(plan)
    }

    /// Returns the number of steps of all runs, assuming 1,000 per evaluation episode.
    pub fn total_steps(&self) -> u64 {
        let runs = (self.configs.len() * self.ages.len() * self.policies.len()) as u64;
        let steps = self.steps.saturating_add(self.evaluate.saturating_mul(1000));
        runs.saturating_mul(self.seeds).saturating_mul(steps)
    }
}

/// A key with its values.
struct PlanEntry {
    key: String,
    values: Vec<String>,
    line: u32,
}

/// Reads a flat mapping of scalars and lists of scalars.
fn entries(text: &str) -> Result<Vec<PlanEntry>, (u32, String)> {
    let mut options = Options::default();
    options.set_emit_comments(false);
    let mut found: Vec<PlanEntry> = Vec::new();
    let (mut key, mut list, mut inside) = (None::<(String, u32)>, None::<Vec<String>>, false);
    for event in Parser::new_from_str_with_options(text, options) {
        let (event, span) = event.map_err(|error| {
            let line = u32::try_from(error.marker().line()).unwrap_or(u32::MAX);
            (line, format!("not valid YAML: {}", quoted(&error.info())))
        })?;
        let line = u32::try_from(span.start.line()).unwrap_or(u32::MAX);
        let fault = |what: &str| {
            Err((
                line,
                format!("a plan has keys with values and lists of values; it has no {what}"),
            ))
        };
        match event {
            Event::StreamStart | Event::StreamEnd | Event::DocumentStart(..) | Event::DocumentEnd => {}
            Event::MappingStart(..) if !inside && found.is_empty() => inside = true,
            Event::MappingEnd => inside = false,
            Event::SequenceStart(..) if inside && key.is_some() && list.is_none() => list = Some(Vec::new()),
            Event::SequenceEnd => {
                if let (Some(values), Some((key, line))) = (list.take(), key.take()) {
                    found.push(PlanEntry { key, values, line });
                }
            }
            Event::Scalar(value, ..) if inside => match (&mut list, &key) {
                (Some(list), _) if list.len() >= MAX_ENTRIES => {
                    return Err((line, format!("a list has at most {MAX_ENTRIES} entries")));
                }
                (Some(list), _) => list.push(value.into_owned()),
                (None, Some(_)) => {
                    if let Some((key, line)) = key.take() {
                        let values = vec![value.into_owned()];
                        found.push(PlanEntry { key, values, line });
                    }
                }
                (None, None) if found.iter().any(|entry| entry.key == *value) => {
                    return Err((line, format!("the key `{}` appears twice", quoted(&value))));
                }
                (None, None) => key = Some((value.into_owned(), line)),
            },
            Event::Scalar(..) => return fault("single values"),
            Event::Alias(_) => return fault("aliases"),
            Event::SequenceStart(..) => return fault("lists in lists"),
            _ => return fault("mappings in mappings"),
        }
    }
    Ok(found)
}

/// Returns the single value of a key.
fn single<'v>(key: &str, values: &'v [String]) -> Result<&'v str, String> {
    match values {
        [value] => Ok(value),
        _ => Err(format!("`{key}` has one value")),
    }
}

/// Reads a whole number.
fn whole(key: &str, values: &[String], least: u64, most: u64) -> Result<u64, String> {
    let text = single(key, values)?;
    let number = text.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| {
        format!(
            "`{key}` is {:?}; expected a whole number from {least} to {most}",
            quoted(text)
        )
    })
}

/// Reads an age.
fn age(text: &str) -> Result<Option<f64>, String> {
    if text.eq_ignore_ascii_case("none") {
        return Ok(None);
    }
    let age = text.parse().ok().filter(|age| (0.0..=MAX_AGE).contains(age));
    age.map(Some).ok_or_else(|| {
        format!(
            "{:?} is not an age: expected none, or months from 0 to {MAX_AGE}",
            quoted(text)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_are_flat() {
        let text = "name: A\nconfigs: [a.yml, 'b.yml']\nages: [none, 3]\npolicies:\n  - held\n  - \"python3 p.py\"\nseeds: 2\nsteps: 10";
        let plan = BenchmarkPlan::parse(text, PathBuf::new()).expect("a plan");
        assert_eq!((plan.configs.len(), plan.seeds, plan.steps, plan.record), (2, 2, 10, 1));
        assert_eq!((plan.ages, plan.policies.len()), (vec![None, Some(3.0)], 2));
        for (text, line, part) in [
            ("", 1, "`configs` is empty or missing"),
            ("configs: [a]\npolices: [x]", 2, "unknown key `polices`"),
            ("configs: [a]\npolicies: [x]\nseeds: 0", 3, "from 1 to 1000"),
            ("configs: [a]\npolicies: [x]\nseeds: [1, 2]", 3, "one value"),
            ("configs: [a]\npolicies: [[x]]", 2, "lists in lists"),
            ("configs: {a: b}", 1, "mappings in mappings"),
            ("configs: [a]\nconfigs: [b]", 2, "twice"),
            ("configs: [a]\npolicies: [x]\nages: [25]", 3, "not an age"),
            ("configs: [a", 1, "not valid YAML"),
            ("- a", 1, "no lists in lists"),
        ] {
            let (found, reason) = BenchmarkPlan::parse(text, PathBuf::new()).expect_err(text);
            assert!(reason.contains(part), "{text}: {reason}");
            assert!(found >= line, "{text}: line {found}");
        }
    }
}

//! Results of a protocol: runs, means over seeds, comparisons, and their files.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::comparison::{Comparison, compare};
use super::job::{Job, Progress};
use super::rules::PhaseValues;
use super::{MeasureRule, Protocol, ProtocolError, ProtocolPlan};
use crate::config::Config;
use crate::eval::ConfidenceInterval;
use crate::eval::side_by_side::side_by_side;
use crate::files::replace_file;
use crate::json;

/// A run: an age, a policy and a seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ProtocolRun {
    /// Its name.
    pub name: String,
    /// CRC-32 of everything that decides the result, including the version of babybench.
    pub identity: u32,
    /// The age, months.
    pub age: f64,
    /// The policy.
    pub policy: String,
    /// The seed.
    pub seed: u64,
    /// The measures by condition, phase and name. Undefined ones are left out.
    pub values: BTreeMap<String, PhaseValues>,
}

impl ProtocolRun {
    /// Returns a measure.
    pub fn value(&self, condition: &str, phase: &str, measure: &str) -> Option<f64> {
        self.values.get(condition)?.get(phase)?.get(measure).copied()
    }
}

/// A row of the table: the runs of a policy at an age, in a condition and a phase.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct ProtocolRow {
    /// The policy.
    pub policy: String,
    /// The condition.
    pub condition: String,
    /// The phase.
    pub phase: String,
    /// The age, months; none for measures across ages.
    pub age: Option<f64>,
    /// The mean of each measure over seeds, by its name.
    pub metrics: BTreeMap<String, ConfidenceInterval>,
}

/// A protocol with its results.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ProtocolResult {
    /// The protocol.
    pub protocol: Protocol,
    /// The plan.
    pub plan: ProtocolPlan,
    /// The version of babybench.
    pub babybench: String,
    /// The commit that it was built from, if the build named it (the variable `BABYBENCH_COMMIT`).
    pub commit: Option<String>,
    /// Published numbers with ours beside them.
    pub comparisons: Vec<Comparison>,
    /// Means over seeds.
    pub rows: Vec<ProtocolRow>,
    /// Every run.
    pub runs: Vec<ProtocolRun>,
}

/// What made the results, and the checksums of their files: `manifest.json`.
#[derive(Debug, Serialize)]
struct ProtocolManifest<'r> {
    format: &'static str,
    version: u32,
    babybench: &'r str,
    commit: Option<&'r str>,
    platform: String,
    protocol: &'r str,
    /// CRC-32 of the protocol's document.
    document: u32,
    plan: &'r ProtocolPlan,
    ages: &'r [f64],
    /// The configuration of each condition at the youngest age of the run.
    configurations: BTreeMap<&'r str, Config>,
    /// CRC-32 of each file.
    files: BTreeMap<&'static str, u32>,
}

impl Protocol {
    /// Runs a plan into a folder, `jobs` runs at a time. Finished runs in the folder are not repeated. `progress` is called after every step
    /// and can stop the protocol. The results are the same for any number of jobs.
    ///
    /// The folder gets `runs/NAME.json` for each run, and with [`ProtocolPlan::keep_records`] `records/NAME/CONDITION`; see
    /// [`ProtocolResult::write`] for the other files.
    ///
    /// # Errors
    /// The first that occurs: an invalid plan or configuration, or an error of an environment, a policy or the file system.
    pub fn run(
        &self,
        plan: &ProtocolPlan,
        dir: &Path,
        jobs: usize,
        progress: Progress<'_>,
    ) -> Result<ProtocolResult, ProtocolError> {
        plan.check()?;
        // before anything is written
        plan.total_steps(self)?;
        for folder in ["runs", "records"].map(|name| dir.join(name)) {
            std::fs::create_dir_all(&folder).map_err(|source| ProtocolError::Io { path: folder, source })?;
        }
        let all = Job::all(self, plan);
        let (runs, ended) = side_by_side(&all, jobs, |job| job.run_or_read(dir, progress));
        if !plan.keep_records {
            // an empty folder; records of an earlier run stay
            let _ = std::fs::remove_dir(dir.join("records"));
        }
        match ended {
            Err(ProtocolError::Stopped { .. }) => {
                let (done, planned) = (runs.len(), all.len());
                return Err(ProtocolError::Stopped { done, planned });
            }
            other => other?,
        }
        let rows = rows(self, &runs);
        Ok(ProtocolResult {
            comparisons: compare(self, plan, &rows, &runs),
            protocol: self.clone(),
            plan: plan.clone(),
            babybench: env!("CARGO_PKG_VERSION").to_string(),
            commit: option_env!("BABYBENCH_COMMIT").map(str::to_string),
            rows,
            runs,
        })
    }
}

impl ProtocolResult {
    /// Returns everything as JSON.
    pub fn to_json(&self) -> String {
        json::text(self)
    }

    /// Writes `protocol.md`, `protocol.json`, `figure.svg` and `manifest.json` into a folder. They have no dates: the same runs give the same
    /// bytes.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn write(&self, dir: &Path) -> Result<(), ProtocolError> {
        let mut files = BTreeMap::new();
        for (name, text) in [
            ("protocol.md", self.to_markdown()),
            ("protocol.json", self.to_json() + "\n"),
            ("figure.svg", self.to_svg()),
        ] {
            files.insert(name, crc32fast::hash(text.as_bytes()));
            save(dir, name, &text)?;
        }
        let text = json::text(&self.manifest(files)?) + "\n";
        save(dir, "manifest.json", &text)
    }

    fn manifest(&self, files: BTreeMap<&'static str, u32>) -> Result<ProtocolManifest<'_>, ProtocolError> {
        let ages = self.plan.ages(&self.protocol);
        let mut configurations = BTreeMap::new();
        for condition in &self.protocol.conditions {
            let config = self
                .protocol
                .configured(condition, &self.plan.keys, ages.first().copied())?;
            configurations.insert(condition.name.as_str(), config);
        }
        Ok(ProtocolManifest {
            format: "babybench protocol",
            version: 1,
            babybench: &self.babybench,
            commit: self.commit.as_deref(),
            platform: format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
            protocol: &self.protocol.name,
            document: crc32fast::hash(self.protocol.text.as_bytes()),
            plan: &self.plan,
            ages,
            configurations,
            files,
        })
    }

    /// Returns the rows of a condition and a phase, measures across ages last.
    pub(super) fn rows_of<'r>(&'r self, condition: &'r str, phase: &'r str) -> impl Iterator<Item = &'r ProtocolRow> {
        let of = move |row: &&ProtocolRow| row.condition == condition && row.phase == phase;
        self.rows.iter().filter(of)
    }
}

fn save(dir: &Path, name: &str, text: &str) -> Result<(), ProtocolError> {
    let path = dir.join(name);
    replace_file(&path, text.as_bytes()).map_err(|source| ProtocolError::Io { path, source })
}

/// Computes means over seeds.
fn rows(protocol: &Protocol, runs: &[ProtocolRun]) -> Vec<ProtocolRow> {
    let mut out = Vec::new();
    for policy in runs.chunk_by(|a, b| a.policy == b.policy) {
        let Some(first) = policy.first() else {
            continue;
        };
        for condition in &protocol.conditions {
            for (k, phase) in protocol.phases.iter().enumerate() {
                let row = |age, metrics| ProtocolRow {
                    policy: first.policy.clone(),
                    condition: condition.name.clone(),
                    phase: phase.name.clone(),
                    age,
                    metrics,
                };
                for age in policy.chunk_by(|a, b| a.age == b.age) {
                    let mut metrics = BTreeMap::new();
                    for measure in &protocol.measures {
                        let value = |run: &ProtocolRun| run.value(&condition.name, &phase.name, &measure.name);
                        let values: Vec<f64> = age.iter().filter_map(value).collect();
                        let interval = ConfidenceInterval::of(&values);
                        metrics.extend(interval.map(|interval| (measure.name.clone(), interval)));
                    }
                    out.push(row(age.first().map(|run| run.age), metrics));
                }
                let across = across_ages(protocol, policy, &condition.name, &phase.name);
                // of protocols with several phases the first one counts
                if k == 0 && !across.is_empty() {
                    out.push(row(None, across));
                }
            }
        }
    }
    out
}

/// Computes the measures across ages: each for every seed, then the mean over seeds that have one.
fn across_ages(
    protocol: &Protocol,
    runs: &[ProtocolRun],
    condition: &str,
    phase: &str,
) -> BTreeMap<String, ConfidenceInterval> {
    let mut seeds: Vec<u64> = runs.iter().map(|run| run.seed).collect();
    seeds.sort_unstable();
    seeds.dedup();
    let mut out = BTreeMap::new();
    for measure in &protocol.measures {
        let MeasureRule::Age { of, level, falls } = &measure.rule else {
            continue;
        };
        let crossed = |seed: &u64| {
            let of_seed = runs.iter().filter(|run| run.seed == *seed);
            let mut points: Vec<[f64; 2]> = of_seed
                .filter_map(|run| Some([run.age, run.value(condition, phase, of)?]))
                .collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            crossing(&points, *level, *falls)
        };
        let values: Vec<f64> = seeds.iter().filter_map(crossed).collect();
        let interval = ConfidenceInterval::of(&values);
        out.extend(interval.map(|interval| (measure.name.clone(), interval)));
    }
    out
}

/// Returns where points (x, y), by x, first cross a level in a direction, linear between them; `None` if they do not.
fn crossing(points: &[[f64; 2]], level: f64, falls: bool) -> Option<f64> {
    points.windows(2).find_map(|pair| {
        let [[x0, y0], [x1, y1]] = [pair[0], pair[1]];
        let crossed = if falls {
            y0 > level && y1 <= level
        } else {
            y0 < level && y1 >= level
        };
        crossed.then(|| x0 + (x1 - x0) * (level - y0) / (y1 - y0))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_crossed_between_ages() {
        let points = [[0.0, 50.0], [2.0, 40.0], [4.0, 0.0], [6.0, 30.0]];
        assert_eq!(crossing(&points, 20.0, true), Some(3.0));
        assert_eq!(crossing(&points, 20.0, false), Some(4.0 + 2.0 * 20.0 / 30.0));
        assert_eq!(crossing(&points, 60.0, true), None, "below from the start");
        assert_eq!(crossing(&points[..1], 20.0, true), None);
    }
}

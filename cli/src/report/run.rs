//! The contents of a run's folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::ReportError;
use babybench::config::{Behavior, Compat, Config, Scene};
use babybench::env::Info;
use babybench::eval::{Score, TouchableGeoms};
use babybench::mimo::{build_model, embedded};
use babybench::model::Model;
use babybench::runs::logs::{EvaluationLog, evaluation_path, read_training, training_path};
use babybench::runs::{read_scene, scene_config};

/// Maximum number of evaluation episodes that are read.
const MAX_EVALUATIONS: usize = 100;

/// An evaluation episode.
pub(super) struct EvaluationEpisode {
    pub episode: u64,
    pub log: EvaluationLog,
    /// The video, if there is one.
    pub video: Option<PathBuf>,
}

/// A baseline to compare with.
pub(super) struct Baseline {
    /// Name of its folder.
    pub name: String,
    /// The records that count.
    pub records: Vec<Info>,
}

/// A run.
pub(super) struct RunContents {
    pub dir: PathBuf,
    pub behavior: Behavior,
    /// The name of a user-defined task.
    pub task: Option<String>,
    pub config: Option<Config>,
    /// The scene of the run, or one with the same MIMo if that does not load here.
    pub model: Option<Model>,
    pub touchables: Option<TouchableGeoms>,
    pub training: Vec<Info>,
    pub score: Option<Score>,
    pub evaluations: Vec<EvaluationEpisode>,
    pub notices: Vec<String>,
    pub baseline: Option<Baseline>,
}

impl RunContents {
    /// Reads as much of a run's folder as possible; missing or damaged parts become notices.
    pub fn read(dir: &Path) -> Result<Self, ReportError> {
        let path = || dir.to_path_buf();
        if !dir.is_dir() {
            return Err(ReportError::Missing { path: path() });
        }
        let episodes = episodes(dir)?;
        if episodes.is_empty() && !training_path(dir).exists() {
            return Err(ReportError::NoRun { path: path() });
        }
        let (mut failures, mut notices) = (Vec::new(), Vec::new());
        let training = training(dir, &mut failures, &mut notices);
        let evaluations = evaluations(dir, &episodes, &mut failures);
        if episodes.is_empty() {
            notices.push("No evaluation yet; babybench evaluate makes one.".to_string());
        }
        if episodes.len() > MAX_EVALUATIONS {
            let all = episodes.len();
            notices.push(format!(
                "Only the first {MAX_EVALUATIONS} of {all} evaluation episodes are shown."
            ));
        }
        let records = || {
            training
                .iter()
                .chain(evaluations.iter().filter_map(|e| e.log.info.last()))
        };
        let found = records().next().map(|r| r.behavior.name().to_string());
        if found.is_none() && !failures.is_empty() {
            let reasons = failures.join("; ");
            return Err(ReportError::Unreadable { path: path(), reasons });
        }
        notices.splice(0..0, failures);
        let config = scene_config(dir);
        let of_config = config.as_ref().map(|c| c.behavior);
        let known = found.as_deref().and_then(Behavior::from_name);
        let task = found.filter(|_| known.is_none());
        let behavior = known.or(of_config).unwrap_or_default();
        let nq = evaluations.first().map(|e| e.log.nq);
        let (model, own) = scene(dir, behavior, nq, &mut notices);
        let touchables = model.as_ref().and_then(TouchableGeoms::new);
        // the parts of a likely scene need not be those of the run
        let skin = touchables.as_ref().filter(|_| own);
        let compat = config.as_ref().map_or(Compat::Api, |c| c.compat);
        let score = score(&training, compat, skin, &mut notices);
        Ok(Self {
            dir: dir.to_path_buf(),
            behavior,
            task,
            touchables,
            config,
            model,
            training,
            score,
            evaluations,
            notices,
            baseline: None,
        })
    }

    /// Reads the training to compare with from its folder.
    pub fn compare(&mut self, dir: &Path) -> Result<(), ReportError> {
        let refused = |reason: String| ReportError::Baseline {
            path: dir.to_path_buf(),
            reason,
        };
        let records = read_training(dir).map_err(|e| refused(e.to_string()))?;
        let other = records.first().map(|r| r.behavior.name());
        let own = self.task.as_deref().unwrap_or(self.behavior.name());
        if let Some(other) = other.filter(|&other| other != own) {
            return Err(refused(format!("its behavior is {other}")));
        }
        let compat = scene_config(dir).map_or(Compat::Api, |c| c.compat);
        let records = Score::counted(&records, compat).to_vec();
        if records.is_empty() {
            return Err(refused("its training log has no episodes".to_string()));
        }
        let name = dir.file_name().unwrap_or(dir.as_os_str());
        let name = name.to_string_lossy().into_owned();
        self.baseline = Some(Baseline { name, records });
        Ok(())
    }

    /// Returns whether the run follows the API page or the Python code where they disagree.
    pub fn compat(&self) -> Compat {
        self.config.as_ref().map_or(Compat::Api, |config| config.compat)
    }

    /// Returns the records that count for the score.
    pub fn counted(&self) -> &[Info] {
        Score::counted(&self.training, self.compat())
    }

    /// Returns the parts that each hand touched, each with the share of episodes in which it did: in training, or,
    /// without that, in the evaluation.
    pub fn touched(&self) -> [Vec<(usize, f64)>; 2] {
        let last: Vec<&Info> = match self.counted() {
            [] => self.evaluations.iter().filter_map(|e| e.log.info.last()).collect(),
            records => records.iter().collect(),
        };
        [0, 1].map(|hand| {
            let mut number: BTreeMap<usize, f64> = BTreeMap::new();
            for &geom in last.iter().filter_map(|r| r.behavior.touches()).flat_map(|t| t[hand]) {
                *number.entry(geom).or_default() += 1.0;
            }
            let share = |(geom, n)| (geom, n / last.len() as f64);
            let mut parts: Vec<(usize, f64)> = number.into_iter().map(share).collect();
            parts.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            parts
        })
    }
}

/// Returns the score of a training, unless it is of a task, which has none. `skin` has the parts that the hands can reach.
fn score(training: &[Info], compat: Compat, skin: Option<&TouchableGeoms>, notices: &mut Vec<String>) -> Option<Score> {
    if training.is_empty() || training.iter().any(|r| r.behavior.task().is_some()) {
        return None;
    }
    let score = Score::new(training, compat).map_err(|e| notices.push(e.to_string()));
    let score = score.ok()?;
    Some(match skin {
        Some(skin) => score.within_reach(skin),
        None => score,
    })
}

/// Reads the training log, if there is one.
fn training(dir: &Path, failures: &mut Vec<String>, notices: &mut Vec<String>) -> Vec<Info> {
    if !training_path(dir).exists() {
        notices.push("No training log yet; babybench train writes one.".to_string());
        return Vec::new();
    }
    match read_training(dir) {
        Ok(records) => {
            if records.is_empty() {
                notices.push("The training log has no episodes yet.".to_string());
            }
            records
        }
        Err(e) => {
            failures.push(e.to_string());
            Vec::new()
        }
    }
}

/// Reads the scene of the run, or builds a likely one if that does not load here; returns whether it is the run's own.
fn scene(dir: &Path, behavior: Behavior, nq: Option<usize>, notices: &mut Vec<String>) -> (Option<Model>, bool) {
    match read_scene(dir) {
        Ok(model) => (Some(model), true),
        Err(e) => {
            if dir.join("scene.xml").exists() {
                let why = format!("Names come from a built-in scene, because the run's cannot be loaded: {e}");
                notices.push(why);
            }
            (likely_scene(behavior, nq), false)
        }
    }
}

/// Builds a scene with the MIMo of a behavior, and with `nq` positions if they are known.
fn likely_scene(behavior: Behavior, nq: Option<usize>) -> Option<Model> {
    let build = |scene: &Scene| {
        let config = Config {
            behavior,
            scene: scene.clone(),
            ..Config::default()
        };
        build_model(&config, &embedded()).ok()
    };
    let mut models = Scene::BABYBENCH.iter().filter_map(build);
    models.find(|m| nq.is_none_or(|nq| nq == m.nq))
}

/// Returns the numbers of the evaluation episodes in a folder, ascending.
fn episodes(dir: &Path) -> Result<Vec<u64>, ReportError> {
    let path = dir.join("logs");
    let entries = match std::fs::read_dir(&path) {
        Ok(entries) => entries,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(source) => return Err(ReportError::Io { path, source }),
    };
    let number = |name: std::ffi::OsString| -> Option<u64> {
        let name = name.into_string().ok()?;
        let number = name.strip_prefix("evaluation_")?.strip_suffix(".pkl")?;
        number.parse().ok()
    };
    let mut found: Vec<u64> = entries.flatten().filter_map(|e| number(e.file_name())).collect();
    found.sort_unstable();
    Ok(found)
}

fn evaluations(dir: &Path, episodes: &[u64], failures: &mut Vec<String>) -> Vec<EvaluationEpisode> {
    let mut out = Vec::new();
    for &episode in episodes.iter().take(MAX_EVALUATIONS) {
        match EvaluationLog::read(evaluation_path(dir, episode)) {
            Ok(log) if log.is_empty() => {}
            Ok(log) => {
                let video = dir.join("videos").join(format!("evaluation_{episode}.avi"));
                let video = video.is_file().then_some(video);
                out.push(EvaluationEpisode { episode, log, video });
            }
            Err(e) => failures.push(e.to_string()),
        }
    }
    out
}

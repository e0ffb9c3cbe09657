//! Trials of a condition: a policy acts in an environment, phase by phase.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::controls::{BoundControl, missing};
use super::fixture::Holder;
use super::job::Progress;
use super::observed::observe;
use super::plan::TrialSteps;
use super::sample::Sample;
use super::{Condition, Protocol, Yoke};
use crate::env::{Env, EnvError};
use crate::eval::EpisodeError;
use crate::policy::Policy;
use crate::runs::{Record, RecordOptions, Recorder};

/// Position and velocity of joints in every step of a phase, over all trials, by joint and phase.
pub(super) type Track = BTreeMap<(String, String), Vec<[f64; 2]>>;

/// A joint whose motion is kept for a later condition.
struct Kept {
    phase: usize,
    key: (String, String),
    address: [usize; 2],
}

/// A joint that repeats a motion.
struct Repeated {
    phase: usize,
    address: [usize; 2],
    motion: Vec<[f64; 2]>,
    next: usize,
}

/// An environment in which a policy performs the trials of a condition.
pub(super) struct Performer<'p> {
    protocol: &'p Protocol,
    yoke: Option<&'p Yoke>,
    env: Env,
    policy: Box<dyn Policy>,
    controls: Vec<BoundControl>,
    action: Vec<f32>,
    records: PathBuf,
    recorder: Option<Recorder>,
    kept: Vec<Kept>,
    track: Track,
    repeated: Option<Repeated>,
    /// Samples without the measures of their records, which are in the same order.
    samples: Vec<Sample>,
    trial: u32,
    /// Steps since the start of the trial.
    steps: u64,
    /// Time at which the trial first was a success, s.
    success: Option<f64>,
}

/// Names an error of an environment.
fn failed(trial: u32) -> impl Fn(EnvError) -> EpisodeError {
    move |source| EpisodeError::Env {
        episode: u64::from(trial),
        source: Box::new(source),
    }
}

/// Finds a hinge or slide and returns its places in `qpos` and `qvel`.
fn address(env: &Env, joint: &str) -> Result<[usize; 2], EnvError> {
    let model = env.model();
    let found = model.joint(joint).ok_or_else(|| missing("joint", joint))?;
    let next = |list: &[usize], end: usize| list.get(found + 1).copied().unwrap_or(end);
    let (at, dof) = (model.jnt_qposadr[found], model.jnt_dofadr[found]);
    if next(&model.jnt_qposadr, model.nq) != at + 1 || next(&model.jnt_dofadr, model.nv) != dof + 1 {
        return Err(missing("hinge or slide joint", joint));
    }
    Ok([at, dof])
}

fn phase(protocol: &Protocol, name: &str) -> Option<usize> {
    protocol.phases.iter().position(|phase| phase.name == name)
}

/// Finds the joints whose motion later conditions repeat.
fn kept(protocol: &Protocol, condition: &Condition, env: &Env) -> Result<Vec<Kept>, EnvError> {
    let mut kept = Vec::new();
    for yoke in protocol.conditions.iter().filter_map(|other| other.yoke.as_ref()) {
        if let Some(phase) = phase(protocol, &yoke.phase).filter(|_| yoke.to == condition.name) {
            kept.push(Kept {
                phase,
                key: (yoke.joint.clone(), yoke.phase.clone()),
                address: address(env, &yoke.joint)?,
            });
        }
    }
    Ok(kept)
}

/// Finds the joint that repeats a motion, which [`Performer::follow`] sets.
fn repeated(protocol: &Protocol, condition: &Condition, env: &Env) -> Result<Option<Repeated>, EnvError> {
    let Some(yoke) = &condition.yoke else {
        return Ok(None);
    };
    let address = address(env, &yoke.joint)?;
    Ok(phase(protocol, &yoke.phase).map(|phase| Repeated {
        phase,
        address,
        motion: Vec::new(),
        next: 0,
    }))
}

impl<'p> Performer<'p> {
    /// Prepares the trials of a condition. Records go into the folder `records`.
    pub fn new(
        protocol: &'p Protocol,
        condition: &'p Condition,
        env: Env,
        policy: Box<dyn Policy>,
        records: &Path,
        name: &str,
    ) -> Result<Self, EpisodeError> {
        let bind = |control| BoundControl::of(&env, control).map_err(failed(0));
        let controls = condition.controls.iter().map(bind).collect::<Result<_, _>>()?;
        let recorder = match protocol.fixture {
            Some(_) => None,
            None => {
                let policy = name.to_string();
                let options = RecordOptions {
                    policy,
                    ..RecordOptions::default()
                };
                Some(Recorder::create(records, &env, options)?)
            }
        };
        Ok(Self {
            kept: kept(protocol, condition, &env).map_err(failed(0))?,
            repeated: repeated(protocol, condition, &env).map_err(failed(0))?,
            protocol,
            yoke: condition.yoke.as_ref(),
            env,
            policy,
            controls,
            action: Vec::new(),
            records: records.to_path_buf(),
            recorder,
            track: Track::new(),
            samples: Vec::new(),
            trial: 0,
            steps: 0,
            success: None,
        })
    }

    /// Takes the motion of the condition that this one is yoked to.
    pub fn follow(&mut self, tracks: &BTreeMap<String, Track>) {
        if let (Some(yoke), Some(repeated)) = (self.yoke, &mut self.repeated) {
            let key = (yoke.joint.clone(), yoke.phase.clone());
            let motion = tracks.get(&yoke.to).and_then(|track| track.get(&key));
            repeated.motion = motion.cloned().unwrap_or_default();
        }
    }

    /// Performs a trial. The first one begins with the seed.
    pub fn trial(
        &mut self,
        trial: u32,
        seed: u64,
        steps: &TrialSteps,
        progress: Progress<'_>,
    ) -> Result<(), EpisodeError> {
        (self.trial, self.steps, self.success) = (trial, 0, None);
        // one seed for the whole run
        self.env.reset((trial == 0).then_some(seed)).map_err(failed(trial))?;
        if self.protocol.fixture.is_some() {
            return self.held(steps, progress);
        }
        self.policy.begin(&mut self.env, u64::from(trial))?;
        for (phase, parts) in steps.iter().enumerate() {
            for &steps in parts {
                self.part(phase, steps, progress)?;
            }
        }
        Ok(())
    }

    /// Performs a trial in which a fixture holds MIMo.
    fn held(&mut self, steps: &TrialSteps, progress: Progress<'_>) -> Result<(), EpisodeError> {
        let Some(fixture) = &self.protocol.fixture else {
            return Ok(());
        };
        let failed = failed(self.trial);
        let mut holder = Holder::hold(fixture, &mut self.env).map_err(&failed)?;
        self.policy.begin(&mut self.env, u64::from(self.trial))?;
        let total: u64 = steps.iter().flatten().sum();
        let mut done = 0;
        while done < total && !self.env.over() {
            holder.before(&mut self.env, done, total).map_err(&failed)?;
            self.step(progress)?;
            holder.after(&self.env, done, total);
            done += 1;
        }
        self.samples.push(Sample {
            trial: self.trial,
            seconds: done as f64 * self.env.blueprint().dt(),
            ..holder.end()
        });
        Ok(())
    }

    /// Performs a part of a phase as an episode of the record.
    fn part(&mut self, phase: usize, steps: u64, progress: Progress<'_>) -> Result<(), EpisodeError> {
        if self.env.over() {
            return Ok(());
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.begin(&self.env, self.samples.len() as u64);
        }
        let before = self.success;
        for _ in 0..steps {
            if self.env.over() {
                break;
            }
            self.repeat(phase);
            self.step(progress)?;
            self.keep(phase);
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.end(&self.env)?;
        }
        let mut sample = Sample {
            trial: self.trial,
            phase,
            ..Sample::default()
        };
        if self.env.info().behavior.task().is_some() {
            sample.put("success", f64::from(u8::from(self.success.is_some())));
            sample.put("success_time", self.success.filter(|_| before.is_none()));
        }
        self.samples.push(sample);
        Ok(())
    }

    /// Puts a joint where it was in the condition that this one is yoked to.
    fn repeat(&mut self, phase: usize) {
        let Some(repeated) = self.repeated.as_mut().filter(|repeated| repeated.phase == phase) else {
            return;
        };
        if let Some(&[position, velocity]) = repeated.motion.get(repeated.next) {
            let [at, dof] = repeated.address;
            let state = self.env.state_mut();
            (state.qpos[at], state.qvel[dof]) = (position, velocity);
            repeated.next += 1;
        }
    }

    /// Keeps the motion of joints that later conditions repeat.
    fn keep(&mut self, phase: usize) {
        for kept in self.kept.iter().filter(|kept| kept.phase == phase) {
            let ([at, dof], state) = (kept.address, self.env.state());
            let now = [state.qpos[at], state.qvel[dof]];
            self.track.entry(kept.key.clone()).or_default().push(now);
        }
    }

    /// Performs a step.
    fn step(&mut self, progress: Progress<'_>) -> Result<(), EpisodeError> {
        let failed = failed(self.trial);
        self.policy.act(&mut self.env, &mut self.action)?;
        for control in &self.controls {
            control.apply(&self.env, &mut self.action);
        }
        match &mut self.recorder {
            Some(recorder) => recorder.step(&mut self.env, &self.action)?,
            None => {
                self.env.step(&self.action).map_err(&failed)?;
            }
        }
        self.steps += 1;
        let task = self.env.info().behavior.task();
        if self.success.is_none() && task.is_some_and(|task| task.outcome.is_success) {
            self.success = Some(self.steps as f64 * self.env.blueprint().dt());
        }
        if progress().is_break() {
            let (done, planned) = (0, 0);
            return Err(EpisodeError::Stopped { done, planned });
        }
        Ok(())
    }

    /// Measures the records, and returns all samples with the motions that were kept.
    pub fn end(mut self) -> Result<(Vec<Sample>, Track), EpisodeError> {
        if self.recorder.take().is_some() {
            let record = Record::open(&self.records)?;
            for (episode, sample) in self.samples.iter_mut().enumerate() {
                observe(&record, episode as u64, &self.protocol.camera, sample)?;
            }
        }
        Ok((self.samples, self.track))
    }
}

//! Steps and resets of environments that share memory for computed quantities.

use std::ops::{Deref, DerefMut};

use super::physics::ScratchUse;
use super::{Env, EnvError};

/// Whether steps and resets check [`Task::only_moves`](crate::env::Task::only_moves).
const CHECKED: bool = cfg!(any(test, debug_assertions));

/// An environment that works in a scratch state, if it shares memory, until this guard is dropped.
pub(crate) struct Workspace<'a> {
    env: &'a mut Env,
}

impl Deref for Workspace<'_> {
    type Target = Env;

    fn deref(&self) -> &Env {
        self.env
    }
}

impl DerefMut for Workspace<'_> {
    fn deref_mut(&mut self) -> &mut Env {
        self.env
    }
}

impl Drop for Workspace<'_> {
    fn drop(&mut self) {
        self.env.physics.end();
    }
}

impl Env {
    /// From now on, steps and resets in a [`Workspace`] share scratch states, if the task allows it. Call it for a new environment.
    pub(crate) fn share(&mut self) {
        if self.task.only_moves() {
            self.physics.share();
        }
    }

    /// Returns whether steps and resets share scratch states.
    pub(crate) fn shares(&self) -> bool {
        self.physics.shares()
    }

    /// Begins a step or reset in a scratch state, if the environment shares memory.
    pub(crate) fn work(&mut self, work: ScratchUse) -> Workspace<'_> {
        self.physics.begin(work);
        Workspace { env: self }
    }

    /// Returns a copy for [`Env::check_reset`] before a reset in a scratch state, in tests and debug builds.
    pub(crate) fn before_reset(&self) -> Option<Self> {
        (CHECKED && self.shares()).then(|| self.clone())
    }

    /// Resets a copy that keeps its whole state, and checks that it equals the environment after its reset in a scratch state. The task then read no
    /// computed quantity before the first call of the engine.
    ///
    /// # Errors
    /// [`EnvError::OnlyMoves`].
    pub(crate) fn check_reset(&self, copy: Option<Self>, seed: Option<u64>) -> Result<(), EnvError> {
        let Some(mut copy) = copy else { return Ok(()) };
        if copy.reset(seed).is_ok() && copy.snapshot() != self.snapshot() {
            return Err(self.moves_more("the start of an episode"));
        }
        Ok(())
    }

    /// Checks, in tests and debug builds, that what a step or reset computed in a scratch state can be recomputed. Steps are checked less
    /// and less often, because a check takes as long as a physics step.
    pub(super) fn check_shared(&self) -> Result<(), EnvError> {
        let steps = self.episode.steps;
        let due = steps == 0 || steps.is_power_of_two();
        if CHECKED
            && due
            && let Some(what) = self.physics.unshareable()
        {
            return Err(self.moves_more(what));
        }
        Ok(())
    }

    fn moves_more(&self, what: &'static str) -> EnvError {
        EnvError::OnlyMoves {
            task: self.task.name().to_string(),
            what,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::config::Behavior;
    use crate::env::{BlueprintOptions, EnvError, Task, TaskScene};
    use crate::vector::VectorError;
    use crate::{Blueprint, Config, VectorEnv, VectorOptions};

    fn quick(config: Config) -> Config {
        Config {
            touch_scale: 4.0,
            vision_active: false,
            max_episode_steps: 5,
            ..config
        }
    }

    /// Runs two episodes of a few environments on one thread.
    fn run(blueprint: &Blueprint) -> Result<(), String> {
        let text = |error: VectorError| error.to_string();
        let mut envs = VectorEnv::new(blueprint, 3, VectorOptions::default()).map_err(text)?;
        let mut actions = Vec::new();
        envs.reset(3).map_err(text)?;
        for _ in 0..9 {
            envs.sample_actions(&mut actions).map_err(text)?;
            let batch = envs.step(&actions).map_err(text)?;
            if let Some(failure) = batch.failures.first() {
                return Err(failure.error.to_string());
            }
        }
        Ok(())
    }

    fn error_of(task: impl Task + 'static) -> String {
        let options = BlueprintOptions::default().with_task(task);
        let blueprint = Blueprint::with(quick(Config::default()), options).expect("embedded assets");
        run(&blueprint).expect_err("the task does more")
    }

    #[test]
    fn built_in_tasks_keep_their_promise() {
        for &behavior in Behavior::ALL {
            let blueprint = Blueprint::new(quick(Config::of(behavior))).expect("embedded assets");
            run(&blueprint).expect("it only moves things");
        }
    }

    /// Pushes the hip after the physics.
    #[derive(Clone, Debug)]
    struct PushTask;

    impl Task for PushTask {
        fn name(&self) -> &str {
            "push"
        }

        fn only_moves(&self) -> bool {
            true
        }

        fn after_step(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
            scene.state.xfrc_applied[1][2] += 1.0;
            Ok(())
        }
    }

    #[test]
    fn a_task_that_changes_forces_after_the_physics_is_found_out() {
        let error = error_of(PushTask);
        assert!(error.contains("\"push\"") && error.contains("qfrc_smooth"), "{error}");
    }

    /// Begins an episode at the height where the last one ended.
    #[derive(Clone, Debug)]
    struct HeightTask;

    impl Task for HeightTask {
        fn name(&self) -> &str {
            "go_on"
        }

        fn only_moves(&self) -> bool {
            true
        }

        fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
            let height = scene.state.xpos[10][2];
            scene.restart()?;
            scene.state.qpos[7] += 0.01 * height;
            scene.forward()
        }
    }

    #[test]
    fn a_task_that_reads_poses_of_the_last_episode_is_found_out() {
        let error = error_of(HeightTask);
        assert!(
            error.contains("\"go_on\"") && error.contains("start of an episode"),
            "{error}"
        );
    }
}

//! A user-defined task: MIMo lies on the floor and lifts his right hand to a height of 30 cm or more, a different one in each episode.

use babybench::env::{BlueprintOptions, Goal, StepReward, Task, TaskScene, TaskSizes, TaskView};
use babybench::{Blueprint, Config, EnvError, Model};

#[derive(Clone, Debug, Default)]
struct Lift {
    hand: usize,
}

impl Task for Lift {
    fn name(&self) -> &str {
        "lift"
    }

    fn bind(&mut self, _config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        self.hand = model.body("right_hand").ok_or(EnvError::Missing {
            what: "body",
            name: "right_hand".to_string(),
            purpose: "the task lift",
        })?;
        Ok(TaskSizes {
            goal: 1,
            ..TaskSizes::default()
        })
    }

    fn begin(&mut self, scene: &mut TaskScene<'_>, desired: &mut [f64]) {
        desired.fill(scene.rng.uniform_in(0.3, 0.35));
    }

    fn achieve(&self, view: &TaskView<'_>, _desired: &[f64], achieved: &mut [f64], _terms: &mut [f64]) {
        achieved.fill(view.state.xpos[self.hand][2]);
    }

    fn judge(&self, goal: Goal<'_>) -> StepReward {
        StepReward {
            reward: -(goal.desired[0] - goal.achieved[0]).max(0.0),
            is_success: goal.achieved >= goal.desired,
            is_failure: false,
        }
    }
}

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    let config = Config {
        frame_skip: 4,
        touch_active: false,
        vision_active: false,
        ..Config::default()
    };
    let mut env = Blueprint::with(config, BlueprintOptions::default().with_task(Lift::default()))?.env()?;
    let arm: Vec<f32> = env
        .model()
        .actuator_name
        .iter()
        .map(|name| f32::from(u8::from(name.contains("right_shoulder"))))
        .collect();
    for episode in 0..3 {
        env.reset(Some(episode))?;
        while !env.last_step().over() {
            env.step(&arm)?;
        }
        println!("episode {episode}: {}", env.info().to_json());
    }
    Ok(())
}

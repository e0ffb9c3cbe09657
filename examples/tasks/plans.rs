//! Training plans: for each task the inputs of its policy, and the stages of its training.

use babybench::config::Behavior;
use babybench::sensors::ProprioceptionComponent;
use babybench::{Config, Env};

use crate::linear::{Design, Feature};

/// A stage of training: some weights are free, the others stay.
pub struct Stage {
    pub free: Vec<usize>,
    /// The number that is 1 in the desired goal; random by default.
    pub goal: Option<usize>,
    pub generations: usize,
    /// Candidates of a generation.
    pub size: usize,
    /// Episodes of each candidate.
    pub trials: usize,
    /// Spread of the first generation.
    pub spread: f64,
}

/// A policy to be learned.
pub struct Plan {
    pub design: Design,
    /// The initial weights.
    pub start: Vec<f64>,
    pub stages: Vec<Stage>,
    /// The cost per metre of the smallest distance in an episode without success.
    pub shaping: f64,
    fingers: Option<usize>,
}

/// The tasks, in the order of their training.
pub const TASKS: [Behavior; 5] = [
    Behavior::Reach,
    Behavior::SelfBody,
    Behavior::Standup,
    Behavior::RollOver,
    Behavior::Catch,
];

/// Returns the configuration in which a policy of a task is trained: the task's own, without senses that it does not use.
pub fn config(behavior: Behavior, age: Option<f64>) -> Config {
    let own = Config::of(behavior);
    let max_episode_steps = if behavior == Behavior::Reach {
        300
    } else {
        own.max_episode_steps
    };
    Config {
        age,
        max_episode_steps,
        ..own
    }
}

/// Indices of the numbers of an action and of its joint.
struct Drive {
    action: usize,
    angle: usize,
    velocity: usize,
}

impl Plan {
    /// Returns the plan of a task.
    pub fn of(behavior: Behavior, env: &Env) -> Result<Self, Box<dyn std::error::Error>> {
        let drives = drives(env)?;
        let mut plan = Self {
            design: Design::default(),
            start: Vec::new(),
            stages: Vec::new(),
            shaping: 0.0,
            fingers: None,
        };
        match behavior {
            Behavior::Reach => plan.reach(&drives),
            Behavior::SelfBody => plan.self_body(&drives, env)?,
            Behavior::Standup => plan.postures(&drives, &[], 250, 20, 1),
            Behavior::RollOver => plan.postures(&drives, &turned(), 150, 24, 1),
            Behavior::Catch => plan.postures(&drives, &[], 80, 16, 3),
            other => return Err(format!("{other} has no plan").into()),
        }
        Ok(plan)
    }

    /// Returns the remaining distance to the goal, m, if it counts.
    pub fn distance(&self, env: &Env) -> Option<f64> {
        let target = env.goal().desired.iter().position(|v| *v > 0.0)?;
        let xpos = &env.state().xpos;
        let (from, to) = (xpos[self.fingers?], xpos.get(target)?);
        let squares = from.iter().zip(to).map(|(a, b)| (a - b) * (a - b));
        Some(squares.sum::<f64>().sqrt())
    }

    fn all_free(&mut self, start: f64, generations: usize, size: usize, trials: usize, spread: f64) {
        self.start = vec![start; self.design.terms.len()];
        self.stages.push(Stage {
            free: (0..self.start.len()).collect(),
            goal: None,
            generations,
            size,
            trials,
            spread,
        });
    }

    /// Every torque depends on the way to the ball, and on the angles and the velocities of the arm.
    fn reach(&mut self, drives: &[Drive]) {
        let design = &mut self.design;
        design.feature(Feature::one());
        for axis in 0..3 {
            let parts = vec![("desired_goal", axis, 5.0), ("achieved_goal", axis, -5.0)];
            design.feature(Feature { offset: 0.0, parts });
        }
        for drive in drives {
            design.feature(Feature::of("observation", drive.angle, 1.0));
            design.feature(Feature::of("observation", drive.velocity, 0.1));
        }
        for drive in drives {
            for feature in 0..design.features.len() {
                design.term(drive.action, feature, 0.3);
            }
        }
        self.all_free(0.0, 120, 20, 4, 0.7);
    }

    /// For each goal a posture, to which the policy's own springs and dampers pull.
    fn self_body(&mut self, drives: &[Drive], env: &Env) -> Result<(), Box<dyn std::error::Error>> {
        self.shaping = 500.0;
        self.fingers = env.model().body("right_fingers");
        let design = &mut self.design;
        for drive in drives {
            let angle = design.feature(Feature::of("observation", drive.angle, 1.0));
            let velocity = design.feature(Feature::of("observation", drive.velocity, 0.1));
            design.term(drive.action, angle, 1.0);
            design.term(drive.action, velocity, 1.0);
            self.start.extend([-1.0, -1.0]);
        }
        let skin = env.senses().touch().ok_or("selfbody needs touch")?.layout().bodies();
        for body in skin.iter().map(|skin| skin.body) {
            let name = &env.model().body_name[body];
            if ["right_fingers", "left_lower_arm"].contains(&name.as_str()) {
                continue;
            }
            let goal = design.feature(Feature::of("desired_goal", body, 1.0));
            let first = design.terms.len();
            for drive in drives {
                design.term(drive.action, goal, 1.0);
                self.start.push(0.0);
            }
            self.stages.push(Stage {
                free: (first..design.terms.len()).collect(),
                goal: Some(body),
                generations: 30,
                size: 12,
                trials: 1,
                spread: 1.0,
            });
        }
        Ok(())
    }

    /// Every number of the action depends on its own joint and on the shared features.
    fn postures(&mut self, drives: &[Drive], common: &[Feature], generations: usize, size: usize, trials: usize) {
        let design = &mut self.design;
        let mut features = vec![design.feature(Feature::one())];
        features.extend(common.iter().map(|feature| design.feature(feature.clone())));
        for drive in drives {
            let angle = design.feature(Feature::of("observation", drive.angle, 1.0));
            let velocity = design.feature(Feature::of("observation", drive.velocity, 0.1));
            for &feature in features.iter().chain(&[angle, velocity]) {
                design.term(drive.action, feature, 0.3);
            }
        }
        self.all_free(0.0, generations, size, trials, 0.5);
    }
}

/// Returns how far he has turned, -1 to 1, and in which direction he feels his weight, m/s^2 times 0.1. The movement that brings him onto his side
/// does not bring him onto his belly.
fn turned() -> Vec<Feature> {
    let way = Feature {
        offset: -1.0,
        parts: vec![("achieved_goal", 0, 2.0)],
    };
    let weight = |axis| Feature::of("vestibular", axis, 0.1);
    vec![way, weight(0), weight(1), weight(2)]
}

/// Finds the joint of each number of an action; muscles have two blocks of numbers, one after the other.
fn drives(env: &Env) -> Result<Vec<Drive>, Box<dyn std::error::Error>> {
    let (model, actuators) = (env.model(), env.blueprint().actuation().actuators());
    let senses = env.senses().proprioception();
    let drive = |action: usize| {
        let joint = &model.jnt_name[model.actuator_trnid[actuators[action % actuators.len()]]];
        let place = |component| senses.find(model, component, joint).map(|range| range.start);
        let missing = || format!("{joint} is not felt");
        Ok(Drive {
            action,
            angle: place(ProprioceptionComponent::Angles).ok_or_else(missing)?,
            velocity: place(ProprioceptionComponent::Velocities).ok_or_else(missing)?,
        })
    };
    (0..env.action_space().len()).map(drive).collect()
}

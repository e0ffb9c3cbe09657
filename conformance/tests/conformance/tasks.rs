//! MIMo's tasks with goals: their compiled scenes, and replays of the kit's recordings of them.

use babybench::Blueprint;
use babybench::Env;
use babybench::config::{Behavior, Compat, Config};
use babybench::formats::npz::Npz;
use babybench::mimo::{build_model, embedded};
use babybench::runs::{EpisodeStart, Recording, Replay, replay};
use conformance::arrays::{actuators, looks, names, narrowed, physical};
use conformance::data;
use conformance::measure::{Summary, max_abs, only_print, pick, relative_to_change, rms, row};
use testkit::harness::Trial;
use testkit::{Rng, show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        scenes_of_tasks_compile_as_in_the_kit,
        tasks_one_step_from_every_recorded_state,
        tasks_open_loop_stay_near_the_recording,
        tasks_settle_and_reset_as_in_the_kit
    ]
}

const TASKS: [Behavior; 4] = [Behavior::Reach, Behavior::Standup, Behavior::SelfBody, Behavior::Catch];

/// Difference of compiled numbers that the order of sums explains.
const COMPILED: f64 = 1e-14;

/// All arrays of the four scenes, with names, lights, textures and materials.
fn scenes_of_tasks_compile_as_in_the_kit() {
    let mut wrong = Vec::new();
    for task in TASKS {
        let model = build_model(&Config::of(task), &embedded()).expect("the embedded assets load");
        let npz = data::npz(&format!("compiled_{task}.npz"));
        let (mut identical, mut near, mut worst) = (0, 0, 0.0_f64);
        for (name, ours) in [physical(&model), looks(&model), actuators(&model)].concat() {
            let kit = npz.get_f64(name).expect("recorded").data;
            let kit = narrowed(name, &kit);
            if ours.len() != kit.len() {
                wrong.push(format!(
                    "{task} {name}: {} values, the kit has {}",
                    ours.len(),
                    kit.len()
                ));
                continue;
            }
            let difference = max_abs(&ours, &kit);
            worst = worst.max(difference);
            match difference {
                0.0 => identical += 1,
                d if d <= COMPILED => near += 1,
                d => wrong.push(format!("{task} {name}: {d:e}")),
            }
        }
        for (kind, ours) in names(&model) {
            let bytes = npz.get_f64(&format!("{kind}_name")).expect("recorded").data;
            let kit = String::from_utf8(bytes.iter().map(|&b| b as u8).collect()).expect("names");
            if ours.join("\n") != kit {
                wrong.push(format!("{task}: names of {kind} differ"));
            }
        }
        show!("{task:9} {identical} arrays bit-identical, {near} others within {worst:.1e}");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A recording of a task.
struct Golden {
    name: String,
    npz: Npz,
    config: Config,
}

impl Golden {
    fn all() -> impl Iterator<Item = Self> {
        data::names("tasks", ".npz").into_iter().map(|name| {
            let task = name
                .split('_')
                .next()
                .and_then(Behavior::from_name)
                .expect("the name of a task");
            Self {
                npz: data::npz(&format!("tasks/{name}.npz")),
                config: Config {
                    compat: Compat::Reference,
                    ..Config::of(task)
                },
                name,
            }
        })
    }

    fn env(&self) -> Env {
        Blueprint::new(self.config.clone())
            .and_then(|b| b.env())
            .expect("the environment builds")
    }

    fn recording(&self, env: &Env) -> Recording {
        Recording::read(&self.npz, env).expect("the recording fits")
    }

    fn array(&self, name: &str) -> Vec<f64> {
        self.npz.get_f64(name).map(|a| a.data).unwrap_or_default()
    }
}

/// Velocities after single steps, relative to their largest change in the step.
fn qvel(env: &Env, recording: &Recording, ours: &Replay) -> Summary {
    let nv = env.model().nv;
    let starts = |t: usize| recording.episodes.iter().find(|start| start.row == t);
    let before = |t: usize| starts(t).map_or_else(|| row(&recording.qvel, t - 1, nv), |start| &start.qvel[..]);
    Summary::new(
        (0..ours.len).map(|t| relative_to_change(row(&ours.qvel, t, nv), row(&recording.qvel, t, nv), before(t))),
    )
}

/// Returns the largest difference relative to the size of the expected value, at least 1e-3.
fn relative_error(ours: &[f64], theirs: &[f64]) -> f64 {
    assert_eq!(ours.len(), theirs.len());
    let each = ours.iter().zip(theirs).map(|(a, b)| (a - b).abs() / b.abs().max(1e-3));
    each.fold(0.0, f64::max)
}

/// When written, the worst were: qvel 9.0e-12 (median), 1.2e-7 (90 %); rewards 4.9e-12, goals 8.9e-13; every termination and success
/// was that of the recording.
fn tasks_one_step_from_every_recorded_state() {
    let mut missed = Vec::new();
    for g in Golden::all() {
        let mut env = g.env();
        let recording = g.recording(&env);
        let ours = replay(&mut env, &recording, true).expect("the replay runs");
        let task = ours.task.as_ref().expect("a task has rewards");
        let flags = |flags: &[bool]| flags.iter().map(|f| f64::from(u8::from(*f))).collect::<Vec<f64>>();
        let successes: Vec<bool> = ours
            .info
            .iter()
            .map(|i| i.behavior.task().is_some_and(|t| t.outcome.is_success))
            .collect();
        let step = qvel(&env, &recording, &ours);
        let reward = relative_error(&task.reward, &g.array("reward"));
        let goals = relative_error(&task.achieved_goal, &g.array("achieved_goal"))
            .max(relative_error(&task.desired_goal, &g.array("desired_goal")));
        let terminated = max_abs(&flags(&task.terminated), &g.array("terminated"));
        let success = max_abs(&flags(&successes), &g.array("is_success"));
        show!(
            "{:16} qvel {step}   reward {reward:.1e}   goals {goals:.1e}   {} episodes, {} terminated",
            g.name,
            recording.episodes.len(),
            task.terminated.iter().filter(|t| **t).count()
        );
        let figures = [
            ("median of qvel", step.p50, 1e-10),
            ("90th percentile of qvel", step.p90, 1e-6),
            ("rewards", reward, 1e-6),
            ("goals", goals, 1e-6),
            ("termination", terminated, 0.0),
            ("success", success, 0.0),
        ];
        let over = figures.iter().filter(|(_, value, limit)| value > limit);
        missed.extend(over.map(|(what, value, limit)| format!("{}: {what} {value:e} > {limit:e}", g.name)));
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

/// Steps that the open loop is followed for.
const OPEN: usize = 100;
/// Distance of the starts of the floor, rad.
const NUDGE: f64 = 1e-7;

/// When written, the worst was 0.6 floors. The floor is how far the same replay gets from itself when it starts 1e-7 rad away in every
/// joint, mean of two.
fn tasks_open_loop_stay_near_the_recording() {
    let mut missed = Vec::new();
    for g in Golden::all() {
        let mut env = g.env();
        let mut recording = g.recording(&env);
        let first = recording
            .episodes
            .get(1)
            .map_or(recording.len, |next| next.row)
            .min(OPEN);
        recording.len = first;
        let nq = env.model().nq;
        let joints = env.senses().proprioception().joints().qpos.clone();
        let at = |table: &[f64]| pick(row(table, first - 1, nq), &joints);
        let ours = replay(&mut env, &recording, false).expect("the replay runs");
        let distance = rms(&at(&ours.qpos), &at(&recording.qpos));
        let mut rng = Rng::with_seed(1);
        let floor = (0..2).map(|_| {
            let mut nudged = recording.clone();
            for start in &mut nudged.episodes {
                for &q in &joints {
                    start.qpos[q] += if rng.bool() { NUDGE } else { -NUDGE };
                }
            }
            let other = replay(&mut env, &nudged, false).expect("the replay runs");
            rms(&at(&ours.qpos), &at(&other.qpos)) / 2.0
        });
        let floor: f64 = floor.sum();
        show!("{:16} {first:3} steps: {distance:.1e} rad, floor {floor:.1e}", g.name);
        if distance > 3.0 * floor {
            missed.push(format!(
                "{}: {distance:e} rad after {first} steps, floor {floor:e}",
                g.name
            ));
        }
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

/// The state that the kit's constructor leaves, from which episodes of `selfbody` start, and the resets of all tasks from the states
/// that they set, with the recorded draws.
fn tasks_settle_and_reset_as_in_the_kit() {
    let mut missed = Vec::new();
    for g in Golden::all() {
        let env = g.env();
        let starts: Vec<EpisodeStart> = g.recording(&env).episodes;
        if g.config.behavior == Behavior::SelfBody {
            let error = max_abs(env.blueprint().init_qpos(), &g.array("ctor_qpos"));
            show!("{:16} settled within {error:.1e}", g.name);
            if error > 1e-9 {
                missed.push(format!("{}: the settled state is {error:e} away", g.name));
            }
        }
        let set = g.array("reset_set_qpos");
        let (nq, joints) = (env.model().nq, env.senses().proprioception().joints().qpos.clone());
        for (e, start) in starts.iter().enumerate() {
            let error = match g.config.behavior {
                // what was drawn is in the state that is set; what follows is simulated
                Behavior::Standup => {
                    let mut env = g.env();
                    let still = vec![0.0; env.model().nv];
                    env.by_hand().reset_to(row(&set, e, nq), &still).expect("a state");
                    for _ in 0..100 {
                        env.by_hand().physics_step().expect("a step");
                    }
                    max_abs(&pick(&env.state().qpos, &joints), &pick(&start.qpos, &joints))
                }
                Behavior::SelfBody => max_abs(env.blueprint().init_qpos(), &start.qpos),
                _ => continue,
            };
            show!("{:16} episode {e} starts within {error:.1e}", g.name);
            if error > 1e-6 {
                missed.push(format!("{}: episode {e} starts {error:e} away", g.name));
            }
        }
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

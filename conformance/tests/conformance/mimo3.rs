//! MIMo 3: compiled scenes at all ages, and replays of recordings of its environments.

use babybench::config::{ActuationModel, Behavior, Compat, Config, TouchFunction, TouchResponse};
use babybench::env::{BlueprintOptions, Task, TaskDocument, TaskScene};
use babybench::formats::npz::Npz;
use babybench::mimo::{Version, body_kind};
use babybench::runs::{Recording, Replay, replay};
use babybench::{Blueprint, Env, EnvError, Model};
use conformance::data;
use conformance::measure::{Summary, max_abs, only_print, relative, relative_to_change, row};
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        mimo_3_has_the_originals_names,
        mimo_3_compiles_as_the_original_at_all_ages,
        mimo_3_one_step_from_every_recorded_state,
        mimo_3_feels_what_the_original_feels
    ]
}

/// The original's benchmark: MIMo over the floor, beside a box and a ball, without a goal.
#[derive(Clone, Debug)]
struct Bench(Version);

impl Task for Bench {
    fn name(&self) -> &str {
        "bench"
    }

    fn document(&self, _config: &Config) -> TaskDocument {
        let xml = data::text(&format!("mimo3/bench_{}.xml", self.0.name()));
        // every body feels, and so do the eyes
        let names = original_bodies(self.0);
        let spacing = names.into_iter().filter_map(|name| {
            let kind = body_kind(&name)?;
            Some((name, kind.touch_spacing))
        });
        TaskDocument {
            xml,
            version: self.0,
            touch_spacing: spacing.collect(),
        }
    }

    fn settle(&self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        scene.restart()
    }
}

/// Returns the names of the original's bodies.
fn original_bodies(version: Version) -> Vec<String> {
    let names = named(&data::npz("mimo3/compiled.npz"), &format!("{}|bodies", version.name()));
    names
        .lines()
        .map(str::to_string)
        .filter(|name| name != "mimo_location")
        .collect()
}

/// Builds an environment by the name of its data: `bench_v2`, `roll_over_1` (at the age of one month).
fn blueprint(name: &str, touch: bool) -> Blueprint {
    let (kind, age) = match name.rsplit_once('_') {
        Some((kind, age)) if age.parse::<f64>().is_ok() => (kind, age.parse().ok()),
        _ => (name, None),
    };
    let bench = match kind {
        "bench_v1" => Some(Version::V1),
        "bench_v2" | "muscle_v2" => Some(Version::V2),
        _ => None,
    };
    let common = match bench {
        Some(_) => Config {
            frame_skip: 2,
            vision_active: false,
            touch_active: touch,
            touch_function: TouchFunction::ForceVector,
            touch_response: TouchResponse::SpreadLinear,
            ..Config::default()
        },
        None => Config::of(Behavior::from_name(kind).expect("a task")),
    };
    let mut config = Config {
        mimo_version: 3,
        compat: Compat::Reference,
        age,
        ..common
    };
    if kind == "muscle_v2" {
        config.actuation_model = ActuationModel::Muscle;
    }
    let options = BlueprintOptions::default();
    let options = match bench {
        Some(version) => options.with_task(Bench(version)),
        None => options,
    };
    Blueprint::with(config, options).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn named(npz: &Npz, key: &str) -> String {
    let bytes = npz.get_f64(key).expect(key).data;
    String::from_utf8(bytes.iter().map(|&b| b as u8).collect()).expect("names")
}

fn mimo_3_has_the_originals_names() {
    let npz = data::npz("mimo3/compiled.npz");
    let mut wrong = Vec::new();
    for version in ["v1", "v2"] {
        let blueprint = blueprint(&format!("bench_{version}"), false);
        let model = blueprint.model();
        let kinds = [
            // the world is not among the original's
            ("bodies", model.body_name[1..].to_vec()),
            ("joints", model.jnt_name.clone()),
            ("geoms", model.geom_name.clone()),
            ("sites", model.site_name.clone()),
            ("actuators", model.actuator_name.clone()),
            ("sensors", model.sensor_name.clone()),
        ];
        for (kind, ours) in kinds {
            let theirs = named(&npz, &format!("{version}|{kind}"));
            show!("{version} {kind}: {}", ours.len());
            if ours.join("\n") != theirs {
                wrong.push(format!("{version} {kind}: {ours:?}\n{theirs:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Arrays that are recorded.
fn arrays(model: &Model) -> Vec<(&'static str, Vec<f64>)> {
    fn flat<const N: usize>(rows: &[[f64; N]]) -> Vec<f64> {
        rows.iter().flatten().copied().collect()
    }
    vec![
        ("body_pos", flat(&model.body_pos)),
        ("body_mass", model.body_mass.clone()),
        ("body_inertia", flat(&model.body_inertia)),
        ("body_ipos", flat(&model.body_ipos)),
        ("body_iquat", flat(&model.body_iquat)),
        ("body_invweight0", flat(&model.body_invweight0)),
        ("geom_size", flat(&model.geom_size)),
        ("geom_pos", flat(&model.geom_pos)),
        ("geom_rbound", model.geom_rbound.clone()),
        ("jnt_pos", flat(&model.jnt_pos)),
        ("site_pos", flat(&model.site_pos)),
        ("actuator_gear", model.actuator_gear.clone()),
        ("dof_M0", model.dof_m0.clone()),
        ("dof_invweight0", model.dof_invweight0.clone()),
        ("qpos0", model.qpos0.clone()),
    ]
}

/// Largest difference of compiled numbers, relative to the largest number of the array.
const COMPILED: f64 = 3e-14;

/// With an age, MIMo starts where his lowest point is that of the original proportions; the original does not move him.
fn mimo_3_compiles_as_the_original_at_all_ages() {
    let npz = data::npz("mimo3/compiled.npz");
    let mut keys: Vec<String> = npz.arrays().map(|array| array.name.clone()).collect();
    keys.retain(|key| key.ends_with("|body_pos"));
    keys.sort();
    let mut wrong = Vec::new();
    for key in keys {
        let key = key.strip_suffix("|body_pos").expect("its ending");
        let (name, age) = key.split_once('|').expect("name and age");
        let grown = age != "None";
        let full = if grown {
            format!("{name}_{age}")
        } else {
            name.to_string()
        };
        let blueprint = blueprint(&full, false);
        let model = blueprint.model();
        let place = model.body("mimo_location").expect("MIMo");
        let free = model.jnt_qposadr[model.body_jntadr[place]];
        let mut worst: f64 = 0.0;
        for (what, ours) in arrays(model) {
            let mut ours = ours;
            let theirs = npz.get_f64(&format!("{key}|{what}")).expect("recorded").data;
            if ours.len() != theirs.len() {
                wrong.push(format!("{full} {what}: {} numbers, not {}", ours.len(), theirs.len()));
                continue;
            }
            if grown && (what == "body_pos" || what == "body_ipos") {
                ours[3 * place + 2] = theirs[3 * place + 2];
            }
            if grown && what == "body_invweight0" {
                // of a body without mass, which depends on its place
                let own = 2 * place..2 * place + 2;
                ours[own.clone()].copy_from_slice(&theirs[own]);
            }
            if grown && what == "qpos0" {
                ours[free + 2] = theirs[free + 2];
            }
            let far = relative(&ours, &theirs);
            if far > COMPILED {
                let at = (0..ours.len())
                    .max_by(|&a, &b| (ours[a] - theirs[a]).abs().total_cmp(&(ours[b] - theirs[b]).abs()));
                let at = at.unwrap_or(0);
                wrong.push(format!("{full} {what}: {far:e} at {at}: {} {}", ours[at], theirs[at]));
            }
            worst = worst.max(far);
        }
        show!("{full:16} {worst:.1e}");
    }
    assert!(only_print() || wrong.is_empty(), "{}", wrong.join("\n"));
}

struct Episode {
    name: String,
    npz: Npz,
}

impl Episode {
    fn all() -> impl Iterator<Item = Self> {
        let names = data::names("mimo3", ".npz")
            .into_iter()
            .filter(|name| name != "compiled");
        names.map(|name| Self {
            npz: data::npz(&format!("mimo3/{name}.npz")),
            name,
        })
    }

    fn array(&self, name: &str) -> Vec<f64> {
        self.npz.get_f64(name).map(|a| a.data).unwrap_or_default()
    }

    fn replay(&self, touch: bool) -> (Env, Recording, Replay) {
        let mut env = blueprint(&self.name, touch).env().expect("the environment builds");
        let recording = Recording::read(&self.npz, &env).expect("the recording fits");
        let ours = replay(&mut env, &recording, true).expect("the replay runs");
        (env, recording, ours)
    }
}

/// Returns the largest difference relative to the size of the expected value, at least 1e-3.
fn relative_error(ours: &[f64], theirs: &[f64]) -> f64 {
    assert_eq!(ours.len(), theirs.len());
    let each = ours.iter().zip(theirs).map(|(a, b)| (a - b).abs() / b.abs().max(1e-3));
    each.fold(0.0, f64::max)
}

fn mimo_3_one_step_from_every_recorded_state() {
    let mut missed = Vec::new();
    for e in Episode::all() {
        let (env, recording, ours) = e.replay(false);
        let nv = env.model().nv;
        let before = |t: usize| {
            if t == 0 {
                &recording.qvel0[..]
            } else {
                row(&recording.qvel, t - 1, nv)
            }
        };
        let step = Summary::new(
            (0..ours.len).map(|t| relative_to_change(row(&ours.qvel, t, nv), row(&recording.qvel, t, nv), before(t))),
        );
        let nq = env.model().nq;
        let place = Summary::new((0..ours.len).map(|t| max_abs(row(&ours.qpos, t, nq), row(&recording.qpos, t, nq))));
        let mut figures = vec![
            ("90th percentile of qpos", place.p90, 1e-7),
            ("median of qvel", step.p50, 1e-10),
            ("90th percentile of qvel", step.p90, 1e-6),
        ];
        if let Some(task) = ours
            .task
            .as_ref()
            .filter(|_| !e.name.starts_with("bench") && !e.name.starts_with("muscle"))
        {
            let reward = relative_error(&task.reward, &e.array("reward"));
            let goals = max_abs(&task.achieved_goal, &e.array("achieved_goal"));
            let terminated: Vec<f64> = task.terminated.iter().map(|t| f64::from(u8::from(*t))).collect();
            figures.push(("rewards", reward, 1e-6));
            figures.push(("goals", goals, 1e-6));
            figures.push(("termination", max_abs(&terminated, &e.array("terminated")), 0.0));
        }
        let text: Vec<String> = figures
            .iter()
            .skip(3)
            .map(|(what, value, _)| format!("{what} {value:.1e}"))
            .collect();
        show!(
            "{:16} qvel {step}   qpos {:.1e}   {}",
            e.name,
            place.p90,
            text.join("   ")
        );
        let over = figures.iter().filter(|(_, value, limit)| value > limit);
        missed.extend(over.map(|(what, value, limit)| format!("{}: {what} {value:e} > {limit:e}", e.name)));
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

fn mimo_3_feels_what_the_original_feels() {
    let mut missed = Vec::new();
    for e in Episode::all() {
        let steps = e.array("touch_step");
        let size = e.array("touch_size");
        let Some(&size) = size.first() else { continue };
        let (_, _, ours) = e.replay(true);
        let Some(touch) = ours.touch else {
            missed.push(format!("{}: no touch", e.name));
            continue;
        };
        if touch.len as f64 != size {
            missed.push(format!("{}: {} numbers of touch, not {size}", e.name, touch.len));
            continue;
        }
        let (index, value) = (e.array("touch_index"), e.array("touch_value"));
        let (mut worst, mut compared) = (0.0_f64, 0);
        for t in 0..ours.len.min(20) {
            let mut dense = vec![0.0; size as usize];
            for k in touch.ptr[t] as usize..touch.ptr[t + 1] as usize {
                dense[touch.idx[k] as usize] = f64::from(touch.val[k]);
            }
            let mut theirs = vec![0.0; size as usize];
            for k in (0..steps.len()).filter(|&k| steps[k] as usize == t) {
                theirs[index[k] as usize] = value[k];
                compared += 1;
            }
            let scale = theirs.iter().fold(1e-3_f64, |a, b| a.max(b.abs()));
            worst = worst.max(max_abs(&dense, &theirs) / scale);
        }
        show!("{:16} {size} numbers, {compared} values within {worst:.1e}", e.name);
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

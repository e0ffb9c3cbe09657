//! Cost of pictures compared with MuJoCo's own renderer.

use std::path::Path;
use std::time::Instant;

use babybench::config::{Behavior, Scene};
use babybench::formats::npz::Npz;
use babybench::render::{Poses, RenderRequest, Renderer, View};
use babybench::{Config, Env};
use conformance::live::speed::{cpu_time, quartiles};

use crate::python;

/// A picture, or both eyes, of a state.
struct Row {
    scene: String,
    state: usize,
    eyes: bool,
    /// CPU time of MuJoCo's renderer, ms.
    mujoco: f64,
}

/// Prints the CPU time of MuJoCo's renderer and ours for the states of `data/render_*.npz`.
///
/// # Errors
/// The Python is missing or fails; a state cannot be drawn.
pub fn print(python: &Path) -> Result<(), String> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
    let rows = rows(python)?;
    println!(
        "CPU time of pictures, ms: MuJoCo 3.3.0's renderer (OSMesa in one thread) and ours, the same states and cameras; by the \
         clock, how long both eyes take one thread and two (`vision_threads: 2`), by turns.\n"
    );
    println!(
        "| scene | pictures | MuJoCo | ours | ours, dearest | times faster, least | p50 | clock, one thread | two |"
    );
    println!("|---|---|--:|--:|--:|--:|--:|--:|--:|");
    for scene in Scene::BABYBENCH {
        let name = scene.to_string();
        let states = Npz::open(data.join(format!("render_{name}.npz")))
            .and_then(|npz| npz.get_f64("qpos"))
            .map_err(|e| e.to_string())?;
        let config = Config {
            scene: scene.clone(),
            behavior: if *scene == Scene::Cubes {
                Behavior::HandRegard
            } else {
                Behavior::None
            },
            touch_active: false,
            vision_active: false,
            ..Config::default()
        };
        let mut env = Env::new(config).map_err(|e| e.to_string())?;
        let nq = states.shape[1];
        for eyes in [true, false] {
            let rows = rows.iter().filter(|r| r.scene == name && r.eyes == eyes);
            let (mut theirs, mut ours, mut ratio) = (Vec::new(), Vec::new(), Vec::new());
            let mut clock = [Vec::new(), Vec::new()];
            for row in rows {
                let qpos = states
                    .data
                    .get(row.state * nq..(row.state + 1) * nq)
                    .ok_or_else(|| format!("render_{name}.npz has no state {}", row.state))?;
                let Spent { cpu: spent, wall } = spent(&mut env, qpos, eyes)?;
                clock.iter_mut().zip(wall).for_each(|(all, ms)| all.push(ms));
                theirs.push(row.mujoco);
                ours.push(spent);
                ratio.push(row.mujoco / spent);
            }
            let dearest = ours.iter().copied().fold(0.0, f64::max);
            let least = ratio.iter().copied().fold(f64::INFINITY, f64::min);
            let [theirs, ours, ratio] = [theirs, ours, ratio].map(|v| quartiles(v)[1]);
            let what = if eyes {
                "both eyes, 64 x 64"
            } else {
                "corner, 480 x 480"
            };
            let [one, two] = clock.map(|v| {
                if eyes {
                    format!("{:.3}", quartiles(v)[1])
                } else {
                    String::new()
                }
            });
            println!(
                "| {name} | {what} | {theirs:.2} | {ours:.3} | {dearest:.3} | {least:.1} | {ratio:.1} | {one} | {two} |"
            );
        }
    }
    Ok(())
}

/// Runs the script that measures MuJoCo's renderer.
fn rows(python: &Path) -> Result<Vec<Row>, String> {
    let script = python::script("render_goldens.py");
    let output = python::command(python)
        .arg(&script)
        .arg("--time")
        .output()
        .map_err(|e| format!("cannot run {}: {e}", python.display()))?;
    if !output.status.success() {
        return Err(format!(
            "{} failed; it needs {}:\n{}",
            script.display(),
            python::NEEDS,
            String::from_utf8_lossy(&output.stderr)
        ));
    }
    let row = |line: &str| {
        let mut words = line.split_whitespace();
        Some(Row {
            scene: words.next()?.to_string(),
            state: words.next()?.parse().ok()?,
            eyes: words.next()? == "eyes",
            mujoco: words.next()?.parse().ok()?,
        })
    };
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| row(line).ok_or_else(|| format!("unexpected line of {}: {line}", script.display())))
        .collect()
}

/// Cost of our pictures of a state, medians, ms.
struct Spent {
    /// CPU time of one thread.
    cpu: f64,
    /// Wall time, with one thread and with two.
    wall: [f64; 2],
}

/// Measures the cost of our pictures of a state.
fn spent(env: &mut Env, qpos: &[f64], eyes: bool) -> Result<Spent, String> {
    let qvel = vec![0.0; env.state().qvel.len()];
    env.by_hand().reset_to(qpos, &qvel).map_err(|e| e.to_string())?;
    let scenery = env.blueprint().scenery().map_err(|e| e.to_string())?;
    let (names, size, repeat): (&[&str], _, _) = if eyes {
        (&["eye_left", "eye_right"], 64, 60)
    } else {
        (&["corner"], 480, 10)
    };
    let request = |name: &&str| {
        let camera = env.model().camera(name).ok_or_else(|| format!("no camera {name}"))?;
        let view = View {
            camera,
            width: size,
            height: size,
        };
        let poses = Poses::from(env.state());
        Ok(RenderRequest { poses, view })
    };
    let requests = names.iter().map(request).collect::<Result<Vec<_>, String>>()?;
    let mut pictures = vec![vec![0; 3 * size * size]; requests.len()];
    let mut renderers = [1, 2].map(|threads| {
        let mut renderer = Renderer::cpu(scenery.clone());
        renderer.set_threads(threads);
        renderer
    });
    let (mut cpu, mut wall) = (Vec::new(), [Vec::new(), Vec::new()]);
    for _ in 0..repeat {
        for (renderer, wall) in renderers.iter_mut().zip(&mut wall) {
            let alone = renderer.threads() == 1;
            let (clock, start) = (Instant::now(), cpu_time());
            let drawn = renderer.rgb(&requests, pictures.iter_mut().map(|picture| &mut picture[..]));
            drawn.map_err(|e| e.to_string())?;
            if alone {
                cpu.push(1e3 * (cpu_time() - start));
            }
            wall.push(1e3 * clock.elapsed().as_secs_f64());
        }
    }
    Ok(Spent {
        cpu: quartiles(cpu)[1],
        wall: wall.map(|v| quartiles(v)[1]),
    })
}

//! Measures the cost of the eyes of 64 environments, in one submission to a GPU and with the CPU renderer, in the same run:
//! `cargo bench --features wgpu --bench render_gpu`. `WGPU_BACKEND` (vulkan, gl, metal, dx12) chooses another adapter.

#[path = "../tests/common/mod.rs"]
mod common;

use std::time::Instant;

use babybench::config::Scene;
use babybench::render::gpu::{GpuRenderer, Pending, Rgb};
use babybench::render::{CpuRenderer, RenderError, RenderRequest};
use babybench::{Blueprint, Env};
use common::seen;

const ENVIRONMENTS: usize = 64;
const ROUNDS: usize = 7;

/// Returns the CPU time of all threads of this process, s, if the system reports it.
fn cpu_time() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let mut fields = stat.rsplit_once(')')?.1.split_whitespace().skip(11);
    let ticks: f64 = fields.next()?.parse::<f64>().ok()? + fields.next()?.parse::<f64>().ok()?;
    Some(ticks / 100.0)
}

/// Measures the wall and CPU time of a piece of work, s.
fn timed(work: impl FnOnce() -> Result<(), RenderError>) -> Result<[f64; 2], RenderError> {
    let (start, cpu) = (Instant::now(), cpu_time());
    work()?;
    let spent = cpu.zip(cpu_time()).map_or(f64::NAN, |(a, b)| b - a);
    Ok([start.elapsed().as_secs_f64(), spent])
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Prints one line of the table, from the median round.
fn report(name: &str, images: usize, rounds: &[[f64; 2]]) -> f64 {
    let wall = median(rounds.iter().map(|r| r[0]).collect());
    let cpu: f64 = rounds.iter().map(|r| r[1]).sum::<f64>() / rounds.len() as f64;
    let count = images as f64;
    println!(
        "  {name:28} {:8.0} images/s   {:8.4} ms wall   {:8.4} ms CPU an image",
        count / wall,
        1e3 * wall / count,
        1e3 * cpu / count
    );
    wall
}

/// Creates the environments, each after a few random steps.
fn environments(blueprint: &Blueprint) -> Result<Vec<Env>, Box<dyn std::error::Error>> {
    let mut environments: Vec<Env> = (0..ENVIRONMENTS).map(|_| blueprint.env()).collect::<Result<_, _>>()?;
    let mut action = Vec::new();
    for (seed, env) in environments.iter_mut().enumerate() {
        env.senses_mut().defer_vision(true);
        env.reset(Some(seed as u64))?;
        for _ in 0..20 {
            env.sample_action(&mut action);
            env.step(&action)?;
        }
    }
    Ok(environments)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for scene in Scene::BABYBENCH {
        let blueprint = Blueprint::new(seen(scene.clone()))?;
        let scenery = blueprint.scenery()?;
        let mut gpu = GpuRenderer::new(scenery.clone())?;
        let environments = environments(&blueprint)?;
        let requests: Vec<RenderRequest> = environments
            .iter()
            .filter_map(|e| Some(e.senses().vision()?.requests(e.state())))
            .flatten()
            .collect();
        println!(
            "{scene}: {} eyes of 64 x 64 in one submission, {}",
            requests.len(),
            gpu.adapter()
        );
        let mut array = vec![0; requests[0].view.rgb_len() * requests.len()];
        let piece = array.len() / requests.len();
        let mut renderer = CpuRenderer::new();
        let (mut cpu, mut one, mut encoding) = (Vec::new(), Vec::new(), Vec::new());
        gpu.draw::<Rgb>(&requests)?;
        for _ in 0..ROUNDS {
            cpu.push(timed(|| {
                let mut outs = array.chunks_exact_mut(piece);
                requests.iter().try_for_each(|s| {
                    let out = outs.next().unwrap_or_default();
                    renderer.rgb(&scenery, &s.poses, &s.view, out)
                })
            })?);
            one.push(timed(|| {
                gpu.begin::<Rgb>(&requests)?.wait_into(array.chunks_exact_mut(piece))
            })?);
            let mut pending = None;
            encoding.push(timed(|| {
                pending = Some(gpu.begin::<Rgb>(&requests)?);
                Ok(())
            })?);
            pending.map(Pending::wait).transpose()?;
        }
        // the next submission is under way while the last one is read
        let pipelined = timed(|| {
            let mut last = gpu.begin::<Rgb>(&requests)?;
            for _ in 1..ROUNDS {
                let next = gpu.begin::<Rgb>(&requests)?;
                std::mem::replace(&mut last, next).wait_into(array.chunks_exact_mut(piece))?;
            }
            last.wait_into(array.chunks_exact_mut(piece))
        })?
        .map(|t| t / ROUNDS as f64);
        let by_cpu = report("CPU renderer, one thread", requests.len(), &cpu);
        let by_gpu = report("wgpu, waiting for each", requests.len(), &one);
        report("wgpu, one submission ahead", requests.len(), &[pipelined]);
        report("of that, recording", requests.len(), &encoding);
        println!("  wgpu takes {:.2} of the CPU renderer's time", by_gpu / by_cpu);
    }
    Ok(())
}

//! The times of our renderers.

use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

use babybench::config::Scene;
use babybench::formats::npz::Npz;
use babybench::physics::State;
use babybench::render::gpu::{GpuRenderer, Rgb};
use babybench::render::{CpuRenderer, Poses, RenderError, RenderRequest, Scenery, View};
use babybench::{Config, Env};
use conformance::live::speed::quartiles;
use conformance::pictures::{config, pictures};

use super::{PICTURE, ROUNDS, Row, SIZE};

/// Measures the renderer on a GPU and that on the CPU, with one thread and with all.
pub fn rows(scene: &Scene, environments: &[usize]) -> Result<Vec<Row>, String> {
    let mut seen = Seen::open(scene)?;
    let mut rows = Vec::new();
    for &environments in environments {
        rows.extend(seen.rows(&scene.to_string(), environments)?);
    }
    Ok(rows)
}

/// Returns the pictures of both eyes that MuJoCo draws with OSMesa for each state.
pub fn osmesa(scene: &str) -> Result<Vec<u8>, String> {
    let npz = Npz::open(file(scene)).map_err(|e| e.to_string())?;
    Ok(pictures(&npz, "eyes").1.concat())
}

fn file(scene: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("data/render_{scene}.npz"))
}

fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// The states of a scene, and what draws them.
struct Seen {
    states: Vec<State>,
    cameras: [usize; 2],
    gpu: GpuRenderer,
    scenery: Arc<Scenery>,
}

impl Seen {
    fn open(scene: &Scene) -> Result<Self, String> {
        let config = Config {
            vision_active: false,
            touch_active: false,
            ..config(scene.clone())
        };
        let mut env = Env::new(config).map_err(|e| e.to_string())?;
        let qvel = vec![0.0; env.state().qvel.len()];
        let npz = Npz::open(file(&scene.to_string())).map_err(|e| e.to_string())?;
        let qpos = npz.get_f64("qpos").map_err(|e| e.to_string())?;
        let mut states = Vec::new();
        for qpos in qpos.data.chunks_exact(qpos.shape[1]) {
            env.by_hand().reset_to(qpos, &qvel).map_err(|e| e.to_string())?;
            states.push(env.state().clone());
        }
        let scenery = env.blueprint().scenery().map_err(|e| e.to_string())?;
        let camera = |name: &str| env.model().camera(name).ok_or_else(|| format!("no camera {name}"));
        Ok(Self {
            states,
            cameras: [camera("eye_left")?, camera("eye_right")?],
            gpu: GpuRenderer::new(scenery.clone()).map_err(|e| e.to_string())?,
            scenery,
        })
    }

    fn rows(&mut self, scene: &str, environments: usize) -> Result<Vec<Row>, String> {
        let [by_gpu, by_cpu] = self.pictures().map_err(|e| e.to_string())?.map(Rc::new);
        let eyes = eyes(&self.states, self.cameras, environments);
        let mut array = vec![0; PICTURE * eyes.len()];
        let gpu = &mut self.gpu;
        let waiting = milliseconds(|| {
            let drawn = gpu.begin::<Rgb>(&eyes)?;
            drawn.wait_into(array.chunks_exact_mut(PICTURE))
        })?;
        let mut last = gpu.begin::<Rgb>(&eyes).map_err(|e| e.to_string())?;
        let ahead = milliseconds(|| {
            let next = gpu.begin::<Rgb>(&eyes)?;
            std::mem::replace(&mut last, next).wait_into(array.chunks_exact_mut(PICTURE))
        })?;
        let row = |renderer: &str, device: String, host, pictures: &Rc<Vec<u8>>| Row {
            scene: scene.to_string(),
            renderer: renderer.to_string(),
            device,
            environments,
            host,
            device_only: None,
            pictures: pictures.clone(),
        };
        let adapter = gpu.adapter().to_string();
        let mut rows = vec![
            row("ours, GPU", adapter.clone(), waiting, &by_gpu),
            row("ours, GPU, a round ahead", adapter, ahead, &by_gpu),
        ];
        for (renderer, threads) in [("ours, CPU, one thread", 1), ("ours, CPU, all threads", threads())] {
            let mut renderers: Vec<_> = (0..threads).map(|_| CpuRenderer::new()).collect();
            let ms = milliseconds(|| by_cpu_in_threads(&mut renderers, &self.scenery, &eyes, &mut array))?;
            let device = format!("threads of the processor: {threads}");
            rows.push(row(renderer, device, ms, &by_cpu));
        }
        Ok(rows)
    }

    /// Draws both eyes of each state on the GPU, and on the CPU.
    fn pictures(&mut self) -> Result<[Vec<u8>; 2], RenderError> {
        let eyes = eyes(&self.states, self.cameras, self.states.len());
        let mut both = [vec![0; PICTURE * eyes.len()], vec![0; PICTURE * eyes.len()]];
        let drawn = self.gpu.begin::<Rgb>(&eyes)?;
        drawn.wait_into(both[0].chunks_exact_mut(PICTURE))?;
        by_cpu_in_threads(&mut [CpuRenderer::new()], &self.scenery, &eyes, &mut both[1])?;
        Ok(both)
    }
}

/// Returns the requests of the eyes of many environments.
fn eyes(states: &[State], cameras: [usize; 2], environments: usize) -> Vec<RenderRequest<'_>> {
    let request = |k: usize| {
        let poses = Poses::from(&states[k / 2 % states.len()]);
        let view = View {
            camera: cameras[k % 2],
            width: SIZE,
            height: SIZE,
        };
        RenderRequest { poses, view }
    };
    (0..2 * environments).map(request).collect()
}

/// Draws pictures, with an equal share for each renderer in its own thread.
fn by_cpu_in_threads(
    renderers: &mut [CpuRenderer],
    scenery: &Scenery,
    eyes: &[RenderRequest],
    array: &mut [u8],
) -> Result<(), RenderError> {
    let share = eyes.len().div_ceil(renderers.len());
    let shares = eyes.chunks(share).zip(array.chunks_mut(PICTURE * share));
    std::thread::scope(|scope| {
        let draw = |(renderer, (eyes, out)): (&mut CpuRenderer, (&[RenderRequest], &mut [u8]))| {
            eyes.iter()
                .zip(out.chunks_exact_mut(PICTURE))
                .try_for_each(|(eye, out)| renderer.rgb(scenery, &eye.poses, &eye.view, out))
        };
        let threads: Vec<_> = renderers
            .iter_mut()
            .zip(shares)
            .map(|work| scope.spawn(move || draw(work)))
            .collect();
        threads
            .into_iter()
            .try_for_each(|thread| thread.join().expect("drawing does not panic"))
    })
}

/// Returns the median time of a round, ms.
fn milliseconds(mut round: impl FnMut() -> Result<(), RenderError>) -> Result<f64, String> {
    round().map_err(|e| e.to_string())?;
    let mut spent = Vec::new();
    for _ in 0..ROUNDS {
        let start = Instant::now();
        round().map_err(|e| e.to_string())?;
        spent.push(1e3 * start.elapsed().as_secs_f64());
    }
    Ok(quartiles(spent)[1])
}

//! The eyes of many environments, drawn together.

use std::sync::Arc;

use crate::env::{Env, EnvError};
use crate::render::{ImageBuffers, RenderRequest, SharedGpu, draw_on};
use crate::sensors::EyeImages;

/// Draws what the eyes of many environments see into their observations, and transforms it. With `renderer: wgpu`, all environments of a
/// blueprint are drawn in one submission and one transfer; by the CPU, one environment after the other.
///
/// ```
/// use babybench::env::draw_eyes;
/// use babybench::{Blueprint, Config, Env};
///
/// let blueprint = Blueprint::new(Config { touch_active: false, ..Config::default() })?; // renderer: wgpu for a GPU
/// let mut environments: Vec<Env> = (0..2).map(|_| blueprint.env()).collect::<Result<_, _>>()?;
/// let mut action = Vec::new();
/// for (seed, env) in environments.iter_mut().enumerate() {
///     env.senses_mut().defer_vision(true);
///     env.reset(Some(seed as u64))?;
///     env.sample_action(&mut action);
///     env.step(&action)?;
/// }
/// draw_eyes(&mut environments)?;
/// assert!(environments[1].observation().eye_left.is_some_and(|image| image.iter().any(|&v| v > 0)));
/// # Ok::<(), babybench::EnvError>(())
/// ```
///
/// # Errors
/// As the renderers.
pub fn draw_eyes<'e>(environments: impl IntoIterator<Item = &'e mut Env>) -> Result<(), EnvError> {
    let mut on_gpus: Vec<&mut Env> = Vec::new();
    for env in environments {
        let Some(vision) = &env.senses.vision else { continue };
        env.physics.check_shape()?;
        if vision.renderer().shared_gpu().is_some() {
            on_gpus.push(env);
            continue;
        }
        env.senses.observe_eyes(&env.physics.state, &mut env.rng)?;
    }
    draw_on_gpus(&mut on_gpus)?;
    Ok(())
}

/// Draws what the eyes of environments see that GPUs draw, in one submission for each.
fn draw_on_gpus(environments: &mut [&mut Env]) -> Result<(), EnvError> {
    let mut batches: Vec<Batch> = Vec::new();
    for env in environments.iter_mut().filter(|env| env.senses.eyes_look()) {
        let state = &env.physics.state;
        let Some(vision) = &env.senses.vision else { continue };
        let Some(gpu) = vision.renderer().shared_gpu() else {
            continue;
        };
        let known = batches.iter().position(|b| Arc::ptr_eq(&b.gpu, gpu));
        let index = known.unwrap_or(batches.len());
        if known.is_none() {
            batches.push(Batch::new(gpu.clone()));
        }
        batches[index].requests.extend(vision.requests(state));
        let eyes = env.senses.eyes.each_mut().map(EyeImages::buffers);
        batches[index].images.extend(eyes);
    }
    for batch in batches {
        draw_on(&batch.gpu, &batch.requests, batch.images)?;
    }
    for env in environments {
        env.senses.transform_eyes(&mut env.rng);
    }
    Ok(())
}

/// The pictures that one GPU draws.
struct Batch<'e> {
    gpu: SharedGpu,
    requests: Vec<RenderRequest<'e>>,
    images: Vec<ImageBuffers<'e>>,
}

impl Batch<'_> {
    fn new(gpu: SharedGpu) -> Self {
        Self {
            gpu,
            requests: Vec::new(),
            images: Vec::new(),
        }
    }
}

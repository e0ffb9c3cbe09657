//! The library's wgpu renderer on WebGL2, which tells of finished images only when it is asked.
#![forbid(unsafe_code)]
#![cfg(target_arch = "wasm32")]

use babybench::env::Viewer;
use babybench::render::gpu::{GpuRenderer, Rgb};
use babybench::render::{Poses, RenderRequest, View};
use babybench::{Config, Env};
use js_sys::{Array, Uint8Array};
use wasm_bindgen::prelude::*;
use wgpu::{Backends, DeviceDescriptor, Instance, InstanceDescriptor, Limits, RequestAdapterOptions, SurfaceTarget};

/// The camera of the images.
const CAMERA: &str = "corner";

fn error(e: impl std::fmt::Display) -> JsError {
    JsError::new(&e.to_string())
}

/// Draws one image, of `side` pixels each way, on the WebGL2 context of a canvas, and once more on the CPU. Returns the name of the adapter
/// and both images: red, green and blue of each pixel.
#[wasm_bindgen]
pub async fn draw(canvas: web_sys::OffscreenCanvas, side: usize) -> Result<Array, JsError> {
    let config = Config {
        touch_active: false,
        vision_active: false,
        ..Config::default()
    };
    let mut env = Env::new(config).map_err(error)?;
    env.reset(Some(0)).map_err(error)?;
    let scenery = env.blueprint().scenery().map_err(error)?;

    let mut description = InstanceDescriptor::new_without_display_handle();
    description.backends = Backends::GL;
    let instance = Instance::new(description);
    let surface = instance
        .create_surface(SurfaceTarget::OffscreenCanvas(canvas))
        .map_err(error)?;
    let wanted = RequestAdapterOptions {
        compatible_surface: Some(&surface),
        ..Default::default()
    };
    let adapter = instance.request_adapter(&wanted).await.map_err(error)?;
    let description = DeviceDescriptor {
        required_limits: Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits()),
        ..Default::default()
    };
    let (device, queue) = adapter.request_device(&description).await.map_err(error)?;
    let mut renderer = GpuRenderer::with_device(device, queue, scenery).map_err(error)?;

    let camera = env.model().camera(CAMERA).ok_or_else(|| error("no such camera"))?;
    let view = View {
        camera,
        width: side,
        height: side,
    };
    let poses = Poses::from(env.state());
    let pending = renderer.begin::<Rgb>(&[RenderRequest { poses, view }]).map_err(error)?;
    // nothing else is drawn that could bring the image along
    let images = pending.read().await.map_err(error)?;

    let mut viewer = Viewer::new(env.blueprint()).map_err(error)?;
    let own = viewer.draw(&env, CAMERA, side, side).map_err(error)?;
    let [found, own] = [images.as_slice(), own].map(|image| Uint8Array::from(image).into());
    Ok(Array::from_iter([JsValue::from(renderer.adapter()), found, own]))
}

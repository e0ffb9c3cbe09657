//! Pictures of an environment from any of its cameras.

use babybench::env::{ViewFrom, Viewer};
use babybench::math::Vec3;
use babybench::render::{FreeCamera, Poses, RenderRequest, Renderer, View};
use numpy::Element;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

use crate::arrays::shaped;
use crate::env::Inner;
use crate::errors::{IntoException, detached};

/// The renderers made so far.
#[derive(Default)]
pub struct Painters {
    viewer: Option<Viewer>,
    renderer: Option<Renderer>,
}

/// A camera, as given from Python.
#[derive(FromPyObject)]
pub enum Camera {
    /// One of the scene.
    Named(String),
    /// A free camera: the point that it looks at, m, distance, m, azimuth and elevation, degrees.
    Free((Vec3, f64, f64, f64)),
}

impl Camera {
    fn view(&self) -> ViewFrom<'_> {
        match self {
            Self::Named(name) => ViewFrom::Camera(name),
            Self::Free((lookat, distance, azimuth, elevation)) => ViewFrom::Free(FreeCamera {
                lookat: *lookat,
                distance: *distance,
                azimuth: *azimuth,
                elevation: *elevation,
            }),
        }
    }
}

/// Draws a picture in colour, (height, width, 3).
pub fn colour<'py>(
    py: Python<'py>,
    inner: &mut Inner,
    camera: &Camera,
    [width, height]: [usize; 2],
) -> PyResult<Bound<'py, PyAny>> {
    let Inner { env, painters, .. } = inner;
    let viewer = &mut painters.viewer;
    let picture = detached(py, || -> Result<Vec<u8>, babybench::EnvError> {
        if viewer.is_none() {
            *viewer = Some(Viewer::new(env.blueprint())?);
        }
        match viewer {
            Some(viewer) => Ok(viewer.draw(env, camera.view(), width, height)?.to_vec()),
            None => Ok(Vec::new()),
        }
    })?;
    shaped(py, &picture, &[height, width, 3])
}

/// Draws distances from the camera's plane, (height, width), m.
pub fn depth<'py>(
    py: Python<'py>,
    inner: &mut Inner,
    camera: &Camera,
    size: [usize; 2],
) -> PyResult<Bound<'py, PyAny>> {
    map::<f32>(py, inner, camera, size, |renderer, views, out| {
        renderer.depth(views, [out])
    })
}

/// Draws ids of geoms, (height, width).
pub fn segmentation<'py>(
    py: Python<'py>,
    inner: &mut Inner,
    camera: &Camera,
    size: [usize; 2],
) -> PyResult<Bound<'py, PyAny>> {
    map::<i32>(py, inner, camera, size, |renderer, views, out| {
        renderer.segmentation(views, [out])
    })
}

/// A method of a renderer that draws numbers of one kind.
type Draw<T> = fn(&mut Renderer, &[RenderRequest], &mut [T]) -> Result<(), babybench::render::RenderError>;

/// Draws a picture of numbers, (height, width).
fn map<'py, T: Element + Copy + Default + Send>(
    py: Python<'py>,
    inner: &mut Inner,
    camera: &Camera,
    [width, height]: [usize; 2],
    method: Draw<T>,
) -> PyResult<Bound<'py, PyAny>> {
    let Inner { env, painters, .. } = inner;
    let renderer = &mut painters.renderer;
    let known = |name: &str| {
        env.model().camera(name).ok_or_else(|| {
            let cameras = env.model().cam_name.join(", ");
            PyKeyError::new_err(format!("there is no camera {name:?}; there are {cameras}"))
        })
    };
    let (camera, free) = match camera.view() {
        ViewFrom::Camera(name) => (known(name)?, None),
        ViewFrom::Free(free) => {
            let pose = free.pose().map_err(IntoException::into_exception)?;
            (View::FREE, Some(pose))
        }
    };
    let picture = detached(py, || -> Result<Vec<T>, babybench::EnvError> {
        let view = View { camera, width, height };
        view.check()?;
        let mut picture = vec![T::default(); view.pixels()];
        let mut poses = Poses::from(env.state());
        poses.free = free;
        let renderer = match renderer {
            Some(renderer) => renderer,
            None => renderer.insert(env.blueprint().renderer()?),
        };
        method(renderer, &[RenderRequest { poses, view }], &mut picture)?;
        Ok(picture)
    })?;
    shaped(py, &picture, &[height, width])
}

//! A state of any model, and the engine that advances it: MuJoCo's `mjData`.

use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

use babybench::model::Model;
use babybench::physics::collision::placed;
use babybench::physics::contact::{ContactOptions, Scratch, distance};
use babybench::physics::{Engine, EngineError, SoftEngine, State, Topology, ray, rne_post_constraint};
use babybench::render::{FreeCamera, ImageBuffers, Poses, RenderRequest, Renderer, View};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{ToArray, shaped};
use crate::errors::{IntoException, detached};
use crate::physics_fields::{COMPUTED, CONSTRAINTS, GROUPS, INPUT, POST, part, read_inputs, state_layout, write_state};
use crate::physics_markers::{Marker, Placed};
use crate::physics_model::{PhysicsModel, params};
use crate::state;

/// Steps between two checks for Ctrl-C.
const UNINTERRUPTED: usize = 1000;

impl IntoException for EngineError {
    fn into_exception(self) -> PyErr {
        let text = self.to_string();
        match self {
            Self::NoKeyframe { .. } => PyIndexError::new_err(text),
            Self::NotFinite { .. } | Self::NotPositive { .. } => PyValueError::new_err(text),
            _ => PyRuntimeError::new_err(text),
        }
    }
}

/// A distance, and the points between which it is measured, m.
type Span = (f64, [f64; 3], [f64; 3]);

/// The contents of a Python state.
struct Inner {
    engine: SoftEngine,
    state: State,
    /// A second state for computations without contacts and constraints.
    aside: Option<State>,
    version: u64,
    model: Arc<Model>,
}

/// A state of a model.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct PhysicsData {
    inner: Mutex<Inner>,
    model: Py<PhysicsModel>,
    memory: Py<PyArray1<f64>>,
    active: Py<PyArray1<u8>>,
}

/// Returns whether MuJoCo computes accelerations of bodies in each step, because a sensor reads them.
impl PhysicsData {
    fn guard(&self) -> PyResult<MutexGuard<'_, Inner>> {
        self.inner.try_lock().map_err(|e| {
            PyRuntimeError::new_err(match e {
                TryLockError::WouldBlock => "another thread is using the state: give each thread one of its own",
                TryLockError::Poisoned(_) => "the state is broken: make another",
            })
        })
    }

    /// Computes with the values that a program has written into the arrays of the model and of the state.
    fn with<R: Send>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&mut Inner) -> Result<R, EngineError> + Send,
    ) -> PyResult<(MutexGuard<'_, Inner>, R)> {
        let now = self.model.get().now(py)?;
        let mut guard = self.guard()?;
        if guard.version != now.version {
            guard.engine = now.soft.engine();
            // elements that never move are placed once for a state, and may have new poses
            let mut state = guard.engine.new_state();
            state.copy_dynamic_from(&guard.state);
            guard.state = state;
            guard.aside = None;
            guard.version = now.version;
            guard.model = now.model;
        }
        {
            let (memory, active) = (
                self.memory.bind(py).try_readonly()?,
                self.active.bind(py).try_readonly()?,
            );
            read_inputs(memory.as_slice()?, &mut guard.state);
            guard.state.params = params(&guard.model, active.as_slice()?).into();
        }
        let inner = &mut *guard;
        let done = detached(py, || work(inner))?;
        Ok((guard, done))
    }

    fn show(&self, py: Python<'_>, state: &State, groups: u32) -> PyResult<()> {
        let mut memory = self.memory.bind(py).try_readwrite()?;
        write_state(state, groups, memory.as_slice_mut()?);
        Ok(())
    }
}

/// Advances by some time steps.
fn steps(inner: &mut Inner, count: usize) -> Result<(), EngineError> {
    (0..count).try_for_each(|_| inner.engine.step(&mut inner.state))
}

#[pymethods]
impl PhysicsData {
    #[new]
    fn new(py: Python<'_>, model: Py<PhysicsModel>) -> PyResult<Self> {
        let now = model.get().now(py)?;
        let engine = now.soft.engine();
        let state = engine.new_state();
        let mut memory = Vec::new();
        for (_, _, shape) in state_layout(&state) {
            memory.resize(memory.len() + shape.iter().product::<usize>(), 0.0);
        }
        write_state(&state, INPUT, &mut memory);
        let active = now.model.eq_active0.iter().map(|&on| u8::from(on));
        Ok(Self {
            memory: PyArray1::from_vec(py, memory).unbind(),
            active: PyArray1::from_iter(py, active).unbind(),
            inner: Mutex::new(Inner {
                engine,
                state,
                aside: None,
                version: now.version,
                model: now.model,
            }),
            model,
        })
    }

    /// Returns the memory of all arrays.
    #[getter]
    fn memory<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.memory.bind(py).clone()
    }

    /// Returns which equality constraints are active.
    #[getter]
    fn eq_active<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u8>> {
        self.active.bind(py).clone()
    }

    /// Returns names, groups and shapes of the arrays in the memory, in order.
    #[getter]
    fn layout(&self) -> PyResult<Vec<(&'static str, u32, Vec<usize>)>> {
        Ok(state_layout(&self.guard()?.state))
    }

    /// Returns the groups of arrays by name.
    #[classattr]
    #[allow(non_snake_case)]
    fn GROUPS(py: Python<'_>) -> PyResult<Py<PyDict>> {
        let groups = PyDict::new(py);
        for (name, bit) in GROUPS {
            groups.set_item(name, bit)?;
        }
        Ok(groups.unbind())
    }

    /// Resets: everything is zero except the positions, or the values of a keyframe.
    #[pyo3(signature = (key=None))]
    fn reset(&self, py: Python<'_>, key: Option<usize>) -> PyResult<()> {
        let (mut guard, ()) = self.with(py, |_| Ok(()))?;
        let inner = &mut *guard;
        let mut state = inner.engine.new_state();
        if let Some(key) = key {
            inner
                .engine
                .reset_to_keyframe(&mut state, key)
                .map_err(IntoException::into_exception)?;
        }
        inner.state = state;
        {
            let mut active = self.active.bind(py).try_readwrite()?;
            for (to, &on) in active.as_slice_mut()?.iter_mut().zip(&inner.model.eq_active0) {
                *to = u8::from(on);
            }
            self.memory.bind(py).try_readwrite()?.as_slice_mut()?.fill(0.0);
        }
        self.show(py, &inner.state, INPUT)
    }

    /// Advances by some time steps.
    fn step(&self, py: Python<'_>, count: usize) -> PyResult<()> {
        let mut left = count;
        while left > 0 {
            let now = left.min(UNINTERRUPTED);
            left -= now;
            let (guard, post) = self.with(py, |inner| {
                steps(inner, now)?;
                Ok(inner.model.reads_accelerations())
            })?;
            self.show(py, &guard.state, INPUT | COMPUTED | if post { POST } else { 0 })?;
            drop(guard);
            py.check_signals()?;
        }
        Ok(())
    }

    /// Returns the first geom that a ray meets at the poses in the arrays, and the distance; `hidden` geoms are left out, and those of
    /// one body.
    fn ray(
        &self,
        py: Python<'_>,
        origin: [f64; 3],
        direction: [f64; 3],
        without_body: Option<usize>,
        hidden: Vec<usize>,
    ) -> PyResult<Option<(usize, f64)>> {
        let mut guard = self.guard()?;
        let memory = self.memory.bind(py).try_readonly()?;
        let shown = memory.as_slice()?;
        let inner = &mut *guard;
        let places = part(&inner.state, shown, "geom_xpos").as_chunks::<3>().0.to_vec();
        let turns = part(&inner.state, shown, "geom_xmat").as_chunks::<9>().0.to_vec();
        inner.state.geom_xpos.copy_from_slice(&places);
        inner.state.geom_xmat.copy_from_slice(&turns);
        let seen = if hidden.is_empty() {
            inner.model.clone()
        } else {
            Arc::new(inner.model.edited(|arrays| {
                for geom in hidden {
                    if let (Some(material), Some(rgba)) =
                        (arrays.geom_matid.get_mut(geom), arrays.geom_rgba.get_mut(geom))
                    {
                        *material = None;
                        rgba[3] = 0.0;
                    }
                }
            }))
        };
        let hit = ray(&seen, &inner.state, origin, direction, without_body).map_err(IntoException::into_exception)?;
        Ok(hit.map(|hit| (hit.geom, hit.distance)))
    }

    /// Returns the distance between two geoms at the positions in the arrays, if it is below `most`, and the points between which it is
    /// measured, m.
    fn distance(&self, py: Python<'_>, geoms: [usize; 2], most: f64) -> PyResult<Option<Span>> {
        let now = self.model.get().now(py)?;
        let mut guard = self.guard()?;
        let inner = &mut *guard;
        let memory = self.memory.bind(py).try_readonly()?;
        let shown = memory.as_slice()?;
        let (places, turns) = (
            part(&inner.state, shown, "geom_xpos").as_chunks::<3>().0.to_vec(),
            part(&inner.state, shown, "geom_xmat").as_chunks::<9>().0.to_vec(),
        );
        inner.state.geom_xpos.copy_from_slice(&places);
        inner.state.geom_xmat.copy_from_slice(&turns);
        inner.state.params = params(&now.model, self.active.bind(py).try_readonly()?.as_slice()?).into();
        let opt = &now.model.opt;
        let options = ContactOptions {
            ccd_tolerance: opt.ccd_tolerance,
            ccd_iterations: opt.ccd_iterations,
            nativeccd: opt.flags.nativeccd,
            ..ContactOptions::default()
        };
        let [first, second] = geoms.map(|geom| placed(&now.model, &inner.state, geom));
        let span = distance(&first, &second, most, &options, &mut Scratch::new(), &mut Vec::new());
        Ok(span.map(|span| (span.dist, span.from, span.to)))
    }

    /// Computes everything without advancing, and updates some groups of arrays. Without constraints among them, contacts and their
    /// forces do not change; without accelerations, the solver's start does not.
    fn forward(&self, py: Python<'_>, groups: u32) -> PyResult<()> {
        let (guard, post) = self.with(py, |inner| {
            let Inner {
                engine,
                state,
                aside,
                model,
                ..
            } = inner;
            if groups & CONSTRAINTS == 0 {
                let other = aside.get_or_insert_with(|| state.clone());
                other.copy_dynamic_from(state);
                engine.forward(other)?;
            } else {
                engine.forward(state)?;
            }
            Ok(model.reads_accelerations() && groups & INPUT != 0)
        })?;
        let groups = if post { groups | POST } else { groups };
        let state = if groups & CONSTRAINTS == 0 {
            guard.aside.as_ref()
        } else {
            None
        };
        self.show(py, state.unwrap_or(&guard.state), groups)
    }

    /// Computes the quantities that follow from accelerations and constraint forces at the current velocities.
    fn rne_post_constraint(&self, py: Python<'_>) -> PyResult<()> {
        let (guard, ()) = self.with(py, |inner| {
            inner.engine.check_shape(&inner.state)?;
            rne_post_constraint(&inner.model, &mut inner.state, true);
            Ok(())
        })?;
        self.show(py, &guard.state, POST)
    }

    /// Returns the values of the sensors as they were last computed.
    fn sensordata<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.guard()?.state.sensordata[..].to_array(py)
    }

    /// Copies everything from another state of the same model.
    fn copy_from(&self, py: Python<'_>, other: &Self) -> PyResult<()> {
        if std::ptr::eq(self, other) {
            return Ok(());
        }
        let theirs = other.guard()?;
        let mut ours = self.guard()?;
        if self.memory.bind(py).len()? != other.memory.bind(py).len()? {
            return Err(PyValueError::new_err("the states are of models of other sizes"));
        }
        ours.state.clone_from(&theirs.state);
        let memory = other.memory.bind(py).to_vec()?;
        self.memory
            .bind(py)
            .try_readwrite()?
            .as_slice_mut()?
            .copy_from_slice(&memory);
        let active = other.active.bind(py).to_vec()?;
        self.active
            .bind(py)
            .try_readwrite()?
            .as_slice_mut()?
            .copy_from_slice(&active);
        Ok(())
    }

    /// Returns the contacts as arrays, one entry for each.
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state::contacts(py, &self.guard()?.state)
    }

    /// Returns the number of contacts and of constraint rows.
    #[getter]
    fn counts(&self) -> PyResult<(usize, usize)> {
        let guard = self.guard()?;
        Ok((guard.state.contact.len(), guard.state.nefc()))
    }

    /// Returns the constraint rows as arrays, one entry for each.
    fn rows<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let guard = self.guard()?;
        let (rows, dict) = (guard.state.efc_rows().collect::<Vec<_>>(), PyDict::new(py));
        dict.set_item("type", PyArray1::from_iter(py, rows.iter().map(|r| r.kind as i32)))?;
        dict.set_item("id", PyArray1::from_iter(py, rows.iter().map(|r| r.id as i32)))?;
        macro_rules! numbers {
            ($($name:literal $field:ident)*) => {$(
                dict.set_item($name, PyArray1::from_iter(py, rows.iter().map(|r| r.$field)))?;
            )*};
        }
        numbers!("pos" pos "margin" margin "R" r "vel" vel "aref" aref "force" force);
        dict.set_item("D", PyArray1::from_iter(py, rows.iter().map(|r| 1.0 / r.r)))?;
        Ok(dict)
    }

    /// Returns the positions of the vertices of flexes, and the lengths of their edges with the rates of these.
    fn flexes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (guard, dict) = (self.guard()?, PyDict::new(py));
        dict.set_item("flexvert_xpos", guard.state.flexvert_xpos[..].to_array(py)?)?;
        dict.set_item(
            "flexedge_length",
            PyArray1::from_slice(py, &guard.state.flexedge_length),
        )?;
        dict.set_item(
            "flexedge_velocity",
            PyArray1::from_slice(py, &guard.state.flexedge_velocity),
        )?;
        Ok(dict)
    }

    /// Returns the Jacobian of the constraints as a full matrix, (nefc, nv).
    fn jacobian<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let guard = self.guard()?;
        let (count, nv) = (guard.state.nefc(), guard.model.nv);
        let rows = (0..count).flat_map(|row| guard.engine.efc_j(&guard.state, row).unwrap_or_default());
        shaped(py, &rows.collect::<Vec<_>>(), &[count, nv])
    }

    /// Returns the Jacobian of tendon lengths as a full matrix, (ntendon, nv).
    fn tendon_jacobian<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let guard = self.guard()?;
        let (model, topology) = (&guard.model, Topology::new(&guard.model));
        let mut full = vec![0.0; model.ntendon() * model.nv];
        for (tendon, row) in full.chunks_exact_mut(model.nv.max(1)).enumerate() {
            let rates = &guard.state.ten_j[topology.tendons.range(tendon)];
            for (&dof, rate) in topology.tendons.row(tendon).iter().zip(rates) {
                row[dof as usize] = *rate;
            }
        }
        shaped(py, &full, &[model.ntendon(), model.nv])
    }

    /// Returns the joint-space inertia as a full matrix, (nv, nv).
    fn inertia<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let guard = self.guard()?;
        let nv = guard.model.nv;
        shaped(py, &guard.engine.full_m(&guard.state), &[nv, nv])
    }
}

/// Draws states of a model.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct PhysicsRenderer {
    renderer: Mutex<Drawing>,
    model: Py<PhysicsModel>,
    /// The textures of the materials when the renderer was made.
    textures: Vec<Option<usize>>,
    /// The geoms, sites, groups of tendons and groups of skins to draw, where these are not MuJoCo's default ones.
    shown: Option<[Vec<bool>; 4]>,
}

/// A free camera: the point that it looks at, distance, azimuth, elevation.
type FreeView = ([f64; 3], f64, f64, f64);

/// A renderer, the number of the look that it draws, and the markers.
struct Drawing {
    renderer: Renderer,
    look: u64,
    markers: Vec<Marker>,
}

#[pymethods]
impl PhysicsRenderer {
    /// Draws what MuJoCo shows by default, or the geoms, sites, groups of tendons and groups of skins for which `shown` is true.
    #[new]
    #[pyo3(signature = (model, shown=None))]
    fn new(py: Python<'_>, model: Py<PhysicsModel>, shown: Option<[Vec<bool>; 4]>) -> PyResult<Self> {
        let (scenery, look) = model.get().scenery(py, None, shown.as_ref(), &[])?;
        let renderer = Renderer::cpu(scenery);
        Ok(Self {
            renderer: Mutex::new(Drawing {
                renderer,
                look,
                markers: Vec::new(),
            }),
            textures: model.get().textures(),
            model,
            shown,
        })
    }

    /// Draws what the arrays of a state show, from a camera or from a free one (point, distance, azimuth, elevation): colours
    /// (height, width, 3), distances or ids of geoms (height, width). The ids of markers follow those of the model's geoms.
    fn draw<'py>(
        &self,
        py: Python<'py>,
        data: &PhysicsData,
        camera: (Option<usize>, FreeView),
        size: [usize; 2],
        what: &str,
        markers: Vec<Placed>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [width, height] = size;
        let (camera, (lookat, distance, azimuth, elevation)) = camera;
        let camera_pose = FreeCamera {
            lookat,
            distance,
            azimuth,
            elevation,
        }
        .pose()
        .map_err(IntoException::into_exception)?;
        let view = View {
            camera: camera.unwrap_or(View::FREE),
            width,
            height,
        };
        view.check().map_err(IntoException::into_exception)?;
        let look = self.model.get().look(py)?;
        let guard = data.guard()?;
        let memory = data.memory.bind(py).try_readonly()?;
        let memory = memory.as_slice()?;
        let state = &guard.state;
        let vectors = |name| part(state, memory, name).as_chunks::<3>().0;
        let matrices = |name| part(state, memory, name).as_chunks::<9>().0;
        let marked: Vec<Marker> = markers.iter().map(Marker::new).collect::<PyResult<_>>()?;
        let places = [vectors("geom_xpos"), &markers.iter().map(|m| m.2).collect::<Vec<_>>()].concat();
        let turns = [matrices("geom_xmat"), &markers.iter().map(|m| m.3).collect::<Vec<_>>()].concat();
        let sizes = [
            &guard.model.geom_size[..],
            &marked.iter().map(|m| m.size).collect::<Vec<_>>(),
        ]
        .concat();
        let poses = Poses {
            geom_xpos: &places,
            geom_xmat: &turns,
            geom_size: &sizes,
            site_xpos: vectors("site_xpos"),
            site_xmat: matrices("site_xmat"),
            ten_wrapadr: &state.ten_wrapadr,
            ten_wrapnum: &state.ten_wrapnum,
            wrap_xpos: &state.wrap_xpos,
            wrap_obj: &state.wrap_obj,
            cam_xpos: vectors("cam_xpos"),
            cam_xmat: matrices("cam_xmat"),
            free: Some(camera_pose),
            xpos: vectors("xpos"),
            xmat: matrices("xmat"),
            subtree_com: vectors("subtree_com"),
            flexvert_xpos: &state.flexvert_xpos,
        };
        // waiting for another thread here, with Python's lock held, could block forever
        let mut guard_of_renderer = self.renderer.try_lock().map_err(|_| {
            PyRuntimeError::new_err("another thread is using the renderer: give each thread one of its own")
        })?;
        if guard_of_renderer.look != look || guard_of_renderer.markers != marked {
            let (scenery, look) = self
                .model
                .get()
                .scenery(py, Some(&self.textures), self.shown.as_ref(), &marked)?;
            let renderer = Renderer::cpu(scenery);
            *guard_of_renderer = Drawing {
                renderer,
                look,
                markers: marked,
            };
        }
        let renderer = &mut guard_of_renderer.renderer;
        let request = [RenderRequest { poses, view }];
        let (mut rgb, mut depth, mut ids) = (Vec::new(), Vec::new(), Vec::new());
        let images = match what {
            "rgb" => {
                rgb.resize(view.rgb_len(), 0);
                ImageBuffers::rgb(&mut rgb)
            }
            "depth" => {
                depth.resize(view.pixels(), 0.0);
                ImageBuffers::depth(&mut depth)
            }
            _ => {
                ids.resize(view.pixels(), 0);
                ImageBuffers::segmentation(&mut ids)
            }
        };
        detached(py, || renderer.draw(&request, [images]))?;
        match what {
            "rgb" => shaped(py, &rgb, &[height, width, 3]),
            "depth" => shaped::<f32>(py, &depth, &[height, width]),
            _ => shaped::<i32>(py, &ids, &[height, width]),
        }
    }
}

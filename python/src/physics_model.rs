//! Any model, compiled from a document: MuJoCo's `mjModel`.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use babybench::Model;
use babybench::assets::{AssetSource, FileSystem};
use babybench::mjcf_loader::{LoadError, load, load_str};
use babybench::model::{Arrays, Keyframe, SameFrame, SensorType, Texture, TextureType, Wrap};
use babybench::physics::{Params, SoftModel, SoftOptions, compile};
use babybench::render::{RenderError, Scenery};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::ToArray;
use crate::errors::{IntoException, detached};
use crate::given_files::GivenFiles;
use crate::model::{self, table};
use crate::physics_columns::{Contents, Memory};
use crate::physics_fields::{model_layout, read_model, write_model};
use crate::physics_markers::Marker;
use crate::physics_options::{settings, with_option};
use crate::physics_shapes::shapes;
use crate::scene::extras;

impl IntoException for LoadError {
    fn into_exception(self) -> PyErr {
        PyValueError::new_err(self.to_string())
    }
}

impl IntoException for RenderError {
    fn into_exception(self) -> PyErr {
        PyValueError::new_err(self.to_string())
    }
}

table! { ARRAYS, array, Arrays,
    body_gravcomp sensor_needstage geom_dataid geom_fluid body_mocapid body_user jnt_user geom_user site_user actuator_user sensor_user tendon_user cam_pos0 cam_poscom0 cam_mat0
    cam_targetbodyid tendon_lengthspring tendon_stiffness tendon_damping
    geom_aabb jnt_actgravcomp jnt_actfrclimited jnt_actfrcrange
    cam_resolution cam_sensorsize cam_intrinsic
    tendon_frictionloss tendon_solref_fri tendon_solimp_fri tendon_length0 tendon_width
    actuator_trntype actuator_cranklength actuator_group actuator_acc0 actuator_length0
}

/// The parts that change when a program writes into the arrays of a model.
struct Current {
    soft: SoftModel,
    model: Arc<Model>,
    /// The numbers that the model was last made from.
    seen: Vec<f64>,
    columns_seen: Contents,
    version: u64,
    /// The number of changes of the look.
    looks: u64,
    scenery: Option<Arc<Scenery>>,
}

/// A model of any document.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct PhysicsModel {
    current: Mutex<Current>,
    memory: Py<PyArray1<f64>>,
    columns: Memory,
    assets: Arc<dyn AssetSource>,
}

/// The current model, for states.
pub struct Now {
    pub soft: SoftModel,
    pub model: Arc<Model>,
    pub version: u64,
}

fn soft(model: &Arc<Model>) -> SoftModel {
    // torques of welds as MuJoCo shows them
    let options = SoftOptions {
        double_weld_torque: true,
        ..SoftOptions::default()
    };
    SoftModel::new(model.clone(), options)
}

/// Makes geoms and sites that are oriented like their bodies follow these, as in MuJoCo, even if their frames are the inertial ones. A position that
/// a program writes then takes effect.
fn level_frames(arrays: &mut Arrays) {
    let geoms = arrays.geom_sameframe.iter_mut().zip(&arrays.geom_quat);
    let sites = arrays.site_sameframe.iter_mut().zip(&arrays.site_quat);
    for (frame, quat) in geoms.chain(sites) {
        let level = SameFrame::of([0.0; 3], *quat, [0.0; 3], *quat) == SameFrame::Body;
        if *frame == SameFrame::Inertia && level {
            *frame = SameFrame::BodyRot;
        }
    }
}

impl PhysicsModel {
    fn made(py: Python<'_>, model: Model, assets: Arc<dyn AssetSource>) -> PyResult<Self> {
        let model = Arc::new(model.edited(level_frames));
        let (seen, columns_seen) = (write_model(&model), Contents::of(&model));
        Ok(Self {
            memory: PyArray1::from_slice(py, &seen).unbind(),
            columns: Memory::new(py, &model, &columns_seen)?,
            current: Mutex::new(Current {
                soft: soft(&model),
                model,
                seen,
                columns_seen,
                version: 0,
                looks: 0,
                scenery: None,
            }),
            assets,
        })
    }

    fn current(&self) -> MutexGuard<'_, Current> {
        self.current.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the model with the values that a program has written into its arrays.
    pub fn now(&self, py: Python<'_>) -> PyResult<Now> {
        let mut current = self.current();
        let memory = self.memory.bind(py).try_readonly()?;
        let written = memory.as_slice()?;
        if written != &current.seen[..] {
            let mut fault = Ok(());
            let model = current.model.edited(|arrays| {
                fault = read_model(written, arrays);
                // the engine has the first of the six gears apart
                for (first, gears) in arrays.actuator_gear.iter_mut().zip(&arrays.actuator_gear6) {
                    *first = gears[0];
                }
            });
            fault.map_err(|(name, index, value)| {
                let name = name.replacen("opt_", "opt.", 1);
                PyValueError::new_err(format!(
                    "model.{name}, number {index}, is {value}: only finite numbers can be simulated"
                ))
            })?;
            if model.opt.timestep <= 0.0 {
                return Err(PyValueError::new_err(format!(
                    "model.opt.timestep is {}: it must be > 0",
                    model.opt.timestep
                )));
            }
            let weighs = |kind: &SensorType| matches!(kind, SensorType::SubtreeLinVel | SensorType::SubtreeAngMom);
            if model.body_mass != current.model.body_mass && model.sensor_type.iter().any(weighs) {
                return Err(PyValueError::new_err(
                    "model.body_mass cannot change where a sensor is a subtreelinvel or a subtreeangmom, of which MuJoCo would show \
                     what the masses of the document make: change the document",
                ));
            }
            current.seen = written.to_vec();
            current.replace(model);
        }
        if let Some(written) = self.columns.changed(py, &current.columns_seen)? {
            let mut fault = Ok(());
            let model = current.model.edited(|arrays| {
                fault = written.write(&current.columns_seen, arrays);
            });
            fault?;
            current.columns_seen = written;
            current.replace(model);
            current.looks += 1;
            current.scenery = None;
        }
        let Current {
            soft, model, version, ..
        } = &*current;
        Ok(Now {
            soft: soft.clone(),
            model: model.clone(),
            version: *version,
        })
    }

    /// Returns the scenery of the model and the number of its look. `textures`, if given, replaces the current textures of the materials, because
    /// MuJoCo reads them when a renderer is made. `shown` replaces MuJoCo's default groups. `markers` follow the geoms of the model.
    pub fn scenery(
        &self,
        py: Python<'_>,
        textures: Option<&[Option<usize>]>,
        shown: Option<&[Vec<bool>; 4]>,
        markers: &[Marker],
    ) -> PyResult<(Arc<Scenery>, u64)> {
        self.now(py)?;
        let (known, model, looks) = {
            let current = self.current();
            (current.scenery.clone(), current.model.clone(), current.looks)
        };
        let same = textures.is_none_or(|given| model.materials.iter().map(|m| &m.texture).eq(given));
        if let Some(scenery) = known.filter(|_| same && shown.is_none() && markers.is_empty()) {
            return Ok((scenery, looks));
        }
        if !same || shown.is_some() || !markers.is_empty() {
            let older = model.edited(|arrays| {
                for (material, texture) in arrays.materials.iter_mut().zip(textures.unwrap_or_default()) {
                    material.texture = *texture;
                }
                if let Some(shown) = shown {
                    show(arrays, shown);
                }
                markers.iter().for_each(|marker| marker.add(arrays));
            });
            return Ok((Arc::new(detached(py, || Scenery::new(&older, &*self.assets))?), looks));
        }
        let scenery = Arc::new(detached(py, || Scenery::new(&model, &*self.assets))?);
        self.current().scenery = Some(scenery.clone());
        Ok((scenery, looks))
    }

    /// Returns the number of the current look, including what a program has written.
    pub fn look(&self, py: Python<'_>) -> PyResult<u64> {
        self.now(py)?;
        Ok(self.current().looks)
    }

    /// Returns the texture of each material.
    pub fn textures(&self) -> Vec<Option<usize>> {
        self.current().model.materials.iter().map(|m| m.texture).collect()
    }
}

/// Moves geoms, sites, and groups of tendons and of skins that are shown into a group that is drawn, and the others out of it.
fn show(arrays: &mut Arrays, shown: &[Vec<bool>; 4]) {
    const GROUPS: [i32; 2] = [5, 0];
    for (groups, shown) in [&mut arrays.geom_group, &mut arrays.site_group].into_iter().zip(shown) {
        for (group, shown) in groups.iter_mut().zip(shown) {
            *group = GROUPS[usize::from(*shown)];
        }
    }
    // groups beyond the first and the last count as these
    let by_group = |groups: &[bool], group: i32| {
        let place = usize::try_from(group).unwrap_or_default().min(5);
        GROUPS[usize::from(groups.get(place).copied().unwrap_or_default())]
    };
    for group in &mut arrays.tendon_group {
        *group = by_group(&shown[2], *group);
    }
    for skin in &mut arrays.skins {
        skin.group = by_group(&shown[3], skin.group);
    }
}

impl Current {
    fn replace(&mut self, model: Model) {
        self.model = Arc::new(model);
        self.soft = soft(&self.model);
        self.version += 1;
    }
}

#[pymethods]
impl PhysicsModel {
    /// Compiles a file. Includes and textures are found as MuJoCo finds them.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (assets, name) =
            FileSystem::beside(&path).map_err(|e| PyValueError::new_err(format!("{}: {e}", path.display())))?;
        let compiled = || {
            load(&assets, &name)
                .and_then(compile)
                .map_err(|error| error.in_folder(assets.folder()))
        };
        let model = detached(py, compiled)?;
        Self::made(py, model, Arc::new(assets))
    }

    /// Compiles a text, with files that replace those in and around a folder that it names.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: &str, files: HashMap<String, Vec<u8>>, folder: PathBuf) -> PyResult<Self> {
        let assets = GivenFiles::new(files, folder)?;
        let model = detached(py, || load_str(text, "model.xml", &assets).and_then(compile))?;
        Self::made(py, model, Arc::new(assets))
    }

    /// Returns a separate model with the same numbers.
    fn copy(&self, py: Python<'_>) -> PyResult<Self> {
        let now = self.now(py)?;
        Self::made(py, (*now.model).clone(), self.assets.clone())
    }

    /// Returns the memory of the numbers that a program may change; steps read them.
    #[getter]
    fn memory<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.memory.bind(py).clone()
    }

    /// Returns names and shapes of the arrays in the memory, in order.
    #[getter]
    fn layout(&self) -> Vec<(&'static str, Vec<usize>)> {
        model_layout(&self.current().model)
    }

    /// Returns the arrays of other types that a program may change, by name: colours, groups, materials, lights, equalities, keyframes.
    #[getter]
    fn columns<'py>(&self, py: Python<'py>) -> Bound<'py, PyDict> {
        self.columns.views(py)
    }

    #[classattr]
    #[allow(non_snake_case)]
    fn ARRAYS() -> Vec<&'static str> {
        [model::ARRAYS, ARRAYS].concat()
    }

    /// Returns a compiled array by name.
    fn array<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let model = self.current().model.clone();
        if ARRAYS.contains(&name) {
            array(py, &model, name)
        } else {
            model::array(py, &model, name)
        }
    }

    /// Returns the arrays of meshes, height fields and skins under MuJoCo's names.
    fn shapes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        shapes(py, &self.current().model.clone())
    }

    /// Returns the names of all elements, by kind.
    fn names<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let m = self.current().model.clone();
        let names = model::names(py, &m)?;
        let list = |names: Vec<&str>| names.into_iter().map(str::to_owned).collect::<Vec<_>>();
        names.set_item("texture", list(m.textures.iter().map(|t| &t.name[..]).collect()))?;
        names.set_item("material", list(m.materials.iter().map(|t| &t.name[..]).collect()))?;
        names.set_item("light", list(m.lights.iter().map(|l| &l.name[..]).collect()))?;
        names.set_item("mesh", list(m.meshes.iter().map(|mesh| &mesh.name[..]).collect()))?;
        names.set_item("hfield", list(m.hfields.iter().map(|field| &field.name[..]).collect()))?;
        names.set_item("skin", list(m.skins.iter().map(|skin| &skin.name[..]).collect()))?;
        names.set_item("key", list(m.keys.iter().map(|k| &k.name[..]).collect()))?;
        names.set_item("numeric", &m.numeric_name)?;
        names.set_item("text", &m.text_name)?;
        Ok(names)
    }

    /// Returns sizes, options, statistics and visual settings that are in no array.
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        settings(py, &self.current().model.clone())
    }

    /// Sets a whole number among the options.
    fn set_option(&self, name: &str, value: i64) -> PyResult<()> {
        let mut current = self.current();
        let model = with_option(&current.model, name, value)?;
        current.replace(model);
        Ok(())
    }

    /// Returns as MuJoCo's arrays the values that the engine stores in another form: equalities, lights, materials, tendons, keyframes,
    /// data for programs.
    fn extras<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let m = self.current().model.clone();
        let all = extras(py, &m)?;
        let kinds = |modes: Vec<i32>| PyArray1::from_vec(py, modes);
        all.set_item("cam_mode", kinds(m.cam_mode.iter().map(|mode| mode.code()).collect()))?;
        all.set_item("light_mode", kinds(m.lights.iter().map(|l| l.mode.code()).collect()))?;
        macro_rules! rows {
            ($($name:literal $list:ident $field:ident)*) => {$({
                let rows: Vec<_> = m.$list.iter().map(|x| x.$field.clone()).collect();
                all.set_item($name, rows[..].to_array(py)?)?;
            })*};
        }
        rows! {
            "light_bodyid" lights bodyid "light_targetbodyid" lights targetbodyid "light_directional" lights directional
            "light_castshadow" lights castshadow "light_pos0" lights pos0 "light_poscom0" lights poscom0 "light_dir0" lights dir0
        }
        let poses = |of: fn(&Keyframe) -> &[f64]| PyArray1::from_iter(py, m.keys.iter().flat_map(of).copied());
        all.set_item("key_mpos", poses(|key| key.mpos.as_flattened()))?;
        all.set_item("key_mquat", poses(|key| key.mquat.as_flattened()))?;
        let wraps: Vec<_> = m.tendon_wrap.iter().flatten().collect();
        let numbers: Vec<usize> = m.tendon_wrap.iter().map(Vec::len).collect();
        all.set_item("tendon_num", numbers[..].to_array(py)?)?;
        let wraps: Vec<(i32, i32)> = wraps.into_iter().map(wrap).collect();
        all.set_item("wrap_type", PyArray1::from_iter(py, wraps.iter().map(|w| w.0)))?;
        all.set_item("wrap_objid", PyArray1::from_iter(py, wraps.iter().map(|w| w.1)))?;
        let stages = m.sensor_datatype.iter().map(|kind| *kind as i32);
        all.set_item("sensor_datatype", PyArray1::from_iter(py, stages))?;
        let dims = m.sensor_dim.iter().map(|dim| *dim as i32);
        all.set_item("sensor_dim", PyArray1::from_iter(py, dims))?;
        all.set_item("numeric_data", m.numeric_data.clone())?;
        all.set_item("text_data", &m.text_data)?;
        let patterns: Option<Vec<usize>> = m.textures.iter().map(pattern_numbers).collect();
        if let Some(numbers) = patterns {
            all.set_item("ntexdata", numbers.iter().sum::<usize>())?;
        }
        Ok(all)
    }
}

/// Returns how many numbers a pattern has, the six sides of a cube one below another; `None` for an image, whose file has its size.
fn pattern_numbers(texture: &Texture) -> Option<usize> {
    let sides = if texture.kind == TextureType::Flat2d { 1 } else { 6 };
    let image = texture.file.is_some() || texture.cube_files.iter().any(Option::is_some);
    let height = if sides == 6 {
        sides * texture.width
    } else {
        texture.height
    };
    (!image).then_some(texture.width * height * texture.channels)
}

/// Returns MuJoCo's type and object of the elements that a tendon runs along.
fn wrap(wrap: &Wrap) -> (i32, i32) {
    match *wrap {
        Wrap::Joint { joint, .. } => (1, joint as i32),
        Wrap::Pulley { .. } => (2, -1),
        Wrap::Site { site } => (3, site as i32),
        Wrap::Sphere { geom, .. } => (4, geom as i32),
        Wrap::Cylinder { geom, .. } => (5, geom as i32),
    }
}

/// Returns the parameters of a model, with equalities as a program has switched them.
pub fn params(model: &Model, active: &[u8]) -> Params {
    let mut params = Params::new(model);
    // MuJoCo weighs centres of mass by the current masses, not by those of the document
    params.body_subtreemass.clone_from(&params.body_mass);
    for body in (1..model.nbody()).rev() {
        params.body_subtreemass[model.body_parentid[body]] += params.body_subtreemass[body];
    }
    for (to, &on) in params.eq_active.iter_mut().zip(active) {
        *to = on != 0;
    }
    params
}

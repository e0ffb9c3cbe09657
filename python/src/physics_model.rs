//! Any model, compiled from a document: MuJoCo's `mjModel`.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use babybench::Model;
use babybench::assets::{AssetSource, FileSystem};
use babybench::mjcf_loader::{LoadError, load, load_str};
use babybench::model::{Arrays, Flags, IntegratorType, Keyframe, SensorType, SolverType, Wrap};
use babybench::physics::{Params, SoftModel, SoftOptions, compile};
use babybench::render::{RenderError, Scenery};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyAttributeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::ToArray;
use crate::errors::{IntoException, detached};
use crate::given_files::GivenFiles;
use crate::model::{self, table};
use crate::physics_fields::{model_layout, read_model, write_model};
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
}

/// The parts that change when a program writes into the arrays of a model.
struct Current {
    soft: SoftModel,
    model: Arc<Model>,
    /// The numbers that the model was last made of.
    seen: Vec<f64>,
    version: u64,
    scenery: Option<Arc<Scenery>>,
}

/// A model of any document.
#[pyclass(frozen, module = "babybench_core._native")]
pub struct PhysicsModel {
    current: Mutex<Current>,
    memory: Py<PyArray1<f64>>,
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

impl PhysicsModel {
    fn made(py: Python<'_>, model: Model, assets: Arc<dyn AssetSource>) -> Self {
        let model = Arc::new(model);
        let seen = write_model(&model);
        Self {
            memory: PyArray1::from_slice(py, &seen).unbind(),
            current: Mutex::new(Current {
                soft: soft(&model),
                model,
                seen,
                version: 0,
                scenery: None,
            }),
            assets,
        }
    }

    fn current(&self) -> MutexGuard<'_, Current> {
        self.current.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the model with what a program has written into its arrays.
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
        let Current {
            soft, model, version, ..
        } = &*current;
        Ok(Now {
            soft: soft.clone(),
            model: model.clone(),
            version: *version,
        })
    }

    /// Returns what is drawn of the model.
    pub fn scenery(&self, py: Python<'_>) -> PyResult<Arc<Scenery>> {
        let (known, model) = {
            let current = self.current();
            (current.scenery.clone(), current.model.clone())
        };
        if let Some(scenery) = known {
            return Ok(scenery);
        }
        let scenery = Arc::new(detached(py, || Scenery::new(&model, &*self.assets))?);
        self.current().scenery = Some(scenery.clone());
        Ok(scenery)
    }
}

impl Current {
    fn replace(&mut self, model: Model) {
        self.model = Arc::new(model);
        self.soft = soft(&self.model);
        self.version += 1;
    }
}

/// The flags of a simulation in the order of MuJoCo's `mjtDisableBit`.
fn flags(flags: &mut Flags) -> [&mut bool; 17] {
    [
        &mut flags.constraint,
        &mut flags.equality,
        &mut flags.frictionloss,
        &mut flags.limit,
        &mut flags.contact,
        &mut flags.passive,
        &mut flags.gravity,
        &mut flags.clampctrl,
        &mut flags.warmstart,
        &mut flags.filterparent,
        &mut flags.actuation,
        &mut flags.refsafe,
        &mut flags.sensor,
        &mut flags.midphase,
        &mut flags.eulerdamp,
        &mut flags.autoreset,
        &mut flags.nativeccd,
    ]
}

/// The flags that are off by default, in the order of MuJoCo's `mjtEnableBit`, with the bit of the first. The bits around them are
/// `override`, which is never on, and `island`, which documents alone set.
fn enabled(flags: &mut Flags) -> (usize, [&mut bool; 4]) {
    let flags = [
        &mut flags.energy,
        &mut flags.fwdinv,
        &mut flags.invdiscrete,
        &mut flags.multiccd,
    ];
    (1, flags)
}

/// Returns the bit of islands in MuJoCo's `mjtEnableBit`, if they are on.
fn islands(flags: &Flags) -> usize {
    usize::from(flags.island) << 5
}

#[pymethods]
impl PhysicsModel {
    /// Compiles a file. Includes and textures are found as MuJoCo finds them.
    #[staticmethod]
    fn from_file(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (assets, name) =
            FileSystem::beside(&path).map_err(|e| PyValueError::new_err(format!("{}: {e}", path.display())))?;
        let model = detached(py, || load(&assets, &name).and_then(compile))?;
        Ok(Self::made(py, model, Arc::new(assets)))
    }

    /// Compiles a text, with files that replace those in and around a folder that it names.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: &str, files: HashMap<String, Vec<u8>>, folder: PathBuf) -> PyResult<Self> {
        let assets = GivenFiles::new(files, folder)?;
        let model = detached(py, || load_str(text, "model.xml", &assets).and_then(compile))?;
        Ok(Self::made(py, model, Arc::new(assets)))
    }

    /// Returns a model of its own with the same numbers.
    fn copy(&self, py: Python<'_>) -> PyResult<Self> {
        let now = self.now(py)?;
        Ok(Self::made(py, (*now.model).clone(), self.assets.clone()))
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

    /// Returns sizes, options, statistics and visual settings that no array has.
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let m = self.current().model.clone();
        let settings = model::options(py, &m)?;
        for (name, size) in [
            ("nkey", m.nkey()),
            ("nlight", m.lights.len()),
            ("nexclude", m.exclude.len()),
            ("nmesh", m.nmesh()),
            ("nhfield", m.nhfield()),
            ("nskin", m.nskin()),
        ] {
            settings.set_item(name, size)?;
        }
        let solver = match m.opt.solver {
            SolverType::Pgs => 0,
            SolverType::Cg => 1,
            SolverType::Newton => 2,
        };
        let jacobian = m.opt.jacobian as u8;
        let cone = m.opt.cone as u8;
        let integrator = match m.opt.integrator {
            IntegratorType::Euler => 0,
            IntegratorType::Rk4 => 1,
            IntegratorType::Implicit => 2,
            IntegratorType::ImplicitFast => 3,
        };
        for (name, value) in [
            ("solver", solver),
            ("jacobian", jacobian),
            ("cone", cone),
            ("integrator", integrator),
        ] {
            settings.set_item(name, value)?;
        }
        let mut own = m.opt.flags.clone();
        let bits = flags(&mut own)
            .into_iter()
            .enumerate()
            .map(|(bit, on)| u32::from(!*on) << bit);
        settings.set_item("disableflags", bits.sum::<u32>())?;
        let (first, on) = enabled(&mut own);
        let bits = on
            .into_iter()
            .enumerate()
            .map(|(bit, on)| usize::from(*on) << (first + bit));
        let bits: usize = bits.sum();
        settings.set_item("enableflags", bits | islands(&own))?;
        settings.set_item("noslip_iterations", m.opt.noslip_iterations)?;
        settings.set_item("disableactuator", m.opt.disableactuator)?;
        settings.set_item("nuserdata", m.nuserdata)?;
        for (name, value) in [
            ("meaninertia", m.stat.meaninertia),
            ("meanmass", m.stat.meanmass),
            ("meansize", m.stat.meansize),
            ("fovy", m.vis.fovy),
        ] {
            settings.set_item(name, value)?;
        }
        settings.set_item("center", m.stat.center[..].to_array(py)?)?;
        settings.set_item("offwidth", m.vis.offwidth)?;
        settings.set_item("offheight", m.vis.offheight)?;
        Ok(settings)
    }

    /// Sets a whole number among the options.
    fn set_option(&self, name: &str, value: i64) -> PyResult<()> {
        let refused = || {
            PyAttributeError::new_err(format!(
                "opt.{name} cannot be {value} here: what can be set are iterations, ls_iterations, ccd_iterations and noslip_iterations (0 or more), \
                 integrator (0 Euler, 1 RK4, 2 implicit, 3 implicitfast), disableflags (bits 0 to 16), enableflags (bits 1 to 4) and \
                 disableactuator (bits 0 to 30); set others in the document"
            ))
        };
        let count = usize::try_from(value).map_err(|_| refused())?;
        let mut current = self.current();
        let mut known = true;
        let model = current.model.edited(|arrays| {
            let opt = &mut arrays.opt;
            match (name, count) {
                ("iterations", 0..=1_000_000) => opt.iterations = count,
                ("ls_iterations", 0..=1_000_000) => opt.ls_iterations = count,
                ("ccd_iterations", 0..=1_000_000) => opt.ccd_iterations = count,
                ("integrator", 0) => opt.integrator = IntegratorType::Euler,
                ("integrator", 1) => opt.integrator = IntegratorType::Rk4,
                ("integrator", 2) => opt.integrator = IntegratorType::Implicit,
                ("integrator", 3) => opt.integrator = IntegratorType::ImplicitFast,
                ("noslip_iterations", 0..=1_000_000) => opt.noslip_iterations = count,
                ("disableactuator", 0..0x8000_0000) => opt.disableactuator = count as u32,
                ("enableflags", _) if count & !0b1_1110 == islands(&opt.flags) => {
                    let (first, on) = enabled(&mut opt.flags);
                    for (bit, on) in on.into_iter().enumerate() {
                        *on = count >> (first + bit) & 1 == 1;
                    }
                }
                ("disableflags", 0..0x2_0000) => {
                    for (bit, on) in flags(&mut opt.flags).into_iter().enumerate() {
                        *on = count >> bit & 1 == 0;
                    }
                }
                _ => known = false,
            }
        });
        if !known {
            return Err(refused());
        }
        current.replace(model);
        Ok(())
    }

    /// Returns MuJoCo's arrays of what the engine keeps in another form: equalities, lights, materials, tendons, keyframes, data for
    /// programs.
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
            "light_castshadow" lights castshadow "light_active" lights active "light_pos" lights pos "light_dir" lights dir "light_pos0" lights pos0
            "light_poscom0" lights poscom0 "light_dir0" lights dir0 "light_ambient" lights ambient "light_diffuse" lights diffuse
            "light_specular" lights specular "light_attenuation" lights attenuation "light_cutoff" lights cutoff
            "light_exponent" lights exponent
            "mat_rgba" materials rgba "mat_specular" materials specular "mat_shininess" materials shininess
            "mat_reflectance" materials reflectance "mat_emission" materials emission "mat_texrepeat" materials texrepeat
            "mat_texuniform" materials texuniform
            "key_time" keys time "key_qpos" keys qpos "key_qvel" keys qvel "key_act" keys act "key_ctrl" keys ctrl
        }
        let poses = |of: fn(&Keyframe) -> &[f64]| PyArray1::from_iter(py, m.keys.iter().flat_map(of).copied());
        all.set_item("key_mpos", poses(|key| key.mpos.as_flattened()))?;
        all.set_item("key_mquat", poses(|key| key.mquat.as_flattened()))?;
        let wraps: Vec<_> = m.tendon_wrap.iter().flatten().collect();
        let numbers: Vec<usize> = m.tendon_wrap.iter().map(Vec::len).collect();
        all.set_item("tendon_num", numbers[..].to_array(py)?)?;
        let wraps: Vec<(i32, i32, f64)> = wraps.into_iter().map(wrap).collect();
        all.set_item("wrap_type", PyArray1::from_iter(py, wraps.iter().map(|w| w.0)))?;
        all.set_item("wrap_objid", PyArray1::from_iter(py, wraps.iter().map(|w| w.1)))?;
        all.set_item("wrap_prm", PyArray1::from_iter(py, wraps.iter().map(|w| w.2)))?;
        let stages = m.sensor_datatype.iter().map(|kind| *kind as i32);
        all.set_item("sensor_datatype", PyArray1::from_iter(py, stages))?;
        let dims = m.sensor_dim.iter().map(|dim| *dim as i32);
        all.set_item("sensor_dim", PyArray1::from_iter(py, dims))?;
        all.set_item("numeric_data", m.numeric_data.clone())?;
        all.set_item("text_data", &m.text_data)?;
        Ok(all)
    }
}

/// Returns MuJoCo's type, object and parameter of what a tendon runs along.
fn wrap(wrap: &Wrap) -> (i32, i32, f64) {
    let side = |side: Option<usize>| side.map_or(-1.0, |site| site as f64);
    match *wrap {
        Wrap::Joint { joint, coef } => (1, joint as i32, coef),
        Wrap::Pulley { divisor } => (2, -1, divisor),
        Wrap::Site { site } => (3, site as i32, 0.0),
        Wrap::Sphere { geom, side: site } => (4, geom as i32, side(site)),
        Wrap::Cylinder { geom, side: site } => (5, geom as i32, side(site)),
    }
}

/// Returns the parameters of a model, with equalities as a program has switched them.
pub fn params(model: &Model, active: &[u8]) -> Params {
    let mut params = Params::new(model);
    // MuJoCo weighs centres of mass by the masses of now, not by those of the document
    params.body_subtreemass.clone_from(&params.body_mass);
    for body in (1..model.nbody()).rev() {
        params.body_subtreemass[model.body_parentid[body]] += params.body_subtreemass[body];
    }
    for (to, &on) in params.eq_active.iter_mut().zip(active) {
        *to = on != 0;
    }
    params
}

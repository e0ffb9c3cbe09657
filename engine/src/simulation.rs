//! A model, its state and an engine in one value.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

use mjcf_sim_loader::{LoadError, load, load_str};
use mjcf_sim_model::Model;
use mjcf_sim_model::assets::{AssetError, AssetSource, FileSystem, MemoryAssets};
use mjcf_sim_model::math::Vec3;
use mjcf_sim_physics::{Engine, EngineError, RayHit, SoftEngine, SoftOptions, State, compile, ray};
use mjcf_sim_render::{FreeCamera, Poses, RenderError, RenderRequest, Renderer, Scenery, View};

/// A simulated scene: a compiled model, its state, the engine that steps it, and the textures to draw it with.
///
/// It is the short way. The parts work alone, too: [`physics::SoftEngine`](crate::physics::SoftEngine) steps any number of states,
/// [`physics::Batch`](crate::physics::Batch) many at once, and [`render::Renderer`](crate::render::Renderer) draws into buffers
/// of yours.
///
/// ```
/// use mjcf_sim::Simulation;
///
/// let mut ball = Simulation::from_text("<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>")?;
/// ball.run(100)?; // 0.2 s at the default time step of 2 ms
/// assert!((ball.state.qvel[2] + 9.81 * 0.2).abs() < 1e-9);
/// # Ok::<(), mjcf_sim::SimulationError>(())
/// ```
pub struct Simulation {
    /// Everything that changes while the scene runs, under MuJoCo's names: write `ctrl`, `qpos`, `xfrc_applied`; read `sensordata`,
    /// `xpos`, `contact`.
    pub state: State,
    engine: SoftEngine,
    assets: Arc<dyn AssetSource>,
    renderer: Option<Renderer>,
}

/// An error of a [`Simulation`].
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum SimulationError {
    /// The path of the document is invalid.
    #[error(transparent)]
    Asset(#[from] AssetError),
    /// The document cannot be loaded or compiled.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// The state cannot be stepped.
    #[error(transparent)]
    Engine(#[from] EngineError),
    /// The scene cannot be drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// The model has no element of this name.
    #[error("the model has no {kind} {name:?}; it has {}", listed(.names))]
    Unknown {
        /// Kind of the element.
        kind: &'static str,
        /// The requested name.
        name: String,
        /// The names of all elements of the kind.
        names: Vec<String>,
    },
}

/// Checks the length of a vector of the state, which a program may replace.
fn fits(what: &'static str, found: usize, expected: usize) -> Result<(), EngineError> {
    if found == expected {
        Ok(())
    } else {
        Err(EngineError::Shape { what, found, expected })
    }
}

/// Lists names for a message.
fn listed(names: &[String]) -> String {
    let named: Vec<_> = names
        .iter()
        .filter(|name| !name.is_empty())
        .map(|name| format!("{name:?}"))
        .collect();
    if named.is_empty() {
        "none with a name".to_owned()
    } else {
        named.join(", ")
    }
}

/// The same text as `Display`, so that a program whose `main` returns the error prints the sentence.
impl fmt::Debug for SimulationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Debug for Simulation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let model = self.model();
        f.debug_struct("Simulation")
            .field("model", &model.name)
            .field("nq", &model.nq)
            .field("nv", &model.nv)
            .field("time", &self.state.time)
            .finish_non_exhaustive()
    }
}

impl Simulation {
    /// Loads an MJCF document with the default [`Limits`](crate::Limits). Files that it names start at its folder, as in MuJoCo, and may lie
    /// above it (`../`) or anywhere (absolute paths). For untrusted documents, use [`DirAssets`](crate::assets::DirAssets), which stays
    /// within its folder, with [`mjcf_loader::load`](crate::mjcf_loader::load()) and [`Simulation::new`].
    ///
    /// # Errors
    /// A file that is missing or too large; a document that is not understood or cannot be compiled, with its place.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, SimulationError> {
        let (assets, file) = FileSystem::beside(path)?;
        let model = load(&assets, &file)
            .and_then(compile)
            .map_err(|error| error.in_folder(assets.folder()))?;
        Ok(Self::new(Arc::new(model), Arc::new(assets)))
    }

    /// Loads an MJCF document from text with the default [`Limits`](crate::Limits); it has no other files. [`Simulation::new`] has an example with
    /// meshes in memory.
    ///
    /// # Errors
    /// A document that is not understood or cannot be compiled, with its place.
    pub fn from_text(mjcf: &str) -> Result<Self, SimulationError> {
        let assets = MemoryAssets::new();
        let model = compile(load_str(mjcf, "model.xml", &assets)?)?;
        Ok(Self::new(Arc::new(model), Arc::new(assets)))
    }

    /// Simulates a compiled model with the default [`SoftOptions`]; `assets` has the files that its document named.
    ///
    /// ```
    /// use std::sync::Arc;
    ///
    /// use mjcf_sim::assets::MemoryAssets;
    /// use mjcf_sim::mjcf_loader::load_str;
    /// use mjcf_sim::{Simulation, physics};
    ///
    /// let text = r#"<mujoco><asset><mesh name="tetrahedron" file="t.obj"/></asset>
    ///   <worldbody><body><freejoint/><geom type="mesh" mesh="tetrahedron"/></body></worldbody></mujoco>"#;
    /// let mut assets = MemoryAssets::new();
    /// assets.insert("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")?;
    /// let model = physics::compile(load_str(text, "model.xml", &assets)?)?;
    /// let scene = Simulation::new(Arc::new(model), Arc::new(assets));
    /// assert!((scene.model().body_mass[1] - 1000.0 / 6.0).abs() < 1e-5, "a sixth of a cubic metre of water");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new(model: Arc<Model>, assets: Arc<dyn AssetSource>) -> Self {
        Self::with_options(model, assets, SoftOptions::default())
    }

    /// Simulates a compiled model with options of the engine, such as forces on bodies in every step
    /// ([`SoftOptions::post_constraint`]).
    pub fn with_options(model: Arc<Model>, assets: Arc<dyn AssetSource>, options: SoftOptions) -> Self {
        let engine = SoftEngine::new(model, options);
        let mut simulation = Self {
            state: engine.new_state(),
            engine,
            assets,
            renderer: None,
        };
        simulation.settle();
        simulation
    }

    /// Computes the poses, sensors and contacts of a new state, which may be drawn before the first step.
    fn settle(&mut self) {
        // an error is that of the first step, too, which returns it
        let _ = self.engine.forward(&mut self.state);
    }

    /// Returns the engine, for the quantities that it computes on request: [`full_m`](crate::physics::Engine::full_m),
    /// [`efc_j`](crate::physics::Engine::efc_j).
    pub fn engine(&self) -> &SoftEngine {
        &self.engine
    }

    /// Returns the compiled model.
    pub fn model(&self) -> &Arc<Model> {
        self.engine.model()
    }

    /// Advances by one time step of the model (`model().opt.timestep`, s).
    ///
    /// Sensors, contacts and poses are those of the start of the step, as in MuJoCo; [`forward`](Self::forward) computes those of the
    /// end.
    ///
    /// # Errors
    /// Numbers in the state that are not finite, or a motion that diverges.
    #[doc(alias = "mj_step")]
    pub fn step(&mut self) -> Result<(), SimulationError> {
        Ok(self.engine.step(&mut self.state)?)
    }

    /// Advances by `steps` time steps, and computes sensors, contacts and poses at their end.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    pub fn run(&mut self, steps: usize) -> Result<(), SimulationError> {
        for _ in 0..steps {
            self.step()?;
        }
        self.forward()
    }

    /// Computes everything that follows from positions, velocities and controls, without advancing.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    #[doc(alias = "mj_forward")]
    pub fn forward(&mut self) -> Result<(), SimulationError> {
        Ok(self.engine.forward(&mut self.state)?)
    }

    /// Restarts at `qpos0`, at rest.
    #[doc(alias = "mj_resetData")]
    pub fn reset(&mut self) {
        self.state = self.engine.new_state();
        self.settle();
    }

    /// Restarts at a keyframe.
    ///
    /// # Errors
    /// The model has no keyframe with this name.
    #[doc(alias = "mj_resetDataKeyframe")]
    pub fn reset_to(&mut self, keyframe: &str) -> Result<(), SimulationError> {
        let key = self.model().key(keyframe);
        let names = |model: &Model| model.keys.iter().map(|key| key.name.clone()).collect();
        let key = key.ok_or_else(|| unknown("keyframe", keyframe, names(self.model())))?;
        self.engine.reset_to_keyframe(&mut self.state, key)?;
        self.settle();
        Ok(())
    }

    /// Returns the reading of a sensor at the start of the last step, or at the last [`forward`](Self::forward).
    ///
    /// # Errors
    /// The model has no sensor with this name, or [`state`](Self::state) is of another model.
    pub fn sensor(&self, name: &str) -> Result<&[f64], SimulationError> {
        let model = self.engine.model();
        let sensor = model
            .sensor(name)
            .ok_or_else(|| unknown("sensor", name, model.sensor_name.clone()))?;
        let start = model.sensor_adr[sensor];
        let (found, expected) = (self.state.sensordata.len(), model.nsensordata());
        fits("sensordata", found, expected)?;
        Ok(&self.state.sensordata[start..start + model.sensor_dim[sensor]])
    }

    /// Returns the first geom that a ray meets from `origin` (m) along `direction`, world frame; see [`physics::ray`](crate::physics::ray).
    ///
    /// # Errors
    /// [`state`](Self::state) is of another model.
    #[doc(alias = "mj_ray")]
    pub fn ray(&self, origin: Vec3, direction: Vec3) -> Result<Option<RayHit>, SimulationError> {
        Ok(ray(self.model(), &self.state, origin, direction, None)?)
    }

    /// Sets the control of an actuator for the following steps.
    ///
    /// # Errors
    /// The model has no actuator with this name, or [`state`](Self::state) is of another model.
    pub fn set_control(&mut self, actuator: &str, value: f64) -> Result<(), SimulationError> {
        let model = self.engine.model();
        let id = model.actuator(actuator);
        let id = id.ok_or_else(|| unknown("actuator", actuator, model.actuator_name.clone()))?;
        fits("ctrl", self.state.ctrl.len(), model.nu())?;
        self.state.ctrl[id] = value;
        Ok(())
    }

    /// Draws the scene from a camera of the model, or from the initial view of MuJoCo's viewer: red, green and blue of each
    /// pixel, rows from the top (height, width, 3).
    ///
    /// Poses are those of the last step or [`forward`](Self::forward). The first picture decodes the textures.
    ///
    /// # Errors
    /// The model has no camera with this name, a texture is broken, or a side has 0 or more than
    /// [`MAX_SIZE`](crate::render::MAX_SIZE) pixels.
    #[doc(alias("mjr_render", "mjv_updateScene"))]
    pub fn draw(&mut self, camera: Option<&str>, width: usize, height: usize) -> Result<Vec<u8>, SimulationError> {
        let model = self.engine.model().clone();
        let id = |name: &str| {
            model
                .camera(name)
                .ok_or_else(|| unknown("camera", name, model.cam_name.clone()))
        };
        let view = View {
            camera: camera.map(id).transpose()?.unwrap_or(View::FREE),
            width,
            height,
        };
        view.check()?;
        let renderer = match &mut self.renderer {
            Some(renderer) => renderer,
            none => none.insert(Renderer::cpu(Arc::new(Scenery::new(&model, &*self.assets)?))),
        };
        let mut poses = Poses::from(&self.state);
        poses.free = Some(FreeCamera::of(&model).pose()?);
        let mut rgb = vec![0; view.rgb_len()];
        renderer.rgb(&[RenderRequest { poses, view }], [&mut rgb[..]])?;
        Ok(rgb)
    }
}

fn unknown(kind: &'static str, name: &str, names: Vec<String>) -> SimulationError {
    SimulationError::Unknown {
        kind,
        name: name.to_owned(),
        names,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ARM: &str = r#"<mujoco>
      <worldbody><light pos="0 0 3"/><camera name="side" pos="0 -3 0" xyaxes="1 0 0 0 0 1"/>
        <body name="arm"><joint name="hinge" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 1 0 0" size=".1"/></body></worldbody>
      <actuator><motor name="shoulder" joint="hinge"/></actuator>
      <sensor><jointpos name="angle" joint="hinge"/></sensor>
      <keyframe><key name="down" qpos="1.5"/></keyframe></mujoco>"#;

    #[test]
    fn sensors_are_those_of_the_end_of_a_run() -> Result<(), SimulationError> {
        let mut arm = Simulation::from_text(ARM)?;
        arm.run(50)?;
        assert_eq!(arm.sensor("angle")?, &arm.state.qpos[..]);
        assert!(arm.state.qpos[0] > 0.0, "it falls");
        arm.reset_to("down")?;
        arm.forward()?;
        assert_eq!(arm.sensor("angle")?, [1.5]);
        arm.reset();
        assert_eq!((arm.state.qpos[0], arm.state.time), (0.0, 0.0));
        Ok(())
    }

    #[test]
    fn a_control_moves_the_arm_against_its_weight() -> Result<(), SimulationError> {
        let mut arm = Simulation::from_text(ARM)?;
        arm.set_control("shoulder", -500.0)?;
        arm.run(20)?;
        assert!(arm.state.qpos[0] < 0.0, "it rises");
        Ok(())
    }

    #[test]
    fn names_that_do_not_exist_are_answered_with_those_that_do() -> Result<(), SimulationError> {
        let mut arm = Simulation::from_text(ARM)?;
        let errors = [
            arm.sensor("angel").map(|_| ()),
            arm.set_control("elbow", 0.0),
            arm.reset_to("up"),
            arm.draw(Some("front"), 8, 8).map(|_| ()),
        ];
        let said: Vec<_> = errors
            .into_iter()
            .map(|e| e.expect_err("no such name").to_string())
            .collect();
        assert_eq!(
            said,
            [
                r#"the model has no sensor "angel"; it has "angle""#,
                r#"the model has no actuator "elbow"; it has "shoulder""#,
                r#"the model has no keyframe "up"; it has "down""#,
                r#"the model has no camera "front"; it has "side""#,
            ]
        );
        Ok(())
    }

    #[test]
    fn the_free_camera_looks_where_the_document_says() -> Result<(), SimulationError> {
        let view = |global: &str| {
            let mut scene = Simulation::from_text(&format!(
                "<mujoco><visual><global {global}/></visual><worldbody><light pos='0 0 3'/><geom type='box' size='.1 .2 .3'/></worldbody></mujoco>"
            ))?;
            scene.forward()?;
            scene.draw(None, 32, 24)
        };
        assert_eq!(view("")?, view("azimuth='90' elevation='-45'")?);
        assert_ne!(view("")?, view("azimuth='0'")?);
        assert_ne!(view("")?, view("elevation='-10'")?);
        Ok(())
    }

    #[test]
    fn pictures_show_the_pose_of_the_last_step() -> Result<(), SimulationError> {
        let mut arm = Simulation::from_text(ARM)?;
        arm.forward()?;
        let level = arm.draw(Some("side"), 32, 24)?;
        assert_eq!(level.len(), 32 * 24 * 3);
        arm.reset_to("down")?;
        arm.forward()?;
        assert_ne!(arm.draw(Some("side"), 32, 24)?, level);
        assert_ne!(arm.draw(None, 32, 24)?, level);
        assert!(matches!(
            arm.draw(None, 0, 24),
            Err(SimulationError::Render(RenderError::Size { .. }))
        ));
        Ok(())
    }
}

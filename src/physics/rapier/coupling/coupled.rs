//! A coupled model with its state and engine.

use std::sync::Arc;

use mjcf_sim_loader::edit::{Document, EditError, ElementId};
use mjcf_sim_model::Model;
use mjcf_sim_model::assets::{AssetSource, MemoryAssets};
use mjcf_sim_physics::{Engine, SoftEngine, SoftOptions, State, compile};
use rapier3d_f64::parry::math::Pose;

use super::{Coupling, CouplingError, CouplingOptions, WorldSets};

/// A model in a Rapier world of your own, solved by our engine, with contacts that push both ways.
///
/// ```
/// use mjcf_sim::assets::MemoryAssets;
/// use mjcf_sim::mjcf_loader::edit::Document;
/// use mjcf_sim::rapier::rapier3d_f64::prelude::*;
/// use mjcf_sim::rapier::{CoupledSimulation, CouplingOptions, WorldSets};
///
/// // a tray on a spring, in MJCF
/// let tray = "<mujoco><worldbody><body name='tray' pos='0 0 1'>
///   <joint type='slide' axis='0 0 1' stiffness='200' damping='20'/><geom type='box' size='.3 .3 .02' mass='1'/></body></worldbody></mujoco>";
/// let tray = Document::read_str(tray, "tray.xml", &MemoryAssets::new())?;
///
/// // a ball in your world
/// let mut world = PhysicsWorld::new();
/// world.gravity = Vector::new(0.0, 0.0, -9.81);
/// world.integration_parameters.dt = 0.002;
/// let ball = RigidBodyBuilder::dynamic().translation(Vector::new(0.0, 0.0, 1.3));
/// let (ball, _) = world.insert(ball, ColliderBuilder::ball(0.05).density(1000.0));
///
/// let (options, here) = (CouplingOptions::default(), Pose::IDENTITY);
/// let mut tray = CoupledSimulation::join(&tray, &MemoryAssets::new(), &mut WorldSets::from(&mut world), here, options)?;
/// for _ in 0..1000 {
///     tray.step(&mut WorldSets::from(&mut world))?;
///     world.step();
/// }
/// let height = world.bodies[ball].translation().z;
/// assert!(height > 0.9 && height < 1.05, "the ball lies on the tray, at {height} m");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct CoupledSimulation {
    /// The state of the model: write `ctrl`, read `qpos`, `sensordata`, `contact`. Positions are in the frame of the model.
    pub state: State,
    engine: SoftEngine,
    options: SoftOptions,
    coupling: Coupling,
}

impl std::fmt::Debug for CoupledSimulation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CoupledSimulation")
            .field("time", &self.state.time)
            .field("coupling", &self.coupling)
            .finish_non_exhaustive()
    }
}

/// A copy continues as the original does, in a copy of the world.
impl Clone for CoupledSimulation {
    fn clone(&self) -> Self {
        Self {
            state: self.state.clone(),
            engine: SoftEngine::new(self.engine.model().clone(), self.options),
            options: self.options,
            coupling: self.coupling.clone(),
        }
    }
}

/// Adds slots to a document.
fn with_slots(document: &Document, options: &CouplingOptions) -> Result<Document, EditError> {
    let mut document = document.clone();
    for section in document.children(document.root())? {
        // their positions would lack those of the slots
        if document.element(section)? == "keyframe" {
            document.remove(section)?;
        }
    }
    let text = format!("<mujoco><worldbody>{}</worldbody></mujoco>", options.slots());
    let slots = Document::read_str(&text, "slots.xml", &MemoryAssets::new())?;
    copy_children(&mut document, &slots, slots.world())?;
    Ok(document)
}

/// Copies the world of a document into that of another. The documents' settings do not matter, because slots state all their numbers.
fn copy_children(to: &mut Document, from: &Document, world: ElementId) -> Result<(), EditError> {
    let mut open = vec![(world, to.world())];
    while let Some((source, target)) = open.pop() {
        for child in from.children(source)? {
            let copy = to.add(target, from.element(child)?)?;
            for (name, value) in from.attributes(child)? {
                to.set(copy, name, value)?;
            }
            open.push((child, copy));
        }
    }
    Ok(())
}

impl CoupledSimulation {
    /// Compiles a document with slots and inserts the model into a world, at `qpos0`. `frame` is the frame of the model in the world; in
    /// worlds whose y points up it turns z into y. Files that the document names are looked up in `assets`. Its keyframes are left out.
    ///
    /// # Errors
    /// A document that does not compile; options or a frame out of range; a world whose time step is not a multiple of the model's.
    pub fn join(
        document: &Document,
        assets: &dyn AssetSource,
        sets: &mut WorldSets<'_>,
        frame: Pose,
        options: CouplingOptions,
    ) -> Result<Self, CouplingError> {
        let spec = with_slots(document, &options).and_then(|document| document.compile(assets));
        let model = compile(spec.map_err(Box::new)?).map_err(Box::new)?;
        Self::insert(Arc::new(model), sets, frame, options)
    }

    /// Inserts a compiled model with [`CouplingOptions::slots`] into a world, at `qpos0`.
    ///
    /// # Errors
    /// As [`Coupling::join`] and [`Coupling::steps`].
    pub fn insert(
        model: Arc<Model>,
        sets: &mut WorldSets<'_>,
        frame: Pose,
        options: CouplingOptions,
    ) -> Result<Self, CouplingError> {
        Coupling::steps(&model, sets.dt)?;
        // programs may read accelerations and wrenches of bodies, even if no sensor of the model does
        let engine_options = SoftOptions {
            post_constraint: true,
            ..SoftOptions::default()
        };
        let engine = SoftEngine::new(model, engine_options);
        let state = engine.new_state();
        let coupling = Coupling::join(engine.model(), engine.topology(), &state, sets, frame, options)?;
        Ok(Self {
            state,
            engine,
            options: engine_options,
            coupling,
        })
    }

    /// Advances the model by the time step of the world, and gives the bodies that touch it their impulses. The program steps its world
    /// afterwards.
    ///
    /// # Errors
    /// Those of [`Coupling::update`], which change nothing. Those of the engine, after which the state has to be reset.
    pub fn step(&mut self, sets: &mut WorldSets<'_>) -> Result<(), CouplingError> {
        self.engine.check_shape(&self.state)?;
        let steps = Coupling::steps(self.engine.model(), sets.dt)?;
        if let Some(model) = self.coupling.update(self.engine.model(), &self.state, sets)? {
            self.engine = SoftEngine::new(Arc::new(model), self.options);
            self.coupling.adopt(self.engine.model(), &mut self.state.params);
        }
        self.coupling.load(&mut self.state, sets);
        for _ in 0..steps {
            self.engine.step(&mut self.state)?;
            self.coupling.record(self.engine.model(), &self.state);
        }
        self.coupling.unload(self.engine.model(), &self.state, sets)
    }

    /// Applies the rest of the impulses to the bodies of the world after its step; see [`Coupling::unload`]. Otherwise the next
    /// [`CoupledSimulation::step`] applies them.
    pub fn finish(&mut self, sets: &mut WorldSets<'_>) {
        self.coupling.finish(sets);
    }

    /// Returns the model. Its slots change as neighbors come and go; its sizes, ids and names stay.
    pub fn model(&self) -> &Arc<Model> {
        self.engine.model()
    }

    /// Returns the engine, which answers questions about the model.
    pub fn engine(&self) -> &SoftEngine {
        &self.engine
    }

    /// Returns the coupling: neighbors, impulses, colliders.
    pub fn coupling(&self) -> &Coupling {
        &self.coupling
    }

    /// Returns the coupling, to restore a snapshot.
    pub fn coupling_mut(&mut self) -> &mut Coupling {
        &mut self.coupling
    }

    /// Removes the model from the world.
    pub fn leave(self, sets: &mut WorldSets<'_>) {
        self.coupling.leave(sets);
    }
}

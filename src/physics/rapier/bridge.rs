//! The bridge between a state and a Rapier world.

use std::sync::Arc;

use rapier3d_f64::dynamics::{FrictionModel, IntegrationParameters};
use rapier3d_f64::geometry::NarrowPhase;
use rapier3d_f64::pipeline::{EventHandler, PhysicsWorld};

use crate::bodies::RapierBodies;
use crate::contacts::{ContactHooks, ContactTargets, read_contacts};
use crate::rows::{RapierRows, read_welds, softness};
use crate::{ContactDispatcher, RapierError, RapierOptions, RapierSets};
use mjcf_sim_model::model::Model;
use mjcf_sim_physics::EngineError;
use mjcf_sim_physics::collision::{PairTable, Sweep, contact_options};
use mjcf_sim_physics::constraint::RowBuilder;
use mjcf_sim_physics::contact::{ContactOptions, Quirks};
use mjcf_sim_physics::dynamics::*;
use mjcf_sim_physics::engine::{Stage, check_contacts, check_input, check_motion, check_output};
use mjcf_sim_physics::params::Params;
use mjcf_sim_physics::state::{RESERVED_CONTACTS, State};
use mjcf_sim_physics::topology::Topology;

/// A model in a Rapier world that may contain other bodies. It passes a [`State`] to Rapier before a step of the world and reads the result.
///
/// [`Bridge::step`] advances a `PhysicsWorld`. Where the sets are your own, a step is [`Bridge::before`],
/// `PhysicsPipeline::step` with [`Bridge::hooks`] and [`Bridge::parameters`], [`Bridge::after`], [`Bridge::advance`],
/// with [`Bridge::narrow_phase`] for MuJoCo's contact geometry. The state leads: poses in the world are overwritten by
/// the next step.
///
/// See `examples/own_world.rs`.
pub struct Bridge {
    model: Arc<Model>,
    topology: Arc<Topology>,
    pairs: Arc<PairTable>,
    rig: Arc<RapierBodies>,
    options: RapierOptions,
    contact: ContactOptions,
    sweep: Sweep,
    rows: RapierRows,
    aims: ContactTargets,
    integrator: Integrator,
    composite: CompositeInertia,
    bias: BiasScratch,
    sensor_scratch: SensorScratch,
    builder: RowBuilder,
    inertia: Articulated,
    force: Vec<f64>,
    velocity: Vec<f64>,
    stranger: Option<usize>,
}

impl std::fmt::Debug for Bridge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Bridge")
            .field("options", &self.options)
            .finish_non_exhaustive()
    }
}

impl Bridge {
    /// Inserts `model` into a world.
    ///
    /// The gravity of the model acts on its bodies, and that of the world on all others.
    ///
    /// # Errors
    /// Fails if the model has elements that Rapier's multibodies cannot represent.
    pub fn insert(model: Arc<Model>, options: RapierOptions, sets: &mut RapierSets) -> Result<Self, RapierError> {
        let topology = Topology::new(&model);
        let rig = RapierBodies::insert(&model, &topology, sets)?;
        let pairs = Arc::new(PairTable::new(&model));
        Ok(Self::new(model, Arc::new(topology), pairs, Arc::new(rig), options))
    }

    pub(super) fn new(
        model: Arc<Model>,
        topology: Arc<Topology>,
        pairs: Arc<PairTable>,
        rig: Arc<RapierBodies>,
        options: RapierOptions,
    ) -> Self {
        let contact = contact_options(&model, Quirks::default());
        Self {
            sweep: Sweep::new(&model, &pairs, contact),
            rows: RapierRows::default(),
            aims: ContactTargets::default(),
            integrator: Integrator::default(),
            composite: CompositeInertia::default(),
            bias: BiasScratch::default(),
            sensor_scratch: SensorScratch::default(),
            builder: RowBuilder::new(&model, &topology),
            inertia: Articulated::new(&model),
            force: Vec::with_capacity(model.nv),
            velocity: vec![0.0; model.nv],
            stranger: (0..model.ngeom()).find(|&g| model.geom_bodyid[g] == 0),
            model,
            topology,
            pairs,
            rig,
            options,
            contact,
        }
    }

    /// Returns the compiled model.
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Returns the topology of the model's kinematic tree.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Returns the geom pairs that may touch, in contact order.
    pub fn pairs(&self) -> &PairTable {
        &self.pairs
    }

    /// Returns the model's bodies and colliders in the world.
    pub fn rig(&self) -> &RapierBodies {
        &self.rig
    }

    /// Creates a state at `qpos0`, at rest, with nothing computed yet.
    pub fn new_state(&self) -> State {
        let mut state = State::new(&self.model, &self.topology);
        state.contact.reserve(RESERVED_CONTACTS);
        state
    }

    /// Chooses the geom that represents colliders outside the model in `State::contacts`, by default the first geom of the world. Without one, such
    /// contacts act but are not sensed.
    pub fn set_stranger(&mut self, geom: Option<usize>) {
        self.stranger = geom.filter(|&g| g < self.model.ngeom());
    }

    /// Returns Rapier's parameters: one step without substeps, with all of Rapier's own approximations switched off.
    pub fn parameters(&self) -> IntegrationParameters {
        let (soft, _) = softness(self.options.contact_compliance, self.model.opt.timestep);
        IntegrationParameters {
            dt: self.model.opt.timestep,
            contact_softness: soft,
            static_contact_softness: soft,
            warmstart_coefficient: 0.0,
            num_solver_iterations: 1,
            num_internal_pgs_iterations: self.options.iterations,
            num_internal_stabilization_iterations: 0,
            friction_in_bias_pass: true,
            normalized_max_corrective_velocity: f64::MAX,
            normalized_max_linear_velocity: f64::MAX,
            normalized_prediction_distance: 0.0005,
            max_ccd_substeps: 0,
            contact_clustering: false,
            contact_recycling: false,
            friction_model: FrictionModel::Coulomb,
            ..IntegrationParameters::default()
        }
    }

    /// Creates a narrow phase with MuJoCo's contact geometry between the shapes of a model, and Parry's for others.
    pub fn narrow_phase(&self) -> NarrowPhase {
        NarrowPhase::with_query_dispatcher(ContactDispatcher::new(self.contact).one_point_manifolds())
    }

    /// Sets up a world for the model: time step, solver and narrow phase.
    pub fn configure(&self, world: &mut PhysicsWorld) {
        world.integration_parameters = self.parameters();
        world.narrow_phase = self.narrow_phase();
    }

    /// Advances a world, and with it the state, by one time step.
    ///
    /// # Errors
    /// Fails like [`Bridge::before`] and [`Bridge::after`].
    pub fn step(
        &mut self,
        s: &mut State,
        world: &mut PhysicsWorld,
        events: &dyn EventHandler,
    ) -> Result<(), EngineError> {
        self.before(s, &mut RapierSets::from(&mut *world))?;
        world.step_with_events(&self.hooks(), events);
        let sets = RapierSets {
            bodies: &mut world.bodies,
            colliders: &mut world.colliders,
            impulse_joints: &mut world.impulse_joints,
            multibody_joints: &mut world.multibody_joints,
        };
        self.after(s, &sets, &world.narrow_phase)?;
        self.advance(s)
    }

    /// Computes everything up to the solver from `qpos`, `qvel` and `ctrl`, and loads it into the world.
    ///
    /// # Errors
    /// Fails if the state does not fit the model or is not finite.
    pub fn before(&mut self, s: &mut State, sets: &mut RapierSets) -> Result<(), EngineError> {
        self.compute(s, &mut |_| {})?;
        self.load(s, sets);
        Ok(())
    }

    /// Computes poses, contacts, constraint rows and forces; `stage` is called with each stage that begins.
    pub(super) fn compute(&mut self, s: &mut State, stage: &mut dyn FnMut(Stage)) -> Result<(), EngineError> {
        let (model, topology) = (&*self.model, &*self.topology);
        check_input(model, topology, s)?;
        check_params(model, &s.params)?;
        // values that Rapier cannot handle never reach it
        check_motion(model, s)?;
        stage(Stage::Kinematics);
        kinematics(model, s);
        com_pos(model, s);
        cameras(model, s);
        tendons(model, topology, s);
        crb(model, topology, s, &mut self.composite);
        self.inertia.update(model, s, &self.composite);
        stage(Stage::Collision);
        let flags = &model.opt.flags;
        if self.options.disable_contacts || !flags.contact || !flags.constraint {
            s.contact.clear();
        } else {
            self.sweep.contacts(model, &self.pairs, s)?;
        }
        stage(Stage::Constraints);
        self.builder.build(model, topology, &self.composite, s);
        transmissions(model, topology, s);
        stage(Stage::Forces);
        fwd_velocity(model, topology, s, &mut self.bias);
        fwd_actuation(model, topology, &mut self.inertia, s);
        stage(Stage::Solver);
        Ok(())
    }

    pub(super) fn load(&mut self, s: &State, sets: &mut RapierSets) {
        let (model, topology, h) = (&*self.model, &*self.topology, self.model.opt.timestep);
        self.rig.load(model, topology, s, sets, &mut self.force);
        self.rows.load(&self.rig, model, topology, &mut self.inertia, s, sets);
        let (_, rate) = softness(self.options.contact_compliance, h);
        self.aims.load(s, h, rate);
    }

    /// Returns the hooks for the step that [`Bridge::before`] prepared.
    pub fn hooks(&self) -> ContactHooks<'_> {
        ContactHooks {
            rig: &self.rig,
            aims: &self.aims,
        }
    }

    /// Reads accelerations and the forces of contacts and welds from the world, and computes the quantities that depend on them.
    ///
    /// # Errors
    /// Fails if the simulation diverged.
    pub fn after(&mut self, s: &mut State, sets: &RapierSets, narrow: &NarrowPhase) -> Result<(), EngineError> {
        let (model, h) = (&*self.model, self.model.opt.timestep);
        self.rig.velocities(model, s, sets, &mut self.velocity);
        for d in 0..model.nv {
            s.qacc[d] = (self.velocity[d] - s.qvel[d]) / h;
        }
        s.qacc_warmstart.copy_from_slice(&s.qacc);
        mul_m(&self.topology, &s.qm, &s.qacc, &mut s.qfrc_constraint);
        for (f, smooth) in s.qfrc_constraint.iter_mut().zip(&s.qfrc_smooth) {
            *f -= smooth;
        }
        s.solver_iterations = self.options.iterations;
        read_contacts(&self.hooks(), model, narrow, s, self.stranger);
        read_welds(&self.rig, model, s, sets);
        rne_post_constraint(model, s, &self.bias, self.options.double_weld_torque);
        if model.opt.flags.sensor {
            sensors(model, s, &mut self.sensor_scratch);
        }
        check_output(model, s)?;
        check_contacts(model, s)
    }

    /// Advances the state by a time step with these accelerations, as MuJoCo does, with implicit joint damping.
    ///
    /// # Errors
    /// Fails if the simulation diverged.
    pub fn advance(&mut self, s: &mut State) -> Result<(), EngineError> {
        self.integrator
            .advance(&self.model, &self.topology, &mut self.inertia, s);
        check_output(&self.model, s)
    }
}

/// Refuses parameters that the rig has built in.
fn check_params(model: &Model, p: &Params) -> Result<(), EngineError> {
    let same = [
        ("body_mass", p.body_mass == model.body_mass),
        ("body_inertia", p.body_inertia == model.body_inertia),
        ("geom_size", p.geom_size == model.geom_size),
    ];
    match same.into_iter().find(|(_, same)| !same) {
        Some((what, _)) => Err(EngineError::FixedParameter { what }),
        None => Ok(()),
    }
}

//! The default engine: joint-space dynamics with soft constraints, as MuJoCo formulates them.

use std::sync::Arc;

use crate::collision::{FlexSweep, PairTable, Sweep, contact_options};
use crate::constraint::{DualSolver, NewtonSolver, RowBuilder, contact_forces};
use crate::contact::Quirks;
use crate::dynamics::*;
use crate::engine::{Engine, Probe, Stage, check_contacts, check_evaluation, check_input, check_motion, check_output};
use crate::error::EngineError;
use crate::model::{IntegratorType, Model, SolverType};
use crate::state::{RESERVED_CONTACTS, State};
use crate::topology::Topology;
use crate::vectorize::vectorized;

/// The options of [`SoftEngine`]. The default is MuJoCo 3.3.0's contact geometry with physically correct torque sensors.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SoftOptions {
    /// Peculiarities of MuJoCo 3.3.0's contact geometry to keep.
    pub contact_quirks: Quirks,
    /// Count the rotational multipliers of a weld as its torque in `cfrc_ext`, as MuJoCo 3.3.0 does: about twice the
    /// true torque, visible in torque sensors between the weld and the root of the tree.
    pub double_weld_torque: bool,
    /// Detect no contacts.
    pub disable_contacts: bool,
    /// Compute `cacc`, `cfrc_ext` and `cfrc_int` in every step, even if no sensor of the model reads them.
    #[doc(alias = "mj_rnePostConstraint")]
    pub post_constraint: bool,
}

/// Advances a state by MuJoCo's formulation in joint space.
///
/// It is named after its soft constraints: as in MuJoCo, contacts, limits and equalities give a little under force. Soft bodies are flexes of
/// the model, which it simulates, too.
///
/// A step computes kinematics, inertia, contacts, constraint rows, velocities, forces, solves for the acceleration with the
/// solver of the model, and integrates with its integrator: by default Newton's method, and semi-implicit Euler with implicit
/// joint damping. After warm-up it allocates nothing.
#[doc(alias("mj_step", "mjSOL_NEWTON"))]
pub struct SoftEngine {
    model: Arc<Model>,
    options: SoftOptions,
    topology: Arc<Topology>,
    pairs: Arc<PairTable>,
    sweep: Sweep,
    flex_sweep: FlexSweep,
    rows: RowBuilder,
    newton: NewtonSolver,
    dual: DualSolver,
    integrator: Integrator,
    stages: RungeKutta,
    sensor_scratch: SensorScratch,
    composite: CompositeInertia,
    bias: BiasScratch,
    bodies: Articulated,
    /// Whether `cacc`, `cfrc_ext` and `cfrc_int` are computed.
    post_constraint: bool,
    probe: Option<Probe>,
}

impl std::fmt::Debug for SoftEngine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SoftEngine")
            .field("options", &self.options)
            .finish_non_exhaustive()
    }
}

/// The part that soft engines of one model share: the tree, and the pairs that may touch.
#[derive(Clone, Debug)]
pub struct SoftModel {
    model: Arc<Model>,
    options: SoftOptions,
    topology: Arc<Topology>,
    pairs: Arc<PairTable>,
}

impl SoftModel {
    /// Derives the shared part from `model`.
    pub fn new(model: Arc<Model>, options: SoftOptions) -> Self {
        Self {
            options,
            topology: Arc::new(Topology::new(&model)),
            pairs: Arc::new(PairTable::new(&model)),
            model,
        }
    }

    /// Returns a new engine.
    pub fn engine(&self) -> SoftEngine {
        let (model, topology, pairs) = (&self.model, &self.topology, &self.pairs);
        let contact = contact_options(model, self.options.contact_quirks);
        SoftEngine {
            options: self.options,
            sweep: Sweep::new(model, pairs, contact),
            flex_sweep: FlexSweep::default(),
            rows: RowBuilder::new(model, topology),
            newton: NewtonSolver::with_capacity(topology, model.nv, RESERVED_CONTACTS),
            dual: DualSolver::default(),
            integrator: Integrator::default(),
            stages: RungeKutta::default(),
            sensor_scratch: SensorScratch::default(),
            composite: CompositeInertia::default(),
            bias: BiasScratch::default(),
            bodies: Articulated::new(model),
            post_constraint: self.options.post_constraint || model.reads_accelerations(),
            probe: None,
            topology: topology.clone(),
            pairs: pairs.clone(),
            model: model.clone(),
        }
    }
}

impl SoftEngine {
    /// Makes an engine for `model`. It is cheaper to create several engines of one model from one [`SoftModel`].
    pub fn new(model: Arc<Model>, options: SoftOptions) -> Self {
        SoftModel::new(model, options).engine()
    }

    /// Calls the probe, if any, with the stage that begins, or with `None` when the step is done.
    #[inline]
    fn mark(&mut self, stage: Option<Stage>) {
        if let Some(p) = &mut self.probe {
            p(stage);
        }
    }

    /// Computes the position stage: poses, inertia, contacts, constraint rows.
    #[doc(alias = "mj_fwdPosition")]
    fn fwd_position(&mut self, s: &mut State) -> Result<(), EngineError> {
        self.mark(Some(Stage::Kinematics));
        vectorized!({
            kinematics(&self.model, s);
            com_pos(&self.model, s);
            cameras(&self.model, s);
            if !self.model.flexes.is_empty() {
                flexes(&self.model, &self.topology, s, false);
            }
            tendons(&self.model, &self.topology, s);
        });
        vectorized!(crb(&self.model, &self.topology, s, &mut self.composite));
        vectorized!(self.bodies.update(&self.model, s, &self.composite));
        self.mark(Some(Stage::Collision));
        let flags = &self.model.opt.flags;
        if self.options.disable_contacts || !flags.contact || !flags.constraint {
            s.contact.clear();
            s.flex_contact.clear();
        } else {
            vectorized!(self.sweep.contacts(&self.model, &self.pairs, s))?;
            if !self.model.flexes.is_empty() {
                let (options, scratch) = self.sweep.tools();
                self.flex_sweep.contacts(&self.model, options, scratch, s)?;
            }
        }
        self.mark(Some(Stage::Constraints));
        vectorized!(self.rows.build(&self.model, &self.topology, &self.composite, s));
        transmissions(&self.model, &self.topology, s);
        Ok(())
    }

    /// Computes everything. `senses` adds body accelerations, wrenches and sensors.
    #[doc(alias = "mj_forwardSkip")]
    // everything hot is inlined into it, so there must be one of it only
    #[inline(never)]
    fn compute(&mut self, s: &mut State, senses: bool) -> Result<(), EngineError> {
        check_input(&self.model, &self.topology, s)?;
        self.fwd_position(s)?;
        self.mark(Some(Stage::Forces));
        vectorized!(fwd_velocity(&self.model, &self.topology, s, &mut self.bias));
        vectorized!(fwd_actuation(&self.model, &self.topology, &mut self.bodies, s));
        self.mark(Some(Stage::Solver));
        match self.model.opt.solver {
            SolverType::Newton | SolverType::Cg => {
                vectorized!(self.newton.solve(&self.model, &self.topology, &mut self.bodies, s))
            }
            SolverType::Pgs => self.dual.solve(&self.model, &self.topology, &mut self.bodies, s)?,
        }
        if self.model.opt.noslip_iterations > 0 {
            self.dual.hold(&self.model, &self.topology, &mut self.bodies, s)?;
        }
        vectorized!(contact_forces(&self.model, s));
        if !senses {
            return Ok(());
        }
        self.mark(Some(Stage::Wrenches));
        vectorized!({
            if self.post_constraint {
                rne_post_constraint(&self.model, s, &self.bias, self.options.double_weld_torque);
            }
            if self.model.opt.flags.sensor {
                sensors(&self.model, s, &mut self.sensor_scratch);
            }
        });
        Ok(())
    }

    /// Computes everything, and checks that the simulation has not diverged.
    fn compute_checked(&mut self, s: &mut State) -> Result<(), EngineError> {
        self.compute(s, true)?;
        check_output(&self.model, s)?;
        check_contacts(&self.model, s)
    }
}

impl Engine for SoftEngine {
    fn model(&self) -> &Arc<Model> {
        &self.model
    }

    fn topology(&self) -> &Topology {
        &self.topology
    }

    fn forward(&mut self, state: &mut State) -> Result<(), EngineError> {
        let done = self.compute_checked(state);
        self.mark(None);
        done
    }

    fn step(&mut self, state: &mut State) -> Result<(), EngineError> {
        self.compute_checked(state)?;
        self.mark(Some(Stage::Integration));
        match self.model.opt.integrator {
            IntegratorType::Euler | IntegratorType::Implicit | IntegratorType::ImplicitFast => {
                vectorized!(
                    self.integrator
                        .advance(&self.model, &self.topology, &mut self.bodies, state)
                );
            }
            IntegratorType::Rk4 => {
                let (model, mut stages) = (self.model.clone(), std::mem::take(&mut self.stages));
                let done = stages.advance(&model, state, |s| {
                    // sensors stay those of the start of the step, as in MuJoCo
                    self.compute(s, false)?;
                    check_evaluation(&model, s)?;
                    check_contacts(&model, s)
                });
                self.stages = stages;
                done?;
            }
        }
        self.mark(None);
        // accelerations on the way may be large where those at the start are not: that shows at the start of the next step
        check_motion(&self.model, state)
    }

    fn set_probe(&mut self, probe: Option<Probe>) {
        self.probe = probe;
    }
}

//! The default engine: joint-space dynamics with soft constraints, as MuJoCo formulates them.

use std::sync::Arc;

use crate::model::Model;
use crate::physics::constraint::{Newton, RowBuilder};
use crate::physics::contact::Quirks;
use crate::physics::dynamics::*;
use crate::physics::engine::{Engine, EngineError, Probe, Stage, check_contacts, check_input, check_output};
use crate::physics::state::{RESERVED_CONTACTS, State};
use crate::physics::topology::Topology;
use crate::physics::vectorize::vectorize;
use crate::physics::world::{PairTable, Sweep, contact_options};

/// The options of [`SoftEngine`]. The default is MuJoCo 3.3.0's contact geometry with physically right torque
/// sensors.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SoftOptions {
    /// Peculiarities of MuJoCo 3.3.0's contact geometry to keep.
    pub contact_quirks: Quirks,
    /// Count the rotational multipliers of a weld as its torque in `cfrc_ext`, as MuJoCo 3.3.0 does: about twice the
    /// true torque, visible in torque sensors between the weld and the root of the tree.
    pub double_weld_torque: bool,
    /// Detect no contacts.
    pub disable_contacts: bool,
}

/// Advances a state by MuJoCo's formulation in joint space.
///
/// A step computes kinematics, inertia, contacts, constraint rows, velocities, forces, solves for the acceleration with
/// Newton's method, and integrates with semi-implicit Euler and implicit joint damping. After warm-up it allocates
/// nothing.
pub struct SoftEngine {
    model: Arc<Model>,
    options: SoftOptions,
    topology: Arc<Topology>,
    pairs: Arc<PairTable>,
    sweep: Sweep,
    rows: RowBuilder,
    newton: Newton,
    integrator: Integrator,
    bias: BiasScratch,
    bodies: Articulated,
    probe: Option<Probe>,
}

impl std::fmt::Debug for SoftEngine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SoftEngine")
            .field("options", &self.options)
            .finish_non_exhaustive()
    }
}

/// What soft engines of one model share: the tree, and the pairs that may touch.
#[derive(Clone, Debug)]
pub struct SoftModel {
    model: Arc<Model>,
    options: SoftOptions,
    topology: Arc<Topology>,
    pairs: Arc<PairTable>,
}

impl SoftModel {
    /// Derives it from `model`.
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
            rows: RowBuilder::new(model, topology),
            newton: Newton::with_capacity(topology, model.nv, RESERVED_CONTACTS),
            integrator: Integrator::default(),
            bias: BiasScratch::default(),
            bodies: Articulated::default(),
            probe: None,
            topology: topology.clone(),
            pairs: pairs.clone(),
            model: model.clone(),
        }
    }
}

impl SoftEngine {
    /// Makes an engine for `model`. Several engines of one model are cheaper from one [`SoftModel`].
    pub fn new(model: Arc<Model>, options: SoftOptions) -> Self {
        SoftModel::new(model, options).engine()
    }

    /// Tells the probe, if there is one, that a stage begins, or with `None` that the step is done.
    #[inline]
    fn mark(&mut self, stage: Option<Stage>) {
        if let Some(p) = &mut self.probe {
            p(stage);
        }
    }

    /// Computes the position stage: poses, inertia, contacts, constraint rows.
    fn fwd_position(&mut self, s: &mut State) -> Result<(), EngineError> {
        self.mark(Some(Stage::Kinematics));
        let (model, topology, bodies) = (&*self.model, &*self.topology, &mut self.bodies);
        vectorize(
            #[inline(always)]
            || {
                kinematics(model, s);
                cameras(model, s);
                com_pos(model, s);
            },
        );
        vectorize(
            #[inline(always)]
            || crb(model, topology, s),
        );
        vectorize(
            #[inline(always)]
            || bodies.update(model, s),
        );
        self.mark(Some(Stage::Collision));
        if self.options.disable_contacts {
            s.contact.clear();
        } else {
            let (sweep, model, pairs) = (&mut self.sweep, &*self.model, &*self.pairs);
            vectorize(
                #[inline(always)]
                || sweep.contacts(model, pairs, s),
            )?;
        }
        self.mark(Some(Stage::Constraints));
        let (rows, model, topology) = (&mut self.rows, &*self.model, &*self.topology);
        vectorize(
            #[inline(always)]
            || rows.build(model, topology, s),
        );
        Ok(())
    }

    fn compute(&mut self, s: &mut State) -> Result<(), EngineError> {
        check_input(&self.model, &self.topology, s)?;
        self.fwd_position(s)?;
        self.mark(Some(Stage::Forces));
        let (model, bias, bodies) = (&*self.model, &mut self.bias, &mut self.bodies);
        vectorize(
            #[inline(always)]
            || fwd_velocity(model, s, bias),
        );
        vectorize(
            #[inline(always)]
            || fwd_actuation(model, bodies, s),
        );
        self.mark(Some(Stage::Solver));
        let (newton, model, topology) = (&mut self.newton, &*self.model, &*self.topology);
        vectorize(
            #[inline(always)]
            || newton.solve(model, topology, s),
        );
        self.mark(Some(Stage::Wrenches));
        let (model, double_weld_torque) = (&*self.model, self.options.double_weld_torque);
        vectorize(
            #[inline(always)]
            || {
                rne_post_constraint(model, s, double_weld_torque);
                sensors(model, s);
            },
        );
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

    fn pairs(&self) -> &PairTable {
        &self.pairs
    }

    fn forward(&mut self, state: &mut State) -> Result<(), EngineError> {
        let done = self.compute(state);
        self.mark(None);
        done
    }

    fn step(&mut self, state: &mut State) -> Result<(), EngineError> {
        self.compute(state)?;
        self.mark(Some(Stage::Integration));
        let (integrator, model, bodies) = (&mut self.integrator, &*self.model, &mut self.bodies);
        vectorize(
            #[inline(always)]
            || integrator.advance(model, bodies, state),
        );
        self.mark(None);
        check_output(&self.model, state)
    }

    fn set_probe(&mut self, probe: Option<Probe>) {
        self.probe = probe;
    }
}

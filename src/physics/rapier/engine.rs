//! Rapier's pipeline as an engine: a bridge to its own world.

use std::sync::Arc;

use rapier3d_f64::dynamics::{
    CCDSolver, ImpulseJointSet, IntegrationParameters, IslandManager, MultibodyJointSet, RigidBodySet, SoftBodySet,
};
use rapier3d_f64::geometry::{BroadPhaseBvh, ColliderSet};
use rapier3d_f64::parry::math::Vector;
use rapier3d_f64::pipeline::PhysicsPipeline;

use crate::bodies::RapierBodies;
use crate::bridge::Bridge;
use crate::{RapierError, RapierOptions, RapierSets};
use mjcf_sim_model::model::{IntegratorType, Model};
use mjcf_sim_physics::collision::PairTable;
use mjcf_sim_physics::state::State;
use mjcf_sim_physics::topology::Topology;
use mjcf_sim_physics::{Engine, EngineError, Probe, Stage};

/// The sets of the engine's own world.
#[derive(Clone, Debug, Default)]
struct OwnedSets {
    bodies: RigidBodySet,
    colliders: ColliderSet,
    impulse_joints: ImpulseJointSet,
    multibody_joints: MultibodyJointSet,
}

impl OwnedSets {
    fn sets(&mut self) -> RapierSets<'_> {
        RapierSets {
            bodies: &mut self.bodies,
            colliders: &mut self.colliders,
            impulse_joints: &mut self.impulse_joints,
            multibody_joints: &mut self.multibody_joints,
        }
    }
}

/// A model prepared for Rapier. It is made once, so that creating engines from it is cheap.
#[derive(Clone, Debug)]
pub struct RapierModel {
    model: Arc<Model>,
    options: RapierOptions,
    topology: Arc<Topology>,
    pairs: Arc<PairTable>,
    rig: Arc<RapierBodies>,
    /// The world before its first step.
    pristine: Arc<OwnedSets>,
}

impl RapierModel {
    /// Prepares `model` for engines that share it.
    ///
    /// # Errors
    /// Fails if the model has elements that Rapier's multibodies cannot represent.
    pub fn new(model: Arc<Model>, options: RapierOptions) -> Result<Self, RapierError> {
        if model.opt.integrator != IntegratorType::Euler {
            return Err(RapierError::unsupported(
                "option",
                "integrator",
                "Rapier steps by Euler's method",
            ));
        }
        let topology = Topology::new(&model);
        let mut pristine = OwnedSets::default();
        let rig = RapierBodies::insert(&model, &topology, &mut pristine.sets())?;
        Ok(Self {
            pairs: Arc::new(PairTable::new(&model)),
            options,
            topology: Arc::new(topology),
            rig: Arc::new(rig),
            pristine: Arc::new(pristine),
            model,
        })
    }

    /// Creates a new engine.
    pub fn engine(&self) -> RapierEngine {
        let (model, pairs) = (self.model.clone(), self.pairs.clone());
        let bridge = Bridge::new(model, self.topology.clone(), pairs, self.rig.clone(), self.options);
        RapierEngine {
            parameters: bridge.parameters(),
            pristine: self.pristine.clone(),
            bridge,
            probe: None,
        }
    }
}

/// Rapier's pipeline as an engine: multibody dynamics, contacts and joints are solved by `PhysicsPipeline::step`.
///
/// Every step starts from a copy of the world before its first step, loaded with the state. So a step depends on the
/// state alone: nothing that Rapier remembers (islands, the order of pairs, warm starts) outlives it, a restored state
/// continues with the same bits, and a state that diverged leaves no trace. The copy costs a few percent of a step. A
/// step allocates.
pub struct RapierEngine {
    bridge: Bridge,
    pristine: Arc<OwnedSets>,
    parameters: IntegrationParameters,
    probe: Option<Probe>,
}

impl std::fmt::Debug for RapierEngine {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("RapierEngine")
            .field("bridge", &self.bridge)
            .finish_non_exhaustive()
    }
}

impl RapierEngine {
    /// Creates an engine for `model`.
    ///
    /// # Errors
    /// Fails like [`RapierModel::new`].
    pub fn new(model: Arc<Model>, options: RapierOptions) -> Result<Self, RapierError> {
        Ok(RapierModel::new(model, options)?.engine())
    }

    /// Returns the bridge to the world of the step.
    pub fn bridge(&self) -> &Bridge {
        &self.bridge
    }

    /// Calls the probe, if any, with the stage that begins, or with `None` when the step is done.
    fn mark(&mut self, stage: Option<Stage>) {
        if let Some(p) = &mut self.probe {
            p(stage);
        }
    }

    /// Computes everything that follows from the state, in a fresh copy of the world.
    fn compute(&mut self, s: &mut State) -> Result<(), EngineError> {
        let probe = &mut self.probe;
        self.bridge.compute(s, &mut |stage| {
            if let Some(p) = probe {
                p(Some(stage));
            }
        })?;
        let mut world = OwnedSets::clone(&self.pristine);
        self.bridge.load(s, &mut world.sets());
        let mut narrow = self.bridge.narrow_phase();
        PhysicsPipeline::new().step(
            Vector::ZERO,
            &self.parameters,
            &mut IslandManager::new(),
            &mut BroadPhaseBvh::new(),
            &mut narrow,
            &mut world.bodies,
            &mut world.colliders,
            &mut world.impulse_joints,
            &mut world.multibody_joints,
            &mut SoftBodySet::new(),
            &mut CCDSolver::new(),
            &self.bridge.hooks(),
            &(),
        );
        self.mark(Some(Stage::Wrenches));
        self.bridge.after(s, &world.sets(), &narrow)
    }
}

impl Engine for RapierEngine {
    fn model(&self) -> &Arc<Model> {
        self.bridge.model()
    }

    fn topology(&self) -> &Topology {
        self.bridge.topology()
    }

    fn forward(&mut self, s: &mut State) -> Result<(), EngineError> {
        let done = self.compute(s);
        self.mark(None);
        done
    }

    fn step(&mut self, s: &mut State) -> Result<(), EngineError> {
        self.compute(s)?;
        self.mark(Some(Stage::Integration));
        let done = self.bridge.advance(s);
        self.mark(None);
        done
    }

    fn set_probe(&mut self, probe: Option<Probe>) {
        self.probe = probe;
    }
}

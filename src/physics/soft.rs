//! The default engine: joint-space dynamics with soft constraints, as MuJoCo formulates them.

use std::sync::Arc;

use crate::math::Vec3;
use crate::model::Model;
use crate::physics::constraint::{Newton, make_constraints};
use crate::physics::contact::{Options, Quirks};
use crate::physics::dynamics::*;
use crate::physics::engine::{Engine, EngineError, Probe, Stage};
use crate::physics::state::{RESERVED_CONTACTS, State};
use crate::physics::topology::Topology;
use crate::physics::world::{PairTable, Scene, Sweep};

/// Coordinates and velocities beyond this count as divergence (MuJoCo's `mjMAXVAL`).
const MAXVAL: f64 = 1e10;

/// Choices of [`SoftEngine`]. The default is MuJoCo 3.3.0's contact geometry with physically right torque sensors.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct SoftOptions {
    /// Peculiarities of MuJoCo 3.3.0's contact geometry to keep.
    pub contact_quirks: Quirks,
    /// Count the rotational multipliers of a weld as its torque in `cfrc_ext`, as MuJoCo 3.3.0 does: about twice the true
    /// torque, visible in torque sensors between the weld and the root of the tree.
    pub double_weld_torque: bool,
    /// Detect no contacts.
    pub disable_contacts: bool,
}

/// MuJoCo's formulation in joint space, with the scene in Rapier.
///
/// A step computes kinematics, inertia, contacts, constraint rows, velocities, forces, solves for the acceleration with
/// Newton's method, and integrates with semi-implicit Euler and implicit joint damping. After warm-up it allocates nothing.
pub struct SoftEngine {
    model: Arc<Model>,
    options: SoftOptions,
    topology: Topology,
    pairs: PairTable,
    sweep: Sweep,
    scene: Scene,
    newton: Newton,
    integrator: Integrator,
    bias: BiasScratch,
    columns: Vec<(u32, Vec3, Vec3)>,
    probe: Option<Probe>,
}

impl SoftEngine {
    /// For `model`, whose constants [`set_const`] has filled.
    pub fn new(model: Arc<Model>, options: SoftOptions) -> Self {
        let pairs = PairTable::new(&model);
        let contact = Options {
            ccd_tolerance: model.opt.ccd_tolerance,
            ccd_iterations: model.opt.ccd_iterations,
            quirks: options.contact_quirks,
        };
        Self {
            options,
            topology: Topology::new(&model),
            sweep: Sweep::new(&model, &pairs, contact),
            scene: Scene::new(&model, &pairs, contact),
            pairs,
            newton: Newton::with_capacity(model.nv, RESERVED_CONTACTS),
            integrator: Integrator::default(),
            bias: BiasScratch::default(),
            columns: Vec::with_capacity(model.nv),
            probe: None,
            model,
        }
    }

    /// The live scene in Rapier, with the poses of the last forward or step.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The live scene, to run Rapier's collision pipeline and queries on.
    pub fn scene_mut(&mut self) -> &mut Scene {
        &mut self.scene
    }

    /// Installs or removes a probe that is told when each stage of a step begins.
    pub fn set_probe(&mut self, probe: Option<Probe>) {
        self.probe = probe;
    }

    /// Tells the probe, if there is one.
    #[inline]
    pub(crate) fn mark(&mut self, stage: Option<Stage>) {
        if let Some(p) = &mut self.probe {
            p(stage);
        }
    }

    /// Derived structure of the model.
    pub fn topology(&self) -> &Topology {
        &self.topology
    }

    /// Geom pairs that may touch, in contact order.
    pub fn pairs(&self) -> &PairTable {
        &self.pairs
    }

    /// Position stage: poses, inertia, contacts, constraint rows.
    fn fwd_position(&mut self, s: &mut State) {
        self.mark(Some(Stage::Kinematics));
        let model = &*self.model;
        kinematics(model, s);
        cameras(model, s);
        com_pos(model, s);
        crb(model, &self.topology, s);
        factor_m(&self.topology, s);
        self.mark(Some(Stage::Scene));
        self.scene.sync(s);
        self.mark(Some(Stage::Collision));
        if self.options.disable_contacts {
            s.contacts.clear();
        } else {
            self.sweep.contacts(&self.model, &self.pairs, s);
        }
        self.mark(Some(Stage::Constraints));
        make_constraints(&self.model, &self.topology, s, &mut self.columns);
    }

    fn compute(&mut self, s: &mut State) -> Result<(), EngineError> {
        self.check_input(s)?;
        self.fwd_position(s);
        self.mark(Some(Stage::Forces));
        fwd_velocity(&self.model, s, &mut self.bias);
        fwd_actuation(&self.model, &self.topology, s);
        self.mark(Some(Stage::Solver));
        self.newton.solve(&self.model, &self.topology, s);
        self.mark(Some(Stage::Wrenches));
        rne_post_constraint(&self.model, s, self.options.double_weld_torque);
        self.check_output(s)
    }

    fn check_input(&self, s: &State) -> Result<(), EngineError> {
        let m = &*self.model;
        let p = &s.params;
        let fields: [(&'static str, &[f64], usize); 8] = [
            ("qpos", &s.qpos, m.nq),
            ("qvel", &s.qvel, m.nv),
            ("ctrl", &s.ctrl, m.nu()),
            ("qfrc_applied", &s.qfrc_applied, m.nv),
            ("params.eq_offset", &p.eq_offset, m.neq()),
            ("params.jnt_stiffness", &p.jnt_stiffness, m.njnt()),
            ("params.dof_damping", &p.dof_damping, m.nv),
            ("params.actuator_gear", &p.actuator_gear, m.nu()),
        ];
        // the solver does without a warm start that is no use
        let lengths = [
            ("qacc_warmstart", s.qacc_warmstart.len(), m.nv),
            ("params.eq_active", p.eq_active.len(), m.neq()),
            ("params.actuator_forcelimited", p.actuator_forcelimited.len(), m.nu()),
        ];
        for (what, found, expected) in lengths {
            if found != expected {
                return Err(EngineError::Shape { what, found, expected });
            }
        }
        for (what, values, expected) in fields {
            if values.len() != expected {
                return Err(EngineError::Shape {
                    what,
                    found: values.len(),
                    expected,
                });
            }
            if let Some((index, &value)) = values.iter().enumerate().find(|(_, v)| !v.is_finite()) {
                return Err(EngineError::NotFinite { what, index, value });
            }
        }
        Ok(())
    }

    /// Reports the coordinate that left the bounds by most: positions first, as they drag the rest along.
    fn check_output(&self, s: &State) -> Result<(), EngineError> {
        let model = &*self.model;
        for (what, values) in [("qpos", &s.qpos), ("qvel", &s.qvel), ("qacc", &s.qacc)] {
            if values.iter().all(|v| v.abs() <= MAXVAL) {
                continue;
            }
            let size = |v: f64| if v.is_nan() { f64::INFINITY } else { v.abs() };
            let worst = (0..values.len())
                .max_by(|&i, &k| size(values[i]).total_cmp(&size(values[k])))
                .unwrap_or(0);
            let joint = match what {
                "qpos" => model.jnt_qposadr.iter().rposition(|&adr| adr <= worst).unwrap_or(0),
                _ => model.dof_jntid[worst],
            };
            return Err(EngineError::Diverged {
                step: s.step,
                joint: model.jnt_name[joint].clone(),
                what,
                value: values[worst],
            });
        }
        Ok(())
    }
}

impl Engine for SoftEngine {
    fn model(&self) -> &Arc<Model> {
        &self.model
    }

    fn new_state(&self) -> State {
        State::new(&self.model, &self.topology)
    }

    fn forward(&mut self, state: &mut State) -> Result<(), EngineError> {
        self.compute(state)
    }

    fn step(&mut self, state: &mut State) -> Result<(), EngineError> {
        self.compute(state)?;
        self.mark(Some(Stage::Integration));
        self.integrator.advance(&self.model, &self.topology, state);
        self.check_output(state)
    }
}

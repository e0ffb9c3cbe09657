//! The interface of physics engines.

use std::sync::Arc;

use crate::MAXVAL;
use crate::detected::{Contact, ContactSide};
use crate::error::EngineError;
use crate::model::Model;
use crate::state::State;
use crate::table::length;
use crate::topology::Topology;

/// Advances a [`State`] of a [`Model`]. An engine stores nothing that affects later steps; everything is in the state.
///
/// Write your own to change how a scene moves. This one leaves forces to [`SoftEngine`](crate::SoftEngine) and integrates hinges and
/// slides by itself, within a greatest speed:
///
/// ```
/// use std::sync::Arc;
///
/// use mjcf_sim::assets::MemoryAssets;
/// use mjcf_sim::mjcf_loader::load_str;
/// use mjcf_sim::Model;
/// use mjcf_sim::physics::{Engine, EngineError, Probe, SoftEngine, SoftOptions, State, Topology, compile};
///
/// /// Limits the speed of every degree of freedom, rad/s or m/s.
/// struct Governed {
///     inner: SoftEngine,
///     most: f64,
/// }
///
/// impl Engine for Governed {
///     fn model(&self) -> &Arc<Model> {
///         self.inner.model()
///     }
///     fn topology(&self) -> &Topology {
///         self.inner.topology()
///     }
///     fn forward(&mut self, state: &mut State) -> Result<(), EngineError> {
///         self.inner.forward(state)
///     }
///     fn step(&mut self, state: &mut State) -> Result<(), EngineError> {
///         self.forward(state)?;
///         let h = self.model().opt.timestep;
///         for i in 0..state.qvel.len() {
///             state.qvel[i] = (state.qvel[i] + h * state.qacc[i]).clamp(-self.most, self.most);
///             state.qpos[i] += h * state.qvel[i];
///         }
///         state.time += h;
///         state.step += 1;
///         Ok(())
///     }
/// }
///
/// let text = "<mujoco><worldbody><body><joint axis='0 1 0'/><geom size='.1' pos='1 0 0'/></body></worldbody></mujoco>";
/// let model = Arc::new(compile(load_str(text, "arm.xml", &MemoryAssets::new())?)?);
/// let mut engine = Governed { inner: SoftEngine::new(model, SoftOptions::default()), most: 0.5 };
/// let mut state = engine.new_state();
/// for _ in 0..500 {
///     engine.step(&mut state)?;
/// }
/// assert_eq!(state.qvel[0], 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Engine: Send + Sync {
    /// Returns the compiled scene.
    fn model(&self) -> &Arc<Model>;

    /// Returns the structure of the model's tree, which the engine derived once.
    fn topology(&self) -> &Topology;

    /// Returns a state at `qpos0`, at rest. Computed quantities are zero until [`Engine::forward`] or [`Engine::step`].
    #[doc(alias("mj_makeData", "mj_resetData"))]
    fn new_state(&self) -> State {
        State::new(self.model(), self.topology())
    }

    /// Returns the joint-space inertia matrix in full (nv, nv), row by row, kg and kg m^2: MuJoCo's `mj_fullM`. It is empty if the state belongs to
    /// another model.
    #[doc(alias("mj_fullM", "qM"))]
    fn full_m(&self, state: &State) -> Vec<f64> {
        if state.qm.len() == self.topology().tiles.tiles() {
            self.topology().full(&state.qm)
        } else {
            Vec::new()
        }
    }

    /// Returns a row of the constraint Jacobian in full (nv), MuJoCo's `efc_J`; nothing if there are fewer rows or the state belongs to another
    /// model.
    #[doc(alias("efc_J", "mj_mulJacVec"))]
    fn efc_j(&self, state: &State, row: usize) -> Option<Vec<f64>> {
        state.efc.jacobian_row(self.topology(), row)
    }

    /// Sets time, positions, velocities, activations, controls and mocap poses of a state to those of keyframe `key` of the model, and
    /// all other dynamic fields (forces, warm start, parameters) to those of a new state.
    ///
    /// ```
    /// use mjcf_sim::assets::MemoryAssets;
    /// use mjcf_sim::physics::{Engine, SoftEngine, SoftOptions, compile};
    ///
    /// let text = "<mujoco><worldbody><body><joint name='hinge'/><geom size='.1' pos='1 0 0'/></body></worldbody>
    ///   <keyframe><key name='up' qpos='-1.5' qvel='2'/></keyframe></mujoco>";
    /// let model = compile(mjcf_sim::mjcf_loader::load_str(text, "arm.xml", &MemoryAssets::new())?)?;
    /// let mut engine = SoftEngine::new(model.into(), SoftOptions::default());
    /// let mut state = engine.new_state();
    /// let up = engine.model().key("up").ok_or("no such keyframe")?;
    /// engine.reset_to_keyframe(&mut state, up)?;
    /// assert_eq!((state.qpos[0], state.qvel[0]), (-1.5, 2.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// The model has no such keyframe; nothing is changed then.
    #[doc(alias("mj_resetDataKeyframe"))]
    fn reset_to_keyframe(&self, state: &mut State, key: usize) -> Result<(), EngineError> {
        let (model, count) = (self.model(), self.model().nkey());
        let keyframe = model.keys.get(key).ok_or(EngineError::NoKeyframe { key, count })?;
        state.copy_dynamic_from(&self.new_state());
        state.time = keyframe.time;
        state.qpos.clone_from(&keyframe.qpos);
        state.qvel.clone_from(&keyframe.qvel);
        state.act.clone_from(&keyframe.act);
        state.ctrl.clone_from(&keyframe.ctrl);
        state.mocap_pos.clone_from(&keyframe.mpos);
        state.mocap_quat.clone_from(&keyframe.mquat);
        Ok(())
    }

    /// Checks that the vectors of a state have the lengths that the model needs, as every forward and step do.
    ///
    /// # Errors
    /// The first vector that has another length.
    fn check_shape(&self, state: &State) -> Result<(), EngineError> {
        check_shape(self.model(), self.topology(), state)
    }

    /// Computes everything that follows from `qpos`, `qvel` and `ctrl`, without advancing.
    ///
    /// # Errors
    /// Vectors that do not fit the model, numbers that are not finite, divergence.
    #[doc(alias = "mj_forward")]
    fn forward(&mut self, state: &mut State) -> Result<(), EngineError>;

    /// Advances by one time step. The computed quantities are those at the start of the step. With the integrator `RK4` they are those of the last of
    /// its four evaluations, at the end of the step, except for `sensordata`, which belongs to the start.
    ///
    /// # Errors
    /// As [`Engine::forward`].
    #[doc(alias = "mj_step")]
    fn step(&mut self, state: &mut State) -> Result<(), EngineError>;

    /// Installs or removes a probe, which is called when each stage of a step begins and when the step is done. An engine without stages
    /// need not have one: by default nothing is called.
    fn set_probe(&mut self, probe: Option<Probe>) {
        drop(probe);
    }
}

/// A stage of a physics step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Poses and inertia.
    Kinematics,
    /// Contacts.
    Collision,
    /// Constraint rows.
    Constraints,
    /// Velocities, bias, passive and actuator forces.
    Forces,
    /// Newton's method.
    Solver,
    /// Accelerations and internal wrenches, and the sensors of the model.
    Wrenches,
    /// Integration.
    Integration,
}

impl Stage {
    /// Lists all stages, in the order of a step.
    pub const ALL: [Self; 7] = [
        Self::Kinematics,
        Self::Collision,
        Self::Constraints,
        Self::Forces,
        Self::Solver,
        Self::Wrenches,
        Self::Integration,
    ];

    /// Returns a display name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kinematics => "kinematics",
            Self::Collision => "collision",
            Self::Constraints => "constraints",
            Self::Forces => "forces",
            Self::Solver => "solver",
            Self::Wrenches => "wrenches",
            Self::Integration => "integration",
        }
    }
}

/// A function that is called when a stage begins, and with `None` when a step is done; for timing, because the library has no clock.
pub type Probe = Box<dyn FnMut(Option<Stage>) + Send + Sync>;

/// Checks that all vectors of a state have the right length, and that those that a step reads are finite.
#[doc(alias("mj_checkPos", "mj_checkVel"))]
pub fn check_input(m: &Model, topology: &Topology, s: &State) -> Result<(), EngineError> {
    check_shape(m, topology, s)?;
    s.finite()?;
    s.params.finite()
}

fn check_shape(m: &Model, topology: &Topology, s: &State) -> Result<(), EngineError> {
    s.fits(m, topology)?;
    // an actuation model may keep its own activations where actuators have none
    if m.na > 0 {
        length("act", s.act.len(), m.na)?;
    }
    s.params.fits(m)
}

/// Reports the coordinate that left the bounds by most: positions first, because they affect the rest.
#[doc(alias = "mj_checkAcc")]
pub fn check_output(model: &Model, s: &State) -> Result<(), EngineError> {
    check_bounds(model, s, &[("qpos", &s.qpos), ("qvel", &s.qvel), ("qacc", &s.qacc)])
}

/// Reports accelerations that are not finite, at an evaluation within a step. MuJoCo checks for large ones only at the start of a step.
pub fn check_evaluation(model: &Model, s: &State) -> Result<(), EngineError> {
    if s.qacc.iter().all(|v| v.is_finite()) {
        return Ok(());
    }
    check_output(model, s)
}

/// Reports the first contact that is not finite. Bodies may still be finite: a body of 1e30 kg is barely affected.
pub fn check_contacts(model: &Model, s: &State) -> Result<(), EngineError> {
    let finite = |c: &Contact| {
        let numbers = c.pos.iter().chain(&c.frame).chain(&c.force);
        // an overflow of the sum is a divergence, too
        (numbers.fold(c.dist, |sum, v| sum + v.abs())).is_finite()
    };
    let named = |names: &[String], id: usize| match names.get(id) {
        Some(name) if !name.is_empty() => format!("{name:?}"),
        _ => id.to_string(),
    };
    let geoms = match s.contact.iter().find(|c| !finite(c)) {
        Some(bad) => bad.geom.map(|geom| named(&model.geom_name, geom)),
        None => match s.flex_contact.iter().find(|c| !finite(&c.contact)) {
            Some(bad) => bad.sides.map(|side| match side {
                ContactSide::Geom(geom) => named(&model.geom_name, geom),
                ContactSide::Vertex { flex, .. } | ContactSide::Element { flex, .. } => {
                    format!("flex {:?}", model.flexes[flex].name)
                }
            }),
            None => return Ok(()),
        },
    };
    Err(EngineError::DivergedContact { step: s.step, geoms })
}

/// Checks only positions and velocities; see [`check_output`].
pub fn check_motion(model: &Model, s: &State) -> Result<(), EngineError> {
    check_bounds(model, s, &[("qpos", &s.qpos), ("qvel", &s.qvel)])
}

fn check_bounds(model: &Model, s: &State, fields: &[(&'static str, &Vec<f64>)]) -> Result<(), EngineError> {
    for &(what, values) in fields {
        if values.iter().fold(true, |all, v| all & (v.abs() <= MAXVAL)) {
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
            number: joint,
            body: model.body_name[model.jnt_bodyid[joint]].clone(),
            what,
            value: values[worst],
        });
    }
    Ok(())
}

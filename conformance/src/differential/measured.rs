//! Quantities of a step on both sides.

use babybench::Model;
use babybench::model::SolverType;
use babybench::physics::State;

use super::contacts::contacts;
use super::slack::Slack;
use crate::measure::{max_abs, relative};
use crate::mujoco::Simulation;

/// Accelerations, measured relative to the largest.
pub(super) const QACC: &str = "qacc";

/// The result of a step.
pub(super) const QVEL: &str = "qvel after the step";
pub(super) const QPOS: &str = "qpos after the step";

/// A quantity that both sides have.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Name of the quantity that was compared.
    pub quantity: &'static str,
    /// The distance of our result from MuJoCo's.
    pub error: f64,
    /// The error up to which both agree.
    pub limit: f64,
    /// Values of both sides, for display.
    pub place: String,
}

impl Measured {
    pub(super) fn new(quantity: &'static str, error: f64, limit: f64, place: impl Into<String>) -> Self {
        // finite, as JSON has no other numbers
        let error = if error.is_nan() { f64::MAX } else { error.min(f64::MAX) };
        let place = place.into();
        Self {
            quantity,
            error,
            limit,
            place,
        }
    }

    /// Records that both sides accept a document.
    pub fn taken() -> Self {
        Self::new("taken", 0.0, 0.0, "")
    }

    /// Returns whether both sides agree.
    pub fn agrees(&self) -> bool {
        self.error <= self.limit
    }

    /// Returns another measure instead of this one, if both sides agree only by the other.
    fn or(self, other: Option<Self>) -> Self {
        match other {
            Some(other) if !self.agrees() && other.agrees() => other,
            _ => self,
        }
    }

    /// Accepts a difference of at most `allowed`.
    fn or_apart(self, apart: f64, allowed: f64) -> Self {
        if apart <= allowed && !self.agrees() {
            Self {
                error: self.limit,
                ..self
            }
        } else {
            self
        }
    }

    /// Measures numbers, relative to MuJoCo's largest.
    fn relative(quantity: &'static str, ours: &[f64], theirs: &[f64], limit: f64) -> Self {
        if ours.len() != theirs.len() {
            let place = format!("{} values, MuJoCo {}", ours.len(), theirs.len());
            return Self::new(quantity, f64::INFINITY, limit, place);
        }
        let scale = theirs.iter().fold(1e-6_f64, |m, v| m.max(v.abs()));
        let far = |k: &usize| (ours[*k] - theirs[*k]).abs();
        let worst = (0..ours.len()).max_by(|a, b| far(a).total_cmp(&far(b)));
        let place = worst.map(|k| format!("[{k}] {:e}, MuJoCo {:e}", ours[k], theirs[k]));
        Self::new(
            quantity,
            max_abs(ours, theirs) / scale,
            limit,
            place.unwrap_or_default(),
        )
    }
}

/// Measures all quantities of a step. Those that follow from differing ones are left out. Where both solvers stop early, they
/// need agree no better than the `tolerance` that the document asks for, and no better than the cost at which they stop ([`Slack`]);
/// the velocities that follow are held to the same cost, the positions to what the velocities move them, and sensors are left out
/// where accelerations agree by that rule alone.
pub(super) fn measure(model: &Model, state: &State, theirs: &Simulation) -> Vec<Measured> {
    let limit = model.opt.tolerance.max(1e-6);
    let mut all = vec![
        Measured::relative("qfrc_bias", &state.qfrc_bias, theirs.qfrc_bias(), 1e-9),
        Measured::relative("qfrc_passive", &state.qfrc_passive, theirs.qfrc_passive(), 1e-9),
        Measured::relative("qfrc_actuator", &state.qfrc_actuator, theirs.qfrc_actuator(), 1e-9),
        Measured::relative("act_dot", &state.act_dot, theirs.act_dot(), 1e-9),
        activations(state, theirs),
        Measured::relative("qacc_smooth", &state.qacc_smooth, theirs.qacc_smooth(), 1e-6),
    ];
    all.extend(contacts(state, &theirs.contacts()));
    if all.iter().all(Measured::agrees) {
        all.extend(rows(state, theirs));
    }
    if !all.iter().all(Measured::agrees) {
        return all;
    }
    let h = model.opt.timestep;
    let slack = Slack::new(model, theirs);
    let qacc = acceleration(state, theirs, limit).or(slack.accelerations(&state.qacc, theirs.qacc()));
    let (agrees, alike) = (qacc.agrees(), qacc.quantity == QACC);
    all.push(qacc);
    let cg = model.opt.solver == SolverType::Cg;
    if agrees {
        let [mut qvel, qpos] = advanced(state, theirs, limit);
        if cg {
            // conjugate gradients may stop far from the minimum, where accelerations are not yet those of the forces, from which
            // velocities follow: as far as forces agree, as implicit damping makes differences only smaller
            let apart = h * slack.force_norm(&state.qfrc_constraint, theirs.qfrc_constraint());
            qvel = qvel.or_apart(slack.norm(&state.qvel, theirs.qvel()), 2.0 * apart);
        }
        all.push(qvel.or(slack.velocities(&state.qvel, theirs.qvel(), h)));
        let moved = h * max_abs(&state.qvel, theirs.qvel());
        all.push(qpos.or_apart(max_abs(&state.qpos, theirs.qpos()), 2.0 * moved));
    }
    if agrees && alike {
        all.push(sensors(state, theirs, if cg { 1000.0 * limit } else { 10.0 * limit }));
    }
    all
}

/// Measures the activations after a step.
pub(super) fn activations(state: &State, theirs: &Simulation) -> Measured {
    Measured::relative("act after the step", &state.act, theirs.act(), 1e-9)
}

/// Measures where a step leads.
pub(super) fn advanced(state: &State, theirs: &Simulation, limit: f64) -> [Measured; 2] {
    [
        Measured::relative(QVEL, &state.qvel, theirs.qvel(), limit),
        Measured::relative(QPOS, &state.qpos, theirs.qpos(), limit),
    ]
}

fn acceleration(state: &State, theirs: &Simulation, limit: f64) -> Measured {
    let mut qacc = Measured::relative(QACC, &state.qacc, theirs.qacc(), limit);
    qacc.place += &format!(
        "; {} contacts, {} rows, iterations {} and {}",
        theirs.ncon(),
        theirs.nefc(),
        state.solver_iterations,
        theirs.solver_iterations()
    );
    qacc
}

/// Torques are differences between external forces and the forces of bodies on each other, which may be much greater.
fn sensors(state: &State, theirs: &Simulation, limit: f64) -> Measured {
    let wrenches = state.cfrc_int.iter().chain(&state.cfrc_ext).flatten();
    let wrench = wrenches.fold(0.0_f64, |m, v| m.max(v.abs()));
    let largest = theirs.sensordata().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut sensors = Measured::relative("sensordata", &state.sensordata, theirs.sensordata(), limit);
    sensors.error *= largest.max(1e-6) / largest.max(1e-3 * wrench).max(1e-6);
    sensors
}

fn rows(state: &State, theirs: &Simulation) -> Vec<Measured> {
    let ours: Vec<_> = state.efc_rows().collect();
    let place = format!("{}, MuJoCo {}", ours.len(), theirs.nefc());
    let other = f64::from(u8::from(ours.len() != theirs.nefc()));
    let mut all = vec![Measured::new("rows: number", other, 0.0, place)];
    if other > 0.0 || ours.is_empty() {
        return all;
    }
    let kinds = |k: usize| {
        ours.get(k)
            .map_or(String::new(), |row| format!(" {:?} {}", row.kind, row.id))
    };
    let mut compare = |quantity, of: fn(&babybench::physics::EfcRow) -> f64, theirs: &[f64], limit, each: bool| {
        let mut values: Vec<f64> = ours.iter().map(of).collect();
        let mut theirs = theirs.to_vec();
        if !state.flex_contact.is_empty() {
            // contacts of flexes come in another order
            for values in [&mut values, &mut theirs] {
                values.sort_by(f64::total_cmp);
            }
        }
        let mut measured = Measured::relative(quantity, &values, &theirs, limit);
        if each {
            let errors = values.iter().zip(&theirs).map(|(a, b)| relative(&[*a], &[*b]));
            let worst = errors.enumerate().fold((0, 0.0), |w, e| if e.1 > w.1 { e } else { w });
            measured.error = worst.1;
            measured.place = format!(
                "[{}]{} {:e}, MuJoCo {:e}",
                worst.0,
                kinds(worst.0),
                values[worst.0],
                theirs[worst.0]
            );
        }
        all.push(measured);
    };
    compare("rows: pos", |row| row.pos, theirs.efc_pos(), 1e-9, false);
    compare("rows: margin", |row| row.margin, theirs.efc_margin(), 1e-12, false);
    compare("rows: R", |row| row.r, theirs.efc_R(), 1e-6, true);
    compare("rows: vel", |row| row.vel, theirs.efc_vel(), 1e-9, false);
    compare("rows: aref", |row| row.aref, theirs.efc_aref(), 1e-8, false);
    all
}

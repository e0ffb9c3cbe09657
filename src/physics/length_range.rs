//! The range of lengths of an actuator, found by simulating both directions while a document is compiled.

use std::sync::Arc;

use crate::dynamics::stages::{com_pos, crb, kinematics, solve, update};
use crate::dynamics::{Articulated, CompositeInertia, dense_moment, tendons, transmissions};
use crate::engine::Engine;
use crate::math::MINVAL;
use crate::mjcf_loader::{LengthRange, LengthRangeMode, LoadError, Locations};
use crate::model::{BiasType, GainType, IntegratorType, Model, TrnType};
use crate::soft::{SoftEngine, SoftOptions};
use crate::state::State;

const UNSTABLE: &str = "the simulation that looks for its lengthrange is unstable: give lengthrange, or a smaller timestep in \
    <lengthrange> of <compiler>";
const EMPTY: &str = "its length does not change in the simulation that looks for its lengthrange: give lengthrange";
const ENDLESS: &str = "its length goes on changing in the simulation that looks for its lengthrange: limit what it acts on, or give \
    lengthrange";
const LONG: &str = "the simulation that looks for its lengthrange has too many steps: give lengthrange, or a smaller inttotal in \
    <lengthrange> of <compiler>";

/// Completes `actuator_lengthrange` as MuJoCo's `mj_setLengthRange` does: from the given range, from the limit of the joint or tendon,
/// or by pulling and pushing the actuator for some time, with only equalities and limits active.
///
/// # Errors
/// Lengths that do not come to rest, or do not change.
#[doc(alias = "mj_setLengthRange")]
pub(super) fn complete(model: Model, settings: &LengthRange, places: &Locations) -> Result<Model, LoadError> {
    let asked: Vec<usize> = (0..model.nu()).filter(|&i| is_asked(&model, settings, i)).collect();
    if asked.is_empty() {
        return Ok(model);
    }
    let mut ranges = model.actuator_lengthrange.clone();
    let mut search = None;
    let limit = places.limits().lengthrange_steps;
    let mut steps = 0.0;
    for i in asked {
        if let Some(range) = own_limit(&model, i).filter(|_| settings.uselimit) {
            ranges[i] = range;
            continue;
        }
        let search = search.get_or_insert_with(|| LengthRangeSimulation::new(&model, settings));
        steps += 2.0 * settings.inttotal / search.engine.model().opt.timestep;
        if steps > limit as f64 {
            return Err(places.actuator_error(i, LONG));
        }
        ranges[i] = search.range(i).map_err(|message| places.actuator_error(i, message))?;
    }
    Ok(model.with_lengthrange(ranges))
}

/// Returns whether an actuator lacks a range that it needs.
fn is_asked(model: &Model, settings: &LengthRange, i: usize) -> bool {
    let muscle = model.actuator_gaintype[i] == GainType::Muscle || model.actuator_biastype[i] == BiasType::Muscle;
    let wanted = match settings.mode {
        LengthRangeMode::None => false,
        LengthRangeMode::Muscle => muscle,
        LengthRangeMode::All => true,
    };
    let [shortest, longest] = model.actuator_lengthrange[i];
    wanted && !(settings.useexisting && shortest < longest)
}

/// Returns the limit that an actuator gets from `uselimit`.
fn own_limit(model: &Model, i: usize) -> Option<[f64; 2]> {
    // MuJoCo has two ids for each actuator, one after the other, and 3.3.0 looks here at the i-th of all: at the target of another
    // actuator, or at its second id. Most models with more than one muscle are simulated for that reason, and so they are here
    let pair = i / 2;
    let id = match i % 2 {
        0 => model.actuator_trnid[pair],
        _ => model.actuator_refid[pair]?,
    };
    let (limited, ranges) = match model.actuator_trntype[i] {
        TrnType::Joint | TrnType::JointInParent => (&model.jnt_limited, &model.jnt_range),
        TrnType::Tendon => (&model.tendon_limited, &model.tendon_range),
        _ => return None,
    };
    (limited.get(id) == Some(&true)).then(|| ranges[id])
}

/// The simulation that finds the shortest and longest length of an actuator.
struct LengthRangeSimulation<'a> {
    settings: &'a LengthRange,
    engine: SoftEngine,
    composite: CompositeInertia,
    bodies: Articulated,
    moment: Vec<f64>,
    response: Vec<f64>,
}

impl<'a> LengthRangeSimulation<'a> {
    fn new(model: &Model, settings: &'a LengthRange) -> Self {
        let model = model.with_options(|opt| {
            // these are on and those are off, regardless of the document
            let flags = &mut opt.flags;
            for on in [
                &mut flags.constraint,
                &mut flags.equality,
                &mut flags.limit,
                &mut flags.warmstart,
                &mut flags.refsafe,
                &mut flags.eulerdamp,
            ] {
                *on = true;
            }
            for off in [
                &mut flags.frictionloss,
                &mut flags.contact,
                &mut flags.passive,
                &mut flags.gravity,
                &mut flags.actuation,
            ] {
                *off = false;
            }
            if settings.timestep > 0.0 {
                opt.timestep = settings.timestep;
            }
            // its two halves of a step have no others
            if opt.integrator == IntegratorType::Rk4 {
                opt.integrator = IntegratorType::Euler;
            }
        });
        let nv = model.nv;
        Self {
            settings,
            composite: CompositeInertia::default(),
            bodies: Articulated::new(&model),
            engine: SoftEngine::new(Arc::new(model), SoftOptions::default()),
            moment: vec![0.0; nv],
            response: vec![0.0; nv],
        }
    }

    /// Returns the shortest and the longest length of an actuator.
    fn range(&mut self, i: usize) -> Result<[f64; 2], &'static str> {
        let (short, long) = (self.pull(i, -1.0)?, self.pull(i, 1.0)?);
        let found = [short[0], long[1]];
        let width = found[1] - found[0];
        if width.is_nan() || width <= 0.0 {
            return Err(EMPTY);
        }
        let converged = |[low, high]: [f64; 2]| high - low <= self.settings.tolrange * width;
        if converged(short) && converged(long) {
            Ok(found)
        } else {
            Err(ENDLESS)
        }
    }

    /// Pulls (-1) or pushes (1) an actuator for `inttotal`. Returns the least and the greatest length of the last `interval`.
    fn pull(&mut self, i: usize, side: f64) -> Result<[f64; 2], &'static str> {
        let settings = self.settings;
        let mut s = self.engine.new_state();
        let mut seen: Option<[f64; 2]> = None;
        let slower = pxfm::f_exp(-self.engine.model().opt.timestep / settings.timeconst.max(0.01));
        while s.time < settings.inttotal {
            s.qvel.iter_mut().for_each(|v| *v *= slower);
            self.push(&mut s, i, side);
            self.engine.step(&mut s).map_err(|_| UNSTABLE)?;
            let length = s.actuator_length[i];
            if s.time > settings.inttotal - settings.interval {
                let [low, high] = seen.unwrap_or([length; 2]);
                seen = Some([low.min(length), high.max(length)]);
            }
        }
        Ok(seen.unwrap_or_default())
    }

    /// Applies the force along the moment of an actuator that accelerates the model by `accel`.
    fn push(&mut self, s: &mut State, i: usize, side: f64) {
        let (model, topology) = (self.engine.model().clone(), self.engine.topology());
        kinematics(&model, s);
        com_pos(&model, s);
        tendons(&model, topology, s);
        transmissions(&model, topology, s);
        crb(&model, topology, s, &mut self.composite);
        update(&mut self.bodies, &model, s, &self.composite);
        dense_moment(&model, topology, s, i, &mut self.moment);
        solve(&mut self.bodies, s, &self.moment, &mut self.response);
        let norm = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
        let scale = side * self.settings.accel / norm(&self.response).max(MINVAL);
        for (force, arm) in s.qfrc_applied.iter_mut().zip(&self.moment) {
            *force = arm * scale;
        }
        let (total, most) = (norm(&s.qfrc_applied), self.settings.maxforce);
        if most > 0.0 && total > most {
            let scale = most / total.max(MINVAL);
            s.qfrc_applied.iter_mut().for_each(|force| *force *= scale);
        }
    }
}

//! Random states. Each value follows from a seed and the name of its element, so that when a document loses an element, the others keep
//! theirs.

use babybench::Model;
use babybench::physics::State;
use fastrand::Rng;
use serde::{Deserialize, Serialize};

/// Ingredients of a random state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    /// Decides all values.
    pub seed: u64,
    /// Largest distance of the coordinates from `qpos0`, m or rad.
    pub apart: f64,
    /// Largest speed, m/s or rad/s.
    pub speed: f64,
    /// Largest control and activation.
    pub control: f64,
    /// Largest generalised force applied from outside.
    pub force: f64,
    /// Largest force and torque on bodies.
    pub wrench: f64,
    /// Largest acceleration from which the solver starts.
    pub warm: f64,
}

/// Seeds are spread over all numbers (Fowler, Noll and Vo's hash).
pub fn hash(seed: u64, text: &str) -> u64 {
    let bytes = seed.to_le_bytes().into_iter().chain(text.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |h, byte| {
        (h ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

impl Recipe {
    /// Draws a recipe.
    pub fn new(seed: u64) -> Self {
        let mut rng = Rng::with_seed(seed);
        let mut pick = |values: [f64; 4]| values[rng.usize(..4)];
        Self {
            seed,
            apart: pick([0.0, 0.3, 1.0, 3.0]),
            speed: pick([0.0, 1.0, 5.0, 30.0]),
            control: pick([0.0, 0.5, 1.0, 3.0]),
            force: pick([0.0, 0.0, 0.0, 5.0]),
            wrench: pick([0.0, 0.0, 0.0, 5.0]),
            warm: pick([0.0, 0.0, 0.0, 50.0]),
        }
    }

    /// Returns the recipes with one part removed, for the reducer.
    pub fn simpler(&self) -> Vec<Self> {
        let mut all = vec![*self; 6];
        all[0].warm = 0.0;
        all[1].wrench = 0.0;
        all[2].force = 0.0;
        all[3].control = 0.0;
        all[4].speed = 0.0;
        all[5].apart = 0.0;
        all.retain(|other| other != self);
        all
    }

    /// Fills a new state.
    pub fn fill(&self, model: &Model, state: &mut State) {
        let draw = |what: &str, name: &str, to: &mut [f64], size: f64| {
            let mut rng = Rng::with_seed(hash(hash(self.seed, what), name));
            to.iter_mut().for_each(|v| *v += size * (2.0 * rng.f64() - 1.0));
        };
        for j in 0..model.njnt() {
            let (name, q, d) = (&model.jnt_name[j], model.jnt_qposadr[j], model.jnt_dofadr[j]);
            let dofs = model.jnt_type[j].nv();
            if dofs > 1 {
                let turn = q + dofs - 3;
                state.qpos[q..turn].fill(0.0);
                draw("place", name, &mut state.qpos[q..turn], 0.4);
                if self.apart > 0.0 {
                    draw("turn", name, &mut state.qpos[turn..turn + 4], 1.0);
                }
                let norm = state.qpos[turn..turn + 4].iter().map(|v| v * v).sum::<f64>().sqrt();
                state.qpos[turn..turn + 4].iter_mut().for_each(|v| *v /= norm);
            } else {
                draw("qpos", name, &mut state.qpos[q..q + 1], self.apart);
            }
            draw("qvel", name, &mut state.qvel[d..d + dofs], self.speed);
            draw("force", name, &mut state.qfrc_applied[d..d + dofs], self.force);
            draw("warm", name, &mut state.qacc_warmstart[d..d + dofs], self.warm);
        }
        for (name, ctrl) in model.actuator_name.iter().zip(&mut state.ctrl) {
            draw("ctrl", name, std::slice::from_mut(ctrl), self.control);
        }
        for (name, address) in model.actuator_name.iter().zip(&model.actuator_actadr) {
            if let Some(k) = *address {
                draw("act", name, std::slice::from_mut(&mut state.act[k]), self.control);
            }
        }
        for (name, place) in model.body_name.iter().zip(&model.body_mocapid) {
            if let Some(k) = *place {
                draw("place", name, &mut state.mocap_pos[k], self.apart.min(0.5));
                draw("turn", name, &mut state.mocap_quat[k], self.apart);
            }
        }
        for (name, wrench) in model.body_name.iter().zip(&mut state.xfrc_applied).skip(1) {
            draw("wrench", name, wrench, self.wrench);
        }
    }
}

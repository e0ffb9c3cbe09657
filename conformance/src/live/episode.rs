//! Episodes that MuJoCo runs, for others to be compared with.

use babybench::mimo::{MimoJoints, lock};
use babybench::physics::{Params, Shared};

use super::{Case, Drive, Motion};
use crate::mujoco::Simulation;

/// Steps at rest before the first state of [`Motion::Rest`].
const REST: usize = 500;

/// Everything that determines an episode of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Episode {
    /// The way MIMo is moved.
    pub motion: Motion,
    /// Draws everything random, and the locked joints.
    pub seed: u64,
}

impl Episode {
    /// Returns `n` episodes that cycle through all motions.
    pub fn mixed(n: usize) -> Vec<Self> {
        let motion = |k: usize| Motion::ALL[k % Motion::ALL.len()];
        (0..n)
            .map(|k| Self {
                motion: motion(k),
                seed: k as u64 + 1,
            })
            .collect()
    }

    /// Locks of the episode: in every third none, in every third the feet and eyes, otherwise random joints at random angles.
    pub fn params(&self, case: &Case, drive: &mut Drive) -> Shared<Params> {
        let mut params = case.params.clone();
        let m = &case.model;
        let turn = self.seed / Motion::ALL.len() as u64 % 3;
        for j in MimoJoints::new(m).joint {
            let rng = drive.rng();
            let angle = match turn {
                0 => continue,
                1 if !["foot", "toe", "eye"].iter().any(|part| m.jnt_name[j].contains(part)) => continue,
                1 => 0.0,
                _ if rng.bool() => continue,
                _ => m.jnt_range[j][0] + (m.jnt_range[j][1] - m.jnt_range[j][0]) * rng.f64(),
            };
            // joints that other constraints hold stay theirs
            let _ = lock(m, &mut params, j.into(), angle);
        }
        params
    }

    /// Moves the simulation to the start, `qpos0` with random velocities, and returns the controls.
    pub fn start(&self, case: &Case, simulation: &mut Simulation) -> (Drive, Shared<Params>) {
        let mut drive = Drive::new(&case.model, self.motion, self.seed);
        let params = self.params(case, &mut drive);
        simulation.reset();
        simulation.set_params(&case.model, &params);
        let mut qvel = vec![0.0; case.model.nv];
        for d in MimoJoints::new(&case.model).dof {
            qvel[d] = 2.0 * (drive.rng().f64() - 0.5);
        }
        if self.motion == Motion::Topple {
            for d in case.object_dofs() {
                qvel[d] = 4.0 * (drive.rng().f64() - 0.5);
            }
        }
        let qpos = simulation.qpos().to_vec();
        simulation.set_motion(&qpos, &qvel);
        if self.motion == Motion::Rest {
            (0..REST).for_each(|_| simulation.step());
        }
        (drive, params)
    }
}

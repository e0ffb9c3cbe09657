//! Velocity and angular momentum of bodies together with all bodies below them.

use crate::math::*;
use crate::model::Model;
use crate::spatial::*;
use crate::state::State;

/// Velocities and angular momenta of subtrees.
#[derive(Clone, Debug, Default)]
pub struct SubtreeScratch {
    /// Velocity of the centre of mass of each subtree (nbody), m/s.
    pub(super) linvel: Vec<Vec3>,
    /// Angular momentum of each subtree about its centre of mass (nbody), kg m^2/s.
    pub(super) angmom: Vec<Vec3>,
    /// Velocity of the centre of mass of each body (nbody), m/s.
    velocity: Vec<Vec3>,
}

impl SubtreeScratch {
    /// Computes both from `cvel` (MuJoCo's `mj_subtreeVel`).
    #[doc(alias = "mj_subtreeVel")]
    pub(super) fn update(&mut self, model: &Model, s: &State) {
        let nb = model.nbody();
        self.linvel.resize(nb, [0.0; 3]);
        self.angmom.resize(nb, [0.0; 3]);
        self.velocity.resize(nb, [0.0; 3]);
        for b in 0..nb {
            let offset = sub(s.xipos[b], s.subtree_com[model.body_rootid[b]]);
            self.velocity[b] = velocity_at(&s.cvel[b], offset);
            self.linvel[b] = scale(self.velocity[b], s.params.body_mass[b]);
            let turning = mat_t_vec(&s.ximat[b], angular(&s.cvel[b]));
            let inertia = s.params.body_inertia[b];
            self.angmom[b] = mat_vec(&s.ximat[b], std::array::from_fn(|k| inertia[k] * turning[k]));
        }
        // momentum of the subtrees, then velocity
        for b in (0..nb).rev() {
            if b > 0 {
                let p = model.body_parentid[b];
                self.linvel[p] = add(self.linvel[p], self.linvel[b]);
            }
            self.linvel[b] = scale(self.linvel[b], 1.0 / s.params.body_subtreemass[b].max(MINVAL));
        }
        for b in (1..nb).rev() {
            let p = model.body_parentid[b];
            // of the body about the centre of its subtree
            let (arm, v) = (sub(s.xipos[b], s.subtree_com[b]), sub(self.velocity[b], self.linvel[b]));
            let own = cross(arm, scale(v, s.params.body_mass[b]));
            self.angmom[b] = add(self.angmom[b], own);
            self.angmom[p] = add(self.angmom[p], self.angmom[b]);
            // of the subtree about the centre of the parent's
            let (arm, v) = (
                sub(s.subtree_com[b], s.subtree_com[p]),
                sub(self.linvel[b], self.linvel[p]),
            );
            let moved = cross(arm, scale(v, s.params.body_subtreemass[b]));
            self.angmom[p] = add(self.angmom[p], moved);
        }
    }
}

//! Another mass, inertia and size for a free body.

use crate::error::EngineError;
use crate::math::{Vec3, column, cross, dot, quat_to_mat};
use crate::mjcf_loader::bounding_radius;
use crate::model::{GeomType, JointType, Model};
use crate::state::State;

/// The values of a body that [`State::set_free_body`] sets; `None` leaves one as it is.
///
/// ```
/// use mjcf_sim::physics::FreeBody;
///
/// let ball = FreeBody::sphere(0.3, 0.02);
/// assert_eq!((ball.mass, ball.size), (Some(0.3), Some([0.02, 0.0, 0.0])));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FreeBody {
    /// Mass, kg, > 0.
    pub mass: Option<f64>,
    /// Principal moments of inertia, kg m^2, > 0.
    pub inertia: Option<Vec3>,
    /// Size of its first geom, m; see [`GeomType`](crate::model::GeomType).
    pub size: Option<Vec3>,
}

impl FreeBody {
    /// Returns a solid ball of a mass (kg) and a radius (m).
    pub fn sphere(mass: f64, radius: f64) -> Self {
        Self {
            mass: Some(mass),
            inertia: Some([2.0 * mass * radius * radius / 5.0; 3]),
            size: Some([radius, 0.0, 0.0]),
        }
    }
}

impl State {
    /// Changes the mass, inertia or size of a body from the next step. The body must be in the world, have a free joint and carry
    /// no other body. A reset of the environment restores the model's values. Pictures and touch sensors keep the size of the model.
    ///
    /// Derived quantities (inverse weights, masses of subtrees) follow in closed form: with mass `m`, moments
    /// `I` and centre of mass `c` in the body, `1/m` and the mean of `1/I`, and for the translations of the joint
    /// `1/m + sum |c x axis|^2 / (3 I)`. MuJoCo's `mj_setConst` computes the same at `qpos0`, except for the mean inertia that
    /// scales the solver's tolerance, which stays that of the model.
    ///
    /// ```
    /// use mjcf_sim::Simulation;
    /// use mjcf_sim::physics::FreeBody;
    ///
    /// let mut scene = Simulation::from_text(
    ///     "<mujoco><worldbody><body name='ball'><freejoint/><geom size='.1'/></body></worldbody></mujoco>")?;
    /// let model = scene.model().clone();
    /// let ball = model.body("ball").ok_or("no ball")?;
    /// scene.state.set_free_body(&model, ball, FreeBody::sphere(5.0, 0.05))?;
    /// assert_eq!(scene.state.params.body_mass[ball], 5.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// A body that does not exist or is not free, numbers that are not positive and finite; nothing is changed then.
    pub fn set_free_body(&mut self, model: &Model, body: usize, change: FreeBody) -> Result<(), EngineError> {
        let count = model.nbody();
        if body >= count {
            return Err(EngineError::NoBody { body, count });
        }
        self.params.fits(model)?;
        let joint = model.body_jntadr[body];
        let alone = model.body_parentid[body] == 0
            && !model.body_parentid.contains(&body)
            && model.body_jntnum[body] == 1
            && model.jnt_type[joint] == JointType::Free;
        if !alone {
            let body = model.body_name[body].clone();
            return Err(EngineError::NotFree { body });
        }
        let p = &self.params;
        let mass = change.mass.unwrap_or(p.body_mass[body]);
        let inertia = change.inertia.unwrap_or(p.body_inertia[body]);
        check("mass", &[mass])?;
        check("inertia", &inertia)?;
        if let Some(size) = change.size {
            self.resize(model, body, size)?;
        }
        self.weigh(model, body, mass, inertia);
        Ok(())
    }

    /// Changes the size of the first geom of a body.
    fn resize(&mut self, model: &Model, body: usize, size: Vec3) -> Result<(), EngineError> {
        let geom = model.body_geomadr[body];
        // meshes and height fields stay as they are
        if model.body_geomnum[body] == 0 || matches!(model.geom_type[geom], GeomType::HField | GeomType::Mesh) {
            let body = model.body_name[body].clone();
            return Err(EngineError::NoGeom { body });
        }
        let used = model.geom_size[geom]
            .iter()
            .rposition(|s| *s > 0.0)
            .map_or(0, |last| last + 1);
        check("size", &size[..used])?;
        let mut kept = [0.0; 3];
        kept[..used].copy_from_slice(&size[..used]);
        self.params.geom_size[geom] = kept;
        self.params.geom_rbound[geom] = bounding_radius(model.geom_type[geom], &kept);
        Ok(())
    }

    /// Changes mass and inertia of a free body, and the parameters that depend on them.
    fn weigh(&mut self, model: &Model, body: usize, mass: f64, inertia: Vec3) {
        let p = &mut *self.params;
        (p.body_mass[body], p.body_inertia[body]) = (mass, inertia);
        p.body_subtreemass.clone_from(&p.body_mass);
        for b in (1..model.nbody()).rev() {
            p.body_subtreemass[model.body_parentid[b]] += p.body_subtreemass[b];
        }
        let turn = inertia.iter().map(|i| 1.0 / i).sum::<f64>() / 3.0;
        p.body_invweight0[body] = [1.0 / mass, turn];
        let (centre, axes) = (model.body_ipos[body], quat_to_mat(model.body_iquat[body]));
        let lever = |k: usize| {
            let arm = cross(centre, column(&axes, k));
            dot(arm, arm) / inertia[k]
        };
        let shift = 1.0 / mass + (lever(0) + lever(1) + lever(2)) / 3.0;
        let dof = model.body_dofadr[body];
        p.dof_invweight0[dof..dof + 3].fill(shift);
        p.dof_invweight0[dof + 3..dof + 6].fill(turn);
    }
}

/// Checks that numbers are positive and finite.
fn check(what: &'static str, values: &[f64]) -> Result<(), EngineError> {
    let bad = |v: &f64| !(v.is_finite() && *v > 0.0);
    match values.iter().position(bad) {
        Some(index) => Err(EngineError::NotPositive {
            what,
            index,
            value: values[index],
        }),
        None => Ok(()),
    }
}

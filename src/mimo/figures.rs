//! MIMo's stature and mass.

use super::MimoJoints;
use super::growth::head_circumference;
use super::placement::reach;
use crate::math::{column, dot, mat_t_vec};
use crate::model::Model;
use crate::physics::{State, Topology, kinematics};

/// The figures of a body that are listed in tables of infants, with all joints at 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyFigures {
    /// From the soles to the crown, m.
    pub stature: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Height of the centre of mass above the soles, m.
    pub center_of_mass: f64,
}

impl BodyFigures {
    /// Measures the MIMo of a scene; `None` if it has none.
    ///
    /// ```
    /// use babybench::mimo::BodyFigures;
    /// use babybench::{Blueprint, Config};
    ///
    /// let newborn = Config { age: Some(0.0), touch_active: false, vision_active: false, ..Config::default() };
    /// let figures = BodyFigures::of(Blueprint::new(newborn)?.model()).expect("there is a MIMo");
    /// assert!((figures.stature - 0.5046).abs() < 1e-4 && (figures.mass - 2.910).abs() < 1e-3);
    /// # Ok::<(), babybench::EnvError>(())
    /// ```
    pub fn of(model: &Model) -> Option<Self> {
        let hip = model.body("hip")?;
        let mut state = State::new(model, &Topology::new(model));
        for q in MimoJoints::new(model).qpos {
            state.qpos[q] = 0.0;
        }
        kinematics(model, &mut state);
        let [soles, crown] = upright_extent(model, &state, hip);
        // along MIMo's own axis, because he may lie
        let up = column(&state.xmat[hip], 2);
        let bodies = (0..model.nbody()).filter(|&b| model.in_subtree(b, hip));
        let (mut mass, mut moment) = (0.0, 0.0);
        for body in bodies {
            mass += model.body_mass[body];
            moment += model.body_mass[body] * dot(up, state.xipos[body]);
        }
        Some(Self {
            stature: crown - soles,
            mass,
            center_of_mass: moment / mass - soles,
        })
    }

    /// Returns the length from the crown to the lowest point of the hip, m, with all joints at 0; `None` without a MIMo.
    pub fn crown_rump(model: &Model) -> Option<f64> {
        let hip = model.body("hip")?;
        let mut state = State::new(model, &Topology::new(model));
        for q in MimoJoints::new(model).qpos {
            state.qpos[q] = 0.0;
        }
        kinematics(model, &mut state);
        let [_, crown] = upright_extent(model, &state, hip);
        let up = column(&state.xmat[hip], 2);
        let rump = (0..model.ngeom()).filter(|&g| model.geom_bodyid[g] == hip).map(|g| {
            let far = reach(
                model.geom_type[g],
                model.geom_size[g],
                mat_t_vec(&state.geom_xmat[g], up),
            );
            dot(up, state.geom_xpos[g]) - far
        });
        Some(crown - rump.fold(f64::INFINITY, f64::min))
    }
}

impl BodyFigures {
    /// Returns the circumference of the head, m, as the key `head_circumference` has it; `None` without a MIMo.
    pub fn head_circumference(model: &Model) -> Option<f64> {
        let geom = model.body_geomadr[model.body("head")?];
        Some(head_circumference(model.geom_size.get(geom)?[0]) / 100.0)
    }
}

/// Returns the lowest and the highest point of MIMo along the axis from his hip (the body `hip`) to his chest, m.
pub fn upright_extent(model: &Model, state: &State, hip: usize) -> [f64; 2] {
    let up = column(&state.xmat[hip], 2);
    let own = |g: &usize| model.in_subtree(model.geom_bodyid[*g], hip);
    let geoms = (0..model.ngeom()).filter(own).map(|g| {
        let at = dot(up, state.geom_xpos[g]);
        let far = reach(
            model.geom_type[g],
            model.geom_size[g],
            mat_t_vec(&state.geom_xmat[g], up),
        );
        [at - far, at + far]
    });
    geoms.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| {
        [low.min(a), high.max(b)]
    })
}

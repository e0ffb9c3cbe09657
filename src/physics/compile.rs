//! The last stage of compilation: the constants that need dynamics.

use crate::dynamics::{MAX_WEIGHT, constants};
use crate::length_range;
use crate::mjcf_loader::{LoadError, Locations, Spec};
use crate::model::{Arrays, BiasType, Constants, GainType, JointType, Model, SameFrame, SolverType};

const NO_ACCELERATION: &str =
    "the inertia at qpos0 is singular or ill-conditioned: redundant joints, or masses of extreme size or ratio";
const NO_DAMPING: &str = "a damping ratio needs a gain that is not negative: give kv instead";
const IDLE_MUSCLE: &str = "the muscle moves nothing at qpos0, so that scale gives no force: give force, or let its ends move against each other";
const REDUNDANT: &str = "two joints of one kind along one axis of a body that stands alone, of which MuJoCo lets each move the whole inertia: make them one";
const ISLANDS: &str = "island=\"enable\" lets conjugate gradients stop for each island apart, which is not done here: leave it out, or choose another \
    solver, with which it changes nothing";
const NO_STATISTICS: &str = "sizes or masses are too large for the statistics of the model";

/// Acceleration per unit force below which a muscle moves nothing.
const MIN_ACCELERATION: f64 = 1e-10;

/// Compiles a document into a model, as MuJoCo's `mj_compile` does: the only way to a [`Model`].
///
/// ```
/// use mjcf_sim::assets::MemoryAssets;
/// use mjcf_sim::mjcf_loader::load_str;
/// use mjcf_sim::physics::{Engine, SoftEngine, SoftOptions, compile};
///
/// let text = "<mujoco><worldbody><body pos='0 0 1'><freejoint/><geom size='.1'/></body></worldbody></mujoco>";
/// let model = compile(load_str(text, "ball.xml", &MemoryAssets::new())?)?;
/// let mut engine = SoftEngine::new(model.into(), SoftOptions::default());
/// let mut state = engine.new_state();
/// engine.step(&mut state)?;
/// assert!((state.qvel[2] + 0.002 * 9.81).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A joint-space inertia at `qpos0` that is singular, numbers that are not finite, muscles whose lengths have no bounds; with the place
/// of the element.
#[doc(alias = "mj_compile")]
pub fn compile(spec: Spec) -> Result<Model, LoadError> {
    let (arrays, places, lengthrange) = spec.into_parts();
    let constants = constants(&arrays);
    check(&arrays, &constants, &places)?;
    let model = Model::new(arrays, constants);
    if model.opt.flags.island && model.opt.solver == SolverType::Cg {
        return Err(places.body_error(0, ISLANDS));
    }
    length_range::complete(model, &lengthrange, &places)
}

/// Finds a body whose inertia MuJoCo treats as diagonal (`body_simple`) although two of its joints move it in the same way: a body without children,
/// in the world or in a static body of the world, whose joints are at its centre of mass and along its axes.
fn redundant(arrays: &Arrays) -> Option<usize> {
    let at_centre = |j: usize| arrays.jnt_pos[j].iter().all(|v| v.abs() < 1e-6);
    let axis = |j: usize| {
        let mut along = (0..3).filter(|&k| arrays.jnt_axis[j][k].abs() > 1e-14);
        along.next().filter(|_| along.next().is_none())
    };
    (1..arrays.nbody()).find(|&b| {
        let parent = arrays.body_parentid[b];
        let alone = arrays.body_parentid[parent] == 0
            && arrays.body_jntnum[parent] == 0
            && arrays.body_parentid.get(b + 1) != Some(&b)
            && arrays.body_sameframe[b] == SameFrame::Body;
        let joints = arrays.body_jntadr[b]..arrays.body_jntadr[b] + arrays.body_jntnum[b];
        let kinds: Option<Vec<_>> = joints
            .map(|j| axis(j).filter(|_| at_centre(j)).map(|axis| (arrays.jnt_type[j], axis)))
            .collect();
        let twice = |kinds: Vec<(JointType, usize)>| (1..kinds.len()).any(|k| kinds[..k].contains(&kinds[k]));
        alone && kinds.is_some_and(twice)
    })
}

/// Refuses constants that are not finite, or that consist of rounding errors because of a singular inertia.
fn check(arrays: &Arrays, constants: &Constants, places: &Locations) -> Result<(), LoadError> {
    if let Some(body) = redundant(arrays) {
        return Err(places.body_error(body, REDUNDANT));
    }
    for (d, (weight, inertia)) in constants.dof_invweight0.iter().zip(&constants.dof_m0).enumerate() {
        // those of free and ball joints are means over three directions, which differ as the body's axes do
        let alone = arrays.jnt_type[arrays.dof_jntid[d]].nv() == 1;
        let singular = alone && (*weight < 0.0 || weight * inertia > MAX_WEIGHT);
        if !weight.is_finite() || !inertia.is_finite() || singular {
            return Err(places.body_error(arrays.dof_bodyid[d], NO_ACCELERATION));
        }
    }
    for (b, weights) in constants.body_invweight0.iter().enumerate() {
        if !weights.iter().all(|weight| weight.is_finite()) {
            return Err(places.body_error(b, NO_ACCELERATION));
        }
    }
    for (t, weight) in constants.tendon_invweight0.iter().enumerate() {
        if !weight.is_finite() {
            return Err(places.tendon_error(t, NO_ACCELERATION));
        }
    }
    for (i, bias) in constants.actuator_biasprm.iter().enumerate() {
        if !bias.iter().all(|value| value.is_finite()) {
            return Err(places.actuator_error(i, NO_DAMPING));
        }
    }
    for (i, acc0) in constants.actuator_acc0.iter().enumerate() {
        let gain = arrays.actuator_gaintype[i] == GainType::Muscle && arrays.actuator_gainprm[i][2] < 0.0;
        let bias = arrays.actuator_biastype[i] == BiasType::Muscle && arrays.actuator_biasprm[i][2] < 0.0;
        // MuJoCo divides by what rounding errors leave
        if (gain || bias) && *acc0 < MIN_ACCELERATION {
            return Err(places.actuator_error(i, IDLE_MUSCLE));
        }
    }
    let stat = &constants.stat;
    let scalars = [stat.meaninertia, stat.meanmass, stat.meansize, stat.extent];
    if scalars.iter().chain(&stat.center).all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(places.body_error(0, NO_STATISTICS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::MemoryAssets;
    use crate::mjcf_loader::load_str;

    #[test]
    fn islands_are_taken_where_they_make_no_difference() {
        let with = |solver: &str| {
            let text = format!("<mujoco><option solver='{solver}'><flag island='enable'/></option></mujoco>");
            load_str(&text, "m.xml", &MemoryAssets::new()).and_then(compile)
        };
        assert!(with("Newton").is_ok() && with("PGS").is_ok());
        let error = with("CG").expect_err("CG").to_string();
        assert!(
            error.starts_with("m.xml:1:1: mujoco: island=\"enable\" lets conjugate gradients"),
            "{error}"
        );
    }

    #[test]
    fn springs_follow_from_time_constants() {
        let text = "<mujoco><worldbody><body><joint type='slide' springdamper='.1 .5' stiffness='7' damping='9'/>
            <geom size='.1' mass='2'/></body></worldbody></mujoco>";
        let model = load_str(text, "m.xml", &MemoryAssets::new())
            .and_then(compile)
            .expect("valid");
        // 2 kg: m / (t^2 r^2) and 2 m / t
        assert!(
            (model.jnt_stiffness[0] - 800.0).abs() < 1e-9,
            "{}",
            model.jnt_stiffness[0]
        );
        assert!((model.dof_damping[0] - 40.0).abs() < 1e-9, "{}", model.dof_damping[0]);
        let bad = text.replace(".1 .5", ".1 0");
        let error = load_str(&bad, "m.xml", &MemoryAssets::new()).expect_err("no damping ratio");
        assert!(
            error
                .to_string()
                .ends_with("both numbers of springdamper must be positive"),
            "{error}"
        );
    }
}

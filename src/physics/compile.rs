//! The last step from a document to a model: the constants that need dynamics.

use crate::mjcf_loader::{LoadError, Places, Spec};
use crate::model::{Arrays, Constants, JointType, Model};
use crate::physics::dynamics::{MAX_WEIGHT, constants};

const NO_ACCELERATION: &str =
    "the inertia at qpos0 is singular or ill-conditioned: redundant joints, or masses of extreme size or ratio";
const NO_STATISTICS: &str = "sizes or masses are too large for the statistics of the model";

/// Compiles a document into a model, as MuJoCo's `mj_compile` does: the only way to a [`Model`].
///
/// ```
/// use babybench::assets::MemoryAssets;
/// use babybench::mjcf_loader::load_str;
/// use babybench::physics::{Engine, SoftEngine, SoftOptions, compile};
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
/// A joint-space inertia at `qpos0` that is singular, numbers that are not finite; with the place of the element.
#[doc(alias = "mj_compile")]
pub fn compile(spec: Spec) -> Result<Model, LoadError> {
    let (arrays, places) = spec.into_parts();
    let constants = constants(&arrays);
    check(&arrays, &constants, &places)?;
    Ok(Model::new(arrays, constants))
}

/// Refuses constants that are not finite, or that a singular inertia leaves to rounding errors.
fn check(arrays: &Arrays, constants: &Constants, places: &Places) -> Result<(), LoadError> {
    for (d, (weight, inertia)) in constants.dof_invweight0.iter().zip(&constants.dof_m0).enumerate() {
        // those of a free joint are means over three directions, which differ as the body's axes do
        let alone = arrays.jnt_type[arrays.dof_jntid[d]] != JointType::Free;
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
    let stat = &constants.stat;
    let scalars = [stat.meaninertia, stat.meanmass, stat.meansize, stat.extent];
    if scalars.iter().chain(&stat.center).all(|value| value.is_finite()) {
        Ok(())
    } else {
        Err(places.body_error(0, NO_STATISTICS))
    }
}

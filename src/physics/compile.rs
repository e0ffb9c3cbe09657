//! The last step from a document to a model: the constants that need dynamics.

use crate::mjcf_loader::{LoadError, Places, Spec};
use crate::model::{Arrays, Constants, JointType, Model, SameFrame};
use crate::physics::dynamics::{MAX_WEIGHT, constants};

const NO_ACCELERATION: &str =
    "the inertia at qpos0 is singular or ill-conditioned: redundant joints, or masses of extreme size or ratio";
const NO_DAMPING: &str = "a damping ratio needs a gain that is not negative: give kv instead";
const REDUNDANT: &str = "two joints of one kind along one axis of a body that stands alone, of which MuJoCo lets each move the whole inertia: make them one";
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

/// Finds a body whose inertia MuJoCo takes for diagonal (`body_simple`) although two of its joints move it alike: one without
/// children, in the world or in a static body of the world, whose joints are at its centre of mass and along its axes.
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

/// Refuses constants that are not finite, or that a singular inertia leaves to rounding errors.
fn check(arrays: &Arrays, constants: &Constants, places: &Places) -> Result<(), LoadError> {
    if let Some(body) = redundant(arrays) {
        return Err(places.body_error(body, REDUNDANT));
    }
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
    for (i, bias) in constants.actuator_biasprm.iter().enumerate() {
        if !bias.iter().all(|value| value.is_finite()) {
            return Err(places.actuator_error(i, NO_DAMPING));
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

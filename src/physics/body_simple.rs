//! Bodies whose inertia MuJoCo treats as diagonal (`body_simple`).

use crate::math::QUAT_ID;
use crate::model::{Arrays, JointType, SameFrame};

/// Returns whether MuJoCo uses the inverse mass of a body as it is, instead of the mean over directions: a [simple](is_simple) body with slide
/// joints only (`body_simple` 2).
pub fn slides_alone(model: &Arrays, b: usize) -> bool {
    let joints = model.body_jntadr[b]..model.body_jntadr[b] + model.body_jntnum[b];
    is_simple(model, b) && joints.into_iter().all(|j| model.jnt_type[j] == JointType::Slide)
}

/// Returns whether MuJoCo treats the inertia of a body as diagonal (`body_simple`): a body without children, in the world or in a static
/// body of the world. Its frame is that of its inertia, its joints are at the origin and along the axes of this frame, and none of
/// them follows a rotation.
pub fn is_simple(model: &Arrays, b: usize) -> bool {
    // what is smaller counts as zero in MuJoCo's compiler
    const EPS: f64 = 1e-14;
    let joints = model.body_jntadr[b]..model.body_jntadr[b] + model.body_jntnum[b];
    let along_axis = |j: usize| model.jnt_axis[j].iter().filter(|v| v.abs() > EPS).count() == 1;
    let turns = |j: usize| matches!(model.jnt_type[j], JointType::Hinge | JointType::Ball);
    let parent = model.body_parentid[b];
    let on_the_ground = model.body_parentid[parent] == 0 && model.body_jntnum[parent] == 0;
    // a child, if there is one, comes next
    on_the_ground
        && model.body_parentid.get(b + 1) != Some(&b)
        && model.body_sameframe[b] == SameFrame::Body
        && !joints.is_empty()
        && !joints.clone().skip(1).any(|j| turns(j - 1))
        && joints.into_iter().all(|j| {
            let at_origin = SameFrame::of(model.jnt_pos[j], QUAT_ID, [0.0; 3], QUAT_ID) == SameFrame::Body;
            along_axis(j) && at_origin
        })
}

/// Returns for each body whether it is simple with slide joints only, in models with flexes.
pub fn alone(model: &Arrays) -> Vec<bool> {
    if model.flexes.is_empty() {
        return Vec::new();
    }
    (0..model.nbody()).map(|b| slides_alone(model, b)).collect()
}

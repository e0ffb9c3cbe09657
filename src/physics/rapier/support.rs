//! Checks that Rapier's multibodies can represent a model.

use crate::RapierError;
use mjcf_sim_model::model::{EqualityKind, GeomType, JointType, Model, Wrap};
use mjcf_sim_physics::topology::Topology;

/// Refuses models that Rapier's multibodies cannot represent.
pub(super) fn check(model: &Model, topology: &Topology) -> Result<(), RapierError> {
    if let Some(b) = model.body_mocapid.iter().position(Option::is_some) {
        let what = "mocap bodies are not supported";
        return Err(RapierError::unsupported("body", &model.body_name[b], what));
    }
    joints(model)?;
    if let Some(i) = (0..model.nu()).find(|&i| model.actuator_turns(i).is_some()) {
        let what = "free joints have no actuators";
        return Err(RapierError::unsupported("actuator", &model.actuator_name[i], what));
    }
    couplings(model, topology)?;
    shapes(model)
}

/// Refuses joints that multibodies do not support.
fn joints(model: &Model) -> Result<(), RapierError> {
    for j in 0..model.njnt() {
        let b = model.jnt_bodyid[j];
        let what = match model.jnt_type[j] {
            JointType::Slide => "slide joints are not supported",
            JointType::Ball => "ball joints are not supported",
            JointType::Free if model.body_jntnum[b] > 1 => "a free joint must be the only one of its body",
            JointType::Free if model.body_parentid[b] != 0 => "a free joint must be on a child of the world",
            _ => continue,
        };
        return Err(RapierError::unsupported("joint", &model.jnt_name[j], what));
    }
    Ok(())
}

/// Refuses tendons and equalities that do not couple two coordinates of a multibody.
fn couplings(model: &Model, topology: &Topology) -> Result<(), RapierError> {
    let tree = |j: usize| topology.dof_tree[model.jnt_dofadr[j]];
    for t in 0..model.ntendon() {
        if model.tendon_frictionloss[t] > 0.0 {
            let what = "a tendon cannot have dry friction";
            return Err(RapierError::unsupported("tendon", &model.tendon_name[t], what));
        }
        if model.tendon_is_spatial(t) {
            let what = "spatial tendons are not supported";
            return Err(RapierError::unsupported("tendon", &model.tendon_name[t], what));
        }
        let scalar = |along: &Wrap| match *along {
            Wrap::Joint { joint, .. } => matches!(model.jnt_type[joint], JointType::Hinge | JointType::Slide),
            _ => false,
        };
        if !model.tendon_wrap[t].iter().all(scalar) {
            let what = "a tendon over ball and free joints is not supported";
            return Err(RapierError::unsupported("tendon", &model.tendon_name[t], what));
        }
        let pair = matches!(model.tendon_wrap[t][..], [Wrap::Joint { joint: a, coef: x }, Wrap::Joint { joint: b, coef: y }]
            if a != b && x != 0.0 && y != 0.0 && tree(a) == tree(b));
        if model.tendon_limited[t] && !pair {
            let what = "a limited tendon must span two joints of the same tree";
            return Err(RapierError::unsupported("tendon", &model.tendon_name[t], what));
        }
    }
    if let Some(flex) = model.flexes.first() {
        return Err(RapierError::unsupported(
            "flex",
            &flex.name,
            "deformable bodies are not supported",
        ));
    }
    for e in 0..model.neq() {
        if let EqualityKind::Tendon { .. } = model.eq_kind[e] {
            let what = "tendons cannot be held";
            return Err(RapierError::unsupported("equality", &model.eq_name[e], what));
        }
        if let EqualityKind::Joint {
            joint1,
            joint2: Some(joint2),
            ..
        } = model.eq_kind[e]
            && (joint1 == joint2 || tree(joint1) != tree(joint2))
        {
            let what = "a joint equality must be between two joints of the same tree";
            return Err(RapierError::unsupported("equality", &model.eq_name[e], what));
        }
    }
    Ok(())
}

/// Refuses shapes that Parry does not support, if anything could touch them.
fn shapes(model: &Model) -> Result<(), RapierError> {
    for g in 0..model.ngeom() {
        let touches = model.geom_contype[g] | model.geom_conaffinity[g] != 0
            || model.pair_geom.iter().any(|pair| pair.contains(&g));
        let what = match model.geom_type[g] {
            GeomType::Ellipsoid => "Parry has no ellipsoid that things could touch",
            GeomType::HField => "height fields that things could touch are the soft engine's only",
            _ => continue,
        };
        if touches {
            return Err(RapierError::unsupported("geom", &model.geom_name[g], what));
        }
    }
    Ok(())
}

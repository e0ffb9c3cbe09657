//! Compiles actuators.

use super::context::{Context, Ids, User};
use crate::mjcf_loader::actuator::Actuator;
use crate::mjcf_loader::document::Document;
use crate::mjcf_loader::error::{ErrorKind, LoadError};
use crate::model::{Arrays, BiasType, DynType, GainType};

const FILTERED: &str =
    "inheritrange is for actuators whose control or integral is a position, and this one has a filter";
const IN_PARENT: &str = "inheritrange needs the attribute joint, not jointinparent";
const WITHOUT_RANGE: &str = "inheritrange is used, but the joint has no range";
const NO_ACTIVATION: &str = "actrange applies, but the actuator has no activation: set dyntype, or actlimited to false";
const STATELESS: &str = "actdim must be 0 or left out where dyntype is none";
const STATEFUL: &str = "actdim must be 1 or left out: each activation is one number";

/// Compiles the actuators, whose user data all get the length of the longest or of `nuser_actuator`.
pub(super) fn compile_actuators(
    context: &Context,
    document: &Document,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let users = document.actuators.iter().map(|actuator| &actuator.user);
    let users = User::new("nuser_actuator", document.size.nuser_actuator, users);
    for actuator in &document.actuators {
        let user = users.of(context, actuator.at, &actuator.user)?;
        let joint = transmission(context, actuator, ids, arrays)?;
        let (ctrlrange, actrange) = ranges(context, actuator, arrays.jnt_range[joint])?;
        let limited = |attribute, limited, range| context.limited(actuator.at, attribute, limited, range);
        arrays.actuator_name.push(actuator.name.clone());
        arrays.actuator_trnid.push(joint);
        arrays.actuator_gear.push(actuator.gear);
        arrays
            .actuator_ctrllimited
            .push(limited("ctrlrange", actuator.control.limited, ctrlrange)?);
        arrays.actuator_ctrlrange.push(ctrlrange);
        arrays
            .actuator_forcelimited
            .push(limited("forcerange", actuator.forcelimited, actuator.forcerange)?);
        arrays.actuator_forcerange.push(actuator.forcerange);
        arrays.actuator_lengthrange.push(actuator.lengthrange);
        let law = &actuator.law;
        arrays
            .actuator_actlimited
            .push(limited("actrange", law.actlimited, actrange)?);
        arrays.actuator_actrange.push(actrange);
        compile_law(context, actuator, arrays)?;
        arrays.actuator_user.push(user);
    }
    Ok(())
}

/// Returns the joint that an actuator drives.
fn transmission(context: &Context, actuator: &Actuator, ids: &Ids, arrays: &Arrays) -> Result<usize, LoadError> {
    let (attribute, name) = match (&actuator.joint, &actuator.jointinparent) {
        (Some(name), _) => ("joint", name),
        (None, Some(name)) => ("jointinparent", name),
        (None, None) => return Err(context.error(actuator.at, ErrorKind::MissingAttribute("joint"))),
    };
    ids.scalar_joint(context, arrays, actuator.at, attribute, name)
}

/// Returns the ranges of control and activation: as given, or in the proportion `inheritrange` to that of the joint.
fn ranges(context: &Context, actuator: &Actuator, joint: [f64; 2]) -> Result<([f64; 2], [f64; 2]), LoadError> {
    let (law, given) = (&actuator.law, (actuator.ctrlrange, actuator.activation.range));
    let servo =
        law.gaintype == GainType::Fixed && law.biastype == BiasType::Affine && law.gainprm[0] == -law.biasprm[1];
    if !servo || actuator.inheritrange <= 0.0 {
        return Ok(given);
    }
    let [low, high] = joint;
    let wrong = match law.dyntype {
        DynType::Filter => Some(FILTERED),
        _ if actuator.joint.is_none() => Some(IN_PARENT),
        _ if low == high => Some(WITHOUT_RANGE),
        _ => None,
    };
    if let Some(wrong) = wrong {
        return Err(context.invalid(actuator.at, wrong));
    }
    let (mean, radius) = (0.5 * (high + low), 0.5 * (high - low) * actuator.inheritrange);
    let inherited = [mean - radius, mean + radius];
    match law.dyntype {
        DynType::Integrator => Ok((given.0, inherited)),
        _ => Ok((inherited, given.1)),
    }
}

/// Compiles what makes a force of control, length and velocity.
fn compile_law(context: &Context, actuator: &Actuator, arrays: &mut Arrays) -> Result<(), LoadError> {
    let law = &actuator.law;
    let stateful = law.dyntype != DynType::None;
    let wrong = match law.actdim {
        _ if !stateful && arrays.actuator_actlimited.last() == Some(&true) => Some(NO_ACTIVATION),
        1.. if !stateful => Some(STATELESS),
        0 | 2.. if stateful => Some(STATEFUL),
        _ => None,
    };
    if let Some(wrong) = wrong {
        return Err(context.invalid(actuator.at, wrong));
    }
    arrays.actuator_dyntype.push(law.dyntype);
    arrays.actuator_dynprm.push(law.dynprm);
    arrays.actuator_actearly.push(law.actearly);
    arrays.actuator_actadr.push(stateful.then_some(arrays.na));
    arrays.na += usize::from(stateful);
    arrays.actuator_gaintype.push(law.gaintype);
    arrays.actuator_gainprm.push(law.gainprm);
    arrays.actuator_biastype.push(law.biastype);
    arrays.actuator_biasprm.push(law.biasprm);
    Ok(())
}

//! Compiles actuators.

use super::context::{Context, Ids, User};
use crate::mjcf_loader::actuator::Actuator;
use crate::mjcf_loader::document::Document;
use crate::mjcf_loader::error::{ErrorKind, LoadError};
use crate::model::{Arrays, BiasType, DynType, GainType, TrnType};

const FILTERED: &str =
    "inheritrange is for actuators whose control or integral is a position, and this one has a filter";
const IN_PARENT: &str = "inheritrange needs the attribute joint, not jointinparent";
const WITHOUT_RANGE: &str = "inheritrange is used, but the joint or the tendon has no range";
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
        let (trntype, trnid) = transmission(context, actuator, ids, arrays)?;
        let range = match trntype {
            TrnType::Tendon => arrays.tendon_range[trnid],
            TrnType::Joint | TrnType::JointInParent => arrays.jnt_range[trnid],
        };
        let (ctrlrange, actrange) = ranges(context, actuator, range)?;
        let limited = |attribute, limited, range| context.limited(actuator.at, attribute, limited, range);
        arrays.actuator_name.push(actuator.name.clone());
        arrays.actuator_trntype.push(trntype);
        arrays.actuator_trnid.push(trnid);
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

/// Returns what an actuator acts on: kind and id.
fn transmission(
    context: &Context,
    actuator: &Actuator,
    ids: &Ids,
    arrays: &Arrays,
) -> Result<(TrnType, usize), LoadError> {
    let at = actuator.at;
    let joint = |attribute, name: &String| ids.scalar_joint(context, arrays, at, attribute, name);
    if let Some(name) = &actuator.joint {
        Ok((TrnType::Joint, joint("joint", name)?))
    } else if let Some(name) = &actuator.jointinparent {
        Ok((TrnType::JointInParent, joint("jointinparent", name)?))
    } else if let Some(name) = &actuator.tendon {
        Ok((TrnType::Tendon, ids.tendon.find(context.tree, at, "tendon", name)?))
    } else {
        Err(context.error(at, ErrorKind::MissingAttribute("joint")))
    }
}

/// Returns the ranges of control and activation: as given, or in the proportion `inheritrange` to that of what it acts on.
fn ranges(context: &Context, actuator: &Actuator, range: [f64; 2]) -> Result<([f64; 2], [f64; 2]), LoadError> {
    let (law, given) = (&actuator.law, (actuator.ctrlrange, actuator.activation.range));
    let servo =
        law.gaintype == GainType::Fixed && law.biastype == BiasType::Affine && law.gainprm[0] == -law.biasprm[1];
    if !servo || actuator.inheritrange <= 0.0 {
        return Ok(given);
    }
    let [low, high] = range;
    let wrong = match law.dyntype {
        DynType::Filter => Some(FILTERED),
        _ if actuator.jointinparent.is_some() => Some(IN_PARENT),
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

//! Compiles actuators.

use super::context::{Context, Ids, UserDataSize};
use crate::actuator::{Actuator, Target};
use crate::document::TypedDocument;
use crate::error::{ErrorKind, LoadError};
use crate::model::{Arrays, BiasType, DynType, GainType, TrnType};

const FILTERED: &str =
    "inheritrange is for actuators whose control or integral is a position, and this one has a filter";
const IN_PARENT: &str = "inheritrange needs the attribute joint or tendon";
const NO_ROD: &str = "cranklength of a slider-crank must be positive";
const WITHOUT_RANGE: &str = "inheritrange is used, but the joint or the tendon has no range";
const NO_ACTIVATION: &str = "actrange applies, but the actuator has no activation: set dyntype, or actlimited to false";
const STATELESS: &str = "actdim must be 0 or left out where dyntype is none";
const RANGE: &str = "the second number of the range of a muscle must be the greater";
const CURVE: &str = "a muscle needs lmin < 1 < lmax";
const SCALES: &str = "scale, vmax, fpmax and fvmax of a muscle must be positive";
const STATEFUL: &str = "actdim must be 1 or left out: each activation is one number";

/// Compiles the actuators, whose user data all get the length of the longest or of `nuser_actuator`.
pub(super) fn compile_actuators(
    context: &Context,
    document: &TypedDocument,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let users = document.actuators.iter().map(|actuator| &actuator.user);
    let users = UserDataSize::new("nuser_actuator", document.size.nuser_actuator, users);
    for actuator in &document.actuators {
        let user = users.of(context, actuator.at, &actuator.user)?;
        let (trntype, trnid, refid) = transmission(context, actuator, ids)?;
        let range = match trntype {
            TrnType::Tendon => Some(arrays.tendon_range[trnid]),
            // the range of a ball joint limits an angle, and a servo tracks coordinates
            TrnType::Joint | TrnType::JointInParent if arrays.jnt_type[trnid].nv() > 1 => None,
            TrnType::Joint | TrnType::JointInParent => Some(arrays.jnt_range[trnid]),
            TrnType::SliderCrank | TrnType::Site | TrnType::Body => None,
        };
        let (ctrlrange, actrange) = ranges(context, actuator, range)?;
        let limited = |attribute, limited, range| context.limited(actuator.at, attribute, limited, range);
        arrays.actuator_name.push(actuator.name.clone());
        arrays.actuator_group.push(actuator.group);
        arrays.actuator_trntype.push(trntype);
        arrays.actuator_trnid.push(trnid);
        arrays.actuator_refid.push(refid);
        arrays.actuator_cranklength.push(actuator.target.cranklength);
        arrays.actuator_gear.push(actuator.target.gear[0]);
        arrays.actuator_gear6.push(actuator.target.gear);
        arrays
            .actuator_ctrllimited
            .push(limited("ctrlrange", actuator.control.limited, ctrlrange)?);
        arrays.actuator_ctrlrange.push(ctrlrange);
        arrays
            .actuator_forcelimited
            .push(limited("forcerange", actuator.forcelimited, actuator.forcerange)?);
        arrays.actuator_forcerange.push(actuator.forcerange);
        arrays.actuator_lengthrange.push(actuator.target.lengthrange);
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

/// Returns the transmission of an actuator: kind, id, and the second id of kinds that have two.
fn transmission(
    context: &Context,
    actuator: &Actuator,
    ids: &Ids,
) -> Result<(TrnType, usize, Option<usize>), LoadError> {
    let at = actuator.at;
    let Target {
        joint,
        jointinparent,
        tendon,
        cranksite,
        slidersite,
        cranklength,
        ..
    } = &actuator.target;
    let find_joint = |attribute, name: &String| ids.joint.find(context.tree, at, attribute, name);
    let find_site = |attribute, name: &String| ids.site.find(context.tree, at, attribute, name);
    // the tables allow one of these attributes, so their order does not matter
    if let Some(name) = joint {
        Ok((TrnType::Joint, find_joint("joint", name)?, None))
    } else if let Some(name) = jointinparent {
        Ok((TrnType::JointInParent, find_joint("jointinparent", name)?, None))
    } else if let Some(name) = tendon {
        Ok((
            TrnType::Tendon,
            ids.tendon.find(context.tree, at, "tendon", name)?,
            None,
        ))
    } else if let Some(name) = cranksite {
        let Some(slider) = slidersite else {
            return Err(context.error(at, ErrorKind::MissingAttribute("slidersite")));
        };
        if *cranklength <= 0.0 {
            return Err(context.invalid(at, NO_ROD));
        }
        let crank = find_site("cranksite", name)?;
        Ok((TrnType::SliderCrank, crank, Some(find_site("slidersite", slider)?)))
    } else if let Some(name) = &actuator.at_site.site {
        // MuJoCo ignores an empty name
        let reference = actuator.at_site.refsite.as_ref().filter(|name| !name.is_empty());
        let reference = reference.map(|name| find_site("refsite", name)).transpose()?;
        Ok((TrnType::Site, find_site("site", name)?, reference))
    } else if let Some(name) = &actuator.on_body.body {
        Ok((TrnType::Body, ids.body.find(context.tree, at, "body", name)?, None))
    } else {
        Err(context.error(at, ErrorKind::MissingAttribute("joint")))
    }
}

/// Returns the ranges of control and activation: as given, or `inheritrange` times the range of the joint or tendon, around its middle.
fn ranges(context: &Context, actuator: &Actuator, range: Option<[f64; 2]>) -> Result<([f64; 2], [f64; 2]), LoadError> {
    let (law, given) = (&actuator.law, (actuator.ctrlrange, actuator.activation.range));
    // a position servo: force = kp (control - length) - kv velocity. MuJoCo recognises it by its numbers, not by its element.
    let servo =
        law.gaintype == GainType::Fixed && law.biastype == BiasType::Affine && law.gainprm[0] == -law.biasprm[1];
    if !servo || actuator.inheritrange <= 0.0 {
        return Ok(given);
    }
    let [low, high] = range.unwrap_or_default();
    let wrong = match law.dyntype {
        DynType::Filter | DynType::Muscle => Some(FILTERED),
        _ if range.is_none() || actuator.target.jointinparent.is_some() => Some(IN_PARENT),
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

/// Compiles the force law of an actuator: activation dynamics, gain and bias.
fn compile_law(context: &Context, actuator: &Actuator, arrays: &mut Arrays) -> Result<(), LoadError> {
    let law = &actuator.law;
    let stateful = law.dyntype != DynType::None;
    let muscle = [
        (law.gaintype == GainType::Muscle).then_some(&law.gainprm),
        (law.biastype == BiasType::Muscle).then_some(&law.biasprm),
    ];
    if let Some(wrong) = muscle.into_iter().flatten().find_map(check_muscle) {
        return Err(context.invalid(actuator.at, wrong));
    }
    let wrong = match law.actdim {
        // the caller has pushed the limit of this actuator
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

/// Returns a description of a fault in the gain or the bias of a muscle.
fn check_muscle(&[low, high, _, scale, lmin, lmax, vmax, fpmax, fvmax, _]: &[f64; 10]) -> Option<&'static str> {
    // the curves divide by high - low, 1 - lmin, lmax - 1 and vmax
    if low >= high {
        Some(RANGE)
    } else if lmin >= 1.0 || lmax <= 1.0 {
        Some(CURVE)
    } else if [scale, vmax, fpmax, fvmax].iter().any(|&v| v <= 0.0) {
        Some(SCALES)
    } else {
        None
    }
}

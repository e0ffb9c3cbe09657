//! Compiles actuators and sensors.

use super::context::{Context, Ids, user_length};
use crate::mjcf_loader::document::Document;
use crate::mjcf_loader::error::LoadError;
use crate::model::Arrays;

/// Compiles the actuators, whose user data all get the length of the longest or of `nuser_actuator`.
pub(super) fn compile_actuators(
    context: &Context,
    document: &Document,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let users = document.actuators.iter().map(|actuator| &actuator.user);
    let nuser = user_length(document.size.nuser_actuator, users);
    for actuator in &document.actuators {
        let excess = "user has more values than nuser_actuator";
        let user = context.user(actuator.at, &actuator.user, nuser, excess)?;
        let limited = |attribute, limited, range| context.limited(actuator.at, attribute, limited, range);
        arrays.actuator_name.push(actuator.name.clone());
        arrays
            .actuator_trnid
            .push(ids.scalar_joint(context, arrays, actuator.at, "joint", &actuator.joint)?);
        arrays.actuator_gear.push(actuator.gear);
        arrays
            .actuator_ctrllimited
            .push(limited("ctrlrange", actuator.ctrllimited, actuator.ctrlrange)?);
        arrays.actuator_ctrlrange.push(actuator.ctrlrange);
        arrays
            .actuator_forcelimited
            .push(limited("forcerange", actuator.forcelimited, actuator.forcerange)?);
        arrays.actuator_forcerange.push(actuator.forcerange);
        arrays.actuator_gainprm.push([actuator.gain, 0.0, 0.0]);
        arrays.actuator_biastype.push(actuator.biastype);
        arrays.actuator_biasprm.push(actuator.biasprm);
        arrays.actuator_user.push(user);
    }
    Ok(())
}

/// Compiles the sensors, of which each has three values.
pub(super) fn compile_sensors(
    context: &Context,
    document: &Document,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    for (index, sensor) in document.sensors.iter().enumerate() {
        let site = ids.site.find(context.tree, sensor.at, "site", &sensor.site)?;
        arrays.sensor_name.push(sensor.name.clone());
        arrays.sensor_type.push(sensor.kind);
        arrays.sensor_objid.push(site);
        arrays.sensor_adr.push(3 * index);
    }
    Ok(())
}

//! Actuators.

use babybench::Model;

use super::{Named, flags, flat, optional};

/// Returns the actuator arrays, reduced to what the model keeps.
pub fn actuators(m: &Model) -> Named {
    let seconds = m.actuator_trnid.iter().zip(&m.actuator_refid);
    let trnid = seconds.flat_map(|(&id, second)| [id as f64, second.map_or(-1.0, |id| id as f64)]);
    let trnid = trnid.collect();
    vec![
        ("actuator_trnid", trnid),
        ("actuator_gear", flat(&m.actuator_gear6)),
        ("actuator_ctrllimited", flags(&m.actuator_ctrllimited)),
        ("actuator_ctrlrange", flat(&m.actuator_ctrlrange)),
        ("actuator_forcelimited", flags(&m.actuator_forcelimited)),
        ("actuator_forcerange", flat(&m.actuator_forcerange)),
        ("actuator_gainprm", flat(&m.actuator_gainprm)),
        (
            "actuator_biastype",
            m.actuator_biastype.iter().map(|kind| f64::from(kind.code())).collect(),
        ),
        ("actuator_biasprm", flat(&m.actuator_biasprm)),
        ("actuator_user", m.actuator_user.iter().flatten().copied().collect()),
    ]
}

/// Returns the arrays of activations and gains, which recordings of scenes without them leave out.
pub fn activations(m: &Model) -> Named {
    let numbers = m.actuator_actadr.iter().map(|adr| f64::from(u8::from(adr.is_some())));
    vec![
        ("na", vec![m.na as f64]),
        (
            "actuator_dyntype",
            m.actuator_dyntype.iter().map(|kind| f64::from(kind.code())).collect(),
        ),
        ("actuator_dynprm", flat(&m.actuator_dynprm)),
        ("actuator_actadr", optional(&m.actuator_actadr)),
        ("actuator_actnum", numbers.collect()),
        ("actuator_actlimited", flags(&m.actuator_actlimited)),
        ("actuator_actrange", flat(&m.actuator_actrange)),
        ("actuator_actearly", flags(&m.actuator_actearly)),
        (
            "actuator_gaintype",
            m.actuator_gaintype.iter().map(|kind| f64::from(kind.code())).collect(),
        ),
        ("actuator_lengthrange", flat(&m.actuator_lengthrange)),
    ]
}

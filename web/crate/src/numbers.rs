//! Locations of numbers in the memory of the module, for JavaScript.

use babybench::physics::State;
use babybench::spaces::Values;

/// Finds a vector of the state by MuJoCo's name.
pub fn of_state<'a>(s: &'a State, name: &str) -> Option<Values<'a>> {
    Some(Values::F64(match name {
        "qpos" => &s.qpos,
        "qvel" => &s.qvel,
        "qacc" => &s.qacc,
        "ctrl" => &s.ctrl,
        "act" => &s.act,
        "actuator_force" => &s.actuator_force,
        "qfrc_actuator" => &s.qfrc_actuator,
        "qfrc_constraint" => &s.qfrc_constraint,
        "sensordata" => &s.sensordata,
        "xpos" => s.xpos.as_flattened(),
        "xquat" => s.xquat.as_flattened(),
        "xmat" => s.xmat.as_flattened(),
        "xipos" => s.xipos.as_flattened(),
        "geom_xpos" => s.geom_xpos.as_flattened(),
        "geom_xmat" => s.geom_xmat.as_flattened(),
        "site_xpos" => s.site_xpos.as_flattened(),
        "site_xmat" => s.site_xmat.as_flattened(),
        "cam_xpos" => s.cam_xpos.as_flattened(),
        "cam_xmat" => s.cam_xmat.as_flattened(),
        "subtree_com" => s.subtree_com.as_flattened(),
        "xfrc_applied" => s.xfrc_applied.as_flattened(),
        _ => return None,
    }))
}

/// Returns kind, address and length.
pub fn place(values: Values<'_>) -> [u32; 3] {
    let (kind, address) = match values {
        Values::U8(v) => (1, v.as_ptr().addr()),
        Values::I32(v) => (5, v.as_ptr().addr()),
        Values::F32(v) => (4, v.as_ptr().addr()),
        Values::F64(v) => (8, v.as_ptr().addr()),
    };
    [kind, address as u32, values.len() as u32]
}

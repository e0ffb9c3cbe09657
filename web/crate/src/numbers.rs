//! Where JavaScript finds numbers in the memory of the module.

use babybench::physics::State;

/// Numbers in the memory of the module.
pub enum Numbers<'a> {
    U8(&'a [u8]),
    I32(&'a [i32]),
    F32(&'a [f32]),
    F64(&'a [f64]),
}

impl<'a> Numbers<'a> {
    /// Finds a vector of the state by MuJoCo's name.
    pub fn of_state(s: &'a State, name: &str) -> Option<Self> {
        Some(Self::F64(match name {
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
    pub fn place(&self) -> [u32; 3] {
        let (kind, address, len) = match self {
            Self::U8(v) => (1, v.as_ptr().addr(), v.len()),
            Self::I32(v) => (5, v.as_ptr().addr(), v.len()),
            Self::F32(v) => (4, v.as_ptr().addr(), v.len()),
            Self::F64(v) => (8, v.as_ptr().addr(), v.len()),
        };
        [kind, address as u32, len as u32]
    }
}

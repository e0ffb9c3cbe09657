//! MuJoCo's numbers for enums whose variants are declared in its order.

use super::actuator::{BiasType, DynType, GainType, TrnType};
use super::elements::{GeomType, JointType};
use super::look::{CamLight, TextureType};

macro_rules! codes {
    ($($kind:ident is $name:literal,)*) => {$(
        impl $kind {
            #[doc = concat!("Returns MuJoCo's number (`", $name, "`).")]
            pub const fn code(self) -> i32 {
                self as i32
            }
        }
    )*};
}

codes! {
    BiasType is "mjtBias",
    CamLight is "mjtCamLight",
    DynType is "mjtDyn",
    GainType is "mjtGain",
    GeomType is "mjtGeom",
    JointType is "mjtJoint",
    TextureType is "mjtTexture",
    TrnType is "mjtTrn",
}

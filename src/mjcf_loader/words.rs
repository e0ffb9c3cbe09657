//! Shared by the tables: words with their values, bounds, defaults, and poses as written.

use crate::math::Vec3;
use crate::model::{BiasType, Builtin, CamLight, DynType, GainType, GeomType, JointType, Mark, TextureType};

use super::attribute::Sign::Any;
use super::attribute::{AttributeField, AttributeKind, FieldVisitor, Keywords, Value, reals, words};
use super::table::table;

pub(super) const SOLREF: [f64; 2] = [0.02, 1.0];
pub(super) const SOLIMP: [f64; 5] = [0.9, 0.95, 0.001, 0.5, 2.0];
pub(super) const GREY: [f64; 4] = [0.5, 0.5, 0.5, 1.0];

/// Groups from 5 on are drawn alike, as are those up to 0.
pub(super) const MIN_GROUP: i64 = i32::MIN as i64;
pub(super) const MAX_GROUP: i64 = i32::MAX as i64;
/// Greatest group of a skin.
pub(super) const MAX_SKIN_GROUP: i64 = 5;
/// Bits of collision. The highest is the sign.
pub(super) const MIN_BITS: i64 = i32::MIN as i64;
pub(super) const MAX_BITS: i64 = i32::MAX as i64;
/// Maximum number of keyframes that a document may request without defining them.
pub(super) const MAX_KEYS: i64 = 10_000;
pub(super) const MAX_COUNT: i64 = 1 << 30;
pub(super) const MAX_PIXELS: i64 = 16384;

/// A switch with the value `auto`, which is on if a range is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum AutoBool {
    No,
    Yes,
    Auto,
}

pub(super) const TRI: Keywords<AutoBool> =
    words! { "false" => AutoBool::No, "true" => AutoBool::Yes, "auto" => AutoBool::Auto };
pub(super) const JOINTS: Keywords<JointType> = words! {
    "free" => JointType::Free,
    "ball" => JointType::Ball,
    "slide" => JointType::Slide,
    "hinge" => JointType::Hinge,
};
pub(super) const FLUID: Keywords<bool> = words! { "none" => false, "ellipsoid" => true };
pub(super) const SHAPES: Keywords<GeomType> = words! {
    "plane" => GeomType::Plane,
    "hfield" => GeomType::HField,
    "sphere" => GeomType::Sphere,
    "capsule" => GeomType::Capsule,
    "ellipsoid" => GeomType::Ellipsoid,
    "cylinder" => GeomType::Cylinder,
    "box" => GeomType::Box,
    "mesh" => GeomType::Mesh,
};
/// The shapes of sites, which are neither planes nor height fields nor meshes.
pub(super) const SITE_SHAPES: Keywords<GeomType> = words! {
    "sphere" => GeomType::Sphere,
    "capsule" => GeomType::Capsule,
    "ellipsoid" => GeomType::Ellipsoid,
    "cylinder" => GeomType::Cylinder,
    "box" => GeomType::Box,
};
pub(super) const TEXTURES: Keywords<TextureType> = words! {
    "2d" => TextureType::Flat2d,
    "cube" => TextureType::Cube,
    "skybox" => TextureType::Skybox,
};
pub(super) const BUILTINS: Keywords<Builtin> = words! {
    "none" => Builtin::None,
    "gradient" => Builtin::Gradient,
    "checker" => Builtin::Checker,
    "flat" => Builtin::Flat,
};
pub(super) const MARKS: Keywords<Mark> = words! {
    "none" => Mark::None,
    "edge" => Mark::Edge,
    "cross" => Mark::Cross,
    "random" => Mark::Random,
};
pub(super) const CAM_LIGHT: Keywords<CamLight> = words! {
    "fixed" => CamLight::Fixed,
    "track" => CamLight::Track,
    "trackcom" => CamLight::TrackCom,
    "targetbody" => CamLight::TargetBody,
    "targetbodycom" => CamLight::TargetBodyCom,
};

pub(super) const DYNAMICS: Keywords<DynType> = words! {
    "none" => DynType::None,
    "integrator" => DynType::Integrator,
    "filter" => DynType::Filter,
    "filterexact" => DynType::FilterExact,
    "muscle" => DynType::Muscle,
};
pub(super) const GAINS: Keywords<GainType> =
    words! { "fixed" => GainType::Fixed, "affine" => GainType::Affine, "muscle" => GainType::Muscle };
pub(super) const BIASES: Keywords<BiasType> =
    words! { "none" => BiasType::None, "affine" => BiasType::Affine, "muscle" => BiasType::Muscle };

/// An orientation as written in the document.
#[derive(Clone, Copy, Debug)]
pub(super) enum Orientation {
    Quat([f64; 4]),
    AxisAngle([f64; 4]),
    XyAxes([f64; 6]),
    ZAxis([f64; 3]),
    Euler([f64; 3]),
}

impl Orientation {
    pub const IDENTITY: Orientation = Orientation::Quat([1.0, 0.0, 0.0, 0.0]);
}

/// One way to write an orientation.
#[derive(Clone, Copy)]
struct Rotation<const N: usize> {
    kind: AttributeKind,
    make: fn([f64; N]) -> Orientation,
}

const QUAT: Rotation<4> = Rotation {
    kind: AttributeKind::Quat,
    make: Orientation::Quat,
};
const fn rotation<const N: usize>(make: fn([f64; N]) -> Orientation) -> Rotation<N> {
    Rotation {
        kind: reals(N, Any),
        make,
    }
}

impl<const N: usize> Rotation<N> {
    const fn kind(self) -> AttributeKind {
        self.kind
    }

    fn visit(self, field: &mut Orientation, visit: FieldVisitor) {
        visit(&mut RotationField { rotation: self, field });
    }
}

/// A field together with a way to write it.
struct RotationField<'a, const N: usize> {
    rotation: Rotation<N>,
    field: &'a mut Orientation,
}

impl<const N: usize> AttributeField for RotationField<'_, N> {
    fn store(&mut self, value: &Value) {
        if let Value::Reals(values) = value
            && let Ok(values) = values[..].try_into()
        {
            *self.field = match ((self.rotation.make)(values), *self.field) {
                // A default class that rotates by other means wins over a quaternion, as in MuJoCo.
                (Orientation::Quat(_), inherited) if !matches!(inherited, Orientation::Quat(_)) => inherited,
                (written, _) => written,
            };
        }
    }

    fn show(&self) -> String {
        match (self.rotation.kind, &*self.field) {
            (AttributeKind::Quat, Orientation::Quat(quat)) => quat.show(),
            _ => String::new(),
        }
    }
}

table! {
    /// A pose as written.
    #[derive(Copy, Debug)]
    group Frame {
        also orientation: Orientation = Orientation::IDENTITY;
        set "quat" => orientation, QUAT, orientation, "Orientation as a quaternion, w first.";
        set "axisangle" => orientation, rotation(Orientation::AxisAngle), orientation, "Orientation as an axis and an angle about it.";
        set "xyaxes" => orientation, rotation(Orientation::XyAxes), orientation, "Orientation as the x axis and the y axis.";
        set "zaxis" => orientation, rotation(Orientation::ZAxis), orientation, "Orientation as the z axis, by the shortest rotation.";
        set "euler" => orientation, rotation(Orientation::Euler), orientation, "Orientation as three angles about the axes of `eulerseq`.";
        "pos" pos: Vec3 = [0.0; 3], reals(3, Any), "Position in the body, m.";
    }
}

//! Head and eyes that follow a point.

use super::pose::{address, own_joint};
use super::scene::TaskScene;
use crate::config::Compat;
use crate::env::EnvError;
use crate::math::{Vec3, norm, sub};
use crate::model::Model;

/// Height of the eyes above the origin of the head, m.
const EYE_HEIGHT: f64 = 0.067375;
/// Distance of the eyes from the middle of the head, m.
const EYE_FORWARD: f64 = 0.07;
/// Distance of an eye from the plane of symmetry, m.
const EYE_SIDEWARD: f64 = 0.0245;

/// The joints of the head and of the eyes, as indices in `qpos`.
#[derive(Clone, Debug, Default)]
pub(super) struct HeadTracking {
    head: usize,
    swivel: usize,
    tilt: usize,
    /// Horizontal angles of the eyes that follow the point.
    eyes: Vec<usize>,
    /// Joints that are held at 0.
    straight: Vec<usize>,
    /// Whether the distance to the point is measured from the height of the eyes.
    from_eyes: bool,
}

/// The joints of the eyes that the Python code omits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ForgottenJoints {
    /// None.
    None,
    /// The left eye rolls freely: MIMo 2's task `reach`.
    LeftTorsion,
    /// The right eye looks ahead and is otherwise free, and distances are measured from the height of the eyes: MIMo 3's task `reach`.
    RightEye,
}

impl HeadTracking {
    /// Finds the joints.
    pub fn new(model: &Model, forgotten: ForgottenJoints, purpose: &'static str) -> Result<Self, EnvError> {
        let at = |name: &str| address(model, &own_joint(name), purpose);
        let both: [&str; 2] = ["left_eye_horizontal", "right_eye_horizontal"];
        let [left, right] = [
            ["left_eye_vertical", "left_eye_torsional"],
            ["right_eye_vertical", "right_eye_torsional"],
        ];
        let (following, held) = match forgotten {
            ForgottenJoints::None => (&both[..], [left, right].concat()),
            ForgottenJoints::LeftTorsion => (&both[..], [&left[..1], &right[..]].concat()),
            ForgottenJoints::RightEye => (&both[..1], [&left[..], &both[1..]].concat()),
        };
        let held = std::iter::once("head_tilt_side").chain(held);
        Ok(Self {
            head: super::body(model, "head", purpose)?,
            swivel: at("head_swivel")?,
            tilt: at("head_tilt")?,
            eyes: following.iter().map(|name| at(name)).collect::<Result<_, _>>()?,
            from_eyes: forgotten == ForgottenJoints::RightEye,
            straight: held.map(at).collect::<Result<_, _>>()?,
        })
    }

    /// Turns head and eyes towards a point of the world, m. Velocities do not change.
    ///
    /// Under `compat: reference` the head turns the wrong way from a point behind it.
    pub fn look_at(&self, scene: &mut TaskScene<'_>, point: Vec3) {
        let [x, y, z] = sub(point, scene.state.xpos[self.head]);
        let up = z - EYE_HEIGHT;
        let eyes = norm([x, y, if self.from_eyes { up } else { z }]) - EYE_FORWARD;
        let [swivel, tilt] = if scene.config.compat == Compat::Reference {
            [pxfm::f_atan(y / x), pxfm::f_atan(-up / x)]
        } else {
            [pxfm::f_atan2(y, x), pxfm::f_atan2(-up, x.abs())]
        };
        let qpos = &mut scene.state.qpos;
        (qpos[self.swivel], qpos[self.tilt]) = (swivel, tilt);
        for &eye in &self.eyes {
            qpos[eye] = pxfm::f_atan(-EYE_SIDEWARD / eyes);
        }
        for &joint in &self.straight {
            qpos[joint] = 0.0;
        }
    }
}

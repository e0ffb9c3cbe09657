//! Types of the elements of a model.

use crate::math::{QUAT_ID, Quat, Vec3};

/// The type of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum JointType {
    /// Six degrees of freedom; `qpos` is position (3) and quaternion (4), `qvel` linear velocity in the world frame (3)
    /// and angular velocity in the body frame (3).
    Free,
    /// Three rotations about an anchor; `qpos` is a quaternion (4), `qvel` the angular velocity in the body frame (3), rad/s.
    Ball,
    /// Translation along the axis, m.
    Slide,
    /// Rotation about the axis, rad.
    Hinge,
}

impl JointType {
    /// Returns the number of position coordinates.
    pub fn nq(self) -> usize {
        match self {
            Self::Free => 7,
            Self::Ball => 4,
            Self::Slide | Self::Hinge => 1,
        }
    }
    /// Returns the place in `qpos` of the quaternion of a joint whose coordinates begin at `adr`, if it has one.
    pub fn quat(self, adr: usize) -> Option<usize> {
        match self {
            Self::Free => Some(adr + 3),
            Self::Ball => Some(adr),
            Self::Slide | Self::Hinge => None,
        }
    }

    /// Returns the number of degrees of freedom.
    pub fn nv(self) -> usize {
        match self {
            Self::Free => 6,
            Self::Ball => 3,
            Self::Slide | Self::Hinge => 1,
        }
    }
}

/// The shape of a geom or site, with the meaning of `size`.
///
/// The order is MuJoCo's, by which pairs are arranged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GeomType {
    /// Infinite for collision; `size` is half width, half length, grid spacing.
    Plane,
    /// A height field; `size` is half width, half length, and half of a mean height over the base.
    HField,
    /// `size` is the radius.
    Sphere,
    /// `size` is radius, half length of the segment along z.
    Capsule,
    /// `size` is the semi-axes. Drawn and touch-sensed only: it takes part in no collision.
    Ellipsoid,
    /// `size` is radius, half height along z.
    Cylinder,
    /// `size` is the half lengths.
    Box,
    /// A triangle mesh, whose convex hull collides; `size` is the largest distance from its centre along each axis.
    Mesh,
}

/// The known frame, if any, with which the frame of an element in a body coincides.
///
/// MuJoCo copies such frames instead of composing them, which shows in the last bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SameFrame {
    /// A separate frame.
    None,
    /// The body's frame.
    Body,
    /// The inertial frame.
    Inertia,
    /// The body's orientation.
    BodyRot,
    /// The orientation of the inertial frame.
    InertiaRot,
}

impl SameFrame {
    /// Compares a pose in a body with the body's own frame and its inertial frame, to within 1e-6 in each number.
    pub fn of(pos: Vec3, quat: Quat, ipos: Vec3, iquat: Quat) -> Self {
        let close = |a: &[f64], b: &[f64], sign: f64| a.iter().zip(b).all(|(x, y)| (x - sign * y).abs() < 1e-6);
        let same_quat = |other: Quat| close(&quat, &other, 1.0) || close(&quat, &other, -1.0);
        let (level, aligned) = (same_quat(QUAT_ID), same_quat(iquat));
        if level && close(&pos, &[0.0; 3], 1.0) {
            Self::Body
        } else if aligned && close(&pos, &ipos, 1.0) {
            Self::Inertia
        } else if level {
            Self::BodyRot
        } else if aligned {
            Self::InertiaRot
        } else {
            Self::None
        }
    }
}

/// An equality constraint, with the elements that it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EqualityKind {
    /// `y - y0 = polycoef(x - x0)` with `y` the first joint and `x` the second; without a second joint `y - y0 = polycoef[0]`.
    Joint {
        /// The constrained joint.
        joint1: usize,
        /// The joint it follows.
        joint2: Option<usize>,
        /// Coefficients of the quartic polynomial.
        polycoef: [f64; 5],
    },
    /// `y - y0 = polycoef(x - x0)` with `y` the length of the first tendon and `x` that of the second, `y0` and `x0` those at
    /// `qpos0`; without a second tendon `y - y0 = polycoef[0]`.
    Tendon {
        /// The constrained tendon.
        tendon1: usize,
        /// The tendon it follows.
        tendon2: Option<usize>,
        /// Coefficients of the quartic polynomial.
        polycoef: [f64; 5],
    },
    /// A point of body 1 and a point of body 2 stay together.
    Connect {
        /// First body.
        body1: usize,
        /// Second body; the world by default.
        body2: usize,
        /// The point in body 1, m.
        anchor1: Vec3,
        /// The point in body 2, m: where the first one is at `qpos0`.
        anchor2: Vec3,
        /// The sites at the points, if they are sites.
        sites: Option<[usize; 2]>,
    },
    /// Body 1 keeps its pose relative to body 2.
    Weld {
        /// First body.
        body1: usize,
        /// Second body; the world by default.
        body2: usize,
        /// Point of the constraint in body 2, m.
        anchor: Vec3,
        /// Position of body 2 relative to body 1 at the anchor, in body 1, m (MuJoCo's `relpose`).
        relpos: Vec3,
        /// Orientation of body 2 relative to body 1.
        relquat: Quat,
        /// Weight of the rotational rows.
        torquescale: f64,
        /// The sites whose poses are held together, if it holds sites.
        sites: Option<[usize; 2]>,
    },
    /// The edges of a flex keep their lengths at `qpos0`.
    Flex {
        /// The flex.
        flex: usize,
    },
}

impl EqualityKind {
    /// Returns MuJoCo's `eq_type`, `eq_objtype`, `eq_obj1id` and `eq_obj2id`, and the row of `eq_data`.
    pub fn numbers(&self) -> ([i32; 4], [f64; 11]) {
        // mjOBJ_BODY or mjOBJ_SITE, and the ids
        let ends = |bodies: [usize; 2], sites: Option<[usize; 2]>| {
            let object = if sites.is_some() { 6 } else { 1 };
            (object, sites.unwrap_or(bodies).map(|id| id as i32))
        };
        let id = |of: Option<usize>| of.map_or(-1, |id| id as i32);
        let (kind, (object, [first, second])) = match *self {
            Self::Connect {
                body1, body2, sites, ..
            } => (0, ends([body1, body2], sites)),
            Self::Weld {
                body1, body2, sites, ..
            } => (1, ends([body1, body2], sites)),
            Self::Joint { joint1, joint2, .. } => (2, (0, [joint1 as i32, id(joint2)])),
            Self::Tendon { tendon1, tendon2, .. } => (3, (0, [tendon1 as i32, id(tendon2)])),
            Self::Flex { flex } => (4, (0, [flex as i32, -1])),
        };
        ([kind, object, first, second], self.data())
    }

    /// Returns MuJoCo's row of `eq_data`.
    fn data(&self) -> [f64; 11] {
        let mut data = [0.0; 11];
        // the scale of torques, which is there where nothing uses it, too
        data[10] = 1.0;
        match *self {
            Self::Connect { sites: Some(_), .. } => data[10] = 0.0,
            Self::Connect { anchor1, anchor2, .. } => {
                data[..3].copy_from_slice(&anchor1);
                data[3..6].copy_from_slice(&anchor2);
            }
            Self::Weld {
                sites: Some(_),
                torquescale,
                ..
            } => {
                // nothing uses it, and it is what a polynomial begins with
                data[1] = 1.0;
                data[10] = torquescale;
            }
            Self::Weld {
                anchor,
                relpos,
                relquat,
                torquescale,
                ..
            } => {
                data[..3].copy_from_slice(&anchor);
                data[3..6].copy_from_slice(&relpos);
                data[6..10].copy_from_slice(&relquat);
                data[10] = torquescale;
            }
            Self::Joint { polycoef, .. } | Self::Tendon { polycoef, .. } => data[..5].copy_from_slice(&polycoef),
            // nothing uses it, and it is what a polynomial begins with
            Self::Flex { .. } => data[1] = 1.0,
        }
        data
    }

    /// Sets the numbers from a row of MuJoCo's `eq_data`. Numbers that MuJoCo also ignores, such as the anchors of sites, are dropped.
    pub fn set_data(&mut self, data: &[f64; 11]) {
        let vector = |from: usize| [data[from], data[from + 1], data[from + 2]];
        match self {
            Self::Connect { anchor1, anchor2, .. } => (*anchor1, *anchor2) = (vector(0), vector(3)),
            Self::Weld {
                anchor,
                relpos,
                relquat,
                torquescale,
                ..
            } => {
                (*anchor, *relpos, *torquescale) = (vector(0), vector(3), data[10]);
                relquat.copy_from_slice(&data[6..10]);
            }
            Self::Joint { polycoef, .. } | Self::Tendon { polycoef, .. } => polycoef.copy_from_slice(&data[..5]),
            Self::Flex { .. } => {}
        }
    }
}

/// An object on the path of a tendon (MuJoCo's `mjtWrap`). A fixed tendon has joints only, a spatial one everything else.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wrap {
    /// A joint of one coordinate, which contributes `coef` times its coordinate to the length.
    Joint {
        /// The joint.
        joint: usize,
        /// Length of the tendon per coordinate.
        coef: f64,
    },
    /// A pulley: the length of the path after it is divided by `divisor`.
    Pulley {
        /// The divisor, which is positive.
        divisor: f64,
    },
    /// A site, which the tendon passes through.
    Site {
        /// The site.
        site: usize,
    },
    /// A sphere between two sites, around which the tendon wraps if it is in the way.
    Sphere {
        /// The geom.
        geom: usize,
        /// The site on whose side the tendon stays; a site inside the sphere makes the tendon pass through the sphere and touch it from inside.
        side: Option<usize>,
    },
    /// A cylinder without ends, likewise.
    Cylinder {
        /// The geom.
        geom: usize,
        /// The site on whose side the tendon stays.
        side: Option<usize>,
    },
}

/// A state that a document names (`<keyframe><key>`).
#[derive(Clone, Debug, PartialEq)]
pub struct Keyframe {
    /// Name; may be empty.
    pub name: String,
    /// Time, s.
    pub time: f64,
    /// Positions (nq).
    pub qpos: Vec<f64>,
    /// Velocities (nv).
    pub qvel: Vec<f64>,
    /// Activations (na).
    pub act: Vec<f64>,
    /// Controls (nu).
    pub ctrl: Vec<f64>,
    /// Positions of mocap bodies (nmocap), m.
    pub mpos: Vec<Vec3>,
    /// Orientations of mocap bodies (nmocap).
    pub mquat: Vec<Quat>,
}

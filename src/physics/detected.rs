//! Detected contacts, of geoms and of flexes.

use crate::math::{Mat3, Vec3, mat_t_vec};
use crate::model::Arrays;

/// A detected contact between two geoms.
#[doc(alias = "mjContact")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The geoms (2), by id: the one of lower [`crate::model::GeomType`] first; the normal points away from it.
    pub geom: [usize; 2],
    /// Distance between the surfaces, m; negative is penetration.
    pub dist: f64,
    /// Midpoint between the surfaces (3), world frame, m.
    pub pos: Vec3,
    /// Contact frame (9): its rows are the normal from the first to the second geom and two tangents, world frame, unit vectors.
    pub frame: Mat3,
    /// Dimension: 1 frictionless, 3 sliding, 4 with torsional, 6 with rolling friction.
    pub dim: usize,
    /// Friction coefficients (5): two sliding, no unit; one torsional, m; two rolling, m.
    pub friction: [f64; 5],
    /// `solref` of the normal (2); see [Solver parameters](crate::model::Arrays#solver-parameters).
    pub solref: [f64; 2],
    /// `solref` of friction (2); zeros mean that of the normal.
    pub solreffriction: [f64; 2],
    /// `solimp` (5); see [Solver parameters](crate::model::Arrays#solver-parameters).
    pub solimp: [f64; 5],
    /// Distance at which the contact becomes a constraint: margin minus gap, m.
    pub includemargin: f64,
    /// First constraint row of the contact, an index into [`State::efc_rows`](crate::State::efc_rows); `None` if it is not a constraint, where MuJoCo has -1.
    pub efc_address: Option<usize>,
    /// Force (3), N, and torque (3), N m, that the first geom exerts on the second, contact frame. Filled by the solver; MuJoCo computes it in
    /// `mj_contactForce`.
    pub force: [f64; 6],
}

impl Contact {
    /// Returns the force that the first geom exerts on the second, N, world frame; the negative acts on the first.
    pub fn world_force(&self) -> Vec3 {
        mat_t_vec(&self.frame, [self.force[0], self.force[1], self.force[2]])
    }
}

/// One side of a contact of a flex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactSide {
    /// A geom, by id.
    Geom(usize),
    /// A vertex of a flex.
    Vertex {
        /// The flex, by id.
        flex: usize,
        /// The vertex in the flex.
        vertex: usize,
    },
    /// An element of a flex.
    Element {
        /// The flex, by id.
        flex: usize,
        /// The element in the flex.
        element: usize,
    },
}

impl ContactSide {
    /// Returns the geom, if it is one.
    pub fn geom(self) -> Option<usize> {
        match self {
            Self::Geom(geom) => Some(geom),
            _ => None,
        }
    }

    /// Returns the body of the geom or vertex, by id; of an element, that of its first vertex.
    pub fn body(self, model: &Arrays) -> usize {
        let of = |flex: usize, vertex: usize| model.flexes[flex].vertbodyid[vertex];
        match self {
            Self::Geom(geom) => model.geom_bodyid[geom],
            Self::Vertex { flex, vertex } => of(flex, vertex),
            Self::Element { flex, element } => of(flex, model.flexes[flex].element(element)[0]),
        }
    }

    /// Returns the name of the geom's body, or of the flex.
    pub fn name(self, model: &Arrays) -> &str {
        match self {
            Self::Geom(geom) => &model.body_name[model.geom_bodyid[geom]],
            Self::Vertex { flex, .. } | Self::Element { flex, .. } => &model.flexes[flex].name,
        }
    }
}

/// A detected contact of which at least one side is a flex.
#[doc(alias = "mjContact")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlexContact {
    /// The sides. The normal points away from the first. MuJoCo's `geom`, `flex`, `elem` and `vert`.
    pub sides: [ContactSide; 2],
    /// Everything else. Its `geom` has no meaning.
    pub contact: Contact,
    /// Number of contacts of geoms ([`State::contact`](crate::State::contact)) before it in MuJoCo's list, which mixes contacts of geoms and flexes.
    pub after: usize,
}

impl FlexContact {
    /// Returns the geoms of both sides.
    pub fn geoms(&self) -> [Option<usize>; 2] {
        self.sides.map(ContactSide::geom)
    }
}

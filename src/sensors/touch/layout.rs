//! The layout of the skin: the bodies with sensors, and their positions.

use std::ops::Range;

use thiserror::Error;

use super::grid::Grid;
use super::hull::Hull;
use super::points::{estimate, surface_points};
use crate::config::{Compat, Config};
use crate::math::*;
use crate::mimo::{MimoBodies, body_kind};
use crate::model::{GeomType, Model};

/// Distance (m) from the hull of another geom below which a sensor counts as inside and is left out.
const INTERIOR: f64 = 1e-9;

/// Greatest number of sensors of a skin.
pub const MAX_SENSORS: usize = 1 << 20;

/// An error in making a skin.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SkinError {
    /// A distance between sensors is not a positive number.
    #[error("the touch sensors of {body:?} cannot be {spacing} m apart: the distance must be finite and > 0")]
    Spacing {
        /// Name of the body.
        body: String,
        /// Distance between its sensors, m.
        spacing: f64,
    },
    /// A geom that can touch is a mesh or a height field.
    #[error(
        "{body:?} has a mesh or a height field that touches, on which touch sensors are not placed; give the body shapes that touch, and contype=\"0\" conaffinity=\"0\" to the other"
    )]
    Mesh {
        /// Name of the body.
        body: String,
    },
    /// There would be too many sensors.
    #[error(
        "{spacing} m between the touch sensors of {body:?} would bring the total to about {expected}, above {MAX_SENSORS}, \
         which takes seconds to make and hundreds of bytes each; raise touch_scale"
    )]
    TooMany {
        /// Name of the body at which the limit is exceeded.
        body: String,
        /// Distance between its sensors, m.
        spacing: f64,
        /// An estimate of the total up to that body.
        expected: u64,
    },
}

/// The sensors on one geom of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinGeom {
    /// Geom, by id.
    pub geom: usize,
    /// Range of its sensors, counted within the body.
    pub sensors: Range<usize>,
    /// Number of points on its surface, including those inside other geoms of the body.
    pub points: usize,
    /// Orientation of the geom in the body.
    pub mat: Mat3,
}

/// The sensors of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinBody {
    /// Body, by id.
    pub body: usize,
    /// Name of the body.
    pub name: String,
    /// Distance between its sensors, m.
    pub spacing: f64,
    /// Index of its first sensor, counted over all bodies.
    pub offset: usize,
    /// Its geoms, in id order.
    pub geoms: Vec<SkinGeom>,
    pub(super) positions: Vec<Vec3>,
    pub(super) grid: Grid,
}

impl SkinBody {
    /// Returns the positions of the sensors in the frame of the body, m, in their order.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Returns the number of sensors.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Returns whether the body has no sensors: all its points lie inside other geoms, or it has no geoms.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Returns the index in [`Self::geoms`] of the geom that carries a sensor (counted within the body).
    pub fn geom_of(&self, sensor: usize) -> usize {
        self.geoms.iter().position(|g| sensor < g.sensors.end).unwrap_or(0)
    }
}

/// The sensors of the skin: immutable, and shared by all environments of a configuration.
///
/// Sensors are ordered by body id, within a body by geom id, within a geom as [`surface_points`] makes them. Points inside
/// the convex hull of the points of another geom of the same body are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinLayout {
    pub(super) bodies: Vec<SkinBody>,
    /// Index in `bodies` plus one, for each body of the model; 0 for bodies without sensors.
    of_body: Vec<u32>,
    len: usize,
}

impl SkinLayout {
    /// Places the sensors of MIMo's skin by `touch_<part>`, `touch_scale` and `compat`.
    ///
    /// Under `compat: reference` MIMo v2 has the table of v1, which has neither his fingers nor his big toes.
    ///
    /// # Errors
    /// Fails if `touch_scale` would give no or too many sensors.
    pub fn new(model: &Model, config: &Config) -> Result<Self, SkinError> {
        let mimo = MimoBodies::of(model);
        Self::place(model, |body| {
            let body = body_kind(&model.body_name[body]).filter(|_| mimo.contains(body))?;
            let known = !body.only_v2 || config.compat == Compat::Api;
            (known && config.touch.get(body.part)).then_some(body.touch_spacing * config.touch_scale)
        })
    }

    /// Places the sensors of a skin for any model: `spacing` returns the distance between sensors (m) for the name of a
    /// body, `None` if the body has none.
    ///
    /// # Errors
    /// Returns an error if a distance is not finite and positive, or so small that there are more than [`MAX_SENSORS`].
    pub fn with_spacing(model: &Model, spacing: impl Fn(&str) -> Option<f64>) -> Result<Self, SkinError> {
        Self::place(model, |body| spacing(&model.body_name[body]))
    }

    /// Places the sensors of a skin: `spacing` returns the distance between the sensors (m) of a body by its id.
    fn place(model: &Model, spacing: impl Fn(usize) -> Option<f64>) -> Result<Self, SkinError> {
        let mut layout = Self {
            bodies: Vec::new(),
            of_body: vec![0; model.nbody()],
            len: 0,
        };
        let mut expected = 0.0;
        for body in 0..model.nbody() {
            let name = model.body_name[body].clone();
            let Some(spacing) = spacing(body) else { continue };
            if !(spacing.is_finite() && spacing > 0.0) {
                return Err(SkinError::Spacing { body: name, spacing });
            }
            let geoms: Vec<usize> = (0..model.ngeom())
                .filter(|&g| model.geom_bodyid[g] == body && (model.geom_contype[g] | model.geom_conaffinity[g]) != 0)
                .collect();
            if geoms
                .iter()
                .any(|&g| matches!(model.geom_type[g], GeomType::HField | GeomType::Mesh))
            {
                return Err(SkinError::Mesh { body: name });
            }
            for &g in &geoms {
                // before any is placed: a spacing of a micrometre would exhaust the memory first
                expected += estimate(model.geom_type[g], model.geom_size[g], spacing);
            }
            if expected > MAX_SENSORS as f64 {
                let expected = expected as u64;
                return Err(SkinError::TooMany {
                    body: name,
                    spacing,
                    expected,
                });
            }
            let (positions, geoms) = assemble(model, &geoms, spacing);
            let grid = Grid::new(&positions, 2.0 * spacing);
            let offset = layout.len;
            layout.len += positions.len();
            layout.bodies.push(SkinBody {
                body,
                name,
                spacing,
                offset,
                geoms,
                positions,
                grid,
            });
            layout.of_body[body] = layout.bodies.len() as u32;
        }
        Ok(layout)
    }

    /// Returns the number of sensors.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Returns whether there are no sensors.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Returns the bodies with sensors, by id.
    pub fn bodies(&self) -> &[SkinBody] {
        &self.bodies
    }

    /// Returns the index in [`Self::bodies`] of a body of the model; `None` if it has no sensors.
    pub fn index(&self, body: usize) -> Option<usize> {
        (*self.of_body.get(body)? as usize).checked_sub(1)
    }

    /// Returns the skin of a body; `None` if it has no sensors.
    pub fn body(&self, body: usize) -> Option<&SkinBody> {
        self.index(body).map(|i| &self.bodies[i])
    }

    /// Returns the positions of the sensors of a body in its frame, m; `None` if it has none.
    pub fn sensor_positions(&self, body: usize) -> Option<&[Vec3]> {
        self.body(body).map(SkinBody::positions)
    }

    /// Returns the body of a sensor and the sensor's index within it.
    pub fn locate(&self, sensor: usize) -> Option<(&SkinBody, usize)> {
        let body = self.bodies.partition_point(|b| b.offset + b.len() <= sensor);
        self.bodies.get(body).map(|b| (b, sensor - b.offset))
    }
}

/// Places the sensors on the geoms of one body, in its frame.
fn assemble(model: &Model, geoms: &[usize], spacing: f64) -> (Vec<Vec3>, Vec<SkinGeom>) {
    let points: Vec<Vec<Vec3>> = geoms
        .iter()
        .map(|&g| {
            let mat = quat_to_mat(quat_normalize(model.geom_quat[g]));
            let local = surface_points(model.geom_type[g], model.geom_size[g], spacing);
            local
                .iter()
                .map(|p| add(mat_vec(&mat, *p), model.geom_pos[g]))
                .collect()
        })
        .collect();
    let hulls: Vec<Option<Hull>> = match geoms.len() {
        // a single geom has no other to lie in
        1 => vec![None],
        _ => points.iter().map(|p| Hull::new(p)).collect(),
    };
    let (mut positions, mut out) = (Vec::new(), Vec::new());
    for (k, (&g, own)) in geoms.iter().zip(&points).enumerate() {
        let start = positions.len();
        let others = || {
            hulls
                .iter()
                .enumerate()
                .filter(|(j, _)| *j != k)
                .filter_map(|(_, h)| h.as_ref())
        };
        positions.extend(own.iter().filter(|p| !others().any(|h| h.contains(**p, INTERIOR))));
        out.push(SkinGeom {
            geom: g,
            sensors: start..positions.len(),
            points: own.len(),
            mat: quat_to_mat(quat_normalize(model.geom_quat[g])),
        });
    }
    (positions, out)
}

//! The skin: which bodies feel, and where their sensors are.

use std::ops::Range;

use thiserror::Error;

use super::grid::Grid;
use super::hull::Hull;
use super::points::{estimate, surface_points};
use crate::config::{Compat, Config, Part};
use crate::math::*;
use crate::model::{BodyId, GeomId, Model};

/// A sensor this close (m) to the hull of another geom, or inside it, does not feel.
const INTERIOR: f64 = 1e-9;

/// The most sensors of a skin.
pub const MAX_SENSORS: usize = 1 << 24;

/// A body that feels: its name without `left_` and `right_`, the distance between its sensors (m), its group, and whether
/// only MIMo v2's table has it.
struct Row(&'static str, f64, Part, bool);

/// MIMo's tables of touch scales; v1 has those marked false, the five-fingered v2 all.
const BODIES: [Row; 30] = [
    Row("toes", 0.010, Part::Feet, false),
    Row("foot", 0.015, Part::Feet, false),
    Row("lower_leg", 0.038, Part::Legs, false),
    Row("upper_leg", 0.027, Part::Legs, false),
    Row("hip", 0.025, Part::Body, false),
    Row("lower_body", 0.025, Part::Body, false),
    Row("upper_body", 0.030, Part::Body, false),
    Row("head", 0.013, Part::Head, false),
    Row("eye", 1.0, Part::Eyes, false),
    Row("upper_arm", 0.024, Part::Arms, false),
    Row("lower_arm", 0.024, Part::Arms, false),
    Row("hand", 0.007, Part::Hands, false),
    Row("fingers", 0.002, Part::Fingers, false),
    Row("big_toe", 0.010, Part::Feet, true),
    Row("ffknuckle", 0.004, Part::Fingers, true),
    Row("ffmiddle", 0.004, Part::Fingers, true),
    Row("ffdistal", 0.002, Part::Fingers, true),
    Row("mfknuckle", 0.004, Part::Fingers, true),
    Row("mfmiddle", 0.004, Part::Fingers, true),
    Row("mfdistal", 0.002, Part::Fingers, true),
    Row("rfknuckle", 0.004, Part::Fingers, true),
    Row("rfmiddle", 0.004, Part::Fingers, true),
    Row("rfdistal", 0.002, Part::Fingers, true),
    Row("lfmetacarpal", 0.007, Part::Fingers, true),
    Row("lfknuckle", 0.004, Part::Fingers, true),
    Row("lfmiddle", 0.004, Part::Fingers, true),
    Row("lfdistal", 0.002, Part::Fingers, true),
    Row("thbase", 0.004, Part::Fingers, true),
    Row("thhub", 0.004, Part::Fingers, true),
    Row("thdistal", 0.002, Part::Fingers, true),
];

/// Why a skin cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SkinError {
    /// A distance between sensors is not a positive number.
    #[error("the touch sensors of {body:?} cannot be {spacing} m apart: the distance must be finite and > 0")]
    Spacing {
        /// Body.
        body: String,
        /// The distance, m.
        spacing: f64,
    },
    /// There would be too many sensors.
    #[error("touch sensors {spacing} m apart on {body:?} make more than {MAX_SENSORS}; raise touch_scale")]
    TooMany {
        /// Body at which there are too many.
        body: String,
        /// Distance between its sensors, m.
        spacing: f64,
    },
}

/// The sensors on one geom of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinGeom {
    /// The geom.
    pub geom: GeomId,
    /// Its sensors, counted within the body.
    pub sensors: Range<usize>,
    /// Number of points on its surface, those inside other geoms of the body included.
    pub points: usize,
    /// Orientation of the geom in the body.
    pub mat: Mat3,
}

/// The sensors of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinBody {
    /// The body.
    pub body: BodyId,
    /// Its name.
    pub name: String,
    /// Distance between its sensors, m.
    pub scale: f64,
    /// Its first sensor, counted over all bodies.
    pub offset: usize,
    /// Its geoms, in id order.
    pub geoms: Vec<SkinGeom>,
    pub(super) positions: Vec<Vec3>,
    pub(super) grid: Grid,
}

impl SkinBody {
    /// Positions of the sensors in the frame of the body, m, in their order.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// Number of sensors.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether the body has no sensors: all its points lie inside one another, or it has no geoms.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Index in [`Self::geoms`] of the geom that a sensor (counted within the body) is on.
    pub fn geom_of(&self, sensor: usize) -> usize {
        self.geoms.iter().position(|g| sensor < g.sensors.end).unwrap_or(0)
    }
}

/// The sensors of the skin: immutable, and shared by all environments of a configuration.
///
/// Sensors are ordered by body id, within a body by geom id, within a geom as [`surface_points`] makes them. Points inside
/// the convex hull of the points of another geom of the same body do not feel and are left out.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinLayout {
    bodies: Vec<SkinBody>,
    /// Index in `bodies` plus one of each body of the model; 0 is none.
    of_body: Vec<u32>,
    len: usize,
}

impl SkinLayout {
    /// MIMo's skin as configured by `touch_<part>`, `touch_scale` and `compat`.
    ///
    /// Under `compat: reference` MIMo v2 has the table of v1, which knows neither its fingers nor its big toes.
    ///
    /// # Errors
    /// A `touch_scale` for which there would be no or too many sensors.
    pub fn new(model: &Model, config: &Config) -> Result<Self, SkinError> {
        Self::with_spacing(model, |body| {
            let plain = body.strip_prefix("left_").or_else(|| body.strip_prefix("right_"));
            let plain = plain.unwrap_or(body);
            let row = BODIES.iter().find(|row| row.0 == plain)?;
            let known = !row.3 || config.compat == Compat::Api;
            (known && config.touch.get(row.2)).then_some(row.1 * config.touch_scale)
        })
    }

    /// A skin for any model: `spacing` tells the distance between sensors (m) for the name of a body, `None` if it does
    /// not feel.
    ///
    /// # Errors
    /// A distance that is not finite and positive, or so small that there are more than [`MAX_SENSORS`].
    pub fn with_spacing(model: &Model, spacing: impl Fn(&str) -> Option<f64>) -> Result<Self, SkinError> {
        let mut layout = Self {
            bodies: Vec::new(),
            of_body: vec![0; model.nbody()],
            len: 0,
        };
        let mut expected = 0.0;
        for body in 0..model.nbody() {
            let name = model.body_name[body].clone();
            let Some(scale) = spacing(&name) else { continue };
            if !(scale.is_finite() && scale > 0.0) {
                let (body, spacing) = (name, scale);
                return Err(SkinError::Spacing { body, spacing });
            }
            let geoms: Vec<usize> = (0..model.ngeom())
                .filter(|&g| model.geom_bodyid[g] == body && (model.geom_contype[g] | model.geom_conaffinity[g]) != 0)
                .collect();
            for &g in &geoms {
                expected += estimate(model.geom_type[g], model.geom_size[g], scale);
            }
            if expected > MAX_SENSORS as f64 {
                let (body, spacing) = (name, scale);
                return Err(SkinError::TooMany { body, spacing });
            }
            let (positions, geoms) = assemble(model, &geoms, scale);
            let grid = Grid::new(&positions, 2.0 * scale);
            let offset = layout.len;
            layout.len += positions.len();
            layout.bodies.push(SkinBody {
                body: BodyId(body),
                name,
                scale,
                offset,
                geoms,
                positions,
                grid,
            });
            layout.of_body[body] = layout.bodies.len() as u32;
        }
        Ok(layout)
    }

    /// Number of sensors.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no sensors.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The bodies that feel, by id.
    pub fn bodies(&self) -> &[SkinBody] {
        &self.bodies
    }

    /// Index in [`Self::bodies`] of a body of the model.
    pub fn index(&self, body: BodyId) -> Option<usize> {
        (*self.of_body.get(body.0)? as usize).checked_sub(1)
    }

    /// The skin of a body, `None` if it does not feel.
    pub fn body(&self, body: BodyId) -> Option<&SkinBody> {
        self.index(body).map(|i| &self.bodies[i])
    }

    /// Positions of the sensors of a body in its frame, m; `None` if it does not feel.
    pub fn sensor_positions(&self, body: BodyId) -> Option<&[Vec3]> {
        self.body(body).map(SkinBody::positions)
    }

    /// The body of a sensor and the sensor's number within it.
    pub fn locate(&self, sensor: usize) -> Option<(&SkinBody, usize)> {
        let body = self.bodies.partition_point(|b| b.offset + b.len() <= sensor);
        self.bodies.get(body).map(|b| (b, sensor - b.offset))
    }
}

/// The sensors of the geoms of one body, in its frame.
fn assemble(model: &Model, geoms: &[usize], scale: f64) -> (Vec<Vec3>, Vec<SkinGeom>) {
    let points: Vec<Vec<Vec3>> = geoms
        .iter()
        .map(|&g| {
            let mat = quat_to_mat(quat_normalize(model.geom_quat[g]));
            let local = surface_points(model.geom_type[g], model.geom_size[g], scale);
            local
                .iter()
                .map(|p| add(mat_vec(&mat, *p), model.geom_pos[g]))
                .collect()
        })
        .collect();
    let hulls: Vec<Option<Hull>> = match geoms.len() {
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
            geom: GeomId(g),
            sensors: start..positions.len(),
            points: own.len(),
            mat: quat_to_mat(quat_normalize(model.geom_quat[g])),
        });
    }
    (positions, out)
}

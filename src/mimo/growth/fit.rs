//! Bodies of a given length and weight.

use super::error::{GrowthError, missing_geom};
use super::lengths::Factors;
use super::shapes::BodyShapes;
use super::sizes::sides;
use crate::mjcf_loader::{Draft, DraftGeom};
use crate::model::GeomType;

/// The density of a geom without a mass of its own, kg/m^3, MJCF's default.
const DENSITY: f64 = 1000.0;
/// The index of the box among the geoms of a foot, which is its lowest part.
const SOLE: usize = 1;
/// The greatest relative error of a length and a weight.
const TOLERANCE: f64 = 1e-12;
/// The greatest number of steps of Newton's method, which takes about five.
const STEPS: usize = 60;
/// The relative change of a factor by which derivatives are measured.
const CHANGE: f64 = 1e-6;

/// The shapes and densities of MIMo's parts, in the order of the geoms of [`BodyShapes`].
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PartMasses {
    /// Shape and density, kg/m^3; of a part that exists on both sides, the sum of both.
    parts: Vec<(GeomType, f64)>,
}

impl PartMasses {
    /// Reads the masses of a document with the original MIMo, for bodies with the parts of `shapes`.
    ///
    /// # Errors
    /// A part that the document lacks.
    pub fn read(shapes: &BodyShapes, draft: &mut Draft) -> Result<Self, GrowthError> {
        let mut parts = Vec::with_capacity(shapes.geoms.len());
        for geom in &shapes.geoms {
            let (mut kind, mut density) = (GeomType::Sphere, 0.0);
            for (body, _) in sides(geom.side, geom.body) {
                let found = draft.geom(&body, geom.index);
                let found = found.ok_or_else(|| missing_geom(&body, geom.index))?;
                kind = found.kind;
                density += found.mass.map_or(DENSITY, |mass| mass / found.volume());
            }
            parts.push((kind, density));
        }
        Ok(Self { parts })
    }

    /// Returns the mass of a body, kg.
    fn of(&self, shapes: &BodyShapes) -> f64 {
        let each = self.parts.iter().zip(&shapes.geoms);
        each.map(|(&(kind, density), geom)| {
            let (mut size, mut pos) = (geom.size, geom.pos);
            let geom = DraftGeom {
                kind,
                size: &mut size,
                pos: &mut pos,
                mass: &mut None,
            };
            density * geom.volume()
        })
        .sum()
    }
}

/// Returns the length of a body from the soles to the crown with all joints at 0, m.
fn stature(shapes: &BodyShapes) -> f64 {
    let height = |name| {
        let found = shapes.bodies.iter().find(|body| body.name == name);
        found.map_or(0.0, |body| body.pos[2])
    };
    let geoms = |body| shapes.geoms.iter().filter(move |geom| geom.body == body);
    let crown = geoms("head").next().map_or(0.0, |head| head.pos[2] + head.size[0]);
    let sole = geoms("foot").nth(SOLE).map_or(0.0, |foot| foot.pos[2] - foot.size[2]);
    // a thick ankle, which is a capsule, reaches below a thin foot
    let ankles = geoms("lower_leg").map(|geom| geom.pos[2] - geom.size[1] - geom.size[0]);
    let lowest = ankles.fold(height("foot") + sole, f64::min);
    let trunk: f64 = ["lower_body", "upper_body", "head"].map(height).iter().sum();
    (trunk + crown) - (height("upper_leg") + height("lower_leg") + lowest)
}

/// A length, m, and a weight, kg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Target {
    pub length: f64,
    pub weight: f64,
}

/// Finds the factors on lengths and on girths with which a body has a length and a weight, beginning with `start`, by Newton's method;
/// `None` if there are none.
pub(super) fn fit(
    target: Target,
    masses: &PartMasses,
    start: Factors,
    make: impl Fn(&Factors) -> BodyShapes,
) -> Option<Factors> {
    let error = |factors: &Factors| {
        let shapes = make(factors);
        [
            stature(&shapes) / target.length - 1.0,
            masses.of(&shapes) / target.weight - 1.0,
        ]
    };
    let mut now = start;
    for _ in 0..STEPS {
        let off = error(&now);
        if off.iter().all(|e| e.abs() < TOLERANCE) {
            return Some(now);
        }
        let changed = |factors: Factors, by: f64| {
            let there = error(&factors);
            [(there[0] - off[0]) / by, (there[1] - off[1]) / by]
        };
        let (by_length, by_girth) = (CHANGE * now.length, CHANGE * now.girth);
        let [a, c] = changed(
            Factors {
                length: now.length + by_length,
                ..now
            },
            by_length,
        );
        let [b, d] = changed(
            Factors {
                girth: now.girth + by_girth,
                ..now
            },
            by_girth,
        );
        let determinant = a * d - b * c;
        let step = [
            (d * off[0] - b * off[1]) / determinant,
            (a * off[1] - c * off[0]) / determinant,
        ];
        // far from the solution a step may not change the sign of a length
        now.length = (now.length - step[0]).clamp(0.5 * now.length, 2.0 * now.length);
        now.girth = (now.girth - step[1]).clamp(0.5 * now.girth, 2.0 * now.girth);
        if !(now.length.is_finite() && now.girth.is_finite()) {
            return None;
        }
    }
    None
}

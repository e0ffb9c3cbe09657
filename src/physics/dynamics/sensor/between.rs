//! Sensors between geoms: distance, direction, nearest points.

use crate::collision::placed;
use crate::contact::{ContactOptions, ContactPoint, Scratch, distance};
use crate::math::*;
use crate::model::{Model, ObjType, SensorType};
use crate::state::State;

/// Buffers of distance sensors, allocated only if a model has one.
#[derive(Clone, Debug, Default)]
pub(super) struct DistanceScratch {
    scratch: Option<Scratch>,
    points: Vec<ContactPoint>,
}

/// Iterates over the geoms on one side of a sensor.
fn geoms(model: &Model, kind: ObjType, id: Option<usize>) -> std::ops::Range<usize> {
    let id = id.unwrap_or(0);
    match kind {
        ObjType::Body => model.body_geomadr[id]..model.body_geomadr[id] + model.body_geomnum[id],
        _ => id..id + 1,
    }
}

impl DistanceScratch {
    /// Returns the value of a sensor, padded with zeros.
    pub fn value(&mut self, model: &Model, s: &State, sensor: usize) -> [f64; 6] {
        let scratch = self.scratch.get_or_insert_with(Scratch::new);
        let options = ContactOptions {
            ccd_tolerance: model.opt.ccd_tolerance,
            ccd_iterations: model.opt.ccd_iterations,
            nativeccd: model.opt.flags.nativeccd,
            ..ContactOptions::default()
        };
        let cutoff = model.sensor_cutoff[sensor];
        let (mut dist, mut from, mut to) = (cutoff, [0.0; 3], [0.0; 3]);
        for g in geoms(model, model.sensor_objtype[sensor], model.sensor_objid[sensor]) {
            for h in geoms(model, model.sensor_reftype[sensor], model.sensor_refid[sensor]) {
                let span = distance(
                    &placed(model, s, g),
                    &placed(model, s, h),
                    cutoff,
                    &options,
                    scratch,
                    &mut self.points,
                );
                if let Some(span) = span.filter(|span| span.dist < dist) {
                    (dist, from, to) = (span.dist, span.from, span.to);
                }
            }
        }
        match model.sensor_type[sensor] {
            SensorType::GeomDist => [dist, 0.0, 0.0, 0.0, 0.0, 0.0],
            SensorType::GeomNormal if from == to => [0.0; 6],
            SensorType::GeomNormal => {
                let [x, y, z] = unit(sub(to, from)).0;
                [x, y, z, 0.0, 0.0, 0.0]
            }
            _ => [from[0], from[1], from[2], to[0], to[1], to[2]],
        }
    }
}

//! The sense of touch: thousands of sensors all over MIMo's body that feel contact forces.
//!
//! A [`SkinLayout`] says where the sensors are; a [`Touch`] turns contacts into their values. Both work on any [`Model`]
//! with contacts and poses from anywhere:
//!
//! ```
//! use babybench::config::{Compat, TouchFunction, TouchResponse};
//! use babybench::sensors::{SkinLayout, Touch};
//! use babybench::{Blueprint, Config};
//! use std::sync::Arc;
//!
//! let config = Config { vision_active: false, ..Config::default() };
//! let blueprint = Blueprint::new(config)?;
//! let model = blueprint.model();
//! let hands = SkinLayout::with_spacing(model, |body| body.ends_with("_hand").then_some(0.01))?;
//! let mut touch = Touch::new(Arc::new(hands), TouchFunction::ForceVector, TouchResponse::Nearest, Compat::Api);
//! let mut env = blueprint.env()?;
//! env.reset(Some(0))?;
//! let s = env.state();
//! touch.sense(model, &s.contacts, &s.xpos, &s.xmat);
//! for sensor in touch.active() {
//!     println!("sensor {} of {:?} feels {:?} N", sensor.index, sensor.body, sensor.value);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Sensors, responses and forces are those of MIMo's touch (Mattern et al., "MIMo: A Multi-Modal Infant Model for Studying
//! Cognitive Development", 2024), without its meshes: the sensors it finds along the surface within twice their distance
//! are always those of the Euclidean ball.

mod contact;
mod grid;
mod hull;
mod layout;
mod picture;
mod points;
mod trace;

use std::sync::Arc;

pub use contact::{TouchContact, touch_contacts};
pub use hull::Hull;
pub use layout::{MAX_SENSORS, SkinBody, SkinError, SkinGeom, SkinLayout};
pub use picture::{Picture, draw_skin};
pub use points::surface_points;

use crate::config::{Compat, Config, TouchFunction, TouchResponse};
use crate::math::*;
use crate::model::{BodyId, GeomId, Model};
use crate::physics::{Contact, State};

/// Sensors within this many times their distance share a force ([`TouchResponse::SpreadLinear`]).
const REACH: f64 = 2.0;

/// The reference does not respond where the x component of the force times the sum of weights is at most this.
const DROPPED: f64 = 1e-10;

/// Rotation from the frame of the body of sensors on up to this many geoms is computed once per contact.
const MAX_GEOMS: usize = 8;

/// A sensor that feels something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveSensor<'a> {
    /// The sensor, counted over all bodies.
    pub sensor: usize,
    /// Its body.
    pub body: BodyId,
    /// The sensor, counted within the body: index into [`SkinLayout::sensor_positions`].
    pub index: usize,
    /// One or three numbers, N.
    pub value: &'a [f32],
}

/// The sense of touch of one environment.
#[derive(Clone, Debug)]
pub struct Touch {
    layout: Arc<SkinLayout>,
    function: TouchFunction,
    response: TouchResponse,
    compat: Compat,
    values: Vec<f32>,
    /// Sensors that were written, and for each sensor whether it was.
    touched: Vec<u32>,
    is_touched: Vec<bool>,
    contacts: Vec<TouchContact>,
    /// Sensors in reach of a contact, and their weights.
    near: Vec<(u32, f64)>,
}

impl Touch {
    /// A sense that feels nothing yet.
    ///
    /// Any `function` may be combined with any `compat`: [`TouchFunction::Normal`] is the page's normal force,
    /// [`TouchFunction::NormalForce`] the Python code's. `compat` decides about
    /// - the frame of [`TouchFunction::ForceVector`]: that of the sensor's geom, or (reference) that of its body,
    /// - the place of the second side of contacts between bodies that feel, see [`touch_contacts`],
    /// - [`TouchResponse::SpreadLinear`] of a force with no x component: shared like any other, or (reference) lost.
    pub fn new(layout: Arc<SkinLayout>, function: TouchFunction, response: TouchResponse, compat: Compat) -> Self {
        let width = if function == TouchFunction::Normal { 1 } else { 3 };
        let most = layout.bodies().iter().map(SkinBody::len).max().unwrap_or(0);
        Self {
            function,
            response,
            compat,
            values: vec![0.0; width * layout.len()],
            touched: Vec::with_capacity(layout.len()),
            is_touched: vec![false; layout.len()],
            contacts: Vec::with_capacity(128),
            near: Vec::with_capacity(most),
            layout,
        }
    }

    /// As configured by `touch_function`, `touch_response` and `compat`.
    pub fn configured(layout: Arc<SkinLayout>, config: &Config) -> Self {
        Self::new(layout, config.touch_function, config.touch_response, config.compat)
    }

    /// Where the sensors are.
    pub fn layout(&self) -> &Arc<SkinLayout> {
        &self.layout
    }

    /// What a sensor reports.
    pub fn function(&self) -> TouchFunction {
        self.function
    }

    /// Numbers per sensor: 1 for [`TouchFunction::Normal`], else 3.
    pub fn width(&self) -> usize {
        if self.function == TouchFunction::Normal { 1 } else { 3 }
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.values.len()
    }

    /// Whether there are no sensors.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// Values of all sensors, N: sensor by sensor, [`Self::width`] numbers each.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Values of the sensors of a body; empty if it does not feel.
    pub fn body_values(&self, body: BodyId) -> &[f32] {
        let width = self.width();
        let range = self
            .layout
            .body(body)
            .map_or(0..0, |b| width * b.offset..width * (b.offset + b.len()));
        &self.values[range]
    }

    /// The sensors whose value is not zero, in the order in which contacts reached them.
    pub fn active(&self) -> impl Iterator<Item = ActiveSensor<'_>> {
        let width = self.width();
        self.touched.iter().filter_map(move |&sensor| {
            let sensor = sensor as usize;
            let value = &self.values[width * sensor..width * (sensor + 1)];
            let (body, index) = self.layout.locate(sensor)?;
            value.iter().any(|v| *v != 0.0).then_some(ActiveSensor {
                sensor,
                body: body.body,
                index,
                value,
            })
        })
    }

    /// The contacts that are felt, with points and forces in world and body frame: the sense without its sensors. Both
    /// sides of a contact between two bodies that feel are listed.
    pub fn contacts(&self) -> &[TouchContact] {
        &self.contacts
    }

    /// Sum of the contact forces on a body that feels, N, world frame.
    pub fn force_on_body(&self, body: BodyId) -> Vec3 {
        self.sum(|c| c.body == body)
    }

    /// Sum of the contact forces on a geom of a body that feels, N, world frame.
    pub fn force_on_geom(&self, geom: GeomId) -> Vec3 {
        self.sum(|c| c.geom == geom)
    }

    fn sum(&self, which: impl Fn(&TouchContact) -> bool) -> Vec3 {
        let felt = self.contacts.iter().filter(|c| which(c));
        felt.fold([0.0; 3], |sum, c| add(sum, c.force))
    }

    /// [`Self::sense`] of a state: the contacts and poses of the start of its last step.
    pub fn observe(&mut self, model: &Model, s: &State) {
        self.sense(model, &s.contacts, &s.xpos, &s.xmat);
    }

    /// Feels `contacts`, with body poses `xpos` (m) and `xmat` of the same instant, and forgets what was felt before.
    ///
    /// Costs what is touched, whatever the number of sensors, and allocates nothing after a few calls.
    pub fn sense(&mut self, model: &Model, contacts: &[Contact], xpos: &[Vec3], xmat: &[Mat3]) {
        self.clear();
        let layout = self.layout.clone();
        touch_contacts(&layout, model, contacts, xpos, xmat, self.compat, &mut self.contacts);
        for k in 0..self.contacts.len() {
            let c = self.contacts[k];
            let skin = &layout.bodies()[c.index];
            let value = match self.function {
                TouchFunction::Normal => [c.normal, 0.0, 0.0],
                TouchFunction::ForceVector => c.force_body,
                TouchFunction::ForceVectorGlobal => c.force,
                TouchFunction::NormalForce => {
                    let contact = &contacts[c.contact];
                    // the code takes a column of the contact frame for the normal
                    let normal = column(&contact.frame, 0);
                    mat_t_vec(&xmat[c.body.0], scale(normal, c.sign() * contact.force[0]))
                }
            };
            self.touch(skin, c.point_body, value);
        }
    }

    /// Presses `value` (in the frame of the body, N) on the skin of a body at `point` (same frame, m), in addition to what
    /// is felt already. Without effect on [`Self::contacts`].
    pub fn press(&mut self, body: BodyId, point: Vec3, value: Vec3) {
        let layout = self.layout.clone();
        if let Some(skin) = layout.body(body) {
            self.touch(skin, point, value);
        }
    }

    /// Forgets what was felt.
    pub fn clear(&mut self) {
        let width = self.width();
        for &sensor in &self.touched {
            let sensor = sensor as usize;
            self.values[width * sensor..width * (sensor + 1)].fill(0.0);
            self.is_touched[sensor] = false;
        }
        self.touched.clear();
        self.contacts.clear();
    }

    /// Shares `value` among the sensors around `point`.
    fn touch(&mut self, skin: &SkinBody, point: Vec3, value: Vec3) {
        let radius = REACH * skin.scale;
        match self.response {
            TouchResponse::Nearest => {
                if let Some(sensor) = skin.grid.nearest(point, radius) {
                    self.near.clear();
                    self.near.push((sensor, 1.0));
                    self.share(skin, value, 1.0);
                }
            }
            TouchResponse::SpreadLinear => {
                let near = &mut self.near;
                near.clear();
                let mut total = 0.0;
                skin.grid.around(point, radius, |sensor, d2| {
                    if d2 < radius * radius {
                        let weight = 1.0 - d2.sqrt() / radius;
                        if weight > 0.0 {
                            total += weight;
                            near.push((sensor, weight));
                        }
                    }
                });
                let dropped = self.compat == Compat::Reference && (value[0] * total).abs() <= DROPPED;
                if total > 0.0 && !dropped {
                    self.share(skin, value, total);
                }
            }
        }
    }

    /// Adds `value` times weight over `total` to each sensor in `near`. Values are kept in single precision, each sum
    /// rounded once.
    fn share(&mut self, skin: &SkinBody, value: Vec3, total: f64) {
        let width = self.width();
        // forces in the frame of each geom of the body
        let mut framed = [value; MAX_GEOMS];
        let by_geom = self.compat == Compat::Api && self.function == TouchFunction::ForceVector;
        if by_geom {
            for (v, g) in framed.iter_mut().zip(&skin.geoms) {
                *v = mat_t_vec(&g.mat, value);
            }
        }
        for &(sensor, weight) in &self.near {
            let v = match by_geom.then(|| skin.geom_of(sensor as usize)) {
                None => value,
                Some(g) if g < MAX_GEOMS => framed[g],
                Some(g) => mat_t_vec(&skin.geoms[g].mat, value),
            };
            let sensor = skin.offset + sensor as usize;
            if !self.is_touched[sensor] {
                self.is_touched[sensor] = true;
                self.touched.push(sensor as u32);
            }
            let share = weight / total;
            for (out, v) in self.values[width * sensor..width * (sensor + 1)].iter_mut().zip(v) {
                *out = (f64::from(*out) + v * share) as f32;
            }
        }
    }
}

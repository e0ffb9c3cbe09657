//! Touch: thousands of sensors all over MIMo's body that feel contact forces.
//!
//! A [`SkinLayout`] places the sensors; a [`Touch`] turns contacts into their values. Both work with any [`Model`], and
//! with contacts and poses from any source:
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
//! touch.sense(model, &s.contact, &s.xpos, &s.xmat);
//! for sensor in touch.active() {
//!     println!("sensor {} of {:?} feels {:?} N", sensor.index, sensor.body, sensor.value);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Sensors, responses and forces are those of MIMo's touch (Mattern et al., "MIMo: A Multi-Modal Infant Model for
//! Studying Cognitive Development", 2024), without its meshes: the sensors it finds along the surface within twice
//! their distance are always those of the Euclidean ball.

mod contact;
mod grid;
mod hull;
mod layout;
pub(crate) mod points;
mod pooled;
mod scaled;
mod values;

use std::sync::Arc;

pub(crate) use contact::MIN_FORCE;
pub use contact::TouchContact;
pub use contact::touch_contacts;
use contact::{TouchedBodies, touch_flexes};
pub use hull::Hull;
pub use layout::{MAX_SENSORS, SkinGeom};
pub use layout::{SkinBody, SkinError, SkinLayout};
pub use points::surface_points;
pub use pooled::{POOLED, TouchPool};
pub use values::SkinValues;

use crate::config::{Compat, Config, TouchFunction, TouchResponse};
use crate::math::*;
use crate::model::Model;
use crate::physics::{Contact, FlexContact, State};

/// Reach of a force, in multiples of the sensor distance ([`TouchResponse::SpreadLinear`]).
const REACH: f64 = 2.0;

/// Bound below which the reference does not respond: the x component of the force times the sum of weights.
const DROPPED: f64 = 1e-10;

/// Greatest number of geoms for which the rotation to a sensor's frame is cached during a contact.
const MAX_GEOMS: usize = 8;

/// A sensor that feels a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveSensor<'a> {
    /// Index of the sensor, counted over all bodies.
    pub sensor: usize,
    /// Its body, by id.
    pub body: usize,
    /// Index of the sensor within the body, as in [`SkinLayout::sensor_positions`].
    pub index: usize,
    /// One or three values, N.
    pub value: &'a [f32],
}

/// The sense of touch of one environment.
#[derive(Clone, Debug)]
pub struct Touch {
    layout: Arc<SkinLayout>,
    function: TouchFunction,
    response: TouchResponse,
    compat: Compat,
    felt: SkinValues,
    contacts: Vec<TouchContact>,
    /// Sensors in reach of a contact, and their weights.
    near: Vec<(u32, f64)>,
}

impl Touch {
    /// Creates a sense without contacts.
    ///
    /// Any `function` may be combined with any `compat`: [`TouchFunction::Normal`] is the page's normal force,
    /// [`TouchFunction::NormalForce`] the Python code's. `compat` decides
    /// - the frame of [`TouchFunction::ForceVector`]: that of the sensor's geom, or (reference) that of its body,
    /// - the point of the second side of contacts between bodies with skin, see [`touch_contacts`],
    /// - [`TouchResponse::SpreadLinear`] of a force with no x component: shared like any other, or (reference) lost.
    pub fn new(layout: Arc<SkinLayout>, function: TouchFunction, response: TouchResponse, compat: Compat) -> Self {
        let width = if function == TouchFunction::Normal { 1 } else { 3 };
        let most = layout.bodies().iter().map(SkinBody::len).max().unwrap_or(0);
        Self {
            function,
            response,
            compat,
            felt: SkinValues::new(layout.len(), width),
            contacts: Vec::with_capacity(128),
            near: Vec::with_capacity(most),
            layout,
        }
    }

    /// Creates the sense that `touch_function`, `touch_response` and `compat` select.
    pub fn configured(layout: Arc<SkinLayout>, config: &Config) -> Self {
        Self::new(layout, config.touch_function, config.touch_response, config.compat)
    }

    /// Returns the layout of the sensors.
    pub fn layout(&self) -> &Arc<SkinLayout> {
        &self.layout
    }

    /// Returns the quantity that sensors report.
    pub fn function(&self) -> TouchFunction {
        self.function
    }

    /// Returns the number of values per sensor: 1 for [`TouchFunction::Normal`], otherwise 3.
    pub fn width(&self) -> usize {
        self.felt.width()
    }

    /// Returns the number of values.
    pub fn len(&self) -> usize {
        self.values().len()
    }

    /// Returns whether there are no sensors.
    pub fn is_empty(&self) -> bool {
        self.values().is_empty()
    }

    /// Returns the forces on all sensors, N.
    pub fn felt(&self) -> &SkinValues {
        &self.felt
    }

    /// Returns the values of all sensors, N: sensor by sensor, [`Self::width`] numbers each.
    pub fn values(&self) -> &[f32] {
        self.felt.values()
    }

    /// Returns the values of the sensors of a body; empty if it has none.
    pub fn body_values(&self, body: usize) -> &[f32] {
        let width = self.width();
        let range = self
            .layout
            .body(body)
            .map_or(0..0, |b| width * b.offset..width * (b.offset + b.len()));
        &self.values()[range]
    }

    /// Iterates over the sensors whose value is not zero, in the order in which contacts reached them.
    pub fn active(&self) -> impl Iterator<Item = ActiveSensor<'_>> {
        self.touched().iter().filter_map(|&sensor| {
            let sensor = sensor as usize;
            let value = self.felt.of(sensor);
            let (body, index) = self.layout.locate(sensor)?;
            value.iter().any(|v| *v != 0.0).then_some(ActiveSensor {
                sensor,
                body: body.body,
                index,
                value,
            })
        })
    }

    /// Returns the sensors that contacts have reached, in that order: all others have the value zero.
    pub fn touched(&self) -> &[u32] {
        self.felt.touched()
    }

    /// Returns the contacts with skin, with points and forces in the world and body frames: touch before it is spread
    /// over the sensors. A contact between two bodies with skin is listed from both sides.
    pub fn contacts(&self) -> &[TouchContact] {
        &self.contacts
    }

    /// Returns the sum of the contact forces on a body with skin, N, world frame.
    pub fn force_on_body(&self, body: usize) -> Vec3 {
        self.sum(|c| c.body == body)
    }

    /// Returns the sum of the contact forces on a geom of a body with skin, N, world frame.
    pub fn force_on_geom(&self, geom: usize) -> Vec3 {
        self.sum(|c| c.geom == geom)
    }

    fn sum(&self, which: impl Fn(&TouchContact) -> bool) -> Vec3 {
        let felt = self.contacts.iter().filter(|c| which(c));
        felt.fold([0.0; 3], |sum, c| add(sum, c.force))
    }

    /// Senses a state: the contacts of geoms and flexes, and the poses at the start of its last step.
    pub fn observe(&mut self, model: &Model, s: &State) {
        self.sense_with_flexes(model, (&s.contact, &s.flex_contact), (&s.xpos, &s.xmat));
    }

    /// Senses `contacts`, with body poses `xpos` (m) and `xmat` of the same instant, replacing earlier values.
    ///
    /// The cost grows with the number of contacts, not of sensors; nothing is allocated after a few calls.
    pub fn sense(&mut self, model: &Model, contacts: &[Contact], xpos: &[Vec3], xmat: &[Mat3]) {
        self.sense_with_flexes(model, (contacts, &[]), (xpos, xmat));
    }

    /// Senses contacts of geoms and of flexes, as [`Touch::sense`] does.
    pub fn sense_with_flexes(
        &mut self,
        model: &Model,
        (contacts, flexes): (&[Contact], &[FlexContact]),
        (xpos, xmat): (&[Vec3], &[Mat3]),
    ) {
        self.clear();
        let layout = self.layout.clone();
        touch_contacts(&layout, model, contacts, xpos, xmat, self.compat, &mut self.contacts);
        let touched = TouchedBodies {
            layout: &layout,
            model,
            poses: (xpos, xmat),
            compat: self.compat,
        };
        touch_flexes(&touched, contacts.len(), flexes, &mut self.contacts);
        for k in 0..self.contacts.len() {
            let c = self.contacts[k];
            let skin = &layout.bodies()[c.index];
            let value = match self.function {
                TouchFunction::Normal => [c.normal, 0.0, 0.0],
                TouchFunction::ForceVector => c.force_body,
                TouchFunction::ForceVectorGlobal => c.force,
                TouchFunction::NormalForce => {
                    let contact = match c.contact.checked_sub(contacts.len()) {
                        None => &contacts[c.contact],
                        Some(of_flex) => &flexes[of_flex].contact,
                    };
                    // the Python code takes a column of the contact frame for the normal
                    let normal = column(&contact.frame, 0);
                    mat_t_vec(&xmat[c.body], scale(normal, c.sign() * contact.force[0]))
                }
            };
            self.contacts[k].felt = self.touch(skin, c.point_body, value);
        }
    }

    /// Adds `value` (in the frame of the body, N), pressed on the skin of a body at `point` (same frame, m), to the current values;
    /// [`Self::contacts`] do not change.
    pub fn press(&mut self, body: usize, point: Vec3, value: Vec3) {
        let layout = self.layout.clone();
        if let Some(skin) = layout.body(body) {
            self.touch(skin, point, value);
        }
    }

    /// Sets all sensors to zero and removes all contacts.
    pub fn clear(&mut self) {
        self.felt.clear();
        self.contacts.clear();
    }

    /// Shares `value` among the sensors around `point`. Returns whether there are any.
    fn touch(&mut self, skin: &SkinBody, point: Vec3, value: Vec3) -> bool {
        let radius = REACH * skin.spacing;
        match self.response {
            TouchResponse::Nearest => {
                let Some(sensor) = skin.grid.nearest(point, radius) else {
                    return false;
                };
                self.near.clear();
                self.near.push((sensor, 1.0));
                self.share(skin, value, 1.0);
                true
            }
            TouchResponse::SpreadLinear => {
                let near = &mut self.near;
                near.clear();
                let mut total = 0.0;
                skin.grid.around(point, radius, |sensor, d2| {
                    // the grid gives whole cells, also sensors beyond the radius
                    if d2 < radius * radius {
                        let weight = 1.0 - d2.sqrt() / radius;
                        if weight > 0.0 {
                            total += weight;
                            near.push((sensor, weight));
                        }
                    }
                });
                let dropped = self.compat == Compat::Reference && (value[0] * total).abs() <= DROPPED;
                let felt = total > 0.0 && !dropped;
                if felt {
                    self.share(skin, value, total);
                }
                felt
            }
        }
    }

    /// Adds `value` times weight over `total` to each sensor in `near`. Values are kept in single precision, each sum
    /// rounded once.
    fn share(&mut self, skin: &SkinBody, value: Vec3, total: f64) {
        // forces in the frame of each geom of the body
        let mut framed = [value; MAX_GEOMS];
        // the page has the force in the frame of the sensor's geom, the Python code in that of its body
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
            let share = weight / total;
            for (out, v) in self.felt.of_mut(sensor).iter_mut().zip(v) {
                *out = (f64::from(*out) + v * share) as f32;
            }
        }
    }
}

//! Slots: bodies of the model that stand for bodies of the world while those are near.

use std::fmt::Write;
use std::ops::Range;

use mjcf_sim_model::Model;

use super::{CouplingError, CouplingOptions};

/// Prefix of the names of slots.
const PREFIX: &str = "rapier_";

/// The body of a slot in the model.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slot {
    /// Body, by id.
    pub body: usize,
    /// First position and first velocity of its free joint; `None` for slots of fixed shapes, which are mocap bodies.
    pub joint: Option<[usize; 2]>,
    /// Row in `mocap_pos`, for slots of fixed shapes.
    pub mocap: usize,
    /// Its geoms, by id.
    pub geoms: Range<usize>,
}

/// All slots of a model.
#[derive(Clone, Debug)]
pub(super) struct Slots {
    /// Slots with a free joint for one shape, then those for several shapes, then slots for fixed shapes.
    pub all: Vec<Slot>,
    /// Number of slots of one shape.
    pub bodies: usize,
    /// Number of slots with a free joint.
    pub free: usize,
    /// Slot of each body of the model (nbody).
    pub of_body: Vec<Option<usize>>,
}

fn names(options: &CouplingOptions) -> impl Iterator<Item = (String, usize)> + '_ {
    let bodies = (0..options.bodies).map(|k| (format!("{PREFIX}body_{k}"), 1));
    let compounds = (0..options.compounds).map(|k| (format!("{PREFIX}compound_{k}"), options.compound_shapes));
    let fixed = (0..options.fixed).map(|k| (format!("{PREFIX}fixed_{k}"), 1));
    bodies.chain(compounds).chain(fixed)
}

impl CouplingOptions {
    /// Returns the slots as MJCF bodies, which a document needs in its `<worldbody>` to be coupled.
    ///
    /// A slot is a body that stands for a body of the world while that is near: it has a free joint, or `mocap` for fixed shapes. Unused
    /// slots rest at the origin, touch nothing and are not drawn.
    pub fn slots(&self) -> String {
        let mut out = String::new();
        for (name, shapes) in names(self) {
            let fixed = name.starts_with("rapier_fixed");
            // nothing fails: text is written into memory
            let _ = write!(out, "<body name=\"{name}\"");
            if fixed {
                out += " mocap=\"true\">";
            } else {
                out += "><freejoint align=\"false\"/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\".01 .01 .01\"/>";
            }
            let mass = if fixed { "0" } else { ".1" };
            for _ in 0..shapes {
                // every attribute that physics reads, as default classes of the document apply to slots, too
                let _ = write!(
                    out,
                    "<geom type=\"sphere\" size=\".01\" pos=\"0 0 0\" quat=\"1 0 0 0\" mass=\"{mass}\" contype=\"0\" conaffinity=\"0\" \
                    condim=\"3\" priority=\"0\" solmix=\"1\" margin=\"0\" gap=\"0\" fluidshape=\"none\" group=\"5\" rgba=\".5 .5 .5 0\"/>"
                );
            }
            out += "</body>";
        }
        out
    }
}

impl Slots {
    /// Finds the slots in a model.
    pub fn new(model: &Model, options: &CouplingOptions) -> Result<Self, CouplingError> {
        let mut slots = Self {
            all: Vec::new(),
            bodies: options.bodies,
            free: options.bodies + options.compounds,
            of_body: vec![None; model.nbody()],
        };
        for (name, shapes) in names(options) {
            let found = model.body(&name).filter(|&body| model.body_geomnum[body] == shapes);
            let Some(body) = found else {
                return Err(CouplingError::NoSlots { name });
            };
            let joint = model.body_jntadr[body];
            let free = (model.body_jntnum[body] == 1).then(|| [model.jnt_qposadr[joint], model.jnt_dofadr[joint]]);
            if free.is_some() != (slots.all.len() < slots.free) || free.is_some() == model.body_mocapid[body].is_some()
            {
                return Err(CouplingError::NoSlots { name });
            }
            slots.of_body[body] = Some(slots.all.len());
            let first = model.body_geomadr[body];
            slots.all.push(Slot {
                body,
                joint: free,
                mocap: model.body_mocapid[body].unwrap_or_default(),
                geoms: first..first + shapes,
            });
        }
        Ok(slots)
    }
}

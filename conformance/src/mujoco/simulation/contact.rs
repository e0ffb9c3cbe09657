//! Contacts of a step.

use std::ffi::c_int;

use super::super::layout::field;
use super::super::offsets::{CONTACT, CONTACT_SIZE, PARTS};
use super::{Simulation, array};

/// A MuJoCo contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The geoms; `usize::MAX` where a side is a flex.
    pub geom: [usize; 2],
    /// Flex, element and vertex of each side, if it has them.
    pub flex: [[Option<usize>; 3]; 2],
    /// Distance, m.
    pub dist: f64,
    /// Position, m.
    pub pos: [f64; 3],
    /// Rows are the normal and two tangents.
    pub frame: [f64; 9],
    /// Dimension.
    pub dim: usize,
    /// Two sliding, one torsional, two rolling friction coefficients.
    pub friction: [f64; 5],
    /// Distance at which it becomes a constraint: margin minus gap, m.
    pub includemargin: f64,
    /// First constraint row, when it is a constraint.
    pub efc_address: Option<usize>,
    /// Force and torque in the contact frame, by `mj_contactForce`.
    pub force: [f64; 6],
}

impl Simulation {
    /// Returns the contacts of the last step, with their forces.
    pub fn contacts(&self) -> Vec<Contact> {
        let at = const { field(PARTS, "contact").at };
        // SAFETY: `contact` points to `ncon` structures of this size.
        let all = unsafe { array::<u8>(self.data, at, self.ncon() * CONTACT_SIZE) };
        all.chunks_exact(CONTACT_SIZE)
            .enumerate()
            .map(|(k, c)| self.contact(k, c))
            .collect()
    }

    fn contact(&self, k: usize, bytes: &[u8]) -> Contact {
        let number = |name: &str, i: usize| {
            let at = field(CONTACT, name).at + 8 * i;
            f64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
        };
        let integer = |name: &str, i: usize| {
            let at = field(CONTACT, name).at + 4 * i;
            i32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
        };
        let mut force = [0.0; 6];
        // SAFETY: `k` is below the number of contacts, and there is room for six numbers.
        unsafe { (self.api.contact_force)(self.model, self.data, k as c_int, force.as_mut_ptr()) };
        Contact {
            geom: [0, 1].map(|side| usize::try_from(integer("geom", side)).unwrap_or(usize::MAX)),
            flex: [0, 1].map(|side| ["flex", "elem", "vert"].map(|name| usize::try_from(integer(name, side)).ok())),
            dist: number("dist", 0),
            pos: std::array::from_fn(|i| number("pos", i)),
            frame: std::array::from_fn(|i| number("frame", i)),
            dim: usize::try_from(integer("dim", 0)).unwrap_or(0),
            friction: std::array::from_fn(|i| number("friction", i)),
            includemargin: number("includemargin", 0),
            efc_address: usize::try_from(integer("efc_address", 0)).ok(),
            force,
        }
    }
}

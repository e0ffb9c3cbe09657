//! The degrees of freedom that move tendons, and those that actuators act on.

use std::ops::Range;

use super::Topology;
use crate::model::{Arrays, TrnType, Wrap};

/// A sparse row over the degrees of freedom for each of some elements.
#[derive(Clone, Debug, Default)]
pub struct DofRows {
    /// First entry of each row, and one past the last.
    adr: Vec<usize>,
    /// Degrees of freedom of each row, ascending.
    dofs: Vec<u32>,
}

impl DofRows {
    /// Makes rows of degrees of freedom, which may come in any order and more than once.
    fn new(rows: impl Iterator<Item = Vec<u32>>) -> Self {
        let mut all = Self::default();
        all.adr.push(0);
        for mut row in rows {
            row.sort_unstable();
            row.dedup();
            all.dofs.extend(row);
            all.adr.push(all.dofs.len());
        }
        all
    }

    /// Returns the entries of a row among those of all rows.
    #[inline]
    pub fn range(&self, row: usize) -> Range<usize> {
        self.adr[row]..self.adr[row + 1]
    }

    /// Returns the degrees of freedom of a row, ascending.
    #[inline]
    pub fn row(&self, row: usize) -> &[u32] {
        &self.dofs[self.range(row)]
    }

    /// Returns the number of entries of all rows.
    pub fn len(&self) -> usize {
        self.dofs.len()
    }
}

/// Returns the degrees of freedom that can change the length of each tendon.
pub(super) fn tendons(model: &Arrays, topology: &Topology) -> DofRows {
    let of = |t: usize| {
        let joints = model.tendon_wrap[t].iter().filter_map(|along| match *along {
            Wrap::Joint { joint, .. } => Some(model.jnt_dofadr[joint] as u32),
            _ => None,
        });
        let mut row: Vec<u32> = joints.collect();
        for [a, b] in neighbours(model, t).filter(|[a, b]| a != b) {
            let (chain_a, chain_b) = topology.apart(a, b);
            row.extend(chain_a);
            row.extend(chain_b);
        }
        row
    };
    DofRows::new((0..model.ntendon()).map(of))
}

/// Returns the degrees of freedom that can change the length of each edge of the flexes whose edges pull.
pub(super) fn flexedges(model: &Arrays, topology: &Topology) -> DofRows {
    let edges = model
        .flexes
        .iter()
        .flat_map(|flex| flex.edge.iter().map(move |edge| (flex, edge)));
    DofRows::new(edges.map(|(flex, &[a, b])| {
        if !flex.edges_pull() {
            return Vec::new();
        }
        let (first, second) = topology.apart(flex.vertbodyid[a], flex.vertbodyid[b]);
        [first, second].concat()
    }))
}

/// Returns the degrees of freedom on which each actuator with its own moment acts: on a ball joint, a free
/// joint, a site, a slider-crank, contacts.
pub(super) fn actuators(model: &Arrays, topology: &Topology) -> DofRows {
    let chain = |site: usize| topology.body_chain(model.site_bodyid[site]);
    let of = |i: usize| {
        let (id, reference) = (model.actuator_trnid[i], model.actuator_refid[i]);
        match model.actuator_trntype[i] {
            TrnType::Joint | TrnType::JointInParent | TrnType::Tendon => {
                let joint = model.actuator_turns(i);
                let dofs = joint.map(|j| model.jnt_dofadr[j]..model.jnt_dofadr[j] + model.jnt_type[j].nv());
                dofs.into_iter().flatten().map(|d| d as u32).collect()
            }
            TrnType::Body => (0..model.nv as u32).collect(),
            TrnType::SliderCrank | TrnType::Site => [chain(id), reference.map_or(&[][..], chain)].concat(),
        }
    };
    DofRows::new((0..model.nu()).map(of))
}

/// Lists the actuators with their own moment.
pub(super) fn own_moments(model: &Arrays) -> Vec<usize> {
    let own = |&i: &usize| match model.actuator_trntype[i] {
        TrnType::Joint | TrnType::JointInParent => model.actuator_turns(i).is_some(),
        TrnType::Tendon => false,
        TrnType::SliderCrank | TrnType::Site | TrnType::Body => true,
    };
    (0..model.nu()).filter(own).collect()
}

/// Lists coordinate and degree of freedom of the hinge or slide that each actuator acts on, if it acts on one.
pub(super) fn actuator_scalar(model: &Arrays) -> Vec<Option<[u32; 2]>> {
    let scalar = |i: usize| {
        let joint = model.actuator_joint(i).filter(|&j| model.jnt_type[j].nv() == 1);
        joint.map(|j| [model.jnt_qposadr[j] as u32, model.jnt_dofadr[j] as u32])
    };
    (0..model.nu()).map(scalar).collect()
}

/// Iterates over the bodies of neighbouring elements along a spatial tendon.
fn neighbours(model: &Arrays, t: usize) -> impl Iterator<Item = [usize; 2]> {
    let pairs = model.tendon_wrap[t].windows(2);
    let direct = pairs.filter_map(|pair| Some([pair[0].body(model)?, pair[1].body(model)?]));
    // past a geom that is not in the way
    let sites = model.tendon_wrap[t].windows(3);
    let past = sites.filter_map(|three| match three {
        [
            first @ Wrap::Site { .. },
            Wrap::Sphere { .. } | Wrap::Cylinder { .. },
            last @ Wrap::Site { .. },
        ] => Some([first.body(model)?, last.body(model)?]),
        _ => None,
    });
    direct.chain(past)
}

//! The numbers of the slots in a model and in its parameters.

use mjcf_sim_model::Model;
use mjcf_sim_model::model::{Arrays, GeomType, SameFrame};
use mjcf_sim_physics::Params;
use rapier3d_f64::dynamics::ImpulseJointSet;
use rapier3d_f64::geometry::InteractionGroups;

use super::Material;
use super::neighbors::{Inertia, Neighbor, Source};
use super::shapes::GeomRow;
use super::slots::Slots;

/// Bits with which geoms touch everything.
const ALL: u32 = u32::MAX;
/// Group of geoms that are not drawn.
const HIDDEN: i32 = 5;
/// Inertia of unused slots, as compiled.
const IDLE: Inertia = Inertia {
    mass: 1.0,
    moments: [0.01; 3],
    damping: [0.0; 2],
};

/// Numbers of the model before it was coupled, to which changes return.
#[derive(Clone)]
pub(super) struct Original {
    meshes: usize,
    hfields: usize,
    exclude: Vec<[usize; 2]>,
    /// Fixed geoms: their ids, contact types, affinities and groups.
    fixed: Vec<(usize, u32, u32, i32)>,
}

impl Original {
    pub fn new(model: &Model, fixed: &[usize]) -> Self {
        let saved = |&g: &usize| (g, model.geom_contype[g], model.geom_conaffinity[g], model.geom_group[g]);
        Self {
            fixed: fixed.iter().map(saved).collect(),
            meshes: model.meshes.len(),
            hfields: model.hfields.len(),
            exclude: model.exclude.clone(),
        }
    }

    /// Switches off the model's own fixed geoms.
    pub fn drop_scenery(&self, arrays: &mut Arrays) {
        for &(g, ..) in &self.fixed {
            (arrays.geom_contype[g], arrays.geom_conaffinity[g]) = (0, 0);
            arrays.geom_group[g] = HIDDEN;
        }
    }

    /// Switches the model's own fixed geoms on again.
    pub fn restore_scenery(&self, arrays: &mut Arrays) {
        for &(g, contype, conaffinity, group) in &self.fixed {
            (arrays.geom_contype[g], arrays.geom_conaffinity[g]) = (contype, conaffinity);
            arrays.geom_group[g] = group;
        }
    }
}

/// Writes mass, moments and what follows from them.
fn weigh(to: &mut Arrays, b: usize, dof: usize, inertia: Inertia) {
    let Inertia { mass, moments, damping } = inertia;
    to.body_mass[b] = mass;
    to.body_inertia[b] = moments;
    // the frame of the slot is that of its inertia: the formulas of `State::set_free_body` without a lever
    let turn = moments.iter().map(|i| 1.0 / i).sum::<f64>() / 3.0;
    to.body_invweight0[b] = [1.0 / mass, turn];
    to.dof_invweight0[dof..dof + 3].fill(1.0 / mass);
    to.dof_invweight0[dof + 3..dof + 6].fill(turn);
    to.dof_m0[dof..dof + 3].fill(mass);
    to.dof_m0[dof + 3..dof + 6].copy_from_slice(&moments);
    to.dof_damping[dof..dof + 3].fill(mass * damping[0]);
    to.dof_damping[dof + 3..dof + 6].copy_from_slice(&moments.map(|moment| moment * damping[1]));
}

/// Sums the masses of subtrees.
macro_rules! sum_masses {
    ($to:expr, $parents:expr) => {{
        $to.body_subtreemass.clone_from(&$to.body_mass);
        for b in (1..$parents.len()).rev() {
            let mass = $to.body_subtreemass[b];
            $to.body_subtreemass[$parents[b]] += mass;
        }
    }};
}

fn of_slot(neighbors: &[Neighbor], slot: usize) -> Option<(&Neighbor, usize)> {
    let place = |n: &Neighbor| n.slots.iter().position(|&taken| taken == slot);
    neighbors.iter().find_map(|n| Some((n, place(n)?)))
}

/// Writes the neighbors into the slots of a model.
pub(super) fn write_model(
    arrays: &mut Arrays,
    slots: &Slots,
    original: &Original,
    neighbors: &[Neighbor],
    excluded: &[[usize; 2]],
) {
    arrays.meshes.truncate(original.meshes);
    arrays.hfields.truncate(original.hfields);
    for (k, slot) in slots.all.iter().enumerate() {
        let found = of_slot(neighbors, k);
        if let Some([_, dof]) = slot.joint {
            let inertia = found.and_then(|(n, _)| n.inertia).unwrap_or(IDLE);
            weigh(arrays, slot.body, dof, inertia);
        }
        for (at, g) in slot.geoms.clone().enumerate() {
            let geom =
                found.and_then(|(n, place)| n.geoms.get(if n.inertia.is_some() { at } else { place }).zip(Some(n)));
            match geom {
                Some(((row, material, _), n)) => write_geom(arrays, g, row, material, n.moved),
                None => {
                    (arrays.geom_contype[g], arrays.geom_conaffinity[g]) = (0, 0);
                    arrays.geom_group[g] = HIDDEN;
                    // rays leave it out, too
                    arrays.geom_rgba[g][3] = 0.0;
                }
            }
        }
    }
    let parents = arrays.body_parentid.clone();
    sum_masses!(arrays, parents);
    arrays.exclude.clone_from(&original.exclude);
    arrays.exclude.extend_from_slice(excluded);
    arrays.exclude.sort_unstable();
    arrays.exclude.dedup();
}

fn write_geom(arrays: &mut Arrays, g: usize, row: &GeomRow, material: &Material, moved: bool) {
    arrays.geom_type[g] = row.kind;
    arrays.geom_size[g] = row.size;
    arrays.geom_pos[g] = row.pos;
    arrays.geom_quat[g] = row.quat;
    arrays.geom_sameframe[g] = SameFrame::None;
    arrays.geom_aabb[g] = row.aabb;
    arrays.geom_rbound[g] = row.rbound;
    arrays.geom_dataid[g] = None;
    if let Some(mesh) = &row.mesh {
        arrays.geom_dataid[g] = Some(arrays.meshes.len());
        arrays.meshes.push(mesh.clone());
    }
    if let Some(hfield) = &row.hfield {
        arrays.geom_dataid[g] = Some(arrays.hfields.len());
        arrays.hfields.push(hfield.clone());
    }
    // fixed and kinematic bodies have a type of 0, so that they do not touch each other
    arrays.geom_contype[g] = if moved { ALL } else { 0 };
    arrays.geom_conaffinity[g] = ALL;
    arrays.geom_condim[g] = material.condim;
    arrays.geom_priority[g] = material.priority;
    arrays.geom_friction[g] = material.friction;
    arrays.geom_solref[g] = material.solref;
    arrays.geom_solimp[g] = material.solimp;
    arrays.geom_rgba[g] = material.rgba;
    arrays.geom_group[g] = 0;
}

/// Writes the numbers of the slots from a model into parameters.
pub(super) fn write_params(params: &mut Params, model: &Model, slots: &Slots) {
    for slot in &slots.all {
        if let Some([_, dof]) = slot.joint {
            let b = slot.body;
            params.body_mass[b] = model.body_mass[b];
            params.body_inertia[b] = model.body_inertia[b];
            params.body_invweight0[b] = model.body_invweight0[b];
            let dofs = dof..dof + 6;
            params.dof_invweight0[dofs.clone()].copy_from_slice(&model.dof_invweight0[dofs.clone()]);
            params.dof_damping[dofs.clone()].copy_from_slice(&model.dof_damping[dofs]);
        }
        for g in slot.geoms.clone() {
            params.geom_size[g] = model.geom_size[g];
            params.geom_rbound[g] = model.geom_rbound[g];
        }
    }
    sum_masses!(params, model.body_parentid);
}

/// Returns the geoms of a model that never move and are in no slot.
pub(super) fn fixed_geoms(model: &Model, slots: &Slots) -> Vec<usize> {
    let fixed = |&g: &usize| {
        let body = model.geom_bodyid[g];
        !model.moves(body) && slots.of_body[body].is_none()
    };
    (0..model.ngeom()).filter(fixed).collect()
}

/// Finds the pairs of slots that Rapier does not let touch: by their groups, or because of a joint.
pub(super) fn find_excluded(
    slots: &Slots,
    neighbors: &[Neighbor],
    joints: &ImpulseJointSet,
    out: &mut Vec<[usize; 2]>,
) {
    out.clear();
    for (i, a) in neighbors.iter().enumerate() {
        for b in &neighbors[i + 1..] {
            let joined = match (a.source, b.source) {
                (Source::Body(one), Source::Body(other)) => joints
                    .joints_between(one, other)
                    .any(|(_, joint)| !joint.data.contacts_enabled()),
                _ => false,
            };
            let meet = |i: usize, k: usize| {
                let both = a.groups(i).into_iter().zip(b.groups(k));
                both.fold(true, |all, (one, other): (InteractionGroups, InteractionGroups)| {
                    all & one.test(other)
                })
            };
            let apart = joined || !(0..a.geoms.len()).any(|i| (0..b.geoms.len()).any(|k| meet(i, k)));
            if apart {
                let body = |&slot: &usize| slots.all[slot].body;
                for one in a.slots.iter().map(body) {
                    out.extend(b.slots.iter().map(body).map(|other| [one.min(other), one.max(other)]));
                }
            }
        }
    }
}

/// Returns the boxes around geoms that can touch, of bodies that move and are in no slot: their numbers.
pub(super) fn touching_geoms(model: &Model, slots: &Slots) -> Vec<usize> {
    let touches = |&g: &usize| {
        let body = model.geom_bodyid[g];
        let bits = model.geom_contype[g] | model.geom_conaffinity[g];
        model.moves(body) && slots.of_body[body].is_none() && bits != 0 && model.geom_type[g] != GeomType::Plane
    };
    (0..model.ngeom()).filter(touches).collect()
}

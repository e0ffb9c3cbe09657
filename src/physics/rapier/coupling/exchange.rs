//! The exchange between the world and a state in a step.

use mjcf_sim_model::Model;
use mjcf_sim_model::math::{Quat, Vec3, add, add_scaled, cross, mat_t_vec, sub};
use mjcf_sim_physics::State;
use rapier3d_f64::dynamics::RigidBody;
use rapier3d_f64::parry::math::{Pose, Rotation, Vector};

use super::WorldSets;
use super::impulse::Impulse;
use super::neighbors::{Neighbor, Source};
use super::slots::{Slot, Slots};

pub(super) fn vec3(v: Vector) -> Vec3 {
    [v.x, v.y, v.z]
}

pub(super) fn vector(v: Vec3) -> Vector {
    Vector::new(v[0], v[1], v[2])
}

fn quat(q: Rotation) -> Quat {
    [q.w, q.x, q.y, q.z]
}

/// Writes the neighbors into a state: poses, velocities, and forces other than those of contacts. Unused slots rest.
pub(super) fn load(s: &mut State, slots: &Slots, neighbors: &[Neighbor], sets: &WorldSets<'_>, frame: Pose) {
    let gravity = frame.rotation.inverse() * sets.gravity;
    if s.params.gravity != vec3(gravity) {
        s.params.gravity = vec3(gravity);
    }
    for slot in &slots.all[..slots.free] {
        rest(s, slot, gravity);
    }
    for n in neighbors {
        match n.source {
            Source::Body(handle) => {
                if let (Some(body), Some(&slot)) = (sets.bodies.get(handle), n.slots.first()) {
                    load_body(s, &slots.all[slot], n, body, (frame, gravity));
                }
            }
            Source::Fixed(handle) => {
                let Some(collider) = sets.colliders.get(handle) else {
                    continue;
                };
                let pose = frame.inv_mul(collider.position());
                for &slot in &n.slots {
                    let k = slots.all[slot].mocap;
                    s.mocap_pos[k] = vec3(pose.translation);
                    s.mocap_quat[k] = quat(pose.rotation);
                }
            }
        }
    }
}

/// Parks a slot at the origin, with a force against gravity.
fn rest(s: &mut State, slot: &Slot, gravity: Vector) {
    let Some([q, d]) = slot.joint else { return };
    s.qpos[q..q + 7].copy_from_slice(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    s.qvel[d..d + 6].fill(0.0);
    let up = -gravity * s.params.body_mass[slot.body];
    s.xfrc_applied[slot.body] = [up.x, up.y, up.z, 0.0, 0.0, 0.0];
}

fn load_body(s: &mut State, slot: &Slot, n: &Neighbor, body: &RigidBody, (frame, gravity): (Pose, Vector)) {
    let Some([q, d]) = slot.joint else { return };
    let local = body.mass_properties().local_mprops;
    let axes = Pose::from_parts(local.local_com, local.principal_inertia_local_frame);
    let pose = frame.inv_mul(&(*body.position() * axes));
    let back = frame.rotation.inverse();
    let (linear, angular) = (back * body.linvel(), pose.rotation.inverse() * (back * body.angvel()));
    s.qpos[q..q + 3].copy_from_slice(&vec3(pose.translation));
    s.qpos[q + 3..q + 7].copy_from_slice(&quat(pose.rotation));
    s.qvel[d..d + 3].copy_from_slice(&vec3(linear));
    s.qvel[d + 3..d + 6].copy_from_slice(&vec3(angular));
    // gravity acts on all bodies of the model alike
    let share = if n.moved { body.gravity_scale() - 1.0 } else { -1.0 };
    let force = gravity * (share * s.params.body_mass[slot.body]) + back * body.user_force();
    let torque = back * body.user_torque();
    s.xfrc_applied[slot.body] = [force.x, force.y, force.z, torque.x, torque.y, torque.z];
}

/// Adds the impulses that the contacts of the last step gave to neighbors, over `h` seconds.
pub(super) fn record(s: &State, model: &Model, slots: &Slots, h: f64, out: &mut [Impulse]) {
    for contact in &s.contact {
        if contact.efc_address.is_none() {
            continue;
        }
        let bodies = contact.geom.map(|g| model.geom_bodyid[g]);
        let [first, second] = bodies.map(|b| slots.of_body[b]);
        // the normal points from the first geom to the second, on which the force acts
        let (slot, own, sign) = match (first, second) {
            (None, Some(slot)) => (slot, bodies[0], 1.0),
            (Some(slot), None) => (slot, bodies[1], -1.0),
            // contacts between neighbors are Rapier's, here they only say what the model pushes against
            _ => continue,
        };
        if slot >= slots.free || !model.moves(own) {
            continue;
        }
        let force = contact.world_force();
        let [.., x, y, z] = contact.force;
        let arm = sub(contact.pos, s.xipos[slots.all[slot].body]);
        let moment = add(mat_t_vec(&contact.frame, [x, y, z]), cross(arm, force));
        out[slot].linear = add_scaled(out[slot].linear, force, sign * h);
        out[slot].angular = add_scaled(out[slot].angular, moment, sign * h);
    }
}

/// Returns the share of an impulse that acts before a step of the world with this many substeps; the rest acts after it.
///
/// Rapier adds the velocity of gravity in `n` parts, and moves bodies after each: by `(n + 1) / 2n` of what they would move if all came
/// first. With the same share of contacts before the step, a body that gravity and contacts hold stays where it is.
fn share(substeps: usize) -> f64 {
    let n = substeps.max(1) as f64;
    (n + 1.0) / (2.0 * n)
}

/// Applies the first part of the impulses to the bodies of the world, and keeps the rest. Sleeping bodies wake.
pub(super) fn unload(impulses: &[Impulse], neighbors: &mut [Neighbor], sets: &mut WorldSets<'_>, frame: Pose) {
    let share = share(sets.substeps);
    for n in neighbors.iter_mut().filter(|n| n.moved) {
        if let Some(&slot) = n.slots.first() {
            push(n.source, impulses[slot].times(share), sets, frame);
            n.pending = impulses[slot].times(1.0 - share);
        }
    }
}

/// Applies the rest of the impulses to the bodies of the world.
pub(super) fn finish(neighbors: &mut [Neighbor], sets: &mut WorldSets<'_>, frame: Pose) {
    for n in neighbors.iter_mut().filter(|n| n.moved) {
        push(n.source, std::mem::take(&mut n.pending), sets, frame);
    }
}

fn push(source: Source, impulse: Impulse, sets: &mut WorldSets<'_>, frame: Pose) {
    let Source::Body(handle) = source else { return };
    if impulse != Impulse::default()
        && let Some(body) = sets.bodies.get_mut(handle)
    {
        body.apply_impulse(frame.rotation * vector(impulse.linear), true);
        body.apply_torque_impulse(frame.rotation * vector(impulse.angular), true);
    }
}

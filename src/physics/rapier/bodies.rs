//! The model as Rapier's bodies: a multibody for each articulated tree, a plain body for each free object.

use rapier3d_f64::dynamics::{
    GenericJoint, ImpulseJointHandle, JointAxesMask, Multibody, RigidBodyBuilder, RigidBodyHandle,
};
use rapier3d_f64::geometry::{ActiveCollisionTypes, ColliderBuilder, ColliderHandle};
use rapier3d_f64::parry::mass_properties::MassProperties;
use rapier3d_f64::parry::math::{Pose, Rotation, Vector};
use rapier3d_f64::pipeline::ActiveHooks;

use crate::inertial::inertial;
use crate::scene::{collider_order, geom_pose, pose, shape};
use crate::support::check;
use crate::{RapierError, RapierSets};
use mjcf_sim_model::math::*;
use mjcf_sim_model::model::{EqualityKind, JointType, Model};
use mjcf_sim_physics::dynamics::mul_m;
use mjcf_sim_physics::state::State;
use mjcf_sim_physics::topology::Topology;

/// A free joint of the model.
#[derive(Clone, Copy, Debug)]
pub(super) struct FreeJoint {
    /// Its body.
    pub body: usize,
    /// Its first degree of freedom.
    pub dof: usize,
}

/// A tree of the model.
#[derive(Clone, Debug)]
pub(super) struct Tree {
    /// Rigid body of the root link: a free one, or a fixed one at the origin of the world.
    pub root: RigidBodyHandle,
    /// The free joint, if there is one.
    pub free: Option<FreeJoint>,
    /// Whether it is a multibody.
    pub articulated: bool,
}

/// A hinge of the model: a link whose joint turns about its x axis.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub joint: usize,
    pub dof: usize,
    pub handle: RigidBodyHandle,
    pub parent: RigidBodyHandle,
    /// Frame of the joint in the parent link at the reference configuration.
    frame: Pose,
}

/// A weld of the model, as an impulse joint with a motor on each axis.
#[derive(Clone, Debug)]
pub(super) struct WeldJoint {
    pub equality: usize,
    pub handle: ImpulseJointHandle,
}

/// The bodies, joints and colliders of a model in a Rapier world, and the mapping between them and a [`State`].
#[derive(Clone, Debug)]
pub struct RapierBodies {
    /// Rigid body of each body of the model; bodies that do not move share one.
    body: Vec<RigidBodyHandle>,
    /// Frame of the rigid body in the model's body: its principal axes, see [`inertial`].
    frame: Vec<Pose>,
    /// Bodies of the model that move.
    moving: Vec<usize>,
    collider: Vec<ColliderHandle>,
    /// Geom of a collider, by the index of its handle.
    geom: Vec<Option<(ColliderHandle, usize)>>,
    pub(super) trees: Vec<Tree>,
    pub(super) links: Vec<Link>,
    pub(super) welds: Vec<WeldJoint>,
}

/// Returns the rotation that takes the x axis to a unit vector.
fn x_to(axis: Vec3) -> Quat {
    let w = 1.0 + axis[0];
    if w < 1e-6 {
        [0.0, 0.0, 0.0, 1.0]
    } else {
        quat_normalize([w, 0.0, -axis[2], axis[1]])
    }
}

fn vector(v: Vec3) -> Vector {
    Vector::new(v[0], v[1], v[2])
}

fn dynamic(body: usize) -> RigidBodyBuilder {
    let mut builder = RigidBodyBuilder::dynamic()
        .can_sleep(false)
        .gravity_scale(0.0)
        .user_data(body as u128);
    builder.gyroscopic_forces_enabled = false;
    builder.allow_fast_rotation = true;
    builder
}

/// Creates the joint of a hinge: everything is locked except the rotation about x.
fn hinge(frame1: Pose, frame2: Pose) -> GenericJoint {
    GenericJoint {
        local_frame1: frame1,
        local_frame2: frame2,
        locked_axes: JointAxesMask::LIN_AXES | JointAxesMask::ANG_Y | JointAxesMask::ANG_Z,
        ..GenericJoint::default()
    }
}

impl RapierBodies {
    /// Inserts bodies, joints and colliders of `model`, whose gravity and forces the rig applies itself.
    ///
    /// # Errors
    /// Fails if the model has elements that Rapier's multibodies cannot represent.
    pub fn insert(model: &Model, topology: &Topology, sets: &mut RapierSets) -> Result<Self, RapierError> {
        check(model, topology)?;
        let nb = model.nbody();
        let ground = sets.bodies.insert(RigidBodyBuilder::fixed());
        let mut rig = Self {
            body: vec![ground; nb],
            frame: vec![Pose::IDENTITY; nb],
            moving: (1..nb).filter(|&b| model.body_weldid[b] != 0).collect(),
            collider: vec![ColliderHandle::invalid(); model.ngeom()],
            geom: Vec::new(),
            trees: Vec::new(),
            links: Vec::new(),
            welds: Vec::new(),
        };
        for b in 1..nb {
            if model.body_weldid[b] == 0 {
                // from the world to the body
                let up = rig.frame[model.body_parentid[b]].inverse();
                rig.frame[b] = (up * pose(model.body_pos[b], model.body_quat[b])).inverse();
                continue;
            }
            let (frame, moments) = inertial(model, b);
            let axes = Rotation::IDENTITY;
            let mass = MassProperties::with_principal_inertia_frame(Vector::ZERO, model.body_mass[b], moments, axes);
            rig.frame[b] = frame;
            rig.body[b] = sets.bodies.insert(dynamic(b).additional_mass_properties(mass));
            rig.connect(model, b, sets)?;
        }
        rig.settle(model, sets);
        rig.insert_colliders(model, sets);
        for e in 0..model.neq() {
            if let EqualityKind::Connect { .. } = model.eq_kind[e] {
                let what = "connections of two points are not translated";
                return Err(RapierError::unsupported("equality", &model.eq_name[e], what));
            }
            if let EqualityKind::Weld { body1, body2, .. } = model.eq_kind[e] {
                let (b1, b2) = (rig.body[body1], rig.body[body2]);
                if b1 != b2 {
                    let handle = sets.impulse_joints.insert(b2, b1, GenericJoint::default(), true);
                    rig.welds.push(WeldJoint { equality: e, handle });
                }
            }
        }
        Ok(rig)
    }

    /// Creates the joints of a body: a root for a free joint, a chain of links for hinges, all but the last without mass,
    /// and a rigid link for none.
    fn connect(&mut self, model: &Model, b: usize, sets: &mut RapierSets) -> Result<(), RapierError> {
        let joints = model.body_jntadr[b]..model.body_jntadr[b] + model.body_jntnum[b];
        if joints.clone().any(|j| model.jnt_type[j] == JointType::Free) {
            self.trees.push(Tree {
                root: self.body[b],
                free: Some(FreeJoint {
                    body: b,
                    dof: model.body_dofadr[b],
                }),
                articulated: false,
            });
            return Ok(());
        }
        let up = model.body_parentid[b];
        let mut parent = self.body[up];
        if model.body_weldid[up] == 0 {
            parent = sets.bodies.insert(RigidBodyBuilder::fixed());
            self.trees.push(Tree {
                root: parent,
                free: None,
                articulated: true,
            });
        }
        // from the frame of the parent link to the body at the reference configuration
        let mut reach = self.frame[up].inverse() * pose(model.body_pos[b], model.body_quat[b]);
        let own = self.frame[b].inverse();
        if joints.is_empty() {
            let joint = GenericJoint {
                locked_axes: JointAxesMask::all(),
                ..hinge(reach, own)
            };
            return link(sets, parent, self.body[b], joint)
                .ok_or_else(|| RapierError::unsupported("body", &model.body_name[b], "Rapier rejects its link"));
        }
        let last = joints.end - 1;
        for j in joints {
            let local = pose(model.jnt_pos[j], x_to(model.jnt_axis[j]));
            let frame = reach * local;
            let (handle, end) = if j == last {
                (self.body[b], own * local)
            } else {
                (sets.bodies.insert(dynamic(b)), local)
            };
            link(sets, parent, handle, hinge(frame, end))
                .ok_or_else(|| RapierError::unsupported("joint", &model.jnt_name[j], "Rapier rejects its link"))?;
            self.links.push(Link {
                joint: j,
                dof: model.jnt_dofadr[j],
                handle,
                parent,
                frame,
            });
            (parent, reach) = (handle, Pose::IDENTITY);
        }
        Ok(())
    }

    /// Sets the final degrees of freedom of each multibody, the armature of the model and no damping.
    fn settle(&mut self, model: &Model, sets: &mut RapierSets) {
        for tree in &mut self.trees {
            let Some(link) = sets.multibody_joints.rigid_body_link(tree.root).copied() else {
                continue;
            };
            if let Some(multibody) = sets.multibody_joints.get_multibody_mut(link.multibody) {
                tree.articulated = true;
                multibody.forward_kinematics(sets.bodies, true);
                multibody.damping_mut().fill(0.0);
            }
        }
        for link in &self.links {
            if let Some((multibody, at)) = multibody_of(sets, link.handle) {
                multibody.armature_mut()[at] = model.dof_armature[link.dof];
            }
        }
    }

    fn insert_colliders(&mut self, model: &Model, sets: &mut RapierSets) {
        for g in collider_order(model) {
            let b = model.geom_bodyid[g];
            let collider = ColliderBuilder::new(shape(model, g, model.geom_size[g]))
                .position(self.frame[b].inverse() * geom_pose(model, g))
                .density(0.0)
                .user_data(g as u128)
                .active_collision_types(ActiveCollisionTypes::default())
                .active_hooks(ActiveHooks::FILTER_CONTACT_PAIRS | ActiveHooks::MODIFY_SOLVER_CONTACTS);
            let handle = sets.colliders.insert_with_parent(collider, self.body[b], sets.bodies);
            self.collider[g] = handle;
            let index = handle.into_raw_parts().0 as usize;
            if self.geom.len() <= index {
                self.geom.resize(index + 1, None);
            }
            self.geom[index] = Some((handle, g));
        }
    }

    /// Returns the pose of a body's Rapier body.
    pub(super) fn pose(&self, s: &State, body: usize) -> Pose {
        pose(s.xpos[body], s.xquat[body]) * self.frame[body]
    }

    /// Returns Rapier's body of a body of the model; bodies that do not move share one. Its axes are the principal axes
    /// of inertia.
    pub fn body_handle(&self, body: usize) -> Option<RigidBodyHandle> {
        self.body.get(body).copied()
    }

    /// Returns Rapier's collider of a geom.
    pub fn collider_handle(&self, geom: usize) -> Option<ColliderHandle> {
        self.collider.get(geom).copied()
    }

    /// Returns the geom of a collider, if it is one of the model's.
    pub fn geom_of(&self, collider: ColliderHandle) -> Option<usize> {
        let (handle, geom) = (*self.geom.get(collider.into_raw_parts().0 as usize)?)?;
        (handle == collider).then_some(geom)
    }

    /// Passes positions, velocities and all forces except those of constraints to Rapier.
    ///
    /// Rapier treats Coriolis forces in a way of its own, from the velocities it is given. It is given none: they enter
    /// as the force that produces them within a time step, `M qvel / h`, beside `qfrc_smooth`, which has our Coriolis
    /// forces. `force` (nv) is working memory.
    pub(super) fn load(
        &self,
        model: &Model,
        topology: &Topology,
        s: &State,
        sets: &mut RapierSets,
        force: &mut Vec<f64>,
    ) {
        force.resize(model.nv, 0.0);
        mul_m(topology, &s.qm, &s.qvel, force);
        for (f, smooth) in force.iter_mut().zip(&s.qfrc_smooth) {
            *f = *f / model.opt.timestep + smooth;
        }
        for &b in &self.moving {
            if let Some(body) = sets.bodies.get_mut(self.body[b]) {
                body.set_position(self.pose(s, b), false);
                body.set_linvel(Vector::ZERO, false);
                body.set_angvel(Vector::ZERO, false);
            }
        }
        for link in &self.links {
            for handle in [link.handle, link.parent] {
                if let Some(body) = sets.bodies.get_mut(handle) {
                    body.reset_torques(false);
                }
            }
        }
        for tree in &self.trees {
            self.load_root(model, s, tree, sets, force);
        }
        for link in &self.links {
            let torque = vector(scale(s.xaxis[link.joint], force[link.dof]));
            if let Some(body) = sets.bodies.get_mut(link.handle) {
                body.add_torque(torque, false);
            }
            if let Some(body) = sets.bodies.get_mut(link.parent) {
                body.add_torque(-torque, false);
            }
            let q = model.jnt_qposadr[link.joint];
            let [w, x, y, z] = axis_angle_to_quat([1.0, 0.0, 0.0], s.qpos[q] - model.qpos0[q]);
            let rotation = Rotation::from_xyzw(x, y, z, w);
            if let Some(id) = sets.multibody_joints.rigid_body_link(link.handle).copied()
                && let Some(multibody) = sets.multibody_joints.get_multibody_mut(id.multibody)
                && let Some(l) = multibody.link_mut(id.id)
            {
                // the coordinate stays at 0, so that no trigonometry of Rapier's takes part
                let coordinate = l.joint.coords()[3];
                if coordinate != 0.0 {
                    l.joint.apply_displacement(&[-coordinate]);
                }
                l.joint.data.local_frame1 = link.frame * Pose::from_rotation(rotation);
            }
        }
    }

    fn load_root(&self, model: &Model, s: &State, tree: &Tree, sets: &mut RapierSets, force: &[f64]) {
        if tree.articulated
            && let Some(id) = sets.multibody_joints.rigid_body_link(tree.root).copied()
            && let Some(multibody) = sets.multibody_joints.get_multibody_mut(id.multibody)
        {
            multibody.generalized_velocity_mut().fill(0.0);
        }
        let Some(FreeJoint { body: b, dof: d }) = tree.free else {
            return;
        };
        let f = [force[d], force[d + 1], force[d + 2]];
        let torque = mat_vec(&s.xmat[b], [force[d + 3], force[d + 4], force[d + 5]]);
        // about the centre of mass instead of the origin of the body
        let about_com = sub(torque, cross(mat_vec(&s.xmat[b], model.body_ipos[b]), f));
        if let Some(body) = sets.bodies.get_mut(tree.root) {
            body.reset_forces(false);
            body.reset_torques(false);
            body.add_force(vector(f), false);
            body.add_torque(vector(about_com), false);
        }
    }

    /// Reads the velocities (nv) after Rapier's step, in the frames at its start.
    pub(super) fn velocities(&self, model: &Model, s: &State, sets: &RapierSets, out: &mut [f64]) {
        for tree in &self.trees {
            let Some(FreeJoint { body: b, dof: d }) = tree.free else {
                continue;
            };
            let (mut linear, mut angular) = ([0.0; 3], [0.0; 3]);
            if tree.articulated {
                // Rapier updates the velocities of the links' bodies only at the start of a step
                if let Some(id) = sets.multibody_joints.rigid_body_link(tree.root)
                    && let Some(multibody) = sets.multibody_joints.get_multibody(id.multibody)
                {
                    let v = multibody.generalized_velocity();
                    (linear, angular) = ([v[0], v[1], v[2]], [v[3], v[4], v[5]]);
                }
            } else if let Some(body) = sets.bodies.get(tree.root) {
                let (v, w) = (body.linvel(), body.angvel());
                (linear, angular) = ([v.x, v.y, v.z], [w.x, w.y, w.z]);
            }
            let at_origin = sub(linear, cross(angular, mat_vec(&s.xmat[b], model.body_ipos[b])));
            out[d..d + 3].copy_from_slice(&at_origin);
            out[d + 3..d + 6].copy_from_slice(&mat_t_vec(&s.xmat[b], angular));
        }
        for link in &self.links {
            if let Some(id) = sets.multibody_joints.rigid_body_link(link.handle)
                && let Some(multibody) = sets.multibody_joints.get_multibody(id.multibody)
                && let Some(l) = multibody.link(id.id)
            {
                out[link.dof] = multibody.generalized_velocity()[l.assembly_id()];
            }
        }
    }
}

/// Returns the multibody of a link and the index of its degree of freedom.
pub(super) fn multibody_of<'a>(
    sets: &'a mut RapierSets,
    handle: RigidBodyHandle,
) -> Option<(&'a mut Multibody, usize)> {
    let id = *sets.multibody_joints.rigid_body_link(handle)?;
    let multibody = sets.multibody_joints.get_multibody_mut(id.multibody)?;
    let at = multibody.link(id.id)?.assembly_id();
    Some((multibody, at))
}

fn link(sets: &mut RapierSets, parent: RigidBodyHandle, child: RigidBodyHandle, joint: GenericJoint) -> Option<()> {
    sets.multibody_joints.insert(parent, child, joint, true).map(|_| ())
}

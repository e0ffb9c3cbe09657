//! Constants of a model that need its dynamics at `qpos0`.

use std::ops::Range;

use super::kinematics::local_to_global;
use super::springs::{bias, slack, springs};
use super::stages::{com_pos, crb, kinematics, solve, update};
use super::transmission::{dense_moment, length, transmissions};
use super::{Articulated, CompositeInertia, flexes, tendons};
use crate::MAXVAL;
use crate::body_simple::slides_alone;
use crate::math::*;
use crate::model::{
    Arrays, CameraPose, Constants, EqualityKind, GeomType, JointType, Light, LightPose, SameFrame, Statistic, WeldPose,
};
use crate::spatial::{angular, velocity_at};
use crate::state::State;
use crate::topology::Topology;

/// Computes inverse weights, the diagonal of the inertia, the statistics that are not given (zero), and the poses of welds without a given one
/// (MuJoCo's `mj_setConst`).
#[doc(alias = "mj_setConst")]
pub fn constants(model: &Arrays) -> Constants {
    let topology = Topology::new(model);
    let mut s = State::new(model, &topology);
    kinematics(model, &mut s);
    com_pos(model, &mut s);
    flexes(model, &topology, &mut s, true);
    tendons(model, &topology, &mut s);
    transmissions(model, &topology, &mut s);
    let mut composite = CompositeInertia::default();
    crb(model, &topology, &mut s, &mut composite);
    let diagonal = (0..model.nv).map(|d| topology.row(&s.qm, d).last().map_or(0.0, |(_, v)| v));
    let dof_m0: Vec<f64> = diagonal.collect();
    let mut weights = InverseWeights::new(model, &topology, &s, &composite);
    let dof_invweight0 = weights.dofs();
    let (jnt_stiffness, dof_damping) = springs(model, &dof_invweight0);
    Constants {
        body_invweight0: (0..model.nbody()).map(|b| weights.body(b)).collect(),
        dof_invweight0,
        jnt_stiffness,
        dof_damping,
        flexedges: flexedges(model, &mut weights),
        tendon_length0: s.ten_length.clone(),
        tendon_lengthspring: slack(model, &topology),
        tendon_invweight0: (0..model.ntendon()).map(|t| weights.tendon(t)).collect(),
        actuator_acc0: (0..model.nu()).map(|i| weights.actuator(i)).collect(),
        actuator_length0: (0..model.nu())
            .map(|i| length(model, &topology, &s, i, model.actuator_gear[i]))
            .collect(),
        actuator_biasprm: (0..model.nu())
            .map(|i| bias(model, &topology, &s, i, &dof_m0))
            .collect(),
        stat: statistics(model, &s, &dof_m0),
        weld_poses: weld_poses(model, &s),
        connect_anchors: connect_anchors(model, &s),
        camera_poses: camera_poses(model, &s),
        light_poses: light_poses(model, &s),
        dof_m0,
    }
}

/// Computes the relative poses at `qpos0` of the welds that keep them.
///
/// The position is that of body 2's anchor, in the frame of body 1.
fn weld_poses(model: &Arrays, s: &State) -> Vec<WeldPose> {
    let mut poses = Vec::new();
    for (equality, kind) in model.eq_kind.iter().enumerate() {
        if let &EqualityKind::Weld {
            body1,
            body2,
            anchor,
            relquat: [0.0, 0.0, 0.0, 0.0],
            sites: None,
            ..
        } = kind
        {
            let point = add(mat_vec(&s.xmat[body2], anchor), s.xpos[body2]);
            poses.push(WeldPose {
                equality,
                relpos: mat_t_vec(&s.xmat[body1], sub(point, s.xpos[body1])),
                relquat: quat_mul(quat_conj(s.xquat[body1]), s.xquat[body2]),
            });
        }
    }
    poses
}

/// Computes the positions of the points of connections in their second bodies at `qpos0`.
fn connect_anchors(model: &Arrays, s: &State) -> Vec<(usize, Vec3)> {
    let kinds = model.eq_kind.iter().enumerate();
    let connections = kinds.filter_map(|(equality, kind)| match *kind {
        EqualityKind::Connect {
            body1,
            body2,
            anchor1,
            sites: None,
            ..
        } => {
            let point = add(mat_vec(&s.xmat[body1], anchor1), s.xpos[body1]);
            Some((equality, mat_t_vec(&s.xmat[body2], sub(point, s.xpos[body2]))))
        }
        _ => None,
    });
    connections.collect()
}

/// Largest accepted product of a degree of freedom's inverse weight and inertia. The product is 1 if the others do not move, and grows with the
/// condition of the inertia. Beyond this limit it consists of rounding errors.
pub const MAX_WEIGHT: f64 = 1e13;

/// Computes inverse weights: the mean acceleration per unit force at `qpos0`, that is, the diagonal of `J M^-1 J'`, averaged
/// over the three directions of translation and of rotation. The solver scales constraints by it.
struct InverseWeights<'a> {
    model: &'a Arrays,
    topology: &'a Topology,
    s: &'a State,
    bodies: Articulated,
    /// Bodies of each tree: the first one and all below it.
    tree_bodies: Vec<Range<usize>>,
    b: Vec<f64>,
    x: Vec<f64>,
}

impl<'a> InverseWeights<'a> {
    fn new(model: &'a Arrays, topology: &'a Topology, s: &'a State, composite: &CompositeInertia) -> Self {
        let mut bodies = Articulated::new(model);
        update(&mut bodies, model, s, composite);
        let first = |tree: usize| model.jnt_bodyid[model.dof_jntid[topology.tree_adr[tree]]];
        let below = |b: usize| (b + 1..model.nbody()).find(|&c| model.body_parentid[c] < b);
        let range = |b: usize| b..below(b).unwrap_or(model.nbody());
        Self {
            model,
            topology,
            s,
            bodies,
            tree_bodies: (0..topology.ntree()).map(|tree| range(first(tree))).collect(),
            b: vec![0.0; model.nv],
            x: vec![0.0; model.nv],
        }
    }

    /// Computes the acceleration along a row of a Jacobian, given by its nonzero entries, per unit force along it.
    fn of(&mut self, jac: &[(usize, f64)]) -> f64 {
        for &(d, v) in jac {
            self.b[d] += v;
        }
        // trees do not feel each other
        let mut trees: Vec<usize> = jac.iter().map(|&(d, _)| self.topology.dof_tree[d]).collect();
        trees.dedup();
        for tree in trees {
            let bodies = self.tree_bodies[tree].clone();
            self.bodies.solve_trees(self.s, bodies, &self.b, &mut self.x);
        }
        jac.iter().for_each(|&(d, _)| self.b[d] = 0.0);
        jac.iter().map(|&(d, v)| v * self.x[d]).sum()
    }

    fn dofs(&mut self) -> Vec<f64> {
        let mut weights = vec![0.0; self.model.nv];
        for j in 0..self.model.njnt() {
            let d = self.model.jnt_dofadr[j];
            match self.model.jnt_type[j] {
                JointType::Free => {
                    let w: [f64; 6] = std::array::from_fn(|k| self.of(&[(d + k, 1.0)]));
                    weights[d..d + 3].fill((w[0] + w[1] + w[2]) / 3.0);
                    weights[d + 3..d + 6].fill((w[3] + w[4] + w[5]) / 3.0);
                }
                JointType::Ball => {
                    let w: [f64; 3] = std::array::from_fn(|k| self.of(&[(d + k, 1.0)]));
                    weights[d..d + 3].fill((w[0] + w[1] + w[2]) / 3.0);
                }
                _ => {
                    let (own, body) = (self.of(&[(d, 1.0)]), self.model.jnt_bodyid[j]);
                    // MuJoCo's does not depend on the armature; slides along one axis keep the result of a singular inertia
                    let sound = own > 0.0 && own * self.model.body_mass[body] < MAX_WEIGHT;
                    weights[d] = if sound && slides_alone(self.model, body) {
                        1.0 / self.model.body_mass[body]
                    } else {
                        own
                    };
                }
            }
        }
        weights
    }

    /// Computes the inverse weights of a body at its centre of mass, in translation and rotation.
    fn body(&mut self, b: usize) -> [f64; 2] {
        let (model, s) = (self.model, self.s);
        if model.body_weldid[b] == 0 {
            return [0.0; 2];
        }
        if slides_alone(model, b) {
            return [1.0 / model.body_mass[b], 0.0];
        }
        let offset = sub(s.xipos[b], s.subtree_com[model.body_rootid[b]]);
        let mut sums = [0.0; 2];
        for k in 0..6 {
            let entry = |&d: &u32| {
                let cdof = &s.cdof[d as usize];
                let v = if k < 3 {
                    velocity_at(cdof, offset)[k]
                } else {
                    angular(cdof)[k - 3]
                };
                (d as usize, v)
            };
            let jac: Vec<(usize, f64)> = self.topology.body_chain(b).iter().map(entry).collect();
            sums[k / 3] += self.of(&jac);
        }
        sums.map(|sum| sum / 3.0)
    }

    /// Computes the norm of the acceleration per unit of an actuator's force.
    fn actuator(&mut self, i: usize) -> f64 {
        dense_moment(self.model, self.topology, self.s, i, &mut self.b);
        solve(&mut self.bodies, self.s, &self.b, &mut self.x);
        self.b.fill(0.0);
        self.x.iter().map(|a| a * a).sum::<f64>().sqrt()
    }

    fn edge(&mut self, e: usize) -> f64 {
        let rows = &self.topology.flexedges;
        let entries = rows.row(e).iter().zip(&self.s.flexedge_j[rows.range(e)]);
        let jac: Vec<(usize, f64)> = entries.map(|(&d, &arm)| (d as usize, arm)).collect();
        self.of(&jac)
    }

    fn tendon(&mut self, t: usize) -> f64 {
        let rows = &self.topology.tendons;
        let entries = rows.row(t).iter().zip(&self.s.ten_j[rows.range(t)]);
        let jac: Vec<(usize, f64)> = entries.map(|(&d, &arm)| (d as usize, arm)).collect();
        self.of(&jac)
    }
}

/// Returns the length and the inverse weight of each edge of all flexes.
fn flexedges(model: &Arrays, weights: &mut InverseWeights) -> Vec<[f64; 2]> {
    let mut edges = Vec::with_capacity(model.nflexedge());
    for flex in &model.flexes {
        for (&rigid, ends) in flex.edge_rigid.iter().zip(&flex.edge) {
            let [a, b] = ends.map(|v| flex.vertbodyid[v]);
            let weight = if rigid {
                0.0
            } else if slides_alone(model, a) && slides_alone(model, b) {
                (1.0 / model.body_mass[a] + 1.0 / model.body_mass[b]) / 2.0
            } else {
                weights.edge(edges.len())
            };
            edges.push([weights.s.flexedge_length[edges.len()], weight]);
        }
    }
    edges
}

/// Returns the poses at `qpos0` of cameras that do not turn with their body.
fn camera_poses(model: &Arrays, s: &State) -> Vec<CameraPose> {
    let pose = |c: usize| {
        let b = model.cam_bodyid[c];
        let (pos, mat0) = local_to_global(s, b, model.cam_pos[c], model.cam_quat[c], SameFrame::None);
        CameraPose {
            pos0: sub(pos, s.xpos[b]),
            poscom0: sub(pos, s.subtree_com[model.cam_targetbodyid[c].unwrap_or(b)]),
            mat0,
        }
    };
    (0..model.ncam()).map(pose).collect()
}

/// Returns the poses at `qpos0` of lights that do not turn with their body.
fn light_poses(model: &Arrays, s: &State) -> Vec<LightPose> {
    let pose = |light: &Light| {
        let b = light.bodyid;
        let pos = add(mat_vec(&s.xmat[b], light.pos), s.xpos[b]);
        LightPose {
            pos0: sub(pos, s.xpos[b]),
            // MuJoCo measures from the target if there is one.
            poscom0: sub(pos, s.subtree_com[light.targetbodyid.unwrap_or(b)]),
            dir0: unit(quat_rotate(s.xquat[b], light.dir)).0,
        }
    };
    model.lights.iter().map(pose).collect()
}

/// Returns mean inertia, mass and size, extent and centre: as given, or else computed.
///
/// `dof_m0` is the diagonal of the inertia.
fn statistics(model: &Arrays, s: &State, dof_m0: &[f64]) -> Statistic {
    let meaninertia = match model.nv {
        0 => 1.0,
        nv => dof_m0.iter().sum::<f64>() / nv as f64,
    };
    let others = model.nbody().saturating_sub(1).max(1) as f64;
    let meanmass = match model.nbody() {
        1 => 1.0,
        _ => model.body_mass[1..].iter().sum::<f64>() / others,
    };
    let meansize = match model.nbody() {
        1 => 0.2,
        _ => sizes(model, s)[1..].iter().map(|v| v.max(1e-5)).sum::<f64>() / others,
    };
    let (low, high) = bounds(model, s);
    // MuJoCo's own extent stays if no two things are next to each other along x
    let extent = if high[0] > low[0] {
        (0..3).map(|k| high[k] - low[k]).fold(1e-5, f64::max)
    } else {
        2.0
    };

    let mut stat = model.stat.clone();
    let set = |field: &mut f64, value: f64| {
        if *field == 0.0 {
            *field = value;
        }
    };
    set(&mut stat.meaninertia, meaninertia);
    set(&mut stat.meanmass, meanmass);
    set(&mut stat.meansize, meansize);
    if stat.center[0].is_nan() {
        stat.center = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
    }
    if stat.extent == 0.0 {
        stat.extent = extent.max(2.0 * meansize);
    }
    stat
}

/// Returns the lowest and highest coordinates of all elements with their bounding spheres.
fn bounds(model: &Arrays, s: &State) -> (Vec3, Vec3) {
    let (mut low, mut high) = ([MAXVAL; 3], [-MAXVAL; 3]);
    let mut include = |p: Vec3, r: f64| {
        for k in 0..3 {
            low[k] = low[k].min(p[k] - r);
            high[k] = high[k].max(p[k] + r);
        }
    };
    for b in 1..model.nbody() {
        include(s.xpos[b], 0.0);
        include(s.xipos[b], 0.0);
    }
    s.xanchor.iter().for_each(|&p| include(p, 0.0));
    s.site_xpos.iter().for_each(|&p| include(p, 0.0));
    for g in 0..model.ngeom() {
        let size = model.geom_size[g];
        let radius = match model.geom_type[g] {
            GeomType::Plane if size[0] > 0.0 || size[1] > 0.0 => 0.1 * size[0].max(size[1]),
            GeomType::Plane => 1.0,
            _ => model.geom_rbound[g],
        };
        include(s.geom_xpos[g], radius);
    }
    if low[0] > high[0] {
        // an empty world
        return ([-1.0; 3], [1.0; 3]);
    }
    if (0..3).all(|k| high[k] - low[k] < MINVAL) {
        // a single point: MuJoCo gives it a cube of 2 m, as it does to nothing at all
        return (low.map(|v| v - 1.0), high.map(|v| v + 1.0));
    }
    (low, high)
}

/// Computes the size of each body: the reach of its joints, its children's joints and its geoms.
///
/// Distances are from the body's centre of mass.
fn sizes(model: &Arrays, s: &State) -> Vec<f64> {
    let mut size = vec![0.0_f64; model.nbody()];
    for j in 0..model.njnt() {
        let body = model.jnt_bodyid[j];
        for b in [body, model.body_parentid[body]] {
            size[b] = size[b].max(norm(sub(s.xipos[b], s.xanchor[j])));
        }
    }
    for g in 0..model.ngeom() {
        let b = model.geom_bodyid[g];
        if model.geom_rbound[g] > 0.0 {
            size[b] = size[b].max(model.geom_rbound[g] + norm(sub(s.xipos[b], s.geom_xpos[g])));
        }
    }
    for flex in &model.flexes {
        for (k, ends) in flex.edge.iter().enumerate() {
            for b in ends.map(|v| flex.vertbodyid[v]) {
                size[b] = size[b].max(s.flexedge_length[flex.edgeadr + k]);
            }
        }
    }
    size
}

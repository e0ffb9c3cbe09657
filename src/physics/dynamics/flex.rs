//! Flexes: positions of their vertices, lengths of their edges with derivatives and rates, and the forces of their springs and their
//! elasticity.

use crate::math::*;
use crate::model::{Arrays, Flex};
use crate::spatial::velocity_at;
use crate::state::State;
use crate::topology::Topology;

/// Computes `flexvert_xpos, flexedge_length, flexedge_j, flexedge_velocity` of all flexes. As in MuJoCo, edges of rigid flexes have a length only in
/// the `reference` configuration. Poses and `cdof` must be up to date.
#[doc(alias = "mj_flex")]
#[inline(never)]
pub fn flexes(model: &Arrays, topology: &Topology, s: &mut State, reference: bool) {
    for flex in &model.flexes {
        for (v, (&b, &vert)) in flex.vertbodyid.iter().zip(&flex.vert).enumerate() {
            s.flexvert_xpos[flex.vertadr + v] = if flex.centered {
                s.xpos[b]
            } else {
                add(mat_vec(&s.xmat[b], vert), s.xpos[b])
            };
        }
        if reference || !flex.rigid {
            edges(model, topology, flex, s);
        }
    }
}

fn edges(model: &Arrays, topology: &Topology, flex: &Flex, s: &mut State) {
    for (k, &[v1, v2]) in flex.edge.iter().enumerate() {
        let e = flex.edgeadr + k;
        let [p1, p2] = [v1, v2].map(|v| s.flexvert_xpos[flex.vertadr + v]);
        let (along, length) = unit(sub(p2, p1));
        s.flexedge_length[e] = length;
        let row = topology.flexedges.range(e);
        if row.is_empty() {
            continue;
        }
        let [b1, b2] = [v1, v2].map(|v| flex.vertbodyid[v]);
        let (first, _) = topology.apart(b1, b2);
        let com = |b: usize| s.subtree_com[model.body_rootid[b]];
        let (arm1, arm2) = (sub(p1, com(b1)), sub(p2, com(b2)));
        let mut velocity = 0.0;
        for (&d, entry) in topology.flexedges.row(e).iter().zip(&mut s.flexedge_j[row]) {
            let axis = &s.cdof[d as usize];
            *entry = if first.contains(&d) {
                -dot(velocity_at(axis, arm1), along)
            } else {
                dot(velocity_at(axis, arm2), along)
            };
            velocity += *entry * s.qvel[d as usize];
        }
        s.flexedge_velocity[e] = velocity;
    }
}

/// Adds the forces of the edges' springs and dampers, and of elasticity, to `qfrc_passive`. `force` is working memory.
#[inline(never)]
pub(super) fn flex_forces(model: &Arrays, topology: &Topology, s: &mut State, force: &mut Vec<Vec3>) {
    for flex in model.flexes.iter().filter(|flex| !flex.rigid) {
        // as in MuJoCo, which asks the first element
        if flex.stiffness.first().is_some_and(|metric| metric[0] != 0.0) && flex.dim > 1 {
            force.clear();
            force.resize(flex.vert.len(), [0.0; 3]);
            elasticity(flex, model.opt.timestep, s, force);
            for (v, &force) in force.iter().enumerate() {
                push(
                    model,
                    topology,
                    s,
                    flex.vertbodyid[v],
                    (force, s.flexvert_xpos[flex.vertadr + v]),
                );
            }
        }
    }
    for flex in model.flexes.iter().filter(|flex| !flex.rigid) {
        let (stiffness, damping) = (flex.edgestiffness, flex.edgedamping);
        if stiffness == 0.0 && damping == 0.0 {
            continue;
        }
        for (k, _) in flex.edge_rigid.iter().enumerate().filter(|(_, rigid)| !**rigid) {
            let e = flex.edgeadr + k;
            let spring = stiffness * (flex.edge_length0[k] - s.flexedge_length[e]);
            let force = spring - damping * s.flexedge_velocity[e];
            let row = topology.flexedges.range(e);
            for (&d, arm) in topology.flexedges.row(e).iter().zip(&s.flexedge_j[row]) {
                s.qfrc_passive[d as usize] += arm * force;
            }
        }
    }
}

/// Vertices of the edges of triangles and tetrahedra.
const TRIANGLE: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];
const TETRAHEDRON: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [2, 3], [0, 3], [1, 3]];

/// Adds the elastic forces on the vertices: the metric of each element times the changes of its squared edge lengths, with generalised
/// Rayleigh damping (Kharevych et al., "Geometric, Variational Integrators for Computer Animation", section 5.2).
fn elasticity(flex: &Flex, timestep: f64, s: &State, force: &mut [Vec3]) {
    let ends: &[[usize; 2]] = if flex.dim == 2 { &TRIANGLE } else { &TETRAHEDRON };
    let (count, places) = (ends.len(), &s.flexvert_xpos[flex.vertadr..]);
    let damping = flex.damping / timestep;
    for (t, metric) in flex.stiffness.iter().enumerate() {
        let vertices = flex.element(t);
        let mut elongation = [0.0; 6];
        for (&k, elongation) in flex.elemedge[t * count..(t + 1) * count].iter().zip(&mut elongation) {
            let (length, velocity) = (
                s.flexedge_length[flex.edgeadr + k],
                s.flexedge_velocity[flex.edgeadr + k],
            );
            let (rest, before) = (flex.edge_length0[k], length - velocity * timestep);
            *elongation = length * length - rest * rest + (length * length - before * before) * damping;
        }
        // the whole metric from its upper triangle
        let mut whole = [[0.0; 6]; 6];
        let mut upper = metric.iter();
        for i in 0..count {
            for (j, value) in (i..count).zip(&mut upper) {
                (whole[i][j], whole[j][i]) = (*value, *value);
            }
        }
        let mut own = [[0.0; 3]; 4];
        for i in 0..count {
            for (j, &[a, b]) in ends.iter().enumerate() {
                let along = sub(places[vertices[a]], places[vertices[b]]);
                for x in 0..3 {
                    own[a][x] -= elongation[i] * along[x] * whole[i][j];
                    own[b][x] -= elongation[i] * -along[x] * whole[i][j];
                }
            }
        }
        for (&v, own) in vertices.iter().zip(own) {
            force[v] = add(force[v], own);
        }
    }
}

/// Adds a force at a point of a body to `qfrc_passive`.
fn push(model: &Arrays, topology: &Topology, s: &mut State, body: usize, (force, point): (Vec3, Vec3)) {
    if topology.slides_alone[body] {
        // as in MuJoCo, whose vertices have slides along x, y and z: a lone slide, whatever its axis, gets the force along x
        let dofs = model.body_dofadr[body]..model.body_dofadr[body] + model.body_dofnum[body];
        for (d, along) in dofs.zip(force) {
            s.qfrc_passive[d] += along;
        }
        return;
    }
    let arm = sub(point, s.subtree_com[model.body_rootid[body]]);
    for &d in topology.body_chain(body) {
        s.qfrc_passive[d as usize] += dot(velocity_at(&s.cdof[d as usize], arm), force);
    }
}

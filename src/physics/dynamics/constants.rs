//! Constants of a model that need its dynamics at `qpos0`: inverse weights and statistics.

use crate::math::*;
use crate::model::{GeomType, JointType, Model, SameFrame};
use crate::physics::dynamics::{Articulated, Damping, com_pos, crb, kinematics};
use crate::physics::spatial::{angular, velocity_at};
use crate::physics::state::State;
use crate::physics::topology::Topology;

/// Fills `body_invweight0, dof_invweight0, tendon_invweight0` and the statistics that are not given (zero).
///
/// An inverse weight is the mean acceleration per unit force at `qpos0`: the diagonal of `J M^-1 J'`, averaged over the
/// three directions of translation and of rotation. The solver scales constraints by it.
pub fn set_const(model: &mut Model) {
    let topology = Topology::new(model);
    let mut s = State::new(model, &topology);
    kinematics(model, &mut s);
    com_pos(model, &mut s);
    crb(model, &topology, &mut s);
    let mut bodies = Articulated::default();
    bodies.update(model, &s);
    statistics(model, &s, &topology);

    let nv = model.nv;
    let (mut b, mut x) = (vec![0.0; nv], vec![0.0; nv]);
    let mut weight = |model: &Model, jac: &[(usize, f64)]| -> f64 {
        b.fill(0.0);
        for &(d, v) in jac {
            b[d] += v;
        }
        bodies.solve(model, &s, Damping::Without, &b, &mut x);
        jac.iter().map(|&(d, v)| v * x[d]).sum()
    };
    for j in 0..model.njnt() {
        let d = model.jnt_dofadr[j];
        match model.jnt_type[j] {
            JointType::Free => {
                let w: [f64; 6] = std::array::from_fn(|k| weight(model, &[(d + k, 1.0)]));
                let (t, r) = ((w[0] + w[1] + w[2]) / 3.0, (w[3] + w[4] + w[5]) / 3.0);
                model.dof_invweight0[d..d + 3].fill(t);
                model.dof_invweight0[d + 3..d + 6].fill(r);
            }
            _ => model.dof_invweight0[d] = weight(model, &[(d, 1.0)]),
        }
    }
    for b in 1..model.nbody() {
        if model.body_weldid[b] == 0 {
            model.body_invweight0[b] = [0.0; 2];
            continue;
        }
        let offset = sub(s.xipos[b], s.subtree_com[model.body_rootid[b]]);
        let mut sums = [0.0; 2];
        for k in 0..6 {
            let jac: Vec<(usize, f64)> = topology
                .body_chain(b)
                .iter()
                .map(|&d| {
                    let cdof = &s.cdof[d as usize];
                    let v = if k < 3 {
                        velocity_at(cdof, offset)[k]
                    } else {
                        angular(cdof)[k - 3]
                    };
                    (d as usize, v)
                })
                .collect();
            sums[k / 3] += weight(model, &jac);
        }
        if slides_alone(model, b) {
            model.body_invweight0[b] = [1.0 / model.body_mass[b], 0.0];
            continue;
        }
        model.body_invweight0[b] = [sums[0] / 3.0, sums[1] / 3.0];
    }
    for t in 0..model.ntendon() {
        let jac: Vec<(usize, f64)> = model.tendon_wrap[t]
            .iter()
            .map(|&(j, c)| (model.jnt_dofadr[j], c))
            .collect();
        model.tendon_invweight0[t] = weight(model, &jac);
    }
}

/// Whether MuJoCo gives a body its whole inverse mass, not the mean over directions: a child of the world without children
/// whose joints all slide along axes of its frame, which is that of its inertia.
fn slides_alone(model: &Model, b: usize) -> bool {
    let joints = model.body_jntadr[b]..model.body_jntadr[b] + model.body_jntnum[b];
    let along_axis = |j: usize| model.jnt_axis[j].iter().filter(|v| v.abs() > MINVAL).count() == 1;
    model.body_parentid[b] == 0
        && !model.body_parentid.contains(&b)
        && model.body_sameframe[b] == SameFrame::Body
        && !joints.is_empty()
        && joints
            .into_iter()
            .all(|j| model.jnt_type[j] == JointType::Slide && along_axis(j))
}

/// Mean inertia, mass and size, extent and centre, where they are not given.
fn statistics(model: &mut Model, s: &State, topology: &Topology) {
    let (nb, nv) = (model.nbody(), model.nv);
    let diagonal = (0..nv).map(|d| topology.row(&s.qm, d).last().map_or(0.0, |(_, v)| v));
    let meaninertia = if nv == 0 {
        1.0
    } else {
        diagonal.sum::<f64>() / nv as f64
    };
    let others = nb.saturating_sub(1).max(1) as f64;
    let meanmass = model.body_mass[1..].iter().sum::<f64>() / others;

    let (mut low, mut high) = ([1e10_f64; 3], [-1e10_f64; 3]);
    let mut include = |p: Vec3, r: f64| {
        for k in 0..3 {
            low[k] = low[k].min(p[k] - r);
            high[k] = high[k].max(p[k] + r);
        }
    };
    for b in 1..nb {
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
    let mut extent = (0..3).map(|k| high[k] - low[k]).fold(1e-5, f64::max);

    let mut size = vec![0.0_f64; nb];
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
    let meansize = size[1..].iter().map(|v| v.max(1e-5)).sum::<f64>() / others;
    extent = extent.max(2.0 * meansize);

    let stat = &mut model.stat;
    let set = |field: &mut f64, value: f64| {
        if *field == 0.0 {
            *field = value;
        }
    };
    set(&mut stat.meaninertia, meaninertia);
    set(&mut stat.meanmass, meanmass);
    set(&mut stat.meansize, meansize);
    if stat.extent == 0.0 {
        stat.center = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
        stat.extent = extent;
    }
}

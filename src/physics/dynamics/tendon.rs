//! Tendons: their lengths, the Jacobians of the lengths, and the points on spatial tendons.

use super::wrap::{WrapShape, wrap};
use crate::math::*;
use crate::model::{Arrays, Wrap};
use crate::spatial::{Spatial, angular, linear};
use crate::state::State;
use crate::topology::Topology;
use crate::topology::tendon_paths::{PathDof, SegmentKind, StraightSegment};

/// Computes lengths, Jacobians and rates of all tendons, and the points of spatial ones: `ten_length, ten_j, ten_velocity,
/// ten_wrapadr, ten_wrapnum, wrap_xpos, wrap_obj`. Poses and `cdof` must be up to date.
#[doc(alias = "mj_tendon")]
#[inline(always)]
pub fn tendons(model: &Arrays, topology: &Topology, s: &mut State) {
    let mut points = 0;
    for t in 0..model.ntendon() {
        s.ten_wrapadr[t] = points;
        if model.tendon_is_spatial(t) {
            spatial(topology, s, t, &mut points);
        } else {
            fixed(model, topology, s, t);
        }
        s.ten_wrapnum[t] = points - s.ten_wrapadr[t];
    }
}

/// Computes a fixed tendon.
#[inline(always)]
fn fixed(model: &Arrays, topology: &Topology, s: &mut State, t: usize) {
    let (mut length, mut velocity) = (0.0, 0.0);
    let (row, dofs) = (topology.tendons.range(t), topology.tendons.row(t));
    for along in &model.tendon_wrap[t] {
        if let Wrap::Joint { joint, coef } = *along {
            let d = model.jnt_dofadr[joint];
            length += coef * s.qpos[model.jnt_qposadr[joint]];
            velocity += coef * s.qvel[d];
            let place = dofs.partition_point(|&other| (other as usize) < d);
            s.ten_j[row.start + place] = coef;
        }
    }
    (s.ten_length[t], s.ten_velocity[t]) = (length, velocity);
}

/// Computes a spatial tendon; separate from the code that is compiled twice.
#[inline(never)]
fn spatial(topology: &Topology, s: &mut State, t: usize, points: &mut usize) {
    let paths = &topology.tendon_paths;
    let sites = &s.site_xpos[..];
    let mut passed = s.wrap_xpos[*points..].iter_mut().zip(&mut s.wrap_obj[*points..]);
    let mut pass = |point: Vec3, object: i32| {
        if let Some((xpos, obj)) = passed.next() {
            (*xpos, *obj) = (point, object);
            *points += 1;
        }
    };
    let row = &mut s.ten_j[topology.tendons.range(t)];
    row.fill(0.0);
    let (mut length, mut has_entries) = (0.0, false);
    for leg in paths.path(t) {
        let Some(stretch) = leg else {
            pass([0.0; 3], PULLEY);
            continue;
        };
        let [a, b] = [sites[stretch.sites[0]], sites[stretch.sites[1]]];
        let mut add = |span: &StraightSegment, a: Vec3, b: Vec3| {
            has_entries |= span.moves;
            let (direction, length) = unit(sub(b, a));
            let along = scale(direction, stretch.share);
            let [first, second] = paths.apart(span);
            add_end(row, &s.cdof, s.subtree_com[span.roots[0]], first, a, scale(along, -1.0));
            add_end(row, &s.cdof, s.subtree_com[span.roots[1]], second, b, along);
            length
        };
        pass(a, SITE);
        length += stretch.share
            * match &stretch.between {
                SegmentKind::Nothing => add(&stretch.straight, a, b),
                SegmentKind::Constant(length) => {
                    has_entries |= stretch.straight.moves;
                    *length
                }
                SegmentKind::Geom(obstacle) => {
                    let geom = obstacle.geom;
                    let round = WrapShape {
                        pos: s.geom_xpos[geom],
                        mat: &s.geom_xmat[geom],
                        radius: s.params.geom_size[geom][0],
                        cylinder: obstacle.cylinder,
                    };
                    match wrap([a, b], &round, obstacle.side.map(|site| sites[site])) {
                        None => add(&stretch.straight, a, b),
                        Some(wrapped) => {
                            let [on, off] = wrapped.points;
                            pass(on, geom as i32);
                            pass(off, geom as i32);
                            let [before, behind] = &obstacle.spans;
                            add(before, a, on) + wrapped.length + add(behind, off, b)
                        }
                    }
                }
            };
        if stretch.ends {
            pass(b, SITE);
        }
    }
    let dofs = topology.tendons.row(t);
    s.ten_velocity[t] = dofs.iter().zip(&*row).map(|(&d, v)| v * s.qvel[d as usize]).sum();
    (s.ten_length[t], s.ten_entries[t]) = (length, has_entries);
}

/// Marks in `wrap_obj` of a tendon's points that are not on a geom.
const SITE: i32 = -1;
const PULLEY: i32 = -2;

/// Below this, a velocity per unit velocity of a degree of freedom may be a rounding error, m/rad.
const AT_REST: f64 = 1e-12;

/// Adds the contribution of a point of a body, which `moved` moves, to the row of a tendon: the velocity of the point along a direction.
#[inline(always)]
fn add_end(row: &mut [f64], cdof: &[Spatial], com: Vec3, moved: &[PathDof], point: Vec3, along: Vec3) {
    // as a wrench about the centre of mass to which `cdof` refers
    let arm = sub(point, com);
    let turn = cross(arm, along);
    for &PathDof { dof, place } in moved {
        let axis = &cdof[dof as usize];
        let mut speed = dot(angular(axis), turn) + dot(linear(axis), along);
        if speed.abs() < AT_REST {
            // a point on the axis stays where it is, but the sum of its parts is a rounding error, against which a limit or dry friction would
            // push with all its might: as velocities they cancel to the last bit
            speed = dot(add(linear(axis), cross(angular(axis), arm)), along);
        }
        row[place as usize] += speed;
    }
}

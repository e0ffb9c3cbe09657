//! Tendons: their lengths, the Jacobians of these, and the points that spatial tendons pass.

use std::ops::Range;

use crate::math::*;
use crate::model::{Arrays, Wrap};
use crate::physics::dynamics::wrap::{Round, wrap};
use crate::physics::spatial::velocity_at;
use crate::physics::state::State;
use crate::physics::topology::Topology;

/// Computes lengths, Jacobians and rates of all tendons, and the points of spatial ones: `ten_length, ten_j, ten_velocity,
/// ten_wrapadr, ten_wrapnum, wrap_xpos, wrap_obj`. Poses and `cdof` must be up to date.
#[inline(always)]
pub fn tendons(model: &Arrays, topology: &Topology, s: &mut State) {
    let mut points = 0;
    for t in 0..model.ntendon() {
        s.ten_wrapadr[t] = points;
        if model.tendon_is_spatial(t) {
            spatial(model, topology, s, t, &mut points);
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

/// Geom, side site and whether it is a cylinder, of what a tendon may wrap around.
type Wrapped = (usize, Option<usize>, bool);

/// Returns the geom that a tendon may wrap around after a site, and how many entries of its path on the next site is; `None` where the
/// path ends at the site.
fn after_site(next: &Wrap) -> Option<(Option<Wrapped>, usize)> {
    match *next {
        Wrap::Pulley { .. } | Wrap::Joint { .. } => None,
        Wrap::Site { .. } => Some((None, 1)),
        Wrap::Sphere { geom, side } => Some((Some((geom, side, false)), 2)),
        Wrap::Cylinder { geom, side } => Some((Some((geom, side, true)), 2)),
    }
}

/// Computes a spatial tendon; kept out of the code that is compiled twice.
#[inline(never)]
fn spatial(model: &Arrays, topology: &Topology, s: &mut State, t: usize, points: &mut usize) {
    let row = topology.tendons.range(t);
    s.ten_j[row.clone()].fill(0.0);
    s.ten_entries[t] = false;
    let (path, mut length, mut divisor) = (&model.tendon_wrap[t], 0.0, 1.0);
    let mut pass = |s: &mut State, point: Vec3, object: i32| {
        (s.wrap_xpos[*points], s.wrap_obj[*points]) = (point, object);
        *points += 1;
    };
    let mut k = 0;
    while k + 1 < path.len() {
        if let Wrap::Pulley { divisor: next } = path[k] {
            divisor = next;
            pass(s, [0.0; 3], PULLEY);
        }
        let Wrap::Site { site: first } = path[k] else {
            k += 1;
            continue;
        };
        let Some((round, step)) = after_site(&path[k + 1]) else {
            k += 1;
            continue;
        };
        // the compiler put geoms between sites
        let Some(&Wrap::Site { site: second }) = path.get(k + step) else {
            break;
        };
        k += step;
        let ends = [first, second].map(|site| (model.site_bodyid[site], s.site_xpos[site]));
        let wrapped = round.and_then(|(geom, side, cylinder)| {
            let round = Round {
                pos: s.geom_xpos[geom],
                mat: s.geom_xmat[geom],
                radius: s.params.geom_size[geom][0],
                cylinder,
            };
            let side = side.map(|site| s.site_xpos[site]);
            wrap(ends.map(|end| end.1), &round, side).map(|wrapped| (geom, wrapped))
        });
        let add = |s: &mut State, a: (usize, Vec3), b: (usize, Vec3)| {
            add_segment(model, topology, s, (t, row.clone()), [a, b], 1.0 / divisor);
            norm(sub(b.1, a.1))
        };
        pass(s, ends[0].1, SITE);
        match wrapped {
            None => length += add(s, ends[0], ends[1]) / divisor,
            Some((geom, wrapped)) => {
                let [on, off] = wrapped.points.map(|point| (model.geom_bodyid[geom], point));
                pass(s, on.1, geom as i32);
                pass(s, off.1, geom as i32);
                length += (add(s, ends[0], on) + wrapped.length + add(s, off, ends[1])) / divisor;
            }
        }
        if !matches!(path.get(k + 1), Some(along) if !matches!(along, Wrap::Pulley { .. })) {
            pass(s, ends[1].1, SITE);
        }
    }
    s.ten_length[t] = length;
    s.ten_velocity[t] = rate(topology, s, t);
}

/// Returns the rate of the length of a tendon.
fn rate(topology: &Topology, s: &State, t: usize) -> f64 {
    let entries = topology.tendons.row(t).iter().zip(&s.ten_j[topology.tendons.range(t)]);
    entries.map(|(&d, v)| v * s.qvel[d as usize]).sum()
}

/// Marks in `wrap_obj` of a tendon's points that are not on a geom.
const SITE: i32 = -1;
const PULLEY: i32 = -2;

/// Adds the derivative of the distance of two points of bodies to the Jacobian of a tendon.
fn add_segment(
    model: &Arrays,
    topology: &Topology,
    s: &mut State,
    (t, row): (usize, Range<usize>),
    [(a, point_a), (b, point_b)]: [(usize, Vec3); 2],
    scale: f64,
) {
    if a == b {
        return;
    }
    s.ten_entries[t] |= [a, b].iter().any(|&body| !topology.body_chain(body).is_empty());
    let direction = unit(sub(point_b, point_a)).0;
    let (mut chain_a, mut chain_b) = topology.apart(a, b);
    let offset = |body: usize, point: Vec3| sub(point, s.subtree_com[model.body_rootid[body]]);
    let (offset_a, offset_b) = (offset(a, point_a), offset(b, point_b));
    let dofs = topology.tendons.row(t);
    let (cdof, entries) = (&s.cdof, &mut s.ten_j[row]);
    let mut place = 0;
    loop {
        let next = |chain: &[u32]| chain.first().copied().unwrap_or(u32::MAX);
        let (next_a, next_b) = (next(chain_a), next(chain_b));
        let d = next_a.min(next_b);
        if d == u32::MAX {
            return;
        }
        let along = |offset| dot(velocity_at(&cdof[d as usize], offset), direction);
        let value = if next_a < next_b {
            chain_a = &chain_a[1..];
            -along(offset_a)
        } else {
            chain_b = &chain_b[1..];
            along(offset_b)
        };
        while dofs[place] < d {
            place += 1;
        }
        entries[place] += scale * value;
    }
}

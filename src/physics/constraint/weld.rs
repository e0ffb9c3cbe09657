//! The points of a connection, the pose error of a weld, and the effect of its rows.

use crate::math::*;
use crate::model::{EqualityKind, Model};
use crate::state::State;

/// The pose error of a weld and the quantities of its Jacobian.
#[derive(Clone, Copy, Debug)]
pub struct Weld {
    /// Constrained point as body 1 carries it, world, m.
    pub point1: Vec3,
    /// Constrained point as body 2 carries it, world, m.
    pub point2: Vec3,
    /// Position error (m) and `torquescale` times the vector part of the relative quaternion.
    pub error: [f64; 6],
    quat1: Quat,
    quat2_conj: Quat,
    torquescale: f64,
}

impl Weld {
    /// Returns the rate of the rotational error under a relative angular velocity `w` of body 1 (world, rad/s).
    pub fn rotation_rate(&self, w: Vec3) -> Vec3 {
        let q = quat_mul(quat_mul(self.quat2_conj, [0.0, w[0], w[1], w[2]]), self.quat1);
        scale([q[1], q[2], q[3]], 0.5 * self.torquescale)
    }

    /// Returns the torque on body 1 (world, N m) of the multipliers of the rotational rows: the transpose of
    /// [`Self::rotation_rate`].
    pub fn torque_of_rows(&self, f: Vec3) -> Vec3 {
        std::array::from_fn(|k| {
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            dot(self.rotation_rate(axis), f)
        })
    }
}

/// Returns the points that connection `id` holds together, as bodies 1 and 2 carry them, world, m; `None` when that equality is
/// not a connection.
pub fn connected_points(model: &Model, s: &State, id: usize) -> Option<[Vec3; 2]> {
    let EqualityKind::Connect {
        body1,
        body2,
        anchor1,
        anchor2,
        sites,
    } = model.eq_kind[id]
    else {
        return None;
    };
    if let Some(sites) = sites {
        return Some(sites.map(|site| s.site_xpos[site]));
    }
    let carried = |body: usize, anchor: Vec3| add(mat_vec(&s.xmat[body], anchor), s.xpos[body]);
    Some([carried(body1, anchor1), carried(body2, anchor2)])
}

/// Returns the current state of weld `id`; `None` when that equality is not a weld.
pub fn weld_points(model: &Model, s: &State, id: usize) -> Option<Weld> {
    let EqualityKind::Weld {
        body1,
        body2,
        anchor,
        relpos,
        relquat,
        torquescale,
        sites,
    } = model.eq_kind[id]
    else {
        return None;
    };
    let (b1, b2) = (body1, body2);
    let point1 = add(mat_vec(&s.xmat[b1], relpos), s.xpos[b1]);
    let point2 = add(mat_vec(&s.xmat[b2], anchor), s.xpos[b2]);
    let (quat1, quat2_conj) = match sites {
        Some([site1, site2]) => (
            quat_mul(s.xquat[b1], model.site_quat[site1]),
            quat_conj(quat_mul(s.xquat[b2], model.site_quat[site2])),
        ),
        None => (quat_mul(s.xquat[b1], relquat), quat_conj(s.xquat[b2])),
    };
    let q = quat_mul(quat2_conj, quat1);
    let p = sub(point1, point2);
    let error = [
        p[0],
        p[1],
        p[2],
        torquescale * q[1],
        torquescale * q[2],
        torquescale * q[3],
    ];
    Some(Weld {
        point1,
        point2,
        error,
        quat1,
        quat2_conj,
        torquescale,
    })
}

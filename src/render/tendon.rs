//! Spatial tendons: a capsule for each straight piece of the path, half as wide where it runs over a geom. A tendon with only a greatest length hangs
//! between its two sites in a catenary, like a rope.

use super::drawable::{Drawable, Element};
use super::view::Poses;
use crate::math::{MINVAL, Mat3, Vec3, add, add_scaled, dot, norm, scale, sub, unit};
use crate::model::{Model, TrnType, Wrap};

/// Evenly spaced points of a catenary. MuJoCo leaves out the last but one.
const POINTS: usize = 30;
/// Pieces of a catenary.
const HANGING: usize = POINTS - 2;
/// Horizontal distance between the ends, relative to the length, below which a rope hangs straight down from both.
const NARROW: f64 = 0.01;
/// Mark in [`Poses::wrap_obj`] of a pulley, where the path is interrupted.
const PULLEY: i32 = -2;

/// Lists the elements that may show a tendon; `rope` is its entry in [`ropes`].
pub fn pieces(model: &Model, tendon: usize, rope: Vec3) -> impl Iterator<Item = Element> {
    let points = |wrap: &Wrap| match wrap {
        Wrap::Joint { .. } => 0,
        Wrap::Pulley { .. } | Wrap::Site { .. } => 1,
        Wrap::Sphere { .. } | Wrap::Cylinder { .. } => 2,
    };
    let count = match rope {
        [0.0, 0.0, 0.0] => model.tendon_wrap[tendon].iter().map(points).sum::<usize>(),
        _ => HANGING + 1,
    };
    (1..count).map(move |piece| Element::Tendon {
        tendon,
        piece: piece - 1,
    })
}

/// Returns for each tendon the upward direction times its greatest length, m, if it hangs loose between two sites; zeros for others, which something
/// pulls, damps or holds.
pub fn ropes(model: &Model) -> Vec<Vec3> {
    let mut pulled = vec![false; model.ntendon()];
    for (kind, &target) in model.actuator_trntype.iter().zip(&model.actuator_trnid) {
        if *kind == TrnType::Tendon {
            pulled[target] = true;
        }
    }
    let tendons = pulled.into_iter().enumerate();
    tendons
        .map(|(tendon, pulled)| if pulled { [0.0; 3] } else { rope(model, tendon) })
        .collect()
}

/// Returns the rope of a tendon that no actuator pulls.
fn rope(model: &Model, tendon: usize) -> Vec3 {
    let gravity = model.opt.gravity;
    let held = model.tendon_damping[tendon] != 0.0 || model.tendon_frictionloss[tendon] != 0.0;
    let sprung = model.tendon_stiffness[tendon] > 0.0;
    let [least, most] = match (sprung, model.tendon_limited[tendon]) {
        (true, _) => model.tendon_lengthspring[tendon],
        (false, true) => model.tendon_range[tendon],
        (false, false) => [0.0; 2],
    };
    let between_sites = matches!(model.tendon_wrap[tendon][..], [Wrap::Site { .. }, Wrap::Site { .. }]);
    let loose = between_sites && least == 0.0 && most > 0.0 && !held;
    if loose && model.opt.flags.gravity && norm(gravity) > MINVAL {
        scale(unit(gravity).0, -most)
    } else {
        [0.0; 3]
    }
}

impl Drawable {
    /// Returns a piece of a tendon in these poses; `None` if it does not exist.
    #[inline(never)]
    pub(super) fn strung(&self, poses: &Poses, tendon: usize, piece: usize) -> Option<(Self, Vec3, Mat3)> {
        let (first, count) = (*poses.ten_wrapadr.get(tendon)?, *poses.ten_wrapnum.get(tendon)?);
        let points = poses.wrap_xpos.get(first..first + count)?;
        let objects = poses.wrap_obj.get(first..first + count)?;
        let (ends, inside) = match (points, self.rope) {
            (&[from, to], rope) if rope != [0.0; 3] => (hanging(from, to, rope, piece)?, false),
            _ => {
                let (ends, on) = (points.get(piece..piece + 2)?, objects.get(piece..piece + 2)?);
                if on.contains(&PULLEY) {
                    return None;
                }
                ([ends[0], ends[1]], on.iter().all(|&object| object >= 0))
            }
        };
        let (direction, length) = unit(sub(ends[1], ends[0]));
        let [width, ..] = self.measured();
        let width = if inside { 0.5 * width } else { width };
        let drawable = self.resized([width, 0.5 * length, 0.0]);
        Some((drawable, scale(add(ends[0], ends[1]), 0.5), along(direction)))
    }
}

/// Returns the shortest rotation that takes z to a direction.
pub(super) fn along([x, y, z]: Vec3) -> Mat3 {
    let across = x * x + y * y;
    if z < 0.0 && across < MINVAL * MINVAL {
        return [1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0];
    }
    let turn = if z > 0.0 { 1.0 / (1.0 + z) } else { (1.0 - z) / across };
    let mixed = -x * y * turn;
    [1.0 - x * x * turn, mixed, x, mixed, 1.0 - y * y * turn, y, -x, -y, z]
}

/// Returns the ends of a piece of a rope between two points; `None` if it has fewer. `rope` is its entry in [`ropes`].
fn hanging(from: Vec3, to: Vec3, rope: Vec3, piece: usize) -> Option<[Vec3; 2]> {
    let (up, length) = unit(rope);
    let apart = sub(to, from);
    let rise = dot(apart, up);
    let (across, width) = unit(add_scaled(apart, up, -rise));
    let straight = norm(apart);
    if straight.is_nan() || straight >= length {
        return (piece == 0).then_some([from, to]);
    }
    let place = |x: f64, y: f64| add_scaled(add_scaled(from, across, x), up, y);
    // the horizontal length: its square is that of the length less that of the rise
    let taut = (length * length - rise * rise).sqrt();
    if width < NARROW * length {
        let down = 0.5 * ((length * length - width * width).sqrt() - rise);
        let lowest = if width > 0.0 {
            place(width * down / (length * length - width * width).sqrt(), -down)
        } else {
            add_scaled(from, up, -down)
        };
        return [[from, lowest], [lowest, to]].get(piece).copied();
    }
    // a cosh((x - middle) / a) has this width, rise and length
    let a = width / (2.0 * stretch(taut / width));
    let middle = 0.5 * width - a * pxfm::f_atanh(rise / length);
    let start = pxfm::f_cosh(middle / a);
    let point = |k: usize| match k {
        0 => from,
        HANGING => to,
        _ => {
            let x = width * k as f64 / (POINTS - 1) as f64;
            place(x, a * (pxfm::f_cosh((x - middle) / a) - start))
        }
    };
    (piece < HANGING).then(|| [point(piece), point(piece + 1)])
}

/// Solves `sinh u = ratio u` for a ratio above 1, by Newton's method from above.
fn stretch(ratio: f64) -> f64 {
    // both are above the solution, and the function is convex
    let mut u = (6.0 * (ratio - 1.0))
        .sqrt()
        .min(2.0 * pxfm::f_log(2.0 * ratio) + 1.0)
        .max(1e-6);
    for _ in 0..50 {
        let step = (pxfm::f_sinh(u) - ratio * u) / (pxfm::f_cosh(u) - ratio);
        u -= step;
        if step.abs() < 1e-12 * u {
            break;
        }
    }
    u.max(1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ropes_are_as_long_as_they_are() {
        for (to, length) in [
            ([0.6, 0.0, -0.1], 0.9),
            ([0.3, -0.4, 0.2], 0.55),
            ([0.1, 0.0, 0.0], 9.0),
            ([0.001, 0.0, 0.2], 0.9),
            ([0.0; 3], 1.0),
        ] {
            let pieces = (0..).map_while(|k| hanging([0.0; 3], to, [0.0, 0.0, length], k));
            let pieces: Vec<_> = pieces.collect();
            let sum: f64 = pieces.iter().map(|[a, b]| norm(sub(*b, *a))).sum();
            assert!((sum / length - 1.0).abs() < 0.02, "{sum} instead of {length}");
            assert!(pieces.windows(2).all(|two| two[0][1] == two[1][0]));
            assert_eq!((pieces[0][0], pieces[pieces.len() - 1][1]), ([0.0; 3], to));
        }
    }

    /// Points of MuJoCo 3.3.0's catenary of 0.9 m from (0, 0, 0) to (0.6, 0, -0.1), in single precision.
    #[test]
    fn ropes_hang_as_in_mujoco() {
        let places = [
            (1, [0.020689654, 0.0, -0.052739206]),
            (5, [0.10344827, 0.0, -0.20939421]),
            (14, [0.28965517, 0.0, -0.34846473]),
            (27, [0.55862068, 0.0, -0.17773765]),
        ];
        for (k, place) in places {
            let [from, _] = hanging([0.0; 3], [0.6, 0.0, -0.1], [0.0, 0.0, 0.9], k).unwrap();
            assert!(norm(sub(from, place)) < 2e-7, "{k}: {from:?}");
        }
    }

    #[test]
    fn tight_ropes_are_straight() {
        let ends = [[0.0; 3], [1.0, 0.0, 0.0]];
        assert_eq!(hanging(ends[0], ends[1], [0.0, 0.0, 1.0], 0), Some(ends));
        assert_eq!(hanging(ends[0], ends[1], [0.0, 0.0, 1.0], 1), None);
        let barely = hanging(ends[0], ends[1], [0.0, 0.0, 1.0 + 1e-15], 14);
        assert!(barely.is_some_and(|ends| ends.iter().flatten().all(|x| x.is_finite())));
    }

    #[test]
    fn directions_turn_z() {
        for direction in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, -0.8], [0.0, -1.0, 0.0]] {
            let mat = along(direction);
            assert_eq!(crate::math::column(&mat, 2), direction);
            let square = crate::math::mat_mul(&mat, &crate::math::transpose(&mat));
            let off = square.iter().zip(crate::math::MAT3_ID).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1e-15);
        }
    }
}

//! Force of a muscle as a function of its length and velocity.
//!
//! The curves of MuJoCo's muscle model (documentation, "Modeling: Muscles"; after Millard et al. 2013), as MIMo uses
//! them (Wochner et al. 2022, "Learning with muscles: benefits for data-efficiency and robustness in anthropomorphic
//! tasks"). Lengths are relative to the optimal length, velocities in optimal lengths per second, forces relative to
//! the isometric maximum.
//!
//! | length | 0.5 | 0.6 | 0.7 | 0.75 | 0.8375 | 0.95 | 1 | 1.1 | 1.3 | 1.45 | 1.6 |
//! |---|---|---|---|---|---|---|---|---|---|---|---|
//! | [`force_length`] | 0 | 0.1393 | 0.4663 | 0.6463 | 0.8638 | 0.98 | 1 | 0.9444 | 0.5 | 0.125 | 0 |
//! | [`passive`] | 0 | 0 | 0 | 0 | 0 | 0 | 0 | 0.0120 | 0.325 | 0.8125 | 1.3 |
//!
//! | velocity / vmax | -1 | -0.5 | -0.1 | 0 | 0.05 | 0.1 | 0.2 and more |
//! |---|---|---|---|---|---|---|---|
//! | [`force_velocity`] | 0 | 0.25 | 0.81 | 1 | 1.0875 | 1.15 | 1.2 |

/// The shortest length at which a muscle is active.
pub const LENGTH_MIN: f64 = 0.5;
/// The longest length at which a muscle is active.
pub const LENGTH_MAX: f64 = 1.6;
/// The force of a muscle that lengthens fast.
pub const FORCE_LENGTHENING: f64 = 1.2;
/// The passive force at [`LENGTH_MAX`].
pub const FORCE_PASSIVE: f64 = 1.3;

/// Returns a smooth bump on (`a`, `b`), 1 at `mid`, made of four parabolas.
fn bump(length: f64, a: f64, mid: f64, b: f64) -> f64 {
    let (left, right) = (0.5 * (a + mid), 0.5 * (mid + b));
    let half_square = |from: f64, width: f64| 0.5 * (length - from) * (length - from) / (width * width);
    if length <= a || length >= b {
        0.0
    } else if length < left {
        half_square(a, left - a)
    } else if length < mid {
        1.0 - half_square(mid, mid - left)
    } else if length < right {
        1.0 - half_square(mid, right - mid)
    } else {
        half_square(b, b - right)
    }
}

/// Returns the active force at a length: a bump on (0.5, 1.6) about the optimal length, and a smaller one on (0.5,
/// 0.95).
pub fn force_length(length: f64) -> f64 {
    bump(length, LENGTH_MIN, 1.0, LENGTH_MAX) + 0.15 * bump(length, LENGTH_MIN, 0.5 * (LENGTH_MIN + 0.95), 0.95)
}

/// Returns the factor on the active force at a velocity (positive when the muscle lengthens), for a fastest shortening
/// of `vmax`.
pub fn force_velocity(velocity: f64, vmax: f64) -> f64 {
    const C: f64 = FORCE_LENGTHENING - 1.0;
    let x = velocity / vmax;
    if x < -1.0 {
        0.0
    } else if x <= 0.0 {
        (x + 1.0) * (x + 1.0)
    } else if x <= C {
        FORCE_LENGTHENING - (C - x) * (C - x) / C
    } else {
        FORCE_LENGTHENING
    }
}

/// Returns the passive force at a length: cubic from the optimal length to 1.3, then a straight line.
pub fn passive(length: f64) -> f64 {
    const B: f64 = 0.5 * (1.0 + LENGTH_MAX);
    const QUARTER: f64 = 0.25 * FORCE_PASSIVE;
    if length <= 1.0 {
        0.0
    } else if length <= B {
        let x = (length - 1.0) / (B - 1.0);
        QUARTER * x * x * x
    } else {
        QUARTER * (1.0 + 3.0 * (length - B) / (B - 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(curve: impl Fn(f64) -> f64, expect: &[(f64, f64)]) {
        for &(x, y) in expect {
            assert!((curve(x) - y).abs() < 1e-12, "at {x}: {} is not {y}", curve(x));
        }
    }

    #[test]
    fn active_force() {
        let table = [
            (0.4, 0.0),
            (0.5, 0.0),
            (0.55, 0.034_814_814_814_8),
            (0.6, 0.139_259_259_259),
            (0.7, 0.466_296_296_296),
            (0.725, 0.555),
            (0.75, 0.646_296_296_296),
            (0.8375, 0.86375),
            (0.9, 0.934_814_814_815),
            (0.95, 0.98),
            (1.0, 1.0),
            (1.05, 0.986_111_111_111),
            (1.1, 0.944_444_444_444),
            (1.3, 0.5),
            (1.45, 0.125),
            (1.6, 0.0),
            (1.7, 0.0),
        ];
        check(force_length, &table);
    }

    #[test]
    fn passive_force() {
        let table = [
            (0.9, 0.0),
            (1.05, 0.001_504_629_629_63),
            (1.1, 0.012_037_037_037),
            (1.3, 0.325),
            (1.45, 0.8125),
            (1.6, 1.3),
            (1.7, 1.625),
        ];
        check(passive, &table);
    }

    #[test]
    fn velocity_factor() {
        let table = [
            (-1.5, 0.0),
            (-1.0, 0.0),
            (-0.5, 0.25),
            (-0.1, 0.81),
            (0.0, 1.0),
            (0.05, 1.0875),
            (0.1, 1.15),
            (0.2, 1.2),
            (9.0, 1.2),
        ];
        for vmax in [1.0, 2.5] {
            check(|x| force_velocity(x * vmax, vmax), &table);
        }
    }
}

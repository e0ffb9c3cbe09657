//! Stiffness, damping and impedance from `solref` and `solimp`.

use crate::math::MINVAL;

/// The stiffness, damping and impedance of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impedance {
    /// Stiffness, 1/s^2.
    pub k: f64,
    /// Damping, 1/s.
    pub b: f64,
    /// Impedance, in (0, 1).
    pub imp: f64,
}

/// Impedances stay this far from 0 and 1.
const MINIMP: f64 = 0.0001;
const MAXIMP: f64 = 0.9999;

/// Computes the impedance of a row. `solref` is (time constant, damping ratio), or, when not positive, (-stiffness,
/// -damping); a time constant below two time steps counts as two time steps. `solimp` is (dmin, dmax, width, midpoint,
/// power): the impedance grows from dmin to dmax as `|pos|` goes from 0 to width, along two power curves that meet at
/// the midpoint. `pos` is the violation, m or rad.
pub fn impedance(solref: [f64; 2], solimp: [f64; 5], pos: f64, timestep: f64) -> Impedance {
    let dmin = solimp[0].clamp(MINIMP, MAXIMP);
    let dmax = solimp[1].clamp(MINIMP, MAXIMP);
    let width = solimp[2].max(0.0);
    let midpoint = solimp[3].clamp(MINIMP, MAXIMP);
    let power = solimp[4].max(1.0);
    let (k, b) = if solref[0] > 0.0 {
        let timeconst = solref[0].max(2.0 * timestep);
        let ratio = solref[1];
        (
            1.0 / (dmax * dmax * timeconst * timeconst * ratio * ratio).max(MINVAL),
            2.0 / (dmax * timeconst).max(MINVAL),
        )
    } else {
        (-solref[0] / (dmax * dmax).max(MINVAL), -solref[1] / dmax.max(MINVAL))
    };
    let imp = if dmin == dmax || width <= MINVAL {
        0.5 * (dmin + dmax)
    } else {
        let x = (pos / width).abs();
        if x >= 1.0 {
            dmax
        } else if x == 0.0 {
            dmin
        } else {
            dmin + sigmoid(x, midpoint, power) * (dmax - dmin)
        }
    };
    Impedance { k, b, imp }
}

/// Evaluates a sigmoid: two power curves from (0, 0) to (1, 1) that meet at `x = midpoint`.
fn sigmoid(x: f64, midpoint: f64, power: f64) -> f64 {
    if power == 1.0 {
        x
    } else if x <= midpoint {
        pow(x, power) / pow(midpoint, power - 1.0)
    } else {
        1.0 - pow(1.0 - x, power) / pow(1.0 - midpoint, power - 1.0)
    }
}

fn pow(x: f64, p: f64) -> f64 {
    if p == 1.0 {
        x
    } else if p == 2.0 {
        x * x
    } else {
        pxfm::f_pow(x, p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impedance_runs_from_dmin_to_dmax() {
        let solimp = [0.9, 0.95, 0.001, 0.5, 2.0];
        let at = |pos| impedance([0.02, 1.0], solimp, pos, 0.005).imp;
        assert_eq!(at(0.0), 0.9);
        assert!((at(0.0005) - 0.925).abs() < 1e-15);
        assert_eq!(at(-0.001), 0.95);
        assert_eq!(at(1.0), 0.95);
    }

    #[test]
    fn time_constants_below_two_steps_count_as_two_steps() {
        let solimp = [0.95, 0.99, 0.001, 0.5, 1.0];
        let short = impedance([0.005, 1.0], solimp, 0.0, 0.005);
        assert_eq!(short, impedance([0.01, 1.0], solimp, 0.0, 0.005));
        assert!((short.b - 2.0 / (0.99 * 0.01)).abs() < 1e-10);
    }
}

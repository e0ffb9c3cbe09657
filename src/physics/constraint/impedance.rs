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

/// The values used if a `solref` mixes its two forms.
const DEFAULT_SOLREF: [f64; 2] = [0.02, 1.0];

/// Returns whether a `solref` is neither zero nor mixed (one number positive and the other not): MuJoCo treats a zero or mixed `solreffriction` as
/// not given.
#[inline(always)]
pub(super) fn is_solref(solref: [f64; 2]) -> bool {
    solref != [0.0; 2] && (solref[0] > 0.0) == (solref[1] > 0.0)
}

/// Computes the impedance of a row. `solref` is (time constant, damping ratio), or, when neither is positive, (-stiffness,
/// -damping); where only one of the two is positive it counts as (0.02, 1), MuJoCo's default. A time constant below `least`
/// counts as `least`, s. `solimp` is (dmin, dmax, width, midpoint,
/// power): the impedance grows from dmin to dmax as `|pos|` goes from 0 to width, along two power curves that meet at
/// the midpoint. `pos` is the violation, m or rad.
#[doc(alias = "mj_makeImpedance")]
#[inline(always)]
pub fn impedance(solref: [f64; 2], solimp: [f64; 5], pos: f64, least: f64) -> Impedance {
    let mixed = (solref[0] > 0.0) != (solref[1] > 0.0);
    let solref = if mixed { DEFAULT_SOLREF } else { solref };
    let dmin = solimp[0].clamp(MINIMP, MAXIMP);
    let dmax = solimp[1].clamp(MINIMP, MAXIMP);
    let width = solimp[2].max(0.0);
    let midpoint = solimp[3].clamp(MINIMP, MAXIMP);
    let power = solimp[4].max(1.0);
    let (k, b) = if solref[0] > 0.0 {
        let timeconst = solref[0].max(least);
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
#[inline(always)]
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
    } else if p == 0.5 {
        // correctly rounded, too
        x.sqrt()
    } else if p == 1.5 {
        // contacts of geoms with powers 1 and 2
        pow_three_halves(x).unwrap_or_else(|| pxfm::f_pow(x, p))
    } else {
        pxfm::f_pow(x, p)
    }
}

/// Returns `x^1.5`, correctly rounded, from `sqrt(x)` in twice the precision; `None` if that is not precise enough, or if `x` is far from 1.
fn pow_three_halves(x: f64) -> Option<f64> {
    if !(1e-100..1e100).contains(&x) {
        return None;
    }
    let root = x.sqrt();
    let (square, low) = product(root, root);
    let root_low = ((x - square) - low) / (2.0 * root);
    let (high, low) = product(x, root);
    let low = low + x * root_low;
    // `low` is off by less than 2^-100 of the whole
    let error = high * 1e-30;
    let (up, down) = (high + (low + error), high + (low - error));
    (up == down).then_some(up)
}

/// Returns a product and its rounding error (Dekker 1971).
fn product(a: f64, b: f64) -> (f64, f64) {
    let halves = |v: f64| {
        let c = 134_217_729.0 * v;
        let high = c - (c - v);
        (high, v - high)
    };
    let ((a1, a2), (b1, b2)) = (halves(a), halves(b));
    let p = a * b;
    (p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impedance_runs_from_dmin_to_dmax() {
        let solimp = [0.9, 0.95, 0.001, 0.5, 2.0];
        let at = |pos| impedance([0.02, 1.0], solimp, pos, 0.01).imp;
        assert_eq!(at(0.0), 0.9);
        assert!((at(0.0005) - 0.925).abs() < 1e-15);
        assert_eq!(at(-0.001), 0.95);
        assert_eq!(at(1.0), 0.95);
    }

    #[test]
    fn powers_of_three_halves_and_a_half_are_those_of_pow() {
        let mut decided = 0;
        for k in 1..200_000 {
            // low-discrepancy numbers over many magnitudes
            let x = (k as f64 * 0.618_033_988_749_894_9).fract() * 0.5_f64.powi(k % 60);
            assert_eq!(pow(x, 1.5).to_bits(), pxfm::f_pow(x, 1.5).to_bits(), "{x:e}");
            assert_eq!(pow(x, 0.5).to_bits(), pxfm::f_pow(x, 0.5).to_bits(), "{x:e}");
            decided += usize::from(pow_three_halves(x).is_some());
        }
        assert_eq!(decided, 199_999);
    }

    #[test]
    fn time_constants_below_the_least_count_as_the_least() {
        let solimp = [0.95, 0.99, 0.001, 0.5, 1.0];
        let short = impedance([0.005, 1.0], solimp, 0.0, 0.01);
        assert_eq!(short, impedance([0.01, 1.0], solimp, 0.0, 0.01));
        assert!((short.b - 2.0 / (0.99 * 0.01)).abs() < 1e-10);
    }
}

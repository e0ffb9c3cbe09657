//! MuJoCo's muscles: active and passive force by length and velocity, and the dynamics of the activation.
//!
//! Parameters of gain and bias are `range` (2), `force`, `scale`, `lmin`, `lmax`, `vmax`, `fpmax`, `fvmax`. Lengths are scaled so that
//! the two ends of `range` are the shortest and the longest length of the actuator; the optimum is 1. The velocity is in
//! units of `vmax` optimal lengths per second.

use crate::math::MINVAL;
use crate::model::Model;

/// Parameters, as in an actuator's gain or bias.
type MuscleParameters = [f64; 10];

/// A muscle's peak force, with length and velocity scaled for its curves.
struct ScaledMuscle {
    /// Isometric force, N.
    force: f64,
    /// Optimal length.
    optimum: f64,
    length: f64,
}

impl ScaledMuscle {
    fn new(model: &Model, actuator: usize, prm: &MuscleParameters, length: f64) -> Self {
        let &[low, high, force, scale, ..] = prm;
        let [shortest, longest] = model.actuator_lengthrange[actuator];
        // `range` says how many optimal lengths the shortest and the longest length are
        let optimum = (longest - shortest) / (high - low).max(MINVAL);
        Self {
            // `scale` is the acceleration that the muscle gives at `qpos0`, and `acc0` that of a unit force
            force: if force < 0.0 {
                scale / model.actuator_acc0[actuator].max(MINVAL)
            } else {
                force
            },
            optimum,
            length: low + (length - shortest) / optimum.max(MINVAL),
        }
    }

    /// Returns the active force at that length, relative to the greatest: four parabolas from `lmin` through 1 to `lmax`.
    fn active(&self, prm: &MuscleParameters) -> f64 {
        let (length, lmin, lmax) = (self.length, prm[4], prm[5]);
        if !(lmin..=lmax).contains(&length) {
            return 0.0;
        }
        let (a, b) = (0.5 * (lmin + 1.0), 0.5 * (1.0 + lmax));
        let part = |distance: f64, width: f64| distance / width.max(MINVAL);
        if length <= a {
            let x = part(length - lmin, a - lmin);
            0.5 * x * x
        } else if length <= 1.0 {
            let x = part(1.0 - length, 1.0 - a);
            1.0 - 0.5 * x * x
        } else if length <= b {
            let x = part(length - 1.0, b - 1.0);
            1.0 - 0.5 * x * x
        } else {
            let x = part(lmax - length, lmax - b);
            0.5 * x * x
        }
    }

    /// Returns the velocity at which an unloaded muscle shortens, per second.
    fn fastest(&self, prm: &MuscleParameters) -> f64 {
        (self.optimum * prm[6]).max(MINVAL)
    }
}

/// Returns the gain of a muscle: minus its active force at full activation, N.
#[doc(alias = "mju_muscleGain")]
pub(super) fn gain(model: &Model, actuator: usize, length: f64, velocity: f64) -> f64 {
    let prm = &model.actuator_gainprm[actuator];
    let muscle = ScaledMuscle::new(model, actuator, prm, length);
    let (v, fvmax) = (velocity / muscle.fastest(prm), prm[8]);
    let y = fvmax - 1.0;
    let by_velocity = if v <= -1.0 {
        0.0
    } else if v <= 0.0 {
        (v + 1.0) * (v + 1.0)
    } else if v <= y {
        fvmax - (y - v) * (y - v) / y.max(MINVAL)
    } else {
        fvmax
    };
    -muscle.force * muscle.active(prm) * by_velocity
}

/// Returns the derivative of [`gain`] by the velocity.
pub(super) fn gain_slope(model: &Model, actuator: usize, length: f64, velocity: f64) -> f64 {
    let prm = &model.actuator_gainprm[actuator];
    let muscle = ScaledMuscle::new(model, actuator, prm, length);
    let fastest = muscle.fastest(prm);
    let (v, y) = (velocity / fastest, prm[8] - 1.0);
    let by_velocity = if v <= -1.0 {
        0.0
    } else if v <= 0.0 {
        2.0 * v + 2.0
    } else if v <= y {
        (-2.0 * v + 2.0 * y) / y.max(MINVAL)
    } else {
        0.0
    };
    -muscle.force * muscle.active(prm) * by_velocity / fastest
}

/// Returns the bias of a muscle: minus its passive force, N, which grows with the square of the length beyond the optimum, and linearly from halfway
/// to `lmax` on.
#[doc(alias = "mju_muscleBias")]
pub(super) fn bias(model: &Model, actuator: usize, length: f64) -> f64 {
    let prm = &model.actuator_biasprm[actuator];
    let muscle = ScaledMuscle::new(model, actuator, prm, length);
    let (length, fpmax) = (muscle.length, prm[7]);
    // half way to lmax, where the parabola becomes its tangent
    let b = 0.5 * (1.0 + prm[5]);
    if length <= 1.0 {
        0.0
    } else if length <= b {
        let x = (length - 1.0) / (b - 1.0).max(MINVAL);
        -muscle.force * fpmax * 0.5 * x * x
    } else {
        let x = (length - b) / (b - 1.0).max(MINVAL);
        -muscle.force * fpmax * (0.5 + x)
    }
}

/// Returns the rate of the activation of a muscle: it moves towards the control, faster up than down, with time constants that
/// depend on the activation. `prm` is time constants of activation and deactivation, s, and the width of the transition between
/// them.
#[doc(alias = "mju_muscleDynamics")]
pub(super) fn rate(prm: &MuscleParameters, ctrl: f64, act: f64) -> f64 {
    // Millard, Uchida, Seth and Delp, "Flexing Computational Muscle", J. Biomech. Eng. 135(2), 2013
    let speed = 0.5 + 1.5 * act.clamp(0.0, 1.0);
    let (up, down, width) = (prm[0] * speed, prm[1] / speed, prm[2]);
    let excess = ctrl.clamp(0.0, 1.0) - act;
    let tau = if width < MINVAL {
        if excess > 0.0 { up } else { down }
    } else {
        down + (up - down) * smooth_step(excess / width + 0.5)
    };
    excess / tau.max(MINVAL)
}

/// Rises from 0 to 1 with two continuous derivatives: a polynomial of degree five (MuJoCo's `mju_sigmoid`).
fn smooth_step(x: f64) -> f64 {
    if x <= 0.0 {
        0.0
    } else if x >= 1.0 {
        1.0
    } else {
        x * x * x * (3.0 * x * (2.0 * x - 5.0) + 10.0)
    }
}

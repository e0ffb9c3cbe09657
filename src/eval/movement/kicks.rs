//! Individual movements of the limbs: their number, duration and speed, and the other side's movements meanwhile.

use super::paths::BodyPaths;
use super::{LIMBS, Values, mean, velocities};
use crate::math::{Vec3, dot, norm};

/// A movement begins when the end of a limb is faster than this in the frame of the hip, m/s, as in the task `mobile`.
const BEGINS: f64 = 0.2;
/// It ends when the end of the limb is slower than this, m/s, or turns back.
const ENDS: f64 = 0.1;
/// Movements of both sides that begin within this time are together, s; within the longer one they alternate.
const TOGETHER: f64 = 0.2;
const ALTERNATING: f64 = 1.0;

/// A movement of a limb, in steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bout {
    pub first: usize,
    pub end: usize,
}

/// Finds the movements in velocities.
pub(super) fn bouts(velocity: &[Vec3]) -> Vec<Bout> {
    let (mut found, mut moving): (Vec<Bout>, Option<(usize, Vec3)>) = (Vec::new(), None);
    for (t, &v) in velocity.iter().enumerate() {
        let speed = norm(v);
        if let Some((first, direction)) = moving
            && (speed < ENDS || dot(v, direction) < 0.0)
        {
            found.push(Bout { first, end: t });
            moving = None;
        }
        if moving.is_none() && speed > BEGINS {
            moving = Some((t, v));
        }
    }
    found.extend(moving.map(|(first, _)| Bout {
        first,
        end: velocity.len(),
    }));
    found
}

pub(super) fn measure(body: &BodyPaths, values: &mut Values) {
    let seconds = body.len() as f64 * body.dt;
    let mut all: Vec<Vec<Bout>> = Vec::new();
    for (name, path) in LIMBS.iter().zip(&body.hip) {
        let velocity = velocities(path, body.dt);
        let found = bouts(&velocity);
        let acceleration: Vec<f64> = velocities(&velocity, body.dt).into_iter().map(norm).collect();
        let within = |bout: &Bout| &acceleration[bout.first.min(acceleration.len())..bout.end.min(acceleration.len())];
        values.put(
            format!("{name}_movements"),
            (seconds > 0.0).then(|| 60.0 * found.len() as f64 / seconds),
        );
        let lasting = found.iter().map(|bout| (bout.end - bout.first) as f64 * body.dt);
        values.put(format!("{name}_duration"), mean(lasting));
        values.put(
            format!("{name}_acceleration"),
            mean(found.iter().filter_map(|bout| mean(within(bout).iter().copied()))),
        );
        let peak = |bout: &Bout| within(bout).iter().copied().reduce(f64::max);
        values.put(format!("{name}_peak_acceleration"), mean(found.iter().filter_map(peak)));
        all.push(found);
    }
    for (name, right, left) in [("hands", 0, 1), ("feet", 2, 3)] {
        sides(name, &all[right], &all[left], body.dt, values);
    }
}

/// Measures the timing of two sides.
fn sides(name: &str, right: &[Bout], left: &[Bout], dt: f64, values: &mut Values) {
    let both = (right.len() + left.len()) as f64;
    if both == 0.0 {
        return;
    }
    values.put(
        format!("{name}_laterality"),
        (right.len() as f64 - left.len() as f64) / both,
    );
    let (mut together, mut alternating) = (0.0, 0.0);
    for (own, other) in [(right, left), (left, right)] {
        for bout in own {
            let nearest = other.iter().map(|o| o.first.abs_diff(bout.first)).min();
            match nearest.map(|steps| steps as f64 * dt) {
                Some(gap) if gap <= TOGETHER => together += 1.0,
                Some(gap) if gap <= ALTERNATING => alternating += 1.0,
                _ => {}
            }
        }
    }
    values.put(format!("{name}_together"), together / both);
    values.put(format!("{name}_alternating"), alternating / both);
    values.put(format!("{name}_alone"), (both - together - alternating) / both);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kicks of a foot to and fro, every two seconds, from a start, s; steps of 10 ms.
    fn kicking(start: f64) -> Vec<Vec3> {
        (0..12_000)
            .map(|t| {
                let phase = (f64::from(t) * 0.01 - start).rem_euclid(2.0);
                let x = if phase < 0.5 {
                    0.05 * (1.0 - pxfm::f_cos(std::f64::consts::TAU * phase / 0.5))
                } else {
                    0.0
                };
                [x, 0.0, 0.0]
            })
            .collect()
    }

    fn measured(right: f64, left: f64) -> Values {
        let mut body = BodyPaths {
            dt: 0.01,
            ..BodyPaths::default()
        };
        body.world = std::array::from_fn(|_| vec![[0.0; 3]; 12_000]);
        body.hip = body.world.clone();
        (body.hip[2], body.hip[3]) = (kicking(right), kicking(left));
        let mut values = Values::default();
        measure(&body, &mut values);
        values
    }

    #[test]
    fn kicks_are_counted_to_and_fro() {
        let values = measured(0.5, 1.5).0;
        // two movements, there and back, in every two seconds
        assert_eq!(values["right_foot_movements"], 60.0);
        assert!(
            (values["right_foot_duration"] - 0.22).abs() < 0.02,
            "{}",
            values["right_foot_duration"]
        );
        assert_eq!(values["right_hand_movements"], 0.0);
        assert!(!values.contains_key("right_hand_duration"));
        assert_eq!(values["feet_laterality"], 0.0);
        // of A cos(w t) the acceleration is at most A w^2
        let peak = 0.05 * (std::f64::consts::TAU / 0.5) * (std::f64::consts::TAU / 0.5);
        assert!((values["left_foot_peak_acceleration"] / peak - 1.0).abs() < 0.05);
    }

    #[test]
    fn sides_move_together_or_in_turns() {
        let together = measured(0.5, 0.6).0;
        assert_eq!(
            [
                together["feet_together"],
                together["feet_alternating"],
                together["feet_alone"]
            ],
            [1.0, 0.0, 0.0]
        );
        let turns = measured(0.5, 1.5).0;
        assert!(turns["feet_alternating"] > 0.95, "{turns:?}");
    }
}

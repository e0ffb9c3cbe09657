//! Order of segments in a roll.

use super::Values;
use super::paths::{BodyPaths, SEGMENTS};

/// A segment has turned when its front looks up by less than this: 45 degrees from supine.
const TURNED: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Measures when each segment turns, s from the first step. Returns the first to turn, if the pelvis does at all.
pub(super) fn measure(body: &BodyPaths, values: &mut Values) -> Option<String> {
    let turn = |front: &[f64]| {
        // only from supine
        let start = *front.first()?;
        (start > TURNED).then(|| front.iter().position(|up| *up < TURNED))?
    };
    let times: Vec<Option<f64>> = body
        .front
        .iter()
        .map(|front| turn(front).map(|t| t as f64 * body.dt))
        .collect();
    for (name, time) in SEGMENTS.iter().zip(&times) {
        values.put(format!("{name}_turns"), *time);
    }
    times[2]?;
    let first = times.iter().enumerate().filter_map(|(k, time)| Some((k, (*time)?)));
    let leading = first.reduce(|a, b| if b.1 < a.1 { b } else { a })?.0;
    Some(SEGMENTS[leading].to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_segment_that_turns_first_leads() {
        let turning = |late: usize| {
            (0..100)
                .map(|t: usize| if t < late { 1.0 } else { 0.0 })
                .collect::<Vec<f64>>()
        };
        let mut body = BodyPaths {
            dt: 0.1,
            front: [turning(30), turning(20), turning(25), turning(10), turning(60)],
            ..BodyPaths::default()
        };
        let mut values = Values::default();
        assert_eq!(measure(&body, &mut values).as_deref(), Some("right_leg"));
        assert_eq!(values.0["pelvis_turns"], 2.5);
        // who does not turn the pelvis does not roll
        body.front[2] = vec![1.0; 100];
        assert_eq!(measure(&body, &mut values), None);
        // who starts prone does not roll over
        body.front = std::array::from_fn(|_| vec![-1.0; 100]);
        assert_eq!(measure(&body, &mut Values::default()), None);
    }
}

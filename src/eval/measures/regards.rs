//! Times in which the hands are in view.

use crate::env::PerEyeAndHand;
use crate::formats::npz::{Npz, NpzError};
use crate::runs::Manifest;

/// Half of the central field of view, degrees.
const FIELD_OF_VIEW: f64 = 15.0;

/// Returns the shares of the steps in which each eye had each hand in view, by the counters of the information, if there are any.
pub(super) fn counted(npz: &Npz) -> Result<Option<PerEyeAndHand<f64>>, NpzError> {
    if npz.arrays().all(|array| array.name != "regards") {
        return Ok(None);
    }
    let counts = npz.get_i64("regards")?;
    let rows = counts.data.as_chunks::<4>().0;
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return Ok(None);
    };
    // counters may continue from the last episode; in one step they grow by at most one
    let old = first.map(|count| if count > 1 { count - 1 } else { 0 });
    let share = |k: usize| last[k].saturating_sub(old[k]) as f64 / rows.len() as f64;
    Ok(Some(std::array::from_fn::<f64, 4, _>(share).into()))
}

/// Returns the shares of the recorded images in which pixels of a hand, with its fingers, lie within 15 degrees of the axis of an eye:
/// occlusion is taken into account. `None` without recorded segmentation.
pub(super) fn seen(npz: &Npz, manifest: &Manifest) -> Result<Option<PerEyeAndHand<f64>>, NpzError> {
    let names = ["eye_right_segmentation", "eye_left_segmentation"];
    let has = |name: &str| npz.arrays().any(|array| array.name == name);
    let Some(fovy) = manifest.fovy.filter(|_| names.iter().all(|name| has(name))) else {
        return Ok(None);
    };
    let hand_of = |geom: i64| {
        let geom = usize::try_from(geom).ok().and_then(|geom| manifest.geoms.get(geom))?;
        match (geom.region.as_deref(), geom.side.as_deref()) {
            (Some("hand"), Some("right")) => Some(0),
            (Some("hand"), Some("left")) => Some(1),
            _ => None,
        }
    };
    let mut shares = [0.0; 4];
    for (eye, name) in names.into_iter().enumerate() {
        let images = npz.get_i64(name)?;
        let [count, height, width] = images.shape[..] else {
            return Ok(None);
        };
        let right = manifest.fovy_right.filter(|_| eye == 0);
        let central = central(height, width, right.unwrap_or(fovy));
        for image in images.data.chunks_exact((height * width).max(1)) {
            let mut found = [false; 2];
            for (&geom, _) in image.iter().zip(&central).filter(|(_, central)| **central) {
                if let Some(hand) = hand_of(geom) {
                    found[hand] = true;
                }
            }
            for (hand, _) in found.iter().enumerate().filter(|(_, found)| **found) {
                shares[2 * eye + hand] += 1.0 / count as f64;
            }
        }
    }
    Ok(Some(shares.into()))
}

/// Returns which pixels of an image are within the central field of view.
fn central(height: usize, width: usize, fovy: f64) -> Vec<bool> {
    let focal = 0.5 * height as f64 / pxfm::f_tan(0.5 * fovy.to_radians());
    let limit = focal * pxfm::f_tan(FIELD_OF_VIEW.to_radians());
    let from_middle = |k: usize, n: usize| k as f64 + 0.5 - 0.5 * n as f64;
    let inside = |k: usize| {
        let (y, x) = (from_middle(k / width, height), from_middle(k % width, width));
        x * x + y * y < limit * limit
    };
    (0..height * width).map(inside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_central_field_is_a_disc() {
        let central = central(64, 64, 60.0);
        let number = central.iter().filter(|central| **central).count() as f64;
        // radius 32 tan(15) / tan(30) pixels
        let radius: f64 = 32.0 * 0.267_949 / 0.577_350;
        assert!(
            (number - std::f64::consts::PI * radius * radius).abs() < 0.05 * number,
            "{number}"
        );
        assert!(central[32 * 64 + 32] && !central[0]);
    }
}

//! Positions of points in the pictures of cameras.

use std::f64::consts::PI;

use crate::math::*;
use crate::model::Model;
use crate::state::State;

/// Returns the position of a site in the picture of a camera, pixels to the right and down from the upper left corner, padded with
/// zeros.
pub(super) fn projection(model: &Model, s: &State, site: usize, camera: usize) -> [f64; 4] {
    let [x, y, z] = mat_t_vec(&s.cam_xmat[camera], sub(s.site_xpos[site], s.cam_xpos[camera]));
    let [width, height] = model.cam_resolution[camera].map(|pixels| pixels as f64);
    let ([wide, high], [fx, fy, ..]) = (model.cam_sensorsize[camera], model.cam_intrinsic[camera]);
    // as in MuJoCo the principal point does not count
    let [across, down] = if wide != 0.0 && high != 0.0 {
        [
            f64::from((fx / wide) as f32) * width,
            f64::from((fy / high) as f32) * height,
        ]
    } else {
        [0.5 / pxfm::f_tan(model.cam_fovy[camera] * PI / 360.0) * height; 2]
    };
    // never a division by nearly zero; the camera looks along -z
    let depth = match z {
        z if z.abs() >= MINVAL => z,
        z if z < 0.0 => -MINVAL,
        _ => MINVAL,
    };
    [
        (0.5 * width * z - across * x) / depth,
        (0.5 * height * z + down * y) / depth,
        0.0,
        0.0,
    ]
}

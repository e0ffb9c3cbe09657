//! Notices about requests of a configuration that cannot be met.

use super::Blueprint;
use crate::sensors::EYES;
use crate::sensors::transform::acuity_cutoff;

impl Blueprint {
    /// Returns what the configuration asks for and cannot have, a sentence each: images that are too small for the acuity of the eyes,
    /// so that it is the number of pixels that limits what MIMo sees.
    pub fn notices(&self) -> Vec<String> {
        let (config, model) = (self.config(), self.model());
        if !config.vision_active {
            return Vec::new();
        }
        let ages = config.eyes.ages(config.age);
        let limited = EYES.iter().zip(ages).filter_map(|(eye, age)| {
            let (age, camera) = (age?, model.camera(eye)?);
            let (pixels, fovy, cutoff) = (config.vision_resolution, model.cam_fovy[camera], acuity_cutoff(age));
            let held = 0.5 * f64::from(pixels) / fovy;
            let needed = (2.0 * cutoff * fovy).ceil();
            (held < cutoff).then(|| {
                format!(
                    "{pixels} pixels over {fovy} degrees hold at most {held:.2} cycles per degree, and at {age} months an eye sees up to \
                     {cutoff:.2}: older and younger eyes look alike beyond that; vision_resolution: {needed} holds all of it"
                )
            })
        });
        let mut notices: Vec<String> = limited.collect();
        notices.dedup();
        notices
    }
}

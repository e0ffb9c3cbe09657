//! Notices about requests of a configuration that cannot be fulfilled.

use super::Blueprint;
use crate::sensors::EYES;
use crate::sensors::transform::acuity_cutoff;

impl Blueprint {
    /// Returns a sentence for each request of the configuration that cannot be fulfilled: images too small for the acuity of the eyes, so that
    /// the number of pixels limits what MIMo sees.
    pub fn notices(&self) -> Vec<String> {
        let (config, model) = (self.config(), self.model());
        if !config.vision_active {
            return Vec::new();
        }
        let ages = config.eyes.ages(config.age);
        let limited = EYES.iter().zip(ages).enumerate().filter_map(|(eye, (name, age))| {
            let (age, camera) = (age?, model.camera(name)?);
            let [_, pixels] = config.eye_sizes()[eye];
            let (fovy, cutoff) = (model.cam_fovy[camera], acuity_cutoff(age));
            // a cycle needs two pixels
            let held = 0.5 * pixels as f64 / fovy;
            let needed = (2.0 * cutoff * fovy).ceil();
            let square = config.eye_sizes() == [[config.vision_resolution as usize; 2]; 2];
            let key = if square { "vision_resolution" } else { "vision_height" };
            (held < cutoff).then(|| {
                format!(
                    "{pixels} pixels over {fovy} degrees hold at most {held:.2} cycles per degree, and at {age} months an eye sees up to \
                     {cutoff:.2}: older and younger eyes look alike beyond that; {key}: {needed} holds all of it"
                )
            })
        });
        let mut notices: Vec<String> = limited.collect();
        notices.dedup();
        notices
    }
}

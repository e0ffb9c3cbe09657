//! The images of the eyes that are observed.

use super::choices::VisionOutput;

/// A set of images of each eye (`vision_outputs`); a list in a file.
///
/// ```
/// use babybench::config::{VisionOutput, VisionOutputs};
/// use babybench::Config;
///
/// let config = Config::from_yaml("vision_outputs: [rgb, depth]", "example.yml")?;
/// assert_eq!(config.vision_outputs, VisionOutputs::new([VisionOutput::Depth, VisionOutput::Rgb]));
/// assert!(!config.vision_outputs.contains(VisionOutput::Gray));
/// # Ok::<(), babybench::config::ConfigError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VisionOutputs([bool; VisionOutput::ALL.len()]);

impl Default for VisionOutputs {
    /// Returns colour alone.
    fn default() -> Self {
        Self::new([VisionOutput::Rgb])
    }
}

impl VisionOutputs {
    /// Creates a set.
    pub fn new(outputs: impl IntoIterator<Item = VisionOutput>) -> Self {
        let mut set = Self([false; VisionOutput::ALL.len()]);
        for output in outputs {
            set.0[output as usize] = true;
        }
        set
    }

    /// Returns whether an image is among them.
    pub const fn contains(self, output: VisionOutput) -> bool {
        self.0[output as usize]
    }

    /// Lists them in the order of [`VisionOutput::ALL`].
    pub fn iter(self) -> impl Iterator<Item = VisionOutput> {
        VisionOutput::ALL
            .iter()
            .copied()
            .filter(move |&output| self.contains(output))
    }

    /// Creates a set from names; `None` if one is unknown.
    pub(super) fn from_names(names: &[&str]) -> Option<Self> {
        let outputs: Option<Vec<_>> = names.iter().map(|name| VisionOutput::from_name(name)).collect();
        Some(Self::new(outputs?))
    }
}

//! Prints the size of an observation that is sent between machines, in bytes, unpacked and packed: touch as the active sensors (their numbers and
//! forces), pictures as PNG, which is lossless. The rest is unchanged.

use babybench::config::VisionOutput;
use babybench::sensors::transform::Sense;
use babybench::spaces::Values;
use babybench::{Config, Env};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};

/// BabyBench's three configurations, by name.
const EXAMPLES: [(&str, &str); 3] = [
    ("self_touch", include_str!("../configs/config_selftouch.yml")),
    ("hand_regard", include_str!("../configs/config_handregard.yml")),
    (
        "test_installation",
        include_str!("../configs/config_test_installation.yml"),
    ),
];
/// Steps of an episode, and episodes, over which the mean is taken.
const STEPS: usize = 100;
const EPISODES: u64 = 3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("| configuration | numbers | touch | touch, packed | both eyes | both eyes, packed | all | all, packed |");
    println!("|---|--:|--:|--:|--:|--:|--:|--:|");
    for (name, text) in EXAMPLES {
        let mut env = Env::new(Config::from_yaml(text, name)?)?;
        let (mut sizes, mut action) = (Sizes::default(), Vec::new());
        for seed in 0..EPISODES {
            env.reset(Some(seed))?;
            for _ in 0..STEPS {
                env.sample_action(&mut action);
                env.step(&action)?;
                sizes.add(&env)?;
            }
        }
        sizes.print(name);
    }
    Ok(())
}

/// Bytes of the observations so far.
#[derive(Default)]
struct Sizes {
    numbers: usize,
    touch: [usize; 2],
    eyes: [usize; 2],
    observations: usize,
}

impl Sizes {
    fn add(&mut self, env: &Env) -> Result<(), Box<dyn std::error::Error>> {
        for (entry, values) in env.observation().entries() {
            match (entry.sense, entry.image, values) {
                (Some(Sense::Touch), ..) => {
                    let felt = env.senses().touch_observed().ok_or("touch is observed")?;
                    self.touch[0] += size_of_val(felt.values());
                    // two bytes identify the sensor
                    self.touch[1] += felt.touched().len() * (2 + 4 * felt.width());
                }
                (_, Some(VisionOutput::Rgb), Values::U8(eye)) => {
                    let side = env.config().vision_resolution;
                    let mut packed = Vec::new();
                    PngEncoder::new(&mut packed).write_image(eye, side, side, ExtendedColorType::Rgb8)?;
                    self.eyes[0] += eye.len();
                    self.eyes[1] += packed.len();
                }
                _ => self.numbers += values.len() * values.dtype().bytes(),
            }
        }
        self.observations += 1;
        Ok(())
    }

    fn print(&self, name: &str) {
        let mean = |bytes: usize| bytes / self.observations.max(1);
        let [touch, touch_packed] = self.touch.map(mean);
        let [eyes, eyes_packed] = self.eyes.map(mean);
        let numbers = mean(self.numbers);
        let (all, packed) = (numbers + touch + eyes, numbers + touch_packed + eyes_packed);
        println!("| {name} | {numbers} | {touch} | {touch_packed} | {eyes} | {eyes_packed} | {all} | {packed} |");
    }
}

//! Shared by the integration tests.
#![allow(dead_code)] // each test binary uses its part

pub mod milestones;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use babybench::assets::MemoryAssets;
use babybench::config::{Behavior, BodyParts, Scene};
use babybench::mjcf_loader::load_str;
use babybench::physics::{State, compile};
use babybench::runs::complete_scene;
use babybench::{Blueprint, Config, Env, Model};

/// The example configurations: name, text.
pub const EXAMPLES: [(&str, &str); 3] = [
    ("self_touch", include_str!("../../configs/config_selftouch.yml")),
    ("hand_regard", include_str!("../../configs/config_handregard.yml")),
    (
        "test_installation",
        include_str!("../../configs/config_test_installation.yml"),
    ),
];

/// The scene of pictures: all default senses but touch, MIMo v2 among the cubes and v1 elsewhere.
pub fn seen(scene: Scene) -> Config {
    Config {
        behavior: if scene == Scene::Cubes {
            Behavior::HandRegard
        } else {
            Behavior::None
        },
        scene,
        touch_active: false,
        ..Config::default()
    }
}

/// Models: MIMo's version by its behavior, and the scene.
pub const MODELS: [(Behavior, Scene); 6] = [
    (Behavior::None, Scene::Base),
    (Behavior::None, Scene::Crib),
    (Behavior::None, Scene::Cubes),
    (Behavior::HandRegard, Scene::Base),
    (Behavior::HandRegard, Scene::Crib),
    (Behavior::HandRegard, Scene::Cubes),
];

/// An example configuration as it stands in its file.
pub fn example(name: &str) -> Config {
    let (_, text) = EXAMPLES.iter().find(|e| e.0 == name).expect("the name of an example");
    Config::from_yaml(text, name).expect("the examples are valid")
}

/// An example configuration with proprioception and balance as its only senses.
pub fn body_only(name: &str) -> Config {
    Config {
        vision_active: false,
        touch_active: false,
        ..example(name)
    }
}

/// An infant of three months whose senses have every transform that there is, with all images.
pub fn infant() -> Config {
    let text = "behavior: self_touch\nscene: crib\nage: 3\ntouch_scale: 2\nvision_resolution: 24\n\
                vision_outputs: [rgb, gray, depth, segmentation]\ndelay_unit: ms\ndelay_sensory: 15\ndelay_vision: 20\n\
                delay_motor: 10\nnoise_proprioception: 0.01\nnoise_touch: 0.1\nnoise_vestibular: 0.05\nnoise_vision: 4\n\
                vision_acuity: true\nvision_acuity_left: 1.5\nvision_foveation: 10\nvision_foveation_right: 2\n\
                touch_pooled: true\npain_active: true\npain_threshold: 0.5\npain_decay_old: 0.9\npain_limit: 3\n\
                vision_rate: 90\ntouch_rate: 130\nmax_episode_steps: 20\n\
                reflexes: by_age\nreflex_observed: true";
    Config::from_yaml(text, "infant").expect("it is valid")
}

/// Everything actuated, nothing locked, proprioception and balance as the only senses.
pub fn free(behavior: Behavior, scene: Scene) -> Config {
    Config {
        behavior,
        scene,
        vision_active: false,
        touch_active: false,
        act: BodyParts::all(true),
        lock: BodyParts::all(false),
        ..Config::default()
    }
}

/// The model of a configuration's scene whose text was changed; every tag of the text stands on a line of its own.
pub fn edited(config: &Config, edit: impl FnOnce(String) -> String) -> Model {
    let scene = complete_scene(config).expect("the embedded assets load");
    let mut assets = MemoryAssets::new();
    for (path, file) in scene.files {
        assets.insert(&path, file).expect("a relative path");
    }
    let spec = load_str(&edit(scene.xml), "scene.xml", &assets);
    spec.and_then(compile).expect("the scene compiles")
}

/// A fresh environment, not reset.
pub fn env(config: Config) -> Env {
    Env::new(config).expect("the configuration is available")
}

/// A blueprint.
pub fn blueprint(config: Config) -> Blueprint {
    Blueprint::new(config).expect("the configuration is available")
}

/// `n` steps with random actions.
pub fn random_steps(env: &mut Env, n: usize) {
    let mut action = Vec::new();
    for _ in 0..n {
        env.sample_action(&mut action);
        env.step(&action).expect("no divergence");
    }
}

/// `n` steps with random actions, each held for `hold` steps.
pub fn held_steps(env: &mut Env, n: usize, hold: usize) {
    let mut action = Vec::new();
    for _ in 0..n / hold {
        env.sample_action(&mut action);
        repeat(env, &action, hold);
    }
}

/// `n` steps with the same action.
pub fn repeat(env: &mut Env, action: &[f32], n: usize) {
    for _ in 0..n {
        env.step(action).expect("no divergence");
    }
}

/// Everything in a state, to the bit: `Debug` prints numbers so that they read back equal.
pub fn bits(s: &State) -> String {
    format!("{s:?}")
}

/// Fails with a short message, unlike `assert_eq!` on two long texts.
pub fn assert_same_bits(a: &State, b: &State, what: &str) {
    let (a, b) = (bits(a), bits(b));
    if a != b {
        let at = a.bytes().zip(b.bytes()).position(|(x, y)| x != y).unwrap_or(0);
        let field = a[..at]
            .rfind(": [")
            .map_or("", |i| &a[a[..i].rfind(' ').map_or(0, |k| k + 1)..i]);
        panic!("{what}: states differ, first in or near `{field}`");
    }
}

/// FNV-1a over the bits of numbers.
#[derive(Clone, Copy)]
pub struct Fnv(pub u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    pub fn add(&mut self, values: &[f64]) {
        for byte in values.iter().flat_map(|v| v.to_bits().to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

/// Largest absolute value, NaN if there is one.
pub fn max_abs<'a>(values: impl IntoIterator<Item = &'a f64>) -> f64 {
    values
        .into_iter()
        .fold(0.0, |m, v| if v.is_nan() || v.abs() > m { v.abs() } else { m })
}

/// A line of `/proc/self/status` in MiB, such as `VmHWM`; `None` off Linux.
pub fn proc_status_mib(key: &str) -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = text.lines().find(|l| l.split(':').next() == Some(key))?;
    let kib: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib / 1024.0)
}

/// A folder of its own, gone at the end of the test.
pub struct Folder(PathBuf);

impl Folder {
    /// Not made yet; its name starts with `name`.
    pub fn new(name: &str) -> Self {
        static NEXT: AtomicUsize = AtomicUsize::new(0);
        let (process, number) = (std::process::id(), NEXT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(format!("babybench_{name}_{process}_{number}"));
        let _ = std::fs::remove_dir_all(&path);
        Self(path)
    }

    pub fn path(&self) -> &Path {
        &self.0
    }

    pub fn text(&self) -> String {
        self.0.display().to_string()
    }

    /// Writes a file, and returns its path.
    pub fn file(&self, name: &str, contents: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        std::fs::write(&path, contents).expect("a file");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

//! MuJoCo's results for the six models, in `data/reference_*.npz`; `scripts/reference_states.py` writes and describes them.

use std::sync::Arc;

use babybench::Model;
use babybench::config::{Behavior, Config, Scene};
use babybench::formats::npz::{Array, Npz};
use babybench::mimo::{Version, build_model, embedded};
use babybench::physics::{SoftEngine, SoftOptions};

use crate::data;

/// A model and what MuJoCo computes for it.
pub struct Reference {
    /// Version and scene, such as `v1_base`.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// Our model, with all actuators.
    pub model: Arc<Model>,
    npz: Npz,
}

impl Reference {
    /// Loads the references of both versions of MIMo in all scenes.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for behavior in [Behavior::None, Behavior::HandRegard] {
            for scene in Scene::BABYBENCH.iter().cloned() {
                let config = Config {
                    behavior,
                    scene: scene.clone(),
                    ..Config::default()
                };
                let name = format!("{}_{scene}", Version::of(behavior).name());
                let npz = data::npz(&format!("reference_{name}.npz"));
                let model = Arc::new(build_model(&config, &embedded()).expect("the embedded assets load"));
                all.push(Self {
                    name,
                    scene,
                    model,
                    npz,
                });
            }
        }
        all
    }

    /// Builds an engine that counts the torque of welds as MuJoCo does.
    pub fn engine(&self, disable_contacts: bool) -> SoftEngine {
        let options = SoftOptions {
            double_weld_torque: true,
            disable_contacts,
            ..SoftOptions::default()
        };
        SoftEngine::new(self.model.clone(), options)
    }

    /// Returns one of MuJoCo's arrays.
    pub fn array(&self, name: &str) -> Array<f64> {
        self.npz.get_f64(name).expect("an array of the data")
    }

    /// Returns the rows of one of MuJoCo's arrays: its values for each value of the first index.
    pub fn rows(&self, name: &str) -> Vec<Vec<f64>> {
        let Array { shape, data } = self.array(name);
        let n = shape[1..].iter().product::<usize>().max(1);
        data.chunks(n).map(<[f64]>::to_vec).collect()
    }
}

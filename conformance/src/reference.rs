//! MuJoCo's results for the six models, in `data/reference_*.npz`; `scripts/reference_states.py` writes them and says
//! what is in them.

use std::path::Path;
use std::sync::Arc;

use babybench::Model;
use babybench::config::{Behavior, Config, Scene};
use babybench::mimo::{Version, build_model, embedded};
use babybench::npz::{Array, Npz};
use babybench::physics::{SoftEngine, SoftOptions};

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
    /// Both versions of MIMo in all scenes.
    pub fn all() -> Vec<Self> {
        let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("data");
        let mut all = Vec::new();
        for behavior in [Behavior::None, Behavior::HandRegard] {
            for &scene in Scene::ALL {
                let config = Config {
                    behavior,
                    scene,
                    ..Config::default()
                };
                let name = format!("{}_{scene}", Version::of(behavior).name());
                let npz = Npz::open(data.join(format!("reference_{name}.npz"))).expect("committed data");
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

    /// An engine that counts the torque of welds as MuJoCo does.
    pub fn engine(&self, disable_contacts: bool) -> SoftEngine {
        let options = SoftOptions {
            double_weld_torque: true,
            disable_contacts,
            ..SoftOptions::default()
        };
        SoftEngine::new(self.model.clone(), options)
    }

    /// One of MuJoCo's arrays.
    pub fn array(&self, name: &str) -> Array<f64> {
        self.npz.get_f64(name).expect("an array of the data")
    }

    /// The rows of one of MuJoCo's arrays: its values for each value of the first index.
    pub fn rows(&self, name: &str) -> Vec<Vec<f64>> {
        let Array { shape, data } = self.array(name);
        let n = shape[1..].iter().product::<usize>().max(1);
        data.chunks(n).map(<[f64]>::to_vec).collect()
    }
}

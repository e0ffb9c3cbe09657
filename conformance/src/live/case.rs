//! The scenes that are compared.

use std::sync::Arc;

use babybench::Model;
use babybench::config::{Behavior, BodyParts, Config, Part, Scene};
use babybench::mimo::{DOCUMENT, Version, build_model, embedded, lock, scene_xml};
use babybench::mjcf_loader::load_str;
use babybench::physics::{Engine, Params, Shared, SoftEngine, SoftOptions, compile};
use babybench::rapier::{RapierEngine, RapierOptions};

use crate::mujoco::{Mujoco, Release, Simulation};

/// An engine that is compared.
#[derive(Clone, Copy)]
pub struct Subject {
    /// The value of the configuration's key `engine`.
    pub name: &'static str,
    /// Builds it for a scene.
    pub make: fn(&Case) -> Box<dyn Engine>,
}

/// All engines.
pub const SUBJECTS: &[Subject] = &[
    Subject {
        name: "soft",
        make: Case::soft,
    },
    Subject {
        name: "rapier",
        make: Case::rapier,
    },
];

/// Returns the three example configurations with their names.
pub fn example_configs() -> [(&'static str, Config); 3] {
    let read = |name, text| (name, Config::from_yaml(text, name).expect("the examples are valid"));
    [
        read(
            "test_installation",
            include_str!("../../../configs/config_test_installation.yml"),
        ),
        read("selftouch", include_str!("../../../configs/config_selftouch.yml")),
        read("handregard", include_str!("../../../configs/config_handregard.yml")),
    ]
}

/// A version of MIMo in a scene.
#[derive(Clone)]
pub struct Case {
    /// Version and scene, such as `v1_base`.
    pub name: String,
    /// Its configuration.
    pub config: Config,
    /// Our model.
    pub model: Arc<Model>,
    /// Parameters at the start: those of the model and the configuration's locks.
    pub params: Shared<Params>,
}

impl Case {
    /// Builds the case of a configuration.
    pub fn new(name: String, config: Config) -> Self {
        let model = Arc::new(build_model(&config, &embedded()).expect("the embedded assets load"));
        let mut params = Params::new(&model);
        for part in Part::ALL {
            if config.lock.get(part) {
                lock(&model, &mut params, part.into(), 0.0).expect("MIMo's joints have locks");
            }
        }
        Self {
            name,
            config,
            model,
            params: params.into(),
        }
    }

    /// Returns both versions of MIMo in all scenes, everything actuated and nothing locked.
    pub fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for behavior in [Behavior::None, Behavior::HandRegard] {
            for scene in Scene::BABYBENCH.iter().cloned() {
                let (act, lock) = (BodyParts::all(true), BodyParts::all(false));
                let name = format!("{}_{scene}", Version::of(behavior).name());
                let config = Config {
                    behavior,
                    scene,
                    act,
                    lock,
                    ..Config::default()
                };
                all.push(Self::new(name, config));
            }
        }
        all
    }

    /// Returns both versions in all scenes, actuated and locked as in the example configurations.
    ///
    /// v1 follows `test_installation` in the base scene and `selftouch` elsewhere; v2 follows `handregard`.
    pub fn examples() -> Vec<Self> {
        let mut all = Vec::new();
        for (_, example) in example_configs() {
            for scene in Scene::BABYBENCH.iter().cloned() {
                let version = Version::of(example.behavior);
                if version == Version::V1 && (example.scene == Scene::Base) != (scene == Scene::Base) {
                    continue;
                }
                let name = format!("{}_{scene}", version.name());
                let config = Config {
                    scene,
                    ..example.clone()
                };
                all.push(Self::new(name, config));
            }
        }
        all
    }

    /// Writes the top document and the unchanged embedded assets to a temporary folder for MuJoCo.
    fn with_files<T>(&self, load: impl FnOnce(&str) -> Result<T, String>) -> Result<T, String> {
        let folder = tempfile::tempdir().map_err(|e| format!("no temporary folder: {e}"))?;
        let xml = scene_xml(&self.config);
        for (name, content) in embedded().0.iter().copied().chain([(DOCUMENT, xml.as_bytes())]) {
            let path = folder.path().join(name);
            let parent = path.parent().unwrap_or(folder.path());
            let written = std::fs::create_dir_all(parent).and_then(|()| std::fs::write(&path, content));
            written.map_err(|e| format!("{}: {e}", path.display()))?;
        }
        load(&folder.path().join(DOCUMENT).to_string_lossy())
    }

    /// Loads the scene into MuJoCo 3.3.0, at `qpos0` with the initial parameters.
    ///
    /// # Errors
    /// MuJoCo's message.
    pub fn simulation(&self, api: &'static Mujoco) -> Result<Simulation, String> {
        let mut simulation = self.with_files(|path| Simulation::new(api, path, &[]))?;
        simulation.set_params(&self.model, &self.params);
        Ok(simulation)
    }

    /// Loads the scene into another release.
    ///
    /// # Errors
    /// MuJoCo's message.
    pub fn release(&self, api: &'static Mujoco, version: &str) -> Result<Release, String> {
        self.with_files(|path| Release::new(api, version, path))
    }

    /// Builds our default engine on the scene, counting the torque of welds as MuJoCo does.
    pub fn soft(&self) -> Box<dyn Engine> {
        self.soft_with(self.model.clone())
    }

    /// Compiles our model with other options, given as attributes of an `option` element.
    pub fn model_with(&self, option: &str) -> Arc<Model> {
        let xml = scene_xml(&self.config).replace("</mujoco>", &format!("<option {option}/></mujoco>"));
        let spec = load_str(&xml, DOCUMENT, &embedded()).expect("the embedded assets load");
        Arc::new(compile(spec).expect("the scenes compile"))
    }

    /// Builds our default engine on another model, such as this one with other tolerances.
    pub fn soft_with(&self, model: Arc<Model>) -> Box<dyn Engine> {
        let options = SoftOptions {
            double_weld_torque: true,
            ..SoftOptions::default()
        };
        Box::new(SoftEngine::new(model, options))
    }

    /// Builds an engine that steps the same model in Rapier's own pipeline.
    pub fn rapier(&self) -> Box<dyn Engine> {
        let options = RapierOptions {
            double_weld_torque: true,
            ..RapierOptions::default()
        };
        Box::new(RapierEngine::new(self.model.clone(), options).expect("MIMo fits Rapier's multibodies"))
    }

    /// Lists the degrees of freedom of objects other than MIMo.
    pub fn object_dofs(&self) -> Vec<usize> {
        let m = &self.model;
        let of_object = |&d: &usize| m.jnt_name[m.dof_jntid[d]].is_empty();
        (0..m.nv).filter(of_object).collect()
    }
}

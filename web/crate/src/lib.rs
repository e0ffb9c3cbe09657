//! babybench for JavaScript. The classes here are the lowest layer: numbers and pointers. The package's `babybench.js`
//! wraps them in views that stay valid, and its types are what users read.
#![forbid(unsafe_code)]

mod env;
mod faces;
mod frame;
mod js;
mod keys;
mod noise;
mod numbers;
mod scene;
mod task;

use babybench::Config;
use babybench::assets::{MemoryAssets, Overlay};
use babybench::env::BlueprintOptions;
use babybench::mimo::embedded;
use faces::Faces;
use js_sys::Uint8Array;
use wasm_bindgen::prelude::*;

/// Lists the configuration keys: name, section, kind, allowed values, default, meaning.
#[wasm_bindgen(js_name = configKeys)]
pub fn config_keys() -> JsValue {
    keys::keys()
}

/// The part that all environments of one configuration share.
#[wasm_bindgen]
pub struct Blueprint(babybench::Blueprint);

#[wasm_bindgen]
impl Blueprint {
    /// Builds the scene of a configuration in YAML. Errors name `name` as its file. A custom scene is searched for among the caller's
    /// files, by path, which override those of the library.
    #[wasm_bindgen(constructor)]
    pub fn new(yaml: &str, name: &str, paths: Vec<String>, contents: Vec<Uint8Array>) -> Result<Blueprint, JsValue> {
        let mut config = Config::from_yaml(yaml, name).map_err(|e| js::config_error(&e))?;
        // a page without pictures defers them, so its arrays hold the last observation
        config.vision_lazy = false;
        let mut files = MemoryAssets::new();
        for (path, bytes) in paths.iter().zip(contents) {
            files.insert(path, bytes.to_vec()).map_err(js::error)?;
        }
        let options = BlueprintOptions::default().with_assets(Overlay::new(embedded()).with(Faces).with(files));
        babybench::Blueprint::with(config, options)
            .map(Self)
            .map_err(|e| js::env_error(&e))
    }

    /// Makes an environment.
    pub fn env(&self) -> Result<env::Core, JsValue> {
        env::Core::new(&self.0)
    }

    /// Returns the complete configuration as YAML.
    #[wasm_bindgen(js_name = toYaml)]
    pub fn to_yaml(&self) -> String {
        self.0.config().to_yaml()
    }

    /// Lists the values of the configuration by key.
    pub fn config(&self) -> JsValue {
        keys::values(self.0.config())
    }
}

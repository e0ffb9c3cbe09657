//! babybench for JavaScript. The classes here are the lowest layer: numbers and pointers. The package's `babybench.js`
//! wraps them in views that stay valid, and its types are what users read.
#![forbid(unsafe_code)]

mod env;
#[path = "../../../examples/checksum/fold.rs"]
mod fold;
mod frame;
mod js;
mod keys;
mod numbers;
mod scene;
mod task;

use babybench::Config;
use wasm_bindgen::prelude::*;

/// Lists the configuration keys: name, section, kind, what is allowed, default, meaning.
#[wasm_bindgen(js_name = configKeys)]
pub fn config_keys() -> JsValue {
    keys::keys()
}

/// What all environments of one configuration share.
#[wasm_bindgen]
pub struct Blueprint(babybench::Blueprint);

#[wasm_bindgen]
impl Blueprint {
    /// Builds the scene of a configuration in YAML; `name` stands for its file in errors.
    #[wasm_bindgen(constructor)]
    pub fn new(yaml: &str, name: &str) -> Result<Blueprint, JsValue> {
        let config = Config::from_yaml(yaml, name).map_err(|e| js::config_error(&e))?;
        babybench::Blueprint::new(config)
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

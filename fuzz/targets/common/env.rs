//! An environment that costs little.

use babybench::{Config, Env};

/// Returns an environment without touch and eyes, after a reset.
pub fn env() -> Env {
    let config = Config { touch_active: false, vision_active: false, ..Config::default() };
    let mut env = Env::new(config).expect("the default scene");
    env.reset(Some(0)).expect("a reset");
    env
}

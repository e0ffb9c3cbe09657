//! Configurations: what is accepted is valid and survives being written; what is refused says where.
#![no_main]

use babybench::Config;
use babybench::runs::read_config;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(text) = std::str::from_utf8(data) else { return };
    match Config::from_yaml(text, "fuzz.yml") {
        Ok(config) => {
            config.validate().expect("what is accepted is valid");
            let again = Config::from_yaml(&config.to_yaml(), "again.yml").expect("it reads what it writes");
            assert!(again == config, "written and read: another configuration");
        }
        Err(e) => {
            let said = e.to_string();
            assert!(said.starts_with("fuzz.yml"), "{said}");
            assert!(said.len() < 4000, "{} bytes: {said}", said.len());
            assert!(!said.chars().any(char::is_control), "{said:?}");
        }
    }
    // the comment at the top of a scene
    let _ = read_config(text);
});

//! The recordings themselves: every archive and every configuration is read whole.

use babybench::config::{Compat, Config, ConfigReader};
use conformance::data;
use testkit::harness::Trial;
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![
        archives_of_the_reference_are_read,
        configurations_of_the_recordings_load
    ]
}

fn archives_of_the_reference_are_read() {
    let (mut files, mut values) = (0, 0);
    for folder in ["recordings", "touch", "."] {
        for name in data::names(folder, ".npz") {
            let npz = data::npz(&format!("{folder}/{name}.npz"));
            for array in npz.arrays() {
                let read = npz.get_f64(&array.name).expect("an array of numbers");
                let size = array.shape.iter().product::<usize>();
                assert_eq!(read.data.len(), size, "{name} {}", array.name);
                values += size;
            }
            files += 1;
        }
    }
    show!("{values} values in {files} archives");
    assert!(files > 20, "{files} archives");
    let npz = data::npz("recordings/base_v1_eyes.npz");
    assert_eq!(npz.get_u8("eye_left").expect("recorded").shape[1..], [64, 64, 3]);
    assert_eq!(npz.get_f64("qpos0").expect("recorded").shape, [54]);
}

fn configurations_of_the_recordings_load() {
    let names = data::names("recordings", ".yml");
    assert!(names.len() >= 8, "{names:?}");
    for name in names {
        let base = Config {
            compat: Compat::Reference,
            ..Config::default()
        };
        let config = ConfigReader::over(base)
            .read_text(&data::text(&format!("recordings/{name}.yml")), &name)
            .unwrap_or_else(|e| panic!("{e}"));
        let again = Config::from_yaml(&config.to_yaml(), &name).expect("what is written is read");
        assert_eq!(again, config, "{name}");
    }
}

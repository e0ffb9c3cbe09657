//! The kit's own example configurations beside ours.

use babybench::Config;
use testkit::harness::Trial;
use testkit::yardsticks::{KIT, kit, workspace};
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs KIT: our_examples_are_those_of_the_kit]
}

fn our_examples_are_those_of_the_kit() {
    let folder = kit().expect("needed").join("examples");
    for name in ["config_selftouch", "config_handregard", "config_test_installation"] {
        let read = |path: std::path::PathBuf| Config::from_file(path).unwrap_or_else(|e| panic!("{e}"));
        let ours = read(workspace().join(format!("configs/{name}.yml")));
        assert_eq!(ours, read(folder.join(format!("{name}.yml"))), "{name}");
        show!("{name}: equal");
    }
}

//! The tests that need a Python or a graphics adapter. What lacks it is reported as ignored, with the reason.

#[path = "../common/mod.rs"]
mod common;

mod policy;
#[cfg(feature = "wgpu")]
mod render_gpu;

use std::process::ExitCode;

fn main() -> ExitCode {
    let all = [
        policy::trials(),
        #[cfg(feature = "wgpu")]
        render_gpu::trials(),
    ];
    testkit::harness::run(all.concat())
}

//! Memory of several environments in one process.

mod common;

use babybench::Env;
use common::*;

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "reads /proc/self/status of Linux")]
fn three_environments_fit_in_64_mib() {
    let before = proc_status_mib("VmRSS").expect("Linux has /proc/self/status");
    let mut environments: Vec<Env> = EXAMPLES.iter().map(|(name, _)| env(example(name))).collect();
    for env in &mut environments {
        env.reset(Some(0)).expect("no divergence");
        random_steps(env, 50);
    }
    let (peak, now) = (
        proc_status_mib("VmHWM").unwrap_or(f64::NAN),
        proc_status_mib("VmRSS").unwrap_or(f64::NAN),
    );
    println!("resident: {before:.1} MiB at the start, {now:.1} MiB with three environments, at most {peak:.1} MiB");
    assert!(peak <= 64.0, "{peak:.1} MiB");
}

//! Clocks, and the comparison of two programs in turn.

use std::time::Instant;

/// First quartile, median, third quartile.
pub fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|q| values[(values.len() - 1) * q / 4])
}

/// Times two programs on the same actions in turn, `steps` steps of `envs` environments at a time, and prints how many times faster the second is.
pub fn pair(
    name: &str,
    [steps, envs]: [usize; 2],
    clock: fn() -> f64,
    actions: &[Vec<f32>],
    mut one: impl FnMut(&[f32]),
    mut other: impl FnMut(&[f32]),
) {
    let time = |program: &mut dyn FnMut(&[f32]), actions: &[Vec<f32>]| {
        let start = clock();
        actions.iter().for_each(|actions| program(actions));
        clock() - start
    };
    let (mut ratios, mut us) = (Vec::new(), [Vec::new(), Vec::new()]);
    for (k, actions) in actions.chunks_exact(steps).enumerate() {
        // the first side changes from pair to pair
        let times = if k % 2 == 0 {
            [time(&mut one, actions), time(&mut other, actions)]
        } else {
            let second = time(&mut other, actions);
            [time(&mut one, actions), second]
        };
        if k > 0 {
            ratios.push(times[0] / times[1]);
            us.iter_mut()
                .zip(times)
                .for_each(|(us, t)| us.push(t * 1e6 / (steps * envs) as f64));
        }
    }
    let [low, median, high] = quartiles(ratios);
    let [one, other] = us.map(|us| quartiles(us)[1]);
    println!("{name:60} {median:.3} times ({low:.3} .. {high:.3}); {one:8.1} and {other:8.1} us per step");
}

/// Returns the CPU time of this thread, s, if the system reports it, and the wall time otherwise.
pub fn cpu_time() -> f64 {
    #[cfg(any(target_os = "linux", target_os = "macos"))]
    return seconds(rustix::time::ClockId::ThreadCPUTime);
    #[cfg(not(any(target_os = "linux", target_os = "macos")))]
    return wall_time();
}

/// Returns the CPU time of all threads of the process, s, if the system reports it, and the wall time otherwise.
pub fn process_time() -> f64 {
    #[cfg(any(target_os = "linux", target_os = "macos"))]
    return seconds(rustix::time::ClockId::ProcessCPUTime);
    #[cfg(not(any(target_os = "linux", target_os = "macos")))]
    return wall_time();
}

/// Reads a clock, s.
#[cfg(any(target_os = "linux", target_os = "macos"))]
fn seconds(clock: rustix::time::ClockId) -> f64 {
    // counts as time passes; what /proc says is a timer's tick of four milliseconds old
    let time = rustix::time::clock_gettime(clock);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Returns the time since the first call, s.
pub fn wall_time() -> f64 {
    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Returns the resident memory of the process, MB, if the system reports it (Linux).
pub fn resident_memory() -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find_map(|l| l.strip_prefix("VmRSS:"));
    let kib = line
        .and_then(|l| l.split_whitespace().next())
        .and_then(|k| k.parse::<f64>().ok());
    kib.map_or(f64::NAN, |kib| kib * 1024.0 / 1e6)
}

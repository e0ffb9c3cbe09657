//! Facts about the machine and the program, as lines of a name and a value.

use std::env::consts::{ARCH, OS};
use std::fs;
use std::thread::available_parallelism;

/// Lists the facts, in the order in which they are printed.
pub fn facts() -> Vec<(&'static str, String)> {
    let profile = if cfg!(debug_assertions) {
        "not optimised"
    } else {
        "optimised"
    };
    let threads = available_parallelism().map_or_else(|e| format!("unknown: {e}"), |n| n.to_string());
    let mut facts = vec![
        (
            "babybench",
            format!("{} for {OS} on {ARCH}, {profile}", env!("CARGO_PKG_VERSION")),
        ),
        ("engine", "reproduces MuJoCo 3.3.0".to_owned()),
        ("system", system()),
        ("processor", processor()),
        ("instructions", instructions()),
        ("threads", threads),
    ];
    facts.extend(memory().map(|memory| ("memory", memory)));
    facts.extend(PARTS.map(|(name, present, meaning)| (name, part(name, present, meaning))));
    facts.extend(adapters().into_iter().map(|adapter| ("adapter", adapter)));
    facts
}

/// Optional parts: their cargo feature, whether this program has it, and what it adds.
const PARTS: [(&str, bool, &str); 3] = [
    ("onnx", cfg!(feature = "onnx"), "policies that are ONNX models"),
    ("rapier", cfg!(feature = "rapier"), "the engine `rapier`"),
    ("wgpu", cfg!(feature = "wgpu"), "pictures on a GPU"),
];

fn part(name: &str, present: bool, meaning: &str) -> String {
    if present {
        format!("yes: {meaning}")
    } else {
        format!("no: {meaning} need a program built with --features {name}")
    }
}

/// Returns the name and the version of the system, if a file of the system has them.
fn system() -> String {
    let release = fs::read_to_string("/etc/os-release").unwrap_or_default();
    let name = value_of(&release, "PRETTY_NAME", '=').map(|name| name.trim_matches('"').to_owned());
    let kernel = fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    let mut system = name.unwrap_or_else(|| OS.to_owned());
    if !kernel.trim().is_empty() {
        system = format!("{system}, kernel {}", kernel.trim());
    }
    system
}

/// Returns the name of the processor. Linux has it in a file, Windows in a variable; macOS only in a system call.
fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    value_of(&info, "model name", ':')
        .or_else(|| std::env::var("PROCESSOR_IDENTIFIER").ok())
        .unwrap_or_else(|| format!("{ARCH}, whose name the system does not publish"))
}

/// Lists the vector instructions by which the engine chooses its code. They do not change its results.
fn instructions() -> String {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    {
        let has = [
            ("AVX2", std::arch::is_x86_feature_detected!("avx2")),
            ("FMA", std::arch::is_x86_feature_detected!("fma")),
            ("AVX-512", std::arch::is_x86_feature_detected!("avx512f")),
        ];
        let names: Vec<_> = has
            .iter()
            .filter(|(_, present)| *present)
            .map(|(name, _)| *name)
            .collect();
        if names.is_empty() {
            "no AVX2".to_owned()
        } else {
            names.join(", ")
        }
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    {
        format!("those of every {ARCH}")
    }
}

/// Returns the machine's memory, where the system has it in a file.
fn memory() -> Option<String> {
    let info = fs::read_to_string("/proc/meminfo").ok()?;
    let kibibytes = |key| {
        value_of(&info, key, ':')?
            .trim_end_matches("kB")
            .trim()
            .parse::<u64>()
            .ok()
    };
    let gibibytes = |kib: u64| kib as f64 / f64::from(1 << 20);
    let (total, free) = (kibibytes("MemTotal")?, kibibytes("MemAvailable")?);
    Some(format!(
        "{:.1} GiB, {:.1} GiB available",
        gibibytes(total),
        gibibytes(free)
    ))
}

/// Returns the value of the first line `KEY SEPARATOR VALUE`.
fn value_of(text: &str, key: &str, separator: char) -> Option<String> {
    let mut pairs = text.lines().filter_map(|line| line.split_once(separator));
    let found = pairs.find(|(name, _)| name.trim() == key)?;
    Some(found.1.trim().to_owned())
}

#[cfg(feature = "wgpu")]
fn adapters() -> Vec<String> {
    let found = babybench::render::gpu::adapters();
    if found.is_empty() {
        return vec!["none: `renderer: wgpu` needs a driver for Vulkan, Metal, Direct3D 12 or OpenGL".to_owned()];
    }
    found
}

#[cfg(not(feature = "wgpu"))]
fn adapters() -> Vec<String> {
    vec!["not looked for: this program draws on the CPU only".to_owned()]
}

#[cfg(test)]
mod tests {
    use super::value_of;

    #[test]
    fn values_are_found_by_their_whole_key() {
        let text = "model name extra\t: no\nmodel name\t: A: 1\nmodel name\t: B\n";
        assert_eq!(value_of(text, "model name", ':').as_deref(), Some("A: 1"));
        assert_eq!(value_of(text, "model", ':'), None);
    }
}

//! Measures what MIMo can do at each age under both settings of `strength`, for the tables in `docs/guide/infant.md`. Keys set factors for groups of
//! joints; the ratios were calibrated with them.
//!
//! ```sh
//! cargo run --release --example milestones                        # all milestones
//! cargo run --release --example milestones -- strength_trunk 0.8  # with a factor on the trunk's strength
//! ```

#[path = "../tests/common/milestones.rs"]
mod milestones;

use babybench::Config;
use babybench::config::ConfigReader;
use babybench::mimo::Version;

/// Ages, months.
const AGES: [f64; 11] = [0.0, 1.0, 2.0, 3.0, 3.5, 4.0, 6.0, 9.0, 12.0, 18.0, 24.0];

/// A milestone: its description, and how it is measured.
type Milestone = (&'static str, fn(&Config) -> f64);

const MILESTONES: [Milestone; 4] = [
    ("head lag at 45 degrees in a pull to sit, degrees", |config| {
        milestones::pull_to_sit(config)[0]
    }),
    ("prone head lift held for 1 s, degrees", milestones::prone_head_lift),
    (
        "tilt at which the trunk gives way, degrees",
        milestones::supported_sitting,
    ),
    ("share of the weight carried by the legs", milestones::leg_support),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // keys with values, which replace those of `strength: infant`
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let mut keys = String::new();
    for pair in arguments.chunks(2) {
        let [name, value] = pair else {
            return Err("give keys with values: strength_trunk 0.8".into());
        };
        keys.push_str(&format!("{name}: {value}\n"));
    }
    if keys.is_empty() {
        keys.push_str("{}");
    }
    let ages = AGES.map(|age| format!("{age}")).join(" | ");
    println!("| | {ages} |\n|---|{}", "--:|".repeat(AGES.len()));
    for (what, measure) in MILESTONES {
        for version in [Version::V1, Version::V2] {
            for (setting, make) in [
                ("infant", milestones::infant as fn(_, _) -> _),
                ("volume", milestones::volume),
            ] {
                let mut values = Vec::new();
                for age in AGES {
                    let mut config: Config = make(version, age);
                    if setting == "infant" {
                        config = ConfigReader::over(config).read_text(&keys, "the arguments")?;
                    }
                    values.push(format!("{:.2}", measure(&config)));
                }
                println!("| {what}, {}, `{setting}` | {} |", version.name(), values.join(" | "));
            }
        }
    }
    Ok(())
}

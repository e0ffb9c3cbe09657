//! The table of costs.

use conformance::live::speed::{Speed, measure};
use conformance::live::{Case, Motion};
use conformance::mujoco::reference;

/// Prints the ratio of CPU times for the scenes whose name and motion contain `filter`.
///
/// # Errors
/// MuJoCo is missing or does not load a scene; the engine fails.
pub fn print(filter: &str, batches: usize) -> Result<(), String> {
    let cases = Case::examples();
    let rows = cases
        .iter()
        .flat_map(|case| [Motion::Random, Motion::Hold, Motion::Passive].map(|motion| (case, motion)));
    let mut rows = rows
        .filter(|(case, motion)| format!("{} {}", case.name, motion.name()).contains(filter))
        .peekable();
    if rows.peek().is_none() {
        return Ok(());
    }
    let api = reference()?;
    println!(
        "CPU time of a step over that of mj_step of MuJoCo 3.3.0: same states, same controls, sensors off, MuJoCo with the"
    );
    println!("model's own options. Quartiles over {batches} batches of 25 steps.\n");
    println!("| scene | motion | ratio p25 | ratio p50 | ratio p75 | ours us | MuJoCo us | contacts |");
    println!("|---|---|--:|--:|--:|--:|--:|--:|");
    for (case, motion) in rows {
        let speed = measure(api, case, &mut *case.soft(), motion, batches)?;
        let Speed {
            ratio: [p25, p50, p75],
            ours,
            mujoco,
            contacts,
            ..
        } = speed;
        println!(
            "| {} | {} | {p25:.2} | {p50:.2} | {p75:.2} | {ours:.0} | {mujoco:.0} | {contacts:.1} |",
            case.name,
            motion.name()
        );
    }
    println!();
    Ok(())
}

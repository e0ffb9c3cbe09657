//! Rollouts along MuJoCo 3.3.0's, with its own floor, and statistics of long ones.

use conformance::live::rollout::{Path, Plan, Rollout, at, paths, resting, rollouts};
use conformance::live::statistics::spreads;
use conformance::live::{Case, Motion};
use conformance::measure::{Summary, only_print};
use conformance::mujoco::{MUJOCO, Mujoco, needed};
use testkit::harness::{TIME, Trial};
use testkit::{show, trials};

pub fn trials() -> Vec<Trial> {
    trials![needs MUJOCO, TIME: rollouts_stay_within_three_floors, passive_motion_stays_within_ten_nanoradians, contacts_carry_the_weight_of_a_resting_mimo, statistics_of_long_rollouts_are_inside_the_spread_of_mujocos_seeds]
}

/// Optimised builds do the full numbers.
const FULL: bool = !cfg!(debug_assertions);

/// Number of rollouts that are beyond three floors at some step, and the number of floors that are beyond three of the
/// others. Where contact geometry jumps and where motion is chaotic both happen by chance.
fn beyond(rollouts: &[Rollout], steps: usize) -> [usize; 2] {
    let ours = |r: &&Rollout| (0..steps).any(|k| r.ours_at(k) > 3.0 * r.floor_at(k));
    let floors = |r: &Rollout| {
        let others = (r.floors.len() - 1) as f64;
        let far = |f: &&Vec<f64>| {
            let of_others = |k: usize| (r.floors.iter().map(|g| g[k]).sum::<f64>() - f[k]) / others;
            (0..steps).any(|k| f[k] > 3.0 * of_others(k))
        };
        r.floors.iter().filter(far).count()
    };
    [rollouts.iter().filter(ours).count(), rollouts.iter().map(floors).sum()]
}

/// The first step after which the median rollout is farther than three median floors.
fn fault(rollouts: &[Rollout], steps: usize) -> Option<String> {
    (0..steps).find_map(|k| {
        let [ours, floor] = at(rollouts, k);
        let good = ours.p50 <= 3.0 * floor.p50;
        (!good).then(|| format!("after {} steps {ours}, floor {floor}", k + 1))
    })
}

fn rollouts_stay_within_three_floors() {
    let api = needed();
    let mut missed = Vec::new();
    let mut total = [0; 4];
    let plans = [(Motion::Random, 300), (Motion::Sine, 300), (Motion::Hold, 100)];
    for case in Case::all() {
        for (motion, steps) in plans {
            let rollouts = if FULL { 3 } else { 1 };
            let plan = Plan {
                motion,
                steps,
                rollouts,
                floors: 3,
            };
            let paths = paths(api, &case, plan).expect("MuJoCo loads our scenes");
            let rollouts = follow(api, &case, plan, &paths);
            let what = format!("{} {}", case.name, motion.name());
            for k in [10, 30, 100, 300].into_iter().filter(|&k| k <= steps) {
                let [ours, floor] = at(&rollouts, k - 1);
                show!("{what} {k:3} steps: {ours}   floor {floor}");
            }
            let [ours, floors] = beyond(&rollouts, steps);
            let (n, m) = (rollouts.len(), plan.floors as usize * rollouts.len());
            show!("    beyond three floors at some step: {ours} of {n}; floors beyond three others: {floors} of {m}");
            total = [total[0] + ours, total[1] + n, total[2] + floors, total[3] + m];
            let failures = rollouts.iter().filter_map(|r| r.ours.failure.as_ref());
            missed.extend(failures.map(|f| format!("{what}: {f}")));
            missed.extend(fault(&rollouts, steps).map(|f| format!("{what}: {f}")));
        }
    }
    let [ours, n, floors, m] = total;
    show!("in all: {ours} of {n} rollouts beyond three floors, {floors} of {m} floors beyond three others");
    if ours * m > floors * n {
        missed.push(format!(
            "{ours} of {n} rollouts are beyond three floors, but only {floors} of {m} floors beyond three others"
        ));
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

fn follow(api: &'static Mujoco, case: &Case, plan: Plan, paths: &[Path]) -> Vec<Rollout> {
    rollouts(api, case, &Case::soft, plan, paths).expect("MuJoCo loads our scenes")
}

fn passive_motion_stays_within_ten_nanoradians() {
    let api = needed();
    let mut missed = Vec::new();
    for case in Case::all() {
        let steps = if FULL { 1000 } else { 200 };
        let plan = Plan {
            motion: Motion::Passive,
            steps,
            rollouts: 2,
            floors: 1,
        };
        let paths = paths(api, &case, plan).expect("MuJoCo loads our scenes");
        let rollouts = follow(api, &case, plan, &paths);
        for k in [100, 300, 1000].into_iter().filter(|&k| k <= plan.steps) {
            let [ours, floor] = at(&rollouts, k - 1);
            show!("{} passive {k:4} steps: {ours}   floor {floor}", case.name);
        }
        let worst = (0..steps).map(|k| at(&rollouts, k)[0].max).fold(0.0, f64::max);
        if worst.is_nan() || worst > 1e-8 {
            missed.push(format!("{}: {worst:e} rad", case.name));
        }
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

fn contacts_carry_the_weight_of_a_resting_mimo() {
    let api = needed();
    let mut missed = Vec::new();
    for case in Case::all() {
        let steps = if FULL { 12_000 } else { 200 };
        let r = resting(api, &case, &Case::soft, steps).expect("the engine runs");
        let (error, force, welds, weight) = (r.error(), r.contacts, r.welds, r.weight);
        let number = r.number;
        show!(
            "{}: {number} contacts {force} N, welds {welds} N, weight {weight} N: {error:.1e}",
            case.name
        );
        if FULL && (error.is_nan() || error > 1e-6) {
            missed.push(format!("{}: {error:.1e}", case.name));
        }
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

fn statistics_of_long_rollouts_are_inside_the_spread_of_mujocos_seeds() {
    let api = needed();
    let (seeds, steps) = if FULL { (8, 1000) } else { (3, 150) };
    let mut missed = Vec::new();
    for case in Case::all() {
        for s in spreads(api, &case, &Case::soft, seeds, steps).expect("both sides run") {
            let of = |values: &[f64]| Summary::new(values.iter().copied());
            let (ours, mujoco) = (of(&s.ours), of(&s.mujoco));
            show!("{} {:30} {ours}   MuJoCo {mujoco}", case.name, s.quantity);
            if !s.inside() {
                missed.push(format!("{} {}: {ours}, MuJoCo {mujoco}", case.name, s.quantity));
            }
        }
    }
    assert!(only_print() || missed.is_empty(), "{}", missed.join("\n"));
}

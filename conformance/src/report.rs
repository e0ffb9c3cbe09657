//! The table of distances to MuJoCo 3.3.0.

use std::fmt::Write as _;
use std::path::Path;

use conformance::example_runs::example_runs;
use conformance::live::one_step::one_step;
use conformance::live::rollout::{Plan, at, follow_release, paths, rollouts};
use conformance::live::statistics::spreads;
use conformance::live::{Case, Motion, SUBJECTS, Subject, parallel};
use conformance::measure::Summary;
use conformance::motion::{Drift, contact_free, settling};
use conformance::mujoco::{Mujoco, REFERENCE, fetched, reference};
use conformance::recordings::golden;
use conformance::reference::Reference;
use conformance::replays::{one_step as replay_steps, open_loop};
use conformance::statics::{Compared, Scale, States, constants};

use crate::plot::{Panel, draw};

const LEGEND: &str = "\
Live: MuJoCo 3.3.0 runs beside. Live step: from each of many states that MuJoCo visits (passive, random and sine controls, \
at rest, toppling objects), over states; the floor is MuJoCo against itself with its solver fully converged. Live rollouts: \
from the same state with the same controls, over rollouts; the floor is MuJoCo from a start 1e-7 rad away. Statistics: \
Kolmogorov-Smirnov distance of a long random run to MuJoCo's runs with other seeds, over seeds; the floor is MuJoCo's own. \
Rows of later MuJoCo releases stand beside. One step: every step of a recorded episode, each from the recorded state before \
it, over steps. Open loop: the episode replayed from its start; floor as above. No contacts, settled: over joints. \
State: over the recorded states. Relative errors are those of the largest value.

";

/// Steps after which an open-loop replay is evaluated.
const OPEN_LOOP: [usize; 3] = [30, 100, 300];

/// Steps after which a live rollout is evaluated.
const ROLLOUT: [usize; 4] = [10, 30, 100, 300];

struct Row {
    quantity: String,
    subject: String,
    engine: String,
    /// p50, p90 and max.
    figures: [Option<f64>; 3],
    /// The same for MuJoCo against itself.
    floor: [Option<f64>; 3],
}

#[derive(Default)]
struct Rows {
    rows: Vec<Row>,
    /// The engine of the rows that are added.
    engine: String,
}

impl Rows {
    fn add(&mut self, quantity: String, subject: &str, figures: [Option<f64>; 3], floor: [Option<f64>; 3]) {
        let (subject, engine) = (subject.to_string(), self.engine.clone());
        self.rows.push(Row {
            quantity,
            subject,
            engine,
            figures,
            floor,
        });
    }

    fn spread(&mut self, quantity: impl Into<String>, subject: &str, s: Summary) {
        self.add(quantity.into(), subject, three(s), [None; 3]);
    }

    fn beside(&mut self, quantity: impl Into<String>, subject: &str, s: Summary, floor: Summary) {
        self.add(quantity.into(), subject, three(s), three(floor));
    }

    fn single(&mut self, quantity: impl Into<String>, subject: &str, value: f64, floor: Option<f64>) {
        self.add(quantity.into(), subject, [None, None, Some(value)], [None, None, floor]);
    }

    /// Groups the rows by quantity, quantities in the order of their first row.
    fn grouped(self) -> Vec<Row> {
        let mut order: Vec<String> = Vec::new();
        for row in &self.rows {
            if !order.contains(&row.quantity) {
                order.push(row.quantity.clone());
            }
        }
        let mut rows = self.rows;
        rows.sort_by_key(|row| order.iter().position(|q| *q == row.quantity));
        rows
    }
}

fn three(s: Summary) -> [Option<f64>; 3] {
    [Some(s.p50), Some(s.p90), Some(s.max)]
}

/// Writes the table, with an explanation, as Markdown.
///
/// Without MuJoCo or the recordings beside the repository, the table contains what the rest yields and says what is
/// missing. Plots go to the folder `plots`.
pub fn table(states: usize, plots: Option<&Path>) -> Result<String, String> {
    let mut rows = Rows::default();
    let mut out = String::from(LEGEND);
    match reference() {
        Ok(api) => live(&mut rows, api, states, plots)?,
        Err(why) => out += &format!("Nothing was measured live: {why}.\n\n"),
    }
    rows.engine = "soft".to_string();
    recordings(&mut rows);
    let references = Reference::all();
    for reference in &references {
        motion(&mut rows, reference);
    }
    for run in example_runs() {
        settled(&mut rows, &run.name, &run.settled(&run.blueprint()));
    }
    for reference in &references {
        statics(&mut rows, reference);
    }
    out.push_str("| distance to MuJoCo 3.3.0 | scene / model | engine | p50 | p90 | max | floor p50 / p90 / max |\n");
    out.push_str("|---|---|---|--:|--:|--:|--:|\n");
    let number = |v: Option<f64>| match v {
        None => String::new(),
        Some(0.0) => "0".to_string(),
        Some(v) => format!("{v:.1e}"),
    };
    for row in rows.grouped() {
        let [p50, p90, max] = row.figures.map(number);
        let floor = row
            .floor
            .into_iter()
            .flatten()
            .map(|v| number(Some(v)))
            .collect::<Vec<_>>()
            .join(" / ");
        let Row {
            quantity,
            subject,
            engine,
            ..
        } = row;
        // writing to a string cannot fail
        let _ = writeln!(
            out,
            "| {quantity} | {subject} | {engine} | {p50} | {p90} | {max} | {floor} |"
        );
    }
    Ok(out)
}

/// Measures both sides live, from the same states.
fn live(rows: &mut Rows, api: &'static Mujoco, states: usize, plots: Option<&Path>) -> Result<(), String> {
    let (cases, mut panels) = (Case::all(), Vec::new());
    for case in &cases {
        eprintln!("{} ...", case.name);
        for subject in SUBJECTS {
            rows.engine = subject.name.to_string();
            single_steps(rows, api, case, subject, states)?;
            for s in spreads(api, case, &subject.make, 8, 1000)? {
                let of = |v: &[f64]| Summary::new(v.iter().copied());
                rows.beside(
                    format!("statistics: {} (KS)", s.quantity),
                    &case.name,
                    of(&s.ours),
                    of(&s.mujoco),
                );
            }
        }
        let plans = [
            (Motion::Random, 300),
            (Motion::Sine, 300),
            (Motion::Hold, 100),
            (Motion::Passive, 1000),
        ];
        for (motion, steps) in plans {
            let few = motion == Motion::Passive;
            let (rollouts, floors) = if few { (4, 1) } else { (8, 3) };
            let plan = Plan {
                motion,
                steps,
                rollouts,
                floors,
            };
            let panel = follow_paths(rows, api, case, plan)?;
            panels.push((motion, panel));
        }
    }
    let Some(folder) = plots else { return Ok(()) };
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    for motion in [Motion::Random, Motion::Sine, Motion::Hold, Motion::Passive] {
        let panels: Vec<&Panel> = panels.iter().filter(|(m, _)| *m == motion).map(|(_, p)| p).collect();
        let file = folder.join(format!("distance_{}.svg", motion.name().replace(' ', "_")));
        draw(&file, &panels)?;
    }
    Ok(())
}

fn single_steps(
    rows: &mut Rows,
    api: &'static Mujoco,
    case: &Case,
    subject: &Subject,
    states: usize,
) -> Result<(), String> {
    let e = one_step(api, case, &subject.make, states, None)?;
    let floor = |v: &[f64]| Summary::new(v.iter().copied());
    rows.beside("live step: qacc (relative)", &case.name, e.qacc(), e.floor());
    rows.beside(
        "live step: contact forces (relative)",
        &case.name,
        e.force(),
        floor(&e.force_floor),
    );
    rows.spread(
        "live step: velocity (rad/s, m/s)",
        &case.name,
        Summary::new(e.qvel.iter().copied()),
    );
    let others = e.mismatches.len() as f64;
    rows.single("live step: states with other contacts", &case.name, others, None);
    Ok(())
}

/// Adds rollouts of all engines and of later releases; returns their medians for a plot.
fn follow_paths(rows: &mut Rows, api: &'static Mujoco, case: &Case, plan: Plan) -> Result<Panel, String> {
    let paths = paths(api, case, plan)?;
    let what = |k: usize| format!("live {}: joints after {k} steps (rms, rad)", plan.motion.name());
    let marks: Vec<usize> = ROLLOUT
        .into_iter()
        .chain([plan.steps])
        .filter(|&k| k <= plan.steps)
        .collect();
    let marks: Vec<usize> = marks
        .iter()
        .enumerate()
        .filter(|(i, k)| !marks[..*i].contains(k))
        .map(|(_, &k)| k)
        .collect();
    let mut panel = Panel {
        title: format!("{}, {}", case.name, plan.motion.name()),
        lines: Vec::new(),
    };
    for subject in SUBJECTS {
        let rollouts = rollouts(api, case, &subject.make, plan, &paths)?;
        rows.engine = subject.name.to_string();
        for &k in &marks {
            let [ours, floor] = at(&rollouts, k - 1);
            rows.beside(what(k), &case.name, ours, floor);
        }
        let median = |which: usize| (0..plan.steps).map(|k| at(&rollouts, k)[which].p50).collect();
        if panel.lines.is_empty() {
            panel.lines.push(("MuJoCo 3.3.0 from 1e-7 away".to_string(), median(1)));
        }
        panel.lines.push((format!("babybench {}", subject.name), median(0)));
    }
    if plan.motion == Motion::Passive {
        return Ok(panel);
    }
    let later: Vec<String> = fetched().into_iter().filter(|v| v != REFERENCE).collect();
    let followed = parallel(&later, || (), |(), version| follow_release(version, case, &paths));
    for (version, distances) in later.iter().zip(followed) {
        let distances = distances?;
        rows.engine = format!("MuJoCo {version}");
        let summary = |k: usize| Summary::new(distances.iter().map(|d| d.joints[k]));
        for &k in &marks {
            rows.spread(what(k), &case.name, summary(k - 1));
        }
        let first = Summary::new(distances.iter().map(|d| d.first_qacc));
        rows.spread(
            format!("live {}: qacc of the first step (relative)", plan.motion.name()),
            &case.name,
            first,
        );
        let median = (0..plan.steps).map(|k| summary(k).p50).collect();
        panel.lines.push((format!("MuJoCo {version}"), median));
    }
    Ok(panel)
}

/// Adds the recorded episodes: single steps over all steps, open loop as rms over joints.
fn recordings(rows: &mut Rows) {
    for g in golden("spring_damper") {
        let step = replay_steps(&g);
        rows.spread("one step: qvel (of its change)", &g.name, step.qvel);
        rows.spread("one step: qacc (relative)", &g.name, step.qacc);
        match step.contacts {
            Some(c) => rows.spread("one step: contact forces (relative)", &g.name, c.force),
            None => rows.single("one step: contact forces (relative)", &g.name, f64::INFINITY, None),
        }
        for (name, s) in step.outputs {
            rows.spread(format!("one step: {name} (relative)"), &g.name, s);
        }
        let rms = open_loop(&g);
        for n in OPEN_LOOP.into_iter().filter(|&n| n <= rms.len()) {
            let floor = g.floor.get(n - 1).copied();
            rows.single(
                format!("open loop: joints after {n} steps (rms, rad)"),
                &g.name,
                rms[n - 1],
                floor,
            );
        }
    }
}

/// Adds the motion without contacts and the settling, over joints.
fn motion(rows: &mut Rows, reference: &Reference) {
    for (run, what) in [("cf", "1000 steps"), ("cfl", "1000 steps, joints locked")] {
        if let Some(last) = contact_free(reference, run).last() {
            rows.spread(
                format!("no contacts: joints after {what} (rad)"),
                &reference.name,
                last.summary(),
            );
        }
    }
    if let Some(last) = settling(reference).last() {
        settled(rows, &reference.name, last);
    }
}

fn settled(rows: &mut Rows, subject: &str, drift: &Drift) {
    rows.spread("settled 100 steps: joints (rad)", subject, drift.summary());
}

/// Adds the quantities of single states, over all states.
fn statics(rows: &mut Rows, reference: &Reference) {
    let states = States::new(reference);
    let (poses, rest): (Vec<&Compared>, Vec<&Compared>) =
        states.smooth.iter().chain(&states.constrained).partition(|q| q.pose);
    let poses = Summary::new(poses.iter().flat_map(|q| q.errors.iter().copied()));
    rows.spread("state: poses of bodies, geoms, sites (m or 1)", &reference.name, poses);
    for q in rest {
        let scale = match q.scale {
            Scale::Absolute => "absolute",
            Scale::Largest => "relative",
            Scale::Change => "of its change",
        };
        rows.spread(format!("state: {} ({scale})", q.name), &reference.name, q.summary());
    }
    let worst = constants(reference).iter().fold(0.0_f64, |max, c| max.max(c.1));
    rows.single(
        "model: inverse weights, statistics (relative)",
        &reference.name,
        worst,
        None,
    );
}

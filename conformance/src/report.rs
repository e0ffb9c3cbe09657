//! The table of distances to MuJoCo 3.3.0.

use std::fmt::Write as _;

use conformance::example_runs::example_runs;
use conformance::measure::Summary;
use conformance::motion::{Drift, contact_free, settling};
use conformance::recordings::golden;
use conformance::reference::Reference;
use conformance::replays::{one_step, open_loop};
use conformance::statics::{Compared, Scale, States, constants};

const LEGEND: &str = "\
One step: every step of a recorded episode, each from the recorded state before it, over steps. Open loop: the episode \
replayed from its start; floor is MuJoCo's own distance from a start 1e-7 rad away. No contacts, settled: over joints. \
State: over the recorded states. Relative errors are those of the largest value.

";

/// Steps after which an open-loop replay is looked at.
const OPEN_LOOP: [usize; 3] = [30, 100, 300];

struct Row {
    quantity: String,
    subject: String,
    /// p50, p90 and max.
    figures: [Option<f64>; 3],
    floor: Option<f64>,
}

#[derive(Default)]
struct Rows(Vec<Row>);

impl Rows {
    fn spread(&mut self, quantity: impl Into<String>, subject: &str, s: Summary) {
        let figures = [Some(s.p50), Some(s.p90), Some(s.max)];
        self.0.push(Row {
            quantity: quantity.into(),
            subject: subject.to_string(),
            figures,
            floor: None,
        });
    }

    fn single(&mut self, quantity: impl Into<String>, subject: &str, value: f64, floor: Option<f64>) {
        let figures = [None, None, Some(value)];
        self.0.push(Row {
            quantity: quantity.into(),
            subject: subject.to_string(),
            figures,
            floor,
        });
    }

    /// Rows of one quantity stand together, quantities in the order of their first row.
    fn grouped(self) -> Vec<Row> {
        let mut order: Vec<String> = Vec::new();
        for row in &self.0 {
            if !order.contains(&row.quantity) {
                order.push(row.quantity.clone());
            }
        }
        let mut rows = self.0;
        rows.sort_by_key(|row| order.iter().position(|q| *q == row.quantity));
        rows
    }
}

/// The table and how to read it, in Markdown. Without the recordings beside the repository it has what the committed data give.
pub fn table() -> String {
    let mut rows = Rows::default();
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
    let mut out = String::from(LEGEND);
    out.push_str("| distance to MuJoCo 3.3.0 | scene / model | p50 | p90 | max | floor |\n");
    out.push_str("|---|---|--:|--:|--:|--:|\n");
    let number = |v: Option<f64>| match v {
        None => String::new(),
        Some(0.0) => "0".to_string(),
        Some(v) => format!("{v:.1e}"),
    };
    for Row {
        quantity,
        subject,
        figures: [p50, p90, max],
        floor,
    } in rows.grouped()
    {
        let (p50, p90, max, floor) = (number(p50), number(p90), number(max), number(floor));
        // writing to a string cannot fail
        let _ = writeln!(out, "| {quantity} | {subject} | {p50} | {p90} | {max} | {floor} |");
    }
    out
}

/// Recorded episodes: single steps over steps, open loop as rms over joints.
fn recordings(rows: &mut Rows) {
    for g in golden("spring_damper") {
        let step = one_step(&g);
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
            let floor = g.floor.as_ref().map(|f| f[n - 1]);
            rows.single(
                format!("open loop: joints after {n} steps (rms, rad)"),
                &g.name,
                rms[n - 1],
                floor,
            );
        }
    }
}

/// Motion without contacts and settling, over joints.
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

/// Quantities of single states, over states.
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

//! Distances of replays to their recordings.

use babybench::runs::{Recording, Replay};
use babybench::spaces::Values;

use crate::measure::{Summary, identical, max_abs, pick, relative, relative_to_change, rms, row};
use crate::recordings::Golden;

/// Distances of single steps, each from the recorded state before it.
pub struct OneStep {
    /// Velocity, relative to its largest change in the step.
    pub qvel: Summary,
    /// Acceleration, relative to its largest value.
    pub qacc: Summary,
    /// Largest differences of controls and gears.
    pub controls: [(&'static str, f64); 2],
    /// The geoms of contacts, differences of their places, and their forces; `None` when the contacts are not the same.
    pub contacts: Option<Contacts>,
    /// Parts of the observation, and all sensors, relative to the largest value of the part.
    pub outputs: Vec<(&'static str, Summary)>,
}

/// Distances of contacts.
pub struct Contacts {
    /// Number of contacts.
    pub number: usize,
    /// Number of distances that agree bit for bit.
    pub identical: usize,
    /// Largest difference of positions, m.
    pub pos: f64,
    /// Largest difference of frames.
    pub frame: f64,
    /// Forces, relative to the largest force of the step.
    pub force: Summary,
}

/// Replays a recording step by step.
pub fn one_step(g: &Golden) -> OneStep {
    let mut env = g.env();
    let (recording, ours) = g.replay(&mut env, true);
    let (nv, t) = (env.model().nv, ours.len);
    let table = |name: &str| g.npz.get_f64(name).expect("recorded").data;
    let errors = |ours: &[f64], theirs: &[f64]| {
        let n = theirs.len() / t;
        Summary::new((0..t).map(|k| relative(row(ours, k, n), row(theirs, k, n))))
    };
    let before = |k: usize| {
        if k == 0 {
            &recording.qvel0
        } else {
            row(&recording.qvel, k - 1, nv)
        }
    };
    let qvel = |k: usize| relative_to_change(row(&ours.qvel, k, nv), row(&recording.qvel, k, nv), before(k));
    let observation = g.observation();
    let no = env.senses().proprioception().len();
    let mut outputs = Vec::new();
    for (component, range) in env.senses().proprioception().layout() {
        let part = |table: &[f64], k: usize| row(table, k, no)[range.clone()].to_vec();
        let part_errors = (0..t).map(|k| relative(&part(&ours.observation, k), &part(&observation, k)));
        outputs.push((component.name(), Summary::new(part_errors)));
    }
    if let Some(Values::F64(v)) = ours.sense("vestibular") {
        outputs.push(("vestibular", errors(v, &table("vestibular"))));
    }
    outputs.push(("sensordata", errors(&ours.sensordata, &table("sensordata"))));
    OneStep {
        qvel: Summary::new((0..t).map(qvel)),
        qacc: errors(&ours.qacc, &recording.qacc),
        controls: [
            ("ctrl", max_abs(&ours.ctrl, &table("ctrl"))),
            ("gear", max_abs(&ours.gear, &table("gear"))),
        ],
        contacts: contacts(g, &ours),
        outputs,
    }
}

fn contacts(g: &Golden, ours: &Replay) -> Option<Contacts> {
    let integers = |name: &str| g.npz.get_i64(name).expect("recorded").data;
    let table = |name: &str| g.npz.get_f64(name).expect("recorded").data;
    let first = integers("contact_ptr");
    if ours.contact_ptr != first || ours.contact_geom != integers("contact_geom") {
        return None;
    }
    let force = table("contact_force");
    let steps = first
        .windows(2)
        .map(|w| 6 * w[0] as usize..6 * w[1] as usize)
        .filter(|r| !r.is_empty());
    Some(Contacts {
        number: ours.contact_dist.len(),
        identical: identical(&ours.contact_dist, &table("contact_dist")),
        pos: max_abs(&ours.contact_pos, &table("contact_pos")),
        frame: max_abs(&ours.contact_frame, &table("contact_frame")),
        force: Summary::new(steps.map(|r| relative(&ours.contact_force[r.clone()], &force[r]))),
    })
}

/// Replays a recording open loop: rms distance of MIMo's joint angles after each step, rad.
pub fn open_loop(g: &Golden) -> Vec<f64> {
    let mut env = g.env();
    let (recording, ours): (Recording, Replay) = g.replay(&mut env, false);
    let nq = env.model().nq;
    let joints = &env.senses().proprioception().joints().qpos;
    let at = |table: &[f64], k: usize| pick(row(table, k, nq), joints);
    (0..ours.len)
        .map(|k| rms(&at(&ours.qpos, k), &at(&recording.qpos, k)))
        .collect()
}

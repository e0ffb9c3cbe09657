//! Quantities that follow from a state without advancing it, and one step.

use babybench::physics::{Engine, SoftEngine, State};

use crate::measure::{Summary, identical, max_abs, relative, relative_each, relative_to_change};
use crate::reference::Reference;

/// Divisor of a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Nothing.
    Absolute,
    /// The largest of MuJoCo's values.
    Largest,
    /// The largest change in the step.
    Change,
}

/// A quantity compared with MuJoCo's.
pub struct Compared {
    /// Name in MuJoCo.
    pub name: &'static str,
    /// Divisor of its errors.
    pub scale: Scale,
    /// Whether it is a position or orientation of bodies, geoms or sites.
    pub pose: bool,
    /// Largest error in each state.
    pub errors: Vec<f64>,
    /// Number of values that agree bit for bit.
    pub identical: usize,
    /// Number of values compared.
    pub values: usize,
}

impl Compared {
    fn new(name: &'static str, scale: Scale) -> Self {
        let pose = ["xpos", "xquat", "xmat"].iter().any(|kind| name.ends_with(kind));
        Self {
            name,
            scale,
            pose,
            errors: Vec::new(),
            identical: 0,
            values: 0,
        }
    }

    fn add(&mut self, ours: &[f64], theirs: &[f64], before: &[f64]) {
        self.errors.push(match self.scale {
            Scale::Absolute => max_abs(ours, theirs),
            Scale::Largest => relative(ours, theirs),
            Scale::Change => relative_to_change(ours, theirs, before),
        });
        self.identical += identical(ours, theirs);
        self.values += theirs.len();
    }

    /// Summarises the errors.
    pub fn summary(&self) -> Summary {
        Summary::new(self.errors.iter().copied())
    }
}

/// Quantities of the recorded states.
pub struct States {
    /// Those that no constraint enters: poses, inertia, forces, acceleration without constraints.
    pub smooth: Vec<Compared>,
    /// Those that constraints enter; `next_qvel` is after one step.
    pub constrained: Vec<Compared>,
    /// Numbers of contacts and of constraint rows: ours, MuJoCo's.
    pub counts: Vec<[(usize, usize); 2]>,
}

impl States {
    /// Compares the quantities of a model in its recorded states.
    pub fn new(reference: &Reference) -> Self {
        let mut engine = reference.engine(false);
        let mut smooth: Vec<Compared> = SMOOTH.iter().map(|q| Compared::new(q.0, q.1)).collect();
        let mut constrained: Vec<Compared> = CONSTRAINED.iter().map(|q| Compared::new(q.0, q.1)).collect();
        let mut next = Compared::new("next_qvel", Scale::Change);
        let theirs = |name: &str| reference.rows(&format!("st_{name}"));
        let quantities = SMOOTH
            .iter()
            .zip(&mut smooth)
            .chain(CONSTRAINED.iter().zip(&mut constrained));
        let mut quantities: Vec<_> = quantities.map(|(q, compared)| (q.2, theirs(q.0), compared)).collect();
        let (qpos, qvel, ctrl) = (theirs("qpos"), theirs("qvel"), theirs("ctrl"));
        let (ncon, nefc, next_qvel) = (theirs("ncon"), theirs("nefc"), theirs("next_qvel"));
        let mut counts = Vec::new();
        for k in 0..qpos.len() {
            let mut at = engine.new_state();
            at.qpos.copy_from_slice(&qpos[k]);
            at.qvel.copy_from_slice(&qvel[k]);
            at.ctrl.copy_from_slice(&ctrl[k]);
            let mut after = at.clone();
            engine.forward(&mut at).expect("a state that MuJoCo reached");
            for (value, rows, compared) in &mut quantities {
                // poses are recorded for the first states only
                if let Some(row) = rows.get(k) {
                    compared.add(&value(&engine, &at), row, &[]);
                }
            }
            counts.push([
                (at.contact.len(), ncon[k][0] as usize),
                (at.nefc(), nefc[k][0] as usize),
            ]);
            engine.step(&mut after).expect("a state that MuJoCo left");
            next.add(&after.qvel, &next_qvel[k], &qvel[k]);
        }
        drop(quantities);
        constrained.push(next);
        Self {
            smooth,
            constrained,
            counts,
        }
    }
}

type Quantity = (&'static str, Scale, fn(&SoftEngine, &State) -> Vec<f64>);

const SMOOTH: [Quantity; 12] = [
    ("xpos", Scale::Absolute, |_, s| s.xpos.concat()),
    ("xquat", Scale::Absolute, |_, s| s.xquat.concat()),
    ("xmat", Scale::Absolute, |_, s| s.xmat.concat()),
    ("geom_xpos", Scale::Absolute, |_, s| s.geom_xpos.concat()),
    ("geom_xmat", Scale::Absolute, |_, s| s.geom_xmat.concat()),
    ("site_xpos", Scale::Absolute, |_, s| s.site_xpos.concat()),
    ("site_xmat", Scale::Absolute, |_, s| s.site_xmat.concat()),
    ("qM", Scale::Absolute, |engine, s| engine.full_m(s)),
    ("qfrc_bias", Scale::Absolute, |_, s| s.qfrc_bias.clone()),
    ("qfrc_passive", Scale::Absolute, |_, s| s.qfrc_passive.clone()),
    ("qfrc_actuator", Scale::Absolute, |_, s| s.qfrc_actuator.clone()),
    ("qacc_smooth", Scale::Largest, |_, s| s.qacc_smooth.clone()),
];

const CONSTRAINED: [Quantity; 3] = [
    ("qacc", Scale::Largest, |_, s| s.qacc.clone()),
    ("qfrc_constraint", Scale::Largest, |_, s| s.qfrc_constraint.clone()),
    ("sensordata", Scale::Largest, |_, s| s.sensordata.clone()),
];

/// Compares the constants of the model that follow from `qpos0`.
///
/// Each comes with its largest relative error; for the centre of the model that is the error relative to the extent.
pub fn constants(reference: &Reference) -> [(&'static str, f64); 5] {
    let (m, stat) = (&reference.model, &reference.model.stat);
    let each = |name, ours: &[f64]| (name, relative_each(ours, &reference.array(name).data));
    let (scalars, center) = (
        reference.array("stat").data[..4].to_vec(),
        reference.array("stat").data[4..].to_vec(),
    );
    let ours = [stat.meaninertia, stat.meanmass, stat.meansize, stat.extent];
    [
        each("body_invweight0", &m.body_invweight0.concat()),
        each("dof_invweight0", &m.dof_invweight0),
        each("tendon_invweight0", &m.tendon_invweight0),
        ("stat", relative_each(&ours, &scalars)),
        ("stat.center", max_abs(&stat.center, &center) / scalars[3]),
    ]
}

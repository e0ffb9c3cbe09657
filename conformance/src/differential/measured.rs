//! Quantities of a step on both sides.

use babybench::physics::State;

use crate::measure::{max_abs, relative};
use crate::mujoco::{Contact, Simulation};

/// A quantity that both sides have.
#[derive(Clone, Debug)]
pub struct Measured {
    /// What.
    pub quantity: &'static str,
    /// How far ours is from MuJoCo's.
    pub error: f64,
    /// The error up to which both agree.
    pub limit: f64,
    /// Values of both sides, for people to read.
    pub place: String,
}

impl Measured {
    pub(super) fn new(quantity: &'static str, error: f64, limit: f64, place: impl Into<String>) -> Self {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        let place = place.into();
        Self {
            quantity,
            error,
            limit,
            place,
        }
    }

    /// Says that both sides take a document.
    pub fn taken() -> Self {
        Self::new("taken", 0.0, 0.0, "")
    }

    /// Tells whether both sides agree.
    pub fn agrees(&self) -> bool {
        self.error <= self.limit
    }

    /// Measures numbers, relative to the largest of MuJoCo's.
    fn relative(quantity: &'static str, ours: &[f64], theirs: &[f64], limit: f64) -> Self {
        if ours.len() != theirs.len() {
            let place = format!("{} values, MuJoCo {}", ours.len(), theirs.len());
            return Self::new(quantity, f64::INFINITY, limit, place);
        }
        let scale = theirs.iter().fold(1e-6_f64, |m, v| m.max(v.abs()));
        let far = |k: &usize| (ours[*k] - theirs[*k]).abs();
        let worst = (0..ours.len()).max_by(|a, b| far(a).total_cmp(&far(b)));
        let place = worst.map(|k| format!("[{k}] {:e}, MuJoCo {:e}", ours[k], theirs[k]));
        Self::new(
            quantity,
            max_abs(ours, theirs) / scale,
            limit,
            place.unwrap_or_default(),
        )
    }
}

/// Measures all quantities of a step. Those that follow from others which differ are left out. Where both solvers stop early, they
/// need agree no better than the `tolerance` that the document asks for.
pub(super) fn measure(state: &State, theirs: &Simulation, tolerance: f64) -> Vec<Measured> {
    let limit = tolerance.max(1e-6);
    let mut all = vec![
        Measured::relative("qfrc_bias", &state.qfrc_bias, theirs.qfrc_bias(), 1e-9),
        Measured::relative("qfrc_passive", &state.qfrc_passive, theirs.qfrc_passive(), 1e-9),
        Measured::relative("qfrc_actuator", &state.qfrc_actuator, theirs.qfrc_actuator(), 1e-9),
        Measured::relative("qacc_smooth", &state.qacc_smooth, theirs.qacc_smooth(), 1e-6),
    ];
    all.extend(contacts(state, &theirs.contacts()));
    if all.iter().all(Measured::agrees) {
        all.extend(rows(state, theirs));
    }
    if all.iter().all(Measured::agrees) {
        all.push(acceleration(state, theirs, limit));
    }
    if all.iter().all(Measured::agrees) {
        all.push(Measured::relative(
            "qvel after the step",
            &state.qvel,
            theirs.qvel(),
            limit,
        ));
        all.push(Measured::relative(
            "qpos after the step",
            &state.qpos,
            theirs.qpos(),
            limit,
        ));
        all.push(sensors(state, theirs, 10.0 * limit));
    }
    all
}

fn acceleration(state: &State, theirs: &Simulation, limit: f64) -> Measured {
    let mut qacc = Measured::relative("qacc", &state.qacc, theirs.qacc(), limit);
    qacc.place += &format!(
        "; {} contacts, {} rows, iterations {} and {}",
        theirs.ncon(),
        theirs.nefc(),
        state.solver_iterations,
        theirs.solver_iterations()
    );
    qacc
}

/// Torques are differences of what acts on the bodies and what they exert on each other, which may be much greater.
fn sensors(state: &State, theirs: &Simulation, limit: f64) -> Measured {
    let wrenches = state.cfrc_int.iter().chain(&state.cfrc_ext).flatten();
    let wrench = wrenches.fold(0.0_f64, |m, v| m.max(v.abs()));
    let largest = theirs.sensordata().iter().fold(0.0_f64, |m, v| m.max(v.abs()));
    let mut sensors = Measured::relative("sensordata", &state.sensordata, theirs.sensordata(), limit);
    sensors.error *= largest.max(1e-6) / largest.max(1e-3 * wrench).max(1e-6);
    sensors
}

fn contacts(state: &State, theirs: &[Contact]) -> Vec<Measured> {
    let geoms: [Vec<[usize; 2]>; 2] = [
        state.contact.iter().map(|c| c.geom).collect(),
        theirs.iter().map(|c| c.geom).collect(),
    ];
    let place = format!("{:?}, MuJoCo {:?}", geoms[0], geoms[1]);
    let other = f64::from(u8::from(geoms[0].len() != geoms[1].len()));
    let mut all = vec![Measured::new("contacts: number", other, 0.0, place.clone())];
    if other > 0.0 {
        return all;
    }
    let other = f64::from(u8::from(geoms[0] != geoms[1]));
    all.push(Measured::new("contacts: geoms in order", other, 0.0, place));
    if other > 0.0 || theirs.is_empty() {
        return all;
    }
    let mut worst = [
        ("dist", 0.0, String::new()),
        ("pos", 0.0, String::new()),
        ("frame", 0.0, String::new()),
    ];
    let mut rest = (0.0_f64, String::new());
    for (a, b) in state.contact.iter().zip(theirs) {
        let errors = [
            (a.dist - b.dist).abs(),
            max_abs(&a.pos, &b.pos),
            max_abs(&a.frame, &b.frame),
        ];
        for (worst, error) in worst.iter_mut().zip(errors) {
            if error.is_nan() || error > worst.1 {
                *worst = (worst.0, error, format!("of geoms {:?}: {a:?}, MuJoCo {b:?}", b.geom));
            }
        }
        let alike = a.dim == b.dim
            && relative(&a.friction, &b.friction) <= 1e-12
            && (a.includemargin - b.includemargin).abs() <= 1e-12
            && a.efc_address == b.efc_address;
        if !alike {
            rest = (1.0, format!("of geoms {:?}: {a:?}, MuJoCo {b:?}", b.geom));
        }
    }
    let names = ["contacts: dist", "contacts: pos", "contacts: frame"];
    all.extend(
        names
            .into_iter()
            .zip(worst)
            .map(|(name, worst)| Measured::new(name, worst.1, 1e-9, worst.2)),
    );
    all.push(Measured::new(
        "contacts: dim, friction, margin, row",
        rest.0,
        0.0,
        rest.1,
    ));
    all
}

fn rows(state: &State, theirs: &Simulation) -> Vec<Measured> {
    let ours: Vec<_> = state.efc_rows().collect();
    let place = format!("{}, MuJoCo {}", ours.len(), theirs.nefc());
    let other = f64::from(u8::from(ours.len() != theirs.nefc()));
    let mut all = vec![Measured::new("rows: number", other, 0.0, place)];
    if other > 0.0 || ours.is_empty() {
        return all;
    }
    let kinds = |k: usize| {
        ours.get(k)
            .map_or(String::new(), |row| format!(" {:?} {}", row.kind, row.id))
    };
    let mut compare = |quantity, of: fn(&babybench::physics::EfcRow) -> f64, theirs: &[f64], limit, each: bool| {
        let values: Vec<f64> = ours.iter().map(of).collect();
        let mut measured = Measured::relative(quantity, &values, theirs, limit);
        if each {
            let errors = values.iter().zip(theirs).map(|(a, b)| relative(&[*a], &[*b]));
            let worst = errors.enumerate().fold((0, 0.0), |w, e| if e.1 > w.1 { e } else { w });
            measured.error = worst.1;
            measured.place = format!(
                "[{}]{} {:e}, MuJoCo {:e}",
                worst.0,
                kinds(worst.0),
                values[worst.0],
                theirs[worst.0]
            );
        }
        all.push(measured);
    };
    compare("rows: pos", |row| row.pos, theirs.efc_pos(), 1e-9, false);
    compare("rows: margin", |row| row.margin, theirs.efc_margin(), 1e-12, false);
    compare("rows: R", |row| row.r, theirs.efc_R(), 1e-6, true);
    compare("rows: vel", |row| row.vel, theirs.efc_vel(), 1e-9, false);
    compare("rows: aref", |row| row.aref, theirs.efc_aref(), 1e-8, false);
    all
}

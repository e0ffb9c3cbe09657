//! The output of `babybench inspect` about a body of some age.

use std::io::{self, Write};

use babybench::config::StrengthModel;
use babybench::mimo::{BodyFigures, BodyScores, Individual, Lms, StrengthRow, Version};
use babybench::{Env, Model};

/// Ages of the authors' figures, months.
const AGES: [f64; 9] = [0.0, 1.0, 3.0, 6.0, 9.0, 12.0, 17.5, 18.0, 24.0];

/// A figure at [`AGES`] by the formulas of MIMo's authors (arXiv 2509.09805), who print none themselves.
type Row = [f64; AGES.len()];

const STATURE: Row = [
    0.504571, 0.583757, 0.633258, 0.676997, 0.709922, 0.737805, 0.781606, 0.785258, 0.826056,
];
const MASS_V1: Row = [
    2.91003, 4.96126, 6.52359, 7.9207, 8.95753, 9.82818, 11.196, 11.3106, 12.6038,
];
const HEAD_RADIUS: Row = [
    0.0540807, 0.0605263, 0.0652253, 0.0686018, 0.0706594, 0.0721438, 0.0741127, 0.0742605, 0.0757752,
];

/// Gears of motors, N m, of both versions unless said otherwise.
const GEARS: [(&str, Option<Version>, Row); 8] = [
    (
        "act:hip_bend",
        None,
        [
            1.96565, 4.79285, 6.60504, 8.00886, 8.92557, 9.61971, 10.5862, 10.661, 11.4453,
        ],
    ),
    (
        "act:head_tilt",
        None,
        [
            1.31455, 1.84283, 2.30622, 2.68323, 2.93199, 3.12068, 3.38322, 3.4035, 3.61603,
        ],
    ),
    (
        "act:left_elbow",
        None,
        [
            1.11324, 1.75556, 2.18361, 2.62517, 2.99225, 3.31687, 3.83625, 3.87959, 4.36021,
        ],
    ),
    (
        "act:left_knee",
        None,
        [
            2.89535, 4.11905, 5.58194, 7.08387, 8.27184, 9.29978, 10.9403, 11.078, 12.6235,
        ],
    ),
    (
        "act:left_wrist_flexion",
        Some(Version::V1),
        [
            0.435888, 0.526086, 0.669262, 0.835712, 0.96967, 1.08328, 1.25727, 1.27143, 1.42577,
        ],
    ),
    (
        "act:left_toes",
        Some(Version::V1),
        [
            0.11047, 0.122571, 0.147696, 0.187293, 0.228665, 0.271366, 0.352021, 0.359464, 0.449676,
        ],
    ),
    (
        "act:left_wrist_flexion",
        Some(Version::V2),
        [
            0.322421, 0.380125, 0.476451, 0.591936, 0.686358, 0.767108, 0.891635, 0.901813, 1.01297,
        ],
    ),
    (
        "act:left_mf_knuckle",
        Some(Version::V2),
        [
            0.0274217, 0.0328815, 0.0411539, 0.0503048, 0.0574115, 0.0633039, 0.0721424, 0.0728538, 0.0805332,
        ],
    ),
];

/// Writes stature, mass, centre of mass and strength of an environment's MIMo next to those of the authors' formulas.
pub fn write(out: &mut impl Write, env: &Env, age: f64) -> io::Result<()> {
    let (model, config) = (env.model(), env.config());
    let Some(figures) = BodyFigures::of(model) else {
        return Ok(());
    };
    let version = Version::of(config.behavior);
    let strength_age = config.strength_age.unwrap_or(age);
    writeln!(out, "\nMIMo {} at {age} months", Version::label(config))?;
    let (here, there) = ("here", "by the authors' formulas (arXiv 2509.09805)");
    writeln!(out, "  {:27} {here:>9}  {there}", "")?;
    let mut line = |what: &str, value: f64, age: f64, row: Option<&Row>, unit: &str| {
        let expected = row.map_or_else(String::new, |row| expected(row, age));
        writeln!(out, "  {what:27} {value:>9.5}  {expected} {unit}")
    };
    line("stature", figures.stature, age, Some(&STATURE), "m")?;
    // the authors' v2 has a lighter chest than BabyBench's
    let mass = (version == Version::V1).then_some(&MASS_V1);
    line("mass", figures.mass, age, mass, "kg")?;
    line("centre of mass, height", figures.center_of_mass, age, None, "m")?;
    if let Some(sitting) = BodyFigures::crown_rump(model) {
        line("crown-rump length", sitting, age, None, "m")?;
        line("crown-rump over length", sitting / figures.stature, age, None, "")?;
    }
    if let Some(head) = BodyFigures::head_circumference(model) {
        line("head circumference", head, age, None, "m")?;
    }
    if let Some(head) = geom_radius(model, "head") {
        line("radius of the head", head, age, Some(&HEAD_RADIUS), "m")?;
    }
    for (name, of, row) in GEARS {
        if let (Some(k), true) = (model.actuator(name), of.is_none_or(|of| of == version)) {
            let gear = model.actuator_gear[k];
            // with the strength of infants the gears are not the authors'
            let row = (config.strength == StrengthModel::Volume).then_some(&row);
            line(&format!("gear {name}"), gear, strength_age, row, "N m")?;
        }
    }
    write_standards(out, env)
}

/// Writes the greatest torques under both settings of `strength`, and their ratios to the torque of gravity.
pub fn write_strength(out: &mut impl Write, rows: &[StrengthRow]) -> io::Result<()> {
    writeln!(out, "  greatest torques, N m, and over that of gravity")?;
    let columns = ["gravity", "volume", "ratio", "infant", "ratio"];
    let [gravity, volume, ratio, infant, _] = columns;
    writeln!(
        out,
        "  {:34} {gravity:>9} {volume:>9} {ratio:>7} {infant:>9} {ratio:>7}",
        ""
    )?;
    for row in rows {
        let ([volume, infant], [r, s]) = (row.torques, row.ratios());
        writeln!(
            out,
            "  {:34} {:>9.5} {volume:>9.5} {r:>7.3} {infant:>9.5} {s:>7.3}",
            row.name, row.gravity
        )?;
    }
    Ok(())
}

/// Writes where length, weight and head circumference lie among infants of an age.
fn write_standards(out: &mut impl Write, env: &Env) -> io::Result<()> {
    let (model, config) = (env.model(), env.config());
    if let Some(infant) = Individual::of(config) {
        let Individual {
            sex,
            length_z,
            weight_z,
            head_z,
        } = infant;
        writeln!(
            out,
            "  this {sex} has z-scores {length_z:+.4} of length, {weight_z:+.4} of weight, {head_z:+.4} of head circumference"
        )?;
    }
    let scores = BodyScores::of(model, config).map_err(io::Error::other)?;
    let Some(first) = scores.first() else { return Ok(()) };
    writeln!(
        out,
        "  among infants ({}): z-score, and -2, 0 and +2 standard deviations",
        first.standard.source
    )?;
    for score in &scores {
        let standard = &score.standard;
        let mut line = |what: &str, z: f64, lms: Lms, unit: &str| {
            let [low, middle, high] = [-2.0, 0.0, 2.0].map(|z| lms.value(z));
            let what = format!("{what} of {}", standard.of);
            // without the sign of a zero that was rounded
            let z = (1e6 * z).round() / 1e6 + 0.0;
            writeln!(out, "  {what:27} {z:>+9.6}  {low:.1}, {middle:.1}, {high:.1} {unit}")
        };
        line("length", score.length, standard.length, "cm")?;
        line("weight", score.weight, standard.weight, "kg")?;
        line("head", score.head, standard.head, "cm")?;
    }
    Ok(())
}

fn geom_radius(model: &Model, body: &str) -> Option<f64> {
    let geom = model.body_geomadr[model.body(body)?];
    model.geom_size.get(geom).map(|size| size[0])
}

/// Returns the authors' value for an age, or the values for the ages around it.
fn expected(row: &Row, age: f64) -> String {
    let above = AGES.partition_point(|a| *a < age).min(AGES.len() - 1);
    if AGES[above] == age || above == 0 {
        format!("{}", row[above])
    } else {
        let (a, b) = (above - 1, above);
        format!("{} at {}, {} at {}", row[a], AGES[a], row[b], AGES[b])
    }
}

//! MIMo's likeness to an infant: strength, proportions and noise over age by both settings, and the constants behind them.

use std::error::Error;
use std::io::{self, Write};

use babybench::config::{Proportions, StrengthModel};
use babybench::mimo::{BodyFigures, SourcedConstant, StrengthRow, embedded, strength_table};
use babybench::spaces::Noise;
use babybench::{Blueprint, Config};

/// Ages of the tables, months.
const AGES: [f64; 9] = [0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 9.0, 12.0, 18.0];

/// Writes all tables as Markdown.
pub fn write(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    write_strength(out)?;
    write_proportions(out)?;
    write_noise(out)?;
    Ok(write_constants(out)?)
}

/// Writes the header of a table over age.
fn header(out: &mut impl Write, what: &str) -> io::Result<()> {
    let ages = AGES.map(|age| age.to_string()).join(" | ");
    writeln!(out, "| {what} | {ages} |\n|---|{}", "--:|".repeat(AGES.len()))
}

fn row(out: &mut impl Write, what: &str, values: [f64; AGES.len()], digits: usize) -> io::Result<()> {
    let values = values.map(|value| format!("{value:.digits$}")).join(" | ");
    writeln!(out, "| {what} | {values} |")
}

/// Returns MIMo v1 at an age.
fn infant(age: f64) -> Config {
    Config {
        age: Some(age),
        touch_active: false,
        vision_active: false,
        ..Config::default()
    }
}

/// Writes the greatest torques over that of gravity, and in N m.
fn write_strength(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    let mut tables: Vec<Vec<StrengthRow>> = Vec::new();
    for age in AGES {
        tables.push(strength_table(&infant(age), &embedded())?);
    }
    let settings = [StrengthModel::Volume, StrengthModel::Infant];
    header(out, "torque over gravity's, v1, by age in months")?;
    for (k, _) in tables[0].iter().enumerate() {
        for (s, setting) in settings.into_iter().enumerate() {
            let values = std::array::from_fn(|a| tables[a][k].ratios()[s]);
            row(out, &format!("{}, `{setting}`", tables[0][k].name), values, 2)?;
        }
    }
    writeln!(out)?;
    Ok(())
}

/// Writes crown-rump length over length.
fn write_proportions(out: &mut impl Write) -> Result<(), Box<dyn Error>> {
    header(out, "crown-rump length over length, by age in months")?;
    for proportions in [Proportions::Mimo, Proportions::Measured] {
        let mut values = [0.0; AGES.len()];
        for (value, age) in values.iter_mut().zip(AGES) {
            let config = Config {
                proportions,
                ..infant(age)
            };
            let blueprint = Blueprint::new(config)?;
            let figures = BodyFigures::of(blueprint.model()).ok_or("there is no MIMo")?;
            let sitting = BodyFigures::crown_rump(blueprint.model()).ok_or("there is no MIMo")?;
            *value = sitting / figures.stature;
        }
        row(out, &format!("`{proportions}`"), values, 3)?;
    }
    writeln!(out)?;
    Ok(())
}

/// Writes the exponents of `color_by_age`.
fn write_noise(out: &mut impl Write) -> io::Result<()> {
    header(out, "exponent of noise, by age in months")?;
    let exponents = AGES.map(|age| Noise::ColorByAge { months: Some(age) }.exponent().unwrap_or(f64::NAN));
    row(out, "`color_by_age`", exponents, 3)?;
    writeln!(out)
}

/// Writes every constant with its values, unit and mark, and a list of their sources.
fn write_constants(out: &mut impl Write) -> io::Result<()> {
    let all = SourcedConstant::all();
    writeln!(
        out,
        "| constant | mark | unit | at ages, months | values |\n|---|---|---|---|---|"
    )?;
    for constant in &all {
        // four digits after the point, but small numbers in full
        let short = |value: &f64| {
            if value.abs() < 0.05 {
                value.to_string()
            } else {
                ((value * 1e4).round() / 1e4).to_string()
            }
        };
        let row = |values: &[f64]| values.iter().map(short).collect::<Vec<_>>().join(", ");
        let (name, mark, unit) = (&constant.name, constant.mark, constant.unit);
        let (ages, values) = (row(&constant.ages), row(&constant.values));
        writeln!(out, "| {name} | {mark} | {unit} | {ages} | {values} |")?;
    }
    writeln!(out)?;
    for constant in &all {
        writeln!(out, "- {}: {}", constant.name, constant.source)?;
    }
    Ok(())
}

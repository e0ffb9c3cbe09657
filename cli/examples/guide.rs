//! Draws the plots of the guide: what grows and what matures, over age.
//!
//! ```sh
//! cargo run --release -p babybench-cli --example guide    # into docs/guide/plots
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};

use babybench::Config;
use babybench::config::{Behavior, MAX_AGE};
use babybench::mimo::{BodyFigures, build_model, embedded};
use babybench::sensors::SkinLayout;
use babybench::sensors::transform::acuity_cutoff;
use plotters::prelude::*;

/// Size of a panel, pixels.
const PANEL: (u32, u32) = (380, 250);
/// Text, axes and grid: legible on light and on dark ground, which shows through.
const GREY: RGBColor = RGBColor(128, 128, 128);
const BLUE: RGBColor = RGBColor(46, 134, 222);
/// Ages that are drawn in a month.
const PER_MONTH: u32 = 4;

/// A quantity over age.
struct Curve {
    title: &'static str,
    /// Age, months, and value.
    points: Vec<(f64, f64)>,
}

/// Draws curves beside each other.
fn draw(file: &Path, curves: &[Curve]) -> Result<(), Box<dyn Error>> {
    let columns = curves.len().min(2);
    let rows = curves.len().div_ceil(columns);
    let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
    let area = SVGBackend::new(file, size).into_drawing_area();
    for (curve, part) in curves.iter().zip(area.split_evenly((rows, columns))) {
        let text = |size: u32| ("sans-serif", size).into_font().color(&GREY);
        let top = curve.points.iter().fold(0.0_f64, |top, (_, value)| top.max(*value));
        let mut chart = ChartBuilder::on(&part)
            .caption(curve.title, text(15))
            .margin(10)
            .x_label_area_size(24)
            .y_label_area_size(48)
            .build_cartesian_2d(0.0..MAX_AGE, 0.0..1.05 * top)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(GREY.mix(0.3))
            .axis_style(GREY)
            .label_style(text(11))
            .x_labels(9)
            .y_labels(6)
            .x_label_formatter(&|age| format!("{age:.0}"))
            .draw()?;
        chart.draw_series(LineSeries::new(curve.points.iter().copied(), BLUE.stroke_width(2)))?;
    }
    area.present()?;
    Ok(())
}

/// Returns stature, mass, strength and the number of touch sensors over age.
fn growth() -> Result<[Curve; 4], Box<dyn Error>> {
    let mut values: [Vec<(f64, f64)>; 4] = Default::default();
    for quarter in 0..=MAX_AGE as u32 * PER_MONTH {
        let age = f64::from(quarter) / f64::from(PER_MONTH);
        let config = Config {
            behavior: Behavior::SelfTouch,
            age: Some(age),
            ..Config::default()
        };
        let model = build_model(&config, &embedded())?;
        let figures = BodyFigures::of(&model).ok_or("a scene without MIMo")?;
        let strength: f64 = model.actuator_gear.iter().sum();
        let sensors = SkinLayout::new(&model, &config)?.len();
        let found = [100.0 * figures.stature, figures.mass, strength, sensors as f64];
        values
            .iter_mut()
            .zip(found)
            .for_each(|(curve, value)| curve.push((age, value)));
    }
    let titles = [
        "stature, cm, over age, months",
        "mass, kg",
        "sum of the motors' gears, N m",
        "touch sensors",
    ];
    let mut curves = titles
        .into_iter()
        .zip(values)
        .map(|(title, points)| Curve { title, points });
    Ok(std::array::from_fn(|_| {
        curves.next().unwrap_or(Curve {
            title: "",
            points: Vec::new(),
        })
    }))
}

fn acuity() -> Curve {
    let ages = (0..=MAX_AGE as u32 * PER_MONTH).map(|quarter| f64::from(quarter) / f64::from(PER_MONTH));
    Curve {
        title: "visual acuity, cycles per degree, over age, months",
        points: ages.map(|age| (age, acuity_cutoff(age))).collect(),
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let usual = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/guide/plots");
    let folder = std::env::args().nth(1).map_or(usual, PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    draw(&folder.join("growth.svg"), &growth()?)?;
    draw(&folder.join("acuity.svg"), &[acuity()])?;
    println!("the plots of the guide are in {}", folder.display());
    Ok(())
}

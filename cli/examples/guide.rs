//! Draws the plots of the guide: what grows and what matures, over age.
//!
//! ```sh
//! cargo run --release -p babybench-cli --example guide    # into docs/guide/plots
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};

use babybench::Config;
use babybench::config::{Behavior, MAX_AGE};
use babybench::mimo::{BodyFigures, GrowthStandard, Lms, build_model, embedded};
use babybench::sensors::SkinLayout;
use babybench::sensors::transform::acuity_cutoff;
use plotters::prelude::*;

/// Size of a panel, pixels.
const PANEL: (u32, u32) = (380, 250);
/// Text, axes and grid: legible on light and on dark backgrounds, which show through.
const GREY: RGBColor = RGBColor(128, 128, 128);
const BLUE: RGBColor = RGBColor(46, 134, 222);
/// Colours of the bands of boys and girls.
const BANDS: [RGBColor; 2] = [RGBColor(26, 158, 110), RGBColor(232, 126, 36)];
/// Number of ages drawn per month.
const PER_MONTH: u32 = 4;

/// A quantity over age.
#[derive(Default)]
struct Curve {
    title: &'static str,
    /// Start of its axis.
    from: f64,
    /// Age, months, and value.
    points: Vec<(f64, f64)>,
    /// The usual range among infants, if known: of boys and of girls.
    bands: Vec<Band>,
}

/// Values of a z-score at each age: age, months, and value.
type Line = Vec<(f64, f64)>;

/// The median among infants, and the range within two standard deviations.
struct Band {
    of: &'static str,
    median: Line,
    low: Line,
    high: Line,
}

impl Band {
    /// Returns the bands of boys and of girls in a measurement.
    fn both(of: fn(&GrowthStandard) -> Lms) -> Vec<Self> {
        let line = |which: usize, z: f64| {
            ages()
                .map(|age| (age, of(&GrowthStandard::at(age)[which]).value(z)))
                .collect()
        };
        let band = |which: usize| Self {
            of: GrowthStandard::at(0.0)[which].of,
            median: line(which, 0.0),
            low: line(which, -2.0),
            high: line(which, 2.0),
        };
        vec![band(0), band(1)]
    }

    /// Returns the edge of the band.
    fn edge(&self) -> Line {
        self.low.iter().chain(self.high.iter().rev()).copied().collect()
    }
}

/// Returns the ages that are drawn, months.
fn ages() -> impl Iterator<Item = f64> {
    (0..=MAX_AGE as u32 * PER_MONTH).map(|quarter| f64::from(quarter) / f64::from(PER_MONTH))
}

/// Draws curves side by side.
fn draw(file: &Path, curves: &[Curve]) -> Result<(), Box<dyn Error>> {
    let columns = curves.len().min(2);
    let rows = curves.len().div_ceil(columns);
    let size = (PANEL.0 * columns as u32, PANEL.1 * rows as u32);
    let area = SVGBackend::new(file, size).into_drawing_area();
    for (curve, part) in curves.iter().zip(area.split_evenly((rows, columns))) {
        let text = |size: u32| ("sans-serif", size).into_font().color(&GREY);
        let highest = curve.bands.iter().flat_map(|band| &band.high);
        let top = curve
            .points
            .iter()
            .chain(highest)
            .fold(0.0_f64, |top, (_, value)| top.max(*value));
        let mut chart = ChartBuilder::on(&part)
            .caption(curve.title, text(15))
            .margin(10)
            .x_label_area_size(24)
            .y_label_area_size(48)
            .build_cartesian_2d(0.0..MAX_AGE, curve.from..1.05 * top)?;
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
        for (band, colour) in curve.bands.iter().zip(BANDS) {
            chart.draw_series([Polygon::new(band.edge(), colour.mix(0.18))])?;
            let median = chart.draw_series(LineSeries::new(
                band.median.iter().copied(),
                colour.mix(0.8).stroke_width(1),
            ))?;
            let key = move |(x, y)| Rectangle::new([(x, y - 4), (x + 14, y + 4)], colour.mix(0.5).filled());
            median.label(format!("WHO, {}", band.of)).legend(key);
        }
        let own = chart.draw_series(LineSeries::new(curve.points.iter().copied(), BLUE.stroke_width(2)))?;
        if !curve.bands.is_empty() {
            own.label("MIMo")
                .legend(|(x, y)| PathElement::new([(x, y), (x + 14, y)], BLUE.stroke_width(2)));
            let labels = &mut chart.configure_series_labels();
            labels
                .position(SeriesLabelPosition::LowerRight)
                .label_font(text(11))
                .legend_area_size(20)
                .draw()?;
        }
    }
    area.present()?;
    Ok(())
}

/// Returns stature, mass, strength and the number of touch sensors over age.
fn growth() -> Result<[Curve; 4], Box<dyn Error>> {
    let mut curves = [
        (
            "stature, cm, over age, months",
            40.0,
            Band::both(|standard| standard.length),
        ),
        ("mass, kg", 0.0, Band::both(|standard| standard.weight)),
        ("sum of the motors' gears, N m", 0.0, Vec::new()),
        ("touch sensors", 0.0, Vec::new()),
    ]
    .map(|(title, from, bands)| Curve {
        title,
        from,
        bands,
        ..Curve::default()
    });
    for age in ages() {
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
        let each = curves.iter_mut().zip(found);
        each.for_each(|(curve, value)| curve.points.push((age, value)));
    }
    Ok(curves)
}

fn acuity() -> Curve {
    Curve {
        title: "visual acuity, cycles per degree, over age, months",
        points: ages().map(|age| (age, acuity_cutoff(age))).collect(),
        ..Curve::default()
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

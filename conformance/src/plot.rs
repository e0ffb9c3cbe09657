//! Plots of the report. Colours are legible on light and on dark backgrounds, which show through.

use std::path::Path;

use plotters::prelude::*;

/// Size of a panel, pixels.
const PANEL: (u32, u32) = (360, 260);

/// Height of the legend.
const LEGEND: u32 = 50;

/// Text, axes and grid.
const GREY: RGBColor = RGBColor(128, 128, 128);

/// By line.
const COLOURS: [RGBColor; 6] = [
    RGBColor(128, 128, 128),
    RGBColor(46, 134, 222),
    RGBColor(230, 126, 34),
    RGBColor(155, 89, 182),
    RGBColor(39, 174, 96),
    RGBColor(214, 69, 65),
];

/// Distances smaller than this are drawn here: the axis is logarithmic.
const LEAST: f64 = 1e-16;

/// Distances over steps.
pub struct Panel {
    /// Title above the plot.
    pub title: String,
    /// Names and values after each step, rad.
    pub lines: Vec<(String, Vec<f64>)>,
}

/// Draws panels, three in a row, with one legend.
///
/// # Errors
/// The file cannot be written.
pub fn draw(file: &Path, panels: &[&Panel]) -> Result<(), String> {
    let failed = |e: &dyn std::fmt::Display| format!("{}: {e}", file.display());
    let rows = panels.len().div_ceil(3).max(1) as u32;
    let area = SVGBackend::new(file, (3 * PANEL.0, LEGEND + rows * PANEL.1)).into_drawing_area();
    let (top, below) = area.split_vertically(LEGEND);
    if let Some(panel) = panels.first() {
        legend(&top, panel).map_err(|e| failed(&e))?;
    }
    for (panel, part) in panels.iter().zip(below.split_evenly((rows as usize, 3))) {
        draw_panel(&part, panel).map_err(|e| failed(&e))?;
    }
    area.present().map_err(|e| failed(&e))
}

type Outcome<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

type Area<B> = DrawingArea<B, plotters::coord::Shift>;

fn legend<B: DrawingBackend>(area: &Area<B>, panel: &Panel) -> Outcome<B> {
    let style = ("sans-serif", 13).into_font().color(&GREY);
    area.draw(&Text::new(
        "rms distance of joint angles to MuJoCo 3.3.0 (rad) over steps of 5 ms: median of rollouts",
        (10, 5),
        style.clone(),
    ))?;
    let mut x = 10;
    for ((name, _), colour) in panel.lines.iter().zip(COLOURS) {
        area.draw(&PathElement::new(vec![(x, 36), (x + 22, 36)], colour.stroke_width(3)))?;
        area.draw(&Text::new(name.clone(), (x + 28, 29), style.clone()))?;
        x += 48 + 7 * name.len() as i32;
    }
    Ok(())
}

fn draw_panel<B: DrawingBackend>(area: &Area<B>, panel: &Panel) -> Outcome<B> {
    let steps = panel.lines.iter().map(|(_, v)| v.len()).max().unwrap_or(1);
    let text = |size: u32| ("sans-serif", size).into_font().color(&GREY);
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, text(15))
        .margin(8)
        .x_label_area_size(24)
        .y_label_area_size(48)
        .build_cartesian_2d(0..steps, (LEAST..10.0).log_scale())?;
    chart
        .configure_mesh()
        .disable_x_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GREY.mix(0.3))
        .axis_style(GREY)
        .label_style(text(11))
        .x_labels(6)
        .y_labels(8)
        .y_label_formatter(&|v| format!("{v:.0e}"))
        .draw()?;
    for ((_, values), colour) in panel.lines.iter().zip(COLOURS) {
        let points = values.iter().enumerate().map(|(k, v)| (k + 1, v.max(LEAST)));
        chart.draw_series(LineSeries::new(points, colour.stroke_width(2)))?;
    }
    Ok(())
}

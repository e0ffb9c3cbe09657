//! A row of infants of several ages, on the same scale.

use maud::html;

use super::doll::{Doll, DollSide};
use super::months;
use super::svg::embed;
use babybench::assets::AssetSource;
use babybench::formats::png::{ColorType, png};
use babybench::mimo::BodyFigures;
use babybench::model::Model;

/// Pixels for each metre.
const SCALE: f64 = 640.0;
/// Width of an infant's place, m.
const PLACE: f64 = 0.52;
/// Free space above the tallest infant, m.
const ABOVE: f64 = 0.06;
/// Height of the labels below the ground, pixels.
const BELOW: usize = 92;
/// Width of the scale at the left, pixels.
const LEFT: usize = 74;

const STYLE: &str =
    "text{font:14px system-ui,sans-serif;fill:#80786e}.age{font-size:19px;fill:#34302c}.rule{font-size:12px}";

/// Draws the MIMos of several models side by side, each with his age in months, stature and mass, as an SVG document; `None` if a model has
/// no MIMo.
pub fn draw_ages(infants: &[(f64, &Model)], assets: &dyn AssetSource) -> Option<String> {
    let figures: Option<Vec<_>> = infants.iter().map(|(_, model)| BodyFigures::of(model)).collect();
    let figures = figures?;
    let tallest = figures.iter().fold(0.0, |most: f64, f| most.max(f.stature));
    let [wide, ground] = [(PLACE * SCALE) as usize, ((tallest + ABOVE) * SCALE) as usize];
    let mut dolls = Vec::new();
    for (_, model) in infants {
        let span = ground as f64 / SCALE;
        let pixels = Doll::dressed(model, assets, [wide, ground], span)?.cut_out(DollSide::Front)?;
        dolls.push(embed("png", &png(&pixels, wide, ground, ColorType::Rgba).ok()?));
    }
    let (right, end) = (LEFT + wide * infants.len(), LEFT / 2);
    let size = [right + end, ground + BELOW];
    let tens = (ground as f64 / SCALE * 10.0) as usize;
    let picture = html! {
        svg xmlns="http://www.w3.org/2000/svg" viewBox=(format!("0 0 {} {}", size[0], size[1])) width=(size[0]) height=(size[1]) role="img" {
            title { "MIMo at several ages, on one scale" }
            style { (STYLE) }
            rect width="100%" height="100%" fill="#faf8f4" {}
            // a line every 10 cm
            @for ten in 1..=tens {
                @let row = ground - (ten as f64 * 0.1 * SCALE) as usize;
                path d=(format!("M{LEFT} {row}H{right}")) stroke="#e2ddd4" {}
                text.rule x=(LEFT - 12) y=(row + 4) text-anchor="end" { (10 * ten) " cm" }
            }
            path d=(format!("M{LEFT} {ground}H{right}")) stroke="#9e9486" stroke-width="3" {}
            @for (k, (((age, _), figures), doll)) in infants.iter().zip(&figures).zip(&dolls).enumerate() {
                @let left = LEFT + k * wide;
                @let middle = left + wide / 2;
                image x=(left) y="0" width=(wide) height=(ground) href=(doll) {}
                text.age x=(middle) y=(ground + 36) text-anchor="middle" { (months(*age)) }
                text x=(middle) y=(ground + 66) text-anchor="middle" {
                    (format!("{:.1} cm, {:.1} kg", 100.0 * figures.stature, figures.mass))
                }
            }
        }
    };
    Some(picture.into_string())
}

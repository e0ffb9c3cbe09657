//! A row of infants of several ages, on the same scale.

use crate::assets::AssetSource;
use crate::mimo::BodyFigures;
use crate::model::Model;
use crate::report::doll::{Doll, Side};
use crate::report::lettering::{letter, width};

/// Pixels for each metre.
const SCALE: f64 = 640.0;
/// Width of an infant's place, m.
const PLACE: f64 = 0.52;
/// Free space above the tallest, m.
const ABOVE: f64 = 0.06;
/// Height of the labels below the ground, pixels.
const BELOW: usize = 92;
/// Width of the scale at the left, pixels.
const LEFT: usize = 74;
/// Heights of a letter of the age, of figures, and of the scale, pixels.
const LETTERS: [f32; 3] = [19.0, 14.0, 12.0];

const PAPER: [f32; 3] = [250.0, 248.0, 244.0];
const LINE: [f32; 3] = [226.0, 221.0, 212.0];
const GROUND: [f32; 3] = [158.0, 148.0, 134.0];
const DARK: [f32; 3] = [52.0, 48.0, 44.0];
const PALE: [f32; 3] = [128.0, 120.0, 110.0];

/// A picture: red, green and blue, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AgesPicture {
    /// Bytes, (height, width, 3).
    pub rgb: Vec<u8>,
    /// Pixels.
    pub width: usize,
    /// Pixels.
    pub height: usize,
}

/// Draws the MIMo of each model, which is of the age beside it in months, one beside the other with his stature and mass;
/// `None` if a model has no MIMo.
pub fn draw_ages(infants: &[(f64, &Model)], assets: &dyn AssetSource) -> Option<AgesPicture> {
    let figures: Option<Vec<_>> = infants.iter().map(|(_, model)| BodyFigures::of(model)).collect();
    let figures = figures?;
    let tallest = figures.iter().fold(0.0, |most: f64, f| most.max(f.stature));
    let place = [(PLACE * SCALE) as usize, ((tallest + ABOVE) * SCALE) as usize];
    let mut sheet = Sheet::new(LEFT + place[0] * infants.len() + LEFT / 2, place[1] + BELOW, place[1]);
    sheet.rule();
    for (k, ((age, model), figures)) in infants.iter().zip(&figures).enumerate() {
        let left = LEFT + k * place[0];
        let span = place[1] as f64 / SCALE;
        let infant = Doll::dressed(model, assets, place, span)?.cut_out(Side::Front)?;
        sheet.put(&infant, place[0], left);
        let middle = left as f32 + place[0] as f32 / 2.0;
        let plural = if *age == 1.0 { "month" } else { "months" };
        let ground = sheet.ground as f32;
        sheet.center(&format!("{age} {plural}"), [middle, ground + 36.0], LETTERS[0], DARK);
        let (tall, heavy) = (100.0 * figures.stature, figures.mass);
        let label = format!("{tall:.1} cm  {heavy:.1} kg");
        sheet.center(&label, [middle, ground + 66.0], LETTERS[1], PALE);
    }
    Some(AgesPicture {
        rgb: sheet.rgb,
        width: sheet.width,
        height: sheet.height,
    })
}

/// The canvas.
struct Sheet {
    rgb: Vec<u8>,
    width: usize,
    height: usize,
    /// Row of the ground.
    ground: usize,
}

impl Sheet {
    fn new(width: usize, height: usize, ground: usize) -> Self {
        let pixel = PAPER.map(|v| v as u8);
        Self {
            rgb: pixel.repeat(width * height),
            width,
            height,
            ground,
        }
    }

    /// Draws the ground, and a line with its height every 10 cm.
    fn rule(&mut self) {
        let tens = self.ground as f64 / SCALE * 10.0;
        for ten in 1..=tens as usize {
            let row = self.ground - (ten as f64 * 0.1 * SCALE) as usize;
            self.line(row, 1, LINE);
            let label = format!("{} cm", 10 * ten);
            let left = LEFT as f32 - 12.0 - width(&label, LETTERS[2]);
            self.write(&label, [left, row as f32 + 5.0], LETTERS[2], PALE);
        }
        self.line(self.ground, 3, GROUND);
    }

    fn line(&mut self, row: usize, thick: usize, color: [f32; 3]) {
        for row in row..(row + thick).min(self.height) {
            for column in LEFT..self.width - LEFT / 2 {
                self.blend(column as i32, row as i32, color, 1.0);
            }
        }
    }

    /// Puts a picture with opacity on the ground.
    fn put(&mut self, rgba: &[u8], wide: usize, left: usize) {
        let high = rgba.len() / 4 / wide;
        let (pixels, _) = rgba.as_chunks::<4>();
        for (k, [r, g, b, cover]) in pixels.iter().enumerate() {
            let (column, row) = (left + k % wide, self.ground - high + k / wide);
            let color = [r, g, b].map(|v| f32::from(*v));
            self.blend(column as i32, row as i32, color, f32::from(*cover) / 255.0);
        }
    }

    fn center(&mut self, text: &str, [middle, baseline]: [f32; 2], height: f32, color: [f32; 3]) {
        self.write(text, [middle - width(text, height) / 2.0, baseline], height, color);
    }

    fn write(&mut self, text: &str, at: [f32; 2], height: f32, color: [f32; 3]) {
        letter(text, at, height, |column, row, cover| {
            self.blend(column, row, color, cover)
        });
    }

    fn blend(&mut self, column: i32, row: i32, color: [f32; 3], cover: f32) {
        let inside = |at: i32, size: usize| usize::try_from(at).ok().filter(|&at| at < size);
        let (Some(column), Some(row)) = (inside(column, self.width), inside(row, self.height)) else {
            return;
        };
        let at = 3 * (row * self.width + column);
        for (v, c) in self.rgb[at..at + 3].iter_mut().zip(color) {
            *v = (f32::from(*v) + cover * (c - f32::from(*v)) + 0.5) as u8;
        }
    }
}

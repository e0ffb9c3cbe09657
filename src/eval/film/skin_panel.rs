//! The touch panel of an evaluation video: the skin from above, touched sensors in red, contacts of the hands in
//! yellow.

use crate::config::Compat;
use crate::env::Env;
use crate::math::*;

/// Side of the panel, pixels.
const SIDE: usize = 240;
/// Position of the hip in the panel: column, row. Measured on the reference's panel, like the next two numbers.
const HIP: [f64; 2] = [118.74, 136.76];
/// Pixels per metre at the height of the hip.
const SCALE: f64 = 198.2;
/// Growth of the scale per metre above the hip.
const PERSPECTIVE: f64 = 0.0593;
/// Smallest force that counts as felt, N.
const FELT: f64 = 1e-7;
/// Pixels of a point (1/72 inch) of the reference's plot.
const POINT: f64 = 100.0 / 72.0;

/// The panel of an evaluation video that shows the skin.
#[derive(Clone, Debug)]
pub(super) struct SkinPanel {
    rgb: Vec<u8>,
}

impl SkinPanel {
    pub fn new() -> Self {
        let rgb = vec![255; 3 * SIDE * SIDE];
        Self { rgb }
    }

    /// Draws the skin of the environment with its current forces; returns `None` if touch is off.
    pub fn draw(&mut self, env: &Env) -> Option<&[u8]> {
        let (touch, model, s) = (env.senses().touch()?, env.model(), env.state());
        let hip = s.xpos[model.body("hip")?];
        self.rgb.fill(255);
        let width = touch.width();
        let force = |values: &[f32]| values.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>().sqrt();
        let mut felt: Vec<(Vec3, f64)> = Vec::new();
        for body in touch.layout().bodies() {
            let (at, frame) = (s.xpos[body.body], &s.xmat[body.body]);
            let values = touch.body_values(body.body).chunks_exact(width);
            for (position, value) in body.positions().iter().zip(values) {
                let place = sub(add(at, mat_vec(frame, *position)), hip);
                match force(value) {
                    f if f > FELT => felt.push((place, f)),
                    _ => self.dot(place, 10.0, [0.0; 3], 0.15),
                }
            }
        }
        let most = felt.iter().fold(FELT, |m, (_, f)| m.max(*f));
        for (place, force) in felt {
            let share = force / most;
            self.dot(place, 5.0 + 5.0 * share, [255.0, 0.0, 0.0], 0.4 + 0.1 * share);
        }
        let hands = [model.body("right_hand")?, model.body("left_hand")?];
        let root = model.body("hip")?;
        for c in &s.contact {
            let bodies = c.geom.map(|g| model.geom_bodyid[g]);
            let own = bodies.iter().all(|&b| model.in_subtree(b, root));
            if own && bodies.iter().any(|b| hands.contains(b)) {
                // the reference leaves these where they are in the world
                let place = match env.config().compat {
                    Compat::Api => sub(c.pos, hip),
                    Compat::Reference => c.pos,
                };
                self.dot(place, 20.0, [255.0, 255.0, 0.0], 0.8);
            }
        }
        Some(&self.rgb)
    }

    /// Draws a disc with an area in square points at a position relative to the hip, m.
    fn dot(&mut self, [x, y, z]: Vec3, area: f64, color: [f64; 3], opacity: f64) {
        let scale = SCALE / (1.0 - PERSPECTIVE * z).max(0.1);
        let center = [HIP[0] + scale * y, HIP[1] + scale * x];
        let radius = 0.5 * POINT * area.sqrt();
        let span = |c: f64| {
            let low = (c - radius - 0.5).floor().max(0.0) as usize;
            low..((c + radius + 1.5).clamp(0.0, SIDE as f64) as usize)
        };
        for row in span(center[1]) {
            for column in span(center[0]) {
                let (dx, dy) = (column as f64 + 0.5 - center[0], row as f64 + 0.5 - center[1]);
                let cover = opacity * (radius + 0.5 - (dx * dx + dy * dy).sqrt()).clamp(0.0, 1.0);
                let at = 3 * (row * SIDE + column);
                for (old, new) in self.rgb[at..at + 3].iter_mut().zip(color) {
                    *old = (f64::from(*old) + cover * (new - f64::from(*old))) as u8;
                }
            }
        }
    }
}

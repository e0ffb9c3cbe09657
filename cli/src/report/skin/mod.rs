//! A picture of the skin and of the forces on it.

mod trace;

use babybench::math::*;
use babybench::model::{GeomType, Model};
use babybench::render::MAX_SIZE;
use babybench::sensors::touch::{SkinLayout, Touch};
use trace::trace;

/// Colour of the background.
const PAPER: [f64; 3] = [255.0, 255.0, 255.0];
/// Colour of a touched sensor and of forces.
const FORCE: [f64; 3] = [200.0, 20.0, 30.0];
/// Colours of the skin of bodies, in turn.
const SKIN: [[f64; 3]; 6] = [
    [244.0, 205.0, 178.0],
    [178.0, 206.0, 232.0],
    [198.0, 224.0, 180.0],
    [232.0, 208.0, 238.0],
    [250.0, 226.0, 158.0],
    [190.0, 226.0, 222.0],
];
/// Length of the arrow of the largest force, m.
const ARROW: f64 = 0.12;

/// An image: rows from top to bottom, three bytes (red, green, blue) per pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Bytes, `3 * width * height`.
    pub rgb: Vec<u8>,
}

impl Picture {
    fn blank(width: usize, height: usize) -> Self {
        let rgb = PAPER.map(|c| c as u8).repeat(width * height);
        Self { width, height, rgb }
    }

    /// Blends `color` over everything closer than `radius` to the line from `a` to `b`, with smooth edges.
    fn stroke(&mut self, a: [f64; 2], b: [f64; 2], radius: f64, color: [f64; 3], opacity: f64) {
        let bound = |k: usize, limit: usize| {
            let low = (a[k].min(b[k]) - radius - 1.0).max(0.0) as usize;
            let high = (a[k].max(b[k]) + radius + 2.0).clamp(0.0, limit as f64) as usize;
            low..high
        };
        let (columns, rows) = (bound(0, self.width), bound(1, self.height));
        let along = [b[0] - a[0], b[1] - a[1]];
        let length2 = along[0] * along[0] + along[1] * along[1];
        for y in rows {
            for x in columns.clone() {
                let from = [x as f64 + 0.5 - a[0], y as f64 + 0.5 - a[1]];
                let t = match length2 {
                    0.0 => 0.0,
                    _ => ((from[0] * along[0] + from[1] * along[1]) / length2).clamp(0.0, 1.0),
                };
                let off = [from[0] - t * along[0], from[1] - t * along[1]];
                let distance = (off[0] * off[0] + off[1] * off[1]).sqrt();
                let cover = opacity * (radius + 0.5 - distance).clamp(0.0, 1.0);
                if cover > 0.0 {
                    let i = 3 * (y * self.width + x);
                    for (pixel, c) in self.rgb[i..i + 3].iter_mut().zip(color) {
                        *pixel = (f64::from(*pixel) * (1.0 - cover) + c * cover).round() as u8;
                    }
                }
            }
        }
    }
}

/// Sensors this much (m) below the visible surface are hidden.
const HIDDEN: f64 = 0.003;

/// A viewing direction, in the frame of the first body with skin. Up is z.
struct ViewDirection {
    /// The axis from left to right in the picture.
    across: usize,
    /// Its sign.
    across_sign: f64,
    /// The axis from the body to the eye.
    depth: usize,
    /// Its sign.
    depth_sign: f64,
}

impl ViewDirection {
    const fn new(across: usize, across_sign: f64, depth: usize, depth_sign: f64) -> Self {
        Self {
            across,
            across_sign,
            depth,
            depth_sign,
        }
    }
}

/// From the front, from the right side, from the back.
const DIRECTIONS: [ViewDirection; 3] = [
    ViewDirection::new(1, 1.0, 0, 1.0),
    ViewDirection::new(0, 1.0, 1, -1.0),
    ViewDirection::new(1, -1.0, 0, -1.0),
];

/// A sensor.
struct SensorDot {
    place: Vec3,
    spacing: f64,
    color: [f64; 3],
    /// Largest component of its value, relative to the largest of all sensors; 0 when nothing is felt.
    felt: f64,
}

/// A geom with skin.
struct SkinSolid {
    kind: GeomType,
    size: Vec3,
    pos: Vec3,
    mat: Mat3,
    color: [f64; 3],
}

/// The part of a picture into which one direction is drawn.
struct Canvas<'a> {
    picture: &'a mut Picture,
    direction: &'a ViewDirection,
    left: f64,
    scale: f64,
    /// Horizontal coordinate of the left border and height of the upper one, m.
    corner: [f64; 2],
    /// Coordinate of the visible surface towards the eye at each pixel, m.
    nearness: Vec<f64>,
}

impl Canvas<'_> {
    fn at(&self, p: Vec3) -> [f64; 2] {
        let x = self.direction.across_sign * p[self.direction.across] - self.corner[0];
        [self.left + x * self.scale, (self.corner[1] - p[2]) * self.scale]
    }

    fn draw_solid(&mut self, g: &SkinSolid) {
        let &ViewDirection {
            across,
            across_sign,
            depth,
            depth_sign,
        } = self.direction;
        let reach = g.size.iter().sum::<f64>();
        let [x, y] = self.at(g.pos);
        let range = |c: f64, limit: usize| {
            let r = reach * self.scale;
            (c - r).clamp(0.0, limit as f64) as usize..(c + r + 1.0).clamp(0.0, limit as f64) as usize
        };
        let (columns, rows) = (range(x, self.picture.width), range(y, self.picture.height));
        let mut gaze = [0.0; 3];
        gaze[depth] = -depth_sign;
        let gaze_in_geom = mat_t_vec(&g.mat, gaze);
        for row in rows {
            for column in columns.clone() {
                let mut eye = [0.0; 3];
                eye[across] = across_sign * (self.corner[0] + (column as f64 + 0.5 - self.left) / self.scale);
                eye[2] = self.corner[1] - (row as f64 + 0.5) / self.scale;
                eye[depth] = g.pos[depth] + depth_sign * 2.0 * reach;
                let origin = mat_t_vec(&g.mat, sub(eye, g.pos));
                let Some((t, normal)) = trace(g.kind, g.size, origin, gaze_in_geom) else {
                    continue;
                };
                let nearness = depth_sign * eye[depth] - t;
                let pixel = row * self.picture.width + column;
                if nearness > self.nearness[pixel] {
                    self.nearness[pixel] = nearness;
                    let light = 0.62 + 0.38 * -dot(normal, gaze_in_geom);
                    let color = g.color.map(|c| (c * light).round() as u8);
                    self.picture.rgb[3 * pixel..3 * pixel + 3].copy_from_slice(&color);
                }
            }
        }
    }

    fn sees(&self, p: Vec3) -> bool {
        let [x, y] = self.at(p);
        let inside = x >= 0.0 && y >= 0.0 && (x as usize) < self.picture.width && (y as usize) < self.picture.height;
        let nearness = self.direction.depth_sign * p[self.direction.depth];
        inside && nearness > self.nearness[y as usize * self.picture.width + x as usize] - HIDDEN
    }

    fn draw_dot(&mut self, d: &SensorDot) {
        let p = self.at(d.place);
        if d.felt > 0.0 {
            let radius = (0.35 * d.spacing * self.scale).max(2.0);
            self.picture.stroke(p, p, radius, FORCE, 0.3 + 0.7 * d.felt);
        } else {
            let radius = (0.12 * d.spacing * self.scale).clamp(0.5, 2.2);
            self.picture.stroke(p, p, radius, d.color.map(|c| 0.4 * c), 0.8);
        }
    }
}

/// The geometry to draw, in the frame of the first body with skin.
struct SkinDrawing {
    dots: Vec<SensorDot>,
    solids: Vec<SkinSolid>,
    /// Points of contact and forces on the skin, N.
    arrows: Vec<(Vec3, Vec3)>,
}

impl SkinDrawing {
    /// Collects the geometry, in the frame of the body `first`.
    fn new(
        model: &Model,
        layout: &SkinLayout,
        xpos: &[Vec3],
        xmat: &[Mat3],
        touch: Option<&Touch>,
        first: usize,
    ) -> Self {
        let to_frame = |p: Vec3| mat_t_vec(&xmat[first], sub(p, xpos[first]));
        let strength = |value: &[f32]| value.iter().fold(0.0_f64, |m, v| m.max(f64::from(v.abs())));
        let strongest = touch.map_or(0.0, |t| strength(t.values())).max(f64::MIN_POSITIVE);
        let (mut dots, mut solids) = (Vec::new(), Vec::new());
        for (k, body) in layout.bodies().iter().enumerate() {
            let b = body.body;
            let color = SKIN[k % SKIN.len()];
            let values = touch.map_or(&[][..], |t| t.body_values(body.body));
            let width = touch.map_or(1, Touch::width);
            let placed = |p: Vec3| to_frame(add(xpos[b], mat_vec(&xmat[b], p)));
            for (i, p) in body.positions().iter().enumerate() {
                let value = values.get(width * i..width * (i + 1)).unwrap_or(&[]);
                dots.push(SensorDot {
                    place: placed(*p),
                    spacing: body.spacing,
                    color,
                    felt: strength(value) / strongest,
                });
            }
            for g in &body.geoms {
                let turned = mat_mul(&xmat[b], &g.mat);
                solids.push(SkinSolid {
                    kind: model.geom_type[g.geom],
                    size: model.geom_size[g.geom],
                    pos: placed(model.geom_pos[g.geom]),
                    mat: mat_mul(&transpose(&xmat[first]), &turned),
                    color,
                });
            }
        }
        let felt = touch.map_or(&[][..], Touch::contacts).iter();
        let arrows = felt
            .map(|c| (to_frame(c.point), mat_t_vec(&xmat[first], c.force)))
            .collect();
        Self { dots, solids, arrows }
    }

    /// Returns the bounds along each axis, m, of everything and of the arrows.
    fn bounds(&self) -> [(f64, f64); 3] {
        let room = if self.arrows.is_empty() { 0.02 } else { 0.6 * ARROW };
        std::array::from_fn(|k| {
            let places = self.dots.iter().map(|d| d.place[k]);
            let (low, high) = places.fold((0.0_f64, 0.0_f64), |(l, h), x| (l.min(x), h.max(x)));
            (low - room, high + room)
        })
    }

    fn draw(&self, canvas: &mut Canvas) {
        self.solids.iter().for_each(|g| canvas.draw_solid(g));
        for touched in [false, true] {
            for d in self.dots.iter().filter(|d| (d.felt > 0.0) == touched) {
                if canvas.sees(d.place) {
                    canvas.draw_dot(d);
                }
            }
        }
        let largest = self.arrows.iter().fold(f64::MIN_POSITIVE, |m, a| m.max(norm(a.1)));
        for (point, force) in &self.arrows {
            let (direction, size) = unit(*force);
            let tip = add_scaled(*point, direction, ARROW * (size / largest).sqrt());
            let (from, to) = (canvas.at(*point), canvas.at(tip));
            draw_arrow(canvas.picture, from, to);
        }
    }
}

/// Draws the sensors of a skin on its geoms, at the body poses `xpos` (m) and `xmat`, seen from the front, from the
/// right side and from the back of the first body that feels (MIMo's hip), without perspective; `height` pixels high
/// (at least 64, at most [`MAX_SIZE`]). The views are smaller where together they would be wider than four times
/// [`MAX_SIZE`].
///
/// With a `touch` of the same instant the sensors that feel are red, the more the stronger, and arrows from the points
/// of contact show the forces on the skin, their length growing with the square root of the force.
pub fn draw_skin(
    model: &Model,
    layout: &SkinLayout,
    xpos: &[Vec3],
    xmat: &[Mat3],
    touch: Option<&Touch>,
    height: usize,
) -> Picture {
    let height = height.clamp(64, MAX_SIZE);
    let Some(first) = layout.bodies().first().map(|b| b.body) else {
        return Picture::blank(height, height);
    };
    let figure = SkinDrawing::new(model, layout, xpos, xmat, touch, first);
    let bounds = figure.bounds();
    let extents = bounds.map(|(low, high)| high - low);
    let across = DIRECTIONS.iter().map(|d| extents[d.across]).sum::<f64>();
    let scale = (height as f64 / extents[2]).min(4.0 * MAX_SIZE as f64 / across);
    let widths = DIRECTIONS.map(|d| extents[d.across] * scale);
    let mut picture = Picture::blank(widths.iter().sum::<f64>().ceil() as usize, height);
    let mut left = 0.0;
    for (direction, width) in DIRECTIONS.iter().zip(widths) {
        let (low, high) = bounds[direction.across];
        let mut canvas = Canvas {
            nearness: vec![f64::NEG_INFINITY; picture.width * picture.height],
            corner: [if direction.across_sign > 0.0 { low } else { -high }, bounds[2].1],
            picture: &mut picture,
            direction,
            left,
            scale,
        };
        figure.draw(&mut canvas);
        left += width;
    }
    picture
}

fn draw_arrow(picture: &mut Picture, from: [f64; 2], to: [f64; 2]) {
    let dark = FORCE.map(|c| c * 0.6);
    picture.stroke(from, to, 1.2, dark, 1.0);
    let d = [to[0] - from[0], to[1] - from[1]];
    let length = (d[0] * d[0] + d[1] * d[1]).sqrt();
    if length > 1.0 {
        let head = (0.3 * length).min(9.0) / length;
        for side in [-0.5, 0.5] {
            let back = [-d[0] - side * d[1], -d[1] + side * d[0]];
            picture.stroke(to, [to[0] + head * back[0], to[1] + head * back[1]], 1.2, dark, 1.0);
        }
    }
}

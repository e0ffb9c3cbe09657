//! Light at the vertices: ambient, diffuse and Blinn's highlights, as fixed-function OpenGL computes them.

use super::camera::{Eye, V3, dot, single, unit};
use super::frame::Draw;
use crate::math::{add, mat_vec};
use crate::render::mesh::Part;
use crate::render::visual::{Drawable, Lamp, Poses, Visual};

/// Highlights weaker than this are not computed.
const FAINT: f32 = 1e-4;
const LN_FAINT: f32 = -9.210_340_5;

/// A light at its place.
#[derive(Clone, Copy, Debug)]
pub struct PlacedLamp {
    /// Position; none for parallel light.
    pub pos: Option<V3>,
    /// Unit direction in which it shines.
    pub dir: V3,
    ambient: V3,
    diffuse: V3,
    specular: V3,
    attenuation: V3,
    cos_cutoff: f32,
    exponent: f32,
    /// Whether it makes highlights.
    shines: bool,
}

/// Places the lights of a scene, the headlight first.
pub fn place(visual: &Visual, poses: &Poses, eye: &Eye, out: &mut Vec<PlacedLamp>) {
    out.clear();
    if let Some([ambient, diffuse, specular]) = visual.headlight {
        out.push(PlacedLamp {
            pos: None,
            dir: eye.forward,
            ambient,
            diffuse,
            specular,
            attenuation: [1.0, 0.0, 0.0],
            cos_cutoff: -1.0,
            exponent: 0.0,
            shines: specular != [0.0; 3],
        });
    }
    out.extend(visual.lamps.iter().map(|l: &Lamp| {
        PlacedLamp {
            pos: l
                .pos
                .map(|p| single(add(poses.xpos[l.body], mat_vec(&poses.xmat[l.body], p)))),
            dir: unit(single(mat_vec(&poses.xmat[l.body], l.dir))),
            ambient: l.ambient,
            diffuse: l.diffuse,
            specular: l.specular,
            attenuation: l.attenuation,
            cos_cutoff: l.cos_cutoff,
            exponent: l.exponent,
            shines: l.specular != [0.0; 3],
        }
    }));
}

/// The colour of a vertex of a unit shape under the lights, 0..1.
pub fn vertex(
    lamps: &[PlacedLamp],
    drawable: &Drawable,
    draw: &Draw,
    eye: V3,
    (part, at, normal): (Part, V3, V3),
) -> V3 {
    let size = drawable.size;
    let cap = 0.5 * (size[0] + size[1]);
    let (stretch, shift) = match part {
        Part::Body => (size[2], 0.0),
        Part::Top => (cap, size[2] - cap),
        Part::Bottom => (cap, cap - size[2]),
    };
    let m = &draw.mat;
    let turn = |v: V3| {
        [
            m[0] * v[0] + m[1] * v[1] + m[2] * v[2],
            m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
            m[6] * v[0] + m[7] * v[1] + m[8] * v[2],
        ]
    };
    let p = turn([at[0] * size[0], at[1] * size[1], at[2] * stretch + shift]);
    let p = [p[0] + draw.pos[0], p[1] + draw.pos[1], p[2] + draw.pos[2]];
    // the inverse of the scale, times all of it: the length does not matter
    let n = unit(turn([
        normal[0] * (size[1] * stretch),
        normal[1] * (size[0] * stretch),
        normal[2] * (size[0] * size[1]),
    ]));
    let to_eye = if drawable.specular > 0.0 {
        unit([eye[0] - p[0], eye[1] - p[1], eye[2] - p[2]])
    } else {
        [0.0; 3]
    };
    // without any light there is a little
    let glow = if lamps.is_empty() { 0.3 } else { 0.0 } + drawable.emission;
    let (mut dull, mut shine) = ([glow; 3], [0.0; 3]);
    for lamp in lamps {
        let (to_lamp, strength) = lamp.reach(p);
        let facing = dot(n, to_lamp);
        let facing = if facing > 0.0 { facing } else { 0.0 };
        for k in 0..3 {
            dull[k] += strength * (lamp.ambient[k] + facing * lamp.diffuse[k]);
        }
        if facing > 0.0 && drawable.specular > 0.0 && lamp.shines {
            let middle = [to_lamp[0] + to_eye[0], to_lamp[1] + to_eye[1], to_lamp[2] + to_eye[2]];
            if !faint(dot(n, middle), dot(middle, middle), drawable.exponent) {
                let highlight = strength * drawable.specular * power(dot(n, unit(middle)), drawable.exponent);
                for k in 0..3 {
                    shine[k] += highlight * lamp.specular[k];
                }
            }
        }
    }
    let mut colour = shine;
    for k in 0..3 {
        colour[k] = (shine[k] + dull[k] * drawable.rgba[k]).clamp(0.0, 1.0);
    }
    colour
}

/// Whether `(along / sqrt(squared))^y` is certainly not visible.
fn faint(along: f32, squared: f32, y: f32) -> bool {
    let least = 1.0 + 1.001 * LN_FAINT / y;
    least > 0.0 && (along <= 0.0 || along * along < least * least * squared)
}

/// `x^y` for x up to 1; 0 where it is not visible.
fn power(x: f32, y: f32) -> f32 {
    // x^y <= exp(y (x - 1))
    debug_assert!((LN_FAINT - FAINT.ln()).abs() < 1e-4);
    if x <= 0.0 {
        if y == 0.0 { 1.0 } else { 0.0 }
    } else if y * (x - 1.0) < LN_FAINT {
        0.0
    } else if x > 0.7 && x <= 1.001 && (0.0..=256.0).contains(&y) {
        near_one(f64::from(x), y) as f32
    } else {
        // in double precision: the single-precision routine picks its instructions at run time
        pxfm::f_pow(f64::from(x), f64::from(y)) as f32
    }
}

/// `x^y` for x in 0.7..1, to 1e-8: the whole part of y by squaring, the rest by series.
fn near_one(x: f64, y: f32) -> f64 {
    let mut rest = y as u32;
    let part = f64::from(y - rest as f32);
    // 2 artanh((x - 1) / (x + 1)) is the logarithm
    let t = (x - 1.0) / (x + 1.0);
    let u = t * t;
    let log = 2.0 * t * (1.0 + u * (1.0 / 3.0 + u * (1.0 / 5.0 + u * (1.0 / 7.0))));
    let z = part * log;
    let series = 1.0 / 6.0 + z * (1.0 / 24.0 + z * (1.0 / 120.0 + z * (1.0 / 720.0 + z * (1.0 / 5040.0))));
    let (mut product, mut square) = (1.0 + z * (1.0 + z * (0.5 + z * series)), x);
    while rest > 0 {
        if rest & 1 == 1 {
            product *= square;
        }
        square *= square;
        rest >>= 1;
    }
    product
}

impl PlacedLamp {
    /// Unit direction from a point to the light, and what is left of its strength there.
    fn reach(&self, p: V3) -> (V3, f32) {
        let Some(pos) = self.pos else {
            return (self.dir.map(|v| -v), 1.0);
        };
        let d = [pos[0] - p[0], pos[1] - p[1], pos[2] - p[2]];
        let distance = dot(d, d).sqrt();
        let to_lamp = d.map(|v| v / distance);
        let [constant, linear, quadratic] = self.attenuation;
        let mut strength = 1.0 / (constant + linear * distance + quadratic * distance * distance);
        if self.cos_cutoff > -1.0 {
            let along = -dot(to_lamp, self.dir);
            strength *= if along < self.cos_cutoff {
                0.0
            } else {
                power(along, self.exponent)
            };
        }
        (to_lamp, strength)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_right() {
        for x in [0.0, 0.2, 0.69, 0.71, 0.9, 0.999, 1.0f32] {
            for y in [0.0, 0.3, 1.0, 38.4, 64.0, 300.0f32] {
                let exact = f64::from(x).powf(f64::from(y));
                let found = f64::from(power(x, y));
                assert!((found - exact).abs() <= 1.1 * f64::from(FAINT), "{x} ^ {y}: {found}");
                if x > 0.7 && x < 1.0 && y <= 256.0 {
                    assert!((near_one(f64::from(x), y) - exact).abs() < 1e-7, "{x} ^ {y}");
                }
            }
        }
    }
}

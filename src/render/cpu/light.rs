//! Light at the vertices: ambient, diffuse and Blinn's highlights, as fixed-function OpenGL computes them.

use super::Draw;
use super::camera::{Eye, V3, dot, single, unit};
use crate::math::{add, mat_vec};
use crate::render::mesh::Part;
use crate::render::visual::{Drawable, Lamp, Poses, Visual};

/// Highlights weaker than this are not computed.
const FAINT: f32 = 1e-4;

/// A light at its place.
#[derive(Clone, Copy, Debug)]
pub struct PlacedLamp {
    /// Position; none for parallel light.
    pos: Option<V3>,
    /// Unit direction in which it shines.
    dir: V3,
    ambient: V3,
    diffuse: V3,
    specular: V3,
    attenuation: V3,
    cos_cutoff: f32,
    exponent: f32,
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
    let turn = |v: V3| {
        let m = &draw.mat;
        [
            m[0] * v[0] + m[1] * v[1] + m[2] * v[2],
            m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
            m[6] * v[0] + m[7] * v[1] + m[8] * v[2],
        ]
    };
    let p = turn([at[0] * size[0], at[1] * size[1], at[2] * stretch + shift]);
    let p = [p[0] + draw.pos[0], p[1] + draw.pos[1], p[2] + draw.pos[2]];
    let n = unit(turn([normal[0] / size[0], normal[1] / size[1], normal[2] / stretch]));
    let to_eye = unit([eye[0] - p[0], eye[1] - p[1], eye[2] - p[2]]);
    let own = [drawable.rgba[0], drawable.rgba[1], drawable.rgba[2]];
    // without any light there is a little
    let glow = if lamps.is_empty() { 0.3 } else { 0.0 } + drawable.emission;
    let mut colour = own.map(|c| glow * c);
    for lamp in lamps {
        let (to_lamp, strength) = lamp.reach(p);
        let facing = dot(n, to_lamp);
        for k in 0..3 {
            colour[k] += strength * (lamp.ambient[k] + facing.max(0.0) * lamp.diffuse[k]) * own[k];
        }
        let shiny = drawable.specular > 0.0 && lamp.specular != [0.0; 3];
        if facing > 0.0 && shiny {
            let middle = unit([to_lamp[0] + to_eye[0], to_lamp[1] + to_eye[1], to_lamp[2] + to_eye[2]]);
            let highlight = strength * drawable.specular * power(dot(n, middle), drawable.exponent);
            for k in 0..3 {
                colour[k] += highlight * lamp.specular[k];
            }
        }
    }
    colour.map(|c| c.clamp(0.0, 1.0))
}

/// `x^y` for x up to 1; 0 where it is not visible.
fn power(x: f32, y: f32) -> f32 {
    // x^y <= exp(y (x - 1))
    const LN_FAINT: f32 = -9.210_340_5;
    debug_assert!((LN_FAINT - FAINT.ln()).abs() < 1e-4);
    if x <= 0.0 {
        if y == 0.0 { 1.0 } else { 0.0 }
    } else if y * (x - 1.0) < LN_FAINT {
        0.0
    } else {
        // in double precision: the single-precision routine picks its instructions at run time
        pxfm::f_pow(f64::from(x), f64::from(y)) as f32
    }
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

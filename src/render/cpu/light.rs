//! Lighting per vertex, four at a time: ambient, diffuse and Blinn highlights, as fixed-function OpenGL computes them.

use wide::f32x4;

use super::camera::{Vec3f, ViewCamera, unit};
use super::frame::PlacedDrawable;
use super::lanes::{four, three};
use crate::drawable::Drawable;
use crate::math::{Vec3, add, mat_vec, sub};
use crate::mesh::MeshPart;
use crate::scenery::{LightAim, LightSource, Scenery};
use crate::single::single;
use crate::view::Poses;

/// Strength of the weakest highlight that is computed.
const FAINT: f32 = 1e-4;
const LN_FAINT: f32 = -9.210_340_5;

/// A light with its pose in the world.
#[derive(Clone, Copy, Debug)]
pub struct PlacedLight {
    /// Position in the world, m; `None` for directional light.
    pub pos: Option<Vec3f>,
    /// Unit direction in which it shines.
    pub dir: Vec3f,
    ambient: Vec3f,
    diffuse: Vec3f,
    specular: Vec3f,
    attenuation: Vec3f,
    cos_cutoff: f32,
    exponent: f32,
    /// Whether it produces highlights.
    shines: bool,
}

/// Places the lights of a scene, the headlight first.
pub fn place(scenery: &Scenery, poses: &Poses, eye: &ViewCamera, out: &mut Vec<PlacedLight>) {
    out.clear();
    if let Some([ambient, diffuse, specular]) = scenery.headlight {
        out.push(PlacedLight {
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
    out.extend(scenery.lights.iter().map(|l: &LightSource| {
        let (pos, dir) = pose(l, poses);
        PlacedLight {
            pos: pos.map(single),
            dir: unit(single(dir)),
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

/// Returns the position of a light (`None` if it is directional) and its direction, in the world.
fn pose(light: &LightSource, poses: &Poses) -> (Option<Vec3>, Vec3) {
    let (xpos, xmat) = (poses.xpos[light.body], &poses.xmat[light.body]);
    let in_world = |pos| add(xpos, mat_vec(xmat, pos));
    let (pos, dir) = match light.aim {
        LightAim::Body => return (light.pos.map(in_world), mat_vec(xmat, light.dir)),
        LightAim::Track { offset, dir } => (add(xpos, offset), dir),
        LightAim::TrackCom { offset, dir } => (add(poses.subtree_com[light.body], offset), dir),
        LightAim::Target { body, pos } => (in_world(pos), sub(poses.xpos[body], in_world(pos))),
        LightAim::TargetCom { body, pos } => (in_world(pos), sub(poses.subtree_com[body], in_world(pos))),
    };
    (light.pos.map(|_| pos), crate::math::unit(dir).0)
}

/// Four vectors, by component.
pub type Vec3x4 = [f32x4; 3];

/// Four vertices of a unit shape: parts, positions, normals.
pub struct VertexGroup {
    pub part: [MeshPart; 4],
    pub at: Vec3x4,
    pub normal: Vec3x4,
}

#[inline(always)]
fn dots(a: &Vec3x4, b: &Vec3x4) -> f32x4 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn units(a: &Vec3x4) -> Vec3x4 {
    let scale = f32x4::ONE / dots(a, a).sqrt();
    three(|k| a[k] * scale)
}

#[inline(always)]
fn splat(v: Vec3f) -> Vec3x4 {
    three(|k| f32x4::splat(v[k]))
}

/// Computes the colours (0..1) of four vertices of a drawable under the lights.
pub fn vertices(
    lights: &[PlacedLight],
    drawable: &Drawable,
    draw: &PlacedDrawable,
    eye: Vec3f,
    corners: &VertexGroup,
) -> Vec3x4 {
    let size = drawable.size;
    // as in the projection: the caps of a capsule are scaled by its radius, not by its length
    let cap = 0.5 * (size[0] + size[1]);
    let ends = four(|k| match corners.part[k] {
        MeshPart::Body => (size[2], 0.0),
        MeshPart::Top => (cap, size[2] - cap),
        MeshPart::Bottom => (cap, cap - size[2]),
    });
    let (stretch, shift) = (f32x4::new(four(|k| ends[k].0)), f32x4::new(four(|k| ends[k].1)));
    let m = draw.mat.map(f32x4::splat);
    let rotate = |v: &Vec3x4| three(|k| m[3 * k] * v[0] + m[3 * k + 1] * v[1] + m[3 * k + 2] * v[2]);
    let at = &corners.at;
    let p = rotate(&[at[0] * size[0], at[1] * size[1], at[2] * stretch + shift]);
    let p = three(|k| p[k] + draw.pos[k]);
    // the inverse of the scale, times all of it: the length does not matter
    let normal = &corners.normal;
    let n = units(&rotate(&[
        normal[0] * (stretch * size[1]),
        normal[1] * (stretch * size[0]),
        normal[2] * (size[0] * size[1]),
    ]));
    // only highlights depend on the point of view
    let to_eye = if drawable.specular > 0.0 {
        units(&three(|k| f32x4::splat(eye[k]) - p[k]))
    } else {
        [f32x4::ZERO; 3]
    };
    shade(lights, drawable, &p, &n, &to_eye)
}

/// Computes the colours (0..1) of points with the unit normals `n`; `to_eye` are the unit directions to the camera.
#[inline(always)]
fn shade(lights: &[PlacedLight], drawable: &Drawable, p: &Vec3x4, n: &Vec3x4, to_eye: &Vec3x4) -> Vec3x4 {
    // a scene without lights is not quite dark
    let glow = if lights.is_empty() { 0.3 } else { 0.0 } + drawable.emission;
    let (mut diffuse, mut highlights) = ([f32x4::splat(glow); 3], [f32x4::ZERO; 3]);
    for light in lights {
        let (to_light, strength) = light.reach(p);
        // Lambert's law
        let facing = dots(n, &to_light);
        let front = facing.simd_gt(f32x4::ZERO);
        let facing = facing & front;
        for k in 0..3 {
            diffuse[k] += strength * (facing * light.diffuse[k] + light.ambient[k]);
        }
        if front.to_bitmask() != 0 && drawable.specular > 0.0 && light.shines {
            // Blinn's half vector, which OpenGL uses instead of the mirrored ray: one sum instead of a reflection
            let middle = three(|k| to_light[k] + to_eye[k]);
            let exponent = drawable.exponent;
            // a power costs more than the rest of a light, and most highlights are too weak for a byte to show
            let shown = front & !faint(dots(n, &middle), dots(&middle, &middle), exponent);
            let bits = shown.to_bitmask();
            if bits != 0 {
                let cosines = dots(n, &units(&middle)).to_array();
                let powers = four(|k| {
                    if bits >> k & 1 == 1 {
                        power(cosines[k], exponent)
                    } else {
                        0.0
                    }
                });
                let highlight = (strength * drawable.specular * f32x4::new(powers)) & shown;
                for k in 0..3 {
                    highlights[k] += highlight * light.specular[k];
                }
            }
        }
    }
    // comparisons, not `min` and `max`: NaN stays, and becomes 0 when it is written as a byte
    let within = |v: f32x4| {
        let (low, high) = (v.simd_lt(f32x4::ZERO), v.simd_gt(f32x4::ONE));
        low.select(f32x4::ZERO, high.select(f32x4::ONE, v))
    };
    three(|k| within(highlights[k] + diffuse[k] * drawable.rgba[k]))
}

/// Returns the lanes in which `(along / sqrt(squared))^y` is certainly too weak to be visible.
#[inline(always)]
fn faint(along: f32x4, squared: f32x4, y: f32) -> f32x4 {
    let least = 1.0 + 1.001 * LN_FAINT / y;
    if least > 0.0 {
        along.simd_le(f32x4::ZERO) | (along * along).simd_lt(squared * (least * least))
    } else {
        f32x4::ZERO
    }
}

/// Computes `x^y` for x up to 1; returns 0 if the result is too weak to be visible.
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
        // in double precision: the single-precision routine picks its instructions at run time, and its last bit with
        // them
        pxfm::f_pow(f64::from(x), f64::from(y)) as f32
    }
}

/// Computes `x^y` for x in 0.7..1, to 1e-8: the integer part of y by squaring, the rest by a series.
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
    // exponentiation by squaring
    while rest > 0 {
        if rest & 1 == 1 {
            product *= square;
        }
        square *= square;
        rest >>= 1;
    }
    product
}

impl PlacedLight {
    /// Returns the unit directions from points to the light, and the share of the light's intensity that arrives there (0..1).
    #[inline(always)]
    fn reach(&self, p: &Vec3x4) -> (Vec3x4, f32x4) {
        // a directional light has no distance to fade with
        let Some(pos) = self.pos else {
            return (splat(self.dir.map(|v| -v)), f32x4::ONE);
        };
        let d = three(|k| f32x4::splat(pos[k]) - p[k]);
        let distance = dots(&d, &d).sqrt();
        let to_light = three(|k| d[k] / distance);
        let [constant, linear, quadratic] = self.attenuation.map(f32x4::splat);
        let mut strength = f32x4::ONE / (constant + linear * distance + quadratic * distance * distance);
        if self.cos_cutoff > -1.0 {
            let along = (-dots(&to_light, &splat(self.dir))).to_array();
            strength *= f32x4::new(four(|k| {
                // the edge of the cone is sharp in OpenGL; what softens a spot light is the power towards its axis
                if along[k] < self.cos_cutoff {
                    0.0
                } else {
                    power(along[k], self.exponent)
                }
            }));
        }
        (to_light, strength)
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

    const POS0: Vec3 = [0.236_602_540_378_443_75, 0.2, 0.209_807_621_135_331_7];
    const COM0: Vec3 = [1.236_602_540_378_443_7, -2.1, 1.209_807_621_135_331_7];
    const DIR0: Vec3 = [
        -0.353_553_390_593_273_8,
        std::f64::consts::FRAC_1_SQRT_2,
        -0.612_372_435_695_794_6,
    ];
    const PLACE: Vec3 = [1.316_125_384_952_760_5, 0.2, 1.008_046_178_500_938_7];

    /// Returns the position and the direction of a light of body 1 whose target is body 2.
    fn placed(aim: LightAim) -> (Option<Vec3>, Vec3) {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let (cos, sin) = (0.340_263_920_455_576_85, 0.940_329_976_357_342_7);
        let identity = crate::math::MAT3_ID;
        let poses = Poses {
            geom_xpos: &[],
            geom_xmat: &[],
            geom_size: &[],
            site_xpos: &[],
            site_xmat: &[],
            ten_wrapadr: &[],
            ten_wrapnum: &[],
            wrap_xpos: &[],
            wrap_obj: &[],
            cam_xpos: &[],
            cam_xmat: &[],
            free: None,
            xpos: &[[0.0; 3], [1.0, 0.0, 1.0], [0.0, 2.0, 0.4]],
            xmat: &[identity, [cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos], identity],
            subtree_com: &[
                [0.0; 3],
                [1.425_485_854_391_165, 0.088_888_888_888_888_89, 1.130_332_187_394_537_6],
                [0.0, 2.3, 0.4],
            ],
            flexvert_xpos: &[],
        };
        let light = LightSource {
            body: 1,
            pos: Some([0.1, 0.2, 0.3]),
            dir: [0.0, half, -half],
            aim,
            ambient: [0.0; 3],
            diffuse: [0.0; 3],
            specular: [0.0; 3],
            attenuation: [1.0, 0.0, 0.0],
            cos_cutoff: -1.0,
            exponent: 0.0,
        };
        pose(&light, &poses)
    }

    /// The expected values are `light_xpos` and `light_xdir` of MuJoCo 3.3.0 for a body that a hinge has turned.
    #[test]
    fn lights_follow_as_in_mujoco() {
        let pos = [0.1, 0.2, 0.3];
        for (aim, at, dir) in [
            (
                LightAim::Body,
                PLACE,
                [
                    -0.664_913_702_835_263_1,
                    std::f64::consts::FRAC_1_SQRT_2,
                    -0.240_602_925_547_258_48,
                ],
            ),
            (
                LightAim::Track {
                    offset: POS0,
                    dir: DIR0,
                },
                [COM0[0], 0.2, COM0[2]],
                DIR0,
            ),
            (
                LightAim::TrackCom {
                    offset: COM0,
                    dir: DIR0,
                },
                [2.662_088_394_769_609, -2.011_111_111_111_110_6, 2.340_139_808_529_869_5],
                DIR0,
            ),
            (
                LightAim::Target { body: 2, pos },
                PLACE,
                [
                    -0.569_441_529_864_488_7,
                    0.778_797_191_722_633_4,
                    -0.263_080_364_585_672_3,
                ],
            ),
            (
                LightAim::TargetCom { body: 2, pos },
                PLACE,
                [
                    -0.515_754_704_551_417_5,
                    0.822_934_419_426_042_4,
                    -0.238_277_204_232_806_57,
                ],
            ),
        ] {
            let (found, shines) = placed(aim);
            let close = |a: Vec3, b: Vec3| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
            assert!(
                close(found.unwrap(), at) && close(shines, dir),
                "{aim:?}: {found:?} {shines:?}"
            );
        }
    }
}

//! Triangle assembly: back faces and triangles that fall between the samples are culled, the others set up and rasterised.

use wide::f32x4;

use super::camera::AffineRow;
use super::clip::{self, ClipVertex, CornerOrigin, EdgePoint, FrustumTest, Polygon};
use super::frame::{ClipPoint, Frame, PlacedDrawable, Targets};
use super::group::{DrawMethod, TriangleGroup};
use super::lanes::{four, three};
use super::plane::Vertex;
use super::raster::{Sink, is_counterclockwise, to_fixed_point};
use super::sampling::{FourSamples, PixelCentre, Sampling};
use super::small::Quads;
use super::target::{NONE, Opaque, Transparent, Triangle, VisibilityBuffer, Writer};
use crate::mesh::{Band, Mesh};
use crate::strip::{STRIP_LANES, Strip};

impl Frame {
    /// Draws a band that is only partly in view.
    pub fn across(&mut self, mesh: &Mesh, rows: &[AffineRow; 4], index: usize, band: &Band) {
        let triangles = &mesh.triangles[band.triangles.clone()];
        // strips describe triangles that are wound as in the mesh
        let (loose, strips): (_, &[Strip]) = if self.draws[index].flip {
            (triangles.len(), &[])
        } else {
            (band.loose, &band.strips)
        };
        for &t in &triangles[..loose] {
            self.cut(mesh, rows, index, t);
        }
        for strip in strips {
            for k in 0..strip.count / STRIP_LANES {
                match self.place_of(index, strip, k) {
                    FrustumTest::Inside => self.quadrilaterals(index, strip, k),
                    FrustumTest::Outside => {}
                    FrustumTest::Across => {
                        for j in STRIP_LANES * k..STRIP_LANES * (k + 1) {
                            let [a, b, c, d] = strip.corners(j);
                            self.cut(mesh, rows, index, [a, b, d]);
                            if !strip.fan {
                                self.cut(mesh, rows, index, [b, c, d]);
                            }
                        }
                    }
                }
            }
        }
    }

    /// Returns where four quadrilaterals of a strip are, by their corners.
    #[inline(always)]
    fn place_of(&self, index: usize, strip: &Strip, k: usize) -> FrustumTest {
        let base = self.draws[index].base;
        // a byte for each quadrilateral, with one bit for each plane that the corner is beyond
        let [a, b, c, d] = four(|i| {
            let from = base + usize::from(strip.first[i]);
            if strip.step[i] == 0 {
                return u32::from_ne_bytes([self.sides[from]; STRIP_LANES]);
            }
            let from = from + STRIP_LANES * k;
            u32::from_ne_bytes(four(|j| self.sides[from..from + STRIP_LANES][j]))
        });
        // bits of planes are the lower six of a byte: a sum with 127 has the highest if there is any
        let each_has_some = |sides: u32| (sides + 0x7f7f_7f7f) & 0x8080_8080 == 0x8080_8080;
        if a | b | c | d == 0 {
            FrustumTest::Inside
        } else if each_has_some(a & b & d) && (strip.fan || each_has_some(b & c & d)) {
            // all corners of each triangle are beyond the same plane
            FrustumTest::Outside
        } else {
            FrustumTest::Across
        }
    }

    /// Draws the part of a triangle that is in view.
    #[inline(always)]
    fn cut(&mut self, mesh: &Mesh, rows: &[AffineRow; 4], index: usize, [a, b, c]: [u16; 3]) {
        let PlacedDrawable { flip, base, .. } = self.draws[index];
        let t = if flip { [a, c, b] } else { [a, b, c] };
        let own = three(|k| base + usize::from(t[k]));
        let [p, q, r] = three(|k| self.sides[own[k]]);
        if p & q & r != 0 {
            return;
        }
        if p | q | r != 0 {
            self.clipped(mesh, rows, index, t, p | q | r);
        } else if self.shows_front(own) {
            self.wait(index, own);
        }
    }

    /// Returns whether a triangle may show its front.
    #[inline(always)]
    fn shows_front(&self, [a, b, c]: [usize; 3]) -> bool {
        let (x, y) = (&self.x, &self.y);
        // rounding may make products equal, but does not change their order
        (x[b] - x[a]) * (y[c] - y[a]) >= (y[b] - y[a]) * (x[c] - x[a])
    }

    /// Draws a band that is wholly in view: the quadrilaterals that may show their front.
    pub fn inside(&mut self, mesh: &Mesh, index: usize, band: &Band) {
        let base = self.draws[index].base;
        for t in &mesh.triangles[band.triangles.clone()][..band.loose] {
            self.wait(index, three(|k| base + usize::from(t[k])));
        }
        for strip in &band.strips {
            for k in 0..strip.count / STRIP_LANES {
                self.quadrilaterals(index, strip, k);
            }
        }
    }

    /// Draws four quadrilaterals of a strip that are wholly in view.
    #[inline(always)]
    fn quadrilaterals(&mut self, index: usize, strip: &Strip, k: usize) {
        let fronts = u32::from(self.fronts[strip.patch + k]);
        // back faces are skipped at once, and their vertices may not even be projected
        if fronts == 0 {
            return;
        }
        let base = self.draws[index].base;
        let step = four(|i| usize::from(strip.step[i]));
        let at = four(|i| base + usize::from(strip.first[i]) + step[i] * STRIP_LANES * k);
        // the same corner of four quadrilaterals lies side by side in memory, or is one vertex for all of them
        let quads = Quads(four(|k| {
            [lanes(&self.x, at[k], step[k]), lanes(&self.y, at[k], step[k])]
        }));
        let front = quads.front();
        // most triangles of a distant shape are smaller than the gaps between samples: this test costs less than
        // setting them up
        let hit = match self.targets {
            _ if front == [0; 2] => 0,
            Targets { centre: false, .. } => quads.hit::<FourSamples>(),
            Targets { colour: false, .. } => quads.hit::<PixelCentre>(),
            _ => quads.hit::<FourSamples>() | quads.hit::<PixelCentre>(),
        };
        let first = front[0] & hit & fronts;
        // in a fan around a pole the second triangle has no area
        let second = if strip.fan { 0 } else { front[1] & hit & fronts };
        let mut rest = first | second;
        while rest != 0 {
            let j = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let [a, b, c, d] = four(|k| at[k] + step[k] * j);
            if first >> j & 1 == 1 {
                self.wait(index, [a, b, d]);
            }
            if second >> j & 1 == 1 {
                self.wait(index, [b, c, d]);
            }
        }
    }

    /// Adds a triangle, given by its vertices, to those waiting to be rasterised.
    #[inline(always)]
    fn wait(&mut self, index: usize, vertices: [usize; 3]) {
        // four triangles of any strips wait for each other: a group that is full costs as much as one with a single
        // triangle
        if self.waiting.add(vertices, &self.vertices) {
            self.flush(index);
        }
    }

    /// Rasterises the waiting triangles.
    #[inline(never)]
    pub fn flush(&mut self, index: usize) {
        let geometry = Geometry {
            vertices: &self.vertices,
            x: &self.x,
            y: &self.y,
        };
        // the kind of the drawable is decided here, outside the loops over pixels, which are compiled for each
        if self.targets.colour && self.draws[index].transparent {
            geometry.raster::<FourSamples, Transparent>(&self.waiting, index, &mut self.colour);
        } else if self.targets.colour {
            geometry.raster::<FourSamples, Opaque>(&self.waiting, index, &mut self.colour);
        }
        if self.targets.centre {
            geometry.raster::<PixelCentre, Opaque>(&self.waiting, index, &mut self.centre);
        }
        self.waiting.clear();
    }

    /// Clips and draws a triangle that reaches beyond some sides of the view volume.
    #[cold]
    fn clipped(&mut self, mesh: &Mesh, rows: &[AffineRow; 4], index: usize, t: [u16; 3], sides: u8) {
        let draw = self.draws[index];
        let half = self.size.map(|n| n as f32 * 0.5);
        let corner = |i: u16| {
            let i = usize::from(i);
            clip::apply(rows, [mesh.x[i], mesh.y[i], mesh.z[i]])
        };
        let triangle: [ClipVertex; 3] = [corner(t[0]), corner(t[1]), corner(t[2])];
        // back faces are dropped before the work of clipping; the rasteriser decides unclear cases
        if clip::faces_away(&triangle) {
            return;
        }
        let mut polygon = Polygon::new(triangle);
        polygon.cut(u32::from(sides));
        let (corners, points) = polygon.parts();
        if corners.len() < 3 {
            return;
        }
        let first = self.vertices.len();
        let place = |source: CornerOrigin| match source {
            CornerOrigin::Own(k) => draw.base + usize::from(t[k]),
            CornerOrigin::New(k) => first + k,
        };
        for &EdgePoint { clip, from, to, share } in points {
            let vertex = clip::project(clip, half);
            let [x, y, ..] = to_fixed_point(f32x4::new([vertex.x, vertex.y, 0.0, 0.0])).to_array();
            self.x.push(x);
            self.y.push(y);
            self.vertices.push(vertex);
            self.sides.push(0);
            self.points.push(ClipPoint {
                from: place(from) as u32,
                to: place(to) as u32,
                share,
            });
        }
        // the fan that Mesa's draw module makes of a polygon: another one would interpolate differently
        for k in 2..corners.len() {
            let [a, b, c] = [
                place(corners[k - 1].from),
                place(corners[k].from),
                place(corners[0].from),
            ];
            self.wait(index, [a, b, c]);
        }
    }
}

/// The projected vertices of a frame.
struct Geometry<'a> {
    vertices: &'a [Vertex],
    /// Their positions, in whole numbers of 1/256 pixels.
    x: &'a [f32],
    y: &'a [f32],
}

impl Geometry<'_> {
    /// Rasterises the waiting triangles, of the kind `K`.
    #[inline(always)]
    fn raster<S: Sampling, K>(&self, waiting: &TriangleGroup, index: usize, target: &mut VisibilityBuffer)
    where
        for<'t> Writer<'t, K>: Sink,
    {
        waiting.each::<S>([target.width, target.height], |own, drawn| {
            let [a, b, c] = own;
            // the order in which Mesa sets triangles up
            let record = Triangle {
                draw: index as u32,
                vertices: [b as u32, a as u32, c as u32],
                setup: NONE,
            };
            match drawn {
                DrawMethod::Spots(spots, depth) => target.spots::<S, K>(&spots, &depth, record),
                DrawMethod::Medium(edges, range, depth) => target.medium::<S, K>(&edges, range, &depth, record),
                DrawMethod::Large => {
                    let fixed = three(|k| [self.x[own[k]] as i32, self.y[own[k]] as i32]);
                    if is_counterclockwise(&fixed) {
                        target.large::<S, K>(&fixed, self.vertices, record);
                    }
                }
            }
        });
    }
}

/// Returns four values, each a step after the previous one.
#[inline(always)]
fn lanes(v: &[f32], from: usize, step: usize) -> f32x4 {
    if step == 0 {
        return f32x4::splat(v[from]);
    }
    let v = &v[from..from + STRIP_LANES];
    f32x4::new([v[0], v[1], v[2], v[3]])
}

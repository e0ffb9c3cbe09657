//! Which triangle is seen at each sample: edges in 1/256 pixels, depth by comparison of 1/w.

/// Nothing is seen.
pub const NONE: u32 = u32::MAX;
/// The four samples of a pixel, in 1/256 of it, from the lower left corner.
pub const SAMPLES: [[i32; 4]; 2] = [[96, 224, 32, 160], [32, 96, 160, 224]];
/// All samples in the centre, for pictures that are not colours.
pub const CENTRE: [[i32; 4]; 2] = [[128; 4]; 2];
/// Coordinates lie within this, 1/256 pixels.
pub const LIMIT: f32 = (1 << 21) as f32;

/// Side of the blocks in which large triangles are tested, pixels.
const BLOCK: i32 = 8;
/// Triangles up to this extent are drawn with 32-bit arithmetic, 1/256 pixels.
const SMALL: i32 = 1 << 14;

/// A projected vertex: 1/256 pixels from the lower left, 1/w.
pub type Corner = (i32, i32, f32);

/// A triangle that is seen somewhere.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    /// Index of what is drawn.
    pub draw: u32,
    /// Its vertices in the frame.
    pub vertices: [u32; 3],
    /// Index of how it is shaded, or [`NONE`].
    pub setup: u32,
}

/// The picture in work; row 0 is the lowest.
#[derive(Debug, Default)]
pub struct Target {
    pub width: usize,
    pub height: usize,
    /// 1/w of each sample; 0 is infinitely far.
    pub depth: Vec<[f32; 4]>,
    /// Index of the record that is seen at each sample.
    pub ids: Vec<[u32; 4]>,
    pub records: Vec<Record>,
    samples: [[i32; 4]; 2],
    /// Extent of the samples within a pixel: least x, greatest x, least y, greatest y.
    margin: [i32; 4],
}

/// An edge: positive to the left of it, zero belongs to one of the two triangles that share it.
struct Edge<T> {
    dx: T,
    dy: T,
    at: T,
}

impl Target {
    pub fn clear(&mut self, width: usize, height: usize, samples: [[i32; 4]; 2]) {
        (self.width, self.height) = (width, height);
        self.depth.clear();
        self.depth.resize(width * height, [0.0; 4]);
        self.ids.clear();
        self.ids.resize(width * height, [NONE; 4]);
        self.records.clear();
        self.samples = samples;
        let least = |v: [i32; 4]| v.into_iter().fold(256, i32::min);
        let greatest = |v: [i32; 4]| v.into_iter().fold(0, i32::max);
        let [x, y] = samples;
        self.margin = [least(x), greatest(x), least(y), greatest(y)];
    }

    /// Whether every sample in a range of pixels shows something nearer than `iw`.
    pub fn hides(&self, x: std::ops::Range<usize>, y: std::ops::Range<usize>, iw: f32) -> bool {
        y.into_iter().all(|row| {
            let row = &self.depth[row * self.width..][x.clone()];
            row.iter().all(|d| d.iter().all(|&v| v > iw))
        })
    }

    /// Draws a counterclockwise triangle.
    #[inline(always)]
    pub fn triangle(&mut self, corners: [Corner; 3], record: Record) {
        let [a, b, c] = corners;
        let wide = i64::from;
        let area = wide(b.0 - a.0) * wide(c.1 - a.1) - wide(b.1 - a.1) * wide(c.0 - a.0);
        if area <= 0 {
            return;
        }
        let (left, right) = (a.0.min(b.0).min(c.0), a.0.max(b.0).max(c.0));
        let (low, high) = (a.1.min(b.1).min(c.1), a.1.max(b.1).max(c.1));
        let x = [
            ((left - self.margin[1] + 255) >> 8).max(0),
            ((right - self.margin[0]) >> 8).min(self.width as i32 - 1),
        ];
        let y = [
            ((low - self.margin[3] + 255) >> 8).max(0),
            ((high - self.margin[2]) >> 8).min(self.height as i32 - 1),
        ];
        if x[0] > x[1] || y[0] > y[1] {
            return;
        }
        if right - left < SMALL && high - low < SMALL {
            self.small(corners, area as i32, x, y, record);
        } else {
            self.large(corners, area, x, y, record);
        }
    }

    /// Writes samples of a pixel where `inside` is not negative.
    #[inline(always)]
    fn pixel(&mut self, at: usize, inside: [i32; 4], z: [f32; 4], id: &mut u32, record: Record) {
        let depth = &mut self.depth[at];
        let mut seen = [false; 4];
        for k in 0..4 {
            seen[k] = inside[k] >= 0 && z[k] >= depth[k];
        }
        if seen == [false; 4] {
            return;
        }
        let ids = &mut self.ids[at];
        for k in 0..4 {
            if !seen[k] {
                continue;
            }
            // of equally near things the one that comes later in the model is seen
            if z[k] == depth[k]
                && ids[k] != NONE
                && self.records.get(ids[k] as usize).is_some_and(|r| r.draw > record.draw)
            {
                continue;
            }
            if *id == NONE {
                *id = self.records.len() as u32;
                self.records.push(record);
            }
            depth[k] = z[k];
            ids[k] = *id;
        }
    }

    #[inline]
    fn small(&mut self, [a, b, c]: [Corner; 3], area: i32, x: [i32; 2], y: [i32; 2], record: Record) {
        let (x0, y0) = (x[0] * 256, y[0] * 256);
        let edge = |p: Corner, q: Corner| {
            let (dx, dy) = (q.0 - p.0, q.1 - p.1);
            let ours = dy < 0 || (dy == 0 && dx < 0);
            Edge {
                dx,
                dy,
                at: dx * (y0 - p.1) - dy * (x0 - p.0) - i32::from(!ours),
            }
        };
        let edges = [edge(b, c), edge(c, a), edge(a, b)];
        let [sx, sy] = self.samples;
        let mut offsets = [[0; 4]; 3];
        for (o, e) in offsets.iter_mut().zip(&edges) {
            for k in 0..4 {
                o[k] = e.at + e.dx * sy[k] - e.dy * sx[k];
            }
        }
        // most small triangles lie between the samples and need no depth
        let mut slope = None;
        let mut id = NONE;
        for py in 0..=y[1] - y[0] {
            let row = (y[0] + py) as usize * self.width + x[0] as usize;
            for px in 0..=x[1] - x[0] {
                let mut inside = [0; 4];
                for (o, e) in offsets.iter().zip(&edges) {
                    let shift = 256 * (e.dx * py - e.dy * px);
                    for k in 0..4 {
                        inside[k] |= o[k] + shift;
                    }
                }
                if inside[0] & inside[1] & inside[2] & inside[3] < 0 {
                    continue;
                }
                let (zx, zy, z_offsets) = *slope.get_or_insert_with(|| {
                    let (zx, zy) = depth_slope(a, b, c, area as f32);
                    let z0 = a.2 + zx * (x0 - a.0) as f32 + zy * (y0 - a.1) as f32;
                    let at = |k: usize| z0 + zx * sx[k] as f32 + zy * sy[k] as f32;
                    (zx, zy, [at(0), at(1), at(2), at(3)])
                });
                let z_pixel = zy * (py * 256) as f32 + zx * (px * 256) as f32;
                let mut z = z_offsets;
                for v in &mut z {
                    *v += z_pixel;
                }
                self.pixel(row + px as usize, inside, z, &mut id, record);
            }
        }
    }

    fn large(&mut self, [a, b, c]: [Corner; 3], area: i64, x: [i32; 2], y: [i32; 2], record: Record) {
        let edge = |p: Corner, q: Corner| {
            let (dx, dy) = (i64::from(q.0 - p.0), i64::from(q.1 - p.1));
            let ours = dy < 0 || (dy == 0 && dx < 0);
            Edge {
                dx,
                dy,
                at: dy * i64::from(p.0) - dx * i64::from(p.1) - i64::from(!ours),
            }
        };
        let edges = [edge(b, c), edge(c, a), edge(a, b)];
        let wide = |p: Corner| (p.0, p.1, f64::from(p.2));
        let (zx, zy) = depth_slope_wide(wide(a), wide(b), wide(c), area as f64);
        let (fx, fy) = (zx as f32, zy as f32);
        let [sx, sy] = self.samples;
        let reach = i64::from(BLOCK * 256);
        let mut id = NONE;
        for by in (y[0] / BLOCK * BLOCK..=y[1]).step_by(BLOCK as usize) {
            for bx in (x[0] / BLOCK * BLOCK..=x[1]).step_by(BLOCK as usize) {
                let (x0, y0) = (i64::from(bx) * 256, i64::from(by) * 256);
                let mut whole = true;
                let mut outside = false;
                for e in &edges {
                    let at = e.dx * y0 - e.dy * x0 + e.at;
                    let (over_y, over_x) = (e.dx * reach, -e.dy * reach);
                    outside |= at + over_y.max(0) + over_x.max(0) < 0;
                    whole &= at + over_y.min(0) + over_x.min(0) >= 0;
                }
                if outside {
                    continue;
                }
                let z0 = f64::from(a.2) + zx * (x0 - i64::from(a.0)) as f64 + zy * (y0 - i64::from(a.1)) as f64;
                let z0 = z0 as f32;
                for py in by.max(y[0])..=(by + BLOCK - 1).min(y[1]) {
                    for px in bx.max(x[0])..=(bx + BLOCK - 1).min(x[1]) {
                        let mut inside = [0i32; 4];
                        if !whole {
                            for e in &edges {
                                for k in 0..4 {
                                    let (x, y) = (i64::from(px * 256 + sx[k]), i64::from(py * 256 + sy[k]));
                                    inside[k] |= ((e.dx * y - e.dy * x + e.at) >> 63) as i32;
                                }
                            }
                        }
                        let mut z = [0.0; 4];
                        for k in 0..4 {
                            let (dx, dy) = ((px - bx) * 256 + sx[k], (py - by) * 256 + sy[k]);
                            z[k] = z0 + fx * dx as f32 + fy * dy as f32;
                        }
                        self.pixel(py as usize * self.width + px as usize, inside, z, &mut id, record);
                    }
                }
            }
        }
    }
}

/// Change of 1/w per 1/256 pixel.
fn depth_slope(a: Corner, b: Corner, c: Corner, area: f32) -> (f32, f32) {
    let (bz, cz) = (b.2 - a.2, c.2 - a.2);
    let (bx, by) = ((b.0 - a.0) as f32, (b.1 - a.1) as f32);
    let (cx, cy) = ((c.0 - a.0) as f32, (c.1 - a.1) as f32);
    let scale = 1.0 / area;
    ((bz * cy - cz * by) * scale, (cz * bx - bz * cx) * scale)
}

/// The same for large triangles.
fn depth_slope_wide(a: (i32, i32, f64), b: (i32, i32, f64), c: (i32, i32, f64), area: f64) -> (f64, f64) {
    let (bz, cz) = (b.2 - a.2, c.2 - a.2);
    let (bx, by) = (f64::from(b.0 - a.0), f64::from(b.1 - a.1));
    let (cx, cy) = (f64::from(c.0 - a.0), f64::from(c.1 - a.1));
    ((bz * cy - cz * by) / area, (cz * bx - bz * cx) / area)
}

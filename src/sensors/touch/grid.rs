//! A uniform grid over the sensors of a body, for finding those near a contact point.

use crate::math::{Vec3, order, sub};

/// Greatest number of cells along an axis; beyond it cells become larger, which is slower but equally exact.
const MAX_CELLS: f64 = 256.0;

/// Sensors by cell. Coordinates are stored in the order of cells, x fastest, so that a row of cells is one run of
/// memory.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid {
    low: Vec3,
    /// Cells per metre.
    per_metre: f64,
    cells: [usize; 3],
    /// Index of the first entry of each cell, and the end.
    start: Vec<u32>,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    sensor: Vec<u32>,
}

impl Grid {
    /// Creates a grid over `points` with cells of at least `cell` (m).
    pub fn new(points: &[Vec3], cell: f64) -> Self {
        let bound = |pick: fn(f64, f64) -> f64, from: f64| {
            std::array::from_fn::<f64, 3, _>(|k| points.iter().fold(from, |m, p| pick(m, p[k])))
        };
        let (low, high) = if points.is_empty() {
            ([0.0; 3], [0.0; 3])
        } else {
            (bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY))
        };
        let size = sub(high, low);
        let cell = cell.max(size[0].max(size[1]).max(size[2]) / MAX_CELLS);
        let mut grid = Self {
            low,
            per_metre: 1.0 / cell,
            cells: size.map(|s| (s / cell) as usize + 1),
            start: Vec::new(),
            x: Vec::new(),
            y: Vec::new(),
            z: Vec::new(),
            sensor: Vec::new(),
        };
        let [nx, ny, nz] = grid.cells;
        let mut order: Vec<(usize, u32)> = points
            .iter()
            .zip(0..)
            .map(|(p, i)| {
                let [x, y, z] = grid.cell(*p).map(|c| c as usize);
                ((z * ny + y) * nx + x, i)
            })
            .collect();
        // by cell, then by sensor: the order within a cell is fixed, and so is that in which forces are added up
        order::sort(&mut order);
        grid.start = vec![0; nx * ny * nz + 1];
        for &(c, i) in &order {
            grid.start[c + 1] += 1;
            let p = points[i as usize];
            grid.x.push(p[0]);
            grid.y.push(p[1]);
            grid.z.push(p[2]);
            grid.sensor.push(i);
        }
        // counts to starts
        for c in 1..grid.start.len() {
            grid.start[c] += grid.start[c - 1];
        }
        grid
    }

    /// Returns the cell of a point, which may lie off the grid.
    fn cell(&self, p: Vec3) -> [i64; 3] {
        std::array::from_fn(|k| {
            let c = ((p[k] - self.low[k]) * self.per_metre).floor() as i64;
            // rounding may put the last point one cell too far
            if c == self.cells[k] as i64 { c - 1 } else { c }
        })
    }

    /// Calls `visit(sensor, squared distance)` for a superset of the sensors within `radius` of `p`.
    #[inline]
    pub fn around(&self, p: Vec3, radius: f64, mut visit: impl FnMut(u32, f64)) {
        let [nx, ny, _] = self.cells;
        let mut range = [(0, 0); 3];
        for k in 0..3 {
            let last = self.cells[k] as i64 - 1;
            // a slack far above rounding
            let reach = radius * (1.0 + 1e-9);
            let at = |x: f64| ((x - self.low[k]) * self.per_metre).floor() as i64;
            let (from, to) = (at(p[k] - reach), at(p[k] + reach));
            if from > last + 1 || to < 0 {
                return;
            }
            range[k] = (from.clamp(0, last) as usize, to.clamp(0, last) as usize);
        }
        for z in range[2].0..=range[2].1 {
            for y in range[1].0..=range[1].1 {
                let row = (z * ny + y) * nx;
                // cells of a row are one run of memory: a single loop for all of them
                let run = self.start[row + range[0].0] as usize..self.start[row + range[0].1 + 1] as usize;
                let columns = self.x[run.clone()]
                    .iter()
                    .zip(&self.y[run.clone()])
                    .zip(&self.z[run.clone()]);
                for (((x, y), z), &sensor) in columns.zip(&self.sensor[run]) {
                    let (dx, dy, dz) = (x - p[0], y - p[1], z - p[2]);
                    visit(sensor, dx * dx + dy * dy + dz * dz);
                }
            }
        }
    }

    /// Returns the sensor nearest to `p`, the first among equally near ones; `None` without sensors. The search starts within `radius`
    /// (m).
    pub fn nearest(&self, p: Vec3, radius: f64) -> Option<u32> {
        let mut best = (f64::INFINITY, u32::MAX);
        let mut consider = |sensor: u32, d2: f64| {
            if d2 < best.0 || (d2 == best.0 && sensor < best.1) {
                best = (d2, sensor);
            }
        };
        self.around(p, radius, &mut consider);
        // nothing within the radius, and the visited cells are not a ball, so only a search over all sensors is exact. It is rare,
        // because contacts are on the skin
        if best.0 > radius * radius {
            best = (f64::INFINITY, u32::MAX);
            for (i, &sensor) in self.sensor.iter().enumerate() {
                let (dx, dy, dz) = (self.x[i] - p[0], self.y[i] - p[1], self.z[i] - p[2]);
                let d2 = dx * dx + dy * dy + dz * dz;
                if d2 < best.0 || (d2 == best.0 && sensor < best.1) {
                    best = (d2, sensor);
                }
            }
        }
        (best.1 != u32::MAX).then_some(best.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::GeomType;
    use crate::sensors::touch::points::surface_points;
    use crate::spaces::NumpyRng;

    #[test]
    fn the_grid_finds_what_a_search_of_all_finds() {
        let points = surface_points(GeomType::Box, [0.0228, 0.01, 0.0207], 0.002);
        let grid = Grid::new(&points, 0.004);
        let mut rng = NumpyRng::seed(1);
        for _ in 0..2000 {
            let p: Vec3 = std::array::from_fn(|_| 0.07 * (rng.uniform() - 0.5));
            let d2: Vec<f64> = points
                .iter()
                .map(|q| {
                    let d = sub(*q, p);
                    d[0] * d[0] + d[1] * d[1] + d[2] * d[2]
                })
                .collect();
            let mut found = Vec::new();
            grid.around(p, 0.004, |i, d| {
                assert_eq!(d, d2[i as usize]);
                if d < 0.004 * 0.004 {
                    found.push(i as usize);
                }
            });
            found.sort_unstable();
            let all: Vec<usize> = (0..points.len()).filter(|&i| d2[i] < 0.004 * 0.004).collect();
            assert_eq!(found, all);
            let best = (0..points.len())
                .min_by(|&i, &j| d2[i].total_cmp(&d2[j]))
                .map(|i| i as u32);
            assert_eq!(grid.nearest(p, 0.004), best);
        }
        assert_eq!(Grid::new(&[], 0.004).nearest([0.0; 3], 0.004), None);
        assert!(grid.nearest([1e30, 0.0, 0.0], 0.004).is_some());
    }
}

//! Differences of pictures, and the pictures of MuJoCo's own renderer in `data/render_*.npz`, which `scripts/render_goldens.py` writes
//! and describes.

use babybench::config::{Behavior, Config, Scene};
use babybench::formats::npz::Npz;

/// Differences of two sets of pictures, bytes.
#[derive(Clone, Debug, Default)]
pub struct Difference {
    values: usize,
    sum: u64,
    /// The largest.
    pub max: u8,
    /// Number of pixels off by more than 2, and by more than 4, in some colour.
    off: [usize; 2],
    ssim: Vec<f64>,
}

impl Difference {
    /// Adds a picture of this width.
    pub fn add(&mut self, ours: &[u8], theirs: &[u8], width: usize) {
        assert_eq!(ours.len(), theirs.len());
        for (a, b) in ours.chunks_exact(3).zip(theirs.chunks_exact(3)) {
            let d = [0, 1, 2].map(|k| a[k].abs_diff(b[k]));
            self.sum += d.iter().map(|&v| u64::from(v)).sum::<u64>();
            let most = d.into_iter().max().unwrap();
            self.max = self.max.max(most);
            self.off[0] += usize::from(most > 2);
            self.off[1] += usize::from(most > 4);
        }
        self.values += ours.len();
        self.ssim.push(ssim(ours, theirs, width));
    }

    /// Adds the differences of another set of pictures.
    pub fn merge(&mut self, other: &Self) {
        self.values += other.values;
        self.sum += other.sum;
        self.max = self.max.max(other.max);
        self.off = [0, 1].map(|k| self.off[k] + other.off[k]);
        self.ssim.extend(&other.ssim);
    }

    /// Returns the mean absolute difference.
    pub fn mean(&self) -> f64 {
        self.sum as f64 / self.values as f64
    }

    /// Returns the percentage of pixels off by more than 2, and by more than 4.
    pub fn off(&self) -> [f64; 2] {
        self.off.map(|n| 100.0 * n as f64 / (self.values / 3) as f64)
    }

    /// Returns the lowest structural similarity of any picture.
    pub fn least_ssim(&self) -> f64 {
        self.ssim.iter().copied().fold(1.0, f64::min)
    }
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let [two, four] = self.off();
        write!(
            f,
            "mean {:.4}, max {}, {two:.4} % of pixels off by more than 2, {four:.4} % by more than 4, SSIM >= {:.5}",
            self.mean(),
            self.max,
            self.least_ssim()
        )
    }
}

/// Computes the mean structural similarity of the brightness over windows of 8 x 8 pixels, 4 apart.
fn ssim(a: &[u8], b: &[u8], width: usize) -> f64 {
    const C: [f64; 2] = [(0.01 * 255.0) * (0.01 * 255.0), (0.03 * 255.0) * (0.03 * 255.0)];
    let gray = |v: &[u8]| -> Vec<f64> {
        let luma = |p: &[u8]| 0.299 * f64::from(p[0]) + 0.587 * f64::from(p[1]) + 0.114 * f64::from(p[2]);
        v.chunks_exact(3).map(luma).collect()
    };
    let (a, b) = (gray(a), gray(b));
    let (mut sum, mut count) = (0.0, 0);
    for y in (0..a.len() / width - 7).step_by(4) {
        for x in (0..width - 7).step_by(4) {
            let at = (0..64).map(|k| (y + k / 8) * width + x + k % 8);
            let [mut ma, mut mb, mut aa, mut bb, mut ab] = [0.0; 5];
            for i in at {
                ma += a[i] / 64.0;
                mb += b[i] / 64.0;
                aa += a[i] * a[i] / 64.0;
                bb += b[i] * b[i] / 64.0;
                ab += a[i] * b[i] / 64.0;
            }
            let (va, vb, cov) = (aa - ma * ma, bb - mb * mb, ab - ma * mb);
            sum += (2.0 * ma * mb + C[0]) * (2.0 * cov + C[1]) / ((ma * ma + mb * mb + C[0]) * (va + vb + C[1]));
            count += 1;
        }
    }
    sum / f64::from(count)
}

/// Returns the configuration that the pictures show: MIMo v2 among the cubes, v1 elsewhere.
pub fn config(scene: Scene) -> Config {
    Config {
        behavior: if scene == Scene::Cubes {
            Behavior::HandRegard
        } else {
            Behavior::None
        },
        scene,
        ..Config::default()
    }
}

/// Decodes the pictures of an array of the data, which stores differences to the left; width and height come first.
pub fn pictures(npz: &Npz, name: &str) -> ([usize; 2], Vec<Vec<u8>>) {
    let a = npz.get_f64(name).expect("committed data");
    let &[.., height, width, 3] = a.shape.as_slice() else {
        panic!("{name} are no pictures");
    };
    let mut bytes: Vec<u8> = a.data.iter().map(|&v| v as u8).collect();
    for row in bytes.chunks_exact_mut(3 * width) {
        for i in 3..row.len() {
            row[i] = row[i].wrapping_add(row[i - 3]);
        }
    }
    let all = bytes.chunks_exact(3 * width * height).map(<[u8]>::to_vec).collect();
    ([width, height], all)
}

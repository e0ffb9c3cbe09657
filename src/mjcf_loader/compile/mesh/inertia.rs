//! Volume, centre and inertia of meshes.

use crate::compile::geometry::diagonalize;
use crate::math::{MINVAL, Quat, Vec3, cross, dot};
use crate::mesh::MeshInertia;

/// Mass properties of a mesh, for a density of one.
pub(super) struct MassProperties {
    /// Volume, m^3; for a shell, the area, m^2.
    pub volume: f64,
    /// Centre of mass, m.
    pub pos: Vec3,
    /// Principal axes.
    pub quat: Quat,
    /// Half lengths of the box with the same inertia, m.
    pub inertia_box: Vec3,
}

/// A triangle with the quantities that integrals over the mesh need.
pub(super) struct Triangle {
    pub area: f64,
    /// Unit normal; shorter for a triangle without area.
    pub normal: Vec3,
    centre: Vec3,
}

impl Triangle {
    pub fn new([a, b, c]: [[f32; 3]; 3]) -> Self {
        // sums of coordinates in single precision, as in MuJoCo
        let centre = std::array::from_fn(|k| f64::from((a[k] + b[k] + c[k]) / 3.0));
        let side = |p: [f32; 3]| std::array::from_fn(|k| f64::from(p[k] - a[k]));
        let normal: Vec3 = cross(side(b), side(c));
        let length = dot(normal, normal).sqrt();
        if length < MINVAL {
            return Self {
                area: 0.0,
                normal,
                centre,
            };
        }
        Self {
            area: length / 2.0,
            normal: normal.map(|x| x / length),
            centre,
        }
    }
}

/// Returns the corners of a face.
pub(super) fn corners(vert: &[[f32; 3]], face: [u32; 3]) -> [[f32; 3]; 3] {
    face.map(|i| vert.get(i as usize).copied().unwrap_or_default())
}

/// Returns the mean of all faces, weighted by their areas.
fn middle(vert: &[[f32; 3]], faces: &[[u32; 3]]) -> Option<Vec3> {
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for &face in faces {
        let triangle = Triangle::new(corners(vert, face));
        for k in 0..3 {
            sum[k] += triangle.area * triangle.centre[k];
        }
        total += triangle.area;
    }
    (total >= MINVAL).then(|| sum.map(|x| x / total))
}

impl MassProperties {
    /// Computes the mass properties enclosed by the `counted` faces and moves the vertices to the centre of mass. `density` scales the inertia,
    /// because its axes are found to an absolute error.
    pub fn of(
        vert: &mut [[f32; 3]],
        faces: &[[u32; 3]],
        counted: &[[u32; 3]],
        kind: MeshInertia,
        density: f64,
    ) -> Result<Self, &'static str> {
        let middle = middle(vert, faces).ok_or("the surface of the mesh is too small")?;
        let pos = centre(vert, counted, kind, middle)?;
        for v in vert.iter_mut() {
            *v = std::array::from_fn(|k| (f64::from(v[k]) - pos[k]) as f32);
        }
        let (volume, products) = products(vert, counted, kind, density);
        let [xx, yy, zz, xy, xz, yz] = products;
        let (quat, [a, b, c]) = diagonalize(&[yy + zz, xx + zz, xx + yy, -xy, -xz, -yz]);
        if c.is_nan() || c <= 0.0 {
            return Err("the inertia of the mesh must have positive principal moments");
        }
        if a + b < c || a + c < b || b + c < a {
            return Err("the principal moments of the mesh do not satisfy A + B >= C; its faces may be misoriented");
        }
        let mass = volume * density;
        let half = |moment: f64| (6.0 * moment / mass).sqrt() / 2.0;
        Ok(Self {
            volume,
            pos,
            quat,
            inertia_box: [half(b + c - a), half(a + c - b), half(a + b - c)],
        })
    }
}

/// Computes the centre of mass from the pyramids over the faces.
fn centre(vert: &[[f32; 3]], faces: &[[u32; 3]], kind: MeshInertia, middle: Vec3) -> Result<Vec3, &'static str> {
    let (mut sum, mut total) = ([0.0; 3], 0.0);
    for &face in faces {
        let Triangle { area, normal, centre } = Triangle::new(corners(vert, face));
        let up = std::array::from_fn(|k| centre[k] - middle[k]);
        let volume = match kind {
            MeshInertia::Shell => area,
            MeshInertia::Legacy => (dot(up, normal) * area / 3.0).abs(),
            MeshInertia::Exact | MeshInertia::Convex => dot(up, normal) * area / 3.0,
        };
        total += volume;
        for k in 0..3 {
            sum[k] += volume * (centre[k] * 3.0 / 4.0 + middle[k] / 4.0);
        }
    }
    match total {
        _ if total >= MINVAL => Ok(sum.map(|x| x / total)),
        _ if total < 0.0 => {
            Err("the volume of the mesh is negative: its triangles must be counterclockwise from outside")
        }
        _ => Err("the volume of the mesh is too small; inertia=\"shell\" gives mass to its surface"),
    }
}

/// Computes the volume and the integrals of xx, yy, zz, xy, xz, yz of a centred mesh.
fn products(vert: &[[f32; 3]], faces: &[[u32; 3]], kind: MeshInertia, density: f64) -> (f64, [f64; 6]) {
    const PAIRS: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [0, 2], [1, 2]];
    let divisor = if kind == MeshInertia::Shell { 12.0 } else { 20.0 };
    let (mut total, mut sums) = (0.0, [0.0; 6]);
    for &face in faces {
        let [d, e, f] = corners(vert, face);
        let Triangle { area, normal, centre } = Triangle::new([d, e, f]);
        let volume = match kind {
            MeshInertia::Shell => area,
            MeshInertia::Legacy => (dot(centre, normal) * area / 3.0).abs(),
            MeshInertia::Exact | MeshInertia::Convex => dot(centre, normal) * area / 3.0,
        };
        total += volume;
        for (sum, [i, j]) in sums.iter_mut().zip(PAIRS) {
            // in single precision, from left to right
            let second = 2.0 * (d[i] * d[j] + e[i] * e[j] + f[i] * f[j])
                + d[i] * e[j]
                + d[j] * e[i]
                + d[i] * f[j]
                + d[j] * f[i]
                + e[i] * f[j]
                + e[j] * f[i];
            *sum += density * volume / divisor * f64::from(second);
        }
    }
    (total, sums)
}

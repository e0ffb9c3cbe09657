//! Polygons cut into triangles by clipping ears (Meisters, "Polygons have ears", American Mathematical Monthly 82, 1975), in
//! the order of the reader that MuJoCo 3.3.0 uses, so that triangles are the same.

/// Appends the triangles of a polygon whose corners are vertices: places among `corners`. Parts that cannot be cut, because the polygon crosses
/// itself, are left out.
pub(super) fn cut(vert: &[[f32; 3]], corners: &[u32], out: &mut Vec<[usize; 3]>) {
    let count = corners.len();
    let flat = project(vert, corners);
    let area: f32 = (0..count).map(|k| 0.5 * wedge(flat[k], flat[(k + 1) % count])).sum();
    let mut rest: Vec<usize> = (0..count).collect();
    let (mut guess, mut tries, mut before) = (0, count, count);
    while rest.len() > 3 && tries > 0 {
        let n = rest.len();
        if guess >= n {
            guess -= n;
        }
        if before == n {
            tries -= 1;
        } else {
            (before, tries) = (n, n);
        }
        let ear = [0, 1, 2].map(|k| rest[(guess + k) % n]);
        let [a, b, c] = ear.map(|k| flat[k]);
        let turn = wedge([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        let covers = || (3..n).any(|k| inside([a, b, c], flat[rest[(guess + k) % n]]));
        if turn * area < 0.0 || covers() {
            guess += 1;
            continue;
        }
        out.push(ear);
        rest.remove((guess + 1) % n);
    }
    if let [a, b, c] = rest[..] {
        out.push([a, b, c]);
    }
}

fn wedge(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

/// Drops the coordinate axis nearest to the normal of the first corner that is not flat.
fn project(vert: &[[f32; 3]], corners: &[u32]) -> Vec<[f32; 2]> {
    let count = corners.len();
    let at = |k: usize| vert.get(corners[k % count] as usize).copied().unwrap_or_default();
    let mut axes = [1, 2];
    for k in 0..count {
        let [a, b, c] = [at(k), at(k + 1), at(k + 2)];
        let along = |p: [f32; 3], q: [f32; 3]| [q[0] - p[0], q[1] - p[1], q[2] - p[2]];
        let (u, v) = (along(a, b), along(b, c));
        let normal = [
            (u[1] * v[2] - u[2] * v[1]).abs(),
            (u[2] * v[0] - u[0] * v[2]).abs(),
            (u[0] * v[1] - u[1] * v[0]).abs(),
        ];
        if normal.iter().any(|&x| x > f32::EPSILON) {
            if !(normal[0] > normal[1] && normal[0] > normal[2]) {
                axes[0] = 0;
                if normal[2] > normal[0] && normal[2] > normal[1] {
                    axes[1] = 1;
                }
            }
            break;
        }
    }
    (0..count).map(|k| axes.map(|axis| at(k)[axis])).collect()
}

/// Returns whether a point is in a triangle, by the crossings of a ray.
fn inside(corners: [[f32; 2]; 3], [x, y]: [f32; 2]) -> bool {
    let mut odd = false;
    for (i, j) in [(0, 2), (1, 0), (2, 1)] {
        let ([px, py], [qx, qy]) = (corners[i], corners[j]);
        if (py > y) != (qy > y) && x < (qx - px) * (y - py) / (qy - py) + px {
            odd = !odd;
        }
    }
    odd
}

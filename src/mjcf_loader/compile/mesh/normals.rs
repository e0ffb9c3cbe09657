//! Normals of vertices, and the orientation of faces.

use super::inertia::{Triangle, corners};
use crate::compile::geometry::normalize;
use crate::math::{MINVAL, Vec3, cross, dot};

/// Least cosine between a face and the mean of the faces around a vertex for the face to count.
const NEAR: f64 = 0.8;

/// Returns the unit normal and twice the area of a face.
fn normal(vert: &[[f32; 3]], face: [u32; 3]) -> (Vec3, f64) {
    let [a, b, c] = corners(vert, face);
    let side = |p: [f32; 3]| std::array::from_fn(|k| f64::from(p[k] - a[k]));
    let mut normal = cross(side(b), side(c));
    let area = normalize(&mut normal);
    (normal, area)
}

/// Computes normals of vertices: means of their faces, weighted by area. Unless they are `smooth`, faces at a large angle to the
/// mean count no more.
pub(super) fn of_vertices(vert: &[[f32; 3]], faces: &[[u32; 3]], smooth: bool) -> Vec<[f32; 3]> {
    let add = |to: &mut [f32; 3], normal: Vec3, area: f64| {
        *to = std::array::from_fn(|k| (f64::from(to[k]) + normal[k] * area) as f32);
    };
    let mut normals = vec![[0.0_f32; 3]; vert.len()];
    for &face in faces {
        let (normal, area) = normal(vert, face);
        for i in face {
            add(&mut normals[i as usize], normal, area);
        }
    }
    if !smooth {
        let mut removed = vec![[0.0_f32; 3]; vert.len()];
        for &face in faces {
            let (normal, area) = normal(vert, face);
            for i in face {
                let mut mean = normals[i as usize].map(f64::from);
                normalize(&mut mean);
                if dot(normal, mean) < NEAR {
                    add(&mut removed[i as usize], normal, area);
                }
            }
        }
        for (n, less) in normals.iter_mut().zip(removed) {
            *n = std::array::from_fn(|k| n[k] - less[k]);
        }
    }
    for n in &mut normals {
        let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
        *n = if f64::from(length) > MINVAL {
            n.map(|x| x / length)
        } else {
            [0.0, 0.0, 1.0]
        };
    }
    normals
}

/// Refuses two faces that traverse an edge in the same direction.
pub(super) fn check_orientation(vert: &[[f32; 3]], faces: &[[u32; 3]]) -> Result<(), &'static str> {
    let mut edges = Vec::with_capacity(3 * faces.len());
    for &face in faces {
        if Triangle::new(corners(vert, face)).area > MINVAL.sqrt() {
            let [a, b, c] = face;
            edges.extend([[a, b], [b, c], [c, a]]);
        }
    }
    edges.sort_unstable();
    if edges.windows(2).any(|pair| pair[0] == pair[1]) {
        return Err("faces of the mesh have inconsistent orientation, with which inertia=\"exact\" has no meaning");
    }
    Ok(())
}

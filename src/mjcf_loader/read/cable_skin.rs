//! The skin of a cable of boxes: a band along its middle, which is blown up to their thickness.

use super::super::composite::CompositeSkin;
use super::super::skin::{Bone, Skin};
use super::super::table::Table;

/// Numbers of a quadrilateral's corners: the point along the cable, the side of the band across, 0 or 1, and that of its two faces.
type Corner = (usize, usize, usize);

/// Makes the skin of a cable with these bodies, whose boxes have half lengths `size`.
pub(super) fn skin(like: &CompositeSkin, prefix: &str, bodies: &[String], size: [f64; 3]) -> Skin {
    let points = bodies.len() + 1;
    let vertex = |(along, across, face): Corner| (2 * (points * face + along) + across) as f64;
    let mut skin = Skin {
        at: like.at,
        name: format!("{prefix}Skin"),
        material: like.material.clone(),
        // as in MuJoCo, bones alone say where vertices are
        vertex: vec![0.0; 3 * 4 * points],
        rgba: like.rgba,
        inflate: 2.0 * size[2],
        group: like.group,
        ..Skin::initial()
    };
    let mut quad = |corners: [Corner; 4]| {
        let [a, b, c, d] = corners.map(vertex);
        skin.face.extend([a, b, c, a, c, d]);
    };
    let steps = || (0..points - 1).map(|k| (k, k + 1));
    for (k, next) in steps() {
        quad([(k, 0, 0), (next, 0, 0), (next, 1, 0), (k, 1, 0)]);
    }
    for (k, next) in steps() {
        let [a, b, c, d] = [(k, 0, 1), (k, 1, 1), (next, 1, 1), (next, 0, 1)].map(vertex);
        skin.face.extend([a, c, d, a, b, c]);
    }
    for (k, next) in steps() {
        let [a, b, c, d] = [(k, 0, 0), (k, 0, 1), (next, 0, 1), (next, 0, 0)].map(vertex);
        skin.face.extend([a, c, d, a, b, c]);
    }
    for (k, next) in steps() {
        let [a, b, c, d] = [(k, 1, 0), (next, 1, 0), (next, 1, 1), (k, 1, 1)].map(vertex);
        skin.face.extend([a, b, c, a, c, d]);
    }
    let last = points - 1;
    let [a, b, c, d] = [(0, 0, 0), (0, 1, 0), (0, 1, 1), (0, 0, 1)].map(vertex);
    skin.face.extend([a, b, c, a, c, d]);
    let [a, b, c, d] = [(last, 0, 0), (last, 0, 1), (last, 1, 1), (last, 1, 0)].map(vertex);
    skin.face.extend([a, c, d, a, b, c]);
    if like.texcoord {
        let along = (0..points).flat_map(|k| [0.0, 1.0].map(|across| [k as f64 / last as f64, across]));
        skin.texcoord = along.clone().chain(along).flatten().collect();
    }
    for k in 0..points {
        for across in 0..2 {
            // the last point hangs at the last body, MuJoCo's way: at twice the length that the document gives the box
            let x = if k == last { -2.0 * size[0] } else { 0.0 };
            let y = if across == 0 { -size[1] } else { size[1] };
            skin.bones.push(Bone {
                at: like.at,
                body: bodies[k.min(last - 1)].clone(),
                bindpos: [x, y, 0.0],
                vertid: vec![vertex((k, across, 0)), vertex((k, across, 1))],
                vertweight: vec![1.0; 2],
                ..Bone::initial()
            });
        }
    }
    skin
}

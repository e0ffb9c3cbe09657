//! The surface of a flex, the layers below it, and the pairs of elements and vertices across inner sides.

/// The surface, the layers and the inner pairs of a flex, which follow from the connectivity of its elements.
pub(super) struct Shell {
    /// Vertices of the fragments of the surface, each counterclockwise from outside.
    pub fragments: Vec<usize>,
    /// Distance of each element from the surface, in elements.
    pub layer: Vec<usize>,
    /// Pairs of an element and the vertex of a neighbour that is not on their common side.
    pub pairs: Vec<[usize; 2]>,
}

/// A side of an element. The order of sides is that of the fields.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// Its vertices, ascending.
    sorted: Vec<usize>,
    elem: usize,
    /// Its vertices in the order of the element.
    vertices: Vec<usize>,
}

/// Places of the vertices of an element's sides, by dimension.
const SIDES: [&[&[usize]]; 3] = [
    &[&[0], &[1]],
    &[&[0, 1], &[1, 2], &[2, 0]],
    &[&[0, 1, 2], &[0, 2, 3], &[0, 3, 1], &[1, 3, 2]],
];

pub(super) fn shell(elem: &[usize], dim: usize) -> Shell {
    let elements = elem.chunks_exact(dim + 1);
    let count = elements.len();
    let side = |(elem, e): (usize, &[usize]), side: &[usize]| {
        let vertices: Vec<usize> = side.iter().map(|&k| e[k]).collect();
        let mut sorted = vertices.clone();
        sorted.sort_unstable();
        Side { sorted, elem, vertices }
    };
    let mut sides: Vec<Side> = elements
        .enumerate()
        .flat_map(|e| SIDES[dim - 1].iter().map(move |places| side(e, places)))
        .collect();
    crate::math::order::sort(&mut sides);
    let (mut border, mut fragments, mut connected) = (vec![false; count], Vec::new(), Vec::new());
    for same in sides.chunk_by(|a, b| a.sorted == b.sorted) {
        if let [single] = same {
            border[single.elem] = true;
            fragments.extend(&single.vertices);
        }
        connected.extend(
            same.windows(2)
                .map(|pair| (pair[0].elem, pair[1].elem, &pair[1].sorted)),
        );
    }
    let mut layer = vec![0; count];
    let mut pairs = Vec::new();
    if dim == 3 {
        layers(&mut layer, &border, &connected);
    } else {
        for &(a, b, side) in connected.iter().filter(|(a, b, _)| border[*a] || border[*b]) {
            for (own, other) in [(a, b), (b, a)] {
                let vertices = &elem[own * (dim + 1)..(own + 1) * (dim + 1)];
                let apart = vertices.iter().find(|v| !side.contains(v));
                pairs.extend(apart.map(|&v| [other, v]));
            }
        }
    }
    Shell {
        fragments,
        layer,
        pairs,
    }
}

/// Computes the distances of elements from the border.
fn layers(layer: &mut [usize], border: &[bool], connected: &[(usize, usize, &Vec<usize>)]) {
    let far = layer.len() + 1;
    for (layer, &border) in layer.iter_mut().zip(border) {
        *layer = if border { 0 } else { far };
    }
    let mut changed = true;
    while changed {
        changed = false;
        for &(a, b, _) in connected {
            for (near, other) in [(a, b), (b, a)] {
                if layer[other] > layer[near] + 1 {
                    layer[other] = layer[near] + 1;
                    changed = true;
                }
            }
        }
    }
}

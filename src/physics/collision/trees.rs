//! MuJoCo's trees of boxes, which exclude pairs of geoms before any routine searches for their contacts.

use std::ops::Range;

use super::boxes::OrientedBox;
use crate::contact::PlacedGeom;
use crate::math::{Vec3, add, order, quat_conj, quat_rotate, sub};
use crate::model::Model;
use crate::state::State;

/// Lengths that differ by less are equal (MuJoCo's `mjEPS`), m.
const EPS: f64 = 1e-14;

/// The trees of all bodies. A node is a box along the body's axes of inertia around some of its geoms. Its children contain the two halves of these
/// geoms, ordered along its longest edge; the leaves contain one geom.
#[derive(Clone, Debug)]
pub(super) struct BodyTrees {
    /// The box of each node: centre and half sizes from the body's centre of mass along its axes of inertia, m.
    nodes: Vec<[f64; 6]>,
    /// The nodes from the root to each geom, as a range of `steps`.
    paths: Vec<Range<usize>>,
    steps: Vec<usize>,
}

/// A leaf of a tree: a geom of its body.
#[derive(Clone)]
struct Leaf {
    geom: usize,
    /// Its place, and the corners of the box around it.
    pos: Vec3,
    low: Vec3,
    high: Vec3,
    /// The nodes above it.
    path: Vec<usize>,
}

impl BodyTrees {
    /// Builds the trees of `model`.
    pub(super) fn new(model: &Model) -> Self {
        let mut trees = Self {
            nodes: Vec::new(),
            paths: vec![0..0; model.ngeom()],
            steps: Vec::new(),
        };
        for body in 0..model.nbody() {
            let first = model.body_geomadr[body];
            let geoms = first..first + model.body_geomnum[body];
            let colliding = geoms.filter(|&g| model.geom_contype[g] | model.geom_conaffinity[g] != 0);
            let mut leaves: Vec<Leaf> = colliding.map(|g| leaf(model, g)).collect();
            trees.node(&mut leaves);
        }
        trees
    }

    /// Adds the node around some geoms of a body, and the nodes below it.
    fn node(&mut self, leaves: &mut [Leaf]) {
        let Some(first) = leaves.first() else {
            return;
        };
        let (mut low, mut high) = (first.low, first.high);
        for leaf in &leaves[1..] {
            low = std::array::from_fn(|k| low[k].min(leaf.low[k]));
            high = std::array::from_fn(|k| high[k].max(leaf.high[k]));
        }
        for leaf in &mut *leaves {
            leaf.path.push(self.nodes.len());
        }
        self.nodes.push(std::array::from_fn(|k| match k {
            0..3 => 0.5 * (low[k] + high[k]),
            _ => 0.5 * (high[k - 3] - low[k - 3]),
        }));
        if let [leaf] = leaves {
            let start = self.steps.len();
            self.steps.append(&mut leaf.path);
            self.paths[leaf.geom] = start..self.steps.len();
            return;
        }
        let edges = sub(high, low);
        let mut axis = usize::from(edges[1] >= edges[0] + EPS);
        if edges[2] >= edges[axis] + EPS {
            axis = 2;
        }
        // places that are equal up to rounding are made equal, so that the geoms' order decides: a comparison with a tolerance is not an order,
        // on which sorting may panic
        let sort = |leaves: &mut [Leaf]| {
            order::sort_by(leaves, |a, b| {
                a.pos[axis].total_cmp(&b.pos[axis]).then(a.geom.cmp(&b.geom))
            });
        };
        sort(leaves);
        for k in 1..leaves.len() {
            let (before, here) = (leaves[k - 1].pos[axis], &mut leaves[k].pos[axis]);
            if *here - before <= EPS {
                *here = before;
            }
        }
        sort(leaves);
        let (low, high) = leaves.split_at_mut(leaves.len() / 2);
        self.node(low);
        self.node(high);
    }

    /// Returns whether MuJoCo leaves out two geoms of a pair that is not explicit. It does if a face of one of the boxes around them lies
    /// farther from the other than their margin, or if the same holds for the boxes of two nodes on the way to them and the largest margin of
    /// both bodies.
    pub(super) fn apart<'a>(
        &self,
        a: &PlacedGeom<'a>,
        b: &PlacedGeom<'a>,
        model: &Model,
        geoms: [usize; 2],
        [margin, body_margin]: [f64; 2],
        s: &State,
    ) -> bool {
        let [x, y] = geoms;
        // boxes are those of the model: around a geom whose size was changed since they say nothing
        if geoms.iter().any(|&g| s.params.geom_size[g] != model.geom_size[g]) {
            return false;
        }
        let own = |geom: &PlacedGeom<'a>, g: usize| OrientedBox::placed(&model.geom_aabb[g], geom.pos, geom.mat);
        if own(a, x).apart(&own(b, y), margin) {
            return true;
        }
        let body = |g: usize| model.geom_bodyid[g];
        let [x, y] = if body(x) < body(y) { [x, y] } else { [y, x] };
        let path = |g: usize| &self.steps[self.paths[g].clone()];
        let (mut first, mut second) = (path(x), path(y));
        while let ([node, below @ ..], [other, others @ ..]) = (first, second)
            && !(below.is_empty() && others.is_empty())
        {
            let (node, other) = (&self.nodes[*node], &self.nodes[*other]);
            let placed = |g: usize, node| OrientedBox::placed(node, s.xipos[body(g)], &s.ximat[body(g)]);
            if placed(x, node).apart(&placed(y, other), body_margin) {
                return true;
            }
            if others.is_empty() || !below.is_empty() && size(node) > size(other) {
                first = below;
            } else {
                second = others;
            }
        }
        false
    }
}

/// Returns a geom with the box around it, along the axes of inertia of its body.
fn leaf(model: &Model, geom: usize) -> Leaf {
    let body = model.geom_bodyid[geom];
    let turn = quat_conj(model.body_iquat[body]);
    let within = |point: Vec3| quat_rotate(turn, sub(point, model.body_ipos[body]));
    let (pos, quat, aabb) = (model.geom_pos[geom], model.geom_quat[geom], model.geom_aabb[geom]);
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for corner in 0..8 {
        let sign = |k: usize| if corner >> k & 1 == 1 { 1.0 } else { -1.0 };
        let point: Vec3 = std::array::from_fn(|k| aabb[k] + sign(k) * aabb[3 + k]);
        let point = within(add(quat_rotate(quat, point), pos));
        low = std::array::from_fn(|k| low[k].min(point[k]));
        high = std::array::from_fn(|k| high[k].max(point[k]));
    }
    Leaf {
        geom,
        pos: within(pos),
        low,
        high,
        path: Vec::new(),
    }
}

/// Returns MuJoCo's measure of a box's surface, by which it chooses the tree to descend: its three numbers are differences of half sizes
/// and centres.
fn size(node: &[f64; 6]) -> f64 {
    let [x, y, z] = std::array::from_fn(|k| node[3 + k] - node[k]);
    x * y + y * z + z * x
}

//! The polygons of a hull or a mesh: triangles on one plane, joined. Convex collision clips them against each other where a pair may have several contacts.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::mem::swap;

use crate::math::{MINVAL, Vec3, cross, dot, sub, unit};
use crate::model::MeshPolygons;

/// Cosine above which two normals count as one: that of 0.0016 rad (MuJoCo's `mjFACE_TOL`).
const ONE_PLANE: f64 = 0.99999872;
/// Twice the area below which a triangle counts as having no area, m^2 (MuJoCo's `mjEPS`).
const NO_AREA: f64 = 1e-14;

/// Joins triangles, each by its corners among `vert`. Their normals are those before the mesh is turned; see [`turn`].
pub(super) fn join(face: &[[u32; 3]], vert: &[[f32; 3]]) -> MeshPolygons {
    let mut planes = Planes::default();
    for &corners in face {
        planes.add(corners, normal(corners, vert));
    }
    let mut polygons = MeshPolygons::default();
    for plane in planes.in_order() {
        planes.edges[plane].paths().iter().for_each(|path| polygons.push(path));
    }
    polygons.index(vert.len());
    polygons
}

/// Computes the normals from the first three corners of each polygon, as MuJoCo does, once the mesh is in its principal axes.
pub(super) fn turn(polygons: &mut MeshPolygons, vert: &[[f32; 3]]) {
    polygons.normal = (0..polygons.len())
        .map(|k| match polygons.corners(k) {
            &[a, b, c, ..] => normal([a, b, c], vert),
            _ => [0.0; 3],
        })
        .collect();
}

/// Returns the normal of a triangle. One without an area has MuJoCo's normal, which is infinite or close to it, so such triangles form a separate
/// plane, the first one.
fn normal(corners: [u32; 3], vert: &[[f32; 3]]) -> Vec3 {
    let [a, b, c] = corners.map(|k| vert[k as usize].map(f64::from));
    let (normal, twice_area) = unit(cross(sub(b, a), sub(c, a)));
    if twice_area < NO_AREA {
        [1.0, 0.0, 0.0].map(|x| x / twice_area)
    } else {
        normal
    }
}

/// The edges of triangles on one plane that no other of them shares, in the order in which they were added.
#[derive(Default)]
struct Edges {
    all: Vec<Option<Edge>>,
    /// Indices of an edge in `all`: several if a triangle occurs twice.
    at: HashMap<[u32; 2], VecDeque<usize>>,
    /// For each triangle an earlier one to which it is connected by edges, or itself.
    island: Vec<usize>,
}

#[derive(Clone, Copy)]
struct Edge {
    ends: [u32; 2],
    triangle: usize,
}

impl Edges {
    /// Adds a triangle: its edges cancel those of its neighbours.
    fn add(&mut self, [a, b, c]: [u32; 3]) {
        let triangle = self.island.len();
        self.island.push(triangle);
        let edges = [[a, b], [b, c], [c, a]];
        let shared = edges.map(|[from, to]| self.at.get_mut(&[to, from]).and_then(VecDeque::pop_front));
        for (ends, shared) in edges.into_iter().zip(shared) {
            match shared {
                Some(k) => {
                    if let Some(edge) = self.all[k].take() {
                        let (one, other) = (self.first(edge.triangle), self.first(triangle));
                        self.island[one.max(other)] = one.min(other);
                    }
                }
                None => {
                    self.at.entry(ends).or_default().push_back(self.all.len());
                    self.all.push(Some(Edge { ends, triangle }));
                }
            }
        }
    }

    /// Returns the first triangle of the island of one.
    fn first(&mut self, mut triangle: usize) -> usize {
        while self.island[triangle] != triangle {
            self.island[triangle] = self.island[self.island[triangle]];
            triangle = self.island[triangle];
        }
        triangle
    }

    /// Returns a loop of edges for each island, in the order of their first triangles. The remaining edges of an island that has a hole or touches
    /// itself are lost, as in MuJoCo.
    fn paths(&mut self) -> Vec<Vec<u32>> {
        let left: Vec<Edge> = self.all.iter().copied().flatten().collect();
        if let [a, b, c] = left[..] {
            // in the order of the edges, as in MuJoCo: where more triangles than one leave three edges, the other way round perhaps
            return vec![vec![a.ends[0], b.ends[0], c.ends[0]]];
        }
        let (mut starts, mut next) = (BTreeMap::new(), HashMap::new());
        for Edge { ends, triangle } in left {
            let island = self.first(triangle);
            starts.entry(island).or_insert((ends[0], 0)).1 += 1;
            next.entry((island, ends[0])).or_insert(ends[1]);
        }
        let path = |(island, (start, edges)): (usize, (u32, usize))| {
            let (mut path, mut at) = (vec![start], start);
            loop {
                at = *next.get(&(island, at))?;
                if at == start {
                    return (path.len() >= 3).then_some(path);
                }
                // after all edges of the island: a loop that does not come back to where it began
                if path.len() == edges {
                    return None;
                }
                path.push(at);
            }
        };
        starts.into_iter().filter_map(path).collect()
    }
}

/// Whether a normal comes before another: they fall by x, then y, then z, and are one within [`ONE_PLANE`].
///
/// This is not transitive, and MuJoCo keeps its planes in a `std::set` with it: which normals are compared, and with that which triangles are
/// joined, depends on the shape of the set's tree. So [`Planes`] is that tree.
fn before(a: Vec3, b: Vec3) -> bool {
    if dot(a, b) > ONE_PLANE {
        return false;
    }
    let differ = (0..3).find(|&k| (a[k] - b[k]).abs() > MINVAL);
    differ.is_some_and(|k| a[k] > b[k])
}

/// Planes as a red-black tree (Cormen, Leiserson, Rivest and Stein, "Introduction to Algorithms", chapter 13), searched and filled as the set of
/// libstdc++ is, with which MuJoCo is built.
#[derive(Default)]
struct Planes {
    normal: Vec<Vec3>,
    edges: Vec<Edges>,
    root: Option<usize>,
    node: Vec<PlaneNode>,
}

#[derive(Clone, Copy, Default)]
struct PlaneNode {
    parent: Option<usize>,
    /// The planes before and after.
    child: [Option<usize>; 2],
    red: bool,
}

impl Planes {
    /// Adds a triangle to the plane of its normal, or with a new plane.
    fn add(&mut self, corners: [u32; 3], normal: Vec3) {
        // a tree that does not find the normal may still find its place taken, and then the triangle is lost
        if let Some(plane) = self.find(normal).or_else(|| self.insert(normal)) {
            self.edges[plane].add(corners);
        }
    }

    /// Finds the first plane that is not before a normal, if the normal is not before it.
    fn find(&self, normal: Vec3) -> Option<usize> {
        let (mut at, mut found) = (self.root, None);
        while let Some(k) = at {
            let right = before(self.normal[k], normal);
            if !right {
                found = Some(k);
            }
            at = self.node[k].child[usize::from(right)];
        }
        found.filter(|&k| !before(normal, self.normal[k]))
    }

    /// Inserts a normal; `None` where the one before its place is the same.
    fn insert(&mut self, normal: Vec3) -> Option<usize> {
        let (mut at, mut parent, mut left) = (self.root, None, true);
        while let Some(k) = at {
            parent = at;
            left = before(normal, self.normal[k]);
            at = self.node[k].child[usize::from(!left)];
        }
        let previous = if left {
            parent.and_then(|k| self.previous(k))
        } else {
            parent
        };
        if previous.is_some_and(|k| !before(self.normal[k], normal)) {
            return None;
        }
        let new = self.node.len();
        self.node.push(PlaneNode {
            parent,
            red: true,
            ..PlaneNode::default()
        });
        self.normal.push(normal);
        self.edges.push(Edges::default());
        match parent {
            Some(k) => self.node[k].child[usize::from(!left)] = Some(new),
            None => self.root = Some(new),
        }
        self.balance(new);
        Some(new)
    }

    fn previous(&self, k: usize) -> Option<usize> {
        if let Some(mut below) = self.node[k].child[0] {
            while let Some(right) = self.node[below].child[1] {
                below = right;
            }
            return Some(below);
        }
        let mut k = k;
        while let Some(parent) = self.node[k].parent {
            if self.node[parent].child[1] == Some(k) {
                return Some(parent);
            }
            k = parent;
        }
        None
    }

    /// Paints and rotates until no red node has a red parent.
    fn balance(&mut self, new: usize) {
        let mut k = new;
        while let Some(mut parent) = self.node[k].parent.filter(|&parent| self.node[parent].red) {
            // a red node is not the root, so that it has a parent
            let Some(grand) = self.node[parent].parent else { break };
            let side = usize::from(self.node[grand].child[1] == Some(parent));
            if let Some(uncle) = self.node[grand].child[1 - side].filter(|&uncle| self.node[uncle].red) {
                self.node[parent].red = false;
                self.node[uncle].red = false;
                self.node[grand].red = true;
                k = grand;
                continue;
            }
            if self.node[parent].child[1 - side] == Some(k) {
                self.rotate(parent, side);
                swap(&mut k, &mut parent);
            }
            self.node[parent].red = false;
            self.node[grand].red = true;
            self.rotate(grand, 1 - side);
        }
        if let Some(root) = self.root {
            self.node[root].red = false;
        }
    }

    /// Rotates a node down to `side`: its child on the other side takes its place.
    fn rotate(&mut self, k: usize, side: usize) {
        let Some(up) = self.node[k].child[1 - side] else { return };
        let inner = self.node[up].child[side];
        self.node[k].child[1 - side] = inner;
        if let Some(inner) = inner {
            self.node[inner].parent = Some(k);
        }
        let parent = self.node[k].parent;
        self.node[up].parent = parent;
        match parent {
            Some(parent) => {
                let at = usize::from(self.node[parent].child[1] == Some(k));
                self.node[parent].child[at] = Some(up);
            }
            None => self.root = Some(up),
        }
        self.node[up].child[side] = Some(k);
        self.node[k].parent = Some(up);
    }

    fn in_order(&self) -> Vec<usize> {
        let (mut order, mut above, mut at) = (Vec::new(), Vec::new(), self.root);
        loop {
            while let Some(k) = at {
                above.push(k);
                at = self.node[k].child[0];
            }
            let Some(k) = above.pop() else { return order };
            order.push(k);
            at = self.node[k].child[1];
        }
    }
}

//! Convex hulls of points, with the order of Qhull.
//!
//! MuJoCo builds the hulls of meshes by Qhull (`qhull Qt`), and where several corners are as far as each other it takes the one that
//! comes first in Qhull's order. So this is Quickhull (Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex
//! Hulls", ACM Transactions on Mathematical Software 22, 1996) with the decisions of Qhull 2020.2 in three dimensions: which points
//! make the first simplex, in which order facets, points and neighbours are kept, what rounding errors are allowed for, which
//! facets are merged because they are not clearly convex, and how merged ones are split into triangles. Comments name the
//! functions of Qhull whose rules they state.
//!
//! Qhull ends with an error in some cases; so does this, and in those of its options that MuJoCo does not set. What it returns is
//! checked by its caller like any other hull.

mod cone;
mod find;
mod lists;
mod matching;
mod merge;
mod partition;
mod parts;
mod plane;
mod simplex;
mod tolerance;
mod triangulate;
mod vertices;

use super::Vec3;
use parts::{Arena, Facet, HullResult, Id, Merge, NONE, Ridge, TAIL, Vertex, VertexMerge};
use tolerance::{Tolerance, larger};

/// A hull of triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hull {
    /// Points that are corners.
    pub corners: Vec<u32>,
    /// For each corner, the points to which it has an edge.
    pub edges: Vec<Vec<u32>>,
    /// Points at the corners of each triangle, counterclockwise from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// A hull under construction.
struct Builder<'p> {
    points: &'p [Vec3],
    tolerance: Tolerance,
    facets: Arena<Facet>,
    vertices: Arena<Vertex>,
    ridges: Arena<Ridge>,
    first_facet: Id,
    /// First new or changed facet; these end the list.
    new_facets: Id,
    /// First facet to be removed; these come before the new ones.
    visible_facets: Id,
    /// The facet whose points are processed next.
    next_facet: Id,
    first_vertex: Id,
    /// First vertex of new facets; these end the list.
    new_vertices: Id,
    facet_count: usize,
    visible_count: usize,
    vertex_count: usize,
    /// Facets from this one on are new since the last point.
    first_new: Id,
    visit: u32,
    vertex_visit: u32,
    interior: Vec3,
    /// The first simplex is a needle.
    narrow: bool,
    /// Whether the facets of each vertex are kept up to date.
    has_neighbors: bool,
    find_best_new: bool,
    /// New facets were found not to be sharp.
    not_sharp: bool,
    /// Largest height of points or vertices above their facets.
    max_outside: f64,
    /// Smallest height of vertices relative to their facets; negative below.
    min_vertex: f64,
    /// Upper bound of the height of a point above its facet.
    most_outside: f64,
    merge_count: u32,
    /// Number of visited ends of edges of merged facets.
    work: usize,
    merges: Vec<Merge>,
    degenerates: Vec<Merge>,
    vertex_merges: Vec<VertexMerge>,
    dead_vertices: Vec<Id>,
    repartitioned: Id,
}

impl<'p> Builder<'p> {
    fn new(points: &'p [Vec3]) -> (Self, Vec<u32>) {
        let extremes = simplex::extremes(points);
        let tolerance = Tolerance::new(&extremes.map(|pair| pair.map(|point| points[point as usize])));
        let mut builder = Self {
            points,
            tolerance,
            facets: Arena::new(),
            vertices: Arena::new(),
            ridges: Arena::new(),
            first_facet: TAIL,
            new_facets: TAIL,
            visible_facets: NONE,
            next_facet: NONE,
            first_vertex: TAIL,
            new_vertices: TAIL,
            facet_count: 0,
            visible_count: 0,
            vertex_count: 0,
            first_new: NONE,
            visit: 0,
            vertex_visit: 0,
            interior: [0.0; 3],
            narrow: false,
            has_neighbors: false,
            find_best_new: false,
            not_sharp: false,
            max_outside: 0.0,
            min_vertex: -tolerance.dist,
            most_outside: 0.0,
            merge_count: 0,
            work: 0,
            merges: Vec::new(),
            degenerates: Vec::new(),
            vertex_merges: Vec::new(),
            dead_vertices: Vec::new(),
            repartitioned: NONE,
        };
        let (facets, vertices) = (&mut builder.facets[TAIL], &mut builder.vertices[TAIL]);
        (facets.previous, facets.next) = (NONE, NONE);
        (vertices.previous, vertices.next) = (NONE, NONE);
        (builder, extremes.as_flattened().to_vec())
    }

    /// Adds the farthest points, one by one, until none is outside, or until there are `most` corners.
    fn build(&mut self, extremes: &[u32], most: Option<usize>) -> HullResult {
        self.bound_outside();
        let corners = self.first_hull(extremes)?;
        self.partition_all(&corners)?;
        self.reset_lists(true);
        self.begin_farthest()?;
        while let Some((point, facet)) = self.next_farthest() {
            if most.is_some_and(|most| self.vertex_count >= most) {
                break;
            }
            self.add_point(point, facet)?;
        }
        self.triangulate()?;
        self.find_vertex_neighbors();
        Ok(())
    }

    /// Bounds how high above its facet a coplanar point may be (`qh_detmaxoutside`).
    fn bound_outside(&mut self) {
        let merged = larger(self.max_outside, self.tolerance.one_merge + self.tolerance.dist);
        self.most_outside = larger(merged, self.tolerance.outside);
    }

    /// Adds a point to the hull (`qh_addpoint`): visible facets are removed, new ones join their border to the point, facets that are not convex are
    /// merged, and points of the removed facets are reassigned.
    fn add_point(&mut self, point: u32, facet: Id) -> HullResult {
        self.bound_outside();
        self.find_horizon(point, facet)?;
        self.make_cone(point)?;
        self.find_best_new = false;
        self.merge_new_facets()?;
        self.find_best_new = self.merged_much()
            || self
                .facets_from(self.new_facets)
                .iter()
                .any(|&facet| !self.facets[facet].simplicial);
        self.partition_visible()?;
        self.find_best_new = false;
        self.not_sharp = false;
        self.delete_visible()?;
        self.reset_lists(true);
        self.merge_vertices()
    }

    /// Removes facets and vertices that are to be removed (`qh_deletevisible`).
    fn delete_visible(&mut self) -> HullResult {
        for facet in self.visible() {
            self.delete_facet(facet)?;
        }
        self.visible_count = 0;
        for vertex in std::mem::take(&mut self.dead_vertices) {
            self.remove_vertex(vertex)?;
            self.vertices[vertex].neighbors = Vec::new();
        }
        Ok(())
    }

    /// Returns the hull as MuJoCo reads it from Qhull's lists: for each vertex, the other vertices of its facets, in the order of first occurrence.
    fn read(&self) -> Hull {
        let mut hull = Hull::default();
        for vertex in self.vertices_from(self.first_vertex) {
            let mut edges: Vec<u32> = Vec::new();
            for &facet in &self.vertices[vertex].neighbors {
                for &other in &self.facets[facet].vertices {
                    let point = self.vertices[other].point;
                    if other != vertex && !edges.contains(&point) {
                        edges.push(point);
                    }
                }
            }
            hull.corners.push(self.vertices[vertex].point);
            hull.edges.push(edges);
        }
        for facet in self.facets_from(self.first_facet) {
            let facet = &self.facets[facet];
            if let &[a, b, c] = facet.vertices.as_slice() {
                let [a, b, c] = [a, b, c].map(|vertex| self.vertices[vertex].point);
                hull.triangles.push(if facet.top { [b, a, c] } else { [a, b, c] });
            }
        }
        hull
    }
}

/// Builds the hull of points, with at most the first `most` corners if it is given. `None` if Qhull would end with an error, for example because the
/// points span no volume.
pub fn hull(points: &[Vec3], most: Option<usize>) -> Option<Hull> {
    if points.len() < 4 || points.len() >= (u32::MAX / 8) as usize {
        return None;
    }
    let (mut builder, extremes) = Builder::new(points);
    builder.build(&extremes, most).ok()?;
    Some(builder.read())
}

#[cfg(test)]
mod order_tests {
    use super::*;

    /// The order of MuJoCo 3.3.0's `mesh_graph` for the corners of a box: six polygons are merged and split again.
    #[test]
    fn a_box_has_the_order_of_mujoco() {
        let corner = |i: u32| {
            [1.0, 2.0, 3.0]
                .into_iter()
                .zip([4, 2, 1])
                .map(move |(half, bit)| if i & bit == 0 { -half } else { half })
        };
        let points: Vec<Vec3> = (0..8)
            .map(|i| {
                let mut axes = corner(i);
                std::array::from_fn(|_| axes.next().unwrap())
            })
            .collect();
        let expected = Hull {
            corners: vec![6, 2, 0, 4, 5, 1, 7, 3],
            edges: vec![
                vec![2, 0, 4, 5, 7, 3],
                vec![6, 0, 3],
                vec![6, 2, 4, 5, 1, 3],
                vec![6, 0, 5],
                vec![4, 0, 1, 6, 7, 3],
                vec![5, 0, 3],
                vec![5, 6, 3],
                vec![2, 0, 1, 6, 7, 5],
            ],
            triangles: vec![
                [2, 6, 0],
                [6, 4, 0],
                [4, 5, 0],
                [5, 1, 0],
                [6, 5, 4],
                [5, 6, 7],
                [3, 2, 0],
                [1, 3, 0],
                [3, 6, 2],
                [6, 3, 7],
                [5, 3, 1],
                [3, 5, 7],
            ],
        };
        assert_eq!(hull(&points, None), Some(expected));
    }

    #[test]
    fn flat_points_have_no_hull() {
        let points: Vec<Vec3> = (0..9).map(|i| [f64::from(i % 3), f64::from(i / 3), 0.0]).collect();
        assert_eq!(hull(&points, None), None);
        assert_eq!(hull(&[[0.0; 3]; 5], None), None);
    }
}

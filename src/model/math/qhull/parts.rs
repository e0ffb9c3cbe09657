//! Facets, vertices, ridges, and the small sets that hold them.

use std::ops::{Index, IndexMut};

use crate::math::Vec3;

/// The index of a facet, a vertex or a ridge in its arena. Later ones have greater indices, as Qhull's ids do.
pub(super) type Id = u32;
/// No facet, vertex or ridge.
pub(super) const NONE: Id = u32::MAX;
/// Marks, among the neighbours of a new facet, an edge that more than two new facets share (a duplicated ridge, in Qhull's words).
pub(super) const SHARED: Id = u32::MAX - 1;
/// Marks such an edge once it is known that its facets must be merged (`qh_MERGEridge`).
pub(super) const FORCED: Id = u32::MAX - 2;
/// The end of the lists of facets and of vertices: the first entry of either arena is not part of the hull.
pub(super) const TAIL: Id = 0;

/// The input cannot be processed in Qhull's way. Qhull itself exits with an error for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HullFailure;

/// Result of an operation that may fail.
pub(super) type HullResult<T = ()> = Result<T, HullFailure>;

/// A list whose items are never removed, so an index stays valid.
pub(super) struct Arena<T>(Vec<T>);

impl<T: Default> Arena<T> {
    /// Creates an arena that has only the end of its list.
    pub(super) fn new() -> Self {
        Self(vec![T::default()])
    }

    /// Adds an item; returns its place.
    pub(super) fn push(&mut self, item: T) -> Id {
        self.0.push(item);
        (self.0.len() - 1) as Id
    }

    /// Returns the number of items, including the end of the list.
    pub(super) fn len(&self) -> usize {
        self.0.len()
    }
}

/// An invalid index yields the end of the list, so malformed sets never panic. The finished hull is checked.
impl<T> Index<Id> for Arena<T> {
    type Output = T;

    #[inline(always)]
    fn index(&self, id: Id) -> &T {
        self.0.get(id as usize).unwrap_or(&self.0[0])
    }
}

impl<T> IndexMut<Id> for Arena<T> {
    #[inline(always)]
    fn index_mut(&mut self, id: Id) -> &mut T {
        let place = if (id as usize) < self.0.len() { id as usize } else { 0 };
        &mut self.0[place]
    }
}

/// A facet: a triangle, or, once it is merged with others, a polygon that is flat within tolerances.
#[derive(Default)]
pub(super) struct Facet {
    pub(super) previous: Id,
    pub(super) next: Id,
    /// Vertices, the latest first.
    pub(super) vertices: Vec<Id>,
    /// Facets beyond the edges: in a triangle, the nth is opposite the nth vertex; in others, the order is that of merging.
    pub(super) neighbors: Vec<Id>,
    /// Edges; a triangle has entries for those that it shares with polygons.
    pub(super) ridges: Vec<Id>,
    /// Whether it ever had an entry in `ridges`.
    pub(super) ridged: bool,
    /// Points above the facet, the farthest last.
    pub(super) outside: Vec<u32>,
    /// Points at the facet, the farthest last.
    pub(super) coplanar: Vec<u32>,
    /// Outward normal, once it is computed.
    pub(super) normal: Option<Vec3>,
    pub(super) offset: f64,
    /// The mean of its vertices, on its plane, once it is computed.
    pub(super) center: Option<Vec3>,
    /// Height of the last point of `outside`.
    pub(super) furthest: f64,
    /// Bound on the distance of points above the facet, as far as known.
    pub(super) max_outside: f64,
    /// Facet that replaces it after its removal.
    pub(super) replace: Id,
    /// For a new facet that is merged into its horizon: the next one with the same horizon, in a ring. For the horizon: the last one.
    pub(super) cycle: Id,
    /// Number of merges.
    pub(super) merges: u16,
    pub(super) visit: u32,
    /// Whether the vertices wind one way or the other.
    pub(super) top: bool,
    pub(super) simplicial: bool,
    /// Visible from the new point, or to be removed for another reason.
    pub(super) visible: bool,
    pub(super) new: bool,
    /// Was merged since vertices were last reduced.
    pub(super) new_merge: bool,
    /// Convexity with its neighbours was tested.
    pub(super) tested: bool,
    pub(super) seen: bool,
    /// The new point is nearly on the plane.
    pub(super) coplanar_horizon: bool,
    /// Is merged into the facet beyond its first edge.
    pub(super) merge_horizon: bool,
    pub(super) cycle_done: bool,
    pub(super) dup_ridge: bool,
    pub(super) merge_ridge: bool,
    pub(super) merge_ridge2: bool,
    pub(super) flipped: bool,
    pub(super) degenerate: bool,
    pub(super) redundant: bool,
    pub(super) keep_center: bool,
    pub(super) not_furthest: bool,
    /// Is one of the triangles of a polygon.
    pub(super) tricoplanar: bool,
}

/// A vertex of the hull.
#[derive(Default)]
pub(super) struct Vertex {
    pub(super) previous: Id,
    pub(super) next: Id,
    /// Index of the point.
    pub(super) point: u32,
    /// Facets of which it is a vertex, kept up to date from the first merge on.
    pub(super) neighbors: Vec<Id>,
    pub(super) visit: u32,
    pub(super) seen: bool,
    pub(super) new: bool,
    /// Lost an edge by merging.
    pub(super) lost_ridge: bool,
    pub(super) deleted: bool,
    /// Its point was assigned to a facet after the vertex was deleted.
    pub(super) partitioned: bool,
}

/// An edge between facets that are not both triangles.
#[derive(Default)]
pub(super) struct Ridge {
    /// Vertices, the latest first.
    pub(super) vertices: Vec<Id>,
    pub(super) top: Id,
    pub(super) bottom: Id,
    pub(super) nonconvex: bool,
    pub(super) tested: bool,
    pub(super) simplicial_top: bool,
    pub(super) simplicial_bottom: bool,
}

impl Ridge {
    /// Returns the facet on the other side.
    #[inline(always)]
    pub(super) fn other(&self, facet: Id) -> Id {
        if self.top == facet { self.bottom } else { self.top }
    }
}

/// The reason for merging two facets. Merges are done in this order.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) enum MergeReason {
    /// Centres are at the other's plane.
    Coplanar,
    /// A centre is above the other's plane.
    Concave,
    /// One is, the other is at it.
    ConcaveCoplanar,
    /// The normal points inwards.
    Flip,
    /// An edge with more than two facets.
    DupRidge,
    /// Fewer than three neighbours.
    Degenerate,
    /// All vertices are those of a neighbour.
    Redundant,
    /// Two triangles of polygons with the same vertices.
    Mirror,
    /// A new facet in the plane of its horizon.
    Horizon,
}

/// A pending merge.
#[derive(Clone, Copy)]
pub(super) struct Merge {
    pub(super) facet1: Id,
    pub(super) facet2: Id,
    pub(super) reason: MergeReason,
    pub(super) distance: f64,
}

/// A merge of two neighbouring vertices that two edges join.
#[derive(Clone, Copy)]
pub(super) struct VertexMerge {
    pub(super) vertex: Id,
    pub(super) into: Id,
    pub(super) ridges: [Id; 2],
    pub(super) distance: f64,
}

/// Removes an item of an unordered set: the last takes its place, as in `qh_setdel`.
pub(super) fn drop_swapping(set: &mut Vec<Id>, item: Id) -> bool {
    let place = set.iter().position(|&other| other == item);
    if let Some(place) = place {
        set.swap_remove(place);
    }
    place.is_some()
}

/// Removes an item of an ordered set (`qh_setdelsorted`).
pub(super) fn drop_sorted(set: &mut Vec<Id>, item: Id) {
    if let Some(place) = set.iter().position(|&other| other == item) {
        set.remove(place);
    }
}

/// Replaces an item by another (`qh_setreplace`).
pub(super) fn replace(set: &mut [Id], old: Id, new: Id) -> HullResult {
    let place = set.iter_mut().find(|other| **other == old).ok_or(HullFailure)?;
    *place = new;
    Ok(())
}

/// Appends an item that is not yet there (`qh_setunique`).
pub(super) fn push_unique(set: &mut Vec<Id>, item: Id) {
    if !set.contains(&item) {
        set.push(item);
    }
}

/// Appends before the last item, which stays the farthest (`qh_setappend2ndlast`).
pub(super) fn push_second_last(set: &mut Vec<Id>, item: Id) {
    set.insert(set.len().saturating_sub(1), item);
}

//! Rows of quadrilaterals, the building blocks of meshes.

/// The number of vertices of each band of a mesh is a multiple of this.
pub const LANES: usize = 8;

/// The number of quadrilaterals of each strip is a multiple of this.
pub const STRIP_LANES: usize = 4;

/// A row of quadrilaterals, each split into two triangles: [a, b, d] and [b, c, d]. A fan has only the first of both.
#[derive(Clone, Copy, Debug)]
pub struct Strip {
    /// Corners a, b, c, d of the first quadrilateral.
    pub first: [u16; 4],
    /// Increment of each corner from one quadrilateral to the next, 0 or 1.
    pub step: [u16; 4],
    /// Number of quadrilaterals, a multiple of [`STRIP_LANES`].
    pub count: usize,
    /// Whether it is a fan.
    pub fan: bool,
    /// Index of its first patch.
    pub patch: usize,
}

impl Strip {
    /// Returns the corners a, b, c, d of a quadrilateral.
    pub fn corners(&self, index: usize) -> [u16; 4] {
        let mut corners = self.first;
        for (corner, step) in corners.iter_mut().zip(self.step) {
            *corner += step * index as u16;
        }
        corners
    }
}

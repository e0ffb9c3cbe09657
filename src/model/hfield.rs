//! Height fields.

/// A height field: heights on a rectangular grid, over a base.
#[derive(Clone, Debug, PartialEq)]
pub struct HField {
    /// Name.
    pub name: String,
    /// Half lengths along x and y, the height for 1 in `data`, the depth of the base below 0, m.
    pub size: [f64; 4],
    /// Number of rows, along y.
    pub nrow: usize,
    /// Number of columns, along x.
    pub ncol: usize,
    /// Heights, 0..1, row by row from the least y.
    pub data: Vec<f32>,
}

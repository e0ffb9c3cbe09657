//! Geoms that a program adds to a picture.

use babybench::model::{Arrays, GeomType};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// A geom that a program adds to a picture: shape, size, colour. Its pose is stored separately.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    kind: GeomType,
    pub size: [f64; 3],
    rgba: [f64; 4],
}

/// MuJoCo's number of the shape, size (m), position (m), orientation and colour of a marker.
pub type Placed = (i32, [f64; 3], [f64; 3], [f64; 9], [f64; 4]);

impl Marker {
    /// Makes a marker from a program's values.
    ///
    /// # Errors
    /// The shape cannot be drawn, or a number is not finite.
    pub fn new(placed: &Placed) -> PyResult<Self> {
        let (kind, size, pos, mat, rgba) = placed;
        let shapes = [
            GeomType::Sphere,
            GeomType::Capsule,
            GeomType::Ellipsoid,
            GeomType::Cylinder,
            GeomType::Box,
        ];
        let found = shapes.into_iter().find(|shape| shape.code() == *kind);
        let kind = found.ok_or_else(|| PyValueError::new_err(format!("markers of the type {kind} are not drawn")))?;
        let mut numbers = size.iter().chain(pos).chain(mat).chain(rgba);
        if !numbers.all(|number| number.is_finite()) {
            return Err(PyValueError::new_err("a number of a marker is not finite"));
        }
        Ok(Self {
            kind,
            size: *size,
            rgba: *rgba,
        })
    }

    /// Appends the marker to the geoms of a model that is drawn.
    pub fn add(&self, arrays: &mut Arrays) {
        arrays.geom_name.push(String::new());
        arrays.geom_type.push(self.kind);
        arrays.geom_size.push(self.size);
        arrays.geom_rgba.push(self.rgba);
        arrays.geom_matid.push(None);
        arrays.geom_dataid.push(None);
        arrays.geom_group.push(0);
        arrays.geom_bodyid.push(0);
        arrays.geom_rbound.push(self.size.iter().sum());
    }
}

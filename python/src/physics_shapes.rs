//! MuJoCo's arrays of meshes, height fields and skins, which a model has one after another.

use babybench::Model;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Writes arrays of elements that lie one after another, with the number of each and the index of its first.
struct Shapes<'py> {
    py: Python<'py>,
    arrays: Bound<'py, PyDict>,
}

impl<'py> Shapes<'py> {
    /// Writes rows of `width` numbers; 0 for a vector.
    fn rows<T: Element + Copy>(&self, name: &str, values: Vec<T>, width: usize) -> PyResult<()> {
        let count = values.len() / width.max(1);
        let array = PyArray1::from_vec(self.py, values);
        if width == 0 {
            return self.arrays.set_item(name, array);
        }
        self.arrays.set_item(name, array.reshape([count, width])?)
    }

    /// Writes the index of the first of each element, and how many each has. `none` stands where an element has none.
    fn spans(&self, first: &str, number: &str, counts: &[usize], none: Option<i32>) -> PyResult<()> {
        let mut at = 0;
        let starts = counts.iter().map(|&count| {
            let start = at;
            at += count as i32;
            none.filter(|_| count == 0).unwrap_or(start)
        });
        self.rows(first, starts.collect(), 0)?;
        self.rows(number, counts.iter().map(|&count| count as i32).collect(), 0)
    }
}

/// Returns the arrays of meshes, height fields and skins under MuJoCo's names.
pub fn shapes<'py>(py: Python<'py>, m: &Model) -> PyResult<Bound<'py, PyDict>> {
    let arrays = PyDict::new(py);
    let all = Shapes {
        py,
        arrays: arrays.clone(),
    };
    meshes(&all, m)?;
    height_fields(&all, m)?;
    skins(&all, m)?;
    Ok(arrays)
}

fn meshes(all: &Shapes, m: &Model) -> PyResult<()> {
    let of = &m.meshes;
    let signed = |faces: &[[u32; 3]]| faces.iter().flatten().map(|&i| i as i32).collect::<Vec<_>>();
    all.rows(
        "mesh_vert",
        of.iter().flat_map(|x| x.vert.as_flattened().to_vec()).collect(),
        3,
    )?;
    all.rows(
        "mesh_normal",
        of.iter().flat_map(|x| x.normal.as_flattened().to_vec()).collect(),
        3,
    )?;
    all.rows(
        "mesh_texcoord",
        of.iter().flat_map(|x| x.texcoord.as_flattened().to_vec()).collect(),
        2,
    )?;
    all.rows("mesh_face", of.iter().flat_map(|x| signed(&x.face)).collect(), 3)?;
    all.rows(
        "mesh_facenormal",
        of.iter().flat_map(|x| signed(&x.facenormal)).collect(),
        3,
    )?;
    all.rows("mesh_scale", of.iter().flat_map(|x| x.scale).collect(), 3)?;
    all.rows("mesh_pos", of.iter().flat_map(|x| x.pos).collect(), 3)?;
    all.rows("mesh_quat", of.iter().flat_map(|x| x.quat).collect(), 4)?;
    let counts = |count: fn(&babybench::model::Mesh) -> usize| of.iter().map(count).collect::<Vec<_>>();
    all.spans("mesh_vertadr", "mesh_vertnum", &counts(|x| x.vert.len()), None)?;
    all.spans("mesh_faceadr", "mesh_facenum", &counts(|x| x.face.len()), None)?;
    all.spans("mesh_normaladr", "mesh_normalnum", &counts(|x| x.normal.len()), None)?;
    all.spans(
        "mesh_texcoordadr",
        "mesh_texcoordnum",
        &counts(|x| x.texcoord.len()),
        Some(-1),
    )
}

fn height_fields(all: &Shapes, m: &Model) -> PyResult<()> {
    let of = &m.hfields;
    all.rows("hfield_size", of.iter().flat_map(|x| x.size).collect(), 4)?;
    all.rows("hfield_nrow", of.iter().map(|x| x.nrow as i32).collect(), 0)?;
    all.rows("hfield_ncol", of.iter().map(|x| x.ncol as i32).collect(), 0)?;
    let counts: Vec<_> = of.iter().map(|x| x.data.len()).collect();
    let mut at = 0;
    let starts = counts.iter().map(|count| {
        at += count;
        (at - count) as i32
    });
    all.rows("hfield_adr", starts.collect(), 0)?;
    all.rows("hfield_data", of.iter().flat_map(|x| x.data.clone()).collect(), 0)
}

fn skins(all: &Shapes, m: &Model) -> PyResult<()> {
    let of = &m.skins;
    all.rows("skin_group", of.iter().map(|x| x.group).collect(), 0)?;
    let ids = of.iter().map(|x| x.material.map_or(-1, |id| id as i32));
    all.rows("skin_matid", ids.collect(), 0)
}

//! MuJoCo's arrays of meshes, height fields, skins and flexes, which a model has one after another.

use babybench::Model;
use babybench::model::Flex;
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
        self.starts(first, counts, none)?;
        self.rows(number, counts.iter().map(|&count| count as i32).collect(), 0)
    }

    /// Writes the index of the first of each element.
    fn starts(&self, first: &str, counts: &[usize], none: Option<i32>) -> PyResult<()> {
        let mut at = 0;
        let starts = counts.iter().map(|&count| {
            let start = at;
            at += count as i32;
            none.filter(|_| count == 0).unwrap_or(start)
        });
        self.rows(first, starts.collect(), 0)
    }
}

/// Returns the arrays of meshes, height fields, skins and flexes under MuJoCo's names.
pub fn shapes<'py>(py: Python<'py>, m: &Model) -> PyResult<Bound<'py, PyDict>> {
    let arrays = PyDict::new(py);
    let all = Shapes {
        py,
        arrays: arrays.clone(),
    };
    meshes(&all, m)?;
    height_fields(&all, m)?;
    skins(&all, m)?;
    flexes(&all, m)?;
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

/// Writes the arrays of flexes, whose vertices, edges and elements lie one after another.
fn flexes(all: &Shapes, m: &Model) -> PyResult<()> {
    let of = &m.flexes;
    let one = |name: &str, of_flex: fn(&Flex) -> i32| all.rows(name, of.iter().map(of_flex).collect(), 0);
    let real = |name: &str, of_flex: fn(&Flex) -> f64| all.rows(name, of.iter().map(of_flex).collect(), 0);
    let flag = |name: &str, of_flex: fn(&Flex) -> bool| {
        all.rows(name, of.iter().map(|flex| u8::from(of_flex(flex))).collect(), 0)
    };
    let ids = |name: &str, of_flex: fn(&Flex) -> &[usize]| {
        let ids = of.iter().flat_map(of_flex).map(|&id| id as i32);
        all.rows(name, ids.collect(), 0)
    };
    let pairs = |name: &str, of_flex: fn(&Flex) -> &[[usize; 2]]| {
        let ids = of.iter().flat_map(of_flex).flatten().map(|&id| id as i32);
        all.rows(name, ids.collect(), 2)
    };
    for (name, of_flex) in [
        ("flex_contype", (|x| x.contype as i32) as fn(&Flex) -> i32),
        ("flex_conaffinity", |x| x.conaffinity as i32),
        ("flex_condim", |x| x.condim as i32),
        ("flex_priority", |x| x.priority),
        ("flex_selfcollide", |x| x.selfcollide as i32),
        ("flex_activelayers", |x| x.activelayers),
        ("flex_dim", |x| x.dim as i32),
        ("flex_matid", |x| x.material.map_or(-1, |id| id as i32)),
        ("flex_group", |x| x.group),
        ("flex_interp", |_| 0),
    ] {
        one(name, of_flex)?;
    }
    for (name, of_flex) in [
        ("flex_solmix", (|x| x.solmix) as fn(&Flex) -> f64),
        ("flex_margin", |x| x.margin),
        ("flex_gap", |x| x.gap),
        ("flex_radius", |x| x.radius),
        ("flex_damping", |x| x.damping),
        ("flex_edgestiffness", |x| x.edgestiffness),
        ("flex_edgedamping", |x| x.edgedamping),
    ] {
        real(name, of_flex)?;
    }
    for (name, of_flex) in [
        ("flex_internal", (|x| x.internal) as fn(&Flex) -> bool),
        ("flex_edgeequality", |x| x.edgeequality),
        ("flex_rigid", |x| x.rigid),
        ("flex_centered", |x| x.centered),
        ("flex_flatskin", |x| x.flatskin),
    ] {
        flag(name, of_flex)?;
    }
    all.rows("flex_solref", of.iter().flat_map(|x| x.solref).collect(), 2)?;
    all.rows("flex_solimp", of.iter().flat_map(|x| x.solimp).collect(), 5)?;
    all.rows("flex_friction", of.iter().flat_map(|x| x.friction).collect(), 3)?;
    let colours = of.iter().flat_map(|x| x.rgba.map(|v| v as f32));
    all.rows("flex_rgba", colours.collect(), 4)?;
    for (name, of_flex) in [
        ("flex_vertbodyid", (|x| &x.vertbodyid) as fn(&Flex) -> &[usize]),
        ("flex_elem", |x| &x.elem),
        ("flex_elemedge", |x| &x.elemedge),
        ("flex_elemlayer", |x| &x.elemlayer),
        ("flex_shell", |x| &x.shell),
    ] {
        ids(name, of_flex)?;
    }
    pairs("flex_edge", |x| &x.edge)?;
    pairs("flex_evpair", |x| &x.evpair)?;
    let places = of.iter().flat_map(|x| x.vert.as_flattened().to_vec());
    all.rows("flex_vert", places.collect(), 3)?;
    let coordinates = of.iter().flat_map(|x| x.texcoord.as_flattened().to_vec());
    all.rows("flex_texcoord", coordinates.collect(), 2)?;
    let rigid = of
        .iter()
        .flat_map(|x| x.edge_rigid.iter().map(|&rigid| u8::from(rigid)));
    all.rows("flexedge_rigid", rigid.collect(), 0)?;
    let lengths = of.iter().flat_map(|x| x.edge_length0.clone());
    all.rows("flexedge_length0", lengths.collect(), 0)?;
    let weights = of.iter().flat_map(|x| x.edge_invweight0.clone());
    all.rows("flexedge_invweight0", weights.collect(), 0)?;
    // zeros for a flex without elasticity
    let metric = |x: &Flex| match x.stiffness.len() {
        0 => vec![0.0; 21 * x.nelem()],
        _ => x.stiffness.as_flattened().to_vec(),
    };
    all.rows("flex_stiffness", of.iter().flat_map(metric).collect(), 21)?;
    spans_of_flexes(all, of)
}

fn spans_of_flexes(all: &Shapes, of: &[Flex]) -> PyResult<()> {
    let counts = |count: fn(&Flex) -> usize| of.iter().map(count).collect::<Vec<_>>();
    all.spans("flex_vertadr", "flex_vertnum", &counts(|x| x.vert.len()), None)?;
    all.spans("flex_edgeadr", "flex_edgenum", &counts(|x| x.edge.len()), None)?;
    all.spans("flex_elemadr", "flex_elemnum", &counts(Flex::nelem), None)?;
    all.spans(
        "flex_evpairadr",
        "flex_evpairnum",
        &counts(|x| x.evpair.len()),
        Some(-1),
    )?;
    all.starts("flex_elemdataadr", &counts(|x| x.elem.len()), None)?;
    all.starts("flex_elemedgeadr", &counts(|x| x.elemedge.len()), None)?;
    all.starts("flex_shelldataadr", &counts(|x| x.shell.len()), Some(-1))?;
    let shells = of.iter().map(|x| (x.shell.len() / x.dim) as i32);
    all.rows("flex_shellnum", shells.collect(), 0)?;
    all.starts("flex_texcoordadr", &counts(|x| x.texcoord.len()), Some(-1))?;
    for name in ["flex_nodeadr", "flex_nodenum"] {
        all.rows(name, vec![0; of.len()], 0)?;
    }
    all.rows::<i32>("flex_nodebodyid", Vec::new(), 0)?;
    all.rows::<f64>("flex_node", Vec::new(), 3)?;
    all.rows::<f64>("flex_node0", Vec::new(), 3)
}

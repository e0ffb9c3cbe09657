//! The numbers of a model that are not doubles in MuJoCo, or that the engine keeps element by element: colours, groups, materials,
//! lights, equalities, keyframes.

use std::collections::{BTreeMap, BTreeSet};

use babybench::model::{Arrays, EqualityKind, SameFrame, Wrap};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The type of a column's numbers in Python.
#[derive(Clone, Copy, PartialEq)]
pub enum Store {
    Double,
    Single,
    Whole,
    Byte,
}

/// The numbers of one element in a column.
pub trait Cell {
    /// Appends the numbers.
    fn read(&self, out: &mut Vec<f64>);

    /// Sets numbers. Returns whether they are valid.
    fn write(&mut self, numbers: &[f64]) -> bool;

    /// Returns whether a column of such cells has rows, and no single numbers.
    fn row(&self) -> bool {
        false
    }
}

impl Cell for f64 {
    fn read(&self, out: &mut Vec<f64>) {
        out.push(*self);
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        *self = numbers[0];
        true
    }
}

impl<const N: usize> Cell for [f64; N] {
    fn read(&self, out: &mut Vec<f64>) {
        out.extend_from_slice(self);
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        self.copy_from_slice(numbers);
        true
    }

    fn row(&self) -> bool {
        true
    }
}

impl Cell for Vec<f64> {
    fn read(&self, out: &mut Vec<f64>) {
        out.extend_from_slice(self);
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        self.copy_from_slice(numbers);
        true
    }

    fn row(&self) -> bool {
        true
    }
}

impl Cell for bool {
    fn read(&self, out: &mut Vec<f64>) {
        out.push(f64::from(u8::from(*self)));
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        *self = numbers[0] != 0.0;
        true
    }
}

impl Cell for i32 {
    fn read(&self, out: &mut Vec<f64>) {
        out.push(f64::from(*self));
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        *self = numbers[0] as i32;
        true
    }
}

/// Bits.
impl Cell for u32 {
    fn read(&self, out: &mut Vec<f64>) {
        out.push(f64::from(*self as i32));
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        *self = numbers[0] as i32 as u32;
        true
    }
}

/// The number of an element, or -1.
impl Cell for Option<usize> {
    fn read(&self, out: &mut Vec<f64>) {
        out.push(self.map_or(-1.0, |id| id as f64));
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        *self = (numbers[0] >= 0.0).then_some(numbers[0] as usize);
        numbers[0] >= -1.0
    }
}

impl Cell for Vec<f32> {
    fn read(&self, out: &mut Vec<f64>) {
        out.extend(self.iter().map(|n| f64::from(*n)));
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        for (own, number) in self.iter_mut().zip(numbers) {
            *own = *number as f32;
        }
        true
    }
}

impl Cell for SameFrame {
    fn read(&self, out: &mut Vec<f64>) {
        out.push(f64::from(*self as u8));
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        let kinds = [Self::None, Self::Body, Self::Inertia, Self::BodyRot, Self::InertiaRot];
        let found = kinds.into_iter().find(|kind| f64::from(*kind as u8) == numbers[0]);
        found.is_some_and(|kind| {
            *self = kind;
            true
        })
    }
}

/// The number of an element that a tendon runs along: a coefficient or a divisor. Other elements have none that can change.
impl Cell for Wrap {
    fn read(&self, out: &mut Vec<f64>) {
        out.push(wrap_number(self));
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        match self {
            Self::Joint { coef, .. } => *coef = numbers[0],
            Self::Pulley { divisor } => *divisor = numbers[0],
            _ => return wrap_number(self) == numbers[0],
        }
        true
    }
}

/// Returns MuJoCo's parameter of an element that a tendon runs along.
pub fn wrap_number(wrap: &Wrap) -> f64 {
    let side = |side: Option<usize>| side.map_or(-1.0, |site| site as f64);
    match *wrap {
        Wrap::Joint { coef, .. } => coef,
        Wrap::Pulley { divisor } => divisor,
        Wrap::Site { .. } => 0.0,
        Wrap::Sphere { side: site, .. } | Wrap::Cylinder { side: site, .. } => side(site),
    }
}

impl Cell for EqualityKind {
    fn read(&self, out: &mut Vec<f64>) {
        out.extend(self.numbers().1);
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        numbers.try_into().is_ok_and(|row| {
            self.set_data(row);
            true
        })
    }

    fn row(&self) -> bool {
        true
    }
}

/// The number of a material's texture for each of MuJoCo's ten roles. Only the second, colour, is drawn.
struct Roles<'a>(&'a mut Option<usize>);

/// Roles of textures (`mjNTEXROLE`).
const ROLES: usize = 10;
/// The role of the colour (`mjTEXROLE_RGB`).
const COLOUR: usize = 1;

impl Cell for Roles<'_> {
    fn read(&self, out: &mut Vec<f64>) {
        for role in 0..ROLES {
            out.push(self.0.filter(|_| role == COLOUR).map_or(-1.0, |id| id as f64));
        }
    }

    fn write(&mut self, numbers: &[f64]) -> bool {
        let others = numbers
            .iter()
            .enumerate()
            .all(|(role, id)| role == COLOUR || *id == -1.0);
        self.0.write(&numbers[COLOUR..=COLOUR]) && others
    }

    fn row(&self) -> bool {
        true
    }
}

/// A column of a model: name, type, and the number that ids in it stay below.
#[derive(Clone, Copy)]
struct Column {
    name: &'static str,
    store: Store,
    below: usize,
}

/// Visits the cells of all columns.
fn visit(arrays: &mut Arrays, mut work: impl FnMut(Column, Vec<&mut dyn Cell>)) {
    let [materials, textures] = [arrays.materials.len(), arrays.textures.len()];
    macro_rules! columns {
        ($($store:ident { $($name:ident $(below $below:expr)? => $list:ident $(. $field:ident)?),* $(,)? })*) => {$($({
            #[allow(unused_assignments, unused_mut)]
            let mut below = usize::MAX;
            $(below = $below;)?
            let cells = arrays.$list.iter_mut().map(|cell| &mut (*cell)$(.$field)? as &mut dyn Cell);
            work(Column { name: stringify!($name), store: Store::$store, below }, cells.collect());
        })*)*};
    }
    columns! {
        Double {
            eq_data => eq_kind, cam_fovy => cam_fovy, light_pos => lights.pos, light_dir => lights.dir,
            key_time => keys.time, key_qpos => keys.qpos, key_qvel => keys.qvel, key_act => keys.act, key_ctrl => keys.ctrl,
        }
        Single {
            geom_rgba => geom_rgba, site_rgba => site_rgba, tendon_rgba => tendon_rgba,
            mat_rgba => materials.rgba, mat_specular => materials.specular, mat_shininess => materials.shininess,
            mat_reflectance => materials.reflectance, mat_emission => materials.emission, mat_texrepeat => materials.texrepeat,
            light_ambient => lights.ambient, light_diffuse => lights.diffuse, light_specular => lights.specular,
            hfield_data => hfields.data, light_attenuation => lights.attenuation, light_cutoff => lights.cutoff, light_exponent => lights.exponent,
        }
        Whole {
            geom_contype => geom_contype, geom_conaffinity => geom_conaffinity, geom_priority => geom_priority,
            jnt_group => jnt_group, actuator_group => actuator_group,
            geom_group => geom_group, site_group => site_group, tendon_group => tendon_group,
            geom_matid below materials => geom_matid, site_matid below materials => site_matid,
            tendon_matid below materials => tendon_matid,
        }
        Byte {
            body_sameframe => body_sameframe, geom_sameframe => geom_sameframe, site_sameframe => site_sameframe,
            tendon_limited => tendon_limited, jnt_actfrclimited => jnt_actfrclimited,
            actuator_ctrllimited => actuator_ctrllimited, actuator_forcelimited => actuator_forcelimited,
            actuator_actlimited => actuator_actlimited, eq_active0 => eq_active0, mat_texuniform => materials.texuniform, light_active => lights.active,
        }
    }
    let mut roles: Vec<_> = arrays
        .materials
        .iter_mut()
        .map(|material| Roles(&mut material.texture))
        .collect();
    let cells = roles.iter_mut().map(|cell| cell as &mut dyn Cell).collect();
    let texid = Column {
        name: "mat_texid",
        store: Store::Whole,
        below: textures,
    };
    work(texid, cells);
    let wraps = arrays.tendon_wrap.iter_mut().flatten();
    let cells = wraps.map(|wrap| wrap as &mut dyn Cell).collect();
    let prm = Column {
        name: "wrap_prm",
        store: Store::Double,
        below: usize::MAX,
    };
    work(prm, cells);
    let vis = &mut arrays.vis;
    for (name, store, cell) in [
        ("vis_fovy", Store::Single, &mut vis.fovy as &mut dyn Cell),
        ("vis_azimuth", Store::Single, &mut vis.azimuth),
        ("vis_elevation", Store::Single, &mut vis.elevation),
        ("vis_znear", Store::Single, &mut vis.znear),
        ("vis_zfar", Store::Single, &mut vis.zfar),
        ("vis_ambient", Store::Single, &mut vis.headlight_ambient),
        ("vis_diffuse", Store::Single, &mut vis.headlight_diffuse),
        ("vis_specular", Store::Single, &mut vis.headlight_specular),
        ("vis_active", Store::Whole, &mut vis.headlight_active),
    ] {
        let below = usize::MAX;
        work(Column { name, store, below }, vec![cell]);
    }
}

/// The memory of all columns, by the type of their numbers. A program writes into it through arrays of NumPy.
pub struct Memory {
    doubles: Py<PyArray1<f64>>,
    singles: Py<PyArray1<f32>>,
    wholes: Py<PyArray1<i32>>,
    bytes: Py<PyArray1<u8>>,
    views: Py<PyDict>,
}

/// The numbers of all columns at one time.
#[derive(Clone, PartialEq)]
pub struct Contents {
    doubles: Vec<f64>,
    singles: Vec<f32>,
    wholes: Vec<i32>,
    bytes: Vec<u8>,
}

impl Contents {
    /// Reads the columns of a model.
    pub fn of(arrays: &Arrays) -> Self {
        let mut all = Self {
            doubles: Vec::new(),
            singles: Vec::new(),
            wholes: Vec::new(),
            bytes: Vec::new(),
        };
        visit(&mut arrays.clone(), |column, cells| {
            let mut numbers = Vec::new();
            cells.iter().for_each(|cell| cell.read(&mut numbers));
            match column.store {
                Store::Double => all.doubles.extend(numbers),
                Store::Single => all.singles.extend(numbers.iter().map(|n| *n as f32)),
                Store::Whole => all.wholes.extend(numbers.iter().map(|n| *n as i32)),
                Store::Byte => all.bytes.extend(numbers.iter().map(|n| *n as u8)),
            }
        });
        all
    }

    /// Writes what differs from `seen` into a model: the engine's numbers are kept where MuJoCo has fewer digits.
    pub fn write(&self, seen: &Self, arrays: &mut Arrays) -> PyResult<()> {
        let mut at = [0; 4];
        let mut fault = None;
        visit(arrays, |column, cells| {
            for (index, cell) in cells.into_iter().enumerate() {
                let mut old = Vec::new();
                cell.read(&mut old);
                let from = &mut at[column.store as usize];
                let span = *from..*from + old.len();
                *from = span.end;
                let pick = |all: &Self| -> Vec<f64> {
                    match column.store {
                        Store::Double => all.doubles[span.clone()].to_vec(),
                        Store::Single => all.singles[span.clone()].iter().map(|n| f64::from(*n)).collect(),
                        Store::Whole => all.wholes[span.clone()].iter().map(|n| f64::from(*n)).collect(),
                        Store::Byte => all.bytes[span.clone()].iter().map(|n| f64::from(*n)).collect(),
                    }
                };
                let (now, before) = (pick(self), pick(seen));
                if now == before {
                    continue;
                }
                let known = now.iter().all(|n| n.is_finite() && *n < column.below as f64);
                if !known || !cell.write(&now) {
                    fault.get_or_insert((column.name, index, now));
                }
            }
        });
        let Some((name, index, now)) = fault else {
            return Ok(());
        };
        Err(invalid(name, index, &now))
    }
}

/// Writes whole columns by name into a model.
pub fn write_columns(given: &BTreeMap<String, Vec<f64>>, arrays: &mut Arrays) -> PyResult<()> {
    let mut fault = Ok(());
    let mut left: BTreeSet<_> = given.keys().cloned().collect();
    visit(arrays, |column, cells| {
        let Some(numbers) = given.get(column.name) else {
            return;
        };
        left.remove(column.name);
        let mut at = 0;
        for (index, cell) in cells.into_iter().enumerate() {
            let mut old = Vec::new();
            cell.read(&mut old);
            let now = numbers.get(at..at + old.len()).unwrap_or_default();
            at += old.len();
            let single = |n: &f64| {
                if column.store == Store::Single {
                    f64::from(*n as f32)
                } else {
                    *n
                }
            };
            if now.len() == old.len() && now.iter().map(single).eq(old.iter().map(single)) {
                continue; // the engine's numbers are kept where MuJoCo has fewer digits
            }
            let known = now.len() == old.len() && now.iter().all(|n| n.is_finite() && *n < column.below as f64);
            if fault.is_ok() && !(known && cell.write(now)) {
                fault = Err(invalid(column.name, index, now));
            }
        }
    });
    if let Some(name) = left.first() {
        return Err(PyKeyError::new_err(format!(
            "nothing of the look of a model is called {name:?}"
        )));
    }
    fault
}

/// Returns the error for invalid numbers of an element.
fn invalid(name: &str, index: usize, now: &[f64]) -> PyErr {
    let name = name.replacen("vis_", "vis.", 1);
    PyValueError::new_err(format!(
        "model.{name}, element {index}, is {now:?}: numbers must be finite, groups 0 or more, and ids those of elements of the \
         model, or -1; of the roles of a material's textures, the second (mjTEXROLE_RGB) is drawn"
    ))
}

/// Returns fresh arrays of all columns by name.
pub fn columns<'py>(py: Python<'py>, arrays: &Arrays) -> PyResult<Bound<'py, PyDict>> {
    Ok(Memory::new(py, arrays, &Contents::of(arrays))?.views(py))
}

impl Memory {
    /// Makes the memory of a model's columns.
    pub fn new(py: Python<'_>, arrays: &Arrays, contents: &Contents) -> PyResult<Self> {
        let doubles = PyArray1::from_slice(py, &contents.doubles);
        let singles = PyArray1::from_slice(py, &contents.singles);
        let wholes = PyArray1::from_slice(py, &contents.wholes);
        let bytes = PyArray1::from_slice(py, &contents.bytes);
        let (views, mut at, mut made) = (PyDict::new(py), [0; 4], Ok(()));
        visit(&mut arrays.clone(), |column, cells| {
            let mut numbers = Vec::new();
            cells.iter().for_each(|cell| cell.read(&mut numbers));
            let from = &mut at[column.store as usize];
            let (first, end) = (*from, *from + numbers.len());
            *from = end;
            let rows = cells.first().is_some_and(|cell| cell.row());
            let width = numbers.len() / cells.len().max(1);
            let whole = match column.store {
                Store::Double => doubles.as_any(),
                Store::Single => singles.as_any(),
                Store::Whole => wholes.as_any(),
                Store::Byte => bytes.as_any(),
            };
            let view = || {
                let part = whole.get_item(pyo3::types::PySlice::new(py, first as isize, end as isize, 1))?;
                let part = if rows {
                    part.call_method1("reshape", ((cells.len(), width),))?
                } else {
                    part
                };
                views.set_item(column.name, part)
            };
            if made.is_ok() {
                made = view();
            }
        });
        made?;
        Ok(Self {
            doubles: doubles.unbind(),
            singles: singles.unbind(),
            wholes: wholes.unbind(),
            bytes: bytes.unbind(),
            views: views.unbind(),
        })
    }

    /// Returns the arrays by name.
    pub fn views<'py>(&self, py: Python<'py>) -> Bound<'py, PyDict> {
        self.views.bind(py).clone()
    }

    /// Returns what a program has written, if that differs from `seen`.
    pub fn changed(&self, py: Python<'_>, seen: &Contents) -> PyResult<Option<Contents>> {
        let (doubles, singles) = (
            self.doubles.bind(py).try_readonly()?,
            self.singles.bind(py).try_readonly()?,
        );
        let (wholes, bytes) = (
            self.wholes.bind(py).try_readonly()?,
            self.bytes.bind(py).try_readonly()?,
        );
        let now = (
            doubles.as_slice()?,
            singles.as_slice()?,
            wholes.as_slice()?,
            bytes.as_slice()?,
        );
        if now == (&seen.doubles[..], &seen.singles[..], &seen.wholes[..], &seen.bytes[..]) {
            return Ok(None);
        }
        let (doubles, singles, wholes, bytes) = now;
        Ok(Some(Contents {
            doubles: doubles.to_vec(),
            singles: singles.to_vec(),
            wholes: wholes.to_vec(),
            bytes: bytes.to_vec(),
        }))
    }
}

//! Arrays, options and names of a model, by their names in MuJoCo.

use std::ffi::{CStr, c_int};
use std::slice;

use super::super::api::NAMED;
use super::super::layout::{Field, Kind, Size, field, position};
use super::super::offsets::{MODEL, MODEL_SIZES, OPTION, PARTS, STATISTIC};
use super::{Simulation, array, count};

impl Simulation {
    /// Returns an array of the model, as numbers; `None` if `mjModel` has no array of that name.
    pub fn model_array(&self, name: &str) -> Option<Vec<f64>> {
        let f = MODEL.iter().find(|f| f.name == name)?;
        let n = self.number(count(f.rows)) * self.number(count(f.cols));
        // SAFETY: the table gives type, place and length of the array.
        Some(unsafe {
            match f.kind {
                Kind::F64 => array::<f64>(self.model, f.at, n).to_vec(),
                Kind::F32 => array::<f32>(self.model, f.at, n)
                    .iter()
                    .map(|&v| f64::from(v))
                    .collect(),
                Kind::I32 => array::<i32>(self.model, f.at, n)
                    .iter()
                    .map(|&v| f64::from(v))
                    .collect(),
                Kind::U8 => array::<u8>(self.model, f.at, n).iter().map(|&v| f64::from(v)).collect(),
            }
        })
    }

    /// Returns an option or a statistic of the model, as numbers.
    pub fn model_value(&self, name: &str) -> Option<Vec<f64>> {
        let part = |name| field(PARTS, name).at;
        let find = |table: &'static [Field]| table.iter().find(|f| f.name == name);
        let (base, f) = match (find(OPTION), find(STATISTIC)) {
            (Some(f), _) => (part("opt"), f),
            (None, Some(f)) => (part("stat"), f),
            (None, None) => return None,
        };
        let Size::Fixed(n) = f.cols else { return None };
        // SAFETY: the values lie inside mjModel, at these offsets.
        Some(unsafe {
            let first = self.model.byte_add(base + f.at);
            match f.kind {
                Kind::F64 => slice::from_raw_parts(first.cast::<f64>(), n).to_vec(),
                Kind::I32 => slice::from_raw_parts(first.cast::<i32>(), n)
                    .iter()
                    .map(|&v| f64::from(v))
                    .collect(),
                Kind::F32 | Kind::U8 => return None,
            }
        })
    }

    /// Returns all arrays, options and statistics of the model, as numbers, in the order of the tables.
    pub fn all_model_values(&self) -> Vec<Vec<f64>> {
        let known = |size: Size| match size {
            Size::Fixed(_) | Size::Times(..) => true,
            Size::Named(name) => position(MODEL_SIZES, name).is_some(),
        };
        let whole = MODEL.iter().filter(|f| known(f.rows) && known(f.cols));
        let arrays = whole.filter_map(|f| self.model_array(f.name));
        let values = OPTION.iter().chain(STATISTIC).filter_map(|f| self.model_value(f.name));
        arrays.chain(values).collect()
    }

    /// Returns the names of the elements of a kind: `body`, `jnt`, `geom` and so on.
    pub fn names(&self, kind: &str) -> Vec<String> {
        let Some((_, object, size)) = NAMED.iter().find(|n| n.0 == kind) else {
            return Vec::new();
        };
        let name = |k: usize| {
            // SAFETY: `k` is below the number of elements; the name ends with 0.
            let name = unsafe { (self.api.id2name)(self.model, *object, k as c_int) };
            if name.is_null() {
                return String::new();
            }
            unsafe { CStr::from_ptr(name) }.to_string_lossy().into_owned()
        };
        (0..self.size(size)).map(name).collect()
    }
}

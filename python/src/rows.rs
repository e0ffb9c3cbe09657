//! Arrays over the environments of a vector.

use babybench::sensors::ObservationEntry;
use babybench::sensors::transform::Sense;
use babybench::spaces::{ObservationSpace, ValuesMut};
use babybench::vector::Buffers;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};

use crate::slab::{AnySlab, Lent, Slab};

/// Arrays over environments, which Rust writes and Python reads.
pub struct Arrays {
    pub rows: usize,
    /// Observations by key, as Python sees them.
    pub dict: Py<PyDict>,
    /// Images by key, if they are drawn on request.
    images: Py<PyDict>,
    /// Whether images are drawn on request.
    lazy: bool,
    /// The arrays of the entries, in the order of [`ObservationEntry::ALL`]; `None` for missing ones.
    entries: Vec<Option<AnySlab>>,
    /// Values of a touch sensor.
    touch_width: usize,
    /// For each row the touch sensors that are not zero, if touch is observed.
    touched: Option<Vec<Vec<u32>>>,
    pub rewards: Slab<f64>,
    pub terminated: Slab<bool>,
    pub truncated: Slab<bool>,
}

impl Arrays {
    pub fn new(
        py: Python<'_>,
        rows: usize,
        spaces: &[ObservationSpace],
        touch_width: usize,
        lazy: bool,
    ) -> PyResult<Self> {
        let (dict, images, mut touched) = (PyDict::new(py), PyDict::new(py), None);
        let slab = |entry: &ObservationEntry| -> PyResult<Option<AnySlab>> {
            let Some(space) = spaces.iter().find(|space| space.key == entry.key) else {
                return Ok(None);
            };
            let slab = AnySlab::new(py, entry.dtype, &[&[rows], &space.shape[..]].concat())?;
            let of = if lazy && entry.image.is_some() { &images } else { &dict };
            of.set_item(entry.key, slab.view())?;
            if entry.sense == Some(Sense::Touch) {
                touched = Some(vec![Vec::new(); rows]);
            }
            Ok(Some(slab))
        };
        Ok(Self {
            rows,
            entries: ObservationEntry::ALL.iter().map(slab).collect::<PyResult<_>>()?,
            dict: dict.unbind(),
            images: images.unbind(),
            lazy,
            touched,
            touch_width,
            rewards: Slab::new(py, &[rows])?,
            terminated: Slab::new(py, &[rows])?,
            truncated: Slab::new(py, &[rows])?,
        })
    }

    /// Returns the observations in arrays that Python owns, or as read-only views.
    pub fn observations<'py>(&mut self, py: Python<'py>, copy: bool) -> PyResult<Bound<'py, PyDict>> {
        if !copy {
            return Ok(self.dict.bind(py).clone());
        }
        let lazy = self.lazy;
        self.copies(py, |entry| !(lazy && entry.image.is_some()))
    }

    /// Returns only the images.
    pub fn eyes<'py>(&mut self, py: Python<'py>, copy: bool) -> PyResult<Bound<'py, PyDict>> {
        if !copy && self.lazy {
            return Ok(self.images.bind(py).clone());
        }
        self.copies(py, |entry| entry.image.is_some())
    }

    /// Returns the chosen entries in arrays that Python owns.
    fn copies<'py>(
        &mut self,
        py: Python<'py>,
        chosen: impl Fn(&ObservationEntry) -> bool,
    ) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        let entries = ObservationEntry::ALL.iter().zip(&mut self.entries);
        for (entry, slab) in entries.filter(|(entry, _)| chosen(entry)) {
            let copied = match (slab, &self.touched, entry.sense) {
                (None, _, _) => continue,
                (Some(AnySlab::F32(slab)), Some(touched), Some(Sense::Touch)) => {
                    slab.copy(py, |from, to| copy_touched(from, to, self.touch_width, touched))?
                }
                (Some(slab), _, _) => slab.copy(py)?,
            };
            dict.set_item(PyString::intern(py, entry.key), copied)?;
        }
        Ok(dict)
    }

    /// Lends all arrays to a function that fills them.
    pub fn fill<R>(&mut self, py: Python<'_>, work: impl FnOnce(Buffers<'_>) -> PyResult<R>) -> PyResult<R> {
        let slabs = self.entries.iter();
        let mut lent: Vec<Option<Lent<'_>>> = slabs.map(|slab| Some(slab.as_ref()?.lend(py))).collect();
        let values = lent
            .iter_mut()
            .map(|lent| lent.as_mut().map(Lent::values_mut).transpose());
        let mut values = values.collect::<PyResult<Vec<Option<ValuesMut<'_>>>>>()?.into_iter();
        let mut rewards = self.rewards.lend(py);
        let (mut terminated, mut truncated) = (self.terminated.lend(py), self.truncated.lend(py));
        work(Buffers {
            rewards: Some(rewards.as_slice_mut()?),
            terminated: Some(terminated.as_slice_mut()?),
            truncated: Some(truncated.as_slice_mut()?),
            touched: self.touched.as_deref_mut(),
            ..Buffers::from_fn(|_| values.next()?)
        })
    }
}

/// Copies the nonzero values of touch: a long row for each environment.
fn copy_touched(from: &[f32], to: &mut [f32], width: usize, touched: &[Vec<u32>]) {
    to.fill(0.0);
    let row = from.len() / touched.len().max(1);
    for (env, sensors) in touched.iter().enumerate() {
        for &sensor in sensors {
            let first = env * row + width * sensor as usize;
            to[first..first + width].copy_from_slice(&from[first..first + width]);
        }
    }
}

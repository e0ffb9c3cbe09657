//! Arrays over environments: a row for each.

use super::Buffers;
use super::layout::RowLayout;
use crate::env::Observation;
use crate::sensors::ObservationEntry;
use crate::spaces::Array;

/// The vector's own arrays.
#[derive(Debug, Default)]
pub(super) struct VectorRows {
    /// The arrays of the entries, in the order of [`ObservationEntry::ALL`]; `None` for missing entries.
    entries: Vec<Option<Array>>,
    /// Lengths of their rows.
    layout: RowLayout,
    touched: Vec<Vec<u32>>,
    rewards: Vec<f64>,
    terminated: Vec<bool>,
    truncated: Vec<bool>,
}

impl VectorRows {
    pub fn new(n: usize, layout: RowLayout) -> Self {
        let entries = ObservationEntry::ALL.iter().zip(layout.entries);
        Self {
            entries: entries
                .map(|(entry, len)| Some(Array::zeros(entry.dtype, n * len?)))
                .collect(),
            layout,
            touched: match layout.touch() {
                Some(_) => (0..n).map(|_| Vec::with_capacity(layout.sensors)).collect(),
                None => Vec::new(),
            },
            rewards: vec![0.0; n],
            terminated: vec![false; n],
            truncated: vec![false; n],
        }
    }

    /// Returns the arrays of existing entries, for writing.
    pub fn buffers(&mut self) -> Buffers<'_> {
        let mut arrays = self.entries.iter_mut();
        Buffers {
            rewards: Some(&mut self.rewards),
            terminated: Some(&mut self.terminated),
            truncated: Some(&mut self.truncated),
            touched: (!self.touched.is_empty()).then_some(&mut self.touched),
            ..Buffers::from_fn(|_| Some(arrays.next()?.as_mut()?.values_mut()))
        }
    }

    /// Returns the observations of the first `n` rows, with or without images.
    pub fn observation(&self, n: usize, images: bool) -> Observation<'_> {
        let mut arrays = self.entries.iter().zip(self.layout.entries);
        Observation::from_fn(|entry| {
            let (array, len) = arrays.next().filter(|_| images || entry.image.is_none())?;
            Some(array.as_ref()?.first(n * len?))
        })
    }

    pub fn rewards(&self) -> &[f64] {
        &self.rewards
    }

    pub fn terminated(&self) -> &[bool] {
        &self.terminated
    }

    pub fn truncated(&self) -> &[bool] {
        &self.truncated
    }
}

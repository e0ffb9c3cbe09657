//! The values of a skin's sensors: thousands of numbers, nearly all of them zero.

use std::ops::Range;

/// Numbers of all sensors of a skin, N, with the list of the sensors that may be nonzero.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinValues {
    width: usize,
    values: Vec<f32>,
    /// Sensors that were written, and for each sensor whether it was written.
    touched: Vec<u32>,
    is_touched: Vec<bool>,
}

impl SkinValues {
    /// Creates zeros for a number of sensors with `width` numbers each.
    pub fn new(sensors: usize, width: usize) -> Self {
        Self {
            width,
            values: vec![0.0; width * sensors],
            touched: Vec::with_capacity(sensors),
            is_touched: vec![false; sensors],
        }
    }

    /// Returns the number of values for each sensor.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of sensors.
    pub fn sensors(&self) -> usize {
        self.is_touched.len()
    }

    /// Returns the values of all sensors, sensor by sensor.
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    /// Returns the sensors that were written, in that order: all others have the value zero.
    pub fn touched(&self) -> &[u32] {
        &self.touched
    }

    /// Returns the values of a sensor.
    pub fn of(&self, sensor: usize) -> &[f32] {
        &self.values[self.range(sensor)]
    }

    /// Returns the values of a sensor for changes; it counts as written from now on.
    pub fn of_mut(&mut self, sensor: usize) -> &mut [f32] {
        if !self.is_touched[sensor] {
            self.is_touched[sensor] = true;
            self.touched.push(sensor as u32);
        }
        let range = self.range(sensor);
        &mut self.values[range]
    }

    /// Calls `change` with the values of each sensor that was written, in that order.
    pub fn for_each_touched(&mut self, mut change: impl FnMut(&mut [f32])) {
        for k in 0..self.touched.len() {
            let range = self.range(self.touched[k] as usize);
            change(&mut self.values[range]);
        }
    }

    /// Sets all sensors to zero.
    pub fn clear(&mut self) {
        for k in 0..self.touched.len() {
            let sensor = self.touched[k] as usize;
            let range = self.range(sensor);
            self.values[range].fill(0.0);
            self.is_touched[sensor] = false;
        }
        self.touched.clear();
    }

    /// Takes over the values of a skin of the same size.
    pub fn copy_from(&mut self, other: &Self) {
        self.clear();
        for &sensor in &other.touched {
            self.of_mut(sensor as usize).copy_from_slice(other.of(sensor as usize));
        }
    }

    /// Removes from the list the sensors whose values are zero.
    pub fn forget_zeros(&mut self) {
        let (values, is_touched, width) = (&self.values, &mut self.is_touched, self.width);
        self.touched.retain(|&sensor| {
            let sensor = sensor as usize;
            let keep = values[width * sensor..width * (sensor + 1)].iter().any(|v| *v != 0.0);
            is_touched[sensor] = keep;
            keep
        });
    }

    fn range(&self, sensor: usize) -> Range<usize> {
        self.width * sensor..self.width * (sensor + 1)
    }
}

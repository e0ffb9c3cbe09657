//! Networks, with the same numbers for the same seed.

use babybench::spaces::NumpyRng;
use candle_core::{Device, Tensor, Var};

use crate::Error;

/// Normally distributed numbers from a seed.
#[derive(Clone, Debug)]
pub struct Noise(NumpyRng);

impl Noise {
    /// Starts with a seed.
    pub fn new(seed: u64) -> Self {
        Self(NumpyRng::seed(seed))
    }

    /// Draws a number of mean 0 and variance 1 (Box and Muller 1958).
    pub fn normal(&mut self) -> f32 {
        let radius = (-2.0 * (1.0 - self.0.uniform()).ln()).sqrt();
        (radius * (std::f64::consts::TAU * self.0.uniform()).cos()) as f32
    }

    /// Returns the numbers below `n` in random order.
    pub fn shuffled(&mut self, n: usize) -> Vec<u32> {
        let mut order: Vec<u32> = (0..n as u32).collect();
        for k in (1..n).rev() {
            order.swap(k, (self.0.uniform() * (k + 1) as f64) as usize);
        }
        order
    }
}

/// Layers that are fully connected, with tanh between them.
#[derive(Clone, Debug)]
pub struct Mlp {
    layers: Vec<[Var; 2]>,
}

impl Mlp {
    /// Makes layers of the given sizes. The weights of the last one are multiplied by `last`.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn new(sizes: &[usize], last: f32, noise: &mut Noise) -> Result<Self, Error> {
        let mut layers = Vec::new();
        for (k, size) in sizes.windows(2).enumerate() {
            let (inputs, outputs) = (size[0], size[1]);
            let gain = if k + 2 == sizes.len() { last } else { 1.0 };
            let scale = gain / (inputs as f32).sqrt();
            let weights: Vec<f32> = (0..inputs * outputs).map(|_| scale * noise.normal()).collect();
            layers.push([
                Var::from_vec(weights, (inputs, outputs), &Device::Cpu)?,
                Var::from_vec(vec![0.0_f32; outputs], outputs, &Device::Cpu)?,
            ]);
        }
        Ok(Self { layers })
    }

    /// Computes the outputs for rows of inputs.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn forward(&self, inputs: &Tensor) -> Result<Tensor, Error> {
        let mut x = inputs.clone();
        for (k, [weights, bias]) in self.layers.iter().enumerate() {
            x = x.matmul(weights)?.broadcast_add(bias)?;
            if k + 1 < self.layers.len() {
                x = x.tanh()?;
            }
        }
        Ok(x)
    }

    /// Returns what is learned.
    pub fn vars(&self) -> Vec<Var> {
        self.layers.iter().flatten().cloned().collect()
    }
}

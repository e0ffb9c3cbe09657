//! The inputs of the policy: one row of numbers for each environment.

use babybench::Env;

/// Numbers beyond this many standard deviations are cut off.
const MOST: f32 = 5.0;

/// The combined senses of an infant: joints, balance, force on each part of the skin, touches so far, and the remaining time of the
/// episode.
#[derive(Clone, Debug)]
pub struct Senses {
    bodies: Vec<usize>,
}

impl Senses {
    /// Finds the parts with skin.
    pub fn new(env: &Env) -> Self {
        let skin = env.senses().touch().map(|touch| touch.layout().bodies());
        Self {
            bodies: skin.unwrap_or_default().iter().map(|skin| skin.body).collect(),
        }
    }

    /// Returns the number of parts with skin.
    pub fn feelings(&self) -> usize {
        self.bodies.len()
    }

    /// Appends the force on each part with skin: the logarithm of newtons plus one.
    pub fn feel(&self, env: &Env, out: &mut Vec<f32>) {
        let Some(touch) = env.senses().touch() else { return };
        out.extend(self.bodies.iter().map(|&body| {
            let force = touch.force_on_body(body);
            let newtons = force.iter().map(|f| f * f).sum::<f64>().sqrt();
            newtons.ln_1p() as f32
        }));
    }

    /// Appends a row. `touched` lists the parts touched in this episode, and `progress` is its elapsed share, 0 to 1.
    pub fn sense(&self, env: &Env, touched: &[bool], progress: f32, out: &mut Vec<f32>) {
        let observation = env.observation();
        let joints = observation.proprioception.iter();
        let balance = observation.vestibular.unwrap_or_default().iter();
        out.extend(joints.chain(balance).map(|&v| v as f32));
        self.feel(env, out);
        out.extend(touched.iter().map(|&t| f32::from(u8::from(t))));
        out.push(progress);
    }
}

/// Normalises numbers to mean 0 and variance 1, by the statistics of all numbers so far (Welford 1962).
#[derive(Clone, Debug, Default)]
pub struct Normalizer {
    count: f64,
    mean: Vec<f64>,
    squares: Vec<f64>,
}

impl Normalizer {
    /// Learns from a row.
    pub fn learn(&mut self, row: &[f32]) {
        self.mean.resize(row.len(), 0.0);
        self.squares.resize(row.len(), 0.0);
        self.count += 1.0;
        for ((&v, mean), squares) in row.iter().zip(&mut self.mean).zip(&mut self.squares) {
            let off = f64::from(v) - *mean;
            *mean += off / self.count;
            *squares += off * (f64::from(v) - *mean);
        }
    }

    /// Normalizes a row.
    pub fn apply(&self, row: &mut [f32]) {
        for ((v, mean), squares) in row.iter_mut().zip(&self.mean).zip(&self.squares) {
            let deviation = (squares / self.count.max(1.0)).sqrt().max(1e-3);
            *v = (((f64::from(*v) - mean) / deviation) as f32).clamp(-MOST, MOST);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_to_mean_0_and_variance_1() {
        let mut normalizer = Normalizer::default();
        let values = [2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0];
        values.iter().for_each(|&v| normalizer.learn(&[v]));
        let mut rows = [[5.0], [7.0], [1.0], [1000.0]];
        rows.iter_mut().for_each(|row| normalizer.apply(row));
        assert_eq!(rows, [[0.0], [1.0], [-2.0], [MOST]]);
    }
}

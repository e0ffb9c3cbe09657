//! Evolution of a vector of numbers by separable CMA-ES, whose cost is linear in their count (R. Ros and N. Hansen, "A simple
//! modification in CMA-ES achieving linear time and space complexity", 2008).

use babybench::spaces::NumpyRng;

/// The distribution that candidates are drawn from: a mean, a step size, and a variance for each number.
#[derive(Clone, Debug)]
pub struct Evolution {
    pub mean: Vec<f64>,
    step: f64,
    variance: Vec<f64>,
    /// Paths of the mean: of the variances, and of the step size.
    paths: [Vec<f64>; 2],
    generation: i32,
    weights: Vec<f64>,
    size: usize,
}

impl Evolution {
    /// Starts from a mean. Of the `size` candidates of each generation, the better half determines the next.
    pub fn new(mean: Vec<f64>, step: f64, size: usize) -> Self {
        let half = size as f64 / 2.0;
        let weights = (1..=size / 2).map(|k| pxfm::f_log(half + 0.5) - pxfm::f_log(k as f64));
        let weights: Vec<f64> = weights.collect();
        let sum: f64 = weights.iter().sum();
        let n = mean.len();
        Self {
            mean,
            step,
            variance: vec![1.0; n],
            paths: [vec![0.0; n], vec![0.0; n]],
            generation: 0,
            weights: weights.into_iter().map(|w| w / sum).collect(),
            size,
        }
    }

    /// Draws the candidates of a generation.
    pub fn draw(&self, rng: &mut NumpyRng) -> Vec<Vec<f64>> {
        let mut candidate = || -> Vec<f64> {
            let spread = self.mean.iter().zip(&self.variance);
            spread
                .map(|(mean, variance)| mean + self.step * variance.sqrt() * rng.normal())
                .collect()
        };
        (0..self.size).map(|_| candidate()).collect()
    }

    /// Learns from the candidates of a generation, the best one first.
    pub fn learn(&mut self, best_first: &[&Vec<f64>]) {
        let n = self.mean.len() as f64;
        let effective = 1.0 / self.weights.iter().map(|w| w * w).sum::<f64>();
        let for_step = (effective + 2.0) / (n + effective + 5.0);
        let for_path = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
        // a diagonal is learned faster than a whole matrix
        let faster = (n + 2.0) / 3.0;
        let for_one = faster * 2.0 / ((n + 1.3) * (n + 1.3) + effective);
        let rest = faster * 2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0) * (n + 2.0) + effective);
        let for_rank = rest.min(1.0 - for_one).max(0.0);
        let damping = 1.0 + for_step + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0);
        let usual = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        self.generation += 1;
        let [path, step_path] = &mut self.paths;
        let mut length = 0.0;
        let mut moves = vec![0.0; self.mean.len()];
        for (i, way) in moves.iter_mut().enumerate() {
            let best = best_first.iter().zip(&self.weights);
            *way = best.map(|(c, w)| w * (c[i] - self.mean[i])).sum::<f64>() / self.step;
            let white = *way / self.variance[i].sqrt();
            step_path[i] = (1.0 - for_step) * step_path[i] + (for_step * (2.0 - for_step) * effective).sqrt() * white;
            length += step_path[i] * step_path[i];
        }
        let length = length.sqrt();
        let settled = (1.0 - pxfm::f_pow(1.0 - for_step, 2.0 * f64::from(self.generation))).sqrt();
        let stalled = length / settled >= (1.4 + 2.0 / (n + 1.0)) * usual;
        let gain = if stalled {
            0.0
        } else {
            (for_path * (2.0 - for_path) * effective).sqrt()
        };
        for (i, way) in moves.iter().enumerate() {
            path[i] = (1.0 - for_path) * path[i] + gain * way;
            let best = best_first.iter().zip(&self.weights);
            let spread: f64 = best.map(|(c, w)| w * ((c[i] - self.mean[i]) / self.step).powi(2)).sum();
            let kept = (1.0 - for_one - for_rank) * self.variance[i];
            self.variance[i] = (kept + for_one * path[i] * path[i] + for_rank * spread).max(1e-12);
            self.mean[i] += self.step * way;
        }
        self.step *= pxfm::f_exp((for_step / damping * (length / usual - 1.0)).min(1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bowl_of_unequal_sides_is_descended() {
        let worth = |c: &Vec<f64>| -> f64 {
            let squares = c.iter().enumerate();
            -squares
                .map(|(i, v)| pxfm::f_pow(10.0, i as f64 / 5.0) * (v - 1.0).powi(2))
                .sum::<f64>()
        };
        let (mut evolution, mut rng) = (Evolution::new(vec![0.0; 20], 0.5, 12), NumpyRng::seed(0));
        for _ in 0..300 {
            let candidates = evolution.draw(&mut rng);
            let mut order: Vec<&Vec<f64>> = candidates.iter().collect();
            order.sort_by(|a, b| worth(b).total_cmp(&worth(a)));
            evolution.learn(&order);
        }
        assert!(worth(&evolution.mean) > -1e-6, "{}", worth(&evolution.mean));
    }
}

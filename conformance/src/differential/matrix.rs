//! The condition of an inertia matrix.

/// Returns the condition of a symmetric matrix (n, n) after rows and columns are scaled to a diagonal of ones; infinite when it
/// is not positive definite.
pub fn scaled_condition(matrix: &[f64], n: usize) -> f64 {
    if n == 0 {
        return 1.0;
    }
    let scale: Vec<f64> = (0..n).map(|k| matrix[k * n + k].max(1e-300).sqrt()).collect();
    let mut a: Vec<f64> = (0..n * n).map(|k| matrix[k] / (scale[k / n] * scale[k % n])).collect();
    if a.iter().any(|v| !v.is_finite()) {
        return f64::INFINITY;
    }
    eigenvalues(&mut a, n);
    let values = (0..n).map(|k| a[k * n + k]);
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    if low > 0.0 { high / low } else { f64::INFINITY }
}

/// Turns a symmetric matrix into a diagonal of its eigenvalues, by Jacobi's rotations.
fn eigenvalues(a: &mut [f64], n: usize) {
    for _ in 0..30 {
        let off: f64 = (0..n * n).filter(|k| k / n != k % n).map(|k| a[k] * a[k]).sum();
        if off < 1e-24 {
            return;
        }
        for p in 0..n {
            for q in p + 1..n {
                if a[p * n + q].abs() > 1e-300 {
                    rotate(a, n, p, q);
                }
            }
        }
    }
}

fn rotate(a: &mut [f64], n: usize, p: usize, q: usize) {
    let theta = (a[q * n + q] - a[p * n + p]) / (2.0 * a[p * n + q]);
    let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
    let (c, s) = (1.0 / (t * t + 1.0).sqrt(), t / (t * t + 1.0).sqrt());
    for k in 0..n {
        let (x, y) = (a[k * n + p], a[k * n + q]);
        (a[k * n + p], a[k * n + q]) = (c * x - s * y, s * x + c * y);
    }
    for k in 0..n {
        let (x, y) = (a[p * n + k], a[q * n + k]);
        (a[p * n + k], a[q * n + k]) = (c * x - s * y, s * x + c * y);
    }
}

#[cfg(test)]
mod tests {
    use super::scaled_condition;

    #[test]
    fn the_condition_of_two_coupled_coordinates_is_known() {
        // eigenvalues 1 - r and 1 + r
        let r = 0.999;
        let condition = scaled_condition(&[4.0, 6.0 * r, 6.0 * r, 9.0], 2);
        assert!((condition / ((1.0 + r) / (1.0 - r)) - 1.0).abs() < 1e-9, "{condition}");
        assert!(scaled_condition(&[1.0, 2.0, 2.0, 1.0], 2).is_infinite());
    }
}

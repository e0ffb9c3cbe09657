//! Random numbers as MJCF writes them.

use fastrand::Rng;

/// A seeded source of values for attributes.
pub struct Dice {
    /// The source of all random choices.
    pub rng: Rng,
    /// A radian in the unit of the attribute that is drawn.
    pub angle: f64,
}

/// Writes numbers with all their digits.
pub fn numbers(values: &[f64]) -> String {
    values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
}

impl Dice {
    /// Creates dice whose angles are radians.
    pub fn new(seed: u64) -> Self {
        Self {
            rng: Rng::with_seed(seed),
            angle: 1.0,
        }
    }

    /// Returns true with a probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.rng.f64() < probability
    }

    /// Returns one of several items.
    pub fn pick<T: Copy>(&mut self, things: &[T]) -> T {
        things[self.rng.usize(..things.len())]
    }

    /// Returns a number between two others.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.rng.f64()
    }

    /// Returns a positive number, with all orders of magnitude equally likely.
    pub fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp()
    }

    /// Returns `n` numbers between `-size` and `size`.
    pub fn vector(&mut self, n: usize, size: f64) -> Vec<f64> {
        (0..n).map(|_| self.uniform(-size, size)).collect()
    }

    /// Writes a positive number.
    pub fn log(&mut self, low: f64, high: f64) -> String {
        self.magnitude(low, high).to_string()
    }

    /// Writes `n` numbers between `-size` and `size`, at times round ones.
    pub fn reals(&mut self, n: usize, size: f64) -> String {
        let mut values = self.vector(n, size);
        if self.chance(0.2) {
            values.iter_mut().for_each(|v| *v = (*v * 10.0).round() / 10.0);
        }
        numbers(&values)
    }

    /// Writes two numbers, the smaller one first.
    pub fn range(&mut self, size: f64) -> String {
        let mut ends = self.vector(2, size);
        ends.sort_by(f64::total_cmp);
        numbers(&ends)
    }

    /// Writes two bounds; sometimes one is infinite.
    pub fn bounds(&mut self, size: f64) -> String {
        let range = self.range(size);
        match (self.rng.u8(..40), range.split_once(' ')) {
            (0, Some((low, _))) => format!("{low} inf"),
            (1, Some((_, high))) => format!("-inf {high}"),
            _ => range,
        }
    }

    /// Writes the gain or the bias of a muscle.
    pub fn muscle(&mut self) -> String {
        let (low, high) = (self.log(0.3, 0.9), self.log(0.95, 1.5));
        let force = if self.chance(0.5) {
            "-1".to_owned()
        } else {
            self.log(0.1, 20.0)
        };
        let (scale, lmin, lmax) = (self.log(1.0, 300.0), self.log(0.2, 0.9), self.log(1.1, 2.0));
        let (vmax, fpmax, fvmax) = (self.log(0.3, 5.0), self.log(0.3, 3.0), self.log(0.9, 2.0));
        format!("{low} {high} {force} {scale} {lmin} {lmax} {vmax} {fpmax} {fvmax}")
    }

    /// Writes an axis, at times one of the coordinates.
    pub fn axis(&mut self) -> String {
        match self.rng.usize(..5) {
            0 => "1 0 0".to_owned(),
            1 => "0 1 0".to_owned(),
            2 => "0 0 -2".to_owned(),
            _ => numbers(&self.vector(3, 1.0)),
        }
    }

    /// Writes a quaternion, at times of a quarter turn.
    pub fn quat(&mut self) -> String {
        match self.rng.usize(..6) {
            0 => "0 1 0 0".to_owned(),
            1 => "0.5 0.5 0.5 0.5".to_owned(),
            2 => "0.7071067811865476 0 0 0.7071067811865476".to_owned(),
            _ => numbers(&self.vector(4, 1.0)),
        }
    }

    /// Writes a `solref`: time constant and damping ratio, stiffness and damping, one number, or signs that do not fit.
    pub fn solref(&mut self) -> String {
        match self.rng.usize(..20) {
            0..=3 => numbers(&[-self.magnitude(10.0, 1e4), -self.magnitude(0.1, 1e2)]),
            4 | 5 => self.log(0.003, 0.1),
            6 => self
                .pick(&["0.02 -1", "-100 5", "0.02 0", "0 1", "0 0", "-100 0", "0 -5", "-50"])
                .to_owned(),
            _ => numbers(&[self.magnitude(0.003, 0.1), self.uniform(0.3, 1.5)]),
        }
    }

    /// Writes the first numbers of a `solimp`, or all of them.
    pub fn solimp(&mut self) -> String {
        let power = self.pick(&[1.0, 2.0, 3.0, 1.7, 4.3]);
        let mut all = [
            self.uniform(0.1, 0.98),
            self.uniform(0.5, 0.999),
            self.magnitude(1e-4, 0.1),
            self.uniform(0.05, 0.95),
            power,
        ];
        if self.chance(0.1) {
            all[2] = 0.0;
        }
        let n = self.rng.usize(1..=5);
        numbers(&all[..n])
    }

    /// Writes friction coefficients: `sliding` ones, a torsional one, and as many rolling ones; the first few, or all.
    pub fn friction(&mut self, sliding: usize) -> String {
        let mut all: Vec<f64> = (0..sliding).map(|_| self.uniform(0.0, 1.5)).collect();
        all.push(self.magnitude(1e-4, 0.1));
        all.extend((0..sliding).map(|_| self.magnitude(1e-5, 0.01)));
        let n = self.rng.usize(1..=all.len());
        // rows without friction have nearly no regularisation
        if self.chance(0.1) {
            all.fill(0.0);
        }
        numbers(&all[..n])
    }

    /// Writes the inertia matrix of some points.
    pub fn full_inertia(&mut self) -> String {
        let mut sum = [0.0; 6];
        for _ in 0..4 {
            let (m, at) = (self.magnitude(0.01, 1.0), self.vector(3, 0.2));
            let [x, y, z] = [at[0], at[1], at[2]];
            let point = [y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z];
            sum.iter_mut().zip(point).for_each(|(s, p)| *s += m * p);
        }
        numbers(&sum)
    }

    /// Writes principal moments of inertia that a body can have.
    pub fn diagonal_inertia(&mut self) -> String {
        let (a, b) = (self.magnitude(0.001, 0.05), self.magnitude(0.001, 0.05));
        let c = self.uniform((a - b).abs() * 1.001, (a + b) * 0.999);
        numbers(&[a, b, c])
    }

    /// Writes an angle or a length of joint coordinates.
    pub fn coordinate(&mut self, size: f64) -> String {
        let value = self.uniform(-size, size);
        (value * self.angle).to_string()
    }

    /// Writes limits of joint coordinates.
    pub fn limits(&mut self) -> String {
        self.bounds(self.angle)
    }
}

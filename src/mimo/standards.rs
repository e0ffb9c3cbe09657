//! Growth of infants according to the World Health Organization, for comparison with MIMo's.

/// The distribution of a measurement at an age, as L, M and S of T. J. Cole's method: M is the median, S the coefficient of variation,
/// L the power that makes it normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lms {
    /// The power.
    pub l: f64,
    /// The median, in the unit of the measurement.
    pub m: f64,
    /// The coefficient of variation.
    pub s: f64,
}

impl Lms {
    /// Returns the z-score of a value: ((x / M)^L - 1) / (L S), and ln(x / M) / S for L = 0.
    pub fn z(self, x: f64) -> f64 {
        let ratio = x / self.m;
        if self.l == 0.0 {
            pxfm::f_log(ratio) / self.s
        } else {
            (pxfm::f_pow(ratio, self.l) - 1.0) / (self.l * self.s)
        }
    }

    /// Returns the value of a z-score.
    pub fn value(self, z: f64) -> f64 {
        if self.l == 0.0 {
            self.m * pxfm::f_exp(self.s * z)
        } else {
            self.m * pxfm::f_pow(1.0 + self.l * self.s * z, 1.0 / self.l)
        }
    }
}

/// Length and weight of boys or of girls at an age, by the WHO Child Growth Standards (Multicentre Growth Reference Study Group,
/// "WHO Child Growth Standards: Length/height-for-age, weight-for-age, ...: Methods and development", 2006).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowthStandard {
    /// `boys` or `girls`.
    pub of: &'static str,
    /// Recumbent length, cm.
    pub length: Lms,
    /// Weight, kg.
    pub weight: Lms,
}

impl GrowthStandard {
    /// Returns the standards of boys and of girls at an age from 0 to 24 months: the tables of whole months, linear between them.
    ///
    /// ```
    /// use babybench::mimo::GrowthStandard;
    ///
    /// let [boys, girls] = GrowthStandard::at(12.0);
    /// assert_eq!((boys.length.m, girls.weight.m), (75.7488, 8.9481));
    /// assert!((boys.length.z(boys.length.value(-2.0)) + 2.0).abs() < 1e-12);
    /// ```
    pub fn at(age: f64) -> [Self; 2] {
        let standard = |of, length: &[[f64; 3]; 25], weight: &[[f64; 3]; 25]| Self {
            of,
            length: between(length, age),
            weight: between(weight, age),
        };
        [
            standard("boys", &LENGTH_OF_BOYS, &WEIGHT_OF_BOYS),
            standard("girls", &LENGTH_OF_GIRLS, &WEIGHT_OF_GIRLS),
        ]
    }
}

/// Interpolates in a table of whole months.
fn between(table: &[[f64; 3]; 25], age: f64) -> Lms {
    let age = age.clamp(0.0, 24.0);
    let month = (age as usize).min(23);
    let (low, high, share) = (table[month], table[month + 1], age - month as f64);
    let [l, m, s] = std::array::from_fn(|k| low[k] + (high[k] - low[k]) * share);
    Lms { l, m, s }
}

/// Recumbent length of boys, cm, by month: L, M, S.
const LENGTH_OF_BOYS: [[f64; 3]; 25] = [
    [1.0, 49.8842, 0.03795],
    [1.0, 54.7244, 0.03557],
    [1.0, 58.4249, 0.03424],
    [1.0, 61.4292, 0.03328],
    [1.0, 63.886, 0.03257],
    [1.0, 65.9026, 0.03204],
    [1.0, 67.6236, 0.03165],
    [1.0, 69.1645, 0.03139],
    [1.0, 70.5994, 0.03124],
    [1.0, 71.9687, 0.03117],
    [1.0, 73.2812, 0.03118],
    [1.0, 74.5388, 0.03125],
    [1.0, 75.7488, 0.03137],
    [1.0, 76.9186, 0.03154],
    [1.0, 78.0497, 0.03174],
    [1.0, 79.1458, 0.03197],
    [1.0, 80.2113, 0.03222],
    [1.0, 81.2487, 0.0325],
    [1.0, 82.2587, 0.03279],
    [1.0, 83.2418, 0.0331],
    [1.0, 84.1996, 0.03342],
    [1.0, 85.1348, 0.03376],
    [1.0, 86.0477, 0.0341],
    [1.0, 86.941, 0.03445],
    [1.0, 87.8161, 0.03479],
];

/// Recumbent length of girls, cm.
const LENGTH_OF_GIRLS: [[f64; 3]; 25] = [
    [1.0, 49.1477, 0.0379],
    [1.0, 53.6872, 0.0364],
    [1.0, 57.0673, 0.03568],
    [1.0, 59.8029, 0.0352],
    [1.0, 62.0899, 0.03486],
    [1.0, 64.0301, 0.03463],
    [1.0, 65.7311, 0.03448],
    [1.0, 67.2873, 0.03441],
    [1.0, 68.7498, 0.0344],
    [1.0, 70.1435, 0.03444],
    [1.0, 71.4818, 0.03452],
    [1.0, 72.771, 0.03464],
    [1.0, 74.015, 0.03479],
    [1.0, 75.2176, 0.03496],
    [1.0, 76.3817, 0.03514],
    [1.0, 77.5099, 0.03534],
    [1.0, 78.6055, 0.03555],
    [1.0, 79.671, 0.03576],
    [1.0, 80.7079, 0.03598],
    [1.0, 81.7182, 0.0362],
    [1.0, 82.7036, 0.03643],
    [1.0, 83.6654, 0.03666],
    [1.0, 84.604, 0.03688],
    [1.0, 85.5202, 0.03711],
    [1.0, 86.4153, 0.03734],
];

/// Weight of boys, kg.
const WEIGHT_OF_BOYS: [[f64; 3]; 25] = [
    [0.3487, 3.3464, 0.14602],
    [0.2297, 4.4709, 0.13395],
    [0.197, 5.5675, 0.12385],
    [0.1738, 6.3762, 0.11727],
    [0.1553, 7.0023, 0.11316],
    [0.1395, 7.5105, 0.1108],
    [0.1257, 7.934, 0.10958],
    [0.1134, 8.297, 0.10902],
    [0.1021, 8.6151, 0.10882],
    [0.0917, 8.9014, 0.10881],
    [0.082, 9.1649, 0.10891],
    [0.073, 9.4122, 0.10906],
    [0.0644, 9.6479, 0.10925],
    [0.0563, 9.8749, 0.10949],
    [0.0487, 10.0953, 0.10976],
    [0.0413, 10.3108, 0.11007],
    [0.0343, 10.5228, 0.11041],
    [0.0275, 10.7319, 0.11079],
    [0.0211, 10.9385, 0.11119],
    [0.0148, 11.143, 0.11164],
    [0.0087, 11.3462, 0.11211],
    [0.0029, 11.5486, 0.11261],
    [-0.0028, 11.7504, 0.11314],
    [-0.0083, 11.9514, 0.11369],
    [-0.0137, 12.1515, 0.11426],
];

/// Weight of girls, kg.
const WEIGHT_OF_GIRLS: [[f64; 3]; 25] = [
    [0.3809, 3.2322, 0.14171],
    [0.1714, 4.1873, 0.13724],
    [0.0962, 5.1282, 0.13],
    [0.0402, 5.8458, 0.12619],
    [-0.005, 6.4237, 0.12402],
    [-0.043, 6.8985, 0.12274],
    [-0.0756, 7.297, 0.12204],
    [-0.1039, 7.6422, 0.12178],
    [-0.1288, 7.9487, 0.12181],
    [-0.1507, 8.2254, 0.12199],
    [-0.17, 8.48, 0.12223],
    [-0.1872, 8.7192, 0.12247],
    [-0.2024, 8.9481, 0.12268],
    [-0.2158, 9.1699, 0.12283],
    [-0.2278, 9.387, 0.12294],
    [-0.2384, 9.6008, 0.12299],
    [-0.2478, 9.8124, 0.12303],
    [-0.2562, 10.0226, 0.12306],
    [-0.2637, 10.2315, 0.12309],
    [-0.2703, 10.4393, 0.12315],
    [-0.2762, 10.6464, 0.12323],
    [-0.2815, 10.8534, 0.12335],
    [-0.2862, 11.0608, 0.1235],
    [-0.2903, 11.2688, 0.12369],
    [-0.2941, 11.4775, 0.1239],
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Bands of the tables as the WHO prints them, in whole tenths.
    #[test]
    fn bands_are_those_that_the_who_prints() {
        let tenths = |x: f64| (10.0 * x).round() / 10.0;
        let [boys, girls] = GrowthStandard::at(0.0);
        assert_eq!(
            [-2.0, 0.0, 2.0].map(|z| tenths(boys.length.value(z))),
            [46.1, 49.9, 53.7]
        );
        assert_eq!([-2.0, 0.0, 2.0].map(|z| tenths(girls.weight.value(z))), [2.4, 3.2, 4.2]);
        let [boys, girls] = GrowthStandard::at(6.0);
        assert_eq!([-2.0, 0.0, 2.0].map(|z| tenths(boys.weight.value(z))), [6.4, 7.9, 9.8]);
        assert_eq!(
            [-2.0, 0.0, 2.0].map(|z| tenths(girls.length.value(z))),
            [61.2, 65.7, 70.3]
        );
    }

    #[test]
    fn ages_beyond_the_tables_are_their_ends() {
        assert_eq!(GrowthStandard::at(24.0), GrowthStandard::at(30.0));
        assert_eq!(GrowthStandard::at(0.0), GrowthStandard::at(-1.0));
        let [boys, _] = GrowthStandard::at(0.5);
        assert!((boys.length.m - 0.5 * (49.8842 + 54.7244)).abs() < 1e-12);
    }
}

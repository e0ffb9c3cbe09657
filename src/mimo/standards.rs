//! Growth of infants according to the World Health Organization.

use super::sources::{Mark, SourcedConstant};

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

/// The name of the WHO's standards.
pub(super) const WHO: &str = "WHO Child Growth Standards 2006";

/// Length, weight and head circumference of boys or of girls at an age. [`GrowthStandard::at`] has those of the WHO Child Growth Standards
/// (Multicentre Growth Reference Study Group, "WHO Child Growth Standards: Methods and development", 2006, and the volume of 2007 on head
/// circumference). [`GrowthStandard::of_config`] chooses those of MIMo's age.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrowthStandard {
    /// `boys` or `girls`.
    pub of: &'static str,
    /// Name of the standard.
    pub source: &'static str,
    /// Recumbent length, cm.
    pub length: Lms,
    /// Weight, kg.
    pub weight: Lms,
    /// Head circumference, cm.
    pub head: Lms,
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
        let standard = |of, [length, weight, head]: [&[[f64; 3]; 25]; 3]| Self {
            of,
            source: WHO,
            length: between(length, age),
            weight: between(weight, age),
            head: between(head, age),
        };
        [
            standard("boys", [&LENGTH_OF_BOYS, &WEIGHT_OF_BOYS, &HEAD_OF_BOYS]),
            standard("girls", [&LENGTH_OF_GIRLS, &WEIGHT_OF_GIRLS, &HEAD_OF_GIRLS]),
        ]
    }
}

/// Ages of the listed medians, months.
const LISTED: [f64; 5] = [0.0, 3.0, 6.0, 12.0, 24.0];

/// Lists medians of the standards.
pub(super) fn constants() -> Vec<SourcedConstant> {
    let both = |what: &str, unit, pick: fn(&GrowthStandard) -> Lms| {
        [0, 1].map(|sex| {
            let of = |age: f64| GrowthStandard::at(age)[sex];
            SourcedConstant {
                name: format!("median {what} of {}", of(0.0).of),
                values: LISTED.map(|age| pick(&of(age)).m).to_vec(),
                ages: LISTED.to_vec(),
                unit,
                source: "WHO Child Growth Standards 2006 and 2007, tables of whole months with L, M and S",
                mark: Mark::Read,
            }
        })
    };
    let all = [
        both("length", "cm", |of| of.length),
        both("weight", "kg", |of| of.weight),
        both("head circumference", "cm", |of| of.head),
    ];
    all.into_iter().flatten().collect()
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

/// Head circumference of boys, cm, at the day nearest to each month.
const HEAD_OF_BOYS: [[f64; 3]; 25] = [
    [1.0, 34.4618, 0.03686],
    [1.0, 37.2435, 0.03135],
    [1.0, 39.1349, 0.02997],
    [1.0, 40.5008, 0.02918],
    [1.0, 41.6401, 0.02868],
    [1.0, 42.5524, 0.02837],
    [1.0, 43.3393, 0.02817],
    [1.0, 43.9791, 0.02804],
    [1.0, 44.5384, 0.02796],
    [1.0, 45.0007, 0.02792],
    [1.0, 45.4004, 0.0279],
    [1.0, 45.7593, 0.02789],
    [1.0, 46.0637, 0.02789],
    [1.0, 46.3421, 0.02789],
    [1.0, 46.5834, 0.02791],
    [1.0, 46.809, 0.02792],
    [1.0, 47.0088, 0.02795],
    [1.0, 47.1936, 0.02797],
    [1.0, 47.3718, 0.028],
    [1.0, 47.5341, 0.02803],
    [1.0, 47.6931, 0.02806],
    [1.0, 47.8399, 0.0281],
    [1.0, 47.985, 0.02814],
    [1.0, 48.1198, 0.02817],
    [1.0, 48.2536, 0.02821],
];

/// Head circumference of girls, cm.
const HEAD_OF_GIRLS: [[f64; 3]; 25] = [
    [1.0, 33.8787, 0.03496],
    [1.0, 36.5163, 0.03211],
    [1.0, 38.258, 0.03168],
    [1.0, 39.521, 0.0314],
    [1.0, 40.5895, 0.03119],
    [1.0, 41.454, 0.03102],
    [1.0, 42.2079, 0.03087],
    [1.0, 42.8278, 0.03075],
    [1.0, 43.3753, 0.03063],
    [1.0, 43.8309, 0.03053],
    [1.0, 44.2273, 0.03044],
    [1.0, 44.5865, 0.03035],
    [1.0, 44.894, 0.03027],
    [1.0, 45.1779, 0.03019],
    [1.0, 45.4255, 0.03012],
    [1.0, 45.6582, 0.03005],
    [1.0, 45.865, 0.02999],
    [1.0, 46.0571, 0.02993],
    [1.0, 46.2431, 0.02987],
    [1.0, 46.4135, 0.02982],
    [1.0, 46.5814, 0.02977],
    [1.0, 46.7375, 0.02972],
    [1.0, 46.8931, 0.02967],
    [1.0, 47.0388, 0.02962],
    [1.0, 47.1845, 0.02957],
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

    /// Medians and coefficients of head circumference as the file of the WHO has them, boys then girls.
    #[test]
    fn heads_are_those_of_the_who() {
        let months = [0.0, 1.0, 2.0, 3.0, 6.0, 9.0, 12.0, 18.0, 24.0];
        let rows = [
            [
                34.4618, 37.2435, 39.1349, 40.5008, 43.3393, 45.0007, 46.0637, 47.3718, 48.2536,
            ],
            [
                0.03686, 0.03135, 0.02997, 0.02918, 0.02817, 0.02792, 0.02789, 0.028, 0.02821,
            ],
            [
                33.8787, 36.5163, 38.258, 39.521, 42.2079, 43.8309, 44.894, 46.2431, 47.1845,
            ],
            [
                0.03496, 0.03211, 0.03168, 0.0314, 0.03087, 0.03053, 0.03027, 0.02987, 0.02957,
            ],
        ];
        for (k, age) in months.into_iter().enumerate() {
            let [boys, girls] = GrowthStandard::at(age).map(|standard| standard.head);
            assert_eq!(
                [boys.m, boys.s, girls.m, girls.s],
                rows.map(|row| row[k]),
                "{age} months"
            );
            assert_eq!((boys.l, girls.l), (1.0, 1.0));
        }
    }

    #[test]
    fn ages_beyond_the_tables_are_their_ends() {
        assert_eq!(GrowthStandard::at(24.0), GrowthStandard::at(30.0));
        assert_eq!(GrowthStandard::at(0.0), GrowthStandard::at(-1.0));
        let [boys, _] = GrowthStandard::at(0.5);
        assert!((boys.length.m - 0.5 * (49.8842 + 54.7244)).abs() < 1e-12);
    }
}

//! Growth of preterm infants by the standards of the INTERGROWTH-21st project.

use super::sources::{Mark, SourcedConstant};
use super::standards::{GrowthStandard, Lms};
use super::{GrowthError, Individual};
use crate::config::{Config, MAX_AGE, Sex};

/// The name of the standards of growth after birth.
const POSTNATAL: &str = "INTERGROWTH-21st, growth of preterm infants after birth";
/// The name of the standards of size at birth.
const AT_BIRTH: &str = "INTERGROWTH-21st, size of very preterm infants at birth";

/// Weeks after conception, counted as in pregnancy, that the standards of growth after birth cover.
const POSTNATAL_WEEKS: [f64; 2] = [27.0, 64.0];
/// Weeks of pregnancy that the standards of size at birth cover.
const BIRTH_WEEKS: [f64; 2] = [24.0, 33.0];
/// Weeks of pregnancy of a birth at term.
const TERM: f64 = 40.0;
/// Weeks in a month of the WHO, which is 30.4375 days.
const WEEKS_IN_A_MONTH: f64 = 30.4375 / 7.0;

/// Returns a logarithm that is normally distributed as L, M and S.
fn log_normal(mean: f64, deviation: f64) -> Lms {
    Lms {
        l: 0.0,
        m: pxfm::f_exp(mean),
        s: deviation,
    }
}

/// Returns a normal distribution as L, M and S.
fn normal(mean: f64, deviation: f64) -> Lms {
    Lms {
        l: 1.0,
        m: mean,
        s: deviation / mean,
    }
}

/// Returns the standards of boys and of girls; `boy` is 1 for boys and 0 for girls.
fn both(source: &'static str, lengths: impl Fn(f64) -> [Lms; 3]) -> [GrowthStandard; 2] {
    [("boys", 1.0), ("girls", 0.0)].map(|(of, boy)| {
        let [length, weight, head] = lengths(boy);
        GrowthStandard {
            of,
            source,
            length,
            weight,
            head,
        }
    })
}

impl GrowthStandard {
    /// Returns the standards of preterm boys and girls after birth, by weeks since the start of pregnancy, 27 to 64 (J. Villar et al. 2015,
    /// doi:10.1016/S2214-109X(15)00163-1).
    ///
    /// ```
    /// use babybench::mimo::GrowthStandard;
    ///
    /// let [boys, girls] = GrowthStandard::after_preterm_birth(40.0);
    /// assert!((boys.weight.m - 3.433).abs() < 5e-4 && (boys.length.m - 50.91).abs() < 5e-3);
    /// assert!(girls.head.m < boys.head.m);
    /// ```
    pub fn after_preterm_birth(weeks: f64) -> [Self; 2] {
        let p = weeks.clamp(POSTNATAL_WEEKS[0], POSTNATAL_WEEKS[1]);
        let (square, log) = (1.0 / (p * p), pxfm::f_log(p));
        both(POSTNATAL, |boy| {
            let length = 4.136_244 - 547.0018 * square + 0.002_606_6 * p + 0.031_496_1 * boy;
            let weight = 2.591_277 - 0.011_55 * p.sqrt() - 2_201.705 * square + 0.091_163_9 * boy;
            let head = 55.536_17 - 852.0059 / p + 0.795_790_3 * boy;
            [
                log_normal(length, 0.050_489 + 310.447_61 * square - 90.074_2 * square * log),
                log_normal(weight, 0.147_025_8 + 505.923_94 * square - 140.057_6 * square * log),
                normal(head, 3.058_222_9 + 3_910.05 * square - 180.562_5 / p),
            ]
        })
    }

    /// Returns the standards of boys and girls at a very preterm birth, by weeks of pregnancy, 24 to 33 (J. Villar et al. 2016,
    /// doi:10.1016/S0140-6736(16)00384-6).
    pub fn at_preterm_birth(weeks: f64) -> [Self; 2] {
        let g = weeks.clamp(BIRTH_WEEKS[0], BIRTH_WEEKS[1]);
        both(AT_BIRTH, |boy| {
            [
                normal(1.307_633 + 1.270_022 * g + 0.426_388_5 * boy, 2.60),
                log_normal(-7.003_03 + 1.325_911 * g.sqrt() + 0.057_193_7 * boy, 0.1932),
                normal(0.786_652_2 + 0.887_638 * g + 0.251_338_5 * boy, 1.56),
            ]
        })
    }

    /// Returns the standards that MIMo's body is compared with: those of his sex, or of boys and of girls; none without an age.
    ///
    /// With `gestation` they are those of preterm infants up to 64 weeks after the start of pregnancy, then the WHO's at the corrected age.
    ///
    /// # Errors
    /// An age that no standard covers.
    pub fn of_config(config: &Config) -> Result<Vec<Self>, GrowthError> {
        let Some(age) = config.age else { return Ok(Vec::new()) };
        let both = Development::of(config, "age", age)?.standards;
        let sex = Individual::of(config).map_or(Sex::None, |individual| individual.sex);
        Ok(both.into_iter().filter(|standard| standard.is_of(sex)).collect())
    }

    /// Returns whether it is the standard of a sex; it is for an unknown one.
    pub(super) fn is_of(&self, sex: Sex) -> bool {
        match sex {
            Sex::None => true,
            Sex::Boy => self.of == "boys",
            Sex::Girl => self.of == "girls",
        }
    }
}

/// How far an infant has developed at an age, and what he is compared with.
pub(super) struct Development {
    /// The age by which bodies and strength are made, months: corrected for the weeks that pregnancy was short of, and at least 0.
    pub months: f64,
    /// The standards of boys and of girls.
    pub standards: [GrowthStandard; 2],
}

impl Development {
    /// Returns the development at an age in months, which is the value of a key.
    ///
    /// # Errors
    /// An age that no standard covers.
    pub fn of(config: &Config, key: &'static str, age: f64) -> Result<Self, GrowthError> {
        let Some(gestation) = config.individual.gestation else {
            return Ok(Self {
                months: age,
                standards: GrowthStandard::at(age),
            });
        };
        let weeks = gestation + age * WEEKS_IN_A_MONTH;
        let corrected = (weeks - TERM) / WEEKS_IN_A_MONTH;
        let [first, last] = POSTNATAL_WEEKS;
        let standards = if age == 0.0 && gestation < BIRTH_WEEKS[1] {
            GrowthStandard::at_preterm_birth(gestation)
        } else if weeks < first {
            let least = (first - gestation) / WEEKS_IN_A_MONTH;
            return Err(GrowthError::Preterm {
                key,
                age,
                gestation,
                reason: format!(
                    "no standard covers the time between birth and {first} weeks; it must be 0, or at least {least:.2}"
                ),
            });
        } else if weeks <= last {
            GrowthStandard::after_preterm_birth(weeks)
        } else if corrected <= MAX_AGE {
            GrowthStandard::at(corrected)
        } else {
            let most = (MAX_AGE * WEEKS_IN_A_MONTH + TERM - gestation) / WEEKS_IN_A_MONTH;
            return Err(GrowthError::Preterm {
                key,
                age,
                gestation,
                reason: format!(
                    "the age from a birth at term is {corrected:.2} months, and the tables end at {MAX_AGE}; it must be at most {most:.2}"
                ),
            });
        };
        Ok(Self {
            // the formulas of proportions and strength begin with a birth at term
            months: corrected.clamp(0.0, MAX_AGE),
            standards,
        })
    }
}

/// Lists the constants of preterm infants.
pub(super) fn constants() -> Vec<SourcedConstant> {
    let constant = |name: &str, values: &[f64], unit, mark, source| SourcedConstant {
        name: name.to_string(),
        values: values.to_vec(),
        ages: Vec::new(),
        unit,
        source,
        mark,
    };
    let villar = "J. Villar et al. 2015, doi:10.1016/S2214-109X(15)00163-1, as in the package gigs";
    let median = |what: &str, unit, pick: fn(&GrowthStandard) -> Lms| {
        let all = [32.0, 40.0, 64.0].map(|weeks| GrowthStandard::after_preterm_birth(weeks).map(|of| pick(&of).m));
        let name = format!("preterm median {what} (boys, girls at 32, 40, 64 weeks)");
        constant(&name, &all.concat(), unit, Mark::Read, villar)
    };
    vec![
        median("length", "cm", |of| of.length),
        median("weight", "kg", |of| of.weight),
        median("head circumference", "cm", |of| of.head),
        constant(
            "size at a preterm birth, first and last week",
            &BIRTH_WEEKS,
            "weeks",
            Mark::Read,
            "J. Villar et al. 2016, doi:10.1016/S0140-6736(16)00384-6",
        ),
        constant(
            "growth of preterm infants, first and last week",
            &POSTNATAL_WEEKS,
            "weeks",
            Mark::Unsourced,
            "the range in which the equations are used; the same source",
        ),
        constant(
            "weeks of pregnancy of a birth at term",
            &[TERM],
            "weeks",
            Mark::Unsourced,
            "the usual convention for corrected ages",
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the equations, worked out by hand: kg, cm, cm.
    #[test]
    fn medians_are_those_of_the_equations() {
        let close = |of: &GrowthStandard, [weight, length, head]: [f64; 3]| {
            for (is, should, digit) in [
                (of.weight.m, weight, 5e-4),
                (of.length.m, length, 5e-3),
                (of.head.m, head, 5e-3),
            ] {
                assert!((is - should).abs() < digit, "{}: {is}, not {should}", of.of);
            }
        };
        close(&GrowthStandard::after_preterm_birth(40.0)[0], [3.433, 50.91, 35.03]);
        close(&GrowthStandard::after_preterm_birth(32.0)[1], [1.456, 39.86, 28.91]);
        close(&GrowthStandard::after_preterm_birth(64.0)[0], [7.787, 66.75, 43.02]);
        close(&GrowthStandard::at_preterm_birth(28.0)[0], [1.073, 37.29, 25.89]);
    }

    #[test]
    fn ages_that_no_standard_covers_are_errors_that_name_the_nearest_that_is() {
        let mut config = Config::default();
        let mut of = |gestation, age| {
            config.individual.gestation = Some(gestation);
            Development::of(&config, "age", age)
        };
        let message =
            |result: Result<Development, GrowthError>| result.err().map(|error| error.to_string()).unwrap_or_default();
        let early = message(of(24.0, 0.3));
        assert!(
            early.contains("`age` is 0.3") && early.contains("at least 0.69"),
            "{early}"
        );
        let late = message(of(42.0, 24.0));
        assert!(late.contains("at most 23.54"), "{late}");
        // at birth, after 27 weeks, and at term
        for (gestation, age, months) in [
            (24.0, 0.0, 0.0),
            (30.0, 1.0, 0.0),
            (30.0, 12.0, 9.700_2),
            (40.0, 3.0, 3.0),
        ] {
            let found = of(gestation, age).map(|development| development.months);
            assert!(
                found.is_ok_and(|found| (found - months).abs() < 1e-4),
                "{gestation}, {age}"
            );
        }
        // standards change at 64 weeks, and the medians by little
        let around = [5.5, 5.6].map(|age| of(40.0, age).map(|development| development.standards[0]));
        let [Ok(before), Ok(after)] = around else {
            panic!("both are covered")
        };
        assert_ne!(before.source, after.source);
        assert!(
            (before.length.m / after.length.m - 1.0).abs() < 0.02
                && (before.weight.m / after.weight.m - 1.0).abs() < 0.03
        );
    }
}

//! The schedule of ages of a MIMo that grows while it learns.

use std::fmt;

/// Ages over steps of the environment (`age_schedule`): points of steps and months, with straight lines between them. It is empty for a
/// MIMo who does not grow.
///
/// ```
/// use babybench::config::AgeSchedule;
/// use babybench::Config;
///
/// let text = "age: {0: 1, 500000: 6}\ntouch_grows: true";
/// let config = Config::from_yaml(text, "example.yml")?;
/// let schedule: &AgeSchedule = &config.age_schedule;
/// assert_eq!(schedule.at(0, 0.25), Some(1.0));
/// assert_eq!(schedule.at(260_000, 0.25), Some(3.5)); // 3.6, in steps of a quarter of a month
/// assert_eq!(schedule.at(2_000_000, 0.25), Some(6.0));
/// # Ok::<(), babybench::config::ConfigError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AgeSchedule {
    points: Vec<(u64, f64)>,
}

impl AgeSchedule {
    /// The greatest number of points.
    pub const MAX_POINTS: usize = 1000;

    /// Creates a schedule from points of steps and months, in order; `None` if the first is not at step 0, the steps do not increase, an age
    /// is not finite or negative, or there are more than [`AgeSchedule::MAX_POINTS`].
    pub fn new(points: impl IntoIterator<Item = (u64, f64)>) -> Option<Self> {
        // one more than allowed is enough to refuse a list of any length
        let points: Vec<_> = points.into_iter().take(Self::MAX_POINTS + 1).collect();
        let ordered = points.windows(2).all(|pair| pair[0].0 < pair[1].0);
        let starts = points.first().is_none_or(|first| first.0 == 0);
        let ages = points.iter().all(|point| point.1.is_finite() && point.1 >= 0.0);
        (ordered && starts && ages && points.len() <= Self::MAX_POINTS).then_some(Self { points })
    }

    /// Returns the points: steps and months.
    pub fn points(&self) -> &[(u64, f64)] {
        &self.points
    }

    /// Returns whether MIMo does not grow.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Returns the age after a number of steps, months, in whole multiples of `grid` between two points. `None` for an empty schedule.
    pub fn at(&self, steps: u64, grid: f64) -> Option<f64> {
        let next = self.points.partition_point(|point| point.0 <= steps);
        let &(from, first) = self.points.get(next.checked_sub(1)?)?;
        let Some(&(to, last)) = self.points.get(next) else {
            return Some(first);
        };
        let share = (steps - from) as f64 / (to - from) as f64;
        let age = first + (last - first) * share;
        // the points themselves keep the ages that were written
        let age = if steps > from && grid > 0.0 {
            (age / grid).round() * grid
        } else {
            age
        };
        // rounding may go beyond a point that is not on the grid
        Some(age.clamp(first.min(last), first.max(last)))
    }

    /// Reads points such as `0: 1, 500000: 6`.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let points = text.split(',').map(|point| {
            let (steps, age) = point.split_once(':')?;
            Some((steps.trim().replace('_', "").parse().ok()?, age.trim().parse().ok()?))
        });
        Self::new(points.collect::<Option<Vec<_>>>()?).filter(|schedule| !schedule.is_empty())
    }
}

/// Writes the points as a configuration file has them.
impl fmt::Display for AgeSchedule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, (steps, age)) in self.points.iter().enumerate() {
            let comma = if at > 0 { ", " } else { "" };
            write!(f, "{comma}{steps}: {age}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ages_lie_between_points_on_the_grid() {
        let up = AgeSchedule::new([(0, 1.1), (100, 2.0), (200, 0.3)]).expect("points");
        for (steps, age) in [
            (0, 1.1),
            (1, 1.1),
            (50, 1.5),
            (100, 2.0),
            (101, 2.0),
            (150, 1.25),
            (200, 0.3),
            (9999, 0.3),
        ] {
            assert_eq!(up.at(steps, 0.25), Some(age), "{steps}");
        }
        assert_eq!(up.at(50, 0.0), Some(1.55));
        assert_eq!(AgeSchedule::default().at(5, 0.25), None);
    }

    #[test]
    fn points_are_checked_and_come_back_as_text() {
        for bad in [
            "",
            "1: 2",
            "0: 1, 0: 2",
            "0: 1, 5: 2, 4: 3",
            "0: -1",
            "0: nan",
            "0",
            "0: 1,",
            "a: 1",
            "0: inf",
            "-0: 1",
        ] {
            assert_eq!(AgeSchedule::parse(bad), None, "{bad:?}");
        }
        let many: Vec<_> = (0..=1000).map(|step| (step, 1.0)).collect();
        assert!(AgeSchedule::new(many[..1000].iter().copied()).is_some());
        assert!(AgeSchedule::new(many).is_none());
        let read = AgeSchedule::parse(" 0 :1,500_000: 6.25").expect("points");
        assert_eq!(read.to_string(), "0: 1, 500000: 6.25");
        assert_eq!(AgeSchedule::parse(&read.to_string()), Some(read));
    }
}

//! Measures of phases from the samples of their parts.

use std::collections::{BTreeMap, BTreeSet};

use super::sample::Sample;
use super::{MeasureRule, Protocol, ProtocolMeasure};

/// The measures of a condition, by phase and name.
pub(super) type PhaseValues = BTreeMap<String, BTreeMap<String, f64>>;

/// Computes the measures of a protocol for each phase. Undefined ones are left out, and so are those across ages.
pub(super) fn evaluate(protocol: &Protocol, samples: &[Sample]) -> PhaseValues {
    let of = Samples { protocol, samples };
    let mut out = PhaseValues::new();
    for (k, phase) in protocol.phases.iter().enumerate() {
        let found = protocol.measures.iter().filter_map(|measure| {
            let value = of.measure(measure, k).filter(|value| value.is_finite())?;
            Some((measure.name.clone(), value))
        });
        out.insert(phase.name.clone(), found.collect());
    }
    out
}

/// The samples of a condition.
struct Samples<'s> {
    protocol: &'s Protocol,
    samples: &'s [Sample],
}

impl Samples<'_> {
    fn measure(&self, measure: &ProtocolMeasure, phase: usize) -> Option<f64> {
        match &measure.rule {
            MeasureRule::Direct => self.direct(&measure.name, phase),
            MeasureRule::Mean(names) => mean(names.iter().filter_map(|name| self.direct(name, phase))),
            MeasureRule::Orders(names) => self.orders(names, phase),
            MeasureRule::Ratio { of, over } => {
                let base = self.place(over).filter(|base| *base != phase)?;
                let before = self.value(of, base).filter(|before| *before > 0.0)?;
                Some(self.value(of, phase)? / before)
            }
            MeasureRule::Reached { of, over, times } => {
                let base = self.place(over).filter(|base| *base != phase)?;
                let before = self.value(of, base).filter(|before| *before > 0.0)?;
                self.reached(of, phase, times * before)
            }
            MeasureRule::Age { .. } => None,
        }
    }

    fn place(&self, phase: &str) -> Option<usize> {
        self.protocol.phases.iter().position(|known| known.name == phase)
    }

    /// Returns a measure that follows from no other phase, by its own name or that of a sample's value.
    fn value(&self, name: &str, phase: usize) -> Option<f64> {
        match self.protocol.measure(name) {
            Some(measure) if matches!(measure.rule, MeasureRule::Mean(_)) => self.measure(measure, phase),
            _ => self.direct(name, phase),
        }
    }

    fn of_phase(&self, phase: usize) -> impl Iterator<Item = &Sample> {
        self.samples.iter().filter(move |sample| sample.phase == phase)
    }

    /// Returns the mean over parts and trials that have the value, weighted by time.
    fn direct(&self, name: &str, phase: usize) -> Option<f64> {
        if name == "areas" {
            return self.areas(phase);
        }
        let (mut sum, mut time) = (0.0, 0.0);
        for sample in self.of_phase(phase) {
            if let Some(value) = sample.values.get(name) {
                sum += sample.seconds * value;
                time += sample.seconds;
            }
        }
        (time > 0.0).then(|| sum / time)
    }

    /// Returns the samples of a phase, trial by trial.
    fn trials(&self, phase: usize) -> BTreeMap<u32, Vec<&Sample>> {
        let mut out = BTreeMap::<u32, Vec<&Sample>>::new();
        for sample in self.of_phase(phase) {
            out.entry(sample.trial).or_default().push(sample);
        }
        out
    }

    /// Returns the number of different areas that were touched in a trial, mean over trials; `None` if touches were not measured.
    fn areas(&self, phase: usize) -> Option<f64> {
        self.direct("contacts", phase)?;
        mean(self.trials(phase).into_values().map(|parts| {
            let all: BTreeSet<&String> = parts.iter().flat_map(|sample| &sample.areas).collect();
            all.len() as f64
        }))
    }

    /// Returns the number of different orders of some times.
    fn orders(&self, names: &[String], phase: usize) -> Option<f64> {
        let order = |parts: &Vec<&Sample>| -> Option<Vec<usize>> {
            let time = |name: &String| parts.iter().find_map(|sample| sample.values.get(name).copied());
            let times: Vec<f64> = names.iter().map(time).collect::<Option<_>>()?;
            let mut order: Vec<usize> = (0..times.len()).collect();
            // a stable sort: segments that turn at the same time keep their order
            order.sort_by(|a, b| times[*a].total_cmp(&times[*b]));
            Some(order)
        };
        let orders: BTreeSet<Vec<usize>> = self.trials(phase).values().filter_map(order).collect();
        (!orders.is_empty()).then_some(orders.len() as f64)
    }

    /// Returns the time, min, at the end of the first part whose value is at least `level`, mean over the trials with such a part.
    fn reached(&self, name: &str, phase: usize, level: f64) -> Option<f64> {
        let names = match self.protocol.measure(name).map(|measure| &measure.rule) {
            Some(MeasureRule::Mean(names)) => names.clone(),
            _ => vec![name.to_string()],
        };
        let of_trial = |parts: Vec<&Sample>| {
            let mut seconds = 0.0;
            for sample in parts {
                seconds += sample.seconds;
                let value = mean(names.iter().filter_map(|name| sample.values.get(name).copied()));
                if value.is_some_and(|value| value >= level) {
                    return Some(seconds / 60.0);
                }
            }
            None
        };
        mean(self.trials(phase).into_values().filter_map(of_trial))
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (n, sum) = values.fold((0_usize, 0.0), |(n, sum), value| (n + 1, sum + value));
    (n > 0).then(|| sum / n as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(trial: u32, phase: usize, values: &[(&str, f64)]) -> Sample {
        let mut sample = Sample {
            trial,
            phase,
            seconds: 60.0,
            ..Sample::default()
        };
        values.iter().for_each(|(name, value)| sample.put(name, *value));
        sample
    }

    #[test]
    fn learning_is_found_in_the_first_fast_part() {
        let protocol = Protocol::named("mobile").expect("a protocol");
        let rate = |phase, value| sample(0, phase, &[("right_foot_movements", value)]);
        let samples = [
            rate(0, 8.0),
            rate(0, 12.0),
            rate(1, 12.0),
            rate(1, 18.0),
            rate(1, 15.0),
            rate(2, 5.0),
        ];
        let found = evaluate(&protocol, &samples);
        assert_eq!(found["learn"]["ratio"], 1.5);
        assert_eq!(found["learn"]["learned_after"], 2.0);
        assert_eq!(found["extinction"]["ratio"], 0.5);
        assert!(!found["extinction"].contains_key("learned_after"), "he forgets");
        assert!(!found["baseline"].contains_key("ratio"));
    }

    #[test]
    fn orders_are_counted_over_trials() {
        let protocol = Protocol::named("roll_over").expect("a protocol");
        let roll = |trial, [head, shoulders, pelvis]: [f64; 3]| {
            let times = [
                ("head_turns", head),
                ("shoulders_turns", shoulders),
                ("pelvis_turns", pelvis),
            ];
            sample(trial, 0, &times)
        };
        let samples = [
            roll(0, [1.0, 2.0, 3.0]),
            roll(1, [0.1, 0.2, 0.3]),
            roll(2, [3.0, 2.0, 1.0]),
            sample(3, 0, &[("head_turns", 1.0)]),
        ];
        assert_eq!(evaluate(&protocol, &samples)["supine"]["patterns"], 2.0);
        assert!(!evaluate(&protocol, &samples[3..])["supine"].contains_key("patterns"));
    }
}

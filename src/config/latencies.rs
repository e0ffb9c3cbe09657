//! Delays of senses by age, from latencies measured in infants.

/// A latency at some ages: months and ms. It is linear between them, and constant before the first and after the last.
pub(crate) type Latency = [[f64; 2]];

/// Vision: the peak P1 of potentials evoked by large reversing checks (McCulloch, Orbach and Skarf 1999, Vision Research 39, 3673, for
/// newborns; Lee et al. 2012, Investigative Ophthalmology and Visual Science 53, 1306, for 15 weeks, as adults).
pub(crate) const SIGHT: &Latency = &[[0.0, 260.0], [3.45, 104.0]];

/// Touch and proprioception: the first cortical response to stimulation of the median nerve at the wrist (Nevalainen, Lauronen and Pihko 2010, IFMBE
/// Proceedings 28, for newborns; Smit et al. 2000, Clinical Neurophysiology 111, 901, for six months).
pub(crate) const SKIN: &Latency = &[[0.0, 30.0], [6.0, 20.0]];

/// Balance: the wave p13 of the neck's muscles (Young et al. 2009, European Journal of Paediatric Neurology 13, 235, for newborns), which barely
/// changes.
pub(crate) const BALANCE: &Latency = &[[0.0, 13.3]];

/// Returns a latency at an age in months, ms.
pub(super) fn latency(of: &Latency, age: f64) -> f64 {
    // the first measurement after the age; before all of them and after the last one the nearest holds
    let after = of.iter().position(|[at, _]| *at > age).unwrap_or(of.len());
    match (of[..after].last(), of.get(after)) {
        (Some(&[from, early]), Some(&[to, late])) => early + (late - early) * (age - from) / (to - from),
        (Some(&[_, ms]), None) | (None, Some(&[_, ms])) => ms,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latencies_fall_until_they_are_those_of_adults() {
        for (of, age, ms) in [
            (SIGHT, 0.0, 260.0),
            (SIGHT, 1.725, 182.0),
            (SIGHT, 3.45, 104.0),
            (SIGHT, 24.0, 104.0),
            (SKIN, 3.0, 25.0),
            (SKIN, 18.0, 20.0),
            (BALANCE, 0.0, 13.3),
            (BALANCE, 9.0, 13.3),
        ] {
            assert!(
                (latency(of, age) - ms).abs() < 1e-9,
                "{age} months: {}",
                latency(of, age)
            );
        }
    }
}

//! The printed lines, and how each is computed.

use crate::cases::{Case, EXAMPLES, VARIANTS};
use crate::sums::{self, Sum};

/// The computations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Episodes of the examples.
    Episode,
    /// Tasks and everything that the examples leave out.
    Variant,
    /// Vectors of environments.
    Vector,
    /// Snapshots, their bytes and what follows them.
    Snapshot,
    /// Pictures of rooms and eyes.
    Picture,
}

/// Kinds by name; the first is the default.
pub const KINDS: [(&str, Kind); 5] = [
    ("episode", Kind::Episode),
    ("variant", Kind::Variant),
    ("vector", Kind::Vector),
    ("snapshot", Kind::Snapshot),
    ("picture", Kind::Picture),
];

/// Lengths of episodes.
const STEPS: [usize; 4] = [0, 10, 100, 1000];
/// Steps of variants and of vectors.
const FEW: usize = 20;

/// One line.
#[derive(Clone, Copy)]
pub struct Job {
    /// The configuration.
    pub case: Case,
    kind: Kind,
    steps: usize,
}

impl Job {
    /// Lists the lines of a kind, with steps up to `longest`. Those of the other engine need the feature `rapier`.
    pub fn all(kind: Kind, longest: usize) -> Vec<Self> {
        let few = FEW.min(longest);
        let of = |cases: &[Case], lengths: &[usize]| {
            let each = |&case| lengths.iter().map(move |&steps| Self { case, kind, steps });
            let built = |case: &&Case| cfg!(feature = "rapier") || case.0 != "rapier";
            cases.iter().filter(built).flat_map(each).collect()
        };
        match kind {
            Kind::Episode => {
                let lengths = STEPS.into_iter().filter(|&steps| steps <= longest);
                of(&EXAMPLES, &lengths.collect::<Vec<_>>())
            }
            Kind::Variant => of(&VARIANTS, &[few]),
            Kind::Vector => of(&EXAMPLES, &[few]),
            Kind::Snapshot | Kind::Picture => of(&[&EXAMPLES[..], &VARIANTS].concat(), &[0]),
        }
    }

    /// Computes the line. Vectors and eyes use `threads`; a snapshot is the given one, or a new one.
    pub fn line(&self, threads: usize, taken: Option<Vec<u8>>) -> Result<String, String> {
        let (name, steps) = (self.case.0, self.steps);
        let (what, sum) = match self.kind {
            Kind::Episode => (steps.to_string(), sums::episode(self.case, steps, threads)),
            Kind::Variant => (steps.to_string(), sums::variant(self.case, steps, threads)),
            Kind::Vector => (steps.to_string(), sums::vector(self.case, steps, threads)),
            Kind::Snapshot => ("snapshot".to_owned(), self.snapshot(taken)),
            Kind::Picture => ("picture".to_owned(), sums::pictures(self.case)),
        };
        let sum = sum.map_err(|e| format!("{name} {what}: {e}"))?;
        Ok(format!("{name} {what} {sum:016x}"))
    }

    fn snapshot(&self, taken: Option<Vec<u8>>) -> Sum {
        sums::restored(self.case, taken.map_or_else(|| sums::snapshot(self.case), Ok)?)
    }
}

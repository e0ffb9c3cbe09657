//! Information of all environments as arrays.

use super::layout::RowLayout;
use crate::config::Reflex;
use crate::env::{BehaviorInfo, Info, Outcome};

/// Information of all environments, as arrays of rows. Lists in the order of first touch, and names, are in
/// [`VectorEnv::env`](super::VectorEnv::env)`(i)?.info()`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Infos<'a> {
    /// Number of steps of each episode (N): see [`Info::steps`].
    pub steps: &'a [u64],
    /// The geoms that the right and the left palm have touched, (N, 2, geoms), 1 or 0, for the behavior `self_touch`.
    pub touches: Option<&'a [u8]>,
    /// Steps with a hand in view, (N, 4), in the order of [`EYE_HAND_PAIRS`](crate::env::EYE_HAND_PAIRS), for the behavior `hand_regard`.
    pub regards: Option<&'a [u64]>,
    /// The same, counted as the API page describes it: [`RegardCounts::page`](crate::env::RegardCounts::page).
    pub page_regards: Option<&'a [u64]>,
    /// The same, counted as the starter kit computes it: [`RegardCounts::kit`](crate::env::RegardCounts::kit).
    pub kit_regards: Option<&'a [u64]>,
    /// Age of the pictures of the eyes (N), s, with a [`vision_rate`](crate::Config::vision_rate).
    pub vision_age: Option<&'a [f64]>,
    /// Age of each MIMo's body (N), months, with an [`age_schedule`](crate::Config::age_schedule).
    pub age: Option<&'a [f64]>,
    /// The reflexes that any environment has.
    pub reflex_names: &'a [Reflex],
    /// The share of steps in which each of them acted, (N, names), 0 to 1: see [`ReflexShares`](crate::env::ReflexShares). `None` without reflexes.
    pub reflexes: Option<&'a [f64]>,
    /// Success and failure (N) of tasks that report them.
    pub outcomes: Option<&'a [Outcome]>,
    /// Further inputs of the rewards of such tasks besides goals, (N, len): [`Goal::terms`](crate::env::Goal::terms).
    pub reward_terms: Option<&'a [f64]>,
}

/// Information as arrays.
#[derive(Debug)]
pub(super) struct InfoRows {
    layout: RowLayout,
    steps: Vec<u64>,
    touches: Vec<u8>,
    /// The counters by `compat`, the page's, and the kit's.
    regards: [Vec<u64>; 3],
    ages: Vec<f64>,
    body_ages: Vec<f64>,
    reflex_names: Vec<Reflex>,
    reflexes: Vec<f64>,
    outcomes: Vec<Outcome>,
    terms: Vec<f64>,
}

impl InfoRows {
    pub fn new(n: usize, layout: RowLayout) -> Self {
        let present = Reflex::ALL.iter().filter(|&&reflex| layout.reflexes[reflex as usize]);
        let reflex_names: Vec<_> = present.copied().collect();
        Self {
            reflexes: vec![0.0; n * reflex_names.len()],
            reflex_names,
            layout,
            steps: vec![0; n],
            touches: vec![0; 2 * n * layout.geoms.unwrap_or_default()],
            regards: std::array::from_fn(|_| vec![0; 4 * n * usize::from(layout.regards)]),
            ages: vec![0.0; n * usize::from(layout.ages)],
            body_ages: vec![0.0; n * usize::from(layout.grows)],
            outcomes: vec![Outcome::default(); n * usize::from(layout.terms.is_some())],
            terms: vec![0.0; n * layout.terms.unwrap_or_default()],
        }
    }

    pub fn write(&mut self, row: usize, info: &Info, terms: &[f64]) {
        self.steps[row] = info.steps;
        if let Some(len) = self.layout.terms {
            self.outcomes[row] = info.behavior.task().map(|info| info.outcome).unwrap_or_default();
            self.terms[row * len..(row + 1) * len].copy_from_slice(terms);
        }
        if let Some(geoms) = self.layout.geoms {
            let out = &mut self.touches[2 * geoms * row..2 * geoms * (row + 1)];
            out.fill(0);
            if let BehaviorInfo::SelfTouch { touches } = &info.behavior {
                for (out, touched) in out.chunks_exact_mut(geoms).zip(touches.each_ref()) {
                    touched.iter().for_each(|&geom| out[geom] = 1);
                }
            }
        }
        if self.layout.ages {
            // a reset samples
            self.ages[row] = info.details.vision_age.unwrap_or_default();
        }
        if self.layout.grows {
            self.body_ages[row] = info.details.age.unwrap_or_default();
        }
        let reflexes = self.reflexes.chunks_exact_mut(self.reflex_names.len().max(1)).nth(row);
        for (share, &reflex) in reflexes.into_iter().flatten().zip(&self.reflex_names) {
            *share = info
                .details
                .reflexes
                .and_then(|shares| shares.get(reflex))
                .unwrap_or_default();
        }
        if self.layout.regards {
            let both = info.details.regards.unwrap_or_default();
            let counts = info.behavior.regards().unwrap_or_default();
            for (out, counts) in self
                .regards
                .iter_mut()
                .zip([counts, both.page.to_array(), both.kit.to_array()])
            {
                out[4 * row..4 * (row + 1)].copy_from_slice(&counts);
            }
        }
    }

    /// Returns the first `n` rows.
    pub fn infos(&self, n: usize) -> Infos<'_> {
        Infos {
            steps: &self.steps[..n],
            touches: self.layout.geoms.map(|geoms| &self.touches[..2 * geoms * n]),
            regards: self.layout.regards.then(|| &self.regards[0][..4 * n]),
            page_regards: self.layout.regards.then(|| &self.regards[1][..4 * n]),
            kit_regards: self.layout.regards.then(|| &self.regards[2][..4 * n]),
            vision_age: self.layout.ages.then(|| &self.ages[..n]),
            age: self.layout.grows.then(|| &self.body_ages[..n]),
            reflex_names: &self.reflex_names,
            reflexes: (!self.reflexes.is_empty()).then(|| &self.reflexes[..n * self.reflex_names.len()]),
            outcomes: self.layout.terms.map(|_| &self.outcomes[..n]),
            reward_terms: self.layout.terms.map(|len| &self.terms[..n * len]),
        }
    }
}

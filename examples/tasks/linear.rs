//! Policies whose action is a linear function of some numbers of the observation.

use babybench::Observation;
use babybench::spaces::BoxSpace;

use crate::model::{self, Sense};

/// An input of a policy: a weighted sum of numbers of the observation.
#[derive(Clone, Debug, Default)]
pub struct Feature {
    /// Its value when all others are 0.
    pub offset: f64,
    /// Keys of senses, places in them, factors.
    pub parts: Vec<(&'static str, usize, f64)>,
}

impl Feature {
    /// Returns the feature that is always 1.
    pub fn one() -> Self {
        let offset = 1.0;
        Self {
            offset,
            parts: Vec::new(),
        }
    }

    /// Returns a number of the observation times a factor.
    pub fn of(key: &'static str, index: usize, factor: f64) -> Self {
        let parts = vec![(key, index, factor)];
        Self { offset: 0.0, parts }
    }
}

/// The features on which each number of the action depends.
#[derive(Clone, Debug, Default)]
pub struct Design {
    pub features: Vec<Feature>,
    /// Numbers of the action, features, scales of their weights.
    pub terms: Vec<(usize, usize, f64)>,
}

impl Design {
    /// Adds a feature and returns its number.
    pub fn feature(&mut self, feature: Feature) -> usize {
        self.features.push(feature);
        self.features.len() - 1
    }

    /// Makes a number of the action depend on a feature.
    pub fn term(&mut self, action: usize, feature: usize, scale: f64) {
        self.terms.push((action, feature, scale));
    }

    /// Computes the action of a policy with these weights.
    pub fn act(&self, weights: &[f64], seen: &Observation<'_>, space: &BoxSpace, action: &mut Vec<f32>) {
        let number = |key: &str, index: usize| {
            let sense = match key {
                "observation" => Some(seen.proprioception),
                "vestibular" => seen.vestibular,
                "achieved_goal" => seen.achieved_goal,
                "desired_goal" => seen.desired_goal,
                _ => None,
            };
            sense.and_then(|s| s.get(index)).copied().unwrap_or_default()
        };
        let value = |f: &Feature| f.offset + f.parts.iter().map(|&(key, i, by)| by * number(key, i)).sum::<f64>();
        let values: Vec<f64> = self.features.iter().map(value).collect();
        let mut sums = vec![0.0; space.len()];
        for (&(to, feature, scale), weight) in self.terms.iter().zip(weights) {
            sums[to] += scale * weight * values[feature];
        }
        action.clear();
        action.extend(sums.iter().enumerate().map(|(d, &v)| space.clip(d, v as f32)));
    }

    /// Writes the policy with these weights as an ONNX model for observations like this one.
    pub fn to_onnx(&self, weights: &[f64], seen: &Observation<'_>, actions: usize) -> Vec<u8> {
        let mut senses: Vec<(&'static str, Vec<f64>)> = Vec::new();
        let mut offset = vec![0.0; actions];
        for (&(to, feature, scale), weight) in self.terms.iter().zip(weights) {
            let Feature {
                offset: constant,
                parts,
            } = &self.features[feature];
            offset[to] += scale * weight * constant;
            for &(key, index, by) in parts {
                let k = senses.iter().position(|(other, _)| *other == key).unwrap_or_else(|| {
                    let numbers = seen.get(key).map_or(0, |values| values.len());
                    senses.push((key, vec![0.0; numbers * actions]));
                    senses.len() - 1
                });
                senses[k].1[index * actions + to] += scale * weight * by;
            }
        }
        let narrow = |values: Vec<f64>| values.into_iter().map(|v| v as f32).collect::<Vec<f32>>();
        let senses: Vec<Sense> = senses
            .into_iter()
            .map(|(key, weights)| Sense {
                key,
                weights: narrow(weights),
            })
            .collect();
        model::bytes(&senses, &narrow(offset))
    }
}

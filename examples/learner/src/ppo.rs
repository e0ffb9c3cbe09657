//! Proximal policy optimization (Schulman et al. 2017), with generalized advantages (Schulman et al. 2016).

use candle_core::{D, Device, Tensor, Var};
use candle_nn::{AdamW, Optimizer, ParamsAdamW};

use crate::Error;
use crate::network::{Mlp, Noise};

/// Discount of a decision's reward at the one before.
const DISCOUNT: f32 = 0.98;
/// Decay of the generalized advantage.
const TRACE: f32 = 0.95;
/// Limit on the change of an action's probability in an update.
const CLIP: f64 = 0.2;
/// Number of passes of an update through its experience.
const EPOCHS: usize = 6;
/// Decisions from which one gradient is computed.
const MINIBATCH: usize = 400;
/// Step size of Adam.
const RATE: f64 = 5e-4;
/// Logarithm of the standard deviation of the first policy.
const FIRST_DEVIATION: f32 = -0.5;

/// The history of episodes of equal length: arrays over decisions and environments, (decisions, environments, ..).
#[derive(Clone, Debug, Default)]
pub struct Experience {
    /// Inputs of the policy.
    pub senses: Vec<f32>,
    /// Actions that it chose.
    pub actions: Vec<f32>,
    /// Logarithm of their probability density.
    pub likelihoods: Vec<f32>,
    /// Value that it expected for the rest of the episode.
    pub values: Vec<f32>,
    /// Rewards of the actions.
    pub rewards: Vec<f32>,
    /// Touch after the action.
    pub feelings: Vec<f32>,
}

impl Experience {
    /// Clears everything.
    pub fn clear(&mut self) {
        let Self {
            senses,
            actions,
            likelihoods,
            values,
            rewards,
            feelings,
        } = self;
        [senses, actions, likelihoods, values, rewards, feelings]
            .into_iter()
            .for_each(Vec::clear);
    }

    /// Computes the advantage of each decision, and the target of its value.
    fn advantages(&self, envs: usize) -> [Vec<f32>; 2] {
        let n = self.rewards.len();
        let mut advantages = vec![0.0; n];
        for k in (0..n).rev() {
            // an episode is over after the last decision
            let (value, advantage) = if k + envs < n {
                (self.values[k + envs], advantages[k + envs])
            } else {
                (0.0, 0.0)
            };
            let error = self.rewards[k] + DISCOUNT * value - self.values[k];
            advantages[k] = error + DISCOUNT * TRACE * advantage;
        }
        let returns = advantages.iter().zip(&self.values).map(|(a, v)| a + v).collect();
        [advantages, returns]
    }
}

/// A policy of normally distributed actions around those that a network proposes, and a network that expects rewards.
pub struct Ppo {
    actor: Mlp,
    critic: Mlp,
    /// Logarithm of the standard deviation of each number of an action.
    deviation: Var,
    optimizer: AdamW,
    actions: usize,
}

impl Ppo {
    /// Makes an untrained policy.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn new(senses: usize, actions: usize, noise: &mut Noise) -> Result<Self, Error> {
        let actor = Mlp::new(&[senses, 128, 64, actions], 0.05, noise)?;
        let critic = Mlp::new(&[senses, 128, 64, 1], 0.5, noise)?;
        let deviation = Var::from_vec(vec![FIRST_DEVIATION; actions], actions, &Device::Cpu)?;
        let mut vars = [actor.vars(), critic.vars()].concat();
        vars.push(deviation.clone());
        let params = ParamsAdamW {
            lr: RATE,
            eps: 1e-5,
            weight_decay: 0.0,
            ..ParamsAdamW::default()
        };
        Ok(Self {
            optimizer: AdamW::new(vars, params)?,
            actor,
            critic,
            deviation,
            actions,
        })
    }

    /// Returns the means of the actions for rows of senses.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn means(&self, senses: &Tensor) -> Result<Vec<f32>, Error> {
        Ok(self.actor.forward(senses)?.flatten_all()?.to_vec1()?)
    }

    /// Decides for rows of senses, and appends actions, likelihoods and values.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn decide(&self, senses: &Tensor, noise: &mut Noise, out: &mut Experience) -> Result<(), Error> {
        let means = self.means(senses)?;
        let log_deviation = self.deviation.to_vec1::<f32>()?;
        for mean in means.chunks_exact(self.actions) {
            let mut likelihood = 0.0;
            for (mean, log_deviation) in mean.iter().zip(&log_deviation) {
                let draw = noise.normal();
                out.actions.push(mean + log_deviation.exp() * draw);
                likelihood -= 0.5 * draw * draw + log_deviation;
            }
            out.likelihoods.push(likelihood);
        }
        out.values
            .extend(self.critic.forward(senses)?.flatten_all()?.to_vec1::<f32>()?);
        Ok(())
    }

    /// Learns from experience. Calls `also` with the rows of every minibatch, so that others can learn from the same.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn learn(
        &mut self,
        experience: &Experience,
        envs: usize,
        noise: &mut Noise,
        mut also: impl FnMut(&Batch) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let n = experience.rewards.len();
        let [advantages, returns] = experience.advantages(envs);
        let all = Batch {
            senses: rows(&experience.senses, n)?,
            actions: rows(&experience.actions, n)?,
            feelings: rows(&experience.feelings, n)?,
            likelihoods: Tensor::from_slice(&experience.likelihoods, n, &Device::Cpu)?,
            advantages: Tensor::new(normalized(&advantages), &Device::Cpu)?,
            returns: Tensor::new(returns, &Device::Cpu)?,
        };
        for _ in 0..EPOCHS {
            for chosen in noise.shuffled(n).chunks(MINIBATCH) {
                let batch = all.chosen(&Tensor::from_slice(chosen, chosen.len(), &Device::Cpu)?)?;
                let loss = self.loss(&batch)?;
                self.optimizer.backward_step(&loss)?;
                also(&batch)?;
            }
        }
        Ok(())
    }

    fn loss(&self, batch: &Batch) -> Result<Tensor, Error> {
        let off = (&batch.actions - self.actor.forward(&batch.senses)?)?;
        let draws = off.broadcast_div(&self.deviation.exp()?)?;
        let likelihood = (draws.sqr()?.sum(D::Minus1)? * -0.5)?.broadcast_sub(&self.deviation.sum_all()?)?;
        let ratio = (likelihood - &batch.likelihoods)?.exp()?;
        let free = (&ratio * &batch.advantages)?;
        let clipped = (ratio.clamp(1.0 - CLIP, 1.0 + CLIP)? * &batch.advantages)?;
        let gain = free.minimum(&clipped)?.mean_all()?;
        let error = (self.critic.forward(&batch.senses)?.squeeze(1)? - &batch.returns)?;
        Ok((error.sqr()?.mean_all()? - gain)?)
    }
}

/// Decisions to learn from, a row each.
pub struct Batch {
    /// Inputs of the policy.
    pub senses: Tensor,
    /// Actions.
    pub actions: Tensor,
    /// Touch after the action.
    pub feelings: Tensor,
    likelihoods: Tensor,
    advantages: Tensor,
    returns: Tensor,
}

impl Batch {
    fn chosen(&self, ids: &Tensor) -> Result<Self, Error> {
        let of = |all: &Tensor| all.index_select(ids, 0);
        Ok(Self {
            senses: of(&self.senses)?,
            actions: of(&self.actions)?,
            feelings: of(&self.feelings)?,
            likelihoods: of(&self.likelihoods)?,
            advantages: of(&self.advantages)?,
            returns: of(&self.returns)?,
        })
    }
}

/// Returns numbers as a matrix of `n` rows.
///
/// # Errors
/// Errors of candle.
pub fn rows(values: &[f32], n: usize) -> Result<Tensor, Error> {
    Ok(Tensor::from_slice(values, (n, values.len() / n.max(1)), &Device::Cpu)?)
}

/// Returns numbers with mean 0 and variance 1.
fn normalized(values: &[f32]) -> Vec<f32> {
    let n = values.len().max(1) as f32;
    let mean = values.iter().sum::<f32>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f32>() / n;
    let deviation = variance.sqrt().max(1e-6);
    values.iter().map(|v| (v - mean) / deviation).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advantages_look_ahead_in_each_environment_alone() {
        let experience = Experience {
            values: vec![0.0; 4],
            rewards: vec![0.0, 1.0, 1.0, 0.0],
            ..Experience::default()
        };
        let [advantages, returns] = experience.advantages(2);
        assert_eq!(advantages, [DISCOUNT * TRACE, 1.0, 1.0, 0.0]);
        assert_eq!(returns, advantages);
    }

    #[test]
    fn a_policy_learns_what_is_rewarded() {
        let mut noise = Noise::new(1);
        let mut ppo = Ppo::new(2, 1, &mut noise).expect("small");
        let senses = rows(&[1.0, 0.0], 1).expect("a row");
        let before = ppo.means(&senses).expect("small")[0];
        for _ in 0..20 {
            let mut experience = Experience::default();
            for _ in 0..64 {
                experience.senses.extend([1.0, 0.0]);
                ppo.decide(&senses, &mut noise, &mut experience).expect("small");
                experience.feelings.push(0.0);
                let action = experience.actions.last().copied().unwrap_or_default();
                experience.rewards.push(-(action - 0.8).powi(2));
            }
            // 64 environments with one decision each
            ppo.learn(&experience, 64, &mut noise, |_| Ok(())).expect("small");
        }
        let after = ppo.means(&senses).expect("small")[0];
        assert!((after - 0.8).abs() < 0.5 * (before - 0.8).abs(), "{before} {after}");
    }
}

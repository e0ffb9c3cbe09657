//! The intrinsic reward: for rare touches of his own body, and for sensations that were not predicted.

use babybench::Env;
use babybench::model::Model;
use candle_core::{Device, Tensor};
use candle_nn::{AdamW, Optimizer, ParamsAdamW};

use crate::Error;
use crate::network::{Mlp, Noise};

/// Weight of surprise in the reward; an average surprise is worth this much.
const SURPRISE: f32 = 0.02;
/// Worth of a touch that happens in every episode.
const COMMON_TOUCH: f32 = 0.1;
/// Share of episodes below which rarer touches are not worth more.
const RAREST: f32 = 0.01;
/// Weight of the last episodes in the estimated shares.
const FORGETTING: f32 = 0.1;

/// The touches between a hand and another part of the body, which the infant feels on both sides.
#[derive(Clone, Debug)]
pub struct DoubleTouch {
    hands: [usize; 2],
    geoms: usize,
}

impl DoubleTouch {
    /// Finds the hands of a scene.
    ///
    /// # Errors
    /// A scene without MIMo.
    pub fn new(model: &Model) -> Result<Self, Error> {
        let hand = |name| model.body(name).ok_or("this scene has no MIMo");
        Ok(Self {
            hands: [hand("right_hand")?, hand("left_hand")?],
            geoms: model.ngeom(),
        })
    }

    /// Returns the number of pairs of a hand and a geom.
    pub fn len(&self) -> usize {
        2 * self.geoms
    }

    /// Returns whether there is nothing to touch.
    pub fn is_empty(&self) -> bool {
        self.geoms == 0
    }

    /// Marks in `felt` the pairs that are felt in this step.
    pub fn feel(&self, env: &Env, felt: &mut [bool]) {
        let contacts = env.senses().touch().map_or(&[][..], |touch| touch.contacts());
        // both sides of a contact are adjacent
        for pair in contacts.windows(2) {
            let [one, other] = pair else { continue };
            if one.contact != other.contact {
                continue;
            }
            for (side, part) in [(one, other), (other, one)] {
                if let Some(hand) = self.hands.iter().position(|&hand| hand == side.body)
                    && part.body != side.body
                {
                    felt[hand * self.geoms + part.geom] = true;
                }
            }
        }
    }
}

/// The rarity of each touch in the last episodes.
#[derive(Clone, Debug)]
pub struct Novelty {
    /// For each pair the share of episodes with it.
    shares: Vec<f32>,
}

impl Novelty {
    /// Starts without any touch.
    pub fn new(pairs: usize) -> Self {
        Self {
            shares: vec![0.0; pairs],
        }
    }

    /// Returns the worth of a touch, the first time in an episode.
    pub fn worth(&self, pair: usize) -> f32 {
        COMMON_TOUCH / self.shares[pair].max(RAREST).sqrt()
    }

    /// Learns from the touches of episodes (episodes, pairs).
    pub fn learn(&mut self, touched: &[Vec<bool>]) {
        for (pair, share) in self.shares.iter_mut().enumerate() {
            let now = touched.iter().filter(|episode| episode[pair]).count() as f32 / touched.len().max(1) as f32;
            *share += FORGETTING * (now - *share);
        }
    }
}

/// A model that predicts touch from observation and action. Its error is the surprise.
pub struct Foresight {
    network: Mlp,
    optimizer: AdamW,
    /// Mean error so far, to which surprise is relative.
    usual: Option<f32>,
}

impl Foresight {
    /// Makes a model that predicts `feelings` numbers from `inputs` numbers.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn new(inputs: usize, feelings: usize, noise: &mut Noise) -> Result<Self, Error> {
        let network = Mlp::new(&[inputs, 128, feelings], 0.1, noise)?;
        let params = ParamsAdamW {
            lr: 1e-3,
            weight_decay: 0.0,
            ..ParamsAdamW::default()
        };
        Ok(Self {
            optimizer: AdamW::new(network.vars(), params)?,
            network,
            usual: None,
        })
    }

    /// Returns the reward for each row of `inputs` (rows, inputs) that was followed by feelings (rows, feelings).
    ///
    /// # Errors
    /// Errors of candle.
    pub fn surprise(&mut self, inputs: &Tensor, feelings: &[f32]) -> Result<Vec<f32>, Error> {
        let errors = self.errors(inputs, feelings)?.to_vec1::<f32>()?;
        let mean = errors.iter().sum::<f32>() / errors.len().max(1) as f32;
        let usual = self.usual.map_or(mean, |usual| usual + 0.05 * (mean - usual));
        self.usual = Some(usual);
        Ok(errors
            .iter()
            .map(|e| SURPRISE * (e / usual.max(1e-6)).min(10.0))
            .collect())
    }

    /// Learns to predict.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn learn(&mut self, inputs: &Tensor, feelings: &[f32]) -> Result<(), Error> {
        let loss = self.errors(inputs, feelings)?.mean_all()?;
        Ok(self.optimizer.backward_step(&loss)?)
    }

    fn errors(&self, inputs: &Tensor, feelings: &[f32]) -> Result<Tensor, Error> {
        let foreseen = self.network.forward(inputs)?;
        let felt = Tensor::from_slice(feelings, foreseen.shape(), &Device::Cpu)?;
        Ok((foreseen - felt)?.sqr()?.mean(1)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rare_touches_are_worth_more() {
        let mut novelty = Novelty::new(2);
        assert_eq!(novelty.worth(0), novelty.worth(1));
        for _ in 0..100 {
            novelty.learn(&[
                vec![true, false],
                vec![true, true],
                vec![true, false],
                vec![true, false],
            ]);
        }
        let [common, rare] = [0, 1].map(|pair| novelty.worth(pair));
        assert!((common - COMMON_TOUCH).abs() < 1e-3 && (rare - 2.0 * COMMON_TOUCH).abs() < 1e-3);
    }

    #[test]
    fn what_is_foreseen_does_not_surprise() {
        let mut noise = Noise::new(0);
        let mut foresight = Foresight::new(2, 1, &mut noise).expect("small");
        let inputs: Vec<f32> = (0..128).map(|_| noise.normal()).collect();
        let feelings: Vec<f32> = inputs.chunks_exact(2).map(|i| i[0] - 0.5 * i[1]).collect();
        let inputs = Tensor::from_slice(&inputs, (64, 2), &Device::Cpu).expect("small");
        let sum = |foresight: &mut Foresight| -> f32 {
            let surprise = foresight.surprise(&inputs, &feelings).expect("small");
            surprise.iter().sum()
        };
        let before = sum(&mut foresight);
        for _ in 0..300 {
            foresight.learn(&inputs, &feelings).expect("small");
        }
        let after = sum(&mut foresight);
        assert!(after < 0.1 * before, "{before} {after}");
    }
}

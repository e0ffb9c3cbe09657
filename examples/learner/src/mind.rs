//! The networks of an infant.

use babybench::Env;
use babybench::spaces::BoxSpace;

use crate::Error;
use crate::curiosity::{DoubleTouch, Foresight, Novelty};
use crate::network::Noise;
use crate::ppo::{Experience, Ppo, rows};
use crate::senses::{Normalizer, Senses};

/// Number of steps for which an action is held: a tenth of a second.
pub const HOLD: u64 = 20;

/// The mind of an infant: its knowledge, its curiosity, and its actions.
pub struct Mind {
    pub(crate) senses: Senses,
    pub(crate) normalizer: Normalizer,
    pub(crate) touch: DoubleTouch,
    pub(crate) novelty: Novelty,
    pub(crate) foresight: Foresight,
    pub(crate) policy: Ppo,
    pub(crate) noise: Noise,
    pub(crate) space: BoxSpace,
}

impl Mind {
    /// Makes an untrained mind.
    ///
    /// # Errors
    /// A scene without MIMo; errors of candle.
    pub fn new(env: &Env, seed: u64) -> Result<Self, Error> {
        let (senses, touch) = (Senses::new(env), DoubleTouch::new(env.model())?);
        let mut row = Vec::new();
        senses.sense(env, &vec![false; touch.len()], 0.0, &mut row);
        let (inputs, space) = (row.len(), env.action_space().clone());
        let mut noise = Noise::new(seed);
        Ok(Self {
            policy: Ppo::new(inputs, space.len(), &mut noise)?,
            foresight: Foresight::new(inputs + space.len(), senses.feelings(), &mut noise)?,
            normalizer: Normalizer::default(),
            novelty: Novelty::new(touch.len()),
            senses,
            touch,
            noise,
            space,
        })
    }

    /// Appends an environment's normalized sensations and updates the statistics.
    pub(crate) fn sense(&mut self, env: &Env, touched: &[bool], out: &mut Vec<f32>) {
        let start = out.len();
        let progress = env.info().steps as f32 / env.config().max_episode_steps.max(1) as f32;
        self.senses.sense(env, touched, progress, out);
        self.normalizer.learn(&out[start..]);
        self.normalizer.apply(&mut out[start..]);
    }

    /// Writes the policy's decision, with the noise of its training, as an action of the environment.
    ///
    /// # Errors
    /// Errors of candle.
    pub fn act(&self, env: &Env, touched: &[bool], noise: &mut Noise, action: &mut Vec<f32>) -> Result<(), Error> {
        let (mut row, mut decided) = (Vec::new(), Experience::default());
        let progress = env.info().steps as f32 / env.config().max_episode_steps.max(1) as f32;
        self.senses.sense(env, touched, progress, &mut row);
        self.normalizer.apply(&mut row);
        self.policy.decide(&rows(&row, 1)?, noise, &mut decided)?;
        let wanted = decided.actions.iter().enumerate();
        action.clear();
        action.extend(wanted.map(|(k, &v)| self.space.clip(k, v)));
        Ok(())
    }

    /// Returns what is felt.
    pub fn touch(&self) -> &DoubleTouch {
        &self.touch
    }
}

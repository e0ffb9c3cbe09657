//! The memory of delays and pain in a snapshot.

use super::SnapshotError;
use super::format::damaged;
use crate::env::Env;
use crate::env::pipeline::{append_part, take_part};

impl Env {
    /// Appends the memory of the action delay, pain and transforms, each part after its length.
    pub(crate) fn save_memory(&self, out: &mut Vec<u8>) {
        let mut part = Vec::new();
        self.action_delay.save(&mut part);
        append_part(out, &mut part);
        if let Some(pain) = &self.senses.pain {
            pain.save(&mut part);
        }
        append_part(out, &mut part);
        self.senses.pipeline.save(out);
        // missing parts leave no mark, because the fingerprint includes the configuration
        if let Some(reflexes) = &self.reflexes {
            reflexes.save(&mut part);
            append_part(out, &mut part);
        }
        for clock in self.senses.clocks.iter().flatten() {
            clock.save(&mut part);
            append_part(out, &mut part);
        }
        if self.grows() {
            part.extend_from_slice(&self.episode.earlier_steps.to_le_bytes());
            append_part(out, &mut part);
        }
    }

    /// Restores what [`Env::save_memory`] wrote. Invalid data change nothing.
    pub(crate) fn load_memory(&mut self, bytes: &[u8]) -> Result<(), SnapshotError> {
        let mut before = Vec::new();
        self.save_memory(&mut before);
        if self.try_load(bytes) {
            return Ok(());
        }
        self.try_load(&before);
        Err(damaged("the memory of its senses does not fit"))
    }

    /// Restores the number of steps before the episode.
    fn load_life(&mut self, bytes: &[u8]) -> bool {
        let steps = bytes.try_into().map(u64::from_le_bytes);
        steps.is_ok_and(|steps| self.set_earlier_steps(steps))
    }

    fn try_load(&mut self, mut bytes: &[u8]) -> bool {
        let bytes = &mut bytes;
        let (Some(motor), Some(pain)) = (take_part(bytes), take_part(bytes)) else {
            return false;
        };
        let felt = match &mut self.senses.pain {
            Some(sense) => sense.load(pain),
            None => pain.is_empty(),
        };
        let senses = &mut self.senses;
        let sensed = self.action_delay.load(motor) && felt && senses.pipeline.load(bytes);
        let reflexes = self.reflexes.as_mut();
        let reacts = reflexes.is_none_or(|r| take_part(bytes).is_some_and(|part| r.load(part)));
        let mut clocks = senses.clocks.iter_mut().flatten();
        let timed = clocks.all(|clock| take_part(bytes).is_some_and(|part| clock.load(part)));
        let counted = !self.grows() || take_part(bytes).is_some_and(|part| self.load_life(part));
        sensed && reacts && timed && counted && bytes.is_empty()
    }
}

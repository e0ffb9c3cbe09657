//! The memory of delays and pain in a snapshot.

use super::SnapshotError;
use super::format::damaged;
use crate::env::Env;
use crate::env::pipeline::take_part;

impl Env {
    /// Appends what actions on their way, pain and transforms remember, each part behind its length.
    pub(in crate::env) fn save_memory(&self, out: &mut Vec<u8>) {
        let mut part = Vec::new();
        self.action_delay.save(&mut part);
        append(out, &mut part);
        if let Some(pain) = &self.senses.pain {
            pain.save(&mut part);
        }
        append(out, &mut part);
        self.senses.pipeline.save(out);
    }

    /// Takes over what [`Env::save_memory`] wrote; changes nothing if it is something else.
    pub(in crate::env) fn load_memory(&mut self, bytes: &[u8]) -> Result<(), SnapshotError> {
        let mut before = Vec::new();
        self.save_memory(&mut before);
        if self.try_load(bytes) {
            return Ok(());
        }
        self.try_load(&before);
        Err(damaged("what its senses remember does not fit"))
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
        self.action_delay.load(motor) && felt && self.senses.pipeline.load(bytes) && bytes.is_empty()
    }
}

/// Moves a part to the end of bytes, behind its length.
fn append(out: &mut Vec<u8>, part: &mut Vec<u8>) {
    out.extend_from_slice(&(part.len() as u64).to_le_bytes());
    out.append(part);
}

//! The absence of a task.

use super::TaskEvent;
use crate::env::{BehaviorInfo, Info, Task};

/// MIMo follows the actions, and nothing is counted.
#[derive(Clone, Debug)]
pub(super) struct FreePlay;

impl Task for FreePlay {
    fn name(&self) -> &str {
        "none"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn inform(&self, _event: TaskEvent<'_>, info: &mut Info) {
        info.behavior = BehaviorInfo::None;
    }
}

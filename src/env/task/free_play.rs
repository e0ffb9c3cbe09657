//! No task at all.

use super::TaskEvent;
use crate::env::{BehaviorInfo, Info, Task};

/// MIMo does what the actions say, and nothing is counted.
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

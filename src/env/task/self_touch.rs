//! Self-touch: parts of the body that the palms touch.

use super::scene::TaskScene;
use super::starts::random_start;
use super::{Task, TaskEvent, TaskSizes, body};
use crate::config::Config;
use crate::env::{BehaviorInfo, EnvError, Info, PartNames, PerHand};
use crate::model::Model;
use crate::physics::State;

/// MIMo touches himself. Holds which of his geoms (ngeom) are palms.
#[derive(Clone, Debug, Default)]
pub(super) struct SelfTouch {
    right_palm: Vec<bool>,
    left_palm: Vec<bool>,
    own: Vec<bool>,
    names: PartNames,
}

impl SelfTouch {
    /// Adds the parts that the palms touch. A contact counts for the first rule that fits: right palm as first geom, as
    /// second, left palm as first, as second.
    fn update(&self, s: &State, touches: &mut PerHand<Vec<usize>>) {
        for c in &s.contact {
            let [a, b] = c.geom;
            let (list, other) = if self.right_palm[a] {
                (&mut touches.right_hand, b)
            } else if self.right_palm[b] {
                (&mut touches.right_hand, a)
            } else if self.left_palm[a] {
                (&mut touches.left_hand, b)
            } else if self.left_palm[b] {
                (&mut touches.left_hand, a)
            } else {
                continue;
            };
            if self.own[other] && !list.contains(&other) {
                list.push(other);
            }
        }
    }
}

impl Task for SelfTouch {
    fn name(&self) -> &str {
        "self_touch"
    }

    fn only_moves(&self) -> bool {
        true
    }

    fn bind(&mut self, _config: &Config, model: &Model) -> Result<TaskSizes, EnvError> {
        let purpose = "behavior self_touch";
        let (right, left) = (body(model, "right_hand", purpose)?, body(model, "left_hand", purpose)?);
        let hip = body(model, "hip", purpose)?;
        let of = |f: &dyn Fn(usize) -> bool| model.geom_bodyid.iter().map(|&b| f(b)).collect::<Vec<bool>>();
        *self = Self {
            right_palm: of(&|b| b == right),
            left_palm: of(&|b| b == left),
            own: of(&|b| model.in_subtree(b, hip)),
            names: PartNames::new(model),
        };
        Ok(TaskSizes::default())
    }

    fn reset(&mut self, scene: &mut TaskScene<'_>) -> Result<(), EnvError> {
        random_start(scene, |_| Ok(()))
    }

    fn inform(&self, event: TaskEvent<'_>, info: &mut Info) {
        match (event, &mut info.behavior) {
            (TaskEvent::Step(state), BehaviorInfo::SelfTouch { touches }) => self.update(state, touches),
            (TaskEvent::Start, BehaviorInfo::SelfTouch { touches }) => {
                touches.each_mut().into_iter().for_each(Vec::clear);
            }
            (TaskEvent::Start, behavior) => {
                let touches = PerHand::from_fn(|_| Vec::with_capacity(self.own.len()));
                *behavior = BehaviorInfo::SelfTouch { touches };
            }
            _ => {}
        }
        if info.details.touched_parts.is_none() {
            info.details.reserve(&self.names);
        }
        info.details.name_parts(info.behavior.touches(), &self.names);
    }
}

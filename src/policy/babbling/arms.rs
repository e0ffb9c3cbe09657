//! The arms of a body: the numbers of an action that move them, and the sensations of their palms.

use crate::env::Env;
use crate::policy::PolicyError;
use crate::spaces::BoxSpace;

/// The two palms, right one first, with their arms.
#[derive(Clone, Debug)]
pub(super) struct Arms {
    palms: [usize; 2],
    /// Whether each geom belongs to a part with skin, which feels touches.
    skinned: Vec<Option<usize>>,
    /// For each arm the numbers of an action that move it.
    actions: [Vec<usize>; 2],
    space: BoxSpace,
}

impl Arms {
    /// Finds the arms of an environment's MIMo.
    pub(super) fn new(env: &Env) -> Result<Self, PolicyError> {
        let touch = env
            .senses()
            .touch()
            .ok_or("babbling learns by touch: set touch_active: true");
        let touch = touch.map_err(|reason| PolicyError::Other(reason.into()))?;
        let model = env.model();
        let palm = |name: &str| {
            let missing = || PolicyError::Other(format!("babbling needs MIMo, with a body {name}").into());
            model.body(name).ok_or_else(missing)
        };
        let palms = [palm("right_hand")?, palm("left_hand")?];
        let layout = touch.layout();
        let skinned = model.geom_bodyid.iter().map(|&body| {
            let skin = layout.bodies().iter().any(|skin| skin.body == body);
            skin.then_some(body)
        });
        let actuators = env.blueprint().actuation().actuators();
        let space = env.action_space().clone();
        let arm = |hand: usize| {
            let (own, other) = (palms[hand], palms[1 - hand]);
            let moves = |actuator: usize| {
                let joint = model.actuator_trnid[actuator];
                let body = model.jnt_bodyid.get(joint).copied().unwrap_or(0);
                // joints between the palm and the trunk, and those of its fingers
                let above = model.in_subtree(own, body) && !model.in_subtree(other, body);
                above || model.in_subtree(body, own)
            };
            // muscles have several blocks of numbers; actuators of other bodies are at the end
            let own_numbers = space.len() - env.blueprint().actuation().extra_actuators().len().min(space.len());
            let all = (0..own_numbers).filter(|d| actuators.get(d % actuators.len().max(1)).is_some_and(|&a| moves(a)));
            all.collect()
        };
        Ok(Self {
            palms,
            skinned: skinned.collect(),
            actions: [arm(0), arm(1)],
            space,
        })
    }

    /// Returns whether an environment has the same body.
    pub(super) fn fits(&self, env: &Env) -> bool {
        self.skinned.len() == env.model().ngeom() && self.space.len() == env.action_space().len()
    }

    /// Returns the number of pairs of a palm and a geom.
    pub(super) fn pairs(&self) -> usize {
        2 * self.skinned.len()
    }

    /// Returns the palm of a pair: 0 right, 1 left.
    pub(super) fn hand_of(&self, pair: u32) -> usize {
        usize::from(pair as usize >= self.skinned.len())
    }

    /// Calls `each` with every pair of a palm and a part that is currently felt; both sides have skin.
    pub(super) fn feel(&self, env: &Env, mut each: impl FnMut(u32)) {
        let contacts = env.senses().touch().map_or(&[][..], |touch| touch.contacts());
        for contact in contacts.iter().filter(|contact| contact.felt) {
            // a flex has no skin
            let Some(other) = contact.other.geom() else { continue };
            let (Some(hand), Some(&Some(body))) = (
                self.palms.iter().position(|&palm| palm == contact.body),
                self.skinned.get(other),
            ) else {
                continue;
            };
            if body != contact.body {
                each((hand * self.skinned.len() + other) as u32);
            }
        }
    }

    pub(super) fn action_len(&self) -> usize {
        self.space.len()
    }

    /// Returns the numbers of an action that move an arm.
    pub(super) fn of_hand(&self, hand: usize) -> &[usize] {
        &self.actions[hand]
    }

    pub(super) fn half_range(&self, d: usize) -> f64 {
        0.5 * f64::from(self.space.high()[d] - self.space.low()[d])
    }

    pub(super) fn clamp(&self, d: usize, value: f64) -> f32 {
        self.space.clip(d, value as f32)
    }

    /// Returns the bounds of an action.
    pub(super) fn space(&self) -> &BoxSpace {
        &self.space
    }
}

//! Forces of contacts on parts of MIMo, for reflexes that are elicited by touch.

use crate::math::{Vec3, mat_t_vec, sub};
use crate::mimo::MimoBodies;
use crate::model::Model;
use crate::physics::{Contact, ContactSide, State};

/// The bodies of MIMo that a reflex watches: the group number of each geom of the scene.
pub(super) struct Watched {
    groups: Vec<Option<u8>>,
    /// Whether a geom is MIMo's.
    own: Vec<bool>,
}

/// A contact of a watched geom with anything outside its group.
pub(super) struct Pressed {
    /// The group of the geom.
    pub group: usize,
    /// Force on it, N, in the frame of its body.
    pub force: Vec3,
    /// Force on it, N, in the world frame.
    pub world: Vec3,
    /// Point of contact, m, in the frame of its body.
    pub point: Vec3,
    /// Whether MIMo touches himself.
    pub by_himself: bool,
}

impl Watched {
    /// Watches the bodies for which `group` returns a number.
    pub fn new(model: &Model, group: impl Fn(&str) -> Option<u8>) -> Self {
        let bodies = MimoBodies::of(model);
        let body = |geom: usize| model.geom_bodyid[geom];
        let own: Vec<bool> = (0..model.ngeom()).map(|geom| bodies.contains(body(geom))).collect();
        let groups = (0..model.ngeom()).map(|geom| group(&model.body_name[body(geom)]).filter(|_| own[geom]));
        Self {
            groups: groups.collect(),
            own,
        }
    }

    /// Calls `found` for each contact of the last physics step.
    pub fn each(&self, model: &Model, state: &State, mut found: impl FnMut(&Pressed)) {
        let mut each = |contact: &Contact, sides: [ContactSide; 2]| {
            let groups = sides.map(|side| side.geom().and_then(|geom| self.groups[geom]));
            if groups[0] == groups[1] {
                return; // neither is watched, or a part touches itself
            }
            let force = contact.world_force();
            for side in 0..2 {
                let Some(group) = groups[side] else { continue };
                let world = if side == 0 { force.map(|v| -v) } else { force };
                let body = sides[side].body(model);
                let frame = &state.xmat[body];
                found(&Pressed {
                    group: usize::from(group),
                    force: mat_t_vec(frame, world),
                    world,
                    point: mat_t_vec(frame, sub(contact.pos, state.xpos[body])),
                    by_himself: sides[1 - side].geom().is_some_and(|geom| self.own[geom]),
                });
            }
        };
        for contact in &state.contact {
            each(contact, contact.geom.map(ContactSide::Geom));
        }
        for flex in &state.flex_contact {
            each(&flex.contact, flex.sides);
        }
    }
}

/// Returns the side of a body by its name, 0 for left and 1 for right.
pub(super) fn side(body: &str) -> Option<(u8, &str)> {
    let left = body.strip_prefix("left_").map(|name| (0, name));
    left.or_else(|| body.strip_prefix("right_").map(|name| (1, name)))
}

//! Touch sensors.

use crate::math::*;
use crate::model::Model;
use crate::ray::ray_shape;
use crate::state::State;

/// Returns the sum of the normal forces of contacts of the site's body whose line of force, from the contact into the body, meets
/// the volume of the site, N.
pub(super) fn touch(model: &Model, s: &State, site: usize) -> f64 {
    let body = model.site_bodyid[site];
    let mut sum = 0.0;
    let of_geoms = s.contact.iter().map(|c| (c, c.geom.map(Some)));
    let of_flexes = s.flex_contact.iter().map(|c| (&c.contact, c.geoms()));
    for (c, geoms) in of_geoms.chain(of_flexes).filter(|(c, _)| c.efc_address.is_some()) {
        // flexes have no sites
        let [b1, b2] = geoms.map(|geom| geom.map_or(usize::MAX, |g| model.geom_bodyid[g]));
        if (b1 != body && b2 != body) || c.force[0] <= 0.0 {
            continue;
        }
        let along = unit(scale(row(&c.frame, 0), c.force[0])).0;
        // the normal points into the second body
        let into = if b2 == body { scale(along, -1.0) } else { along };
        let (pos, mat, size) = (s.site_xpos[site], &s.site_xmat[site], model.site_size[site]);
        if ray_shape(model.site_type[site], size, pos, mat, c.pos, into).is_some() {
            sum += c.force[0];
        }
    }
    sum
}

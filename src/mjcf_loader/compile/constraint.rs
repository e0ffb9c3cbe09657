//! Compiles contact pairs and excludes.

use super::context::{Context, Ids};
use crate::document::TypedDocument;
use crate::error::LoadError;
use crate::math::order;
use crate::model::Arrays;

/// Compiles explicit pairs and excludes, both sorted by the pair of bodies.
pub(super) fn compile_contacts(
    context: &Context,
    document: &TypedDocument,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let mut pairs = Vec::with_capacity(document.pairs.len());
    for pair in &document.pairs {
        if !matches!(pair.condim, 1 | 3 | 4 | 6) {
            return Err(context.invalid(pair.at, "condim must be 1, 3, 4 or 6"));
        }
        let mut geoms = [
            ids.geom.find(context.tree, pair.at, "geom1", &pair.geom1)?,
            ids.geom.find(context.tree, pair.at, "geom2", &pair.geom2)?,
        ];
        if geoms[0] == geoms[1] {
            return Err(context.invalid(pair.at, "a geom cannot pair with itself"));
        }
        let mut bodies = geoms.map(|geom| arrays.geom_bodyid[geom]);
        if bodies[0] > bodies[1] {
            geoms.swap(0, 1);
            bodies.swap(0, 1);
        }
        pairs.push((bodies, geoms, pair));
        context.within(pair.at, "contact pairs", context.tree.limits.pairs, pairs.len())?;
    }
    // stable, so that pairs of the same bodies keep the order of the document
    order::sort_by(&mut pairs, |a, b| a.0.cmp(&b.0));
    for (_, geoms, pair) in pairs {
        arrays.pair_geom.push(geoms);
        arrays.pair_dim.push(pair.condim);
        arrays.pair_solref.push(pair.solref);
        arrays.pair_solreffriction.push(pair.solreffriction);
        arrays.pair_solimp.push(pair.solimp);
        arrays.pair_friction.push(pair.friction);
        arrays.pair_margin.push(pair.margin);
        arrays.pair_gap.push(pair.gap);
    }
    for exclude in &document.excludes {
        let mut bodies = [
            ids.body.find(context.tree, exclude.at, "body1", &exclude.body1)?,
            ids.body.find(context.tree, exclude.at, "body2", &exclude.body2)?,
        ];
        bodies.sort_unstable();
        arrays.exclude.push(bodies);
    }
    order::sort(&mut arrays.exclude);
    Ok(())
}

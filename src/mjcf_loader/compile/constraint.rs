//! Compiles contact pairs and equalities.

use super::context::{Context, Ids};
use crate::math::quat_normalize;
use crate::mjcf_loader::document::Document;
use crate::mjcf_loader::error::LoadError;
use crate::mjcf_loader::relation::{ConnectEquality, Equality, Held, JointEquality, TendonEquality, WeldEquality};
use crate::model::{Arrays, EqualityKind};

/// Compiles explicit pairs and excludes, both sorted by the pair of bodies.
pub(super) fn compile_contacts(
    context: &Context,
    document: &Document,
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
    pairs.sort_by_key(|(bodies, ..)| *bodies);
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
    arrays.exclude.sort_unstable();
    Ok(())
}

/// Finds the two bodies of an equality, the second of which is the world if it is not named.
fn two_bodies(
    context: &Context,
    at: usize,
    body1: &str,
    body2: Option<&String>,
    ids: &Ids,
) -> Result<[usize; 2], LoadError> {
    let body1 = ids.body.find(context.tree, at, "body1", body1)?;
    let body2 = match body2 {
        Some(name) => ids.body.find(context.tree, at, "body2", name)?,
        None => 0,
    };
    if body1 == body2 {
        return Err(context.invalid(at, "a body cannot be held by itself"));
    }
    Ok([body1, body2])
}

/// Compiles an equality. A weld without a pose of its own gets it at `qpos0`, which needs kinematics; until then its
/// quaternion is zero.
pub(super) fn compile_equality(
    context: &Context,
    equality: &Equality,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let at = equality.at;
    let kind = match &equality.held {
        Held::Joint(JointEquality {
            joint1,
            joint2,
            polycoef,
        }) => {
            let find = |attribute, name: &String| ids.scalar_joint(context, arrays, at, attribute, name);
            let (joint1, joint2) = (
                find("joint1", joint1)?,
                joint2.as_ref().map(|name| find("joint2", name)).transpose()?,
            );
            if joint2 == Some(joint1) {
                return Err(context.invalid(at, "a joint cannot follow itself"));
            }
            EqualityKind::Joint {
                joint1,
                joint2,
                polycoef: *polycoef,
            }
        }
        Held::Tendon(TendonEquality {
            tendon1,
            tendon2,
            polycoef,
        }) => {
            let find = |attribute, name: &String| ids.tendon.find(context.tree, at, attribute, name);
            let (tendon1, tendon2) = (
                find("tendon1", tendon1)?,
                tendon2.as_ref().map(|name| find("tendon2", name)).transpose()?,
            );
            if tendon2 == Some(tendon1) {
                return Err(context.invalid(at, "a tendon cannot follow itself"));
            }
            EqualityKind::Tendon {
                tendon1,
                tendon2,
                polycoef: *polycoef,
            }
        }
        Held::Connect(ConnectEquality { body1, body2, anchor }) => {
            let [body1, body2] = two_bodies(context, at, body1, body2.as_ref(), ids)?;
            // where it is in body 2 follows from the poses at qpos0
            let (anchor1, anchor2) = (*anchor, [0.0; 3]);
            EqualityKind::Connect {
                body1,
                body2,
                anchor1,
                anchor2,
            }
        }
        Held::Weld(WeldEquality {
            body1,
            body2,
            relpose,
            anchor,
            torquescale,
        }) => {
            let [body1, body2] = two_bodies(context, at, body1, body2.as_ref(), ids)?;
            let [x, y, z, quat @ ..] = *relpose;
            let (relpos, relquat) = match quat {
                [0.0, 0.0, 0.0, 0.0] => ([0.0; 3], quat),
                quat => ([x, y, z], quat_normalize(quat)),
            };
            EqualityKind::Weld {
                body1,
                body2,
                anchor: *anchor,
                relpos,
                relquat,
                torquescale: *torquescale,
            }
        }
    };
    arrays.eq_name.push(equality.name.clone());
    arrays.eq_kind.push(kind);
    arrays.eq_active0.push(equality.active);
    arrays.eq_solref.push(equality.solref);
    arrays.eq_solimp.push(equality.solimp);
    Ok(())
}

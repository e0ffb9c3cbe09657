//! Compiles tendons.

use super::context::{Context, Ids, UserDataSize, named};
use crate::error::{ErrorKind, LoadError};
use crate::model::{Arrays, GeomType, Wrap};
use crate::relation::{Tendon, TendonElements};
use crate::settings::single;

/// MuJoCo accepts such a tendon, but its length depends on both coefficients and its force only on the last.
const JOINT_TWICE: &str = "the tendon names this joint twice";
const NO_JOINTS: &str = "the tendon has no joints";
const SHORT: &str = "a spatial tendon runs along two sites or more";
const NO_WIDTH: &str = "width must be positive";
const LENGTHS: &str = "springlength must be the shorter and then the longer length";
const SHAPE: &str = "a tendon wraps around spheres and cylinders only";
const BRACKET: &str = "a geom of a tendon must stand between two sites";
const PULLEY_LAST: &str = "a tendon cannot end with a pulley: a site follows it";
const PULLEYS: &str = "two pulleys of a tendon follow each other: a site must stand between them";
const ALONE: &str = "a site of a tendon must have another site or a geom before or behind it, not pulleys alone";
const SITE_TWICE: &str = "the tendon names this site twice in a row";

/// Compiles a tendon.
pub(super) fn compile_tendon(
    context: &Context,
    tendon: &Tendon,
    user: &UserDataSize,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let wrong = match tendon.path.len() {
        0 if !tendon.spatial => Some(NO_JOINTS),
        0 | 1 if tendon.spatial => Some(SHORT),
        _ if tendon.spatial && tendon.looks.width <= 0.0 => Some(NO_WIDTH),
        _ => None,
    };
    if let Some(wrong) = wrong {
        return Err(context.invalid(tendon.at, wrong));
    }
    let mut wrap = Vec::with_capacity(tendon.path.len());
    for along in &tendon.path {
        let next = compile_wrap(context, along, ids, arrays)?;
        let again = |other: &Wrap| match (*other, next) {
            (Wrap::Joint { joint, .. }, Wrap::Joint { joint: next, .. }) => joint == next,
            _ => false,
        };
        if wrap.iter().any(again) {
            return Err(context.error(along.at(), ErrorKind::Invalid(JOINT_TWICE)));
        }
        wrap.push(next);
    }
    if tendon.spatial {
        check_path(context, tendon, &wrap)?;
    }
    arrays.tendon_user.push(user.of(context, tendon.at, &tendon.user)?);
    arrays.tendon_name.push(tendon.name.clone());
    arrays.tendon_wrap.push(wrap);
    arrays
        .tendon_limited
        .push(context.limited(tendon.at, "range", tendon.limited, tendon.range)?);
    arrays.tendon_range.push(tendon.range);
    arrays.tendon_margin.push(tendon.margin);
    arrays.tendon_solref_lim.push(tendon.solref_limit);
    arrays.tendon_solimp_lim.push(tendon.solimp_limit);
    let [shortest, longest] = tendon.springlength.0;
    if shortest > longest {
        return Err(context.invalid(tendon.at, LENGTHS));
    }
    arrays.tendon_lengthspring.push([shortest, longest]);
    arrays.tendon_frictionloss.push(tendon.frictionloss);
    arrays.tendon_solref_fri.push(tendon.solref_friction);
    arrays.tendon_solimp_fri.push(tendon.solimp_friction);
    arrays.tendon_stiffness.push(tendon.stiffness);
    arrays.tendon_damping.push(tendon.damping);
    compile_looks(context, tendon, ids, arrays)
}

/// Compiles the attributes that only change pictures.
fn compile_looks(context: &Context, tendon: &Tendon, ids: &Ids, arrays: &mut Arrays) -> Result<(), LoadError> {
    let find = |name: &String| ids.material.find(context.tree, tendon.at, "material", name);
    let looks = &tendon.looks;
    arrays.tendon_matid.push(named(&looks.material).map(find).transpose()?);
    arrays.tendon_group.push(tendon.group);
    arrays.tendon_width.push(looks.width);
    arrays.tendon_rgba.push(looks.rgba.map(single));
    Ok(())
}

/// Compiles an element that a tendon runs along.
fn compile_wrap(context: &Context, along: &TendonElements, ids: &Ids, arrays: &Arrays) -> Result<Wrap, LoadError> {
    let (tree, at) = (context.tree, along.at());
    Ok(match along {
        TendonElements::Joint(joint) => Wrap::Joint {
            // of a ball or free joint MuJoCo takes the first coordinate
            joint: ids.joint.find(tree, at, "joint", &joint.joint)?,
            coef: joint.coef,
        },
        TendonElements::Site(site) => Wrap::Site {
            site: ids.site.find(tree, at, "site", &site.site)?,
        },
        TendonElements::Pulley(pulley) => Wrap::Pulley {
            divisor: pulley.divisor,
        },
        TendonElements::Geom(wrapped) => {
            let geom = ids.geom.find(tree, at, "geom", &wrapped.geom)?;
            let side = wrapped.sidesite.as_ref().filter(|name| !name.is_empty());
            let side = side.map(|name| ids.site.find(tree, at, "sidesite", name)).transpose()?;
            match arrays.geom_type[geom] {
                GeomType::Sphere => Wrap::Sphere { geom, side },
                GeomType::Cylinder => Wrap::Cylinder { geom, side },
                _ => return Err(context.invalid(at, SHAPE)),
            }
        }
    })
}

/// Checks the order of the elements on the path of a spatial tendon.
fn check_path(context: &Context, tendon: &Tendon, wrap: &[Wrap]) -> Result<(), LoadError> {
    let is_site = |k: usize| matches!(wrap.get(k), Some(Wrap::Site { .. }));
    let is_end = |k: usize| matches!(wrap.get(k), None | Some(Wrap::Pulley { .. }));
    for (k, along) in tendon.path.iter().enumerate() {
        // before the first there is nothing
        let before = k.wrapping_sub(1);
        let wrong = match wrap[k] {
            Wrap::Pulley { .. } if k + 1 == wrap.len() => Some(PULLEY_LAST),
            Wrap::Pulley { .. } if k > 0 && is_end(before) => Some(PULLEYS),
            Wrap::Site { .. } if is_end(before) && is_end(k + 1) => Some(ALONE),
            Wrap::Site { .. } if wrap.get(k + 1) == Some(&wrap[k]) => Some(SITE_TWICE),
            Wrap::Sphere { .. } | Wrap::Cylinder { .. } if !is_site(before) || !is_site(k + 1) => Some(BRACKET),
            _ => None,
        };
        if let Some(wrong) = wrong {
            return Err(context.invalid(along.at(), wrong));
        }
    }
    Ok(())
}

//! Compiles equalities.

use super::context::{Context, Ids};
use crate::error::LoadError;
use crate::math::{Quat, Vec3, quat_conj, quat_mul, quat_normalize};
use crate::model::{Arrays, EqualityKind};
use crate::relation::{Ends, Equality, EqualityElements, JointEquality, TendonEquality, WeldEquality};

/// Compiles an equality. Relative poses of bodies at `qpos0` need kinematics. Until those run, the anchor of a connection in its second body is
/// the origin, and a weld without `relpose` has a quaternion of zeros.
pub(super) fn compile_equality(
    context: &Context,
    equality: &Equality,
    ids: &Ids,
    arrays: &mut Arrays,
) -> Result<(), LoadError> {
    let scope = Scope {
        context,
        ids,
        arrays,
        at: equality.at,
    };
    let kind = match &equality.held {
        EqualityElements::Joint(joint) => scope.joint(joint)?,
        EqualityElements::Tendon(tendon) => scope.tendon(tendon)?,
        EqualityElements::Connect(ends) => scope.connect(ends)?,
        EqualityElements::Weld(weld) => scope.weld(weld)?,
        EqualityElements::Flex(held) => EqualityKind::Flex {
            flex: ids.flex.find(context.tree, equality.at, "flex", &held.flex)?,
        },
    };
    arrays.eq_name.push(equality.name.clone());
    arrays.eq_kind.push(kind);
    arrays.eq_active0.push(equality.active);
    arrays.eq_solref.push(equality.solref);
    arrays.eq_solimp.push(equality.solimp);
    Ok(())
}

/// The tables in which the names of an equality are looked up.
struct Scope<'a> {
    context: &'a Context<'a>,
    ids: &'a Ids,
    arrays: &'a Arrays,
    /// Position of the equality in the text.
    at: usize,
}

/// The two bodies or sites that a connection or a weld holds together.
enum ConnectedBodies {
    Bodies([usize; 2]),
    /// Sites and their bodies.
    Sites([usize; 2], [usize; 2]),
}

impl Scope<'_> {
    fn joint(&self, joint: &JointEquality) -> Result<EqualityKind, LoadError> {
        let find = |attribute, name: &String| {
            self.ids
                .scalar_joint(self.context, self.arrays, self.at, attribute, name)
        };
        let joint1 = find("joint1", &joint.joint1)?;
        let joint2 = joint.joint2.as_ref().map(|name| find("joint2", name)).transpose()?;
        if joint2 == Some(joint1) {
            return Err(self.context.invalid(self.at, "a joint cannot follow itself"));
        }
        Ok(EqualityKind::Joint {
            joint1,
            joint2,
            polycoef: joint.polycoef,
        })
    }

    fn tendon(&self, tendon: &TendonEquality) -> Result<EqualityKind, LoadError> {
        let find = |attribute, name: &String| self.ids.tendon.find(self.context.tree, self.at, attribute, name);
        let tendon1 = find("tendon1", &tendon.tendon1)?;
        let tendon2 = tendon.tendon2.as_ref().map(|name| find("tendon2", name)).transpose()?;
        if tendon2 == Some(tendon1) {
            return Err(self.context.invalid(self.at, "a tendon cannot follow itself"));
        }
        Ok(EqualityKind::Tendon {
            tendon1,
            tendon2,
            polycoef: tendon.polycoef,
        })
    }

    fn connect(&self, ends: &Ends) -> Result<EqualityKind, LoadError> {
        let pair = self.pair(ends, false)?;
        let (bodies, anchors, sites) = match (pair, ends.anchor) {
            (ConnectedBodies::Sites(sites, bodies), _) => (bodies, self.places(sites), Some(sites)),
            (ConnectedBodies::Bodies(bodies), Some(anchor)) => (bodies, [anchor, [0.0; 3]], None),
            (ConnectedBodies::Bodies(_), None) => {
                let what = "give anchor, the point of body1 that is held, or site1 and site2 in place of bodies";
                return Err(self.context.invalid(self.at, what));
            }
        };
        Ok(EqualityKind::Connect {
            body1: bodies[0],
            body2: bodies[1],
            anchor1: anchors[0],
            anchor2: anchors[1],
            sites,
        })
    }

    fn weld(&self, weld: &WeldEquality) -> Result<EqualityKind, LoadError> {
        let (bodies, [relpos, anchor], relquat, sites) = match self.pair(&weld.ends, weld.relpose.is_some())? {
            ConnectedBodies::Sites(sites, bodies) => {
                let [q1, q2] = sites.map(|site| self.arrays.site_quat[site]);
                (bodies, self.places(sites), quat_mul(q1, quat_conj(q2)), Some(sites))
            }
            ConnectedBodies::Bodies(bodies) => {
                let (relpos, relquat) = pose_of(weld.relpose);
                (bodies, [relpos, weld.ends.anchor.unwrap_or_default()], relquat, None)
            }
        };
        Ok(EqualityKind::Weld {
            body1: bodies[0],
            body2: bodies[1],
            anchor,
            relpos,
            relquat,
            torquescale: weld.torquescale,
            sites,
        })
    }

    /// Returns the positions of sites in their bodies.
    fn places(&self, sites: [usize; 2]) -> [Vec3; 2] {
        sites.map(|site| self.arrays.site_pos[site])
    }

    /// Finds the two bodies or sites. `posed` is whether a relative pose of bodies is given.
    fn pair(&self, ends: &Ends, posed: bool) -> Result<ConnectedBodies, LoadError> {
        let (context, at) = (self.context, self.at);
        let of_bodies = ends.body1.is_some() || ends.body2.is_some() || ends.anchor.is_some() || posed;
        match (&ends.site1, &ends.site2, &ends.body1) {
            (None, None, Some(body1)) => {
                let find = |attribute, name| self.ids.body.find(context.tree, at, attribute, name);
                let body1 = find("body1", body1)?;
                // a body that is not named is the world
                let body2 = ends.body2.as_ref().map_or(Ok(0), |name| find("body2", name))?;
                if body1 == body2 {
                    return Err(context.invalid(at, "a body cannot be held by itself"));
                }
                Ok(ConnectedBodies::Bodies([body1, body2]))
            }
            (Some(site1), Some(site2), _) if !of_bodies => {
                let find = |attribute, name| self.ids.site.find(context.tree, at, attribute, name);
                let sites = [find("site1", site1)?, find("site2", site2)?];
                if sites[0] == sites[1] {
                    return Err(context.invalid(at, "a site cannot be held by itself"));
                }
                Ok(ConnectedBodies::Sites(
                    sites,
                    sites.map(|site| self.arrays.site_bodyid[site]),
                ))
            }
            (None, None, None) => Err(context.invalid(at, "give body1, or site1 and site2")),
            _ if of_bodies => Err(context.invalid(at, "give bodies or sites, not both")),
            _ => Err(context.invalid(at, "give both site1 and site2")),
        }
    }
}

/// Returns position and orientation of a weld's relative pose; zeros if it is the pose at `qpos0`.
fn pose_of(relpose: Option<[f64; 7]>) -> (Vec3, Quat) {
    match relpose.unwrap_or_default() {
        // a quaternion of zeros is MuJoCo's default, and means the pose at `qpos0`, for any position
        [_, _, _, 0.0, 0.0, 0.0, 0.0] => ([0.0; 3], [0.0; 4]),
        [x, y, z, quat @ ..] => ([x, y, z], quat_normalize(quat)),
    }
}

//! Finds MIMo's lowest point and his self-penetrations.

use std::sync::Arc;

use super::ROOT;
use super::version::MIMO;
use crate::math::Vec3;
use crate::model::{EqualityKind, GeomType, Model};
use crate::physics::{Engine, EngineError, SoftEngine, SoftOptions, State};

/// Two interpenetrating geoms of MIMo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GeomOverlap {
    pub geoms: [usize; 2],
    /// Depth, m.
    pub depth: f64,
}

/// Returns the positions (nq) of a scene with its joints at the angles of its active constraints: `qpos0`, except among the cubes, where MIMo sits.
pub fn held_posture(model: &Model) -> Vec<f64> {
    let mut qpos = model.qpos0.clone();
    for (kind, _) in model
        .eq_kind
        .iter()
        .zip(&model.eq_active0)
        .filter(|(_, active)| **active)
    {
        if let &EqualityKind::Joint {
            joint1,
            joint2: None,
            polycoef,
        } = kind
        {
            // an equality on one joint counts from `qpos0`, as in MuJoCo
            qpos[model.jnt_qposadr[joint1]] += polycoef[0];
        }
    }
    qpos
}

/// Returns the state at the held posture.
fn at_rest(model: &Arc<Model>) -> Result<State, EngineError> {
    let mut engine = SoftEngine::new(model.clone(), SoftOptions::default());
    let mut state = engine.new_state();
    state.qpos = held_posture(model);
    engine.forward(&mut state)?;
    Ok(state)
}

/// Returns whether a geom is MIMo's.
fn own(model: &Model) -> impl Fn(&usize) -> bool {
    let hip = model.body(ROOT);
    move |g| hip.is_some_and(|hip| model.in_subtree(model.geom_bodyid[*g], hip))
}

/// Lists the geoms of MIMo that overlap at the held posture.
pub(super) fn overlaps(model: &Arc<Model>) -> Result<Vec<GeomOverlap>, EngineError> {
    let (state, own) = (at_rest(model)?, own(model));
    let inside = state.contact.iter().filter(|c| c.dist < 0.0 && c.geom.iter().all(&own));
    Ok(inside
        .map(|c| GeomOverlap {
            geoms: c.geom,
            depth: -c.dist,
        })
        .collect())
}

/// MIMo's lowest point at the held posture.
pub(super) struct LowestPoint {
    /// Height, m.
    pub height: f64,
    /// The upward direction in the frame of the body that holds `mimo_location`.
    pub up: Vec3,
}

impl LowestPoint {
    /// Finds the lowest point of MIMo's geoms; other bodies of the scene may reach lower.
    pub fn of(model: &Arc<Model>) -> Result<Self, EngineError> {
        let (state, own) = (at_rest(model)?, own(model));
        let bottom = |g: usize| {
            let mat = &state.geom_xmat[g];
            let down = reach(model.geom_type[g], model.geom_size[g], [mat[6], mat[7], mat[8]]);
            state.geom_xpos[g][2] - down
        };
        let around = model.body(MIMO).map_or(0, |body| model.body_parentid[body]);
        let mat = &state.xmat[around];
        Ok(Self {
            height: (0..model.ngeom()).filter(own).map(bottom).fold(f64::INFINITY, f64::min),
            up: [mat[6], mat[7], mat[8]],
        })
    }
}

/// Returns how far a shape reaches from its centre along a direction in its own frame, m.
pub(super) fn reach(kind: GeomType, size: [f64; 3], direction: Vec3) -> f64 {
    let [a, b, c] = size;
    let [x, y, z] = direction.map(f64::abs);
    match kind {
        GeomType::Plane => 0.0,
        GeomType::Sphere => a,
        GeomType::Capsule => a + b * z,
        // the rim of the disc at the end, which leans away from the direction
        GeomType::Cylinder => b * z + a * (1.0 - z * z).max(0.0).sqrt(),
        // the box around a mesh
        GeomType::Box | GeomType::HField | GeomType::Mesh => a * x + b * y + c * z,
        GeomType::Ellipsoid => ((a * x).powi(2) + (b * y).powi(2) + (c * z).powi(2)).sqrt(),
    }
}

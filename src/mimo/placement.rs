//! Where MIMo touches what is below him.

use std::sync::Arc;

use crate::math::Mat3;
use crate::model::{GeomType, Model};
use crate::physics::{Engine, EngineError, SoftEngine, SoftOptions};

/// Returns the height of MIMo's lowest point at `qpos0`, m.
pub(super) fn lowest_point(model: &Arc<Model>) -> Result<f64, EngineError> {
    let mut engine = SoftEngine::new(model.clone(), SoftOptions::default());
    let mut state = engine.new_state();
    engine.forward(&mut state)?;
    let hip = model.body("hip");
    let own = |g: &usize| hip.is_some_and(|hip| model.in_subtree(model.geom_bodyid[*g], hip));
    let bottom = |g: usize| {
        let down = reach_down(model.geom_type[g], model.geom_size[g], &state.geom_xmat[g]);
        state.geom_xpos[g][2] - down
    };
    Ok((0..model.ngeom()).filter(own).map(bottom).fold(f64::INFINITY, f64::min))
}

/// Returns how far a shape reaches below its centre, given its orientation in the world, m.
fn reach_down(kind: GeomType, size: [f64; 3], mat: &Mat3) -> f64 {
    let [a, b, c] = size;
    let [x, y, z] = [mat[6].abs(), mat[7].abs(), mat[8].abs()];
    match kind {
        GeomType::Plane => 0.0,
        GeomType::Sphere => a,
        GeomType::Capsule => a + b * z,
        GeomType::Cylinder => b * z + a * (1.0 - z * z).max(0.0).sqrt(),
        GeomType::Box => a * x + b * y + c * z,
        GeomType::Ellipsoid => ((a * x).powi(2) + (b * y).powi(2) + (c * z).powi(2)).sqrt(),
    }
}

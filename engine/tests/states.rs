//! A state of another model is refused wherever a simulation uses it.

use mjcf_sim::{Simulation, SimulationError};

#[test]
fn a_state_of_another_model_is_an_error_and_no_panic() -> Result<(), SimulationError> {
    let text = "<mujoco><worldbody><camera name='eye' pos='0 0 2'/><body name='a'><joint name='j'/><geom size='.1' pos='1 0 0'/></body>\
                </worldbody><actuator><motor name='m' joint='j'/></actuator><sensor><jointpos name='s' joint='j'/></sensor></mujoco>";
    let mut scene = Simulation::from_text(text)?;
    scene.state = Simulation::from_text("<mujoco/>")?.state;
    assert!(scene.sensor("s").is_err());
    assert!(scene.set_control("m", 1.0).is_err());
    assert!(scene.ray([0.0, 0.0, 2.0], [0.0, 0.0, -1.0]).is_err());
    assert!(scene.step().is_err());
    assert!(scene.forward().is_err());
    assert!(scene.draw(Some("eye"), 8, 8).is_err());
    assert!(scene.draw(None, 8, 8).is_err());
    Ok(())
}

#[test]
fn a_ray_that_is_not_finite_or_has_no_direction_meets_nothing() -> Result<(), SimulationError> {
    let mut scene = Simulation::from_text("<mujoco><worldbody><geom type='plane' size='1 1 1'/></worldbody></mujoco>")?;
    scene.forward()?;
    let down = [0.0, 0.0, -1.0];
    assert!(scene.ray([0.0, 0.0, 1.0], down)?.is_some());
    for (origin, direction) in [
        ([f64::NAN, 0.0, 1.0], down),
        ([0.0, 0.0, f64::INFINITY], down),
        ([0.0, 0.0, 1.0], [0.0; 3]),
        ([0.0, 0.0, 1.0], [0.0, 0.0, f64::NAN]),
        ([0.0, 0.0, 1e11], down),
    ] {
        assert_eq!(scene.ray(origin, direction)?, None, "{origin:?} {direction:?}");
    }
    Ok(())
}

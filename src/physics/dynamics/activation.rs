//! Activations of actuators: their rates, and one step in time.

use super::muscle;
use crate::math::MINVAL;
use crate::model::{DynType, Model};

/// Returns the time constant of an actuator's filter, s, which is never 0.
fn time_constant(model: &Model, actuator: usize) -> f64 {
    model.actuator_dynprm[actuator][0].max(MINVAL)
}

/// Returns the rate of an activation at a control.
pub fn rate(model: &Model, actuator: usize, act: f64, ctrl: f64) -> f64 {
    match model.actuator_dyntype[actuator] {
        DynType::None => 0.0,
        DynType::Integrator => ctrl,
        DynType::Filter | DynType::FilterExact => (ctrl - act) / time_constant(model, actuator),
        DynType::Muscle => muscle::rate(&model.actuator_dynprm[actuator], ctrl, act),
    }
}

/// Returns an activation after a time step, clamped to its limits. `rate` is its rate at the start of the step.
#[doc(alias = "mj_nextActivation")]
pub fn next(model: &Model, actuator: usize, act: f64, rate: f64) -> f64 {
    let h = model.opt.timestep;
    let next = match model.actuator_dyntype[actuator] {
        DynType::FilterExact => {
            let tau = time_constant(model, actuator);
            act + rate * tau * (1.0 - pxfm::f_exp(-h / tau))
        }
        _ => act + rate * h,
    };
    if model.actuator_actlimited[actuator] {
        let [low, high] = model.actuator_actrange[actuator];
        next.max(low).min(high)
    } else {
        next
    }
}

/// Returns the activation from which the force follows: the current one, or the next one if the actuator acts early.
pub fn acting(model: &Model, actuator: usize, act: f64, rate: f64) -> f64 {
    if model.actuator_actearly[actuator] {
        next(model, actuator, act, rate)
    } else {
        act
    }
}

/// Advances all activations by a time step.
pub fn advance(model: &Model, act: &mut [f64], act_dot: &[f64]) {
    // without actuators activations stand still, out of their limits, too
    if !model.opt.flags.actuation {
        return;
    }
    for (i, address) in model.actuator_actadr.iter().enumerate() {
        if let Some(k) = *address {
            // one whose group is off stands still, but within its limits
            let rate = if model.actuator_disabled(i) { 0.0 } else { act_dot[k] };
            act[k] = next(model, i, act[k], rate);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use crate::assets::MemoryAssets;
    use crate::mjcf_loader::load_str;
    use crate::model::Model;
    use crate::{Engine, SoftEngine, SoftOptions, compile};

    fn model(actuators: &str) -> Arc<Model> {
        let text = format!(
            "<mujoco><worldbody><body><joint name='j' type='slide' axis='1 0 0'/><geom size='.1' mass='2'/></body></worldbody>
             <actuator>{actuators}</actuator></mujoco>"
        );
        let model = load_str(&text, "m.xml", &MemoryAssets::new()).and_then(compile);
        Arc::new(model.unwrap_or_else(|e| panic!("{e}")))
    }

    fn soft(actuators: &str) -> SoftEngine {
        SoftEngine::new(model(actuators), SoftOptions::default())
    }

    const ALL: &str = "<motor joint='j'/><general joint='j' dyntype='integrator' actrange='-1 0.003'/>
        <general joint='j' dyntype='filter' dynprm='0.1'/><general joint='j' dyntype='filterexact' dynprm='0.1'/>
        <cylinder joint='j' timeconst='0.1' area='3' bias='1 0 0'/>";

    #[test]
    fn activations_follow_the_controls() {
        let mut engine = soft(ALL);
        assert_eq!(
            engine.model().actuator_actadr,
            [None, Some(0), Some(1), Some(2), Some(3)]
        );
        let mut state = engine.new_state();
        state.ctrl = vec![0.5, 1.0, 1.0, 1.0, 1.0];
        engine.step(&mut state).expect("a step");
        assert_eq!(state.act_dot, [1.0, 10.0, 10.0, 10.0]);
        let exact = 1.0 - (-0.02_f64).exp();
        assert_eq!(state.act[..2], [0.002, 0.02]);
        assert!((state.act[2] - exact).abs() < 1e-15, "{}", state.act[2]);
        // forces of the start of the step: the activations were 0, the last one has a bias
        assert_eq!(state.actuator_force, [0.5, 0.0, 0.0, 0.0, 1.0]);
        engine.step(&mut state).expect("a step");
        assert_eq!(state.act[0], 0.003, "the limit");
        assert_eq!(state.actuator_force[4], 3.0 * 0.02 + 1.0);
    }

    #[test]
    fn an_early_activation_acts_in_the_same_step() {
        let mut engine = soft("<general joint='j' dyntype='integrator' actearly='true' gainprm='2'/>");
        let mut state = engine.new_state();
        state.ctrl[0] = 1.0;
        engine.step(&mut state).expect("a step");
        assert_eq!((state.act[0], state.actuator_force[0]), (0.002, 0.004));
    }

    #[test]
    fn gains_and_damping_ratios_are_those_of_the_joint() {
        let mut engine = soft(
            "<damper joint='j' kv='3' gear='2' ctrlrange='0 1'/><position joint='j' kp='8' dampratio='0.5' gear='2'/>
             <velocity joint='j' kv='4'/>",
        );
        // 2 ratio sqrt(k m / gear^2) of a mass of 2 kg
        assert_eq!(engine.model().actuator_biasprm[1][..3], [0.0, -8.0, -2.0]);
        let mut state = engine.new_state();
        (state.qpos[0], state.qvel[0]) = (0.25, 0.5);
        state.ctrl = vec![0.5, 1.0, 2.0];
        engine.forward(&mut state).expect("forces");
        assert_eq!(
            state.actuator_force,
            [-3.0 * 1.0 * 0.5, 8.0 * (1.0 - 0.5) - 2.0, 4.0 * (2.0 - 0.5)]
        );
    }

    /// A copy of the dynamic state includes the activations.
    fn continues(engine: &mut impl Engine) {
        let mut state = engine.new_state();
        state.ctrl = vec![0.5, 1.0, 1.0, -1.0, 1.0];
        let mut copy = engine.new_state();
        for _ in 0..20 {
            engine.step(&mut state).expect("a step");
        }
        copy.copy_dynamic_from(&state);
        for state in [&mut state, &mut copy] {
            engine.step(state).expect("a step");
        }
        assert_eq!(
            (&copy.act, &copy.qpos, &copy.qvel),
            (&state.act, &state.qpos, &state.qvel)
        );
        assert!(state.act.iter().all(|act| *act != 0.0) && state.qvel[0] != 0.0);
    }

    #[test]
    fn a_copied_state_continues_its_activations() {
        continues(&mut soft(ALL));
    }

    #[test]
    fn a_state_without_room_for_activations_is_refused() {
        let mut engine = soft(ALL);
        let mut state = engine.new_state();
        state.act.clear();
        let error = engine.step(&mut state).expect_err("no activations");
        assert_eq!(
            error.to_string(),
            "state.act has 0 values but the model needs 4: build states with Engine::new_state"
        );
        let mut state = engine.new_state();
        state.act[1] = f64::NAN;
        assert!(engine.step(&mut state).is_err());
    }
}

//! Rooting: a touch beside the mouth turns the head to it.

use super::contacts::Watched;
use super::motors::{Motor, Motors};
use super::{Built, LoopInput, MotorCommand, ReflexLoop};
use crate::actuation::ActuationError;
use crate::math::{Vec3, add_scaled, dot, sub};
use crate::mimo::reflexes;
use crate::model::Model;
use crate::physics::State;

/// The direction of the mouth from the centre of the head, in its frame: 35 degrees below straight ahead. Our choice.
const MOUTH: Vec3 = [0.819_152_044_288_991_8, 0.0, -0.573_576_436_351_046];

struct Rooting {
    watched: Watched,
    neck: Motor,
    /// The mouth in the frame of the head, m, and the distance within which touches are beside it, m.
    mouth: Vec3,
    beside: f64,
}

/// Builds the loop.
///
/// # Errors
/// MIMo has no head, or no motor that turns it.
pub(super) fn build(motors: &Motors<'_>) -> Result<Built, ActuationError> {
    let model = motors.model;
    let head = model.body("head").ok_or_else(|| motors.missing("the body head"))?;
    let skull = model.body_geomadr[head];
    let radius = model.geom_size[skull][0];
    Ok(Built {
        inner: Box::new(Rooting {
            watched: Watched::new(model, |body| (body == "head").then_some(0)),
            neck: motors.need("head_swivel")?,
            mouth: add_scaled(model.geom_pos[skull], MOUTH, radius),
            beside: reflexes::BESIDE_MOUTH * radius,
        }),
        inside: 0.0,
    })
}

impl ReflexLoop for Rooting {
    fn channels(&self) -> usize {
        2
    }

    fn memory(&self) -> usize {
        2
    }

    /// Writes the forces beside the mouth, to its left and to its right, N; those of MIMo's own hands count in part.
    fn sense(&self, model: &Model, state: &State, stimulus: &mut [f64]) {
        stimulus.fill(0.0);
        self.watched.each(model, state, |pressed| {
            let away = sub(pressed.point, self.mouth);
            if dot(away, away) < self.beside * self.beside {
                let size = dot(pressed.force, pressed.force).sqrt();
                let share = if pressed.by_himself { reflexes::OWN_TOUCH } else { 1.0 };
                stimulus[usize::from(away[1] < 0.0)] += size * share;
            }
        });
    }

    fn act(&self, input: &mut LoopInput<'_>, commands: &mut [MotorCommand]) -> f64 {
        input.follow_stimuli(reflexes::ROOTING, reflexes::ROOTING_TIMES);
        // positive to the left
        let level = (input.memory[0] - input.memory[1]) * input.gain;
        let effort = level.abs().min(1.0);
        if effort > 0.0 {
            let angle = level.signum() * reflexes::ROOTING_TURN;
            self.neck
                .pull(input.state, angle, effort * reflexes::ROOTING_EFFORT, commands);
        }
        effort
    }
}

//! The palmar and the plantar grasp: pressure in the palm, or behind the toes, bends fingers or toes, for as long as it lasts.

use super::contacts::{Watched, side};
use super::motors::{Motor, Motors};
use super::{Built, LoopInput, MotorCommand, ReflexLoop};
use crate::actuation::ActuationError;
use crate::config::Part;
use crate::mimo::{body_kind, reflexes};
use crate::model::Model;
use crate::physics::State;

/// Motors that bend a hand or a foot, without the side, and the direction in which they bend it. Version 1 has the first of each list.
const FINGERS: [(&str, f64); 13] = [
    ("fingers", -1.0),
    ("ff_knuckle", 1.0),
    ("ff_middle", 1.0),
    ("ff_distal", 1.0),
    ("mf_knuckle", 1.0),
    ("mf_middle", 1.0),
    ("mf_distal", 1.0),
    ("rf_knuckle", 1.0),
    ("rf_middle", 1.0),
    ("rf_distal", 1.0),
    ("lf_knuckle", 1.0),
    ("lf_middle", 1.0),
    ("lf_distal", 1.0),
];
const TOES: [(&str, f64); 2] = [("toes", -1.0), ("big_toe", -1.0)];

struct Grasp {
    watched: Watched,
    /// The motors that bend the left and the right side, with their target angles, rad.
    motors: [Vec<(Motor, f64)>; 2],
    place: Place,
    /// Pressure at which it begins, and the further pressure at which it is full, N.
    force: [f64; 2],
}

/// Where pressure elicits the reflex.
enum Place {
    /// In the palm, whose side of the hand is left or right of the frame's x-z plane.
    Palm,
    /// Under the foot, in front of this place on the frame's x axis, m.
    Sole(f64),
}

/// Builds the loop of the palmar grasp.
///
/// # Errors
/// MIMo has no motors of fingers.
pub(super) fn palmar(motors: &Motors<'_>) -> Result<Built, ActuationError> {
    let hand = |body: &str| {
        let (side, _) = side(body)?;
        let part = body_kind(body)?.part;
        matches!(part, Part::Hands | Part::Fingers).then_some(side)
    };
    build(
        motors,
        Watched::new(motors.model, hand),
        &FINGERS,
        Place::Palm,
        reflexes::PALMAR,
    )
}

/// Builds the loop of the plantar grasp.
///
/// # Errors
/// MIMo has no motors of toes.
pub(super) fn plantar(motors: &Motors<'_>) -> Result<Built, ActuationError> {
    let foot = |body: &str| side(body).filter(|(_, name)| *name == "foot").map(|(side, _)| side);
    let toes = motors
        .model
        .body("left_toes")
        .ok_or_else(|| motors.missing("the body left_toes"))?;
    let ball = motors.model.body_pos[toes][0] * reflexes::BALL;
    build(
        motors,
        Watched::new(motors.model, foot),
        &TOES,
        Place::Sole(ball),
        reflexes::PLANTAR,
    )
}

fn build(
    motors: &Motors<'_>,
    watched: Watched,
    names: &[(&str, f64)],
    place: Place,
    force: [f64; 2],
) -> Result<Built, ActuationError> {
    let bends = |side: &str| -> Vec<(Motor, f64)> {
        let found = names.iter().filter_map(|(name, direction)| {
            let motor = motors.find(&format!("{side}_{name}"))?;
            let [low, high] = motor.range;
            let (from, to) = if *direction < 0.0 { (high, low) } else { (low, high) };
            Some((motor, from + reflexes::BEND * (to - from)))
        });
        found.collect()
    };
    let both = ["left", "right"].map(bends);
    if both.iter().any(Vec::is_empty) {
        let what = if matches!(place, Place::Palm) {
            "fingers"
        } else {
            "toes"
        };
        return Err(motors.missing(&format!("motors of {what}")));
    }
    Ok(Built {
        inner: Box::new(Grasp {
            watched,
            motors: both,
            place,
            force,
        }),
        inside: 0.0,
    })
}

impl ReflexLoop for Grasp {
    fn channels(&self) -> usize {
        2
    }

    fn memory(&self) -> usize {
        2
    }

    /// Writes the pressure on the left and on the right side, N.
    fn sense(&self, model: &Model, state: &State, stimulus: &mut [f64]) {
        stimulus.fill(0.0);
        self.watched.each(model, state, |pressed| {
            let pressure = match self.place {
                // the palm of the left hand is on the side of y
                Place::Palm if pressed.group == 0 => -pressed.force[1],
                Place::Palm => pressed.force[1],
                Place::Sole(ball) if pressed.point[0] > ball => pressed.force[2],
                Place::Sole(_) => 0.0,
            };
            stimulus[pressed.group] += pressure.max(0.0);
        });
    }

    fn act(&self, input: &mut LoopInput<'_>, commands: &mut [MotorCommand]) -> f64 {
        input.follow_stimuli(self.force, reflexes::GRASP_TIMES);
        let mut most: f64 = 0.0;
        for (level, motors) in input.memory.iter().zip(&self.motors) {
            let effort = (level * input.gain).min(1.0);
            if effort > 0.0 {
                for (motor, angle) in motors {
                    motor.pull(input.state, *angle, effort, commands);
                    // he cannot let go: the stronger the reflex, the less effect his action has
                    motor.suppress(effort, commands);
                }
            }
            most = most.max(effort);
        }
        most
    }
}

//! The errors of states and engines.

use thiserror::Error;

/// An error in advancing a state.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum EngineError {
    /// A vector of the state does not fit the model.
    #[error("state.{what} has {found} values but the model needs {expected}: build states with Engine::new_state")]
    Shape {
        /// Field.
        what: &'static str,
        /// Length found.
        found: usize,
        /// Length needed.
        expected: usize,
    },
    /// A number given to the engine is not finite.
    #[error("state.{what}[{index}] is {value}: only finite numbers can be simulated")]
    NotFinite {
        /// Field.
        what: &'static str,
        /// Position in the field.
        index: usize,
        /// The number.
        value: f64,
    },
    /// A force is applied to a body that does not exist.
    #[error("body {body} does not exist: the model has {count} bodies, numbered from 0")]
    NoBody {
        /// The requested body, by id.
        body: usize,
        /// Number of bodies.
        count: usize,
    },
    /// The keyframe does not exist.
    #[error("keyframe {key} does not exist: the model has {count}, numbered from 0")]
    NoKeyframe {
        /// The requested keyframe.
        key: usize,
        /// Number of keyframes.
        count: usize,
    },
    /// The mass or the size of a body that is attached to others cannot change.
    #[error(
        "the body {body:?} is not free: mass, inertia and size can change for bodies of the world with a free joint that carry \
         no other body"
    )]
    NotFree {
        /// Name of the body.
        body: String,
    },
    /// A body without geoms has no size.
    #[error("the body {body:?} has no geom whose size could change")]
    NoGeom {
        /// Name of the body.
        body: String,
    },
    /// A mass, an inertia or a size is not a positive number.
    #[error("{what}[{index}] is {value}: it must be finite and > 0")]
    NotPositive {
        /// Quantity.
        what: &'static str,
        /// Position in it.
        index: usize,
        /// The number.
        value: f64,
    },
    /// An engine has the parameters of the model built in.
    #[error("the engine cannot change params.{what}: use SoftEngine")]
    FixedParameter {
        /// Field of the parameters.
        what: &'static str,
    },
    /// A force applied to a body is not finite.
    #[error("{what}[{index}] is {value}: only finite forces, torques and points can be applied")]
    Applied {
        /// Vector at fault.
        what: &'static str,
        /// Position in it.
        index: usize,
        /// The number.
        value: f64,
    },
    /// A step exceeds a limit.
    #[error("more than {limit} {what} in step {step}: place the bodies apart, or let fewer of them touch")]
    TooMany {
        /// Steps done before.
        step: u64,
        /// The kind of item that exceeds the limit.
        what: &'static str,
        /// The limit, of [`mjcf_sim_model::Limits`].
        limit: usize,
    },
    /// The simulation diverged.
    #[error(
        "the simulation diverged in step {step} at joint {} ({what} = {value:e}): reset it, and use smaller actions, \
         forces or time steps", joint_text(.joint, *.number, .body)
    )]
    Diverged {
        /// Steps done before.
        step: u64,
        /// Name of the joint whose coordinate is out of bounds; may be empty.
        joint: String,
        /// Index of that joint.
        number: usize,
        /// Name of its body; may be empty.
        body: String,
        /// Quantity.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// The simulation diverged in a contact, although positions, velocities and accelerations are still finite.
    #[error(
        "the simulation diverged in step {step} where the geoms {} and {} touch (position or force is not a finite number): \
         make sizes, masses or speeds smaller", .geoms[0], .geoms[1]
    )]
    DivergedContact {
        /// Steps done before.
        step: u64,
        /// Names of the geoms, in quotes; the number of one without a name.
        geoms: [String; 2],
    },
}

/// Returns the name of a joint in quotes, or its number and its body if it has none.
fn joint_text(joint: &str, number: usize, body: &str) -> String {
    match (joint, body) {
        ("", "") => number.to_string(),
        ("", body) => format!("{number} of body {body:?}"),
        (joint, _) => format!("{joint:?}"),
    }
}

/// Checks a number against its limit.
pub(super) fn within(limit: usize, found: usize, what: &'static str, step: u64) -> Result<(), EngineError> {
    if found > limit {
        Err(EngineError::TooMany { step, what, limit })
    } else {
        Ok(())
    }
}

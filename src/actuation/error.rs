//! Errors of actuation models that do not fit a scene.

use thiserror::Error;

/// An error in driving an actuator: which one, and why.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ActuationError {
    /// The actuator is of the wrong kind.
    #[error("actuation_model {model} needs actuator {actuator:?} to be a {needs}")]
    Kind {
        /// Its name.
        actuator: String,
        /// The actuation model.
        model: &'static str,
        /// The expected value.
        needs: &'static str,
    },
    /// MIMo lacks what a reflex needs.
    #[error(
        "the reflex {reflex} needs {missing}, which this MIMo does not have: leave it out of `reflexes`, or keep the part (`act_...`)"
    )]
    Reflex {
        /// The reflex.
        reflex: &'static str,
        /// What is missing.
        missing: String,
    },
    /// A number of the actuator or of its joint is not allowed.
    #[error("actuator {actuator:?}: {what} is {value}, but must be {allowed}")]
    Parameter {
        /// Its name.
        actuator: String,
        /// The index of the number.
        what: &'static str,
        /// Its value; NaN when it is missing.
        value: f64,
        /// The allowed range.
        allowed: &'static str,
    },
}

//! Reasons why a body cannot grow.

use thiserror::Error;

use crate::config::MAX_AGE;

/// A reason why a body cannot grow.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum GrowthError {
    /// The age is out of range.
    #[error("`{key}`: {age} is not an age that MIMo can have; it must be from 0 to {MAX_AGE} months")]
    Age {
        /// Key of the configuration.
        key: &'static str,
        /// The requested age, months.
        age: f64,
    },
    /// No standard covers the age of a preterm infant.
    #[error("`{key}` is {age} and `gestation` is {gestation}, but {reason}")]
    Preterm {
        /// Key of the configuration.
        key: &'static str,
        /// The requested age, months.
        age: f64,
        /// Weeks of pregnancy.
        gestation: f64,
        /// Description of the gap, and the nearest age that is covered.
        reason: String,
    },
    /// Measurements make an impossible body.
    #[error("{keys}: at {age} months {reason}; change it, or leave it to the age")]
    Measurements {
        /// Keys of the configuration at fault, with their values.
        keys: String,
        /// Age, months.
        age: f64,
        /// Description of the fault.
        reason: String,
    },
    /// The scene lacks a part that grows.
    #[error("the scene's MIMo has no {what}, which `age` would change; its assets belong to another version of MIMo")]
    Missing {
        /// Kind and name of the element.
        what: String,
    },
}

/// Returns the error of a scene that lacks a part.
pub(super) fn missing(what: String) -> GrowthError {
    GrowthError::Missing { what }
}

/// Returns the error of a scene that lacks a geom.
pub(super) fn missing_geom(body: &str, index: usize) -> GrowthError {
    missing(format!("geom {index} of the body {body:?}"))
}

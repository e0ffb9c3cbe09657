//! The types of actuators: transmission, activation dynamics, gain and bias.

/// The target of an actuator: `actuator_trnid` is its id (MuJoCo's `mjtTrn`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TrnType {
    /// A joint.
    Joint,
    /// A joint, with forces in the frame of the parent: the same for joints of one coordinate.
    JointInParent,
    /// A slider-crank: two sites joined by a rod. The actuator moves one of them, the slider, along its z axis.
    SliderCrank,
    /// A tendon.
    Tendon,
    /// A site, on which six gears make a wrench, in its frame or that of a reference site.
    Site,
    /// The contacts of a body, which the actuator presses together.
    Body,
}

/// The dynamics of an actuator's activation, which replaces the control in the force.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DynType {
    /// No activation: the force follows from the control.
    None,
    /// The integral of the control over time, s.
    Integrator,
    /// A linear filter of the control with time constant `dynprm[0]`, s, integrated by Euler's method.
    Filter,
    /// The same filter, integrated exactly.
    FilterExact,
    /// A muscle's dynamics: a filter of the control, between 0 and 1, with time constants that depend on the activation: `dynprm` is that of
    /// activation and of deactivation, s, and the width of the transition between them.
    Muscle,
}

/// The type of an actuator's gain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GainType {
    /// `gainprm[0]`.
    Fixed,
    /// `gainprm[0] + gainprm[1] length + gainprm[2] velocity` (damper).
    Affine,
    /// The active force of a muscle. `gainprm` is its working range in optimal lengths (2), isometric force, N, or negative for
    /// `scale` over `actuator_acc0`, `scale`, shortest and longest length with an active force, optimal lengths, greatest speed,
    /// optimal lengths/s, passive force at the longest length and active force when stretched fastest, isometric forces.
    Muscle,
}

/// The type of an actuator's bias.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BiasType {
    /// No bias (motor).
    None,
    /// `biasprm[0] + biasprm[1] length + biasprm[2] velocity` (position servo).
    Affine,
    /// The passive force of a muscle; `biasprm` is as `gainprm` of [`GainType::Muscle`].
    Muscle,
}

//! The options of a simulation, and the statistics of a model.

use crate::math::Vec3;

/// The shape of the friction cones of contacts (`<option cone>`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ConeType {
    /// Pyramids: each contact has `2 (dim - 1)` edges, rows whose force is not negative. MuJoCo's default.
    #[default]
    Pyramidal,
    /// Elliptic cones: each contact has `dim` rows, the normal first.
    Elliptic,
}

/// The format of the constraint Jacobian in MuJoCo (`<option jacobian>`).
///
/// This engine has one format. The choice still decides which equalities without any effect MuJoCo keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum JacobianFormat {
    /// Dense matrices.
    Dense,
    /// Sparse matrices.
    Sparse,
    /// Sparse from 60 degrees of freedom on.
    #[default]
    Auto,
}

impl JacobianFormat {
    /// Returns whether MuJoCo stores the Jacobian of a model with `nv` degrees of freedom sparsely (`mj_isSparse`).
    pub fn is_sparse(self, nv: usize) -> bool {
        match self {
            Self::Dense => false,
            Self::Sparse => true,
            Self::Auto => nv >= 60,
        }
    }
}

/// The options of solver and integrator (`<option>`).
#[doc(alias = "mjOption")]
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Time step, s.
    pub timestep: f64,
    /// Gravity, m/s^2.
    pub gravity: Vec3,
    /// Greatest number of iterations of the solver per step.
    pub iterations: usize,
    /// Scaled improvement or gradient below which the solver stops.
    pub tolerance: f64,
    /// Greatest number of iterations of the solver against slip, which corrects friction after the main solver; 0 for none.
    pub noslip_iterations: usize,
    /// Scaled improvement below which it stops.
    pub noslip_tolerance: f64,
    /// Greatest number of line-search iterations per Newton iteration.
    pub ls_iterations: usize,
    /// Line-search tolerance.
    pub ls_tolerance: f64,
    /// Ratio of frictional to normal constraint impedance.
    pub impratio: f64,
    /// Shape of the friction cones.
    pub cone: ConeType,
    /// Format of the constraint Jacobian in MuJoCo.
    pub jacobian: JacobianFormat,
    /// Greatest number of iterations of the convex collision routine.
    pub ccd_iterations: usize,
    /// Tolerance of the convex collision routine, m.
    pub ccd_tolerance: f64,
    /// Solver of constraints.
    pub solver: SolverType,
    /// Method of integration.
    pub integrator: IntegratorType,
    /// Density of the medium around bodies, kg/m^3; 0 for none.
    pub density: f64,
    /// Viscosity of the medium around bodies, Pa s; 0 for none.
    pub viscosity: f64,
    /// Velocity of the medium, m/s.
    pub wind: Vec3,
    /// Magnetic flux, which magnetometers read.
    pub magnetic: Vec3,
    /// Groups of actuators that exert no force (`actuatorgroupdisable`): bit `k` is group `k`, from 0 to 30.
    pub disableactuator: u32,
    /// Parts of the simulation that may be switched off.
    pub flags: Flags,
}

impl Options {
    /// Returns the least time constant that a `solref` may have, s: two time steps, unless the flag `refsafe` is off.
    pub fn least_timeconst(&self) -> f64 {
        if self.flags.refsafe { 2.0 * self.timestep } else { 0.0 }
    }
}

/// The solver of constraints (`<option solver>`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum SolverType {
    /// Newton's method on the accelerations, with exact line search.
    #[default]
    Newton,
    /// Conjugate gradients (Polak and Ribiere) on the accelerations, with exact line search.
    Cg,
    /// Projected Gauss-Seidel on the forces.
    Pgs,
}

/// The method of integration (`<option integrator>`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum IntegratorType {
    /// Euler's semi-implicit method, with implicit joint damping.
    #[default]
    Euler,
    /// Euler's method, implicit in velocity: forces of the medium, of dampers, of actuators, of Coriolis.
    Implicit,
    /// The same without Coriolis forces.
    ImplicitFast,
    /// The fourth-order method of Runge and Kutta.
    Rk4,
}

/// The parts of a simulation that a document may switch off (`<option><flag>`); all except `multiccd` are on by default.
#[doc(alias = "mjtDisableBit")]
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flags {
    /// All constraints.
    pub constraint: bool,
    /// Equalities.
    pub equality: bool,
    /// Dry friction.
    pub frictionloss: bool,
    /// Limits of joints and tendons.
    pub limit: bool,
    /// Contacts.
    pub contact: bool,
    /// Springs, dampers, the medium, compensated gravity.
    pub passive: bool,
    /// Gravity.
    pub gravity: bool,
    /// Clamping of controls to their range.
    pub clampctrl: bool,
    /// Start of the solver from the last acceleration.
    pub warmstart: bool,
    /// Geoms of a body pass through those of its parent.
    pub filterparent: bool,
    /// Actuators.
    pub actuation: bool,
    /// Time constants of at least two time steps.
    pub refsafe: bool,
    /// Sensors.
    pub sensor: bool,
    /// Contacts of two bodies listed by the types of the geoms, not by their ids, without those of boxes, and of convex collision, whose bounding
    /// boxes are beyond the margin.
    pub midphase: bool,
    /// Implicit joint damping in Euler's method.
    pub eulerdamp: bool,
    /// MuJoCo's own convex collision, by GJK and EPA; without it Minkowski portal refinement, as in libccd.
    pub nativeccd: bool,
    /// Several contacts of a convex pair; off by default.
    pub multiccd: bool,
    /// Islands of bodies found one by one; off by default. Models in which it could make a difference, those with conjugate gradients, are refused.
    pub island: bool,
    /// Restart a simulation that diverges; on by default. It changes no motion here: a simulation that diverges is an error.
    pub autoreset: bool,
    /// Energies in every step; off by default. It changes no motion.
    pub energy: bool,
    /// Comparison of forward and inverse dynamics; off by default. It changes no motion.
    pub fwdinv: bool,
    /// Inverse dynamics of the integrator; off by default. It changes no motion.
    pub invdiscrete: bool,
}

/// The statistics of a model (`<statistic>`), given or computed.
#[doc(alias = "mjStatistic")]
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Statistic {
    /// Mean diagonal of the joint-space inertia, kg m^2.
    pub meaninertia: f64,
    /// Mean body mass, kg.
    pub meanmass: f64,
    /// Mean body size, m.
    pub meansize: f64,
    /// Spatial extent, m.
    pub extent: f64,
    /// Centre of the model, m.
    pub center: Vec3,
}

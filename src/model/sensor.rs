//! Types of sensors, with the kind of their objects and the number of their values.

/// Defines the types of sensors: MuJoCo's number, the name of the element, and the number and kind of the values.
macro_rules! sensors {
    ($($(#[$doc:meta])* $kind:ident = $code:literal, $name:literal, $dim:literal, $data:ident;)*) => {
        /// The type of a sensor.
        #[doc(alias = "mjtSensor")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum SensorType {
            $($(#[$doc])* $kind,)*
        }

        impl SensorType {
            /// Every type, in the order of MuJoCo's numbers.
            pub const ALL: &'static [Self] = &[$(Self::$kind),*];

            /// Returns the name of its element in a document.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$kind => $name,)* }
            }

            /// Returns MuJoCo's number of the type (`mjtSensor`).
            pub const fn code(self) -> i32 {
                match self { $(Self::$kind => $code,)* }
            }

            /// Returns the number of values of such a sensor; `sensor_dim` has that of a user sensor.
            pub const fn dim(self) -> usize {
                match self { $(Self::$kind => $dim,)* }
            }

            /// Returns the kind of its numbers, which determines how a cutoff acts on them.
            pub const fn datatype(self) -> DataType {
                match self { $(Self::$kind => DataType::$data,)* }
            }
        }
    };
}

sensors! {
    /// Sum of the normal forces of the contacts whose lines meet the volume of a site, N.
    Touch = 0, "touch", 1, Positive;
    /// Specific force at a site, m/s^2, site frame.
    Accelerometer = 1, "accelerometer", 3, Real;
    /// Velocity of a site, m/s, site frame.
    Velocimeter = 2, "velocimeter", 3, Real;
    /// Angular velocity at a site, rad/s, site frame.
    Gyro = 3, "gyro", 3, Real;
    /// Force that the parent exerts on the site's body, N, site frame.
    Force = 4, "force", 3, Real;
    /// Torque that the parent exerts on the site's body, N m, site frame.
    Torque = 5, "torque", 3, Real;
    /// Magnetic flux at a site, site frame.
    Magnetometer = 6, "magnetometer", 3, Real;
    /// Distance to the nearest geom along the z axis of a site, m; -1 where there is none.
    RangeFinder = 7, "rangefinder", 1, Positive;
    /// Position of a site in a camera's picture, pixels: to the right and down from the upper left corner.
    CamProjection = 8, "camprojection", 2, Real;
    /// Coordinate of a hinge or slide, rad or m.
    JointPos = 9, "jointpos", 1, Real;
    /// Velocity of a hinge or slide, rad/s or m/s.
    JointVel = 10, "jointvel", 1, Real;
    /// Length of a tendon.
    TendonPos = 11, "tendonpos", 1, Real;
    /// Rate of the length of a tendon.
    TendonVel = 12, "tendonvel", 1, Real;
    /// Length of an actuator.
    ActuatorPos = 13, "actuatorpos", 1, Real;
    /// Rate of the length of an actuator.
    ActuatorVel = 14, "actuatorvel", 1, Real;
    /// Force of an actuator.
    ActuatorFrc = 15, "actuatorfrc", 1, Real;
    /// Force of all actuators on a hinge or slide, N m or N.
    JointActFrc = 16, "jointactuatorfrc", 1, Real;
    /// Orientation of a ball joint as a quaternion.
    BallQuat = 17, "ballquat", 4, Quaternion;
    /// Angular velocity of a ball joint, rad/s, in the axes of its body.
    BallAngVel = 18, "ballangvel", 3, Real;
    /// Distance of a joint to its limit minus the margin, rad or m, while the limit is active; otherwise 0.
    JointLimitPos = 19, "jointlimitpos", 1, Real;
    /// Rate of that distance while the limit is active; otherwise 0.
    JointLimitVel = 20, "jointlimitvel", 1, Real;
    /// Force of the limit of a joint, N m or N.
    JointLimitFrc = 21, "jointlimitfrc", 1, Real;
    /// Distance of a tendon to its limit minus the margin while the limit is active; otherwise 0.
    TendonLimitPos = 22, "tendonlimitpos", 1, Real;
    /// Rate of that distance while the limit is active; otherwise 0.
    TendonLimitVel = 23, "tendonlimitvel", 1, Real;
    /// Force of the limit of a tendon.
    TendonLimitFrc = 24, "tendonlimitfrc", 1, Real;
    /// Position of an object, m, in the world or in the frame of a reference.
    FramePos = 25, "framepos", 3, Real;
    /// Orientation of an object as a quaternion, likewise.
    FrameQuat = 26, "framequat", 4, Quaternion;
    /// X axis of an object, likewise.
    FrameXAxis = 27, "framexaxis", 3, Axis;
    /// Y axis of an object, likewise.
    FrameYAxis = 28, "frameyaxis", 3, Axis;
    /// Z axis of an object, likewise.
    FrameZAxis = 29, "framezaxis", 3, Axis;
    /// Velocity of an object, m/s, in the axes of the world, or seen from the moving frame of a reference.
    FrameLinVel = 30, "framelinvel", 3, Real;
    /// Angular velocity of an object, rad/s, likewise.
    FrameAngVel = 31, "frameangvel", 3, Real;
    /// Acceleration of an object, m/s^2, upward where it stands still under gravity, in the axes of the world.
    FrameLinAcc = 32, "framelinacc", 3, Real;
    /// Angular acceleration of an object, rad/s^2, in the axes of the world.
    FrameAngAcc = 33, "frameangacc", 3, Real;
    /// Centre of mass of a body and those below it, m.
    SubtreeCom = 34, "subtreecom", 3, Real;
    /// Velocity of that centre of mass, m/s.
    SubtreeLinVel = 35, "subtreelinvel", 3, Real;
    /// Angular momentum of a body and those below it about that centre of mass, kg m^2/s.
    SubtreeAngMom = 36, "subtreeangmom", 3, Real;
    /// Least signed distance of two geoms, or of the geoms of bodies, m; the cutoff where that is greater.
    GeomDist = 37, "distance", 1, Positive;
    /// Direction from the first of these to the second, in the world; zero where they are further apart than the cutoff.
    GeomNormal = 38, "normal", 3, Axis;
    /// The points of both that are nearest to each other, m, in the world; zero likewise.
    GeomFromTo = 39, "fromto", 6, Real;
    /// Potential energy of gravity and springs, J.
    EPotential = 40, "e_potential", 1, Real;
    /// Energy of motion, J.
    EKinetic = 41, "e_kinetic", 1, Real;
    /// Time, s.
    Clock = 42, "clock", 1, Real;
    /// Values that a program writes: `sensor_dim` numbers, which no step changes.
    User = 44, "user", 0, Real;
}

impl SensorType {
    /// Returns MuJoCo's number of the stage of a step after which such a sensor can be read: 1 positions, 2 velocities, 3 accelerations.
    pub const fn needstage(self) -> usize {
        use SensorType::*;
        match self {
            Velocimeter | Gyro | JointVel | TendonVel | ActuatorVel | BallAngVel | JointLimitVel | TendonLimitVel
            | FrameLinVel | FrameAngVel | SubtreeLinVel | SubtreeAngMom => 2,
            Touch | Accelerometer | Force | Torque | ActuatorFrc | JointActFrc | JointLimitFrc | TendonLimitFrc
            | FrameLinAcc | FrameAngAcc | User => 3,
            _ => 1,
        }
    }
}

/// The kind of a sensor's numbers.
#[doc(alias = "mjtDataType")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DataType {
    /// Any numbers; a cutoff bounds both sides.
    Real,
    /// Numbers that a cutoff bounds only on the positive side.
    Positive,
    /// A unit vector, which has no cutoff.
    Axis,
    /// A unit quaternion, which has no cutoff.
    Quaternion,
}

/// The kind of an object that a sensor measures, or in whose frame it does.
#[doc(alias = "mjtObj")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ObjType {
    /// None.
    Unknown,
    /// A body, in the frame of its centre of mass and principal axes.
    Body,
    /// A body, in its own frame.
    XBody,
    /// A joint.
    Joint,
    /// A geom.
    Geom,
    /// A site.
    Site,
    /// A camera.
    Camera,
    /// A tendon.
    Tendon,
    /// An actuator.
    Actuator,
}

impl ObjType {
    /// Returns MuJoCo's number of the kind (`mjtObj`).
    pub const fn code(self) -> i32 {
        match self {
            Self::Unknown => 0,
            Self::Body => 1,
            Self::XBody => 2,
            Self::Joint => 3,
            Self::Geom => 5,
            Self::Site => 6,
            Self::Camera => 7,
            Self::Tendon => 18,
            Self::Actuator => 19,
        }
    }
}

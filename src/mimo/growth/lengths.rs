//! Body measurements over age, and the lengths from which MIMo is built.

use std::f64::consts::TAU;

use crate::config::Measurements;

/// The conversion of a measurement to a length of a model made of radii and half lengths.
#[derive(Clone, Copy)]
enum MeasurementKind {
    /// A circumference in cm gives a radius.
    Circumference,
    /// A length or breadth in cm gives its half.
    Length,
    /// A diameter in mm gives a radius.
    Millimetres,
}

impl MeasurementKind {
    /// Converts a measurement to a radius or half length, m.
    fn length(self, measurement: f64) -> f64 {
        match self {
            Self::Circumference => measurement / 100.0 / TAU,
            Self::Length => measurement / 100.0 / 2.0,
            Self::Millimetres => measurement / 1000.0 / 2.0,
        }
    }
}

/// What a measurement is scaled by in infants who differ from others of their age.
#[derive(Clone, Copy)]
enum ScaleKind {
    /// The factor on lengths.
    Long,
    /// The factor on girths and breadths.
    Girth,
    /// The head, which has a measurement of its own.
    Head,
}

/// Factors on the measurements of an age.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Factors {
    /// On lengths, that of the trunk included.
    pub length: f64,
    /// On girths and breadths.
    pub girth: f64,
    /// On the circumference of the head.
    pub head: f64,
}

impl Factors {
    /// Those of an infant as the formulas have him.
    pub const NONE: Self = Self {
        length: 1.0,
        girth: 1.0,
        head: 1.0,
    };

    fn of(&self, kind: ScaleKind) -> f64 {
        match kind {
            ScaleKind::Long => self.length,
            ScaleKind::Girth => self.girth,
            ScaleKind::Head => self.head,
        }
    }

    /// Returns the factor on heights in the trunk relative to its breadth: heights are lengths, and the breadth is a girth unless it is given.
    pub fn trunk(&self, given: &Measurements) -> f64 {
        let breadth = if given.hip_breadth.is_some() { 1.0 } else { self.girth };
        self.length / breadth
    }
}

/// Defines the measurements: per name, its form, what it is scaled by, and the coefficients of `a ln(age + b) + c`.
macro_rules! lengths {
    ($($name:ident, $form:ident, $scale:ident, $a:literal, $b:literal, $c:literal;)*) => {
        /// Radii and half lengths, m.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(super) struct Lengths {
            $(pub $name: f64,)*
        }

        impl Lengths {
            /// Returns the lengths at an age in months; given measurements replace those of the age.
            pub fn new(age: f64, given: &Measurements) -> Self {
                Self {
                    $($name: MeasurementKind::$form.length(given.$name.unwrap_or_else(|| $a * pxfm::f_log(age + $b) + $c)),)*
                }
            }

            /// Returns the lengths of an infant who differs from others; given measurements stay.
            pub fn scaled(&self, given: &Measurements, by: &Factors) -> Self {
                Self {
                    $($name: if given.$name.is_some() { self.$name } else { self.$name * by.of(ScaleKind::$scale) },)*
                }
            }
        }
    };
}

// Fits to the means of AnthroKids (1977) between birth and 33 months, by MIMo's authors (arXiv 2509.09805).
lengths! {
    ankle_circumference, Circumference, Girth, 1.4107782627464334, 0.784476040564327, 9.469892608634597;
    calf_circumference, Circumference, Girth, 2.156721075077345, 0.7477700715477089, 12.567056487136343;
    elbow_hand_length, Length, Long, 6.649244197461142, 10.672098608301102, -1.116669546093675;
    foot_breadth, Length, Girth, 3.137812149969795, 28.236151712915987, -6.896841220624604;
    foot_length, Length, Long, 6.915336579236893, 21.513614075129805, -13.159730009798846;
    forearm_circumference, Circumference, Girth, 1.0425480634537803, 0.10000000000000075, 11.800470420518526;
    hand_breadth, Length, Girth, 0.5576097173905573, 2.759629199815948, 3.011226156774235;
    hand_length, Length, Long, 1.807893920763198, 4.065326075899756, 3.8602500628577907;
    head_circumference, Circumference, Head, 3.422233376936088, 0.4314657418774473, 37.31165274139079;
    hip_breadth, Length, Girth, 1.4341760046387282, 0.10499418458476285, 12.989858733010582;
    knee_sole_length, Length, Long, 18.77345106119117, 36.83828214163621, -52.962767853311384;
    fist_breadth, Length, Girth, 0.6155603275345952, 1.638288223820883, 3.6143533500068163;
    thigh_circumference, Circumference, Girth, 7.152278614284938, 9.10593915972378, 1.40667810434768;
    middle_finger_diameter, Millimetres, Girth, 1.031915880660834, 1.980374141411991, 6.046550226166198;
    rump_knee_length, Length, Long, 2122.3908171324115, 5009.376435062313, -18066.617685980164;
    shoulder_elbow_length, Length, Long, 6.5045706363457585, 15.341494584054242, -6.973972371838398;
    thumb_diameter, Millimetres, Girth, 2.0557357666058156, 5.821313071039758, 4.696608780552676;
    upper_arm_circumference, Circumference, Girth, 1.1122546914444784, 0.10000000000000002, 11.760055532402925;
}

/// The head circumference of the infant on whose measurements MIMo's original proportions are based, cm.
const HEAD_CIRCUMFERENCE: f64 = 46.8;

impl Lengths {
    /// Returns the radius that stands for a head circumference in cm.
    pub fn head(circumference: f64) -> f64 {
        MeasurementKind::Circumference.length(circumference)
    }

    /// Returns the head circumference, cm, of a head whose geom has this radius, m.
    pub fn head_circumference_of(radius: f64) -> f64 {
        HEAD_CIRCUMFERENCE * radius / super::body::HEAD_RADIUS
    }

    /// Returns the lengths of the 18-month-old on whose measurements MIMo's original proportions are based.
    pub fn base() -> Self {
        let measured = Measurements {
            elbow_hand_length: Some(20.7),
            foot_breadth: Some(5.0),
            foot_length: Some(11.9),
            forearm_circumference: Some(14.5),
            hand_breadth: Some(4.6),
            hand_length: Some(9.3),
            head_circumference: Some(HEAD_CIRCUMFERENCE),
            hip_breadth: Some(17.1),
            knee_sole_length: Some(21.6),
            fist_breadth: Some(5.5),
            thigh_circumference: Some(24.4),
            rump_knee_length: Some(21.3),
            shoulder_elbow_length: Some(15.4),
            upper_arm_circumference: Some(14.7),
            ..Measurements::default() // the others enter by themselves, not as a ratio to the base
        };
        Self::new(18.0, &measured)
    }
}

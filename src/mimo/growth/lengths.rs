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

/// Defines the measurements: per name, its form, and the coefficients of `a ln(age + b) + c`.
macro_rules! lengths {
    ($($name:ident, $form:ident, $a:literal, $b:literal, $c:literal;)*) => {
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
        }
    };
}

// Fits to the means of AnthroKids (1977) between birth and 33 months, by MIMo's authors (arXiv 2509.09805).
lengths! {
    ankle_circumference, Circumference, 1.4107782627464334, 0.784476040564327, 9.469892608634597;
    calf_circumference, Circumference, 2.156721075077345, 0.7477700715477089, 12.567056487136343;
    elbow_hand_length, Length, 6.649244197461142, 10.672098608301102, -1.116669546093675;
    foot_breadth, Length, 3.137812149969795, 28.236151712915987, -6.896841220624604;
    foot_length, Length, 6.915336579236893, 21.513614075129805, -13.159730009798846;
    forearm_circumference, Circumference, 1.0425480634537803, 0.10000000000000075, 11.800470420518526;
    hand_breadth, Length, 0.5576097173905573, 2.759629199815948, 3.011226156774235;
    hand_length, Length, 1.807893920763198, 4.065326075899756, 3.8602500628577907;
    head_circumference, Circumference, 3.422233376936088, 0.4314657418774473, 37.31165274139079;
    hip_breadth, Length, 1.4341760046387282, 0.10499418458476285, 12.989858733010582;
    knee_sole_length, Length, 18.77345106119117, 36.83828214163621, -52.962767853311384;
    fist_breadth, Length, 0.6155603275345952, 1.638288223820883, 3.6143533500068163;
    thigh_circumference, Circumference, 7.152278614284938, 9.10593915972378, 1.40667810434768;
    middle_finger_diameter, Millimetres, 1.031915880660834, 1.980374141411991, 6.046550226166198;
    rump_knee_length, Length, 2122.3908171324115, 5009.376435062313, -18066.617685980164;
    shoulder_elbow_length, Length, 6.5045706363457585, 15.341494584054242, -6.973972371838398;
    thumb_diameter, Millimetres, 2.0557357666058156, 5.821313071039758, 4.696608780552676;
    upper_arm_circumference, Circumference, 1.1122546914444784, 0.10000000000000002, 11.760055532402925;
}

impl Lengths {
    /// Returns the lengths of the 18-month-old on whose measurements MIMo's original proportions are based.
    pub fn base() -> Self {
        let measured = Measurements {
            elbow_hand_length: Some(20.7),
            foot_breadth: Some(5.0),
            foot_length: Some(11.9),
            forearm_circumference: Some(14.5),
            hand_breadth: Some(4.6),
            hand_length: Some(9.3),
            head_circumference: Some(46.8),
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

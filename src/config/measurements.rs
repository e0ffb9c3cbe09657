//! Measurements of an infant's body that replace those of its age.

/// Measurements of an infant's body, as AnthroKids (1977) took them: cm, the two diameters of fingers mm. `None` leaves a
/// measurement to the age.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurements {
    /// Circumference of the ankle.
    pub ankle_circumference: Option<f64>,
    /// Circumference of the calf.
    pub calf_circumference: Option<f64>,
    /// Length from the elbow to the tip of the middle finger.
    pub elbow_hand_length: Option<f64>,
    /// Breadth of the fist.
    pub fist_breadth: Option<f64>,
    /// Breadth of the foot.
    pub foot_breadth: Option<f64>,
    /// Length of the foot.
    pub foot_length: Option<f64>,
    /// Circumference of the forearm.
    pub forearm_circumference: Option<f64>,
    /// Breadth of the hand.
    pub hand_breadth: Option<f64>,
    /// Length of the hand.
    pub hand_length: Option<f64>,
    /// Circumference of the head.
    pub head_circumference: Option<f64>,
    /// Breadth of the hip.
    pub hip_breadth: Option<f64>,
    /// Length from the knee to the sole.
    pub knee_sole_length: Option<f64>,
    /// Diameter of the middle finger, mm.
    pub middle_finger_diameter: Option<f64>,
    /// Length from the rump to the knee.
    pub rump_knee_length: Option<f64>,
    /// Length from the shoulder to the elbow.
    pub shoulder_elbow_length: Option<f64>,
    /// Circumference of the thigh, half way.
    pub thigh_circumference: Option<f64>,
    /// Diameter of the thumb, mm.
    pub thumb_diameter: Option<f64>,
    /// Circumference of the upper arm.
    pub upper_arm_circumference: Option<f64>,
}

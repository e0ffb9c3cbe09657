//! Values for each hand, and for each pair of an eye and a hand.

/// One value for each hand.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "eval", derive(serde::Serialize, serde::Deserialize))]
pub struct PerHand<T> {
    /// The right hand's.
    pub right_hand: T,
    /// The left hand's.
    pub left_hand: T,
}

impl<T> PerHand<T> {
    /// Computes the value of each hand: 0 is the right one, 1 the left one.
    pub fn from_fn(mut value: impl FnMut(usize) -> T) -> Self {
        Self {
            right_hand: value(0),
            left_hand: value(1),
        }
    }

    /// Returns the values, right hand first.
    pub fn each_ref(&self) -> [&T; 2] {
        [&self.right_hand, &self.left_hand]
    }

    /// Returns the values for writing, right hand first.
    pub fn each_mut(&mut self) -> [&mut T; 2] {
        [&mut self.right_hand, &mut self.left_hand]
    }
}

/// One value for each pair of an eye and a hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "eval", derive(serde::Serialize, serde::Deserialize))]
pub struct PerEyeAndHand<T> {
    /// Right eye, right hand.
    pub right_eye_right_hand: T,
    /// Right eye, left hand.
    pub right_eye_left_hand: T,
    /// Left eye, right hand.
    pub left_eye_right_hand: T,
    /// Left eye, left hand.
    pub left_eye_left_hand: T,
}

/// The names of the pairs of an eye and a hand, in the order of [`PerEyeAndHand::to_array`].
pub const EYE_HAND_PAIRS: [&str; 4] = [
    "right_eye_right_hand",
    "right_eye_left_hand",
    "left_eye_right_hand",
    "left_eye_left_hand",
];

impl<T> PerEyeAndHand<T> {
    /// Computes the value of each pair from the numbers of its eye and its hand: 0 is right, 1 is left.
    pub fn from_fn(mut value: impl FnMut(usize, usize) -> T) -> Self {
        Self {
            right_eye_right_hand: value(0, 0),
            right_eye_left_hand: value(0, 1),
            left_eye_right_hand: value(1, 0),
            left_eye_left_hand: value(1, 1),
        }
    }
}

impl<T: Copy> PerEyeAndHand<T> {
    /// Returns the values in the order of [`EYE_HAND_PAIRS`].
    pub fn to_array(self) -> [T; 4] {
        [
            self.right_eye_right_hand,
            self.right_eye_left_hand,
            self.left_eye_right_hand,
            self.left_eye_left_hand,
        ]
    }
}

impl<T> From<[T; 4]> for PerEyeAndHand<T> {
    fn from([a, b, c, d]: [T; 4]) -> Self {
        Self {
            right_eye_right_hand: a,
            right_eye_left_hand: b,
            left_eye_right_hand: c,
            left_eye_left_hand: d,
        }
    }
}

//! The eight groups of body parts for which touch, actuation and locks are switched.

/// A group of body parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Part {
    /// The keys `*_hands`.
    Hands,
    /// The keys `*_fingers`.
    Fingers,
    /// The keys `*_arms`.
    Arms,
    /// The keys `*_feet`.
    Feet,
    /// The keys `*_legs`.
    Legs,
    /// The keys `*_body`.
    Body,
    /// The keys `*_head`.
    Head,
    /// The keys `*_eyes`.
    Eyes,
}

impl Part {
    /// Every group, in the order of the API page.
    pub const ALL: [Self; 8] = [
        Self::Hands,
        Self::Fingers,
        Self::Arms,
        Self::Feet,
        Self::Legs,
        Self::Body,
        Self::Head,
        Self::Eyes,
    ];

    /// Returns the ending of the group's keys, such as `hands` in `touch_hands`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Hands => "hands",
            Self::Fingers => "fingers",
            Self::Arms => "arms",
            Self::Feet => "feet",
            Self::Legs => "legs",
            Self::Body => "body",
            Self::Head => "head",
            Self::Eyes => "eyes",
        }
    }
}

/// One value for each [`Part`].
///
/// ```
/// use babybench::config::{BodyParts, Part};
///
/// let act = BodyParts { eyes: false, ..BodyParts::all(true) };
/// assert!(act.get(Part::Hands));
/// assert_eq!(act.iter().filter(|(_, on)| **on).count(), 7);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct BodyParts<T> {
    /// Value of [`Part::Hands`].
    pub hands: T,
    /// Value of [`Part::Fingers`].
    pub fingers: T,
    /// Value of [`Part::Arms`].
    pub arms: T,
    /// Value of [`Part::Feet`].
    pub feet: T,
    /// Value of [`Part::Legs`].
    pub legs: T,
    /// Value of [`Part::Body`].
    pub body: T,
    /// Value of [`Part::Head`].
    pub head: T,
    /// Value of [`Part::Eyes`].
    pub eyes: T,
}

impl<T> BodyParts<T> {
    /// Creates the same value for every part.
    pub const fn all(value: T) -> Self
    where
        T: Copy,
    {
        Self {
            hands: value,
            fingers: value,
            arms: value,
            feet: value,
            legs: value,
            body: value,
            head: value,
            eyes: value,
        }
    }

    /// Returns a reference to the value of one part.
    pub fn get_ref(&self, part: Part) -> &T {
        match part {
            Part::Hands => &self.hands,
            Part::Fingers => &self.fingers,
            Part::Arms => &self.arms,
            Part::Feet => &self.feet,
            Part::Legs => &self.legs,
            Part::Body => &self.body,
            Part::Head => &self.head,
            Part::Eyes => &self.eyes,
        }
    }

    /// Returns a mutable reference to the value of one part.
    pub fn get_mut(&mut self, part: Part) -> &mut T {
        match part {
            Part::Hands => &mut self.hands,
            Part::Fingers => &mut self.fingers,
            Part::Arms => &mut self.arms,
            Part::Feet => &mut self.feet,
            Part::Legs => &mut self.legs,
            Part::Body => &mut self.body,
            Part::Head => &mut self.head,
            Part::Eyes => &mut self.eyes,
        }
    }

    /// Returns the value of one part.
    pub fn get(&self, part: Part) -> T
    where
        T: Copy,
    {
        *self.get_ref(part)
    }

    /// Iterates over the parts with their values, in the order of [`Part::ALL`].
    pub fn iter(&self) -> impl Iterator<Item = (Part, &T)> {
        Part::ALL.into_iter().map(|part| (part, self.get_ref(part)))
    }
}

impl BodyParts<bool> {
    /// Returns whether any part is on.
    pub fn any(&self) -> bool {
        self.iter().any(|(_, on)| *on)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn get_get_mut_and_iter_agree() {
        for part in Part::ALL {
            let mut parts = BodyParts::all(false);
            assert!(!parts.any());
            *parts.get_mut(part) = true;
            assert!(parts.get(part) && parts.any());
            let on: Vec<Part> = parts.iter().filter(|(_, on)| **on).map(|(part, _)| part).collect();
            assert_eq!(on, [part], "{}", part.name());
        }
    }
}

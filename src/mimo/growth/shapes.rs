//! The sizes and positions of MIMo's parts that growth changes.

use crate::math::Vec3;

/// A side of the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// The middle, which is not mirrored.
    Middle,
    /// Given for the left; the right is its mirror image.
    Both,
}

/// The size and the position of a geom, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GeomShape {
    /// Name of its body, without `left_`.
    pub body: &'static str,
    pub side: Side,
    /// Index among the geoms of the body.
    pub index: usize,
    pub size: Vec3,
    pub pos: Vec3,
}

/// The position of a body, joint or site in its body, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PartPosition {
    /// Name, without `left_` (and, for joints, without `robot:`).
    pub name: &'static str,
    pub side: Side,
    pub pos: Vec3,
}

/// All of a body's parts that growth changes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct BodyShapes {
    pub geoms: Vec<GeomShape>,
    pub bodies: Vec<PartPosition>,
    pub joints: Vec<PartPosition>,
    pub sites: Vec<PartPosition>,
}

impl BodyShapes {
    /// Adds the geoms of a body, in order: sizes and positions.
    pub fn geoms<const N: usize>(&mut self, side: Side, body: &'static str, geoms: [(Vec3, Vec3); N]) {
        let indexed = geoms.into_iter().enumerate();
        self.geoms.extend(indexed.map(|(index, (size, pos))| GeomShape {
            body,
            side,
            index,
            size,
            pos,
        }));
    }

    /// Adds the positions of bodies.
    pub fn bodies<const N: usize>(&mut self, side: Side, bodies: [(&'static str, Vec3); N]) {
        self.bodies.extend(places(side, bodies));
    }

    /// Adds the positions of joints.
    pub fn joints<const N: usize>(&mut self, side: Side, joints: [(&'static str, Vec3); N]) {
        self.joints.extend(places(side, joints));
    }
}

fn places<const N: usize>(side: Side, places: [(&'static str, Vec3); N]) -> impl Iterator<Item = PartPosition> {
    places
        .into_iter()
        .map(move |(name, pos)| PartPosition { name, side, pos })
}

/// Returns the size of a sphere.
pub(super) fn sphere(radius: f64) -> Vec3 {
    [radius, 0.0, 0.0]
}

/// Returns the size of a capsule or a cylinder.
pub(super) fn long(radius: f64, half_length: f64) -> Vec3 {
    [radius, half_length, 0.0]
}

/// Returns a position on the x axis.
pub(super) fn on_x(x: f64) -> Vec3 {
    [x, 0.0, 0.0]
}

/// Returns a position on the z axis.
pub(super) fn on_z(z: f64) -> Vec3 {
    [0.0, 0.0, z]
}

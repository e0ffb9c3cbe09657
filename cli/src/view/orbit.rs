//! A camera that users steer around a scene, and the mapping between its picture and the world.

use babybench::Env;
use babybench::math::{Mat3, Vec3, add_scaled, column, dot, sub};
use babybench::render::{FreeCamera, RenderError};

/// A camera that looks at a point. Positions in its picture are fractions of the picture's width and height, from the upper left corner.
pub struct Orbit {
    camera: FreeCamera,
}

/// The pose of the camera in one picture.
pub struct Lens {
    eye: Vec3,
    right: Vec3,
    up: Vec3,
    forward: Vec3,
    /// Height and width of the view at a distance of 1 m.
    high: f64,
    wide: f64,
}

impl Orbit {
    /// Returns a camera that looks at MIMo, or at the centre of a scene without him.
    pub fn new(env: &Env) -> Self {
        let hip = env.model().body("hip").and_then(|body| env.state().xpos.get(body));
        Self {
            camera: FreeCamera {
                lookat: hip.copied().unwrap_or(env.model().stat.center),
                distance: 1.3,
                azimuth: 140.0,
                elevation: -42.0,
            },
        }
    }

    /// Returns the camera.
    pub fn camera(&self) -> FreeCamera {
        self.camera
    }

    /// Turns around the point by degrees; the camera stays between straight down and just below the horizon.
    pub fn turn(&mut self, across: f64, down: f64) {
        self.camera.azimuth = (self.camera.azimuth - across) % 360.0;
        self.camera.elevation = (self.camera.elevation - down).clamp(-89.9, 10.0);
    }

    /// Moves the point with the picture, by fractions of its height.
    pub fn shift(&mut self, across: f64, down: f64, fovy: f64) -> Result<(), RenderError> {
        let lens = self.lens(fovy, 1.0)?;
        let height = lens.high * self.camera.distance;
        let moved = add_scaled(self.camera.lookat, lens.right, -across * height);
        self.camera.lookat = add_scaled(moved, lens.up, down * height).map(|v| v.clamp(-100.0, 100.0));
        Ok(())
    }

    /// Moves nearer or farther.
    pub fn zoom(&mut self, factor: f64) {
        self.camera.distance = (self.camera.distance * factor).clamp(0.1, 30.0);
    }

    /// Returns the pose of the camera, for a vertical field of view (degrees) and an aspect ratio, width over height.
    pub fn lens(&self, fovy: f64, aspect: f64) -> Result<Lens, RenderError> {
        let (eye, mat): (Vec3, Mat3) = self.camera.pose()?;
        let high = 2.0 * (fovy.to_radians() / 2.0).tan();
        Ok(Lens {
            eye,
            right: column(&mat, 0),
            up: column(&mat, 1),
            forward: column(&mat, 2).map(|v| -v),
            high,
            wide: high * aspect,
        })
    }
}

impl Lens {
    /// Returns the point of the world at a position in the picture and a distance (m) from the camera's plane.
    pub fn place(&self, [x, y]: [f64; 2], depth: f64) -> Vec3 {
        let middle = add_scaled(self.eye, self.forward, depth);
        let across = add_scaled(middle, self.right, (x - 0.5) * self.wide * depth);
        add_scaled(across, self.up, (0.5 - y) * self.high * depth)
    }

    /// Returns the position in the picture of a point of the world, and its distance (m) from the camera's plane; `None` behind the camera.
    pub fn seen(&self, point: Vec3) -> Option<([f64; 2], f64)> {
        let arm = sub(point, self.eye);
        let depth = dot(arm, self.forward);
        if depth < 0.01 {
            return None;
        }
        let x = 0.5 + dot(arm, self.right) / (self.wide * depth);
        let y = 0.5 - dot(arm, self.up) / (self.high * depth);
        Some(([x, y], depth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_points_are_each_others_inverse() {
        let mut orbit = Orbit {
            camera: FreeCamera {
                lookat: [0.1, -0.2, 0.3],
                distance: 1.4,
                azimuth: 40.0,
                elevation: -25.0,
            },
        };
        let middle = orbit.lens(45.0, 1.5).expect("a camera").place([0.5, 0.5], 1.4);
        for (a, b) in middle.iter().zip([0.1, -0.2, 0.3]) {
            assert!((a - b).abs() < 1e-12, "{middle:?}");
        }
        orbit.turn(30.0, 500.0);
        assert_eq!(orbit.camera.elevation, -89.9);
        orbit.turn(0.0, -40.0);
        orbit.shift(0.1, 0.2, 45.0).expect("a camera");
        orbit.zoom(0.5);
        let lens = orbit.lens(45.0, 1.5).expect("a camera");
        let (place, depth) = lens.seen(lens.place([0.2, 0.9], 1.7)).expect("in front");
        assert!((place[0] - 0.2).abs() < 1e-12 && (place[1] - 0.9).abs() < 1e-12 && (depth - 1.7).abs() < 1e-12);
        assert!(lens.seen(lens.place([0.5, 0.5], -1.0)).is_none());
    }
}

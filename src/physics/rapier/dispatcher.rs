//! The contact routines as a query dispatcher of Rapier.

use rapier3d_f64::parry::math::{Mat3 as ParryMat3, Pose, Vector};
use rapier3d_f64::parry::query::details::NormalConstraints;
use rapier3d_f64::parry::query::{
    ClosestPoints, Contact, ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, NonlinearRigidMotion,
    PersistentQueryDispatcher, QueryDispatcher, ShapeCastHit, ShapeCastOptions, ShapeDistance, ShapeIntersection,
    TrackedContact, Unsupported,
};
use rapier3d_f64::parry::shape::{PackedFeatureId, Shape, TypedShape};

use crate::hull::{HullShape, plain};
use mjcf_sim_model::math::{MAT3_ID, Mat3, Vec3, add_scaled};
use mjcf_sim_model::model::GeomType;
use mjcf_sim_physics::contact::{ContactOptions, ContactPoint, PlacedGeom, Scratch, bounding_test, collide};

/// A query dispatcher with the contact manifolds of [`mjcf_sim_physics::contact`], and Parry's for everything else.
///
/// It keeps no memory of earlier steps, unlike Parry's own manifolds, and ignores the prediction distance: a contact is
/// a contact when the shapes touch. Points come in the same order as from [`collide`]; those of one normal share a
/// manifold.
#[derive(Clone, Copy, Debug)]
pub struct ContactDispatcher {
    options: ContactOptions,
    split: bool,
}

impl ContactDispatcher {
    /// Creates a dispatcher with the given options.
    pub fn new(options: ContactOptions) -> Self {
        Self { options, split: false }
    }

    /// Creates a separate manifold for each point, with the point's place in the list of the pair as `subshape1`.
    /// Rapier's solver uses at most four points of a manifold; the contact routines find up to 24.
    pub fn one_point_manifolds(self) -> Self {
        Self { split: true, ..self }
    }
}

/// Describes a shape as the contact routines see it: type, size, bounding radius, and whether its frame differs from
/// the collider's (Parry's cylinders stand along y).
fn describe(shape: &dyn Shape) -> Option<(GeomType, Vec3, f64, bool)> {
    if let Some(hull) = shape.as_shape::<HullShape>() {
        return Some((GeomType::Mesh, [0.0; 3], hull.radius(), false));
    }
    Some(match shape.as_typed_shape() {
        TypedShape::HalfSpace(_) => (GeomType::Plane, [0.0; 3], 0.0, false),
        TypedShape::Ball(b) => (GeomType::Sphere, [b.radius, 0.0, 0.0], b.radius, false),
        TypedShape::Capsule(c) => {
            let half = c.segment.b.z;
            (GeomType::Capsule, [c.radius, half, 0.0], c.radius + half, false)
        }
        TypedShape::Cylinder(c) => {
            let (r, h) = (c.radius, c.half_height);
            (GeomType::Cylinder, [r, h, 0.0], (r * r + h * h).sqrt(), true)
        }
        TypedShape::Cuboid(c) => {
            let h = c.half_extents;
            (GeomType::Box, [h.x, h.y, h.z], h.length(), false)
        }
        _ => return None,
    })
}

/// Converts a collider's rotation to the geom's: columns are the local axes. A cylinder's z axis is the collider's y
/// axis.
fn geom_mat(m: ParryMat3, upright: bool) -> Mat3 {
    let (x, y, z) = if upright {
        (m.x_axis, -m.z_axis, m.y_axis)
    } else {
        (m.x_axis, m.y_axis, m.z_axis)
    };
    [x.x, y.x, z.x, x.y, y.y, z.y, x.z, y.z, z.z]
}

fn vector(v: Vec3) -> Vector {
    Vector::new(v[0], v[1], v[2])
}

impl ContactDispatcher {
    /// Finds contacts in the frame of the first shape; `None` when a shape is not one of the model's.
    fn points<'s>(&self, pos12: &Pose, g1: &'s dyn Shape, g2: &'s dyn Shape) -> Option<(Vec<ContactPoint>, bool)> {
        let (kind1, size1, radius1, upright1) = describe(g1)?;
        let (kind2, size2, radius2, upright2) = describe(g2)?;
        let mat1 = if upright1 {
            geom_mat(ParryMat3::IDENTITY, true)
        } else {
            MAT3_ID
        };
        let mat2 = geom_mat(ParryMat3::from_quat(pos12.rotation), upright2);
        let t = pos12.translation;
        let mesh = |shape: &'s dyn Shape| shape.as_shape::<HullShape>().map(|hull| &*hull.mesh);
        let first = PlacedGeom {
            kind: kind1,
            size: size1,
            pos: [0.0; 3],
            mat: &mat1,
            mesh: mesh(g1),
            hfield: None,
        };
        let second = PlacedGeom {
            kind: kind2,
            size: size2,
            pos: [t.x, t.y, t.z],
            mat: &mat2,
            mesh: mesh(g2),
            hfield: None,
        };
        let flipped = kind1 > kind2;
        let ((a, ra), (b, rb)) = if flipped {
            ((second, radius2), (first, radius1))
        } else {
            ((first, radius1), (second, radius2))
        };
        let mut points = Vec::new();
        if bounding_test(&a, ra, &b, rb, 0.0) {
            collide(&a, &b, 0.0, &self.options, &mut Scratch::new(), &mut points);
        }
        Some((points, flipped))
    }
}

impl<M: Default + Clone, C: Default + Copy> PersistentQueryDispatcher<M, C> for ContactDispatcher
where
    DefaultQueryDispatcher: PersistentQueryDispatcher<M, C>,
{
    fn contact_manifolds(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: f64,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        let Some((points, flipped)) = self.points(pos12, g1, g2) else {
            let (g1, g2) = (plain(g1), plain(g2));
            return DefaultQueryDispatcher.contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
        };
        for m in manifolds.iter_mut() {
            m.points.clear();
            (m.local_n1, m.local_n2) = (Vector::ZERO, Vector::ZERO);
        }
        let mut used = 0;
        let mut last_normal = None;
        for p in &points {
            let normal = if flipped { p.normal().map(|v| -v) } else { p.normal() };
            if self.split || last_normal != Some(normal) {
                if manifolds.len() == used {
                    manifolds.push(ContactManifold::with_data(0, 1, M::default()));
                }
                let m = &mut manifolds[used];
                if self.split {
                    m.subshape1 = used as u32;
                }
                m.local_n1 = vector(normal);
                m.local_n2 = pos12.rotation.inverse() * -vector(normal);
                last_normal = Some(normal);
                used += 1;
            }
            let on1 = vector(add_scaled(p.pos, normal, -0.5 * p.dist));
            let on2 = pos12.inverse_transform_point(vector(add_scaled(p.pos, normal, 0.5 * p.dist)));
            let id = PackedFeatureId::UNKNOWN;
            manifolds[used - 1]
                .points
                .push(TrackedContact::new(on1, on2, id, id, p.dist));
        }
        Ok(())
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        normals1: Option<&dyn NormalConstraints>,
        normals2: Option<&dyn NormalConstraints>,
        prediction: f64,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        DefaultQueryDispatcher.contact_manifold_convex_convex(pos12, g1, g2, normals1, normals2, prediction, manifold)
    }
}

impl QueryDispatcher for ContactDispatcher {
    fn intersection_test(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        DefaultQueryDispatcher.intersection_test(pos12, plain(g1), plain(g2))
    }

    fn distance(&self, pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Result<ShapeDistance, Unsupported> {
        DefaultQueryDispatcher.distance(pos12, plain(g1), plain(g2))
    }

    fn contact(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: f64,
    ) -> Result<Option<Contact>, Unsupported> {
        DefaultQueryDispatcher.contact(pos12, plain(g1), plain(g2), prediction)
    }

    fn closest_points(
        &self,
        pos12: &Pose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: f64,
    ) -> Result<ClosestPoints, Unsupported> {
        DefaultQueryDispatcher.closest_points(pos12, plain(g1), plain(g2), max_dist)
    }

    fn cast_shapes(
        &self,
        pos12: &Pose,
        velocity: Vector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes(pos12, velocity, plain(g1), plain(g2), options)
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start: f64,
        end: f64,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        let (g1, g2) = (plain(g1), plain(g2));
        DefaultQueryDispatcher.cast_shapes_nonlinear(motion1, g1, motion2, g2, start, end, stop_at_penetration)
    }
}

//! Meshes as shapes for Parry: their convex hulls, which also store the meshes that the contact routines need.

use std::sync::Arc;

use rapier3d_f64::geometry::SharedShape;
use rapier3d_f64::parry::bounding_volume::{Aabb, BoundingSphere};
use rapier3d_f64::parry::mass_properties::MassProperties;
use rapier3d_f64::parry::math::Vector;
use rapier3d_f64::parry::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use rapier3d_f64::parry::shape::{FeatureId, Shape, ShapeType, SupportMap, TypedShape};

use mjcf_sim_model::math::Vec3;
use mjcf_sim_model::model::Mesh;

/// The convex hull of a mesh.
#[derive(Clone)]
pub(super) struct HullShape {
    pub mesh: Arc<Mesh>,
    /// Parry's hull, or a box if it finds none.
    parry: SharedShape,
}

impl HullShape {
    /// Makes the shape of a mesh, or of a box of these half lengths if Parry finds no hull.
    pub fn shared(mesh: &Mesh, half: Vec3) -> SharedShape {
        let corners = mesh.hull.iter().flat_map(|hull| &hull.vert);
        let places = corners.filter_map(|&v| mesh.vert.get(v as usize));
        let places: Vec<Vector> = places
            .map(|v| Vector::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2])))
            .collect();
        let hull = if places.is_empty() {
            None
        } else {
            SharedShape::convex_hull(&places)
        };
        SharedShape::new(Self {
            mesh: Arc::new(mesh.clone()),
            parry: hull.unwrap_or_else(|| SharedShape::cuboid(half[0], half[1], half[2])),
        })
    }

    /// Returns the radius of a sphere about the origin that contains the mesh, m.
    pub fn radius(&self) -> f64 {
        let [low, high] = self.mesh.bounds;
        let most = |k: usize| low[k].abs().max(high[k].abs());
        (0..3).map(|k| most(k) * most(k)).sum::<f64>().sqrt()
    }
}

/// Returns a shape that Parry supports: the substitute for a mesh, or the shape itself.
pub(super) fn plain(shape: &dyn Shape) -> &dyn Shape {
    match shape.as_shape::<HullShape>() {
        Some(hull) => &*hull.parry,
        None => shape,
    }
}

impl RayCast for HullShape {
    fn cast_local_ray_and_get_normal(&self, ray: &Ray, most: f64, solid: bool) -> Option<RayIntersection> {
        self.parry.cast_local_ray_and_get_normal(ray, most, solid)
    }
}

impl PointQuery for HullShape {
    fn project_local_point(&self, point: Vector, solid: bool) -> PointProjection {
        self.parry.project_local_point(point, solid)
    }

    fn project_local_point_and_get_feature(&self, point: Vector) -> (PointProjection, FeatureId) {
        self.parry.project_local_point_and_get_feature(point)
    }
}

impl Shape for HullShape {
    fn compute_local_aabb(&self) -> Aabb {
        self.parry.compute_local_aabb()
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.parry.compute_local_bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, scale: Vector, num_subdivisions: u32) -> Option<Box<dyn Shape>> {
        self.parry.scale_dyn(scale, num_subdivisions)
    }

    fn mass_properties(&self, density: f64) -> MassProperties {
        self.parry.mass_properties(density)
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> f64 {
        self.parry.ccd_thickness()
    }

    fn ccd_angular_thickness(&self) -> f64 {
        self.parry.ccd_angular_thickness()
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        self.parry.as_support_map()
    }
}

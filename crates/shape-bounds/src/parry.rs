//! Bounds as shapes of parry3d: any [`ConvexBody`] in its queries, by its farthest points, without a mesh between.
//!
//! ```
//! use glam::DVec3;
//! use parry3d_f64::math::Pose;
//! use parry3d_f64::query::distance;
//! use parry3d_f64::shape::Ball;
//! use shape_bounds::curvature::RoundedHull;
//! use shape_bounds::parry::ParryBody;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A rod of radius 0.1, two metres beside a ball: how far they are from each other.
//! let rod = ParryBody::new(RoundedHull::of(&[DVec3::ZERO, DVec3::Z], 0.1)?);
//! let beside = Pose::from_translation(DVec3::new(2.0, 0.0, 0.5));
//! let found = distance(&Pose::IDENTITY, &rod, &beside, &Ball::new(0.5))?.distance;
//! assert!((found - 1.4).abs() < 1e-6);
//! # Ok(())
//! # }
//! ```

use crate::body::ConvexBody;
use glam::DVec3;
use parry3d_f64::bounding_volume::details::local_support_map_aabb;
use parry3d_f64::bounding_volume::{Aabb, BoundingSphere};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::query::details::local_ray_intersection_with_support_map_with_params;
use parry3d_f64::query::gjk::VoronoiSimplex;
use parry3d_f64::query::point::local_point_projection_on_support_map;
use parry3d_f64::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use parry3d_f64::shape::{FeatureId, Shape, ShapeType, SupportMap, TypedShape};
use std::sync::Arc;

/// Polytopes from which mass is told are this close to the body, in its sizes.
const FACETED: f64 = 1e-3;

/// A convex body as a shape of parry3d; clones share it.
#[derive(Debug)]
pub struct ParryBody<B>(Arc<B>);

impl<B> Clone for ParryBody<B> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<B: ConvexBody> ParryBody<B> {
    /// Takes a body.
    #[must_use]
    pub fn new(body: B) -> Self {
        Self(Arc::new(body))
    }

    /// The body.
    #[must_use]
    pub fn body(&self) -> &B {
        &self.0
    }
}

impl<B: ConvexBody> SupportMap for ParryBody<B> {
    fn local_support_point(&self, direction: DVec3) -> DVec3 {
        self.0.climb()(if direction == DVec3::ZERO { DVec3::X } else { direction })
    }
}

impl<B: ConvexBody> RayCast for ParryBody<B> {
    fn cast_local_ray_and_get_normal(&self, ray: &Ray, most: f64, solid: bool) -> Option<RayIntersection> {
        let simplex = &mut VoronoiSimplex::new();
        local_ray_intersection_with_support_map_with_params(self, simplex, ray, most, solid)
    }
}

impl<B: ConvexBody> PointQuery for ParryBody<B> {
    fn project_local_point(&self, point: DVec3, solid: bool) -> PointProjection {
        if solid && self.0.contains(point) {
            return PointProjection::new(true, point);
        }
        local_point_projection_on_support_map(self, &mut VoronoiSimplex::new(), point, solid)
    }

    fn project_local_point_and_get_feature(&self, point: DVec3) -> (PointProjection, FeatureId) {
        (self.project_local_point(point, false), FeatureId::Unknown)
    }

    fn contains_local_point(&self, point: DVec3) -> bool {
        self.0.contains(point)
    }
}

impl<B: ConvexBody + Send + Sync + 'static> Shape for ParryBody<B> {
    fn compute_local_aabb(&self) -> Aabb {
        local_support_map_aabb(self)
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.compute_local_aabb().bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    /// None: a bound holds for the body as it is.
    fn scale_dyn(&self, _scale: DVec3, _subdivisions: u32) -> Option<Box<dyn Shape>> {
        None
    }

    /// Those of a polytope inside of it; of a body without interior or end, none.
    fn mass_properties(&self, density: f64) -> MassProperties {
        let size = self.compute_local_aabb().half_extents().max_element();
        let inside = self.0.faceted(FACETED * size).ok();
        let mesh = inside.and_then(|bounds| bounds.lower().solid().map(exact_hull::SolidHull::mesh));
        mesh.map_or_else(MassProperties::default, |mesh| {
            MassProperties::from_convex_polyhedron(density, &mesh.vertices, &mesh.triangles)
        })
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> f64 {
        self.compute_local_aabb().half_extents().min_element()
    }

    fn ccd_angular_thickness(&self) -> f64 {
        std::f64::consts::FRAC_PI_4
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::OfSupport;
    use crate::curvature::RoundedHull;
    use contact_kinematics::Ellipsoid;
    use parry3d_f64::math::Pose;
    use parry3d_f64::query::{self, Contact};
    use parry3d_f64::shape::{Ball, Capsule, Cuboid};

    /// A rod as ours is parry's capsule: distances, contacts, rays, points and mass.
    #[test]
    fn a_rod_is_a_capsule() {
        let ours = ParryBody::new(RoundedHull::of(&[DVec3::ZERO, DVec3::Z], 0.2).unwrap());
        let theirs = Capsule::new(DVec3::ZERO, DVec3::Z, 0.2);
        let shapes: [&dyn Shape; 2] = [&ours, &theirs];
        for k in 0..20 {
            let turn = f64::from(k) * 0.37;
            let at = Pose::new(
                DVec3::new(1.5 * turn.cos(), 1.5 * turn.sin(), 0.1 * turn),
                DVec3::new(0.3, turn, -0.2),
            );
            for other in [&Cuboid::new(DVec3::new(0.3, 0.2, 0.4)) as &dyn Shape, &Ball::new(0.3)] {
                let [a, b] =
                    shapes.map(|rod| query::distance(&Pose::IDENTITY, rod, &at, other).unwrap().distance);
                assert!((a - b).abs() < 1e-6 && a > 0.1, "{a} {b}");
                let near: [Option<Contact>; 2] =
                    shapes.map(|rod| query::contact(&Pose::IDENTITY, rod, &at, other, 3.0).unwrap());
                let [a, b] = near.map(|contact| contact.unwrap());
                assert!(
                    (a.dist - b.dist).abs() < 1e-6 && a.normal1.distance(b.normal1) < 1e-3,
                    "{a:?} {b:?}"
                );
            }
            let ray = Ray::new(at.translation, DVec3::Z * 0.5 - at.translation);
            let [a, b] = shapes.map(|rod| rod.cast_local_ray(&ray, 10.0, true).unwrap());
            assert!((a - b).abs() < 1e-6, "{a} {b}");
            let [a, b] = shapes.map(|rod| rod.project_local_point(at.translation, true).point);
            assert!(a.distance(b) < 1e-6, "{a} {b}");
        }
        let [a, b] = shapes.map(|rod| rod.mass_properties(2.0));
        assert!((a.mass() - b.mass()).abs() < 0.01 * b.mass() && (a.local_com - b.local_com).length() < 1e-3);
        assert!(
            shapes
                .map(|rod| rod.compute_local_aabb())
                .windows(2)
                .all(|w| w[0].mins.distance(w[1].mins) < 1e-12)
        );
        assert!(ours.contains_local_point(DVec3::Z * 1.19) && !ours.contains_local_point(DVec3::Z * 1.21));
    }

    /// Two that overlap are told to, and fits are bodies as well.
    #[test]
    fn an_ellipsoid_touches_a_box() {
        let egg = ParryBody::new(OfSupport(Ellipsoid::new(DVec3::new(0.5, 0.3, 0.2)).unwrap()));
        let flat = Cuboid::new(DVec3::new(1.0, 1.0, 0.1));
        for (height, touches) in [(0.301, false), (0.299, true)] {
            let at = Pose::from_translation(DVec3::Z * height);
            assert_eq!(
                query::intersection_test(&Pose::IDENTITY, &flat, &at, &egg).unwrap().intersecting,
                touches
            );
        }
    }
}

//! Guaranteed inner and outer bounds on a convex body from contact points and normals.

#[cfg(any(test, feature = "generators"))]
pub mod generators;
mod hull;
mod integrals;
mod mesh;
mod planar;
mod predicates;
mod random;

pub use hull::{Hull, HullCertificate, PointsError, SolidHull};
pub use integrals::SolidMoments;
pub use mesh::TriangleMesh;

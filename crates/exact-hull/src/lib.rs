//! Hull.

pub mod delaunay;
#[cfg(any(test, feature = "generators"))]
pub mod generators;
mod half_space;
mod halfspaces;
mod hull;
mod integrals;
mod mesh;
#[cfg(feature = "parry")]
mod parry;
pub mod planar;
pub mod predicates;
mod random;
mod scaled;
mod twofold;

pub use half_space::HalfSpace;
pub use halfspaces::{Caps, IncrementalIntersection, Intersection, IntersectionError, Polyhedron, Unbounded};
pub use hull::{
    Farthest, Hull, HullCertificate, IncrementalHull, PointsError, SolidHull, SupportWalk, insertion_order,
};
pub use integrals::{Compensated, SolidMoments};
pub use mesh::TriangleMesh;
pub use scaled::ScaledPoints;
pub use twofold::cross_of_differences;
pub use unit_direction::{Direction, DirectionError};

/// How much of a test is run: a decisive part of it, all of it where the environment says `RECON_TESTS=all`.
#[cfg(test)]
pub(crate) fn few_or_all<T>(few: T, all: T) -> T {
    if std::env::var_os("RECON_TESTS").is_some_and(|asked| asked == "all") { all } else { few }
}

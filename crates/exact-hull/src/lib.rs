//! Convex hulls, intersections of half-spaces and Delaunay tetrahedra in space and in the plane, decided by exact predicates. No
//! input is known that gives a surface which is open, bends inwards or leaves a point outside; none should panic, and one that does is a bug.
//!
//! # Start here
//! [`Hull::of`] for points, [`Intersection::of`] for half-spaces:
//!
//! ```
//! use exact_hull::{Direction, HalfSpace, Hull, HullCertificate, Intersection};
//! use glam::DVec3;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // The corners of a cube, its centre, and one corner again.
//! let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2 & 1) as f64);
//! let mut points: Vec<DVec3> = (0..8).map(corner).collect();
//! points.extend([DVec3::splat(0.5), corner(7)]);
//! let hull = Hull::of(&points)?;
//! let cube = hull.solid().ok_or("flat")?;
//! assert_eq!((cube.vertices().len(), cube.volume()), (8, 1.0));
//! assert!(cube.contains(DVec3::ONE) && !cube.contains(DVec3::ONE * (1.0 + f64::EPSILON)));
//! assert!(HullCertificate::of(&cube.mesh(), &points)?.holds());
//!
//! // The same cube by its six faces, and a seventh that only touches it.
//! let face = |normal: DVec3| -> Result<HalfSpace, exact_hull::DirectionError> {
//!     let point = DVec3::splat(0.5) + 0.5 * normal.signum() * normal.abs().ceil();
//!     Ok(HalfSpace { point, normal: Direction::new(normal)?, margin: 0.0 })
//! };
//! let normals = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z, DVec3::ONE];
//! let spaces = normals.into_iter().map(face).collect::<Result<Vec<_>, _>>()?;
//! let around = Intersection::of(&spaces)?;
//! let around = around.bounded().ok_or("open")?;
//! assert!((around.volume() - 1.0).abs() < 1e-13);
//! // Without its lid it has no end upwards.
//! let open = Intersection::of(&[&spaces[..4], &spaces[5..6]].concat())?;
//! assert!(matches!(open, Intersection::Unbounded(along) if along.directions() == [Direction::Z]));
//! # Ok(())
//! # }
//! ```
//!
//! | to do | take |
//! |---|---|
//! | hull of points of any dimension, by that dimension | [`Hull`], [`SolidHull`] |
//! | the same, point by point | [`IncrementalHull`] |
//! | farthest points along many directions | [`SupportWalk`], [`Farthest`] |
//! | intersection of half-spaces; a smallest contradictory set, or the directions without end | [`Intersection`], [`Polyhedron`] |
//! | the same, half-space by half-space | [`IncrementalIntersection`] |
//! | what planes cut off a polyhedron | [`Caps`] |
//! | Delaunay tetrahedra | [`delaunay`] |
//! | a mesh of anybody's, judged as the hull of points | [`HullCertificate`] |
//! | signs, and points scaled so that they are exact | [`predicates`], [`ScaledPoints`] |
//! | sums and products that lose no digits where plain ones do | [`arithmetic`] |
//! | the plane | [`planar`] |
//!
//! # What is exact
//! Which point is on which side of which plane: Shewchuk's adaptive predicates (crate `robust`) behind a floating-point filter, on points
//! scaled by a power of two where their size asks for it. The dimension of a hull is exact as well: points that were meant to be coplanar but
//! are rounded span a thin solid. Volumes, areas and the corners of intersections are rounded; the planes of an intersection are moved out by a
//! few units of rounding first, so that what is computed contains the exact one.
//!
//! # Beside CGAL, Qhull and parry
//! 100,004 sets of 4 to 2000 points in 23 kinds (thin, clustered, repeated, nearly coplanar, far away), judged by exact predicates; 86,328 of them span
//! space, the rest a plane, a line or a point. Of parry3d
//! 0.31.1 and Qhull (SciPy 1.17) "wrong" is a point farther out than 1e-9 of the size or a surface that is not closed, "refused" an error:
//!
//! | | this crate | parry | Qhull |
//! |---|---|---|---|
//! | not exactly the hull | **0** | 38,171 of 86,328 | 10,479 of 86,328 |
//! | wrong | **0** | 23,511 | 78 |
//! | refused | **0** | 6 | 8,696 |
//!
//! Time in ms, thread time of the fastest of a few runs, all in one run on one machine (CGAL 5.5.1, exact predicates; parry and Qhull as above):
//!
//! | input | this crate | parry | Qhull | CGAL |
//! |---|---|---|---|---|
//! | hull, 10^3 points on curves | 0.33 | 1.18 | 2.02 | 2.04 |
//! | hull, 10^5 | 66 | 814 | 1,327 | 853 |
//! | hull, 10^6 | 937 | not tried | 37,869 | 14,370 |
//! | hull, 10^6 points on a sphere | 672 | not tried | 9,587 | 14,391 |
//! | half-spaces, 10^3 | 0.53 | | 2.31 | 3.37 |
//! | half-spaces, 10^5 | 100 | | failed | 1,099 |
//! | half-spaces, 10^6 | 1,354 | | over 150,000 | 15,131 |
//!
//! Of CGAL's two ways to intersect half-spaces the faster one is listed. For a hundred points of which nearly all are repeated, parry is six times as fast.
//!
//! # Limits
//! - `f64` only, two and three dimensions only, one thread.
//! - At most 2^31 - 3 points. Coordinates of one set may differ in size by 2^630 (spheres: 2^356); beyond, [`PointsError::DynamicRange`].
//! - Points inside of a flat face may or may not be corners of its triangulation; faces are not merged.
//! - Points can be added, not taken away.
//! - An intersection thinner than 1e-13 of its size is refused as [`IntersectionError::NoInterior`].
//! - Nothing here is constructed exactly: for exact coordinates of corners, use rational arithmetic.
//!
//! Lengths are in m in the documentation; any other unit serves. The feature `parry` turns meshes into shapes of parry3d, `generators` holds the
//! kinds of points that the table above counts, `strategies` the same for proptest.

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod arithmetic;
pub mod delaunay;
#[cfg(any(test, feature = "generators"))]
pub mod generators;
mod half_space;
mod halfspaces;
mod hull;
mod integrals;
#[cfg(test)]
mod laws;
mod mesh;
#[cfg(feature = "parry")]
mod parry;
pub mod planar;
pub mod predicates;
mod random;
mod scaled;
#[cfg(any(test, feature = "strategies"))]
pub mod strategies;
mod twofold;

pub use half_space::HalfSpace;
pub use halfspaces::{Caps, IncrementalIntersection, Intersection, IntersectionError, Polyhedron, Unbounded};
pub use hull::{
    Farthest, Hull, HullCertificate, IncrementalHull, PointsError, SolidHull, SupportWalk, insertion_order,
};
pub use integrals::SolidMoments;
pub use mesh::TriangleMesh;
pub use scaled::ScaledPoints;
pub use unit_direction::{Direction, DirectionError};

/// How much of a test is run: a decisive part of it, all of it where the environment says `RECON_TESTS=all`.
#[cfg(test)]
pub(crate) fn few_or_all<T>(few: T, all: T) -> T {
    if std::env::var_os("RECON_TESTS").is_some_and(|asked| asked == "all") { all } else { few }
}

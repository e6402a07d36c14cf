//! Guaranteed inner and outer bounds on a convex body from contact points and normals.
//!
//! A convex body that was touched at points `x_k` with outward normals `n_k` contains the hull of the points and is
//! contained in the half-spaces `n_k . (y - x_k) <= 0` (Moll and Erdmann, WAFR 2002, section 8). Which point is outside of
//! which facet is decided by exact arithmetic, so that the bounds hold on thin, flat, repeated and far-away data.
//!
//! # Start here
//! [`ShapeBounds::from_contacts`]; what else there is stands in modules, each with a worked example:
//!
//! ```
//! use glam::DVec3;
//! use shape_bounds::{ContactSample, ShapeBounds};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A unit sphere, touched at the corners of a cube.
//! let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * 2.0 - DVec3::ONE;
//! let contacts = ContactSample::from_raw((0..8).map(|i| corner(i).normalize()).map(|n| (n, n)))?;
//! let bounds = ShapeBounds::from_contacts(&contacts)?;
//! let sphere = 4.0 / 3.0 * std::f64::consts::PI;
//! assert!(bounds.lower_volume() < sphere && sphere < bounds.upper_volume());
//! let gap = bounds.largest_gap().ok_or("open")?;
//! println!("next touch along {}, where up to {} m are unknown", gap.direction.get(), gap.distance);
//! # Ok(())
//! # }
//! ```
//!
//! | what is known besides | take |
//! |---|---|
//! | nothing; contacts come one by one | [`ShapeBounds`]; [`IncrementalBounds`] |
//! | how noisy contacts are, or that they are | [`noise`] |
//! | limits on the radii of curvature | [`curvature`] |
//! | that palms are hollow, of which radius | [`palms`] |
//! | a family of shapes of few parameters | [`fit`] |
//! | that there are corners, edges and faces | [`features`] |
//! | that the body is not convex | [`ShapeBounds::from_concave_contacts`], [`concave`] |
//! | that it is seen from some place inside as a whole, smooth; that contacts are noisy | [`approximation`] |
//! | poses of a body that rests on a plane | [`poses`] |
//! | farthest points, distances, polytopes and moments of any of these bounds, or of a fit, are asked | [`body`] |
//! | the same of a body that is a function of one's own | [`distance`] |
//! | that it all lies in a plane | [`planar`] |
//!
//! Hulls and half-spaces themselves are those of the crate [`exact_hull`], which stands here as a module.
//!
//! All lengths are in m, all coordinates in the body's frame.

#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod approximation;
pub mod body;
mod bounds;
pub mod concave;
pub mod curvature;
pub mod distance;
mod erosion;
mod faceted;
pub mod features;
pub mod fit;
#[cfg(any(test, feature = "generators"))]
pub mod generators;
#[cfg(test)]
mod laws;
mod matrix;
mod median;
pub mod noise;
pub mod palms;
#[cfg(feature = "parry")]
pub mod parry;
pub mod planar;
pub mod poses;
mod sample;
#[cfg(any(test, feature = "strategies"))]
pub mod strategies;

pub use bounds::{BoundsError, Contradiction, Gap, IncrementalBounds, ShapeBounds};
#[doc(no_inline)]
pub use exact_hull;
pub use faceted::FacetError;
pub use sample::{ContactError, ContactSample, NORMAL_TOLERANCE};

/// How much of a test is run: a decisive part of it, all of it where the environment says `RECON_TESTS=all`, as
/// `cargo xtask verify --only all-tests` does.
#[cfg(test)]
pub(crate) fn few_or_all<T>(few: T, all: T) -> T {
    if std::env::var_os("RECON_TESTS").is_some_and(|asked| asked == "all") { all } else { few }
}

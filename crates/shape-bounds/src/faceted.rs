//! Polytopes inside and outside of a curved convex body, within a tolerance of each other.

use crate::bounds::{BoundsError, Gap, ShapeBounds};
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use exact_hull::{Intersection, Unbounded};
use glam::DVec3;
use std::collections::HashSet;
use thiserror::Error;

/// Facets at most. Their number grows as area over radius of curvature and tolerance.
const MOST: usize = 400_000;
/// Rounds at most: each divides the gaps by about four, so that this is far beyond the digits that there are.
const ROUNDS: usize = 60;

/// Corners this close to each other, relative to the tolerance, are at one place.
const SAME_PLACE: f64 = 1e-3;

/// How far beyond the contacts, in terms of their size, an open direction is looked at.
const FAR: f64 = 1e6;

/// Why a curved body has no polytopes around it.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FacetError {
    /// A tolerance that is not positive and finite.
    #[error("tolerance is {value} m; it must be positive and finite")]
    Tolerance {
        /// The tolerance as given.
        value: f64,
    },
    /// The body has no interior, or rounding decides.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
    /// The body has no end in some direction.
    #[error("the bound has no end in some direction: touch the body from more sides")]
    Unbounded,
    /// Too many facets would be needed.
    #[error(
        "{facets} facets leave a gap of {gap:e} m, and more than {MOST} are not made; allow more than {tolerance:e} m"
    )]
    TooFine {
        /// The tolerance as given, in m.
        tolerance: f64,
        /// Facets so far.
        facets: usize,
        /// What they leave, in m.
        gap: f64,
    },
}

/// Polytopes inside and outside of a convex body, no further apart than `tolerance` (Hausdorff distance, m). `start` are contacts
/// of the body, and `touch` gives another one, at which it is touched where a gap is.
pub(crate) fn faceted(
    start: Vec<ContactSample>,
    tolerance: f64,
    mut touch: impl FnMut(&Gap) -> ContactSample,
) -> Result<ShapeBounds, FacetError> {
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(FacetError::Tolerance { value: tolerance });
    }
    let mut contacts = start;
    let mut gap = f64::INFINITY;
    for _ in 0..ROUNDS {
        let bounds = ShapeBounds::from_contacts(&contacts)?;
        if let Intersection::Unbounded(open) = bounds.upper() {
            // The tangent planes so far leave a side open; the body need not.
            let more = towards(open, &contacts).iter().map(&mut touch).collect::<Vec<ContactSample>>();
            if more.iter().any(|c| !c.point.is_finite()) {
                return Err(FacetError::Unbounded);
            }
            contacts.extend(more);
            continue;
        }
        // Where more than three planes meet, several corners are at one place: one touch there is enough.
        let mut places = HashSet::new();
        let place = |g: &Gap| (g.outer / (SAME_PLACE * tolerance)).round().to_array().map(f64::to_bits);
        let wide: Vec<Gap> =
            bounds.gaps_above(tolerance).into_iter().filter(|g| places.insert(place(g))).collect();
        if wide.is_empty() {
            return Ok(bounds);
        }
        gap = wide.iter().map(|g| g.distance).fold(0.0, f64::max);
        if contacts.len() + wide.len() > MOST {
            break;
        }
        contacts.extend(wide.iter().map(&mut touch));
    }
    Err(FacetError::TooFine { tolerance, facets: contacts.len(), gap })
}

/// Gaps without end in the open directions.
fn towards(open: &Unbounded, contacts: &[ContactSample]) -> Vec<Gap> {
    let inner = open.interior();
    let size = contacts.iter().map(|c| c.point.distance(inner)).fold(f64::MIN_POSITIVE, f64::max);
    let gap = |direction: &Direction| Gap {
        direction: *direction,
        outer: inner + direction.get() * (FAR * size),
        inner,
        distance: f64::INFINITY,
    };
    open.directions().iter().map(gap).collect()
}

/// [`faceted`] for a body that is known by its support points.
pub(crate) fn faceted_by_support(
    mut support: impl FnMut(DVec3) -> DVec3,
    tolerance: f64,
) -> Result<ShapeBounds, FacetError> {
    let mut touch = |normal: Direction| ContactSample { point: support(normal.get()), normal };
    let axes = [Direction::X, Direction::Y, Direction::Z];
    let start = axes.into_iter().flat_map(|d| [touch(d), touch(-d)]).collect();
    faceted(start, tolerance, |gap| touch(gap.direction))
}

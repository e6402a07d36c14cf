//! Intersections of half-spaces: the outer bound of a convex body (paper, section 8).

mod caps;
mod corners;
mod error;
mod incremental;
mod interior;
mod polyhedron;
mod recession;
#[cfg(test)]
mod tests;
mod twins;
mod vertex;

pub use caps::Caps;
pub use error::IntersectionError;
pub use incremental::IncrementalIntersection;
use interior::interior_point;
pub use polyhedron::Polyhedron;
pub(crate) use recession::OPEN;
pub(crate) use twins::TWINS;

use crate::HalfSpace;
use crate::hull::{Hull, MOST_POINTS, SolidHull};
use crate::twofold::cross_of_differences;
use glam::DVec3;
use unit_direction::Direction;

/// Below this squared sine of an angle a facet's normal takes twofold precision to be right to a billionth.
const SLIVER: f64 = 1e-14;

/// The intersection of half-spaces, which has an interior.
#[derive(Clone, Debug, PartialEq)]
pub enum Intersection {
    /// The intersection is a polyhedron.
    Bounded(Polyhedron),
    /// The half-spaces do not close around the body.
    Unbounded(Unbounded),
}

/// An intersection of half-spaces that has no end in some directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Unbounded {
    half_spaces: Vec<HalfSpace>,
    interior: DVec3,
    directions: Vec<Direction>,
}

impl Intersection {
    /// Intersects `half_spaces` in expected time O(n log n), as the hull of their polar duals about an interior point.
    ///
    /// Planes are moved outwards by a few units of rounding of the coordinates, so that what is computed contains the
    /// exact intersection.
    ///
    /// # Errors
    /// [`IntersectionError`] for no half-spaces, values that are not finite, half-spaces that contradict each other
    /// (a smallest such set is named), and an interior too thin to compute with.
    pub fn of(half_spaces: &[HalfSpace]) -> Result<Self, IntersectionError> {
        let limit = MOST_POINTS;
        if half_spaces.is_empty() {
            return Err(IntersectionError::Empty);
        }
        if half_spaces.len() > limit {
            return Err(IntersectionError::TooMany { count: half_spaces.len(), limit });
        }
        if let Some(index) = half_spaces.iter().position(|h| !h.point.is_finite() || !h.margin.is_finite()) {
            let HalfSpace { point, margin, .. } = half_spaces[index];
            return Err(IntersectionError::NotFinite { index, point, margin });
        }
        let interior = interior_point(half_spaces)?;
        let outwards = polyhedron::outward_rounding(half_spaces);
        let made = |half_spaces: &[HalfSpace]| {
            let duals: Vec<DVec3> =
                half_spaces.iter().map(|h| h.normal.get() / -h.moved(outwards).excess(interior)).collect();
            Self::from_dual(Hull::of(&duals)?, half_spaces, outwards, interior)
        };
        let first = made(half_spaces)?;
        if first.bounded().is_none_or(Polyhedron::is_sure) {
            return Ok(first);
        }
        // Where along the line that planes share a corner is, rounding decides: of such planes one stands for all.
        twins::joined(half_spaces, interior).map_or(Ok(first), |joined| made(&joined))
    }

    /// The intersection whose polar duals about `interior`, of the half-spaces moved `outwards` (m) for rounding, have the hull
    /// `dual`.
    ///
    /// Whether it has an end is a question to the normals alone. Where a direction is open, the polyhedron reaches from the
    /// interior point as far as that one's depth over the slope of the normals along it; one that stays nearer is bounded.
    ///
    /// # Errors
    /// [`IntersectionError::Duals`] where the duals cannot be told apart although the normals close.
    fn from_dual(
        dual: Hull,
        half_spaces: &[HalfSpace],
        outwards: f64,
        interior: DVec3,
    ) -> Result<Self, IntersectionError> {
        let depth = half_spaces.iter().map(|h| -h.excess(interior)).fold(f64::INFINITY, f64::min);
        let dimension = dual.dimension();
        let closed = dual.into_solid().filter(strictly_contains_origin);
        let is_near = closed.as_ref().is_some_and(|dual| nearest_facet(dual) * depth > OPEN);
        if !is_near {
            let directions = recession::unbounded_directions(half_spaces)?;
            if !directions.is_empty() {
                return Ok(Self::Unbounded(Unbounded {
                    half_spaces: half_spaces.to_vec(),
                    interior,
                    directions,
                }));
            }
        }
        let polyhedron = closed.map(|dual| Polyhedron::from_dual(dual, half_spaces, outwards, interior));
        match polyhedron.filter(Polyhedron::is_finite) {
            Some(polyhedron) => Ok(Self::Bounded(polyhedron)),
            None => Err(IntersectionError::Duals { dimension, depth }),
        }
    }

    /// The polyhedron, if the intersection is bounded.
    #[must_use]
    pub fn bounded(&self) -> Option<&Polyhedron> {
        match self {
            Self::Bounded(polyhedron) => Some(polyhedron),
            Self::Unbounded(_) => None,
        }
    }
}

fn strictly_contains_origin(dual: &SolidHull) -> bool {
    (0..dual.triangles().len()).all(|f| dual.above_facet(f, DVec3::ZERO) < 0.0)
}

/// The least distance from the origin, which is inside, to the plane of a facet: one over that of the farthest corner of the
/// polar.
fn nearest_facet(dual: &SolidHull) -> f64 {
    let distance = |f: usize| {
        let [a, b, c] = dual.corners(f);
        let (ab, ac) = (b - a, c - a);
        let mut across = ab.cross(ac);
        if across.length_squared() < SLIVER * ab.length_squared() * ac.length_squared() {
            across = cross_of_differences(a, b, c);
        }
        across.normalize_or_zero().dot(a)
    };
    (0..dual.triangles().len()).map(distance).fold(f64::INFINITY, f64::min)
}

impl Unbounded {
    /// Generators of the cone of directions without end: every such direction is a sum of these with weights of at
    /// least zero. A whole line without end is given by both its directions.
    #[must_use]
    pub fn directions(&self) -> &[Direction] {
        &self.directions
    }

    /// A point strictly inside.
    #[must_use]
    pub fn interior(&self) -> DVec3 {
        self.interior
    }

    /// The part within an axis-aligned cube: for pictures, or where something else is known to limit the body. Faces on
    /// the cube have sources at and above the number of half-spaces, in the order +x, -x, +y, -y, +z, -z.
    ///
    /// # Errors
    /// Those of [`Intersection::of`], when the cube misses the intersection.
    pub fn within_cube(&self, centre: DVec3, half_side: f64) -> Result<Polyhedron, IntersectionError> {
        let mut all = self.half_spaces.clone();
        for axis in [Direction::X, Direction::Y, Direction::Z] {
            for normal in [axis, -axis] {
                all.push(HalfSpace { point: centre + normal.get() * half_side, normal, margin: 0.0 });
            }
        }
        match Intersection::of(&all)? {
            Intersection::Bounded(polyhedron) => Ok(polyhedron),
            // Six faces of a cube bound everything.
            Intersection::Unbounded(_) => Err(IntersectionError::Duals { dimension: 3, depth: 0.0 }),
        }
    }
}

//! Intersections of half-planes: the outer bound of a convex outline.

mod error;
mod incremental;
mod interior;

pub use error::IntersectionError;
pub use incremental::IncrementalIntersection;
pub use interior::interior_point;

use super::hull::HullPolygon;
use super::{ConvexPolygon, Direction, HalfPlane, Hull};
use crate::halfspaces::{OPEN, TWINS};
use crate::predicates::turn;
use glam::DVec2;

/// Units of rounding of the largest coordinate by which lines are moved outwards before anything is computed from them.
const OUTWARD_ULPS: f64 = 8.0;

/// Edges that a polygon has at least.
const FEWEST: usize = 3;

/// The intersection of half-planes, which has an interior.
#[derive(Clone, Debug, PartialEq)]
pub enum Intersection {
    /// The intersection is a polygon.
    Bounded(Region),
    /// The half-planes do not close around the body.
    Unbounded(Unbounded),
}

/// A bounded intersection of half-planes.
#[derive(Clone, Debug, PartialEq)]
pub struct Region {
    shape: ConvexPolygon,
    sources: Vec<u32>,
    redundant: Vec<u32>,
    half_planes: Vec<HalfPlane>,
}

impl Region {
    /// The polygon.
    #[must_use]
    pub fn shape(&self) -> &ConvexPolygon {
        &self.shape
    }

    /// For each edge, the half-plane it lies on; edge `k` starts at corner `k`.
    #[must_use]
    pub fn edge_sources(&self) -> &[u32] {
        &self.sources
    }

    /// Half-planes that could be left out, ascending.
    #[must_use]
    pub fn redundant(&self) -> &[u32] {
        &self.redundant
    }

    /// How far the point is outside of the half-plane it is farthest outside of, in m; at most zero inside.
    #[must_use]
    pub fn excess(&self, point: DVec2) -> f64 {
        self.half_planes.iter().map(|h| h.excess(point)).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// An intersection of half-planes that has no end in some directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Unbounded {
    half_planes: Vec<HalfPlane>,
    interior: DVec2,
    directions: Vec<Direction>,
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
    pub fn interior(&self) -> DVec2 {
        self.interior
    }

    /// The part within an axis-aligned square. Edges on it have sources at and above the number of half-planes, in the
    /// order +x, -x, +y, -y.
    ///
    /// # Errors
    /// Those of [`Intersection::of`], when the square misses the intersection.
    pub fn within_square(&self, centre: DVec2, half_side: f64) -> Result<Region, IntersectionError> {
        let mut all = self.half_planes.clone();
        for axis in [DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y] {
            let normal = Direction::new(axis).map_err(|_| IntersectionError::Empty)?;
            all.push(HalfPlane { point: centre + axis * half_side, normal, margin: 0.0 });
        }
        match Intersection::of(&all)? {
            Intersection::Bounded(region) => Ok(region),
            // Four sides of a square bound everything; a dual hull that says otherwise has been rounded flat.
            Intersection::Unbounded(_) => {
                Err(IntersectionError::NoInterior { tight: Vec::new(), inradius: 0.0 })
            }
        }
    }
}

impl Intersection {
    /// Intersects `half_planes` in time O(n log n), as the hull of their polar duals about an interior point.
    ///
    /// Lines are moved outwards by a few units of rounding of the coordinates, so that what is computed contains the
    /// exact intersection.
    ///
    /// # Errors
    /// [`IntersectionError`] for no half-planes, values that are not finite, half-planes that contradict each other (a
    /// smallest such set is named), and an interior too thin to compute with.
    pub fn of(half_planes: &[HalfPlane]) -> Result<Self, IntersectionError> {
        let limit = u32::MAX as usize - 2;
        if half_planes.is_empty() {
            return Err(IntersectionError::Empty);
        }
        if half_planes.len() > limit {
            return Err(IntersectionError::TooMany { count: half_planes.len(), limit });
        }
        if let Some(index) = half_planes.iter().position(|h| !h.point.is_finite() || !h.margin.is_finite()) {
            let HalfPlane { point, margin, .. } = half_planes[index];
            return Err(IntersectionError::NotFinite { index, point, margin });
        }
        let interior = interior_point(half_planes)?;
        let largest = half_planes.iter().map(|h| h.point.abs().max_element()).fold(0.0, f64::max);
        let outward = OUTWARD_ULPS * f64::EPSILON * largest;
        let outer: Vec<HalfPlane> =
            half_planes.iter().map(|h| HalfPlane { margin: h.margin + outward, ..*h }).collect();
        let duals: Vec<DVec2> = outer.iter().map(|h| h.normal.get() / -h.excess(interior)).collect();
        Self::from_dual(Hull::of(&duals)?, half_planes, &outer, &duals, interior)
    }

    /// As in space, whether there is an end is a question to the normals alone; an edge of the dual that is far enough from the
    /// origin proves one.
    fn from_dual(
        dual: Hull,
        half_planes: &[HalfPlane],
        outer: &[HalfPlane],
        duals: &[DVec2],
        interior: DVec2,
    ) -> Result<Self, IntersectionError> {
        let depth = half_planes.iter().map(|h| -h.excess(interior)).fold(f64::INFINITY, f64::min);
        let around = |hull: &&HullPolygon| hull.shape().edges().all(|(a, b)| turn(a, b, DVec2::ZERO) > 0.0);
        let closed = dual.polygon().filter(around);
        let distance = |(a, b): (DVec2, DVec2)| (b - a).perp_dot(-a) / a.distance(b);
        let is_near = |hull: &HullPolygon| {
            hull.shape().edges().map(distance).fold(f64::INFINITY, f64::min) * depth > OPEN
        };
        if closed.is_none_or(|hull| !is_near(hull)) {
            let directions = unbounded_directions(half_planes)?;
            if !directions.is_empty() {
                let half_planes = half_planes.to_vec();
                return Ok(Self::Unbounded(Unbounded { half_planes, interior, directions }));
            }
        }
        match closed {
            Some(hull) => Ok(Self::Bounded(region(hull.sources(), outer, duals, interior))),
            None => Err(IntersectionError::NoInterior { tight: Vec::new(), inradius: depth }),
        }
    }

    /// The polygon, if the intersection is bounded.
    #[must_use]
    pub fn bounded(&self) -> Option<&Region> {
        match self {
            Self::Bounded(region) => Some(region),
            Self::Unbounded(_) => None,
        }
    }
}

/// The polygon whose edges lie on the half-planes `sources`, in order. Corner `k` is where edges `k - 1` and `k` meet.
fn region(sources: &[u32], outer: &[HalfPlane], duals: &[DVec2], interior: DVec2) -> Region {
    let sources = &without_twins(sources, outer, interior)[..];
    let count = sources.len();
    let source = |k: usize| sources[k % count] as usize;
    let mut vertices: Vec<DVec2> = (0..count)
        .map(|k| meeting(&outer[source(k + count - 1)], &outer[source(k)]).unwrap_or(DVec2::NAN))
        .collect();
    // Along nearly parallel lines rounding can put a corner behind the one before; from the duals, corners are in order.
    for k in 0..count {
        let normal = outer[source(k)].normal.get();
        let along = vertices[(k + 1) % count] - vertices[k];
        if normal.perp().dot(along).is_nan() || normal.perp().dot(along) < 0.0 {
            for corner in [k, k + 1] {
                let (a, b) = (duals[source(corner + count - 1)], duals[source(corner)]);
                // y with a . y = b . y = 1, about the interior; the denominator is positive since the duals turn left.
                vertices[corner % count] = interior + (a - b).perp() / a.perp_dot(b);
            }
        }
    }
    let mut used = vec![false; outer.len()];
    sources.iter().for_each(|s| used[*s as usize] = true);
    Region {
        shape: ConvexPolygon::new(vertices),
        sources: sources.to_vec(),
        redundant: (0..outer.len() as u32).filter(|i| !used[*i as usize]).collect(),
        half_planes: outer.to_vec(),
    }
}

/// The half-planes without those that are one with others but for rounding, as those of many contacts on one straight side, of which the
/// farthest one stands for all: where nearly parallel lines meet is off by rounding over their angle.
fn without_twins(sources: &[u32], outer: &[HalfPlane], interior: DVec2) -> Vec<u32> {
    let distance = |s: u32| -outer[s as usize].excess(interior);
    let largest = sources.iter().map(|s| distance(*s)).fold(0.0, f64::max);
    let normal = |s: u32| outer[s as usize].normal.get();
    let are_twins = |a: u32, b: u32| {
        normal(a).distance(normal(b)) <= TWINS && (distance(a) - distance(b)).abs() <= TWINS * largest
    };
    // The first of each run of twins, and the farthest.
    let mut kept: Vec<[u32; 2]> = Vec::with_capacity(sources.len());
    let farther = |a: u32, b: u32| if distance(b) > distance(a) { b } else { a };
    for &source in sources {
        match kept.last_mut() {
            Some([first, farthest]) if are_twins(*first, source) => *farthest = farther(*farthest, source),
            _ => kept.push([source; 2]),
        }
    }
    // Around the end of the list.
    if let (Some([first, _]), Some([last, of_last])) = (kept.first().copied(), kept.last().copied())
        && kept.len() > FEWEST
        && are_twins(last, first)
    {
        kept.pop();
        kept[0][1] = farther(kept[0][1], of_last);
    }
    if kept.len() < FEWEST { sources.to_vec() } else { kept.into_iter().map(|[_, s]| s).collect() }
}

/// Where two lines meet, computed from the first one's own point so that nothing large cancels.
fn meeting(a: &HalfPlane, b: &HalfPlane) -> Option<DVec2> {
    let (n, m) = (a.normal.get(), b.normal.get());
    let start = a.point + n * a.margin;
    let slope = n.perp_dot(m);
    if slope == 0.0 {
        return None;
    }
    // start + t n.perp() lies on b, and m . n.perp() = n.perp_dot(m).
    Some(start + n.perp() * (-b.excess(start) / slope))
}

/// Directions that generate the cone `{ d : n_k . d <= 0 for all k }`, up to [`OPEN`]: outward normals of those edges of the hull
/// of the normals and the origin that come as near to the origin, in a set without near-duplicates.
fn unbounded_directions(half_planes: &[HalfPlane]) -> Result<Vec<Direction>, IntersectionError> {
    let mut points: Vec<DVec2> = half_planes.iter().map(|h| h.normal.get()).collect();
    let along = points[0];
    let generators: Vec<DVec2> = if points.iter().all(|n| n.perp_dot(along).abs() <= OPEN) {
        // Lines that are parallel, but for printing.
        let mut both = vec![along.perp(), -along.perp()];
        if points.iter().all(|n| n.dot(along) > 0.0) {
            both.push(-along);
        }
        both
    } else {
        points.push(DVec2::ZERO);
        let hull = Hull::of(&points)?;
        let edges = hull.polygon().map(|hull| hull.shape().edges().collect::<Vec<_>>()).unwrap_or_default();
        edges
            .into_iter()
            .filter_map(|(a, b)| {
                let outward = -(b - a).perp();
                let is_near = turn(a, b, DVec2::ZERO) <= 0.0 || outward.normalize_or_zero().dot(a) <= OPEN;
                is_near.then_some(outward)
            })
            .collect()
    };
    let mut directions: Vec<Direction> = Vec::new();
    for direction in generators.into_iter().filter_map(|g| Direction::new(g).ok()) {
        if directions.iter().all(|d| d.get().distance(direction.get()) > 1e-9) {
            directions.push(direction);
        }
    }
    Ok(directions)
}

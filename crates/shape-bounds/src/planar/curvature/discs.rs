use super::envelope::{Around, Piece};
use super::interior::common_point;
use super::{CurvatureError, around_arc};
use exact_hull::planar::{Direction, HalfPlane};
use glam::DVec2;
use std::f64::consts::TAU;

/// The most that a part of an arc takes of the directions about a point inside, rad: below a quarter of a turn.
const PART: f64 = 1.2;
/// Angles of an arc, relative to a full turn, below which `x - sin x` is taken from its series.
const SERIES: f64 = 1e-2;

/// A disc: of a circular palm, or one that limits curvature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Centre in m.
    pub centre: DVec2,
    /// Radius in m.
    pub radius: f64,
}

/// One side of an intersection of discs and half-planes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Which disc, or the number of discs plus which half-plane.
    pub source: usize,
    /// Where the side begins, counter-clockwise, in m.
    pub from: DVec2,
    /// Where it ends, in m.
    pub to: DVec2,
    /// Angle that it turns by in rad; zero for a side on a half-plane.
    pub angle: f64,
    /// Direction of the outward normal at its beginning, in rad.
    pub start: f64,
}

/// The intersection of discs of any radii and half-planes.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscIntersection {
    discs: Vec<Disc>,
    half_planes: Vec<HalfPlane>,
    /// A point in the interior, and what bounds the outline around it.
    centre: DVec2,
    pieces: Vec<Piece>,
    sides: Vec<Side>,
}

impl DiscIntersection {
    /// Intersects discs and half-planes, at least one disc, in time O(n log n).
    ///
    /// # Errors
    /// [`CurvatureError`] for values that are not finite, radii that are not positive, no disc at all, and an empty
    /// intersection.
    pub fn of(discs: &[Disc], half_planes: &[HalfPlane]) -> Result<Self, CurvatureError> {
        let bad = |d: &Disc| !(d.centre.is_finite() && d.radius.is_finite() && d.radius > 0.0);
        if let Some(index) = discs.iter().position(bad) {
            return Err(CurvatureError::Disc { index, radius: discs[index].radius });
        }
        let bad = |h: &HalfPlane| !(h.point.is_finite() && h.margin.is_finite());
        if let Some(index) = half_planes.iter().position(bad) {
            return Err(CurvatureError::Disc { index: discs.len() + index, radius: f64::INFINITY });
        }
        let count = discs.len() + half_planes.len();
        if count == 0 {
            return Err(CurvatureError::Empty { count, conflict: Vec::new() });
        }
        if discs.is_empty() {
            return Err(CurvatureError::Unbounded { count });
        }
        let centre =
            common_point(discs, half_planes).map_err(|conflict| CurvatureError::Empty { count, conflict })?;
        let around = Around { discs, half_planes, centre };
        let pieces = around.envelope();
        let sides = sides(&around, &pieces);
        Ok(Self { discs: discs.to_vec(), half_planes: half_planes.to_vec(), centre, pieces, sides })
    }

    /// A point in the interior.
    #[cfg(test)]
    pub(super) fn centre(&self) -> DVec2 {
        self.centre
    }

    /// How far `point` is outside, by the disc or half-plane that bounds the outline towards it, which is the second value; negative
    /// inside.
    pub(super) fn excess(&self, point: DVec2) -> (f64, usize) {
        let angle = (point - self.centre).to_angle().rem_euclid(TAU);
        // Before the first piece's start it is the last one, across the angle zero.
        let after = self.pieces.partition_point(|piece| piece.start <= angle);
        let source = self.pieces[(after + self.pieces.len() - 1) % self.pieces.len()].source;
        let excess = match self.discs.get(source) {
            Some(disc) => point.distance(disc.centre) - disc.radius,
            None => self.half_planes[source - self.discs.len()].excess(point),
        };
        (excess, source)
    }

    /// The sides, in order counter-clockwise.
    #[must_use]
    pub fn sides(&self) -> &[Side] {
        &self.sides
    }

    /// Area in m^2: that of the polygon of the corners, plus the segments that the arcs cut off, all closed forms.
    #[must_use]
    pub fn area(&self) -> f64 {
        let Some(origin) = self.sides.first().map(|s| s.from) else { return 0.0 };
        self.sides
            .iter()
            .map(|side| {
                let chord = (side.from - origin).perp_dot(side.to - origin);
                let radius = self.discs.get(side.source).map_or(0.0, |d| d.radius);
                0.5 * (chord + radius * radius * less_sine(side.angle))
            })
            .sum()
    }

    /// Corners of a polygon around it, counter-clockwise, whose sides touch it at most `step` rad (at least a thousandth) of turning apart: what is in
    /// the bound is in the polygon.
    #[must_use]
    pub fn outline(&self, step: f64) -> Vec<DVec2> {
        let of_side = |side: &Side| match self.discs.get(side.source) {
            Some(disc) => {
                let around = around_arc(side.start, side.angle, step).map(|u| disc.centre + u * disc.radius);
                std::iter::once(side.from).chain(around).chain([side.to]).collect()
            }
            None => vec![side.from, side.to],
        };
        self.sides.iter().flat_map(of_side).collect()
    }

    /// Support function in direction `n`, in m.
    #[must_use]
    pub fn support(&self, n: Direction) -> f64 {
        let angle = n.angle();
        let of_side = |side: &Side| {
            let ends = side.from.dot(n.get()).max(side.to.dot(n.get()));
            match self.discs.get(side.source) {
                Some(disc) if (angle - side.start).rem_euclid(TAU) <= side.angle => {
                    disc.centre.dot(n.get()) + disc.radius
                }
                _ => ends,
            }
        };
        self.sides.iter().map(of_side).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether the point is inside, but for rounding.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        self.discs.iter().all(|d| d.centre.distance(point) <= d.radius)
            && self.half_planes.iter().all(|h| h.excess(point) <= 0.0)
    }
}

/// The sides that pieces of the outline are.
fn sides(around: &Around, pieces: &[Piece]) -> Vec<Side> {
    let [single] = pieces else {
        let next = pieces.iter().cycle().skip(1);
        return pieces.iter().zip(next).map(|(piece, next)| side(around, *piece, next.start)).collect();
    };
    // One disc in all others.
    vec![side(around, *single, single.start)]
}

/// The side of a piece that ends at an angle; all round if it ends where it starts.
fn side(around: &Around, Piece { start, source }: Piece, end: f64) -> Side {
    let extent = if end > start { end - start } else { end + TAU - start };
    let point = |angle: f64| {
        let along = DVec2::from_angle(angle);
        around.centre + along * around.distance(source, along)
    };
    let (from, to) = (point(start), point(end));
    let Some(disc) = around.discs.get(source) else {
        let normal = around.half_planes[source - around.discs.len()].normal;
        return Side { source, from, to, angle: 0.0, start: normal.angle().rem_euclid(TAU) };
    };
    // About its own centre an arc turns by less than twice what is seen from inside: parts turn by less than half a turn.
    let parts = (extent / PART).ceil();
    let radius = |k: f64| point(start + extent * k / parts) - disc.centre;
    let angle =
        (0..parts as u32).map(|k| radius(f64::from(k)).angle_to(radius(f64::from(k) + 1.0)).max(0.0)).sum();
    Side { source, from, to, angle, start: (from - disc.centre).to_angle().rem_euclid(TAU) }
}

/// `x - sin x`, which cancels where x is small.
fn less_sine(x: f64) -> f64 {
    if x > SERIES {
        return x - x.sin();
    }
    let square = x * x;
    x * square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)))
}

use super::conflict::smallest_conflict;
use super::{CurvatureError, arc};
use crate::planar::{Direction, HalfPlane, Intersection};
use glam::DVec2;
use std::f64::consts::{PI, TAU};

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
///
/// Each circle and line is cut by all others in time O(n^2 log n), simple and enough for the contacts of a palm: a
/// thousand discs take some hundredths of a second.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscIntersection {
    discs: Vec<Disc>,
    half_planes: Vec<HalfPlane>,
    sides: Vec<Side>,
}

impl DiscIntersection {
    /// Intersects discs and half-planes; at least one disc.
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
        if discs.is_empty() && count > 0 {
            return Err(CurvatureError::Unbounded { count });
        }
        let mut own = Self::cut(discs.to_vec(), half_planes.to_vec());
        if own.sides.is_empty() {
            let conflict = smallest_conflict(count, |some| is_empty(discs, half_planes, some));
            return Err(CurvatureError::Empty { count, conflict });
        }
        own.sides.sort_by(|a, b| a.start.total_cmp(&b.start));
        Ok(own)
    }

    /// The sides in no order; none where nothing is left.
    fn cut(discs: Vec<Disc>, half_planes: Vec<HalfPlane>) -> Self {
        let mut own = Self { discs, half_planes, sides: Vec::new() };
        (0..own.discs.len()).for_each(|i| own.cut_circle(i));
        (0..own.half_planes.len()).for_each(|i| own.cut_line(i));
        own
    }

    /// The arcs of circle `i` that are in everything else.
    fn cut_circle(&mut self, i: usize) {
        let Disc { centre, radius } = self.discs[i];
        let mut forbidden: Vec<(f64, f64)> = Vec::new();
        for (j, other) in self.discs.iter().enumerate().filter(|(j, _)| *j != i) {
            let offset = centre - other.centre;
            if offset == DVec2::ZERO && other.radius == radius {
                // Of equal discs the first counts.
                if j < i {
                    return;
                }
                continue;
            }
            // |offset + r u| <= R  <=>  u . offset <= limit.
            let limit = ((other.radius - radius) * (other.radius + radius) - offset.length_squared())
                / (2.0 * radius);
            if !forbid(offset, limit, &mut forbidden) {
                return;
            }
        }
        for plane in &self.half_planes {
            if !forbid(plane.normal.get(), -plane.excess(centre) / radius, &mut forbidden) {
                return;
            }
        }
        for (start, end) in gaps(&mut forbidden) {
            self.sides.push(Side {
                source: i,
                from: centre + DVec2::from_angle(start) * radius,
                to: centre + DVec2::from_angle(end) * radius,
                angle: end - start,
                start: start.rem_euclid(TAU),
            });
        }
    }

    /// The segment of line `i` that is in everything else.
    fn cut_line(&mut self, i: usize) {
        let plane = self.half_planes[i];
        let n = plane.normal.get();
        let (origin, along) = (plane.point + n * plane.margin, n.perp());
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for disc in &self.discs {
            let offset = disc.centre - origin;
            let (middle, height) = (offset.dot(along), offset.dot(n));
            let half = (disc.radius - height.abs()) * (disc.radius + height.abs());
            if half <= 0.0 {
                return;
            }
            low = low.max(middle - half.sqrt());
            high = high.min(middle + half.sqrt());
        }
        for (j, other) in self.half_planes.iter().enumerate().filter(|(j, _)| *j != i) {
            let slope = other.normal.get().dot(along);
            let room = -other.excess(origin);
            if slope > 0.0 {
                high = high.min(room / slope);
            } else if slope < 0.0 {
                low = low.max(room / slope);
            } else if room < 0.0 || (room == 0.0 && j < i) {
                return;
            }
        }
        if low < high {
            self.sides.push(Side {
                source: self.discs.len() + i,
                from: origin + along * low,
                to: origin + along * high,
                angle: 0.0,
                start: plane.normal.angle().rem_euclid(TAU),
            });
        }
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

    /// Points on the outline, counter-clockwise, at most `step` rad (at least a thousandth) of turning apart.
    #[must_use]
    pub fn outline(&self, step: f64) -> Vec<DVec2> {
        let of_side = |side: &Side| match self.discs.get(side.source) {
            Some(disc) => arc(side.start, side.angle, step).map(|u| disc.centre + u * disc.radius).collect(),
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

/// Whether some of the discs and half-planes have no interior in common.
fn is_empty(discs: &[Disc], half_planes: &[HalfPlane], some: &[usize]) -> bool {
    let round: Vec<Disc> = some.iter().filter_map(|k| discs.get(*k)).copied().collect();
    let flat = some.iter().filter_map(|k| half_planes.get(k.checked_sub(discs.len())?));
    let flat: Vec<HalfPlane> = flat.copied().collect();
    if round.is_empty() {
        return Intersection::of(&flat).is_err_and(|_| !flat.is_empty());
    }
    DiscIntersection::cut(round, flat).sides.is_empty()
}

/// Adds the arc of directions `u` with `u . axis > limit`; false if that is all of them.
fn forbid(axis: DVec2, limit: f64, forbidden: &mut Vec<(f64, f64)>) -> bool {
    let length = axis.length();
    if limit >= length {
        return true;
    }
    if limit <= -length {
        return false;
    }
    let (middle, half) = (axis.to_angle(), (limit / length).acos());
    forbidden.push((middle - half, middle + half));
    true
}

/// What arcs leave of a full turn, each as (start, end) with start below end.
fn gaps(arcs: &mut [(f64, f64)]) -> Vec<(f64, f64)> {
    if arcs.is_empty() {
        return vec![(-PI, PI)];
    }
    for arc in arcs.iter_mut() {
        let turns = (arc.0 / TAU).floor() * TAU;
        *arc = (arc.0 - turns, arc.1 - turns);
    }
    arcs.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Once round from the first arc's start; whatever passes the full turn also covers the beginning.
    let covered = arcs.iter().map(|a| a.1 - TAU).fold(f64::NEG_INFINITY, f64::max);
    let mut end = arcs[0].1.max(covered);
    let mut free = Vec::new();
    for arc in &arcs[1..] {
        if arc.0 > end {
            free.push((end, arc.0));
        }
        end = end.max(arc.1);
    }
    if arcs[0].0 + TAU > end {
        free.push((end, arcs[0].0 + TAU));
    }
    free
}

/// `x - sin x`, which cancels where x is small.
fn less_sine(x: f64) -> f64 {
    if x > SERIES {
        return x - x.sin();
    }
    let square = x * x;
    x * square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0)))
}

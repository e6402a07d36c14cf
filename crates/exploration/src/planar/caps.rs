//! What lies between the bounds, piece by piece.

use super::knowledge::Prospects;
use crate::limits::Limits;
use crate::touching::{Candidate, climbed};
use glam::DVec2;
use shape_bounds::exact_hull::planar::{ConvexPolygon, Direction};
use shape_bounds::planar::ShapeBounds;

/// Heights at which the body may meet the touch, as shares of the way between the bounds: the middles of three equal parts.
const HEIGHTS: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
/// Mean over [`HEIGHTS`] of the share of a triangle that a touch along the normal of its base takes off: `s` at the bottom, and
/// `(1 - s)^2` at the top.
const OF_A_TRIANGLE: f64 = 0.5 + 35.0 / 108.0;
pub(super) type Candidates = crate::touching::Candidates<Direction, DVec2>;

impl Candidates {
    fn take(
        &mut self,
        candidate: Candidate<Direction, DVec2>,
        prospects: &Prospects<'_>,
        limits: &Limits<Direction>,
        score: impl Fn(Direction) -> f64,
    ) {
        if limits.allow(candidate.along) {
            let score = prospects.worth(candidate.along) * candidate.score;
            self.within.push(Candidate { score, ..candidate });
            return;
        }
        self.out_of_reach.push(candidate);
        if let Some(along) = limits.nearest(candidate.along) {
            let score = prospects.worth(along) * score(along);
            self.within.push(Candidate { along, score, ..candidate });
        }
    }
}

/// For each edge of the lower bound the touch along its normal, with the area that it is expected to take off what is between the
/// bounds beyond the edge: all of it is one triangle for exact contacts.
pub(super) fn by_area(
    bounds: &ShapeBounds,
    prospects: &Prospects<'_>,
    limits: &Limits<Direction>,
) -> Candidates {
    let mut found = Candidates::none();
    // A lower bound that is a segment has two edges, one for each of its sides.
    let corners = bounds.lower_corners();
    let (2.., Some(upper)) = (corners.len(), bounds.upper().bounded()) else {
        // Of one point the farthest corner is the best there is.
        return by_distance(bounds, prospects, limits);
    };
    let upper = upper.shape();
    let mut summit = 0;
    for (a, b) in corners.iter().copied().zip(corners.iter().copied().cycle().skip(1)) {
        let Ok(along) = Direction::new(-(b - a).perp()) else { continue };
        summit = climb(upper, along.get(), summit);
        let top = upper.vertices()[summit];
        let score = expected_loss(upper, [a, b], along, summit, prospects);
        let candidate = Candidate { along, ray: [top, a.midpoint(b)], score };
        found.take(candidate, prospects, limits, |near| loss_along(bounds, upper, near, prospects));
    }
    found
}

/// For each corner of the upper bound the touch from its nearest point of the lower one, with their distance.
pub(super) fn by_distance(
    bounds: &ShapeBounds,
    prospects: &Prospects<'_>,
    limits: &Limits<Direction>,
) -> Candidates {
    let mut found = Candidates::none();
    let gaps = bounds.gaps();
    let middle = gaps.iter().map(|gap| gap.inner).sum::<DVec2>() / gaps.len().max(1) as f64;
    for gap in gaps {
        // Deeper than the nearest point, which may be a contact that a ray would only meet again.
        let ray = [gap.outer, gap.inner.midpoint(middle)];
        let candidate = Candidate { along: gap.direction, ray, score: gap.distance };
        found.take(candidate, prospects, limits, |near| {
            let (low, high) = bounds.support(near);
            high - low - prospects.out - prospects.inwards
        });
    }
    found
}

/// The corner farthest along `u`, from `start` around the outline.
fn climb(shape: &ConvexPolygon, u: DVec2, start: usize) -> usize {
    let (corners, count) = (shape.vertices(), shape.vertices().len());
    climbed(
        count,
        start,
        |k| [(k + 1) % count, (k + count - 1) % count],
        |k| corners[k].dot(u),
        |k| corners[k].abs().max_element(),
    )
}

/// Expected loss of area by a touch along the normal of the edge `[a, b]` of the lower bound.
fn expected_loss(
    upper: &ConvexPolygon,
    [a, b]: [DVec2; 2],
    along: Direction,
    summit: usize,
    prospects: &Prospects<'_>,
) -> f64 {
    let u = along.get();
    let (low, high) = (a.dot(u), upper.vertices()[summit].dot(u));
    if high <= low {
        return 0.0;
    }
    if prospects.out == 0.0 && prospects.inwards == 0.0 {
        return OF_A_TRIANGLE * area_beyond(upper, u, low, summit);
    }
    let one = |share: f64| {
        let height = low + share * (high - low);
        let gained = 0.5 * a.distance(b) * (height - prospects.inwards - low).max(0.0);
        area_beyond(upper, u, height + prospects.out, summit) + gained
    };
    HEIGHTS.into_iter().map(one).sum::<f64>() / HEIGHTS.len() as f64
}

/// The same along any direction: what the upper bound loses alone.
fn loss_along(
    bounds: &ShapeBounds,
    upper: &ConvexPolygon,
    along: Direction,
    prospects: &Prospects<'_>,
) -> f64 {
    let u = along.get();
    let summit = climb(upper, u, 0);
    let (low, high) = (bounds.support(along).0, upper.vertices()[summit].dot(u));
    let one = |share: f64| area_beyond(upper, u, low + share * (high - low) + prospects.out, summit);
    if high > low { HEIGHTS.into_iter().map(one).sum::<f64>() / HEIGHTS.len() as f64 } else { 0.0 }
}

/// Area of the polygon where `u . y > t`, by triangles from the summit to both sides.
fn area_beyond(shape: &ConvexPolygon, u: DVec2, t: f64, summit: usize) -> f64 {
    let (corners, count) = (shape.vertices(), shape.vertices().len());
    let top = corners[summit];
    if top.dot(u) <= t {
        return 0.0;
    }
    let side = |step: usize| {
        let mut area = 0.0;
        let mut previous = top;
        let mut at = summit;
        for _ in 0..count {
            at = (at + step) % count;
            let (from, to) = (previous.dot(u) - t, corners[at].dot(u) - t);
            let end = if to > 0.0 {
                corners[at]
            } else {
                previous + (corners[at] - previous) * (from / (from - to))
            };
            area += (previous - top).perp_dot(end - top).abs();
            previous = end;
            if to <= 0.0 {
                break;
            }
        }
        (area, previous)
    };
    let ((forwards, left), (backwards, right)) = (side(1), side(count - 1));
    0.5 * (forwards + backwards + (left - top).perp_dot(right - top).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Source;
    use shape_bounds::exact_hull::planar::{HalfPlane, Intersection};
    use shape_bounds::planar::ContactSample;

    /// Oracle: the upper bound made anew with one half-plane more.
    #[test]
    fn areas_beyond_a_line_are_those_of_a_new_bound() {
        let mut source = Source::new(3);
        let mut compared = 0;
        for count in [4, 7, 20] {
            let axes = DVec2::new(2.0, 1.0);
            let contacts: Vec<ContactSample> = (0..count)
                .map(|k| {
                    let n =
                        Direction::from_angle(f64::from(k) * 6.3 / f64::from(count) + 0.2 * source.unit());
                    let point = axes * axes * n.get() / (axes * n.get()).length();
                    ContactSample { point, normal: n }
                })
                .collect();
            let bounds = ShapeBounds::from_contacts(&contacts).unwrap();
            let Some(upper) = bounds.upper().bounded() else { continue };
            for _ in 0..50 {
                let along = Direction::from_angle(source.between(0.0, 7.0));
                let (low, high) = bounds.support(along);
                let t = source.between(low, high);
                let summit = climb(upper.shape(), along.get(), 0);
                let mut all: Vec<HalfPlane> = contacts.iter().map(ContactSample::half_plane).collect();
                all.push(HalfPlane { point: along.get() * t, normal: along, margin: 0.0 });
                let Ok(Intersection::Bounded(rest)) = Intersection::of(&all) else { panic!("open") };
                let area = area_beyond(upper.shape(), along.get(), t, summit);
                assert!((area - (upper.shape().area() - rest.shape().area())).abs() < 1e-12);
                compared += 1;
            }
        }
        assert!(compared >= 100);
    }
}

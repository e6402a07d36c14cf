//! Where a touch may pay, and how much.

use super::cap::{Caps, Growth};
use super::knowledge::Prospects;
use crate::limits::Limits;
use crate::touching::{Candidate, LEVEL, Score};
use contact_kinematics::Direction;
use glam::DVec3;
use shape_bounds::exact_hull::{Polyhedron, SolidHull, SupportWalk};
use shape_bounds::{Gap, ShapeBounds};

/// Heights at which the body may meet the touch, as shares of the way between the bounds: the middles of three equal parts.
const HEIGHTS: [f64; 3] = [1.0 / 6.0, 0.5, 5.0 / 6.0];
/// Corners of which the exact score is looked at. With fewer, all are; with more, those with the largest cells.
const SCORED: usize = 200;
pub(super) type Candidates = crate::touching::Candidates<Direction, DVec3>;

/// All candidates: towards each corner of the upper bound from its nearest point of the lower one, and along the normal of each
/// facet of the lower one.
pub(super) fn candidates(
    bounds: &ShapeBounds,
    upper: &Polyhedron,
    score: Score,
    prospects: &Prospects<'_>,
    limits: &Limits<Direction>,
) -> Candidates {
    let corners = largest_cells(upper, score);
    let gaps = bounds.gaps_at(&corners);
    let at_corners = corners.iter().zip(gaps).filter_map(|(corner, gap)| Some((*corner as u32, gap?)));
    let mut found = Candidates::none();
    let mut scorer =
        bounds.lower().solid().map(|lower| Scorer::new(upper, lower, (prospects.out, prospects.inwards)));
    let mut take = |along: Direction, segment: [DVec3; 2], aim: DVec3, corner: u32, distance: Option<f64>| {
        let ray = [segment[0], aim];
        let value = match (score, &mut scorer) {
            (Score::Volume, Some(scorer)) => scorer.volume(along, segment, corner),
            // Without a lower bound of any volume the farthest corner is the best there is.
            _ => distance.unwrap_or(0.0),
        };
        let candidate = Candidate { along, ray, score: prospects.worth(along) * value };
        if limits.allow(along) {
            found.within.push(candidate);
            return;
        }
        found.out_of_reach.push(candidate);
        if let Some(near) = limits.nearest(along) {
            let value = match (score, &mut scorer) {
                (Score::Volume, Some(scorer)) => scorer.volume(near, segment, corner),
                _ => bounds.gap_along(near) - prospects.out - prospects.inwards,
            };
            found.within.push(Candidate { along: near, ray, score: prospects.worth(near) * value });
        }
    };
    for (corner, Gap { direction, outer, inner, distance }) in at_corners {
        let aim = between_contacts(upper, corner);
        take(direction, [outer, inner], aim, corner, Some(distance));
    }
    if score == Score::Volume
        && let Some(lower) = bounds.lower().solid()
    {
        for (along, centre, summit) in facets(lower, upper) {
            take(along, [upper.vertices()[summit as usize], centre], centre, summit, None);
        }
    }
    found
}

/// The middle of the contacts of the three faces at a corner.
fn between_contacts(upper: &Polyhedron, corner: u32) -> DVec3 {
    let [a, b, c] = upper.faces_at(corner as usize).map(|f| upper.face_half_spaces()[f as usize].point);
    (a + b + c) / 3.0
}

/// The corners of the upper bound, or the [`SCORED`] with the largest cells if there are more, in the order of their numbers. The cell
/// of a corner is the tetrahedron that it makes with the contacts of its three faces, measured by its volume or by its height.
fn largest_cells(upper: &Polyhedron, score: Score) -> Vec<usize> {
    let mut corners: Vec<usize> = (0..upper.vertices().len()).collect();
    if corners.len() > SCORED {
        let size = |corner: usize| {
            let v = upper.vertices()[corner];
            let [a, b, c] = upper.faces_at(corner).map(|f| upper.face_half_spaces()[f as usize].point - v);
            let volume = a.cross(b).dot(c).abs();
            match score {
                Score::Volume => volume,
                Score::Distance => volume / (b - a).cross(c - a).length().max(f64::MIN_POSITIVE),
            }
        };
        let sizes: Vec<f64> = corners.iter().map(|k| size(*k)).collect();
        corners.select_nth_unstable_by(SCORED, |a, b| sizes[*b].total_cmp(&sizes[*a]).then(a.cmp(b)));
        corners.truncate(SCORED);
        corners.sort_unstable();
    }
    corners
}

/// Normals of facets of the lower bound, their centres and the corner of the upper bound above them: all of them, or the
/// [`SCORED`] with the most room above them.
fn facets(lower: &SolidHull, upper: &Polyhedron) -> Vec<(Direction, DVec3, u32)> {
    let caps = Caps::new(upper);
    let count = lower.triangles().len();
    let mut found = Vec::with_capacity(count);
    // From facet to neighbouring facet, so that each climb starts where the one before it ended, nearby.
    let (mut queue, mut met) = (vec![(0, 0)], vec![false; count]);
    met[0] = true;
    while let Some((facet, start)) = queue.pop() {
        let [a, b, c] = lower.corners(facet);
        let twice = (b - a).cross(c - a);
        let along = Direction::new(twice);
        let summit = along.map_or(start, |along| caps.summit(along.get(), start));
        if let Ok(along) = along {
            let room = (upper.vertices()[summit as usize] - a).dot(twice);
            found.push((facet, room, (along, (a + b + c) / 3.0, summit)));
        }
        for next in lower.neighbours()[facet].map(|f| f as usize) {
            if !met[next] {
                met[next] = true;
                queue.push((next, summit));
            }
        }
    }
    found.sort_unstable_by_key(|f| f.0);
    if found.len() > SCORED {
        found.select_nth_unstable_by(SCORED, |x, y| y.1.total_cmp(&x.1).then(x.0.cmp(&y.0)));
        found.truncate(SCORED);
        found.sort_unstable_by_key(|f| f.0);
    }
    found.into_iter().map(|(_, _, facet)| facet).collect()
}

/// Expected losses.
struct Scorer<'a> {
    upper: &'a Polyhedron,
    lower: &'a SolidHull,
    caps: Caps<'a>,
    growth: Growth<'a>,
    walk: SupportWalk<'a>,
    margins: (f64, f64),
    /// What the gap `1 - L / U` gains by a loss of `U` over what it gains by a growth of `L`: `L / U`.
    weight: f64,
}

impl<'a> Scorer<'a> {
    fn new(upper: &'a Polyhedron, lower: &'a SolidHull, margins: (f64, f64)) -> Self {
        let (caps, growth, walk) = (Caps::new(upper), Growth::new(lower), SupportWalk::new(lower));
        Self { upper, lower, caps, growth, walk, margins, weight: lower.volume() / upper.volume() }
    }

    /// Mean over [`HEIGHTS`] of what the upper bound loses to the half-space there, times `weight`, and the lower one gains by a point
    /// of the segment `ray` there.
    fn volume(&mut self, along: Direction, [outer, inner]: [DVec3; 2], corner: u32) -> f64 {
        let u = along.get();
        let near = self.walk.farthest_corner(u);
        let low = self.lower.vertices()[near].dot(u);
        let summit = self.caps.summit(u, corner);
        let high = self.upper.vertices()[summit as usize].dot(u);
        // Where the bounds meet but for rounding, where the body ends there is known: a touch would be one that was made.
        if high - low <= LEVEL * self.upper.vertices()[summit as usize].abs().max_element() {
            return 0.0;
        }
        let (from, to) = (inner.dot(u), outer.dot(u));
        let one = |share: f64| {
            let height = low + share * (high - low);
            let cut = self.caps.volume_beyond(u, height + self.margins.0, summit);
            let along_ray = ((height - self.margins.1 - from) / (to - from)).clamp(0.0, 1.0);
            let point = if along_ray.is_finite() { inner.lerp(outer, along_ray) } else { inner };
            self.weight * cut + self.growth.volume_with(point, near as u32)
        };
        HEIGHTS.into_iter().map(one).sum::<f64>() / HEIGHTS.len() as f64
    }
}

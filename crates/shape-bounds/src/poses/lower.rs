//! What is certainly inside of a body that was seen to touch a plane.

use super::Observation;
use crate::erosion::eroded_hull;
use exact_hull::HalfSpace;
use exact_hull::Polyhedron;
use glam::DVec3;

/// Shares of the touching poses, best first, of which each makes a region; a few well-known points can prove more than
/// many vague ones.
const SHARES: [f64; 5] = [0.05, 0.15, 0.3, 0.5, 0.8];

/// Corners of regions that lie in the body, if no touching half-space is off by more than `margin` and its gap.
///
/// A body that touches a plane has a point in the part of the upper bound that is within the margins of the plane. A
/// ball about that part holds the point.
pub(super) fn certain_points(observations: &[Observation], upper: &Polyhedron, margin: f64) -> Vec<DVec3> {
    let mut caps = upper.caps();
    let mut balls: Vec<(DVec3, f64)> = observations
        .iter()
        .filter(|o| o.touching)
        .filter_map(|o| {
            let touched = HalfSpace { margin: -(margin + o.gap), ..o.half_space };
            caps.ball(&touched)
        })
        .collect();
    balls.sort_unstable_by(|a, b| a.1.total_cmp(&b.1));
    let best = |share: f64| {
        let few = &balls[..(balls.len() as f64 * share).ceil() as usize];
        let centres: Vec<DVec3> = few.iter().map(|b| b.0).collect();
        eroded_hull(&centres, |k, _| few[k].1)
    };
    SHARES.iter().flat_map(|share| best(*share)).collect()
}

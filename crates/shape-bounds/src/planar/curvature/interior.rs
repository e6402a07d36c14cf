//! A point inside of discs and half-planes, or which few of them have nothing in common.

use super::Disc;
use exact_hull::planar::interior_point;
use exact_hull::planar::{Direction, HalfPlane, IntersectionError};
use glam::DVec2;

/// Cuts before the search is content with what it has; a few are enough but for lenses thinner than a millionth.
const CUTS: usize = 200;

/// A point in the interior of all, or the indices of at most three that have no interior in common (Helly): discs first, then
/// half-planes.
///
/// The centre of the largest disc in the tangents that have been met is tried; where a disc is left, its tangent there is met next
/// (the central cutting planes of Elzinga and Moore, 1975). Tangents without a common interior are the proof that the discs have
/// none.
pub(super) fn common_point(discs: &[Disc], half_planes: &[HalfPlane]) -> Result<DVec2, Vec<usize>> {
    let tangent = |disc: &Disc, normal: Direction| HalfPlane {
        point: disc.centre + normal.get() * disc.radius,
        normal,
        margin: 0.0,
    };
    let mut cuts = half_planes.to_vec();
    let mut sources: Vec<usize> = (discs.len()..discs.len() + half_planes.len()).collect();
    for angle in [0.0, 2.0, 4.0] {
        let smallest = discs.iter().enumerate().min_by(|a, b| a.1.radius.total_cmp(&b.1.radius));
        let Some((source, disc)) = smallest else { break };
        cuts.push(tangent(disc, Direction::from_angle(angle)));
        sources.push(source);
    }
    for _ in 0..CUTS {
        let point = match interior_point(&cuts) {
            Ok(point) => point,
            Err(
                IntersectionError::Contradiction { conflict, .. }
                | IntersectionError::NoInterior { tight: conflict, .. },
            ) => {
                return Err(smallest(conflict.iter().map(|k| sources[*k]).collect(), discs, half_planes));
            }
            Err(_) => break,
        };
        let beyond = |disc: &Disc| point.distance(disc.centre) - disc.radius;
        let farthest = discs.iter().enumerate().max_by(|a, b| beyond(a.1).total_cmp(&beyond(b.1)));
        let Some((source, disc)) = farthest.filter(|(_, disc)| beyond(disc) >= 0.0) else {
            return Ok(point);
        };
        let Ok(normal) = Direction::new(point - disc.centre) else { break };
        cuts.push(tangent(disc, normal));
        sources.push(source);
    }
    Err((0..discs.len() + half_planes.len()).collect())
}

/// Without repeated ones; where two of the three are apart already, these.
fn smallest(mut conflict: Vec<usize>, discs: &[Disc], half_planes: &[HalfPlane]) -> Vec<usize> {
    conflict.sort_unstable();
    conflict.dedup();
    let apart = |a: usize, b: usize| match (discs.get(a), discs.get(b)) {
        (Some(one), Some(other)) => one.centre.distance(other.centre) >= one.radius + other.radius,
        (Some(disc), None) => half_planes[b - discs.len()].excess(disc.centre) >= disc.radius,
        _ => false,
    };
    let pairs = conflict.iter().enumerate().flat_map(|(k, a)| conflict[k + 1..].iter().map(|b| (*a, *b)));
    match pairs.into_iter().find(|(a, b)| apart(*a, *b)) {
        Some((a, b)) => vec![a, b],
        None => conflict,
    }
}

#[cfg(test)]
mod tests {
    use crate::generators::Source;
    use crate::planar::curvature::{CurvatureError, Disc, DiscIntersection};
    use exact_hull::planar::{Direction, HalfPlane};
    use glam::DVec2;

    #[test]
    fn a_conflict_is_empty_and_nothing_can_be_left_out() {
        let mut conflicts = [0; 4];
        for seed in 0..300 {
            let mut s = Source::new(seed);
            let place = |s: &mut Source| DVec2::new(s.normal(), s.normal());
            let discs: Vec<Disc> =
                (0..12).map(|_| Disc { centre: place(&mut s) * 0.4, radius: 0.8 }).collect();
            let planes: Vec<HalfPlane> = (0..3)
                .map(|_| HalfPlane {
                    point: place(&mut s) * 0.8,
                    normal: Direction::new(place(&mut s)).unwrap(),
                    margin: 0.0,
                })
                .collect();
            let Err(CurvatureError::Empty { conflict, count: 15 }) = DiscIntersection::of(&discs, &planes)
            else {
                continue;
            };
            conflicts[conflict.len()] += 1;
            let of = |kept: &[usize]| {
                let (round, flat): (Vec<usize>, Vec<usize>) = kept.iter().partition(|k| **k < 12);
                let round: Vec<Disc> = round.iter().map(|k| discs[*k]).collect();
                let flat: Vec<HalfPlane> = flat.iter().map(|k| planes[*k - 12]).collect();
                DiscIntersection::of(&round, &flat)
            };
            if conflict.iter().any(|k| *k < 12) {
                assert!(matches!(of(&conflict), Err(CurvatureError::Empty { .. })), "seed {seed}");
            }
            for k in 0..conflict.len() {
                let mut fewer = conflict.clone();
                fewer.remove(k);
                assert!(!matches!(of(&fewer), Err(CurvatureError::Empty { count: 1.., .. })), "seed {seed}");
            }
        }
        // Pairs and triples both occur, and never more.
        assert!(conflicts[2] > 20 && conflicts[3] > 5, "{conflicts:?}");
    }

    #[test]
    fn three_discs_that_meet_in_pairs_alone_are_named() {
        let corner = |k: u32| DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 3.0);
        let disc = |centre| Disc { centre, radius: 0.9 };
        let mut discs = vec![disc(DVec2::ZERO); 5];
        for (place, k) in [1, 3, 4].into_iter().zip(0..) {
            discs[place] = disc(corner(k));
        }
        assert!(matches!(
            DiscIntersection::of(&discs, &[]),
            Err(CurvatureError::Empty { count: 5, conflict }) if conflict == [1, 3, 4]
        ));
    }
}

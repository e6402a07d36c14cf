//! Which few of many convex sets have nothing in common.

/// A smallest part of `0..count` that is empty, when all of them are: none of its members can be left out.
///
/// `empty` says whether the sets of these indices have no interior in common; once it is true it must stay so as sets are
/// added. By Helly's theorem three convex sets in the plane are enough. Each member is the last of the shortest
/// beginning that contradicts those found before, which a bisection finds (the additive method of constraint
/// satisfaction): about `3 log2 count` questions.
pub(super) fn smallest_conflict(count: usize, empty: impl Fn(&[usize]) -> bool) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    while found.len() < count && !empty(&found) {
        // The first `low` and what is found are not empty, with the first `high` they are.
        let (mut low, mut high) = (0, count);
        while high - low > 1 {
            let middle = low.midpoint(high);
            let some: Vec<usize> = found.iter().copied().chain(0..middle).collect();
            if empty(&some) { high = middle } else { low = middle }
        }
        if found.contains(&low) {
            // Rounding denies that less than all is empty.
            return (0..count).collect();
        }
        found.push(low);
    }
    found.sort_unstable();
    found
}

#[cfg(test)]
mod tests {
    use crate::generators::Source;
    use crate::planar::{CurvatureError, Direction, Disc, DiscIntersection, HalfPlane};
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

//! What lies next to each other as one.

use glam::{DVec3, IVec3};
use std::collections::HashMap;

/// Pairs of points in groups: those of which some are nearer to each other than `near`, m.
pub(super) fn groups(pairs: &[[DVec3; 2]], near: f64) -> Vec<Vec<usize>> {
    let cell = |p: DVec3| (p / near).floor().as_ivec3();
    let mut cells = HashMap::<IVec3, Vec<usize>>::new();
    for (k, pair) in pairs.iter().enumerate() {
        pair.iter().for_each(|p| cells.entry(cell(*p)).or_default().push(k));
    }
    let (mut all, mut taken) = (Vec::new(), vec![false; pairs.len()]);
    for first in 0..pairs.len() {
        if std::mem::replace(&mut taken[first], true) {
            continue;
        }
        let mut group = vec![first];
        let mut at = 0;
        while at < group.len() {
            for p in pairs[group[at]] {
                let around = (0..27).map(|d| cell(p) + IVec3::new(d % 3 - 1, d / 3 % 3 - 1, d / 9 - 1));
                let beside: Vec<usize> = around.filter_map(|c| cells.get(&c)).flatten().copied().collect();
                for k in beside {
                    if !taken[k] && pairs[k].iter().any(|q| q.distance(p) < near) {
                        taken[k] = true;
                        group.push(k);
                    }
                }
            }
            at += 1;
        }
        all.push(group);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_of_near_pairs_are_one_group() {
        let at = |x: f64| [DVec3::X * x, DVec3::X * x + DVec3::Y];
        let pairs = [at(0.0), at(5.0), at(0.9), at(1.8), at(5.5)];
        assert_eq!(groups(&pairs, 1.0), [vec![0, 2, 3], vec![1, 4]]);
        assert!(groups(&[], 1.0).is_empty());
        // Either end will do, on whichever side of a cell's wall it is.
        assert_eq!(groups(&[[DVec3::ZERO; 2], [DVec3::X * 9.0, DVec3::NEG_X * 0.5]], 1.0).len(), 1);
    }
}

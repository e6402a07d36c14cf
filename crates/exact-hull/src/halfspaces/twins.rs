//! Planes that are nearly one, as those of many contacts on one flat side: their corners are off by rounding over the angle between
//! them.

use crate::HalfSpace;
use glam::DVec3;

/// Two planes are one if their normals, and their distances from the interior relative to the largest, differ by no more.
pub(crate) const TWINS: f64 = 1e-9;

/// A direction that no data single out.
const ASKEW: DVec3 = DVec3::new(0.482_716, -0.613_902, 0.624_581);

/// The half-spaces with one of each set of twins, the farthest out, in the place of all; none where there are no twins. What the others would
/// have cut off is thinner than [`TWINS`] of the size.
pub(super) fn joined(half_spaces: &[HalfSpace], interior: DVec3) -> Option<Vec<HalfSpace>> {
    let distance: Vec<f64> = half_spaces.iter().map(|h| -h.excess(interior)).collect();
    let largest = distance.iter().copied().fold(0.0, f64::max);
    let along: Vec<f64> = half_spaces.iter().map(|h| ASKEW.dot(h.normal.get())).collect();
    let mut order: Vec<usize> = (0..half_spaces.len()).collect();
    order.sort_unstable_by(|a, b| along[*a].total_cmp(&along[*b]));
    let mut stands_for: Vec<usize> = (0..half_spaces.len()).collect();
    for (at, &first) in order.iter().enumerate() {
        if stands_for[first] != first {
            continue;
        }
        let near = order[at + 1..].iter().take_while(|k| along[**k] - along[first] <= 2.0 * TWINS);
        let mut of: Vec<usize> = near
            .copied()
            .filter(|&k| {
                let apart = (half_spaces[k].normal.get() - half_spaces[first].normal.get()).abs();
                stands_for[k] == k
                    && apart.max_element() <= TWINS
                    && (distance[k] - distance[first]).abs() <= TWINS * largest
            })
            .collect();
        of.push(first);
        let farthest = of.iter().copied().fold(first, |a, b| if distance[b] > distance[a] { b } else { a });
        of.iter().for_each(|k| stands_for[*k] = farthest);
    }
    let has_twins = stands_for.iter().enumerate().any(|(k, other)| k != *other);
    has_twins.then(|| stands_for.into_iter().map(|k| half_spaces[k]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use unit_direction::Direction;

    /// Planes that are nearly one become the farthest one out, wherever they stand in the order; what differs by more stays.
    #[test]
    fn twins_are_joined_to_the_farthest_out() {
        let at = |normal: DVec3, distance: f64| {
            let normal = Direction::new(normal).unwrap();
            HalfSpace { point: normal.get() * distance, normal, margin: 0.0 }
        };
        for axis in [DVec3::X, -DVec3::X, ASKEW, -ASKEW] {
            let across = axis.any_orthonormal_vector();
            let near = at(axis + across * 0.3 * TWINS, 1.0);
            let far = at(axis, 1.0 + 0.5 * TWINS);
            let tilted = at(axis + across * 4.0 * TWINS, 1.0);
            let inner = at(axis, 1.0 - 4.0 * TWINS);
            for pair in [[near, far], [far, near]] {
                let spaces = [at(across, 1.0), pair[0], tilted, pair[1], inner];
                assert_eq!(joined(&spaces, DVec3::ZERO).unwrap(), [spaces[0], far, tilted, far, inner]);
            }
            assert!(joined(&[far, tilted, inner], DVec3::ZERO).is_none());
        }
    }
}

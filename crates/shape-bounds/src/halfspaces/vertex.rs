//! Corners of an intersection of half-spaces, computed in two ways.

use crate::sample::HalfSpace;
use crate::twofold::cross_of_differences;
use glam::DVec3;

/// The point common to three planes that may be as close to parallel as neighbouring samples of a dense curve are.
///
/// With `y = x_i + t`, the rows are `n_i`, `n_j - n_i`, `n_k - n_i` and the right-hand sides `m_i`,
/// `n_j . (x_j - x_i) + m_j - m_i` and likewise for `k`: differences of neighbouring data, in which nothing cancels that
/// is not small itself. The plain system loses all digits that the planes have in common. Not finite where the planes
/// have no common point.
pub(super) fn common_point([i, j, k]: [&HalfSpace; 3]) -> DVec3 {
    let n = i.normal.get();
    let (a, b) = (j.normal.get() - n, k.normal.get() - n);
    let offset_j = j.normal.get().dot(j.point - i.point) + (j.margin - i.margin);
    let offset_k = k.normal.get().dot(k.point - i.point) + (k.margin - i.margin);
    let across = a.cross(b);
    let determinant = n.dot(across);
    let numerator = across * i.margin + b.cross(n) * offset_j + n.cross(a) * offset_k;
    i.point + numerator / determinant
}

/// The polar of the plane through three dual points, as seen from the centre of the duality.
///
/// Where the facet is a sliver, its normal is computed with twofold precision: the corner then satisfies the three
/// rounded planes to rounding, however ill-conditioned its position along them is.
pub(super) fn polar_corner([i, j, k]: [DVec3; 3]) -> DVec3 {
    let (a, b) = (j - i, k - i);
    let mut normal = a.cross(b);
    // The rounded normal, off by e |a| |b|, would miss the plane of `j` by e |a|^2 |b| / (|normal| |i|).
    let (aa, bb) = (a.length_squared(), b.length_squared());
    if 256.0 * normal.length_squared() * i.length_squared() < aa * bb * aa.max(bb) {
        normal = cross_of_differences(i, j, k);
    }
    normal / normal.dot(i)
}

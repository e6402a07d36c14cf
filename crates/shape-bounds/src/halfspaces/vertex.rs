//! Where three planes meet, computed in the neighbourhood of their contact points.

use crate::sample::HalfSpace;
use glam::DVec3;

/// The point common to the three planes, which may be as close to parallel as neighbouring samples of a dense curve are.
///
/// With `y = x_i + t`, the rows are `n_i`, `n_j - n_i`, `n_k - n_i` and the right-hand sides `m_i`,
/// `n_j . (x_j - x_i) + m_j - m_i` and likewise for `k`: differences of neighbouring data, in which nothing cancels that
/// is not small itself. The plain system loses all digits that the planes have in common.
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

//! Corners of an intersection of half-spaces, computed in two ways.

use crate::HalfSpace;
use crate::predicates::UNIT_ROUNDOFF;
use crate::twofold::{Twofold, cross_of_differences};
use glam::DVec3;

/// A corner whose bound on its error is below this many tolerances, about 1e-12 of the size, needs no refinement.
const GOOD: f64 = 1000.0;
/// Rounding of the planes' offsets is amplified by at most so much in a corner whose place is sure: to 1e-7 of the size.
const LOOSE: f64 = 1e9;
/// Refinements at most. The inverse has some correct digits, or the planes have no point in common to speak of; so one or
/// two steps are enough.
const STEPS: usize = 4;
/// A step below this many times the tolerance is the last: what it leaves, at most 1e-11 of the size, is
/// smaller by the accuracy of the inverse.
const CONVERGED: f64 = 1e4;

/// The inverse of the system of three planes, as columns: `y = x_i + first m_i + second d_j + third d_k`.
///
/// With `y = x_i + t`, the rows are `n_i`, `n_j - n_i`, `n_k - n_i` and the right-hand sides `m_i`,
/// `n_j . (x_j - x_i) + m_j - m_i` and likewise for `k`: differences of neighbouring data, in which nothing cancels that
/// is not small itself. The plain system loses all digits that the planes have in common.
struct Inverse {
    first: DVec3,
    second: DVec3,
    third: DVec3,
    /// Sizes of the second and the third row, and of both divided by the determinant.
    rows: [f64; 2],
    ratio: f64,
}

impl Inverse {
    /// Not finite where the planes have no common point.
    #[inline]
    fn of([i, j, k]: [&HalfSpace; 3]) -> Self {
        let n = i.normal.get();
        let (a, b) = (j.normal.get() - n, k.normal.get() - n);
        let across = a.cross(b);
        let scale = 1.0 / n.dot(across);
        let rows = [size(a), size(b)];
        let ratio = rows[0] * rows[1] * scale.abs();
        Self { first: across * scale, second: b.cross(n) * scale, third: n.cross(a) * scale, rows, ratio }
    }

    #[inline]
    fn apply(&self, [i, j, k]: [f64; 3]) -> DVec3 {
        self.first * i + self.second * j + self.third * k
    }

    /// Bound on the rounding of the common point `x_i + t` where the planes' points are `d` from `x_i`.
    ///
    /// With `e` the unit roundoff, rows `a`, `b` and `r = |a| |b| / |det|`: products and determinant are off by at most
    /// `3 e |a| |b|` and `6 e |a| |b|`, the rows by `e |a|` and `e |b|`, the sums by three roundings; in all 20 e r |t|.
    /// Right-hand sides are off by `4 e |d|`, which the columns, of at most `r / |a|` and `r / |b|`, take to the point.
    #[inline]
    fn rounding(&self, t: DVec3, [d, e]: [DVec3; 2]) -> f64 {
        let [a, b] = self.rows;
        UNIT_ROUNDOFF * self.ratio * (20.0 * size(t) + 4.0 * (size(d) / a + size(e) / b))
    }
}

/// The sum of the sizes of the coordinates: at least the length.
#[inline]
fn size(v: DVec3) -> f64 {
    v.x.abs() + v.y.abs() + v.z.abs()
}

/// The same planes, in the same cyclic order, the two with the closest normals first: their difference is then a row.
#[inline]
fn closest_first([i, j, k]: [&HalfSpace; 3]) -> [&HalfSpace; 3] {
    let apart = |a: &HalfSpace, b: &HalfSpace| size(a.normal.get() - b.normal.get());
    let (ij, jk, ki) = (apart(i, j), apart(j, k), apart(k, i));
    if ij <= jk && ij <= ki {
        [i, j, k]
    } else if jk <= ki {
        [j, k, i]
    } else {
        [k, i, j]
    }
}

/// The point common to three planes that may be as close to parallel as neighbouring samples of a dense curve are, to
/// rounding of the point and of the planes' heights at it, `tolerance`; none where they have none, to that accuracy.
///
/// Where the planes determine the point badly, it is refined with residuals in twofold precision: then it is the point common
/// to the planes as given, to rounding, as long as the inverse has one correct digit; and then it is said not to be well
/// determined.
#[inline]
pub(super) fn common_point(planes: [&HalfSpace; 3], tolerance: f64) -> Option<(DVec3, bool)> {
    let planes = closest_first(planes);
    let [i, j, k] = planes;
    let inverse = Inverse::of(planes);
    let (d, e) = (j.point - i.point, k.point - i.point);
    let offset_j = j.normal.get().dot(d) + (j.margin - i.margin);
    let offset_k = k.normal.get().dot(e) + (k.margin - i.margin);
    let t = inverse.apply([i.margin, offset_j, offset_k]);
    let point = i.point + t;
    let common = |point: DVec3| planes.iter().all(|h| h.excess(point).abs() <= tolerance);
    let sure = size(inverse.second) + size(inverse.third) <= LOOSE;
    if inverse.rounding(t, [d, e]) <= GOOD * tolerance && common(point) {
        return Some((point, sure));
    }
    let point = refined(planes, &inverse, point, tolerance);
    common(point).then_some((point, false))
}

/// Steps of Newton's method until they are below rounding.
#[cold]
fn refined(planes: [&HalfSpace; 3], inverse: &Inverse, start: DVec3, tolerance: f64) -> DVec3 {
    let mut point = start;
    for _ in 0..STEPS {
        let [i, j, k] = planes.map(|h| excess(h, point));
        let step = inverse.apply([i.value(), j.minus(i), k.minus(i)]);
        point -= step;
        if step.abs().max_element() <= CONVERGED * tolerance {
            break;
        }
    }
    point
}

/// [`HalfSpace::excess`] in twofold precision.
fn excess(h: &HalfSpace, y: DVec3) -> Twofold {
    let n = h.normal.get();
    (0..3).fold(Twofold::from(-h.margin), |sum, axis| {
        sum.plus(Twofold::difference(y[axis], h.point[axis]).times(Twofold::from(n[axis])))
    })
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

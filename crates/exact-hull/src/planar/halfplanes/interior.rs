//! A point well inside of all half-planes, or the proof that there is none.

use super::IntersectionError;
use crate::planar::HalfPlane;
use glam::{DMat3, DVec2, DVec3};

/// The inradius, relative to the size of the data, below which rounding decides whether there is an interior.
const FLAT: f64 = 1e-13;
/// A start is good enough as a centre if it is this deep inside of all half-planes, relative to the size of the data.
const DEEP: f64 = 1e-2;
/// Inradii, relative to the size of the data, of the triangles in which a centre is looked for, one after the other.
const REACH: [f64; 2] = [2.0, 1e6];
/// Exchanges before the search is content with what it has. A handful suffices in practice.
const EXCHANGES: usize = 500;
/// Pivots below this are taken for zero.
const PIVOT: f64 = 1e-11;

/// A point strictly inside of all half-planes, of which there is one at least: their mean point where that is deep inside, the
/// centre of the largest disc otherwise.
///
/// # Errors
/// [`IntersectionError::Contradiction`] and [`IntersectionError::NoInterior`].
pub fn interior_point(half_planes: &[HalfPlane]) -> Result<DVec2, IntersectionError> {
    let mean = half_planes.iter().map(|h| h.point).sum::<DVec2>() / half_planes.len() as f64;
    let size = half_planes.iter().map(|h| h.point.distance(mean) + h.margin.abs()).fold(0.0, f64::max);
    let size = if size > 0.0 { size } else { 1.0 };
    let slack = |y: DVec2| half_planes.iter().map(|h| -h.excess(y)).fold(f64::INFINITY, f64::min);
    if slack(mean) > DEEP * size {
        return Ok(mean);
    }
    let mut best = Exchange::new(half_planes, mean, REACH[0] * size).run(size);
    if best.inradius <= FLAT * size {
        best = Exchange::new(half_planes, mean, REACH[1] * size).run(size);
    }
    if best.inradius > FLAT * size && slack(best.centre) > 0.0 {
        Ok(best.centre)
    } else if best.inradius < -FLAT * size {
        Err(IntersectionError::Contradiction { conflict: best.tight, deficit: -best.inradius })
    } else {
        Err(IntersectionError::NoInterior { tight: best.tight, inradius: best.inradius })
    }
}

struct Inscribed {
    centre: DVec2,
    inradius: f64,
    tight: Vec<usize>,
}

/// The largest disc in all half-planes and a large triangle: `max t : n_k . z + t <= b_k`, by the dual simplex method on
/// three tight constraints with multipliers `l >= 0`, `sum l = 1`, `sum l n = 0`.
///
/// At the optimum the constraints with positive multipliers are tight, and none can be left out: if `t < 0` they are
/// contradictory (Farkas), and any proper subset of them is not, because its normals have no such multipliers.
struct Exchange<'a> {
    half_planes: &'a [HalfPlane],
    mean: DVec2,
    reach: f64,
    basis: [usize; 3],
}

impl<'a> Exchange<'a> {
    fn new(half_planes: &'a [HalfPlane], mean: DVec2, reach: f64) -> Self {
        let n = half_planes.len();
        Self { half_planes, mean, reach, basis: [n, n + 1, n + 2] }
    }

    /// Row `(n_k, 1)` and right-hand side `b_k`.
    fn row(&self, k: usize) -> (DVec3, f64) {
        const S: f64 = 0.866_025_403_784_438_6;
        const SIDES: [DVec2; 3] = [DVec2::new(0.0, 1.0), DVec2::new(-S, -0.5), DVec2::new(S, -0.5)];
        match self.half_planes.get(k) {
            Some(h) => (h.normal.get().extend(1.0), -h.excess(self.mean)),
            None => (SIDES[k - self.half_planes.len()].extend(1.0), self.reach),
        }
    }

    fn run(mut self, size: f64) -> Inscribed {
        let mut best = self.solve();
        for _ in 0..EXCHANGES {
            let (mut worst, mut entering) = (1e-15 * size, None);
            for (k, h) in self.half_planes.iter().enumerate() {
                let violation = h.excess(self.mean + best.0.truncate()) + best.0.z;
                if violation > worst {
                    (worst, entering) = (violation, Some(k));
                }
            }
            let Some(entering) = entering else { break };
            let Some(leaving) = self.leaving(entering) else { break };
            self.basis[leaving] = entering;
            let next = self.solve();
            // In exact arithmetic the disc never grows; when it does, rounding has the word.
            if !next.0.is_finite() || next.0.z > best.0.z + 1e-9 * size {
                break;
            }
            best = next;
        }
        let (solution, multipliers) = best;
        let mut tight: Vec<usize> = (0..3)
            .filter(|&i| multipliers[i] > PIVOT && self.basis[i] < self.half_planes.len())
            .map(|i| self.basis[i])
            .collect();
        tight.sort_unstable();
        Inscribed { centre: self.mean + solution.truncate(), inradius: solution.z, tight }
    }

    /// The basis as columns `(n, 1)`.
    fn columns(&self) -> DMat3 {
        let [a, b, c] = self.basis.map(|k| self.row(k).0);
        DMat3::from_cols(a, b, c)
    }

    /// `(z, t)` where the three constraints are tight, and their multipliers.
    fn solve(&self) -> (DVec3, DVec3) {
        let inverse = self.columns().inverse();
        let offsets = DVec3::from_array(self.basis.map(|k| self.row(k).1));
        (inverse.transpose() * offsets, inverse * DVec3::Z)
    }

    /// Which basis member makes room for `entering`, by the ratio test.
    fn leaving(&self, entering: usize) -> Option<usize> {
        let inverse = self.columns().inverse();
        let multipliers = inverse * DVec3::Z;
        let pivots = inverse * self.row(entering).0;
        (0..3)
            .filter(|&i| pivots[i] > PIVOT)
            .min_by(|&i, &j| (multipliers[i] / pivots[i]).total_cmp(&(multipliers[j] / pivots[j])))
    }
}

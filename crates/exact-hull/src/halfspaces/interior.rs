//! A point well inside of all half-spaces, or the proof that there is none.

use super::IntersectionError;
use crate::HalfSpace;
use glam::{DMat4, DVec3, DVec4};

/// The inradius, relative to the size of the data, below which rounding decides whether there is an interior.
const FLAT: f64 = 1e-13;
/// A start is good enough as a centre if it is this deep inside of all half-spaces, relative to the size of the data.
const DEEP: f64 = 1e-2;
/// Inradii, relative to the size of the data, of the tetrahedra in which a centre is looked for, one after the other.
const REACH: [f64; 2] = [2.0, 1e6];
/// Exchanges before the search is content with what it has. A handful suffices in practice.
const EXCHANGES: usize = 500;
/// Pivots below this are taken for zero.
const PIVOT: f64 = 1e-11;

/// A point strictly inside of all half-spaces.
pub(super) fn interior_point(half_spaces: &[HalfSpace]) -> Result<DVec3, IntersectionError> {
    let mean = half_spaces.iter().map(|h| h.point).sum::<DVec3>() / half_spaces.len() as f64;
    let size = half_spaces.iter().map(|h| h.point.distance(mean) + h.margin.abs()).fold(0.0, f64::max);
    if size.is_infinite() {
        let farthest = |h: &HalfSpace| h.point.abs().max_element().max(h.margin.abs());
        let far = half_spaces.iter().enumerate().max_by(|(_, a), (_, b)| farthest(a).total_cmp(&farthest(b)));
        if let Some((index, &HalfSpace { point, margin, .. })) = far {
            return Err(IntersectionError::TooFar { index, point, margin });
        }
    }
    let size = if size > 0.0 { size } else { 1.0 };
    let slack = |y: DVec3| half_spaces.iter().map(|h| -h.excess(y)).fold(f64::INFINITY, f64::min);
    if slack(mean) > DEEP * size {
        return Ok(mean);
    }
    let mut found = None;
    for reach in REACH {
        let best = Exchange::new(half_spaces, mean, reach * size).run(size);
        let roomy = best.inradius > FLAT * size;
        found = Some(best);
        if roomy {
            break;
        }
    }
    // REACH is not empty, so the search ran.
    let Some(best) = found else { return Ok(mean) };
    if best.inradius > FLAT * size && slack(best.centre) > 0.0 {
        Ok(best.centre)
    } else if best.inradius < -FLAT * size {
        Err(IntersectionError::Contradiction { conflict: best.tight, deficit: -best.inradius })
    } else {
        Err(IntersectionError::NoInterior { tight: best.tight, inradius: best.inradius })
    }
}

struct Inscribed {
    centre: DVec3,
    inradius: f64,
    tight: Vec<usize>,
}

/// The largest ball in all half-spaces and a large tetrahedron: `max t : n_k . z + t <= b_k`, by the dual simplex
/// method (an exchange algorithm) on four tight constraints with multipliers `l >= 0`, `sum l = 1`, `sum l n = 0`.
///
/// At the optimum the constraints with positive multipliers are tight, and none can be left out: if `t < 0` they are
/// contradictory (Farkas), and any proper subset of them is not, because its normals have no such multipliers.
struct Exchange<'a> {
    half_spaces: &'a [HalfSpace],
    mean: DVec3,
    /// Offset of the artificial tetrahedron's planes.
    reach: f64,
    basis: [usize; 4],
}

impl<'a> Exchange<'a> {
    fn new(half_spaces: &'a [HalfSpace], mean: DVec3, reach: f64) -> Self {
        let n = half_spaces.len();
        Self { half_spaces, mean, reach, basis: [n, n + 1, n + 2, n + 3] }
    }

    /// Row `(n_k, 1)` and right-hand side `b_k`.
    fn row(&self, k: usize) -> (DVec4, f64) {
        const S: f64 = 0.577_350_269_189_625_8;
        const CORNERS: [DVec3; 4] =
            [DVec3::new(S, S, S), DVec3::new(S, -S, -S), DVec3::new(-S, S, -S), DVec3::new(-S, -S, S)];
        match self.half_spaces.get(k) {
            Some(h) => (h.normal.get().extend(1.0), -h.excess(self.mean)),
            None => (CORNERS[k - self.half_spaces.len()].extend(1.0), self.reach),
        }
    }

    fn run(mut self, size: f64) -> Inscribed {
        let mut best = self.solve();
        for _ in 0..EXCHANGES {
            let z = best.0.truncate();
            let (mut worst, mut entering) = (1e-15 * size, None);
            for (k, h) in self.half_spaces.iter().enumerate() {
                let violation = h.excess(self.mean + z) + best.0.w;
                if violation > worst {
                    (worst, entering) = (violation, Some(k));
                }
            }
            let Some(entering) = entering else { break };
            let Some(leaving) = self.leaving(entering) else { break };
            self.basis[leaving] = entering;
            let next = self.solve();
            // In exact arithmetic the ball never grows; when it does, rounding has the word.
            if !next.0.is_finite() || next.0.w > best.0.w + 1e-9 * size {
                break;
            }
            best = next;
        }
        let (solution, multipliers) = best;
        let mut tight: Vec<usize> = (0..4)
            .filter(|&i| multipliers[i] > PIVOT && self.basis[i] < self.half_spaces.len())
            .map(|i| self.basis[i])
            .collect();
        tight.sort_unstable();
        Inscribed { centre: self.mean + solution.truncate(), inradius: solution.w, tight }
    }

    /// The basis as columns `(n, 1)`.
    fn columns(&self) -> DMat4 {
        let [a, b, c, d] = self.basis.map(|k| self.row(k).0);
        DMat4::from_cols(a, b, c, d)
    }

    /// `(z, t)` where the four constraints are tight, and their multipliers.
    fn solve(&self) -> (DVec4, DVec4) {
        let inverse = self.columns().inverse();
        let offsets = DVec4::from_array(self.basis.map(|k| self.row(k).1));
        (inverse.transpose() * offsets, inverse * DVec4::W)
    }

    /// Which basis member makes room for `entering`, by the ratio test.
    fn leaving(&self, entering: usize) -> Option<usize> {
        let inverse = self.columns().inverse();
        let multipliers = inverse * DVec4::W;
        let pivots = inverse * self.row(entering).0;
        (0..4)
            .filter(|&i| pivots[i] > PIVOT)
            .min_by(|&i, &j| (multipliers[i] / pivots[i]).total_cmp(&(multipliers[j] / pivots[j])))
    }
}

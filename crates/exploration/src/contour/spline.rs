//! Smooth outlines through points.

use super::outline::{OutlinePoint, SmoothOutline};
use glam::DVec2;
use std::f64::consts::TAU;
use thiserror::Error;

/// Why points are no outline.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum OutlineError {
    /// Fewer than a closed curve needs.
    #[error("an outline of {0} points; it takes 4 at least")]
    TooFew(usize),
    /// A coordinate that is none.
    #[error("point {0} of the outline is not finite")]
    NotFinite(usize),
    /// Two that are one.
    #[error("points {0} and the one after it are one; leave one of them out, also at the end")]
    Twice(usize),
    /// It crosses itself, or encloses nothing.
    #[error("the outline crosses itself near ({x} m, {y} m)")]
    Crosses {
        /// Where.
        x: f64,
        /// Where.
        y: f64,
    },
}

/// The closed cubic spline through points, in either sense, over the length of its chords: twice differentiable.
#[derive(Clone, Debug, PartialEq)]
pub struct SplineOutline {
    /// Parameter at each point, and 2 pi.
    knots: Vec<f64>,
    /// Points and second derivatives there, the first ones again at the end.
    points: Vec<DVec2>,
    second: Vec<DVec2>,
}

/// Chords by which it is looked for crossings.
const CHORDS: usize = 512;

impl SplineOutline {
    /// Counter-clockwise, whichever way the points go.
    ///
    /// # Errors
    /// [`OutlineError`].
    pub fn through(points: &[DVec2]) -> Result<Self, OutlineError> {
        let count = points.len();
        if count < 4 {
            return Err(OutlineError::TooFew(count));
        }
        if let Some(k) = points.iter().position(|p| !p.is_finite()) {
            return Err(OutlineError::NotFinite(k + 1));
        }
        let mut points = points.to_vec();
        let next = |k: usize| (k + 1) % count;
        if (0..count).map(|k| points[k].perp_dot(points[next(k)])).sum::<f64>() < 0.0 {
            points.reverse();
        }
        let chords: Vec<f64> = (0..count).map(|k| points[k].distance(points[next(k)])).collect();
        let all: f64 = chords.iter().sum();
        if let Some(k) = chords.iter().position(|c| *c <= 1e-9 * all) {
            return Err(OutlineError::Twice(k + 1));
        }
        let steps: Vec<f64> = chords.iter().map(|c| TAU * c / all).collect();
        let mut second = second_derivatives(&points, &steps);
        let mut knots: Vec<f64> = steps
            .iter()
            .scan(0.0, |t, step| {
                let here = *t;
                *t += step;
                Some(here)
            })
            .collect();
        knots.push(TAU);
        points.push(points[0]);
        second.push(second[0]);
        let outline = Self { knots, points, second };
        outline.crossing().map_or(Ok(outline), |at| Err(OutlineError::Crosses { x: at.x, y: at.y }))
    }

    /// Where two chords of it cross.
    fn crossing(&self) -> Option<DVec2> {
        let points: Vec<DVec2> = (0..CHORDS).map(|k| self.at(TAU * k as f64 / CHORDS as f64).point).collect();
        let chord = |k: usize| (points[k], points[(k + 1) % CHORDS]);
        let side = |(a, b): (DVec2, DVec2), p: DVec2| (b - a).perp_dot(p - a);
        let cross = |i: usize, k: usize| {
            let (one, other) = (chord(i), chord(k));
            side(one, other.0) * side(one, other.1) < 0.0 && side(other, one.0) * side(other, one.1) < 0.0
        };
        // Neighbours share an end.
        let pairs = (0..CHORDS).flat_map(|i| (i + 2..CHORDS).map(move |k| (i, k)));
        let found = pairs.filter(|(i, k)| (k + 1) % CHORDS != *i).find(|(i, k)| cross(*i, *k));
        found.map(|(i, _)| points[i])
    }
}

/// Of a closed cubic spline: `h_(k-1) M_(k-1) + 2 (h_(k-1) + h_k) M_k + h_k M_(k+1) = 6 (d_k - d_(k-1))`, `d` the slopes of chords. The rows go round; the corners
/// are a rank of one (Sherman and Morrison).
fn second_derivatives(points: &[DVec2], h: &[f64]) -> Vec<DVec2> {
    let n = points.len();
    let before = |k: usize| (k + n - 1) % n;
    let slope = |k: usize| (points[(k + 1) % n] - points[k]) / h[k];
    let right: Vec<DVec2> = (0..n).map(|k| 6.0 * (slope(k) - slope(before(k)))).collect();
    let corner = h[n - 1];
    let mut diagonal: Vec<f64> = (0..n).map(|k| 2.0 * (h[before(k)] + h[k])).collect();
    let gamma = -diagonal[0];
    diagonal[0] -= gamma;
    diagonal[n - 1] -= corner * corner / gamma;
    let ends = |k: usize| {
        if k == 0 {
            gamma
        } else if k == n - 1 {
            corner
        } else {
            0.0
        }
    };
    let x = tridiagonal(&diagonal, h, right);
    let z = tridiagonal(&diagonal, h, (0..n).map(|k| DVec2::splat(ends(k))).collect());
    let share = corner / gamma;
    let factor = (x[0] + share * x[n - 1]) / (1.0 + z[0].x + share * z[n - 1].x);
    x.into_iter().zip(z).map(|(x, z)| x - factor * z.x).collect()
}

/// By elimination without pivots: rows are dominated by their diagonal. Off it is `h[k]` between `k` and `k + 1`.
fn tridiagonal(diagonal: &[f64], h: &[f64], mut right: Vec<DVec2>) -> Vec<DVec2> {
    let n = diagonal.len();
    let mut pivots = diagonal.to_vec();
    for k in 1..n {
        let share = h[k - 1] / pivots[k - 1];
        pivots[k] -= share * h[k - 1];
        let above = right[k - 1];
        right[k] -= share * above;
    }
    right[n - 1] /= pivots[n - 1];
    for k in (0..n - 1).rev() {
        let below = right[k + 1];
        right[k] = (right[k] - h[k] * below) / pivots[k];
    }
    right
}

impl SmoothOutline for SplineOutline {
    fn at(&self, t: f64) -> OutlinePoint {
        let t = t.rem_euclid(TAU);
        let k = self.knots.partition_point(|knot| *knot <= t).clamp(1, self.knots.len() - 1) - 1;
        let h = self.knots[k + 1] - self.knots[k];
        let (b, a) = ((t - self.knots[k]) / h, (self.knots[k + 1] - t) / h);
        let ([p, q], [m, n]) = ([self.points[k], self.points[k + 1]], [self.second[k], self.second[k + 1]]);
        let bent = h * h / 6.0;
        OutlinePoint {
            point: a * p + b * q + bent * ((a.powi(3) - a) * m + (b.powi(3) - b) * n),
            first: (q - p) / h + h / 6.0 * ((3.0 * b * b - 1.0) * n - (3.0 * a * a - 1.0) * m),
            second: a * m + b * n,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waved(t: f64) -> DVec2 {
        DVec2::from_angle(t) * (1.0 + 0.3 * (3.0 * t).cos())
    }

    fn through(count: u32) -> SplineOutline {
        let points: Vec<DVec2> = (0..count).map(|k| waved(TAU * f64::from(k) / f64::from(count))).collect();
        SplineOutline::through(&points).unwrap()
    }

    /// A cubic spline is off by the fourth power of its steps.
    #[test]
    fn a_spline_converges_in_the_fourth_order() {
        let off = |count: u32| {
            let outline = through(count);
            let way = |t: f64| (outline.at(t).point.to_angle() - t + 3.0).rem_euclid(TAU) - 3.0;
            // At the angle that it is at, as its parameter is another one.
            (0..500)
                .map(|k| {
                    let t = TAU * f64::from(k) / 500.0;
                    let p = outline.at(t).point;
                    (p.length() - waved(t + way(t)).length()).abs()
                })
                .fold(0.0, f64::max)
        };
        let order = (off(60) / off(240)).log2() / 2.0;
        assert!((3.6..4.4).contains(&order), "{order}");
    }

    #[test]
    fn its_derivatives_are_those_of_the_curve_and_do_not_jump() {
        let outline = through(24);
        for t in [0.0, 0.4, 1.0, 3.0, TAU - 1e-3] {
            let h = 1e-5;
            let (before, here, after) = (outline.at(t - h), outline.at(t), outline.at(t + h));
            assert!(((after.point - before.point) / (2.0 * h) - here.first).length() < 1e-8);
            assert!((after.second - before.second).length() < 1e-3, "{t}");
        }
        assert_eq!(outline.at(-1.0), outline.at(TAU - 1.0));
    }

    #[test]
    fn points_that_are_no_outline_are_named() {
        let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        let mut other = square;
        other.reverse();
        let [one, two] = [square, other].map(|points| SplineOutline::through(&points).unwrap());
        assert!(one.at(1.0).curvature() > 0.0 && two.at(1.0).curvature() > 0.0, "counter-clockwise");
        let refused = |points: &[DVec2]| SplineOutline::through(points).unwrap_err();
        assert_eq!(refused(&square[..3]), OutlineError::TooFew(3));
        assert_eq!(refused(&[DVec2::ZERO, DVec2::X, DVec2::NAN, DVec2::Y]), OutlineError::NotFinite(3));
        assert_eq!(refused(&[DVec2::ZERO, DVec2::X, DVec2::X, DVec2::Y]), OutlineError::Twice(2));
        let eight = [DVec2::ZERO, DVec2::ONE, DVec2::X, DVec2::Y];
        assert!(matches!(refused(&eight), OutlineError::Crosses { .. }));
    }
}

//! The least number of touches that any planner can do with.
//!
//! Both bounds are polytopes with as many corners, or faces, as there are contacts, and the pattern that is best for one is best for
//! the other. For a smooth body in `d` dimensions with affine surface area `W = int kappa^(1/(d+1)) dS` (over normals: of the product
//! of the principal radii, to the power `d/(d+1)`), the volume between the bounds of the best `n` contacts tends to
//! `W^3 / (8 n^2)` in the plane, a third of it outside, and `7 / (18 sqrt 3) W^2 / n` in space (Gruber's constants for inscribed and
//! circumscribed polytopes). Gaps over volume do not change under affine maps, and no body has a larger `W` for its size than the
//! ellipsoid (affine isoperimetric inequality): so what an ellipsoid takes is enough for all smooth bodies, when `n` is large.

use std::f64::consts::PI;

/// Of the volume between the best bounds in space, over `W^2 / n`, the part outside of the body: `5 / (18 sqrt 3)`.
const OUTSIDE: f64 = 0.160_375_074_982_812_3 / 2.0;
/// The part inside of it: `1 / (2 sqrt 3) / 2`.
const INSIDE: f64 = 0.288_675_134_594_812_9 / 2.0;

/// Touches that the best pattern takes to bring the gap (volume between the bounds over the upper one) around an ellipse
/// (`dimension` 2) or ellipsoid (3) to `gap`, where it is large: `n*`, the line that none can cross on such bodies.
///
/// 9.77 for 10 % in the plane and 39.3 for 20 % in space; exact counts are a little above it, 10 and 40. Infinite for a gap of 0, and
/// never below `dimension + 1`. NaN for other dimensions.
#[must_use]
pub fn least_touches(dimension: usize, gap: f64) -> f64 {
    let gap = gap.clamp(0.0, 1.0);
    let touches = match dimension {
        // W^3 = 8 pi^2 |C|.
        2 => (PI * PI * (1.0 - gap / 3.0) / gap).sqrt(),
        // W^2 = 12 pi |C|.
        3 => (OUTSIDE + INSIDE - OUTSIDE * gap) * 12.0 * PI / gap,
        _ => return f64::NAN,
    };
    touches.max((dimension + 1) as f64)
}

/// The gap that the best `touches` leave around an ellipse (`dimension` 2) or ellipsoid (3): [`least_touches`] the other way round. 1
/// below the least number of touches, NaN for other dimensions.
#[must_use]
pub fn least_gap(dimension: usize, touches: usize) -> f64 {
    let n = touches as f64;
    if touches <= dimension && (dimension == 2 || dimension == 3) {
        return 1.0;
    }
    match dimension {
        2 => PI * PI / (n * n + PI * PI / 3.0),
        3 => (OUTSIDE + INSIDE) * 12.0 * PI / (n + OUTSIDE * 12.0 * PI),
        _ => f64::NAN,
    }
}

/// Touches in all that `goal` is expected to take when `touches` have left a gap of `gap`: gaps fall as `n^(-2/(d-1))`.
///
/// From 6 touches at 30 % it says 10.4 for 10 % in the plane, where 11 were measured.
#[must_use]
pub fn touches_predicted(dimension: usize, touches: usize, gap: f64, goal: f64) -> f64 {
    if gap <= goal {
        return touches as f64;
    }
    touches as f64 * (gap / goal).powf((dimension.max(2) - 1) as f64 / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_formula_is_near_the_best_patterns_known() {
        // A disc: regular polygons, a gap of sin^2(pi / n) exactly. A ball: optimised points.
        for (gap, formula, exact) in [(0.3, 5.44, 6.0), (0.2, 6.79, 7.0), (0.1, 9.77, 10.0)] {
            assert!((least_touches(2, gap) - formula).abs() < 5e-3);
            assert!((PI / exact).sin().powi(2) <= gap && (PI / (exact - 1.0)).sin().powi(2) > gap);
        }
        for (gap, formula) in [(0.3, 25.2), (0.2, 39.3), (0.1, 81.6)] {
            assert!((least_touches(3, gap) - formula).abs() < 0.05, "{}", least_touches(3, gap));
        }
    }

    #[test]
    fn the_least_gap_is_the_inverse_of_the_least_touches() {
        for (dimension, touches) in [(2, 6), (2, 20), (3, 20), (3, 300)] {
            let gap = least_gap(dimension, touches);
            assert!((least_touches(dimension, gap) - touches as f64).abs() < 1e-9 * touches as f64);
        }
        assert_eq!(least_gap(3, 3), 1.0);
    }

    #[test]
    fn predictions_are_those_that_were_measured() {
        assert!((touches_predicted(2, 6, 0.3, 0.1) - 10.4).abs() < 0.01);
        assert!((touches_predicted(3, 28, 0.3, 0.2) - 42.0).abs() < 1e-9);
        assert_eq!(touches_predicted(3, 50, 0.1, 0.2), 50.0);
    }
}

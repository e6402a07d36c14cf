//! Waves held convex: the twin of `fit::convex`.

use super::family::{model, outline};
use super::{FitError, OutlineFamily};
use crate::fit::information::SquareRoot;
use crate::fit::nnls::least_distance;
use contact_kinematics::planar::RadiusFunction;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Rounds of finding where the outline bends too far and forbidding it there.
const ROUNDS: usize = 40;
/// Directions for each order in which such places are looked for.
const DENSITY: usize = 40;
/// By how much the limit is overshot, as a share of it, so that the slack of the proof leaves the limit itself.
const MARGIN: f64 = 0.01;

/// The waves nearest to `theta` in the metric of the data whose radius of curvature is proved to be above `limit`, and how
/// many constraints hold them. Waves at more than `farthest` are refused as soon as they are seen: as in space, the distance
/// grows with each constraint.
pub(super) fn hold(
    family: OutlineFamily,
    theta: &DVector<f64>,
    root: &SquareRoot,
    limit: f64,
    farthest: f64,
) -> Result<(DVector<f64>, usize), FitError> {
    let proved = |theta: &DVector<f64>| {
        outline(family, theta).is_ok_and(|body| body.radius_bounds().min >= limit.max(f64::MIN_POSITIVE))
    };
    if proved(theta) {
        return Ok((theta.clone(), 0));
    }
    let none = || FitError::NoConvexBody { family, radius: limit };
    let own = model(family);
    let count = DENSITY * theta.len();
    let triangle = root.triangle();
    let target = limit * (1.0 + MARGIN) + 1e-6 * theta[0].abs();
    let mut constraints: Vec<DVector<f64>> = Vec::new();
    let (mut held, mut active) = (theta.clone(), 0);
    for _ in 0..ROUNDS {
        let body = own.body(&held).ok_or_else(none)?;
        let radius: Vec<f64> = (0..count).map(|i| body.jet(TAU * i as f64 / count as f64).rho).collect();
        let lowest = |i: &usize| {
            radius[*i] < target * (1.0 - 1e-9)
                && radius[*i] <= radius[(i + 1) % count]
                && radius[*i] <= radius[(i + count - 1) % count]
        };
        let before = constraints.len();
        // rho = a_0 + sum (1 - k^2) (a_k cos + b_k sin) is linear.
        constraints.extend((0..count).filter(lowest).map(|i| {
            let angle = TAU * i as f64 / count as f64;
            DVector::from_fn(theta.len(), |j, _| {
                let order = j.div_ceil(2) as f64;
                let (sin, cos) = (order * angle).sin_cos();
                (1.0 - order * order) * if j == 0 || j % 2 == 1 { cos } else { sin }
            })
        }));
        if constraints.len() == before {
            return if proved(&held) { Ok((held, active)) } else { Err(none()) };
        }
        let rows: Vec<_> = constraints
            .iter()
            .map(|c| triangle.transpose().solve_lower_triangular(c))
            .collect::<Option<_>>()
            .ok_or_else(none)?;
        let g = DMatrix::from_fn(rows.len(), theta.len(), |i, j| rows[i][j]);
        let h = DVector::from_fn(rows.len(), |i, _| target - constraints[i].dot(theta));
        let (x, tight) = least_distance(&g, &h).ok_or_else(none)?;
        if x.norm() > farthest {
            return Err(none());
        }
        held = theta + triangle.solve_upper_triangular(&x).ok_or_else(none)?;
        active = tight;
    }
    Err(none())
}

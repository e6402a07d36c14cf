//! Harmonic shapes held convex.

use super::family::HarmonicModel;
use super::information::SquareRoot;
use super::nnls::least_distance;
use super::{FitError, ShapeFamily};
use contact_kinematics::{Direction, PolynomialSupport, SupportFunction};
use glam::{DMat3, DVec3};
use nalgebra::{DMatrix, DVector};

/// Rounds of finding where the shape bends too far and forbidding it there.
const ROUNDS: usize = 40;
/// Grid spacing in rad times degree, in looking for such places.
const SPACING: f64 = 0.2;
/// The part of the largest radius by which the limit is overshot, so that the certificate's slack leaves the limit itself.
const MARGIN: f64 = 0.002;

/// A harmonic shape whose radii of curvature are certified above a limit.
pub(super) struct Held {
    pub(super) body: PolynomialSupport,
    pub(super) theta: DVector<f64>,
    /// Constraints that hold it; 0 if the shape was convex by itself.
    pub(super) active: usize,
}

/// The shape nearest to `theta` in the metric of the data whose radii of curvature are all above `limit`.
///
/// `t' H(n) t >= limit` for all normals `n` and tangents `t` is linear in the coefficients. Of these infinitely many
/// constraints those are taken that the shape breaks on a grid, the quadratic programme is solved, and so on until the
/// certificate of [`PolynomialSupport::curvature_radii`] holds: a cutting-plane method. The result is the projection of the
/// unconstrained estimate onto a convex set that holds the truth, which brings it nearer to the truth in that metric. A
/// projection at more than `farthest` is refused as soon as it is seen: it grows with each constraint.
pub(super) fn hold(
    degree: usize,
    theta: &DVector<f64>,
    root: &SquareRoot,
    limit: f64,
    farthest: f64,
) -> Result<Held, FitError> {
    let family = ShapeFamily::Harmonics { degree };
    let body = HarmonicModel::body(theta)?;
    let radii = body.curvature_radii();
    if radii.min >= limit && radii.min > 0.0 {
        return Ok(Held { body, theta: theta.clone(), active: 0 });
    }
    let none = FitError::NoConvexBody { family, radius: limit };
    let model = HarmonicModel::new(degree)?;
    let triangle = root.triangle();
    let grid = grid(degree);
    let mut constraints: Vec<DVector<f64>> = Vec::new();
    let (mut theta_held, mut body, mut active) = (theta.clone(), body, 0);
    let mut target = limit + MARGIN * radii.max.abs();
    for _ in 0..ROUNDS {
        let found = violations(&body, &grid, target);
        if found.is_empty() {
            let radii = body.curvature_radii();
            if radii.min >= limit && radii.min > 0.0 {
                return Ok(Held { body, theta: theta_held, active });
            }
            target += 0.5 * (limit - radii.min).abs().max(MARGIN * radii.max);
            continue;
        }
        for (n, t) in found {
            let slope = |h: &DMat3| t.dot(*h * t);
            constraints.push(DVector::from_iterator(theta.len(), model.hessians(n).iter().map(slope)));
        }
        // x = R (theta' - theta): shortest with C R^-1 x >= target - C theta.
        let rows: Vec<_> = constraints
            .iter()
            .map(|c| triangle.transpose().solve_lower_triangular(c))
            .collect::<Option<_>>()
            .ok_or_else(|| none.clone())?;
        let g = DMatrix::from_fn(rows.len(), theta.len(), |i, j| rows[i][j]);
        let h = DVector::from_fn(rows.len(), |i, _| target - constraints[i].dot(theta));
        let (x, held) = least_distance(&g, &h).ok_or_else(|| none.clone())?;
        if x.norm() > farthest {
            return Err(none);
        }
        let step = triangle.solve_upper_triangular(&x).ok_or_else(|| none.clone())?;
        theta_held = theta + step;
        body = HarmonicModel::body(&theta_held)?;
        active = held;
    }
    Err(none)
}

/// Normals with their tangents where the shape's radius is below `target` and no neighbour's is smaller.
fn violations(body: &PolynomialSupport, grid: &Grid, target: f64) -> Vec<(Direction, DVec3)> {
    let least: Vec<(f64, DVec3)> =
        grid.normals.iter().map(|n| least_radius(body.jet(*n).hessian, *n)).collect();
    let rounding = 1e-7 * target.abs();
    (0..least.len())
        .filter(|&i| least[i].0 < target - rounding)
        .filter(|&i| grid.neighbours[i].iter().all(|j| least[*j].0 >= least[i].0))
        .map(|i| (grid.normals[i], least[i].1))
        .collect()
}

/// The smaller principal radius and its direction.
fn least_radius(hessian: DMat3, n: Direction) -> (f64, DVec3) {
    let (a, b) = n.tangent_basis();
    let (aa, ab, bb) = (a.dot(hessian * a), a.dot(hessian * b), b.dot(hessian * b));
    let radius = 0.5 * (aa + bb) - (0.5 * (aa - bb)).hypot(ab);
    // The eigenvector has angle (atan2(2 ab, aa - bb) + pi) / 2.
    let angle = 0.5 * ((2.0 * ab).atan2(aa - bb) + std::f64::consts::PI);
    (radius, a * angle.cos() + b * angle.sin())
}

struct Grid {
    normals: Vec<Direction>,
    neighbours: Vec<Vec<usize>>,
}

/// A spiral of nearly even spacing (Vogel's, on the sphere), with the neighbours of each normal.
fn grid(degree: usize) -> Grid {
    let spacing = SPACING / degree.max(2) as f64;
    let count = (4.0 * std::f64::consts::PI / spacing.powi(2)).ceil() as usize;
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let normal = |i: usize| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let (sin, cos) = (golden * i as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        Direction::new_unchecked(DVec3::new(across * cos, across * sin, z).normalize())
    };
    let normals: Vec<Direction> = (0..count).map(normal).collect();
    // Along the spiral, z falls evenly: neighbours are within a band of indices.
    let band = (spacing * 2.0 * count as f64 / 2.0).ceil() as usize + 1;
    let near = (2.0 * spacing).powi(2);
    let neighbours = (0..count)
        .map(|i| {
            (i.saturating_sub(band)..(i + band + 1).min(count))
                .filter(|&j| j != i && normals[i].get().distance_squared(normals[j].get()) < near)
                .collect()
        })
        .collect();
    Grid { normals, neighbours }
}

//! Principal surfaces and curves: the mean of the points that are nearest to a place is that place.

use super::error::ApproximationError;
use super::smoother::{Row, Smoother};
use super::star::{Frame, Star};
use super::through::Spline;
use nalgebra::SVector;

/// Rounds of projecting and smoothing, at most, and those after which the smoothing is no longer chosen anew.
const ROUNDS: usize = 40;
const CHOICES: usize = 2;
/// A surface whose points move by less than this share of the scatter, in the root mean square, has converged.
const SETTLED: f64 = 1e-3;

/// A surface, and what is known of it: `T` is the surface or curve.
#[derive(Clone, Debug)]
pub(crate) struct Principal<T> {
    /// The surface itself, whose residual is the standard deviation of the points across it.
    pub(crate) surface: T,
    /// Parameters that the data were spent on.
    pub(crate) freedom: f64,
    /// By how much its curvature moves it outwards on the average, in m.
    pub(crate) bias: f64,
    pub(crate) rounds: usize,
    pub(crate) converged: bool,
}

impl<T> Principal<T> {
    /// The same of another type.
    pub(crate) fn map<U>(self, to: impl FnOnce(T) -> U) -> Principal<U> {
        let Self { surface, freedom, bias, rounds, converged } = self;
        Principal { surface: to(surface), freedom, bias, rounds, converged }
    }
}

/// The principal surface of points about a frame (Hastie and Stuetzle, "Principal curves", 1989): project each point on the
/// surface, smooth what is left across it over the places, until it settles.
///
/// The first surface is that smoothed over the directions from the centre.
pub(crate) fn principal<const D: usize>(
    (frame, unit): (Frame<D>, f64),
    points: &[SVector<f64, D>],
    half: usize,
    noise: Option<f64>,
) -> Result<Principal<Spline<D>>, ApproximationError> {
    if let Some(sd) = noise.filter(|sd| !sd.is_finite() || *sd <= 0.0) {
        return Err(ApproximationError::Noise(sd));
    }
    let noise = noise.map(|sd| sd / unit);
    let smoother = Smoother::<D>::new(half);
    let count = points.len() as f64;
    let first = points.iter().map(|x| {
        let (u, value) = frame.place(x);
        smoother.value(&u, value, (x - frame.centre).norm())
    });
    let mut fitted =
        smoother.chosen(&first.collect::<Vec<_>>(), noise, None).ok_or(ApproximationError::Singular)?;
    let mut star = Star { frame, smoother, coefficients: fitted.coefficients.clone() };
    for round in 1.. {
        let (mut rows, mut squares, mut curvature): (Vec<Row>, _, _) = (Vec::new(), 0.0, 0.0);
        for x in points {
            let near = star.nearest(x);
            // A move outwards by the offset is one of the logarithm by the offset over the height.
            let target = star.jet(&near.u).0 + near.offset / near.height;
            rows.push(star.smoother.value(&near.u, target, near.height));
            squares += near.offset * near.offset;
            curvature += 1.0 / near.height / count;
        }
        let next = match round <= CHOICES {
            true => star.smoother.chosen(&rows, noise, Some(fitted.stiffness)),
            false => star.smoother.smooth(&rows, fitted.stiffness),
        };
        let next = next.ok_or(ApproximationError::Singular)?;
        let moved: f64 = (rows.iter())
            .map(|row| (row.missed(&next.coefficients) - row.missed(&fitted.coefficients)).powi(2))
            .sum();
        fitted = next;
        star.coefficients.clone_from(&fitted.coefficients);
        let converged = round > CHOICES && moved <= SETTLED * SETTLED * squares;
        if converged || round == ROUNDS {
            let left = (1.0 - fitted.share).max(f64::EPSILON);
            let variance = squares / (count * left);
            // Half of the curvatures' sum, times the variance; by Minkowski's formula its mean over the surface is that of one over the
            // height, in the plane as well.
            let bias = 0.5 * (D as f64 - 1.0) * variance * curvature * unit;
            let freedom = fitted.share * count;
            let surface = Spline { star, unit, residual: variance.sqrt() * unit };
            return Ok(Principal { surface, freedom, bias, rounds: round, converged });
        }
    }
    Err(ApproximationError::Singular)
}

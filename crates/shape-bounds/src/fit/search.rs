//! The search for a superquadric, whose likelihood has many maxima.

use super::data::{Data, ball};
use super::family::{EllipsoidModel, Model, Superquadric, SuperquadricModel};
use super::finish::misfit;
use super::levenberg::ITERATIONS;
use super::solve::{Effort, SAME, Solution, Spatial, into_error, solve};
use super::{FitError, ShapeFamily, refute};
use crate::noise::NoisyContact;
use nalgebra::DVector;

/// How a shape is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Search {
    /// From few starts, and given up when it is refuted.
    Quick,
    /// From more starts where the contacts refute what few lead to.
    Thorough,
    /// As thorough, and taken though it is refuted.
    Nearest,
}

/// Rounds of looking about a superquadric for a better one, at most.
const ROUNDS: usize = 4;
/// Ends that are followed to rest, of the first starts ...
const FIRST: Effort = Effort { followed: 2, iterations: ITERATIONS };
/// ... and of those about a superquadric, some of which differ by a few units of the sum of squares.
const ABOUT: Effort = Effort { followed: 8, iterations: ITERATIONS };

/// The likeliest superquadric: from an ellipsoid, then, unless the search is quick, about what that leads to, until nothing
/// there is better.
///
/// Which axis the first exponent belongs to does not show in the ellipsoid, and where two of its axes are alike neither do
/// the directions of those: a section with corners on its axes and one with corners between them differ by an eighth of a
/// turn. So starts have each axis for the first, in the frame as it is and turned by an eighth about each of its axes. About
/// a superquadric of like exponents there are others nearly as likely, whose first axis is another.
pub(super) fn superquadric(
    model: &dyn Model,
    contacts: &[NoisyContact],
    data: &Data,
    search: Search,
) -> Result<Solution, FitError> {
    let start = ball(&EllipsoidModel, contacts, data);
    let problem = Spatial { model: &EllipsoidModel, contacts, size: data.size };
    let ellipsoid = solve(&problem, vec![start], Effort::default(), |_| true)
        .map_err(|e| into_error(e, &EllipsoidModel, ShapeFamily::Ellipsoid, data.size))?;
    let first = Superquadric::from_ellipsoid(&EllipsoidModel::body(&ellipsoid.theta)?)?;
    let problem = Spatial { model, contacts, size: data.size };
    let enough = |found: &Solution| refute::is_likely(data.noise_level, &misfit(found, data));
    let mut best = solve(&problem, starts_about(&first), FIRST, enough)
        .map_err(|e| into_error(e, model, ShapeFamily::Superquadric, data.size))?;
    if search == Search::Quick {
        return Ok(best);
    }
    for _ in 0..ROUNDS {
        // Nothing is better than what leaves rounding.
        if best.system.chi_squared <= misfit(&best, data).rounding() {
            break;
        }
        let about = starts_about(&SuperquadricModel::body(&best.theta)?);
        match solve(&problem, about, ABOUT, |_| false) {
            Ok(found) if found.system.chi_squared < best.system.chi_squared * (1.0 - SAME) => best = found,
            _ => break,
        }
    }
    Ok(best)
}

/// Superquadrics with each axis of `body` for the first, in its frame and in that turned by an eighth about each axis.
fn starts_about(body: &Superquadric) -> Vec<DVector<f64>> {
    let turned = (0..3).filter_map(|about| body.turned_by_an_eighth(about));
    let frames: Vec<Superquadric> = std::iter::once(*body).chain(turned).collect();
    let starts = frames.iter().flat_map(|frame| (0..3).filter_map(|third| frame.with_third(third)));
    starts.map(|start| SuperquadricModel::parameters(&start)).collect()
}

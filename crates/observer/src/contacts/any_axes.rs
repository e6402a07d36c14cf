//! A known body of which the log does not tell how its axes lie.

use super::axes::{KNOWN, LOOKED_AT, orientation};
use super::body::{Body, CONSTANTS, INERTIA};
use super::problem::{Problem, Unknowns};
use super::search::fine;
use super::solve::Solved;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector6};
use object_dynamics::MassProperties;

/// Deviation of the axes of a known body, rad, from which on the log does not tell them: by then they lie on a bend that no covariance follows.
const UNTOLD: f64 = 0.9;
/// How much dearer a motion of any axes is at most, in units of chi-squared, than that of certain ones, which is one of them: if more, what is held of
/// its inertia is held at a wrong place.
const DEARER: f64 = 20.0;
/// Squares by which a turned body must differ from the one that was found for the bend to matter: two deviations.
const SHOWS: f64 = 4.0;
/// Turns that are tried about what the log does not tell, rad; and how little of what is known beforehand of a body counts where it is asked what the log
/// alone tells of it.
const TURNS: [f64; 4] = [0.4, 0.8, 1.2, 1.6];
const ALONE: f64 = 1e-6;

impl Problem<'_> {
    /// Takes a body of a mass that is known and of axes that may lie in any way: its inertia is about what it is in the mean over these.
    ///
    /// The motion is nearly linear in the inertia, which for a body that is almost a ball hardly depends on its axes; in the axes it is not.
    pub(super) fn take_any_axes(&mut self, mass: &MassProperties) -> Option<()> {
        let log_mass = mass.mass().ln();
        let round = Body::free(
            log_mass,
            DMat3::from_diagonal(DVec3::splat(mass.principal().moments.element_sum() / 3.0)),
        );
        let ways: Vec<SVector<f64, CONSTANTS>> = (0..LOOKED_AT)
            .map(|i| {
                let R = DMat3::from_quat(orientation(i, LOOKED_AT));
                Body::free(log_mass, R * mass.inertia() * R.transpose()).from(&round)
            })
            .collect();
        let mean = ways.iter().sum::<SVector<f64, CONSTANTS>>() / LOOKED_AT as f64;
        let spread = |of: &SVector<f64, CONSTANTS>| (of - mean) * (of - mean).transpose() / LOOKED_AT as f64;
        let known = SMatrix::<f64, CONSTANTS, CONSTANTS>::identity() * KNOWN.powi(2);
        let covariance = ways.iter().map(spread).sum::<SMatrix<f64, CONSTANTS, CONSTANTS>>() + known;
        let body = round.moved(mean[0], &mean.fixed_rows::<INERTIA>(1).into_owned());
        self.body = (body, covariance.cholesky()?.inverse());
        self.frozen.clear();
        Some(())
    }

    /// Whether the log tells any of these bodies from the one that moves as `at`, by as much as matters. It does not where two moments are
    /// nearly the same: the motion is then the same however their axes lie.
    fn show(&mut self, bodies: &[Body], at: &Unknowns) -> bool {
        let beforehand = self.body.1;
        self.body.1 *= ALONE;
        let equations = self.linearise::<CONSTANTS>(at);
        self.body.1 = beforehand;
        let covariance = equations.and_then(|of| of.covariance_of_body(&self.natural_information()));
        let Some(information) = covariance.and_then(|of| of.try_inverse()) else { return true };
        bodies.iter().any(|body| {
            let by = Body::free(body.log_mass, body.inertia()).from(&at.body);
            (information * by).dot(&by) > SHOWS
        })
    }
}

/// A body turned about what its `covariance` says is not told.
fn untold_turns(body: &Body, covariance: &SMatrix<f64, CONSTANTS, CONSTANTS>) -> Vec<Body> {
    let turns: Matrix3<f64> = covariance.fixed_view::<3, 3>(4, 4).into_owned();
    let eigen = SymmetricEigen::new(turns);
    let untold = (0..3).filter(|&i| eigen.eigenvalues[i] > UNTOLD * UNTOLD);
    let about = |i: usize, turn: f64| {
        let axis = eigen.eigenvectors.column(i) * turn;
        body.beside(0.0, &Vector6::from_fn(|k, _| if k < 3 { 0.0 } else { axis[k - 3] }))
    };
    untold.flat_map(|i| TURNS.map(|turn| about(i, turn))).collect()
}

/// The motion of a known body whose axes the log does not tell, with how they would lie: solved for with any axes. None where it tells them.
pub(super) fn with_any_axes(
    problem: &mut Problem,
    known: &Solved<CONSTANTS>,
    mass: &MassProperties,
) -> Option<(Solved<CONSTANTS>, DQuat)> {
    let covariance = known.covariances(problem)?.body;
    let widest = (4..CONSTANTS).map(|i| covariance[(i, i)]).fold(0.0, f64::max);
    if widest < UNTOLD * UNTOLD {
        return None;
    }
    let (body, frozen) = (problem.body, problem.frozen.clone());
    let found = known.unknowns.body;
    let start = known.unknowns.with(Body::free(found.log_mass, found.inertia()));
    problem.take_any_axes(mass)?;
    let turned = untold_turns(&found, &covariance);
    let solved = if problem.show(&turned, &start) { fine(problem, start) } else { None };
    let solved = solved.filter(|solved| solved.equations.cost < known.equations.cost + DEARER);
    if solved.is_none() {
        (problem.body, problem.frozen) = (body, frozen);
    }
    Some((solved?, found.orientation(mass)))
}

//! How the axes of a known body may lie in the motion that was found without knowing it.

use super::body::{Body, CONSTANTS};
use super::problem::Problem;
use super::redrawn::FEW_DRAWS;
use super::rivals::as_probable;
use super::search::fine;
use super::solve::Solved;
use crate::least_squares::{LeastSquares, LevenbergMarquardt, NormalEquations};
use crate::reliability::Reason;
use crate::rigid::{equivalent_orientations, exponential};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Cholesky, Const, SMatrix, SVector};
use object_dynamics::MassProperties;
use std::f64::consts::{SQRT_2, TAU};

/// Orientations that are looked at: about 25 degrees from one to the next.
pub(super) const LOOKED_AT: usize = 400;
/// How many of them are followed to where the inertia fits best, and from how many of those a motion is solved for.
const FOLLOWED: usize = 12;
const SOLVED: usize = 3;
/// Squared departure of an inertia beyond that of the best axes from which on others are not solved for: far beyond what rules them out.
const FAR: f64 = 1e3;
/// Orientations nearer to each other than these are one, rad: to follow, at the end.
const ALIKE: f64 = 0.35;
const SAME: f64 = 0.1;
/// Logarithm of the odds from which on other axes are ruled out: one wrong in twenty thousand.
const LEAST_LOG_ODDS: f64 = 10.0;
/// Deviation of the logarithm of a constant that is known: as good as exact, and what pulls at it can still be told.
pub(super) const KNOWN: f64 = 1e-4;
/// Deviation of an orientation of which nothing is known, about each axis, rad.
pub(super) const ANY_TURN: f64 = 1.8;
/// Squared departure of a known body from what was found without knowing it, of four degrees of freedom, beyond which it is another one:
/// chance goes there once in a million. What it costs to explain the log by it must go there too, as where little is known of an inertia a
/// covariance does not reach as far.
const CONTRADICTED: f64 = 33.4;

/// That a known body is not the one, by how much dearer the log is with it than without: as many squares of four degrees of freedom.
pub(super) fn against_by_cost(
    problem: &Problem,
    unknown: &Solved<CONSTANTS>,
    mass: &MassProperties,
    squares: f64,
) -> Option<Reason> {
    let covariance = unknown.equations.covariance_of_body(&problem.natural_information())?;
    let log_mass = unknown.unknowns.body.log_mass - mass.mass().ln();
    let deviations = log_mass.abs() / covariance[(0, 0)].max(f64::MIN_POSITIVE).sqrt();
    Some(Reason::OtherBody { mass: log_mass.exp(), deviations, squares })
}

/// What an unknown body may need more than a known one: half of what is left to gain where a fit has settled, twice over.
const MISSED: f64 = 1.0;

/// The motion of a known body.
pub(super) struct Oriented {
    /// Why it cannot be that body.
    pub(super) against: Option<Reason>,
    pub(super) solved: Solved<CONSTANTS>,
    /// How far the axes are from those of the farthest other motion that is not much less probable, rad.
    pub(super) doubt: f64,
    /// By how many deviations another motion that is about as probable, with other axes, is another one.
    pub(super) open: Option<Reason>,
    /// Linearisations of all motions that were looked at.
    pub(super) iterations: usize,
}

/// The most probable motion of a body with the mass properties `mass`, from that of an unknown body. `problem` is left as it was solved. None where no
/// choice of axes can be.
///
/// An unknown body has all motions of the known one. Where that explains the log better, the search for the unknown one has missed them: it is
/// begun again from there, and the axes are looked for again from what it comes to.
pub(super) fn known_motion(
    problem: &mut Problem,
    unknown: &Solved<CONSTANTS>,
    mass: &MassProperties,
) -> Option<Oriented> {
    let (free, frozen) = (problem.body, problem.frozen.clone());
    let left = problem.cost_of_log(unknown);
    let first = oriented(problem, unknown, mass)?;
    let unconfirmed = (!unknown.explained()).then_some(Reason::Unconfirmed);
    let first = Oriented { against: first.against.or(unconfirmed), ..first };
    if problem.cost_of_log(&first.solved) > left - MISSED {
        return Some(first);
    }
    let (body, known) = (problem.body, std::mem::replace(&mut problem.frozen, frozen));
    problem.body = free;
    let found = first.solved.unknowns.body;
    let start = first.solved.unknowns.with(Body::free(found.log_mass, found.inertia()));
    let second = || {
        let again = fine(problem, start)?;
        let mut second = oriented(problem, &again, mass)?;
        second.iterations += again.iterations + first.iterations;
        second.against = second.against.or(first.against);
        Some(second)
    };
    match second().filter(|second| second.solved.equations.cost < first.solved.equations.cost) {
        Some(second) => Some(second),
        None => {
            (problem.body, problem.frozen) = (body, known);
            Some(first)
        }
    }
}

/// From that of an unknown body.
fn oriented(problem: &mut Problem, unknown: &Solved<CONSTANTS>, mass: &MassProperties) -> Option<Oriented> {
    let covariance = unknown.covariances(problem)?.redrawn(problem, unknown, FEW_DRAWS).body;
    let same = equivalent_orientations(mass);
    let likely = Likely {
        unknown: unknown.unknowns.body,
        whitening: covariance.cholesky()?.inverse().cholesky()?,
        mass,
        mass_deviation: covariance[(0, 0)].max(f64::MIN_POSITIVE).sqrt(),
    };
    let mut iterations = 0;
    let mut found: Vec<(Solved<CONSTANTS>, Body, Vec<SVector<f64, CONSTANTS>>)> = Vec::new();
    let candidates = likely.candidates(&same);
    let against = candidates.first().and_then(|best| likely.against(*best));
    for R in candidates {
        let body = problem.take_known(mass, R);
        let Some(solved) = fine(problem, unknown.unknowns.with(body)) else { continue };
        iterations += solved.iterations;
        found.push((solved, body, std::mem::take(&mut problem.frozen)));
    }
    found.sort_by(|a, b| a.0.equations.cost.total_cmp(&b.0.equations.cost));
    let axes = |solved: &Solved<CONSTANTS>| solved.unknowns.body.orientation(mass);
    let mut found = found.into_iter();
    let (solved, body, frozen) = found.next()?;
    let dearer = solved.equations.cost - unknown.equations.cost > CONTRADICTED;
    let against = against.filter(|_| unknown.explained() && dearer);
    let odds = |other: &Solved<CONSTANTS>| 0.5 * (other.equations.cost - solved.equations.cost);
    problem.body.0 = body;
    problem.frozen = frozen;
    let (mut doubt, mut open) = (0.0_f64, None);
    for (other, ..) in found.filter(|(other, ..)| odds(other) < LEAST_LOG_ODDS) {
        doubt = doubt.max(apart(axes(&solved), axes(&other), &same));
        // With other axes it may move in another way.
        open = open.or_else(|| as_probable(problem, &solved, &other));
    }
    Some(Oriented { against, solved, doubt, open, iterations })
}

impl Problem<'_> {
    /// Takes a body of the mass properties `mass` for known, all but how its axes lie: about `R`.
    pub(super) fn take_known(&mut self, mass: &MassProperties, R: DQuat) -> Body {
        let body = Body::turned(mass, R);
        let deviation = |i: usize| if i < 4 { KNOWN } else { ANY_TURN };
        let information = SVector::<f64, CONSTANTS>::from_fn(|i, _| deviation(i).powi(-2));
        self.body = (body, SMatrix::from_diagonal(&information));
        self.frozen.clear();
        body
    }
}

/// Angle between two orientations of a body that looks the same in some.
fn apart(a: DQuat, b: DQuat, same: &[DQuat; 4]) -> f64 {
    same.iter().map(|turn| (a * *turn).angle_between(b)).fold(f64::INFINITY, f64::min)
}

/// Orientation `i` of so many, each as far from the others as they can be: a spiral on the quaternions (Alexa 2022).
pub(super) fn orientation(i: usize, of: usize) -> DQuat {
    /// Root of `x^4 = x + 4`.
    const PSI: f64 = 1.533_751_168_755_204_3;
    let (s, n) = (i as f64 + 0.5, of as f64);
    let (r, R) = ((s / n).sqrt(), (1.0 - s / n).sqrt());
    let (a, b) = (TAU * s / SQRT_2, TAU * s / PSI);
    DQuat::from_xyzw(r * a.sin(), r * a.cos(), R * b.sin(), R * b.cos()).normalize()
}

/// How far an inertia is from the one that was found, in its covariance.
struct Likely<'a> {
    unknown: Body,
    /// Factor of the information on the constants.
    whitening: Cholesky<f64, Const<CONSTANTS>>,
    mass: &'a MassProperties,
    /// Of the logarithm of the mass that was found.
    mass_deviation: f64,
}

impl Likely<'_> {
    fn residual(&self, R: DQuat) -> SVector<f64, CONSTANTS> {
        let inertia = DMat3::from_quat(R);
        let body = Body::free(self.mass.mass().ln(), inertia * self.mass.inertia() * inertia.transpose());
        self.whitening.l().transpose() * body.from(&self.unknown)
    }

    /// Why the known body is not the one that was found, if it is not with its axes at the best place.
    fn against(&self, R: DQuat) -> Option<Reason> {
        let squares = self.residual(R).norm_squared();
        let mass = self.unknown.log_mass - self.mass.mass().ln();
        let deviations = mass.abs() / self.mass_deviation;
        (squares > CONTRADICTED).then_some(Reason::OtherBody { mass: mass.exp(), deviations, squares })
    }

    /// Where the inertia fits best, best first.
    fn candidates(&self, same: &[DQuat; 4]) -> Vec<DQuat> {
        let sorted = |all: Vec<DQuat>| {
            let mut costs: Vec<(f64, DQuat)> =
                all.into_iter().map(|R| (self.residual(R).norm_squared(), R)).collect();
            costs.sort_by(|a, b| a.0.total_cmp(&b.0));
            costs
        };
        let different = |all: Vec<(f64, DQuat)>, least: f64, most: usize| {
            let mut kept: Vec<DQuat> = Vec::new();
            for (_, R) in all {
                if kept.len() < most && kept.iter().all(|other| apart(*other, R, same) > least) {
                    kept.push(R);
                }
            }
            kept
        };
        let first =
            different(sorted((0..LOOKED_AT).map(|i| orientation(i, LOOKED_AT)).collect()), ALIKE, FOLLOWED);
        let search = LevenbergMarquardt { step_tolerance: 1e-4, ..LevenbergMarquardt::default() };
        let mut ends = sorted(first.into_iter().map(|R| search.fit(self, R).point).collect());
        let best = ends.first().map_or(0.0, |(cost, _)| *cost);
        ends.retain(|(cost, _)| *cost < best + FAR);
        different(ends, SAME, SOLVED)
    }
}

impl LeastSquares<3> for Likely<'_> {
    type Point = DQuat;

    fn linearise(&self, R: &DQuat) -> Option<NormalEquations<3>> {
        /// Of central differences: their error is its square.
        const STEP: f64 = 1e-4;
        let slopes = DVec3::AXES.map(|axis| {
            let at = |by: f64| self.residual(exponential(axis * by) * *R);
            (at(STEP) - at(-STEP)) / (2.0 * STEP)
        });
        let residual = self.residual(*R);
        let mut normal = NormalEquations::default();
        for (i, value) in residual.iter().enumerate() {
            normal.add(&SVector::from_fn(|j, _| slopes[j][i]), *value);
        }
        normal.cost.is_finite().then_some(normal)
    }

    fn cost(&self, R: &DQuat) -> Option<f64> {
        Some(self.residual(*R).norm_squared()).filter(|cost| cost.is_finite())
    }

    fn retract(&self, R: &DQuat, step: &SVector<f64, 3>) -> DQuat {
        (exponential(DVec3::new(step[0], step[1], step[2])) * *R).normalize()
    }
}

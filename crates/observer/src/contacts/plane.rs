//! What is different where all motion is in the plane of x and z: five numbers of a motion and five of a body are what they are.

use super::body::{Body, CONSTANTS};
use super::problem::{Beforehand, Problem, Units, Unknowns};
use super::samples::{Deviations, at_nodes};
use super::search::fine;
use super::solve::Solved;
use super::state::Tangent;
use crate::reliability::Reason;
use glam::{DQuat, DVec3};
use nalgebra::{Matrix6, SMatrix, SVector, Vector2, Vector6};
use object_dynamics::MassProperties;

/// Information that holds at each node what cannot be otherwise, in natural units: it is free to be what it is, which is zero, and the equations
/// are to be no worse for it.
const HELD: f64 = 1e4;
/// Deviation of the logarithm of a constant that is known: as good as exact, and what pulls at it can still be told.
const KNOWN: f64 = 1e-4;
/// Squared departure of a known body's mass and moment of inertia from what was found without knowing them, beyond which it is another one:
/// two numbers in their deviations go there once in a million. What it costs to explain the log by it must go there too.
const CONTRADICTED: f64 = 27.6;

/// How often conditions are taken for off by what is not known of the spin, and the share of their deviation from which on a change of that counts.
const ROUNDS: usize = 8;
const BLURS: f64 = 0.3;
/// Deviations of the spin that it may be off by there. With one, `n` conditions of a stretch where the spin is as good as zero would tell it to a share of
/// `1 / sqrt(n)` of that by nothing but noise of their levers, less in the next round, and so on; with four they tell little beside what is known.
const SPIN_OFF: f64 = 4.0;

type OfBody = SMatrix<f64, CONSTANTS, CONSTANTS>;

/// Information that holds positions and velocities along y, momenta and turns about x and z, in natural units.
pub(super) fn held() -> Tangent {
    let across = |i: usize| if i < 6 { i % 3 == 1 } else { i % 3 != 1 };
    Tangent::from_fn(|i, _| if across(i) { HELD } else { 0.0 })
}

/// Noise of the impulses and moments across the plane over a link, large enough for nodes not to hold each other there: a rigid chain is what
/// makes the equations singular in double precision.
pub(super) fn unfelt(units: &Units) -> Matrix6<f64> {
    let impulse = units.mass * units.speed;
    let moment = impulse * units.length;
    Matrix6::from_diagonal(&Vector6::new(0.0, impulse, 0.0, moment, 0.0, moment).map(|noise| noise * noise))
}

/// Without deviations of what cannot be otherwise, but for the place of the plane, m.
pub(super) fn flatten(deviations: &mut Deviations, across: f64) {
    let along = [DVec3::new(1.0, 0.0, 1.0), DVec3::Y];
    for (i, of) in deviations.iter_mut().enumerate() {
        *of *= along[i / 2];
    }
    deviations[0].y = across;
}

/// The same of the covariance of a pose.
pub(super) fn flattened(of: &Matrix6<f64>, across: f64) -> Matrix6<f64> {
    let moves = |i: usize| matches!(i, 0 | 2 | 4);
    let mut flat = Matrix6::from_fn(|i, k| if moves(i) && moves(k) { of[(i, k)] } else { 0.0 });
    flat[(1, 1)] = across * across;
    flat
}

/// How the constants of a body change with the logarithm of the root of its moment of inertia about y.
fn swell() -> SVector<f64, CONSTANTS> {
    SVector::from_fn(|i, _| if i == 1 || i == 3 { 1.0 } else { 0.0 })
}

/// How the constants of a body change with the logarithm of its moment of inertia about y.
pub(super) fn by_moment() -> SVector<f64, CONSTANTS> {
    0.5 * swell()
}

/// Whether what is known beforehand of a body is its mass and moment of inertia.
pub(super) fn is_known(beforehand: &Beforehand) -> bool {
    beforehand.1[(0, 0)] >= KNOWN.powi(-2)
}

/// A body of the mass of `of` whose moments are all the one about y.
pub(super) fn ball(of: &Body) -> Body {
    let ball = MassProperties::from_principal(of.log_mass.exp(), DVec3::splat(of.inertia().y_axis.y));
    ball.map_or(*of, |ball| Body::turned(&ball, DQuat::IDENTITY))
}

/// A body of the mass and the moment of inertia about y of `of`, as it is known beforehand: by the deviations of the logarithms of its mass and
/// of the root of that moment. What else there is of an inertia does not show in the plane and is held.
pub(super) fn body(of: &Body, mass: f64, root: f64) -> (Body, OfBody) {
    let body = ball(of);
    let swell = swell() / swell().norm();
    let mut information = (OfBody::identity() - swell * swell.transpose()) * KNOWN.powi(-2);
    // Both of the roots change by as much.
    information += swell * swell.transpose() * (2.0 * root * root).recip();
    information[(0, 0)] = mass.powi(-2);
    (body, information)
}

/// With conditions that are off as well by what is not known of the spin.
///
/// A contact that is read beside where it is, by `e`, is off in its condition by `z e`, of the spin `z` against the palm. Where that is as good as zero, as where a
/// body turns back, the condition would be exact; but `z` is known to a deviation of its own, and of the product of both the variance is
/// `(z^2 + var z) var e`. The same `e` is in the lever by which the condition tells of `z`: what it seems to tell by that is kept small by a larger `var z`.
pub(super) fn blurred(problem: &mut Problem, solved: Solved<CONSTANTS>) -> Option<Solved<CONSTANTS>> {
    let (mut solved, mut before) = (solved, 0);
    let mut unknown = vec![usual_spin(problem, &solved); problem.nodes.len()];
    for _ in 0..ROUNDS {
        let (blurred, change) = blur(problem, &solved, &unknown);
        if change < BLURS {
            break;
        }
        problem.blurred = blurred;
        before += solved.iterations;
        solved = fine(problem, solved.unknowns)?;
        unknown = spins_unknown(problem, &solved)?;
    }
    solved.iterations += before;
    Some(solved)
}

/// Root mean square of the spins against palms, rad/s.
fn usual_spin(problem: &Problem, solved: &Solved<CONSTANTS>) -> f64 {
    let Solved { unknowns, .. } = solved;
    let (mut squares, mut count) = (0.0, 0.0_f64);
    for (&k, motion) in problem.nodes.iter().zip(&unknowns.motions) {
        let spin = unknowns.body.spin(motion.q, motion.L).y;
        for contact in &problem.record.contacts[k] {
            squares += (spin - contact.W.y).powi(2);
            count += 1.0;
        }
    }
    (squares / count.max(1.0)).sqrt()
}

/// Deviations of the spin at the nodes, rad/s.
fn spins_unknown(problem: &Problem, solved: &Solved<CONSTANTS>) -> Option<Vec<f64>> {
    let covariances = solved.covariances(problem)?;
    let Unknowns { motions, body } = &solved.unknowns;
    Some(at_nodes(motions, body, &covariances).iter().map(|of| of[2].y).collect())
}

/// What conditions are off by for it at each sample of the record, m/s, and by how much that is another number than before, over the deviation that
/// one has: the largest.
fn blur(problem: &Problem, solved: &Solved<CONSTANTS>, unknown: &[f64]) -> (Vec<f64>, f64) {
    let body = &solved.unknowns.body;
    let (mut all, mut change) = (vec![0.0; problem.record.times.len()], 0.0);
    let motions = problem.at_samples(&solved.unknowns);
    for (j, (&from, motion)) in problem.nodes.iter().zip(&motions).enumerate() {
        let unknown = SPIN_OFF * unknown[j];
        let spin = body.spin(motion.q, motion.L).y;
        let end = problem.nodes.get(j + 1).copied().unwrap_or(from + 1);
        for (k, blurred) in all.iter_mut().enumerate().take(end).skip(from) {
            let before = problem.noise_at(k).floor;
            for contact in &problem.record.contacts[k] {
                let read = problem.noise.contact / contact.samples.sqrt();
                *blurred = f64::max(*blurred, unknown * read);
                let now = problem.noise.floor.hypot(*blurred);
                let all = before.hypot((spin - contact.W.y) * read);
                change = f64::max(change, (now - before).abs() / all);
            }
        }
    }
    (all, change)
}

/// The motion of a known body, and why it cannot be that one; `problem` is left as it was solved.
pub(super) fn known_motion(
    problem: &mut Problem,
    unknown: &Solved<CONSTANTS>,
    mass: &MassProperties,
) -> Option<(Solved<CONSTANTS>, Option<Reason>)> {
    let claimed = unknown.covariances(problem)?.body;
    let swell = swell() / swell().norm_squared();
    let of_two =
        SMatrix::<f64, 2, CONSTANTS>::from_fn(|i, j| if i == 1 { swell[j] } else { f64::from(j == 0) });
    let covariance = of_two * claimed * of_two.transpose();
    let found = &unknown.unknowns.body;
    let moment = |body: &Body| 0.5 * body.inertia().y_axis.y.ln();
    let (known, information) = body(&Body::turned(mass, DQuat::IDENTITY), KNOWN, KNOWN);
    let departure = Vector2::new(found.log_mass - known.log_mass, moment(found) - moment(&known));
    let squares = (covariance.try_inverse()? * departure).dot(&departure);
    problem.body = (known, information);
    problem.frozen.clear();
    let solved = fine(problem, unknown.unknowns.with(known))?;
    let dearer = solved.equations.cost - unknown.equations.cost > CONTRADICTED;
    let deviations = departure[0].abs() / covariance[(0, 0)].sqrt();
    let other = Reason::OtherBody { mass: departure[0].exp(), deviations, squares };
    Some((solved, (squares > CONTRADICTED && dearer && unknown.explained()).then_some(other)))
}

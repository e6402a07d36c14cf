//! Contacts in the plane against a family: the twin of `fit::solve`, which explains the residual.

use super::family::Model;
use super::{FitError, NoisyContact, OutlineFamily};
use crate::fit::information::SquareRoot;
use crate::fit::levenberg::{Problem, Solution, System, Unsolved, Whitened};
use crate::fit::misfit::Misfit;
use crate::fit::refute::Leftover;
use contact_kinematics::planar::RadiusFunction;
use glam::{DMat2, DVec2};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Steps of the search for a contact's true normal, and halvings of one that goes too far.
const NORMAL_STEPS: usize = 30;
const HALVINGS: usize = 12;
/// A step of that search, in rad, whose square is rounding.
const NORMAL_STILL: f64 = 1e-8;
/// Largest turn from the measured to the true normal, in rad; what needs more is no measurement.
const LARGEST_TURN: f64 = PI / 3.0;

/// A contact against a model at some parameters, carried to the likeliest true normal.
pub(super) struct Linearised {
    /// Rows of `W` with `W' W` the inverse covariance of the residual.
    whitening: [DVec2; 2],
    residual: DVec2,
    angle: f64,
    log_determinant: f64,
}

/// Contacts against a family.
pub(super) struct Plane<'a> {
    pub(super) model: &'a dyn Model,
    pub(super) contacts: &'a [NoisyContact],
    pub(super) size: f64,
}

impl Problem for Plane<'_> {
    type Contact = Linearised;

    fn assemble(
        &self,
        theta: &DVector<f64>,
        before: Option<&System<Linearised>>,
    ) -> Option<System<Linearised>> {
        let count = self.model.count();
        let body = self.model.body(theta)?;
        let mut root = SquareRoot::new(count);
        let (mut columns, mut row) = (vec![DVec2::ZERO; count], vec![0.0; count + 1]);
        let mut contacts = Vec::with_capacity(self.contacts.len());
        let mut chi_squared = 0.0;
        for (k, contact) in self.contacts.iter().enumerate() {
            let start = before.map_or(contact.contact.normal.angle(), |system| system.contacts[k].angle);
            let own = linearise(body.as_ref(), contact, start)?;
            self.model.columns(theta, own.angle, &mut columns)?;
            for (i, weights) in own.whitening.iter().enumerate() {
                row.iter_mut().zip(&columns).for_each(|(entry, column)| *entry = weights.dot(*column));
                row[count] = own.residual[i];
                root.insert(&mut row);
            }
            chi_squared += own.residual.length_squared();
            contacts.push(own);
        }
        Some(System { root, contacts, chi_squared })
    }

    fn moved(&self, theta: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
        theta + step
    }

    fn scales(&self) -> DVector<f64> {
        DVector::from_element(self.model.count(), self.size)
    }

    fn whitened(&self, solution: &Solution<Linearised>) -> Option<Whitened> {
        let contacts = &solution.system.contacts;
        let mut columns = vec![DVec2::ZERO; self.model.count()];
        let mut rows = DMatrix::zeros(2 * contacts.len(), columns.len());
        for (k, own) in contacts.iter().enumerate() {
            self.model.columns(&solution.theta, own.angle, &mut columns)?;
            for (j, column) in columns.iter().enumerate() {
                (0..2).for_each(|i| rows[(2 * k + i, j)] = own.whitening[i].dot(*column));
            }
        }
        let residuals = contacts.iter().flat_map(|own| own.residual.to_array()).collect();
        Some(Whitened { dimension: 2, rows, residuals })
    }
}

fn linearise(body: &dyn RadiusFunction, contact: &NoisyContact, start: f64) -> Option<Linearised> {
    let measured = contact.contact.normal.angle();
    let angle = true_normal(body, contact, start);
    // dx / dtheta.
    let slope = DVec2::from_angle(angle).perp() * body.jet(angle).rho;
    let missed = contact.contact.point - body.point(angle) - slope * turn(angle, measured);
    let variance = contact.noise.normal.powi(2);
    let covariance = contact.noise.point + DMat2::from_cols(slope * slope.x, slope * slope.y) * variance;
    // Cholesky: rows of the inverse of the lower triangle.
    let (xx, xy, yy) = (covariance.x_axis.x, covariance.x_axis.y, covariance.y_axis.y);
    let first = xx.sqrt();
    let second = (yy - xy * xy / xx).sqrt();
    if !(first > 0.0 && second > 0.0 && first.is_finite() && second.is_finite()) {
        return None;
    }
    let whitening = [DVec2::new(1.0 / first, 0.0), DVec2::new(-xy / xx / second, 1.0 / second)];
    let residual = DVec2::new(whitening[0].dot(missed), whitening[1].dot(missed));
    Some(Linearised { whitening, residual, angle, log_determinant: 2.0 * (first * second).ln() })
}

/// From `a` to `b`, in (-pi, pi].
fn turn(a: f64, b: f64) -> f64 {
    DVec2::from_angle(a).angle_to(DVec2::from_angle(b))
}

/// The normal that minimises `e' P^-1 e + d^2 / s^2`, by Newton's method without third derivatives, with halved steps.
fn true_normal(body: &dyn RadiusFunction, contact: &NoisyContact, start: f64) -> f64 {
    let measured = contact.contact.normal.angle();
    let variance = contact.noise.normal.powi(2);
    if variance == 0.0 {
        return measured;
    }
    let weight = contact.noise.point.inverse();
    let misfit = |angle: f64| {
        let e = contact.contact.point - body.point(angle);
        variance * e.dot(weight * e) + turn(angle, measured).powi(2)
    };
    let (mut angle, mut value) = (start, misfit(start));
    for _ in 0..NORMAL_STEPS {
        let slope = DVec2::from_angle(angle).perp() * body.jet(angle).rho;
        let e = contact.contact.point - body.point(angle);
        let gradient = variance * slope.dot(weight * e) + turn(angle, measured);
        let step = gradient / (variance * slope.dot(weight * slope) + 1.0);
        let mut share = 1.0;
        let found = (0..HALVINGS).find_map(|_| {
            let next = angle + step * share;
            share *= 0.5;
            let next_value = misfit(next);
            let near = turn(next, measured).abs() < LARGEST_TURN;
            (near && next_value < value).then_some((next, next_value))
        });
        let Some(found) = found else { break };
        (angle, value) = found;
        if step.abs() < NORMAL_STILL {
            break;
        }
    }
    angle
}

/// The misfit of a solution, of which `body` is the outline.
pub(super) fn misfit(
    body: &dyn RadiusFunction,
    solution: &Solution<Linearised>,
    problem: &Plane<'_>,
    held: usize,
) -> Misfit {
    let own = &solution.system.contacts;
    let pairs = problem.contacts.iter().zip(own);
    let square: f64 = pairs.map(|(c, own)| c.contact.point.distance_squared(body.point(own.angle))).sum();
    Misfit {
        chi_squared: solution.system.chi_squared,
        equations: 2 * own.len(),
        parameters: solution.theta.len(),
        held,
        weight: own.iter().flat_map(|c| c.whitening).map(|row| row.length_squared()).sum(),
        log_determinants: own.iter().map(|c| c.log_determinant).sum(),
        residual: (square / (2 * own.len().max(1)) as f64).sqrt(),
        size: problem.size,
    }
}

/// What each contact is left with.
pub(super) fn leftovers(body: &dyn RadiusFunction, solution: &Solution<Linearised>) -> Vec<Leftover> {
    let leftover = |own: &Linearised| Leftover {
        point: body.point(own.angle).extend(0.0),
        normal: DVec2::from_angle(own.angle).extend(0.0),
        residual: own.residual.extend(0.0),
    };
    solution.system.contacts.iter().map(leftover).collect()
}

pub(super) fn worst(solution: &Solution<Linearised>) -> (usize, f64) {
    let squares = solution.system.contacts.iter().map(|c| c.residual.length_squared());
    squares.enumerate().fold((0, 0.0), |worst, own| if own.1 > worst.1 { own } else { worst })
}

pub(super) fn undetermined(
    model: &dyn Model,
    family: OutlineFamily,
    root: &SquareRoot,
    size: f64,
) -> FitError {
    let known = root.knowledge(&DVector::from_element(model.count(), size));
    FitError::Undetermined {
        family,
        rank: known.map_or(0, |k| k.rank),
        parameters: model.count(),
        condition: known.map_or(f64::INFINITY, |k| k.condition),
        weakest: known.map_or_else(String::new, |k| model.name(k.weakest_parameter)),
        deviation: known.map_or(f64::INFINITY, |k| k.weakest_deviation),
    }
}

/// What a failed iteration says of the contacts.
pub(super) fn into_error(
    failure: Unsolved<Linearised>,
    model: &dyn Model,
    family: OutlineFamily,
    size: f64,
) -> FitError {
    match failure {
        Unsolved::Singular(system) => undetermined(model, family, &system.root, size),
        Unsolved::NotConverged(iterations, _) => FitError::NotConverged { family, iterations },
    }
}

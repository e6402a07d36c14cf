//! Nonlinear least squares over contacts whose points and normals are both uncertain.

use super::FitError;
use super::family::Model;
use super::information::SquareRoot;
use crate::noise::NoisyContact;
use contact_kinematics::{Direction, SupportFunction, SupportJet};
use glam::{DMat3, DVec3};
use nalgebra::{DVector, Matrix3, Vector3};

/// Iterations before a fit is given up; a handful suffices near a solution.
const ITERATIONS: usize = 200;
/// A step this small, in standard deviations, changes nothing.
const STILL: f64 = 1e-7;
/// A predicted improvement this small, relative to the sum of squares, is rounding of it ...
const FLAT: f64 = 1e-14;
/// ... and this small is so if the step did not bring it about.
const STALLED: f64 = 1e-9;
/// A step this small, relative to the sizes of the parameters, is rounding.
const ROUNDING: f64 = 1e-14;
/// Iterations with equations that leave a combination open before the contacts are blamed, and not the start.
const DEFICIENT: usize = 12;
/// Steps of the search for a contact's true normal, and halvings of one that goes too far.
const NORMAL_STEPS: usize = 30;
const HALVINGS: usize = 12;
/// Least cosine of the turn from the measured to the true normal; what needs more is no measurement.
const LEAST_COSINE: f64 = 0.5;
/// A step of that search, in rad, whose square is rounding: the residual is carried from there to first order.
const NORMAL_STILL: f64 = 1e-8;

/// A contact against a model at some parameters: `residual = x^ - x(n)` carried to the true normal, and its weight.
pub(super) struct Linearised {
    /// Lower triangle `W` with `W' W` the inverse covariance of the residual.
    pub(super) whitening: Matrix3<f64>,
    /// Whitened residual.
    pub(super) residual: Vector3<f64>,
    /// The normal at which the model is taken: the likeliest true one.
    pub(super) normal: Direction,
    /// Logarithm of the determinant of the covariance.
    pub(super) log_determinant: f64,
}

/// A contact at the likeliest true normal, searched for from `start`.
///
/// Points and normals are measured with errors `e` (covariance `P`) and `d` (standard deviation `s` per tangent axis). The
/// likeliest true normal minimises `e' P^-1 e + d' d / s^2`; with it eliminated to first order the residual is
/// `x^ - x(n) - H (n^ - n)`, with `H = dx/dn` the Hessian of the support function, and its covariance
/// `S = P + s^2 H H'`. Its weighted gradient by the parameters is that of the minimum itself, so the fit is the maximum
/// of the likelihood (errors-in-variables, functional model: Fuller, "Measurement error models", 1987, section 3.2).
pub(super) fn linearise(
    model: &(impl Model + ?Sized),
    theta: &DVector<f64>,
    body: &dyn SupportFunction,
    contact: &NoisyContact,
    start: Direction,
    columns: &mut [DVec3],
) -> Option<Linearised> {
    let normal = true_normal(body, contact, start);
    let jet = body.jet(normal);
    model.columns(theta, normal, columns)?;
    let (whitening, log_determinant) = whiten(&jet, contact)?;
    let turn = contact.contact.normal.get() - normal.get();
    let residual = whitening * vector(contact.contact.point - jet.point - jet.hessian * turn);
    Some(Linearised { whitening, residual, normal, log_determinant })
}

/// Newton's method, without the third derivatives, with halved steps.
fn true_normal(body: &dyn SupportFunction, contact: &NoisyContact, start: Direction) -> Direction {
    let variance = contact.noise.normal.powi(2);
    if variance == 0.0 {
        return contact.contact.normal;
    }
    let (point, measured) = (contact.contact.point, contact.contact.normal.get());
    let weight = contact.noise.point.inverse();
    let misfit = |jet: &SupportJet, n: DVec3| {
        let e = point - jet.point;
        variance * e.dot(weight * e) + measured.distance_squared(n)
    };
    let mut normal = start;
    let mut jet = body.jet(normal);
    let mut value = misfit(&jet, normal.get());
    for _ in 0..NORMAL_STEPS {
        let n = normal.get();
        let across = measured - n * measured.dot(n);
        let slope = jet.hessian * (weight * (point - jet.point)) * variance + across;
        let step = (jet.hessian * weight * jet.hessian * variance + DMat3::IDENTITY).inverse() * slope;
        let mut share = 1.0;
        let found = (0..HALVINGS).find_map(|_| {
            let next = Direction::new(n + step * share).ok()?;
            share *= 0.5;
            let next_jet = body.jet(next);
            let next_value = misfit(&next_jet, next.get());
            let near = next.get().dot(measured) > LEAST_COSINE;
            (near && next_value < value).then_some((next, next_jet, next_value))
        });
        let Some(found) = found else { break };
        (normal, jet, value) = found;
        if step.length() < NORMAL_STILL {
            break;
        }
    }
    normal
}

fn whiten(jet: &SupportJet, contact: &NoisyContact) -> Option<(Matrix3<f64>, f64)> {
    let h: DMat3 = jet.hessian;
    let covariance = contact.noise.point + h * h.transpose() * contact.noise.normal.powi(2);
    let own = Matrix3::from_fn(|i, j| covariance.col(j)[i]).cholesky()?;
    let factor = own.l();
    let log_determinant = 2.0 * factor.diagonal().iter().map(|d| d.ln()).sum::<f64>();
    let whitening = factor.solve_lower_triangular(&Matrix3::identity())?;
    whitening.iter().all(|v| v.is_finite()).then_some((whitening, log_determinant))
}

fn vector(v: DVec3) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

impl Linearised {
    /// Hands the three whitened rows of the step's equations to `root`. `row` has room for parameters and right-hand side.
    pub(super) fn insert(&self, columns: &[DVec3], root: &mut SquareRoot, row: &mut [f64]) {
        let count = columns.len();
        for i in 0..3 {
            for (entry, column) in row.iter_mut().zip(columns) {
                *entry = (0..=i).map(|j| self.whitening[(i, j)] * column[j]).sum();
            }
            row[count] = self.residual[i];
            root.insert(row);
        }
    }
}

/// All contacts linearised at the same parameters.
pub(super) struct System {
    pub(super) root: SquareRoot,
    pub(super) contacts: Vec<Linearised>,
    pub(super) chi_squared: f64,
}

/// Linearises all contacts; the search for their true normals starts from those of `before`, or from those measured.
pub(super) fn assemble(
    model: &(impl Model + ?Sized),
    theta: &DVector<f64>,
    contacts: &[NoisyContact],
    before: Option<&System>,
) -> Option<System> {
    let count = model.count();
    let body = model.body(theta)?;
    let mut root = SquareRoot::new(count);
    let (mut columns, mut row) = (vec![DVec3::ZERO; count], vec![0.0; count + 1]);
    let mut linearised = Vec::with_capacity(contacts.len());
    let mut chi_squared = 0.0;
    for (k, contact) in contacts.iter().enumerate() {
        let start = before.map_or(contact.contact.normal, |system| system.contacts[k].normal);
        let own = linearise(model, theta, body.as_ref(), contact, start, &mut columns)?;
        own.insert(&columns, &mut root, &mut row);
        chi_squared += own.residual.norm_squared();
        linearised.push(own);
    }
    Some(System { root, contacts: linearised, chi_squared })
}

/// Where an iteration came to rest.
pub(super) struct Solution {
    pub(super) theta: DVector<f64>,
    pub(super) system: System,
    pub(super) iterations: usize,
}

/// Why an iteration did not come to rest.
pub(super) enum Unsolved {
    /// The equations leave a combination open even for rounding's sake.
    Singular(System),
    NotConverged(usize),
}

/// The likeliest parameters.
///
/// First with the normals taken as exact, which is a smooth problem from any start; from the best of its solutions, with
/// the true normals eliminated. Started far off, the search for a true normal can end on the wrong side of the body.
pub(super) fn solve(
    model: &(impl Model + ?Sized),
    starts: Vec<DVector<f64>>,
    contacts: &[NoisyContact],
    size: f64,
) -> Result<Solution, Unsolved> {
    let mut exact = contacts.to_vec();
    exact.iter_mut().for_each(|c| c.noise.normal = 0.0);
    let mut best: Result<Solution, Unsolved> = Err(Unsolved::NotConverged(0));
    for start in starts {
        let found = iterate(model, start, &exact, size);
        let better = match (&found, &best) {
            (Ok(found), Ok(known)) => found.system.chi_squared < known.system.chi_squared,
            (Err(Unsolved::NotConverged(_)), _) | (Err(_), Ok(_)) => false,
            _ => true,
        };
        if better {
            best = found;
        }
    }
    iterate(model, best?.theta, contacts, size)
}

/// Levenberg's and Marquardt's iteration on the likelihood.
pub(super) fn iterate(
    model: &(impl Model + ?Sized),
    start: DVector<f64>,
    contacts: &[NoisyContact],
    size: f64,
) -> Result<Solution, Unsolved> {
    let scales = model.scales(size);
    let mut theta = start;
    let (mut damping, mut deficient) = (0.0, 0);
    let Some(mut system) = assemble(model, &theta, contacts, None) else {
        return Err(Unsolved::NotConverged(0));
    };
    for iterations in 1..=ITERATIONS {
        if damping > 0.0 || system.root.solve(0.0).is_none() {
            let open = system.root.knowledge(&scales).is_none_or(|known| known.rank < model.count());
            deficient += usize::from(open);
            if deficient > DEFICIENT {
                return Err(Unsolved::Singular(system));
            }
        }
        let Some(step) = system.root.solve(damping) else {
            damping = (damping * 10.0).max(1e-9);
            continue;
        };
        let deviations = (system.root.triangle() * &step).norm();
        let relative = step.component_div(&scales).amax();
        let improvement = deviations.powi(2) / system.chi_squared.max(f64::MIN_POSITIVE);
        if damping == 0.0 && (deviations <= STILL || relative <= ROUNDING || improvement <= FLAT) {
            return Ok(Solution { theta, system, iterations });
        }
        let next = model.moved(&theta, &step);
        let renewed = assemble(model, &next, contacts, Some(&system))
            .filter(|renewed| renewed.chi_squared <= system.chi_squared * (1.0 + 1e-12) || relative <= 1e-10);
        match renewed {
            Some(renewed) => {
                (theta, system) = (next, renewed);
                damping = if damping < 1e-7 { 0.0 } else { damping * 0.1 };
            }
            None if improvement <= STALLED => return Ok(Solution { theta, system, iterations }),
            None if damping > 1e9 => return Err(Unsolved::NotConverged(iterations)),
            None => damping = (damping * 10.0).max(1e-6),
        }
    }
    Err(Unsolved::NotConverged(ITERATIONS))
}

impl Unsolved {
    pub(super) fn into_error(
        self,
        model: &(impl Model + ?Sized),
        family: super::ShapeFamily,
        size: f64,
    ) -> FitError {
        match self {
            Self::Singular(system) => super::undetermined(model, family, &system.root, size),
            Self::NotConverged(iterations) => FitError::NotConverged { family, iterations },
        }
    }
}

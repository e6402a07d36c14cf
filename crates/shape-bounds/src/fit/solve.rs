//! Nonlinear least squares over contacts whose points and normals are both uncertain.

use super::family::Model;
use super::information::SquareRoot;
use super::levenberg::{self, ITERATIONS, Problem, System, Whitened, ends, iterate};
use super::{FitError, ShapeFamily};
use crate::noise::NoisyContact;
use contact_kinematics::{Direction, SupportFunction, SupportJet};
use glam::{DMat3, DVec3};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

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
    /// A whitened column's entry in one of the three rows.
    fn entry(&self, i: usize, column: DVec3) -> f64 {
        (0..=i).map(|j| self.whitening[(i, j)] * column[j]).sum()
    }

    /// Hands the three whitened rows of the step's equations to `root`. `row` has room for parameters and right-hand side.
    pub(super) fn insert(&self, columns: &[DVec3], root: &mut SquareRoot, row: &mut [f64]) {
        let count = columns.len();
        for i in 0..3 {
            row.iter_mut().zip(columns).for_each(|(entry, column)| *entry = self.entry(i, *column));
            row[count] = self.residual[i];
            root.insert(row);
        }
    }
}

/// Contacts against a family.
pub(super) struct Spatial<'a, M: ?Sized> {
    pub(super) model: &'a M,
    pub(super) contacts: &'a [NoisyContact],
    pub(super) size: f64,
}

impl<M: Model + ?Sized> Problem for Spatial<'_, M> {
    type Contact = Linearised;

    /// The search for the true normals starts from those of `before`, or from those measured.
    fn assemble(
        &self,
        theta: &DVector<f64>,
        before: Option<&System<Linearised>>,
    ) -> Option<System<Linearised>> {
        let count = self.model.count();
        let body = self.model.body(theta)?;
        let mut root = SquareRoot::new(count);
        let (mut columns, mut row) = (vec![DVec3::ZERO; count], vec![0.0; count + 1]);
        let mut contacts = Vec::with_capacity(self.contacts.len());
        let mut chi_squared = 0.0;
        for (k, contact) in self.contacts.iter().enumerate() {
            let start = before.map_or(contact.contact.normal, |system| system.contacts[k].normal);
            let own = linearise(self.model, theta, body.as_ref(), contact, start, &mut columns)?;
            own.insert(&columns, &mut root, &mut row);
            chi_squared += own.residual.norm_squared();
            contacts.push(own);
        }
        Some(System { root, contacts, chi_squared })
    }

    fn moved(&self, theta: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
        self.model.moved(theta, step)
    }

    fn scales(&self) -> DVector<f64> {
        self.model.scales(self.size)
    }

    fn whitened(&self, solution: &Solution) -> Option<Whitened> {
        let contacts = &solution.system.contacts;
        let rows = whitened_rows(self.model, &solution.theta, contacts, 0)?;
        let residuals =
            contacts.iter().flat_map(|own| [own.residual.x, own.residual.y, own.residual.z]).collect();
        Some(Whitened { dimension: 3, rows, residuals })
    }
}

/// Whitened rows of a model's parameters from a first one on, three to a contact; `None` where it is no body.
pub(super) fn whitened_rows(
    model: &(impl Model + ?Sized),
    theta: &DVector<f64>,
    contacts: &[Linearised],
    first: usize,
) -> Option<DMatrix<f64>> {
    let mut columns = vec![DVec3::ZERO; model.count()];
    let mut rows = DMatrix::zeros(3 * contacts.len(), columns.len() - first);
    for (k, own) in contacts.iter().enumerate() {
        model.columns(theta, own.normal, &mut columns)?;
        for (j, column) in columns[first..].iter().enumerate() {
            (0..3).for_each(|i| rows[(3 * k + i, j)] = own.entry(i, *column));
        }
    }
    Some(rows)
}

/// Where a fit in space came to rest.
pub(super) type Solution = levenberg::Solution<Linearised>;
type Unsolved = levenberg::Unsolved<Linearised>;

/// Contacts that starts are tried on, spread evenly over all: enough to tell a right valley from a wrong one.
const TRIED: usize = 100;
/// What a solution is worth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// Ends of starts that are followed to rest, at most.
    pub(super) followed: usize,
    /// Iterations for each.
    pub(super) iterations: usize,
}

impl Default for Effort {
    fn default() -> Self {
        Self { followed: 1, iterations: ITERATIONS }
    }
}

/// Ends of starts whose sums of squares differ by less than this share are the same.
pub(super) const SAME: f64 = 1e-6;

/// The likeliest parameters.
///
/// First with the normals taken as exact, which is a smooth problem from any start; from where that leads, with the true
/// normals eliminated, the best end first, until one is good `enough`, else the best of those. Started far off, the search for a
/// true normal can end on the wrong side of the body.
pub(super) fn solve<M: Model + ?Sized>(
    problem: &Spatial<'_, M>,
    starts: Vec<DVector<f64>>,
    effort: Effort,
    enough: impl Fn(&Solution) -> bool,
) -> Result<Solution, Unsolved> {
    let mut exact = thinned(problem.contacts, if starts.len() > 1 { TRIED } else { usize::MAX });
    exact.iter_mut().for_each(|c| c.noise.normal = 0.0);
    let ends = ends(&Spatial { contacts: &exact, ..*problem }, starts)?;
    let mut best: Option<Solution> = None;
    let mut failure = None;
    let mut last = f64::NEG_INFINITY;
    let mut followed = 0;
    for (end, chi_squared) in ends {
        if followed == effort.followed {
            break;
        }
        if chi_squared - last <= SAME * chi_squared {
            continue;
        }
        last = chi_squared;
        followed += 1;
        match iterate(problem, end, effort.iterations) {
            Ok(found) if enough(&found) => return Ok(found),
            Ok(found) => {
                if best.as_ref().is_none_or(|known| found.system.chi_squared < known.system.chi_squared) {
                    best = Some(found);
                }
            }
            Err(error) => failure = failure.or(Some(error)),
        }
    }
    best.ok_or_else(|| failure.unwrap_or(Unsolved::NotConverged(0, None)))
}

/// At most `most` contacts, spread evenly.
pub(super) fn thinned(contacts: &[NoisyContact], most: usize) -> Vec<NoisyContact> {
    let count = contacts.len().min(most);
    (0..count).map(|k| contacts[k * contacts.len() / count]).collect()
}

/// What a failed iteration says of the contacts.
pub(super) fn into_error(
    failure: Unsolved,
    model: &(impl Model + ?Sized),
    family: ShapeFamily,
    size: f64,
) -> FitError {
    match failure {
        Unsolved::Singular(system) => undetermined(model, family, &system.root, size),
        Unsolved::NotConverged(iterations, _) => FitError::NotConverged { family, iterations },
    }
}

pub(super) fn undetermined(
    model: &(impl Model + ?Sized),
    family: ShapeFamily,
    root: &SquareRoot,
    size: f64,
) -> FitError {
    let known = root.knowledge(&model.scales(size));
    FitError::Undetermined {
        family,
        rank: known.map_or(0, |k| k.rank),
        parameters: model.count(),
        condition: known.map_or(f64::INFINITY, |k| k.condition),
        weakest: known.map_or_else(String::new, |k| model.name(k.weakest_parameter)),
        deviation: known.map_or(f64::INFINITY, |k| k.weakest_deviation),
    }
}

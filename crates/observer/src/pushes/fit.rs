//! The fit of one outline to touches: distances of the finger's centre, and forces within any reasonable friction cone.

use super::shape::{MOST, Shape};
use super::touches::Touch;
use crate::least_squares::{Fit, LeastSquares, LevenbergMarquardt, NormalEquations};
use contact_kinematics::is_stopped;
use nalgebra::{SMatrix, SVector};
use object_dynamics::pushing::{ClosedLine, Nearest};

/// Unknowns of the shape and two times.
pub(super) const UNKNOWNS: usize = MOST + 2;
pub(super) type Vector = SVector<f64, UNKNOWNS>;
pub(super) type Matrix = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// Degrees of freedom of the distribution of the residuals: four give an outlier of five deviations a thousand times the odds that a
/// normal one would.
const STUDENT: f64 = 4.0;
/// Deviation of the angle between force and inward normal, rad: coefficients of friction up to 0.7 lie within two of them.
const ANGLE: f64 = 0.35;
/// Deviation of what clocks and the end of the record may be off, s: machines that log each by its own clock differ by as much.
pub(super) const CLOCK: f64 = 0.1;
/// Prior of the shape's unknowns about the start, in sizes of the object: it holds what no touch tells.
const LOOSE: f64 = 3.0;
/// Prior of harmonic `k`, in sizes over `k`.
pub(super) const HARMONIC: f64 = 0.5;
/// Step of the differences by which rows are taken, in sizes of the object.
const STEP: f64 = 1e-6;
/// Rounds in which deviations and shape are found in turn: of a fit that is kept, and of one that is only compared.
const ROUNDS: usize = 8;
const QUICK: usize = 1;
/// Steps of a round.
const ITERATIONS: usize = 15;
/// First deviation of touches, as a share of the size, and the least, m: as finely as arms tell where they are.
const FIRST: f64 = 0.04;
const LEAST: f64 = 1e-5;

/// A shape and the two times: how far the finger's record is ahead at the beginning, and at the end.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) shape: Shape,
    pub(super) times: [f64; 2],
}

/// The touches, and how far they may be off.
#[derive(Clone, Debug)]
pub(super) struct Problem<'a> {
    pub(super) touches: &'a [[Touch; 2]],
    pub(super) radius: f64,
    /// Natural size of the object, m.
    pub(super) size: f64,
    /// Deviations of the mean of the two touches of a push, and of half their difference, m.
    pub(super) deviations: [f64; 2],
    start: Shape,
    /// Weights of plain residuals in place of robust ones: what they tell, rather than where the least cost is.
    plain: Option<[f64; 2]>,
}

/// A fit with its deviations.
#[derive(Clone, Debug)]
pub(super) struct Fitted {
    pub(super) point: Point,
    pub(super) line: ClosedLine,
    pub(super) deviations: [f64; 2],
    /// Shares of the readings of each kind that the fit leaves free.
    pub(super) free: [f64; 2],
    /// Twice the negative logarithm of the evidence, to a constant.
    pub(super) misfit: f64,
    /// What of it each push costs.
    pub(super) of_pushes: Vec<f64>,
}

impl<'a> Problem<'a> {
    pub(super) fn new(
        touches: &'a [[Touch; 2]],
        radius: f64,
        size: f64,
        deviations: [f64; 2],
        start: Shape,
    ) -> Self {
        Self { touches, radius, size, deviations, start, plain: None }
    }

    /// Where the outline is nearest to the finger at the two touches of a push.
    fn nearest(&self, line: &ClosedLine, times: [f64; 2], pair: &[Touch; 2]) -> [Nearest; 2] {
        [0, 1].map(|i| line.nearest(pair[i].centre - pair[i].velocity * times[i]))
    }

    /// Mean and half difference of the gaps of a push, m.
    fn parts_of(&self, nearest: &[Nearest; 2]) -> [f64; 2] {
        let [a, b] = nearest.map(|near| near.distance - self.radius);
        [0.5 * (a + b), 0.5 * (a - b)]
    }

    /// Mean and half difference of the gaps of each push, m.
    pub(super) fn parts(&self, line: &ClosedLine, times: [f64; 2]) -> Vec<[f64; 2]> {
        self.touches.iter().map(|pair| self.parts_of(&self.nearest(line, times, pair))).collect()
    }

    /// All residuals at a point; none where the shape is none.
    pub(super) fn residuals(&self, point: &Point) -> Option<Vec<f64>> {
        let line = point.shape.line()?;
        let mut all = Vec::with_capacity(4 * self.touches.len() + UNKNOWNS);
        for pair in self.touches {
            let nearest = self.nearest(&line, point.times, pair);
            for (i, part) in self.parts_of(&nearest).into_iter().enumerate() {
                let z = part / self.deviations[i];
                all.push(self.plain.map_or_else(|| robust(z), |weights| z * weights[i]));
            }
            for (touch, near) in pair.iter().zip(nearest) {
                let inward = -near.normal;
                all.push(robust(inward.perp_dot(touch.force).atan2(inward.dot(touch.force)) / ANGLE));
            }
        }
        all.extend(point.times.map(|t| t / CLOCK));
        match (&point.shape, &self.start) {
            (Shape::Smooth { coefficients, .. }, _) => {
                for (k, c) in coefficients.iter().enumerate().skip(1) {
                    all.push(c / self.size * k.div_ceil(2) as f64 / HARMONIC);
                }
            }
            (Shape::Polygon(now), Shape::Polygon(start)) => {
                for (p, q) in now.iter().zip(start) {
                    all.extend(((*p - *q) / (LOOSE * self.size)).to_array());
                }
            }
            (Shape::Polygon(_), Shape::Smooth { .. }) => {}
        }
        Some(all)
    }

    /// Residuals and how they change with the unknowns.
    pub(super) fn rows(&self, point: &Point) -> Option<(Vec<Vector>, Vec<f64>)> {
        let residuals = self.residuals(point)?;
        let mut rows = vec![Vector::zeros(); residuals.len()];
        for j in (0..point.shape.unknowns()).chain(MOST..UNKNOWNS) {
            let shifted = |by: f64| self.residuals(&self.step(point, |k| if k == j { by } else { 0.0 }));
            let (above, below) = (shifted(STEP)?, shifted(-STEP)?);
            for (row, (a, b)) in rows.iter_mut().zip(above.iter().zip(&below)) {
                row[j] = (a - b) / (2.0 * STEP);
            }
        }
        Some((rows, residuals))
    }

    fn step(&self, point: &Point, step: impl Fn(usize) -> f64) -> Point {
        Point {
            shape: point.shape.moved(|k| step(k) * self.size),
            times: [0, 1].map(|i| point.times[i] + step(MOST + i) * CLOCK),
        }
    }
}

/// `sign(z) sqrt(rho(z))` with the negative log density `rho / 2` of Student's distribution.
fn robust(z: f64) -> f64 {
    ((STUDENT + 1.0) * (z * z / STUDENT).ln_1p()).sqrt().copysign(z)
}

impl LeastSquares<UNKNOWNS> for Problem<'_> {
    type Point = Point;

    fn linearise(&self, point: &Point) -> Option<NormalEquations<UNKNOWNS>> {
        if is_stopped() {
            return None;
        }
        let (rows, residuals) = self.rows(point)?;
        let mut normal = NormalEquations::default();
        rows.iter().zip(&residuals).for_each(|(row, r)| normal.add(row, *r));
        // Unknowns that this shape does not have stay where they are.
        for j in point.shape.unknowns()..MOST {
            normal.information[(j, j)] += 1.0;
        }
        Some(normal)
    }

    fn cost(&self, point: &Point) -> Option<f64> {
        Some(self.residuals(point)?.iter().map(|r| r * r).sum())
    }

    fn retract(&self, point: &Point, step: &Vector) -> Point {
        self.step(point, |k| step[k])
    }
}

/// Fits a shape and the deviations of the touches in turn, from no guess of these.
pub(super) fn fit(touches: &[[Touch; 2]], radius: f64, size: f64, start: Shape) -> Option<Fitted> {
    let problem = Problem::new(touches, radius, size, [FIRST * size; 2], start.clone());
    in_turn(problem, Point { shape: start, times: [0.0; 2] }, ROUNDS)
}

/// Fits a shape from deviations and times that are about right: in one round, enough to compare it with others.
pub(super) fn compared(
    near: &Fitted,
    touches: &[[Touch; 2]],
    radius: f64,
    size: f64,
    start: Shape,
) -> Option<Fitted> {
    let deviations = near.deviations.map(|d| 2.0 * d);
    let problem = Problem::new(touches, radius, size, deviations, start.clone());
    in_turn(problem, Point { shape: start, times: near.point.times }, QUICK)
}

/// Goes on with a fit until its deviations are settled.
pub(super) fn settled(from: Fitted, touches: &[[Touch; 2]], radius: f64, size: f64) -> Option<Fitted> {
    let problem = Problem::new(touches, radius, size, from.deviations, from.point.shape.clone());
    in_turn(problem, from.point, ROUNDS)
}

fn in_turn(mut problem: Problem, mut point: Point, rounds: usize) -> Option<Fitted> {
    let (touches, size) = (problem.touches, problem.size);
    let solver = LevenbergMarquardt { iterations: ITERATIONS, step_tolerance: 1e-9, ..Default::default() };
    for round in 0..rounds {
        let made: Fit<Point, UNKNOWNS> = solver.fit(&problem, point);
        let line = made.point.shape.line()?;
        point = made.point;
        if made.normal.count == 0 {
            return None;
        }
        let parts = problem.parts(&line, point.times);
        let (free, _) = problem.told(&point)?;
        let fresh = [0, 1].map(|i| {
            let of: Vec<f64> = parts.iter().map(|p| p[i]).collect();
            let scale = scale(&of, problem.deviations[i]) / free[i].sqrt();
            // Never much smaller at once: then outliers of the first shape would be there for good.
            scale.max(0.3 * problem.deviations[i]).max(LEAST)
        });
        let settled = (0..2).all(|i| (fresh[i] / problem.deviations[i]).ln().abs() < 0.01);
        problem.deviations = fresh;
        if settled || round + 1 == rounds {
            let (of_pushes, of_rest) = problem.with_strays(&point)?;
            let logs: f64 = fresh.iter().map(|d| 2.0 * (d / size).ln()).sum();
            let (free, narrowed) = problem.told(&point)?;
            let of_rest = of_rest + touches.len() as f64 * logs + narrowed;
            let misfit = of_pushes.iter().sum::<f64>() + of_rest;
            return Some(Fitted { point, line, deviations: fresh, free, misfit, of_pushes });
        }
    }
    None
}

/// What the touches tell of the unknowns, by how they scatter: `(mean psi')^2 / mean psi^2` for each residual, `psi` being half the slope of
/// the robust cost (Huber, Robust Statistics, 1981, section 6.3).
pub(super) fn information(fitted: &Fitted, touches: &[[Touch; 2]], radius: f64, size: f64) -> Option<Matrix> {
    let mut problem = Problem::new(touches, radius, size, fitted.deviations, fitted.point.shape.clone());
    let parts = problem.parts(&fitted.line, fitted.point.times);
    let weight = |i: usize| {
        let (mut slope, mut square) = (0.0, 0.0);
        for z in parts.iter().map(|part| part[i] / fitted.deviations[i]) {
            let sum = STUDENT + z * z;
            slope += (STUDENT + 1.0) * (STUDENT - z * z) / (sum * sum);
            square += ((STUDENT + 1.0) * z / sum).powi(2);
        }
        slope.max(0.0) / (square * parts.len() as f64).sqrt() * fitted.free[i].sqrt()
    };
    problem.plain = Some([weight(0), weight(1)]);
    problem.linearise(&fitted.point).map(|normal| normal.information)
}

/// Scale of Student's distribution by expectation and maximisation.
fn scale(residuals: &[f64], start: f64) -> f64 {
    let mut scale = start.max(LEAST);
    for _ in 0..20 {
        let sum: f64 =
            residuals.iter().map(|r| (STUDENT + 1.0) / (STUDENT + (r / scale).powi(2)) * r * r).sum();
        scale = (sum / residuals.len() as f64).sqrt().max(LEAST);
    }
    scale
}

//! Least squares of the contacts that the equations of motion predict.

use super::series::{Contacts, Nodes};
use super::shape::{FreeEllipsoid, SHAPE_NUMBERS};
use crate::least_squares::{LeastSquares, NormalEquations};
use crate::rigid::{INERTIA_NUMBERS, inertia_of_numbers};
use contact_kinematics::is_stopped;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::SVector;
use object_dynamics::{Instant, MassProperties};

/// Angular velocity, shape, inertia over mass.
pub(super) const UNKNOWNS: usize = 3 + SHAPE_NUMBERS + INERTIA_NUMBERS;
pub(super) type Row = SVector<f64, UNKNOWNS>;

/// Step of the differences that derivatives are taken from, in natural sizes: the error by the third derivative and
/// that by rounding are then both below 1e-8.
pub(super) const DIFFERENCE: f64 = 1e-5;

/// A motion and the body that makes it: body axes are the world's at the first node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Guess {
    /// Angular velocity at the first node, rad/s.
    pub(super) w: DVec3,
    pub(super) shape: [f64; SHAPE_NUMBERS],
    pub(super) inertia: [f64; INERTIA_NUMBERS],
}

/// Contacts at the nodes of a series, in a window.
pub(super) struct TouchProblem<'a> {
    pub(super) nodes: &'a Nodes,
    pub(super) gravity: DVec3,
    /// Natural length, m.
    pub(super) length: f64,
    /// Inner nodes that are looked at.
    pub(super) end: usize,
    /// Whether derivatives are differences to one side only: half the work, and right to five digits.
    one_sided: bool,
}

impl<'a> TouchProblem<'a> {
    /// Of the nodes up to `window` seconds.
    pub(super) fn new(nodes: &'a Nodes, gravity: DVec3, length: f64, window: f64) -> Self {
        let end =
            nodes.t.partition_point(|&t| t <= window + 1e-12).saturating_sub(2).clamp(1, nodes.means.len());
        Self { nodes, gravity, length, end, one_sided: false }
    }

    /// The same of other readings.
    pub(super) fn with_nodes<'b>(&self, nodes: &'b Nodes) -> TouchProblem<'b> {
        let Self { gravity, length, end, one_sided, .. } = *self;
        TouchProblem { nodes, gravity, length, end, one_sided }
    }

    /// The same with derivatives that do for a search.
    pub(super) fn coarse(self) -> Self {
        Self { one_sided: true, ..self }
    }

    /// Natural sizes of the unknowns: steps of logarithms are of size one.
    pub(super) fn scales(&self) -> Row {
        let rate = (self.gravity.length() / self.length).sqrt();
        Row::from_fn(|i, _| match i {
            0..=2 => rate,
            6..=11 | 15..=17 => self.length,
            _ => 1.0,
        })
    }

    /// The numbers a step away, which is in natural sizes.
    pub(super) fn retract_by(&self, point: &Guess, step: &Row) -> Guess {
        let step = step.component_mul(&self.scales());
        Guess {
            w: point.w + DVec3::new(step[0], step[1], step[2]),
            shape: std::array::from_fn(|i| point.shape[i] + step[3 + i]),
            inertia: std::array::from_fn(|i| point.inertia[i] + step[3 + SHAPE_NUMBERS + i]),
        }
    }

    /// The motion at every node, with contacts; none where the numbers make no motion.
    pub(super) fn motion(&self, guess: &Guess, nodes: usize) -> Option<Vec<Instant>> {
        let shape = FreeEllipsoid::new(&guess.shape);
        let mass = MassProperties::new(1.0, inertia_of_numbers(&guess.inertia)).ok()?;
        let at = |half: usize, q: DQuat, w: DVec3| {
            let sound = q.is_finite() && w.is_finite();
            sound.then(|| Instant::new(&shape, &mass, self.gravity, self.nodes.palms[half], (0.0, q, w)))
        };
        let (mut q, mut w) = (DQuat::IDENTITY, guess.w);
        let mut all = Vec::with_capacity(nodes);
        for k in 0..nodes {
            let now = at(2 * k, q, w)?;
            all.push(Instant { t: self.nodes.t[k], ..now });
            if k + 1 == nodes {
                break;
            }
            // Runge-Kutta step of order 4.
            let h = self.nodes.t[k + 1] - self.nodes.t[k];
            let slope = |w: DVec3, q: DQuat| DQuat::from_xyzw(0.5 * w.x, 0.5 * w.y, 0.5 * w.z, 0.0) * q;
            let after = |half: usize, s: f64, dq: DQuat, a: DVec3| {
                let (q, w) = ((q + dq * s).normalize(), w + a * s);
                Some((slope(w, q), at(half, q, w)?.accelerations.alpha_WO))
            };
            let (q1, a1) = (slope(w, q), now.accelerations.alpha_WO);
            let (q2, a2) = after(2 * k + 1, 0.5 * h, q1, a1)?;
            let (q3, a3) = after(2 * k + 1, 0.5 * h, q2, a2)?;
            let (q4, a4) = after(2 * k + 2, h, q3, a3)?;
            q = (q + (q1 + (q2 + q3) * 2.0 + q4) * (h / 6.0)).normalize();
            w += (a1 + (a2 + a3) * 2.0 + a4) * (h / 6.0);
        }
        Some(all)
    }

    /// Predicted means of the contacts over the blocks.
    fn predicted(&self, guess: &Guess) -> Option<Vec<Contacts>> {
        let motion = self.motion(guess, self.end + 2)?;
        let s: Vec<Contacts> = motion.iter().map(|now| std::array::from_fn(|i| now.sensor(i))).collect();
        let mean = |w: &[Contacts]| -> Contacts {
            std::array::from_fn(|i| {
                std::array::from_fn(|a| {
                    w[1][i][a] + self.nodes.curved * (w[0][i][a] - 2.0 * w[1][i][a] + w[2][i][a])
                })
            })
        };
        Some(s.windows(3).map(mean).collect())
    }

    /// Differences of predicted and measured contacts, m.
    pub(super) fn residuals(&self, guess: &Guess) -> Option<Vec<f64>> {
        let predicted = self.predicted(guess)?;
        let pairs = predicted.iter().zip(&self.nodes.means);
        Some(pairs.flat_map(|(a, b)| (0..6).map(move |c| a[c / 2][c % 2] - b[c / 2][c % 2])).collect())
    }
}

impl TouchProblem<'_> {
    /// Derivatives of the residuals, which are those at `point`, by the unknowns in natural sizes.
    pub(super) fn slopes(&self, point: &Guess, residuals: &[f64]) -> Option<Vec<Vec<f64>>> {
        let mut slopes = Vec::with_capacity(UNKNOWNS);
        for i in 0..UNKNOWNS {
            let moved = |h: f64| {
                self.residuals(&self.retract_by(point, &Row::from_fn(|j, _| if i == j { h } else { 0.0 })))
            };
            let ahead = moved(DIFFERENCE)?;
            let (behind, apart) = if self.one_sided {
                (residuals.to_vec(), DIFFERENCE)
            } else {
                (moved(-DIFFERENCE)?, 2.0 * DIFFERENCE)
            };
            slopes.push(ahead.iter().zip(&behind).map(|(a, b)| (a - b) / apart).collect::<Vec<f64>>());
        }
        Some(slopes)
    }
}

impl LeastSquares<UNKNOWNS> for TouchProblem<'_> {
    type Point = Guess;

    fn linearise(&self, point: &Guess) -> Option<NormalEquations<UNKNOWNS>> {
        if is_stopped() {
            return None;
        }
        let residuals = self.residuals(point)?;
        let slopes = self.slopes(point, &residuals)?;
        let mut normal = NormalEquations::default();
        for (k, &residual) in residuals.iter().enumerate() {
            normal.add(&Row::from_fn(|i, _| slopes[i][k]), residual);
        }
        normal.cost.is_finite().then_some(normal)
    }

    fn cost(&self, point: &Guess) -> Option<f64> {
        let cost: f64 = self.residuals(point)?.iter().map(|r| r * r).sum();
        cost.is_finite().then_some(cost)
    }

    fn retract(&self, point: &Guess, step: &Row) -> Guess {
        self.retract_by(point, step)
    }
}

/// Inertia over mass of a uniform ellipsoid, m^2.
pub(super) fn uniform(semi_axes: DVec3, turn: DQuat) -> DMat3 {
    let square = semi_axes * semi_axes;
    let moments = (DVec3::splat(square.element_sum()) - square) / 5.0;
    let axes = DMat3::from_quat(turn);
    axes * DMat3::from_diagonal(moments) * axes.transpose()
}

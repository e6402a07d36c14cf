//! Coulomb's law at all contacts together, as equations.

use super::MOST_PALMS;
use super::choose::{Choice, Touch};
use super::coulomb::Forces;
use super::problem::{ContactProblem, Directions, Modes};
use super::solve::Dense;
use crate::ContactMode;
use glam::{DVec2, DVec3};

const N: usize = 3 * MOST_PALMS;

/// Forces of the contacts that touch, one triple after the other.
pub(super) type Unknowns = [f64; N];

/// The law as equations `F(r) = 0`, a triple for each contact that touches.
pub(super) struct Law<'a> {
    pub(super) problem: &'a ContactProblem,
    touches: &'a [Touch; MOST_PALMS],
    pub(super) touching: Vec<usize>,
    /// What a unit of force along each axis does to the motion along each axis, and the motion without forces.
    response: [[f64; N]; N],
    pub(super) free: Unknowns,
    /// Diagonal of the response of contacts that do not give way.
    rigid: Unknowns,
    pub(super) scale: f64,
    /// How much a velocity weighs against a force, in units of the contact's own response. Any gives the same solutions; slow
    /// slips are found with a large one.
    weight: f64,
}

/// Which part of the law a contact is on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Branch {
    Apart,
    Sticks,
    /// The direction of its friction, what it comes from, and the friction that the cone allows.
    Slides {
        tau: DVec2,
        length: f64,
        radius: f64,
    },
    /// It slides already, in a direction that is known.
    Held {
        tau: DVec2,
    },
}

impl<'a> Law<'a> {
    pub(super) fn new(problem: &'a ContactProblem, touches: &'a [Touch; MOST_PALMS]) -> Self {
        let touching = (0..problem.contacts().len()).filter(|&i| touches[i] != Touch::Apart).collect();
        let mut law = Self {
            problem,
            touches,
            touching,
            response: [[0.0; N]; N],
            free: [0.0; N],
            rigid: [0.0; N],
            scale: problem.force_scale(|i| touches[i] != Touch::Apart),
            weight: 1.0,
        };
        for (k, &j) in law.touching.iter().enumerate() {
            let contact = &problem.contacts()[j];
            for (c, axis) in contact.axes().into_iter().enumerate() {
                law.free[3 * k + c] = axis.dot(contact.free);
                for (l, &i) in law.touching.iter().enumerate() {
                    let moved = problem.moved_by(i, j, axis);
                    for (r, row) in problem.contacts()[i].axes().into_iter().enumerate() {
                        law.response[3 * l + r][3 * k + c] = row.dot(moved);
                    }
                }
                law.rigid[3 * k + c] = law.response[3 * k + c][3 * k + c];
            }
            law.free[3 * k] += contact.normal_bias;
        }
        law
    }

    fn size(&self) -> usize {
        3 * self.touching.len()
    }

    fn rho(&self, i: usize) -> f64 {
        self.weight / self.problem.own_response(i)
    }

    pub(super) fn gathered(&self, all: &Forces) -> Unknowns {
        let mut r = [0.0; N];
        for (k, &i) in self.touching.iter().enumerate() {
            r[3 * k..3 * k + 3].copy_from_slice(&all[i]);
        }
        r
    }

    pub(super) fn spread(&self, r: &Unknowns) -> Forces {
        let mut all = [[0.0; 3]; MOST_PALMS];
        for (k, &i) in self.touching.iter().enumerate() {
            all[i].copy_from_slice(&r[3 * k..3 * k + 3]);
        }
        all
    }

    /// Lets every contact give way by this share of its own response, with another weight of velocities.
    pub(super) fn at(&mut self, share: f64, weight: f64) -> &Self {
        self.weight = weight;
        for (k, &i) in self.touching.iter().enumerate() {
            for c in 3 * k..3 * k + 3 {
                self.response[c][c] = self.rigid[c] + share * self.problem.own_response(i);
            }
        }
        self
    }

    fn motion(&self, r: &Unknowns) -> Unknowns {
        let n = self.size();
        let mut u = self.free;
        for (row, u) in self.response[..n].iter().zip(&mut u) {
            *u += row[..n].iter().zip(r).map(|(w, r)| w * r).sum::<f64>();
        }
        u
    }

    fn branch(&self, k: usize, r: &Unknowns, u: &Unknowns) -> Branch {
        let i = self.touching[k];
        let y = |c: usize| r[3 * k + c] - self.rho(i) * u[3 * k + c];
        if y(0) <= 0.0 {
            return Branch::Apart;
        }
        if let Touch::Slides(along) = self.touches[i] {
            return Branch::Held { tau: -along };
        }
        let (tangent, radius) = (DVec2::new(y(1), y(2)), self.problem.contacts()[i].friction * y(0));
        let length = tangent.length();
        if length <= radius && radius > 0.0 {
            Branch::Sticks
        } else {
            Branch::Slides { tau: tangent.try_normalize().unwrap_or(DVec2::X), length, radius }
        }
    }

    /// `F(r)`, in units of force.
    pub(super) fn residual(&self, r: &Unknowns) -> Unknowns {
        let u = self.motion(r);
        let mut f = [0.0; N];
        for (k, &i) in self.touching.iter().enumerate() {
            let (at, rho) = (3 * k, self.rho(i));
            let (tau, radius) = match self.branch(k, r, &u) {
                Branch::Apart => {
                    f[at..at + 3].copy_from_slice(&r[at..at + 3]);
                    continue;
                }
                Branch::Sticks => {
                    (at..at + 3).for_each(|c| f[c] = rho * u[c]);
                    continue;
                }
                Branch::Slides { tau, radius, .. } => (tau, radius),
                Branch::Held { tau } => (tau, self.problem.contacts()[i].friction * (r[at] - rho * u[at])),
            };
            f[at] = rho * u[at];
            f[at + 1] = r[at + 1] - radius * tau.x;
            f[at + 2] = r[at + 2] - radius * tau.y;
        }
        f
    }

    /// Newton's step `-F'(r)^-1 F(r)`.
    pub(super) fn step(&self, r: &Unknowns, f: &Unknowns) -> Option<Unknowns> {
        let (n, u) = (self.size(), self.motion(r));
        let mut system = Dense::default();
        for (k, &i) in self.touching.iter().enumerate() {
            let (at, rho, friction) = (3 * k, self.rho(i), self.problem.contacts()[i].friction);
            let branch = self.branch(k, r, &u);
            for c in 0..n {
                let unit = |row: usize| if c == row { 1.0 } else { 0.0 };
                let turned = |row: usize| rho * self.response[row][c];
                let y = [0, 1, 2].map(|row| unit(at + row) - turned(at + row));
                let friction_change = match branch {
                    Branch::Slides { tau, length, radius } => {
                        let across = tau.perp().dot(DVec2::new(y[1], y[2]));
                        let share = if length > 0.0 { radius / length } else { 0.0 };
                        friction * y[0] * tau + share * across * tau.perp()
                    }
                    Branch::Held { tau } => friction * y[0] * tau,
                    Branch::Apart | Branch::Sticks => DVec2::ZERO,
                };
                let [p, q] = [friction_change.x, friction_change.y];
                let column = match branch {
                    Branch::Apart => [unit(at), unit(at + 1), unit(at + 2)],
                    Branch::Sticks => [turned(at), turned(at + 1), turned(at + 2)],
                    _ => [turned(at), unit(at + 1) - p, unit(at + 2) - q],
                };
                for (row, value) in column.into_iter().enumerate() {
                    system.matrix[at + row][c] = value;
                }
            }
        }
        for row in 0..n {
            system.right[row] = -f[row];
        }
        system.eliminate(n)
    }

    /// The modes, directions of slip and motion that forces mean.
    pub(super) fn choice(&self, r: &Unknowns) -> Choice {
        let u = self.motion(r);
        let mut modes: Modes = [ContactMode::Off; MOST_PALMS];
        let mut directions: Directions = [DVec2::X; MOST_PALMS];
        let mut forces = [DVec3::ZERO; MOST_PALMS];
        for (k, &i) in self.touching.iter().enumerate() {
            let contact = &self.problem.contacts()[i];
            let (normal, tangent) = (r[3 * k].max(0.0), DVec2::new(r[3 * k + 1], r[3 * k + 2]));
            let (mode, tangent) = match self.branch(k, r, &u) {
                Branch::Apart => continue,
                Branch::Sticks => (ContactMode::Stick, tangent),
                Branch::Slides { tau, .. } | Branch::Held { tau } => {
                    directions[i] = -tau;
                    (ContactMode::Slide, contact.friction * normal * tau)
                }
            };
            modes[i] = mode;
            forces[i] = normal * contact.n + contact.along_tangent(tangent);
        }
        Choice { modes, directions, reaction: self.problem.reaction(forces) }
    }
}

//! Coulomb's law at all contacts together, as equations: no list of modes, and forces that are one also where squeezes between
//! sticking contacts are free.

use super::MOST_PALMS;
use super::choose::{Choice, Touch};
use super::problem::{ContactProblem, Directions, Modes};
use super::solve::Dense;
use crate::ContactMode;
use glam::{DVec2, DVec3};
use std::f64::consts::{SQRT_2, TAU};

/// Newton's steps from one start, and halvings of one of them.
const STEPS: u32 = 30;
const HALVINGS: u32 = 12;
/// Forces within this share of the largest fulfil the law: what rounding leaves where contacts hardly creep.
const FULFILLED: f64 = 1e-10;
/// A factor of stiffness nearer to one than this says that the solution cannot be followed further.
const STUCK: f64 = 0.95;
/// Numbers without a rational ratio: their multiples fill a cube evenly (square roots of 2 and 3, the golden ratio).
const IRRATIONAL: [f64; 3] = [SQRT_2, 1.732_050_807_568_877_2, 1.618_033_988_749_895];
/// Weights of velocities for the starts spread over the cones.
const WEIGHTS: [f64; 4] = [1e4, 1e3, 1e5, 1e2];

/// Force of each contact along its normal and its two tangents, N (N s where the problem is one of velocities).
pub(crate) type Forces = [[f64; 3]; MOST_PALMS];

const N: usize = 3 * MOST_PALMS;
type Unknowns = [f64; N];

/// How hard a solution is looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search {
    /// Share of its own response by which a contact gives way to its force. It picks the smallest of the squeezes that are free;
    /// sticking contacts creep by this share of what their forces do.
    pub(crate) creep: f64,
    /// Starts spread over the cones that are tried where nothing else leads to a solution; of hard problems one in a hundred
    /// does.
    pub(crate) starts: u32,
}

/// The law as equations `F(r) = 0`, a triple for each contact that touches.
struct Law<'a> {
    problem: &'a ContactProblem,
    touches: &'a [Touch; MOST_PALMS],
    touching: Vec<usize>,
    /// What a unit of force along each axis does to the motion along each axis, and the motion without forces.
    response: [[f64; N]; N],
    free: Unknowns,
    /// Diagonal of the response of contacts that do not give way.
    rigid: Unknowns,
    scale: f64,
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

impl ContactProblem {
    /// Forces at which each contact sticks with its force in the cone, slides with it against its slip, or leaves without one.
    ///
    /// Newton's method on the equations of Alart and Curnier (1991), `r = P(r - rho u)` with the projection onto the section of
    /// the cone at `r_n - rho u_n`: from `guess`; then followed from contacts that give way to rigid ones; then from starts
    /// spread over the cones. None where none of them leads to a solution.
    pub(crate) fn coulomb(
        &self,
        touches: &[Touch; MOST_PALMS],
        guess: &Forces,
        search: Search,
    ) -> Option<(Choice, Forces)> {
        let mut law = Law::new(self, touches);
        let guess = law.gathered(guess);
        let weights = [1.0 / search.creep.sqrt(), 1e2, 1.0];
        let near = weights.into_iter().find_map(|weight| law.at(search.creep, weight).solved(&guess));
        let found = near.or_else(|| law.stiffened(search.creep)).or_else(|| law.searched(search))?;
        Some((law.choice(&found), law.spread(&found)))
    }
}

impl<'a> Law<'a> {
    fn new(problem: &'a ContactProblem, touches: &'a [Touch; MOST_PALMS]) -> Self {
        let touching = (0..problem.contacts().len()).filter(|&i| touches[i] != Touch::Apart).collect();
        let mut law = Self {
            problem,
            touches,
            touching,
            response: [[0.0; N]; N],
            free: [0.0; N],
            rigid: [0.0; N],
            scale: problem.force_scale(),
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

    fn gathered(&self, all: &Forces) -> Unknowns {
        let mut r = [0.0; N];
        for (k, &i) in self.touching.iter().enumerate() {
            r[3 * k..3 * k + 3].copy_from_slice(&all[i]);
        }
        r
    }

    fn spread(&self, r: &Unknowns) -> Forces {
        let mut all = [[0.0; 3]; MOST_PALMS];
        for (k, &i) in self.touching.iter().enumerate() {
            all[i].copy_from_slice(&r[3 * k..3 * k + 3]);
        }
        all
    }

    /// Lets every contact give way by this share of its own response, with another weight of velocities.
    fn at(&mut self, share: f64, weight: f64) -> &Self {
        self.weight = weight;
        for (k, &i) in self.touching.iter().enumerate() {
            for c in 3 * k..3 * k + 3 {
                self.response[c][c] = self.rigid[c] + share * self.problem.own_response(i);
            }
        }
        self
    }

    /// The solution followed from contacts that give way as much as the body does down to those that creep.
    fn stiffened(&mut self, creep: f64) -> Option<Unknowns> {
        let (mut r, mut share, mut factor) = ([0.0; N], 1.0, 0.1);
        let mut reached = None;
        loop {
            match (self.at(share, 1.0 / share.sqrt()).solved(&r), reached) {
                (Some(found), _) if share <= creep => return Some(found),
                (Some(found), _) => {
                    (r, reached) = (found, Some(share));
                    factor = f64::max(factor * factor, 0.1);
                }
                (None, Some(_)) if factor < STUCK => factor = factor.sqrt(),
                (None, _) => return None,
            }
            share = (reached? * factor).max(creep);
        }
    }

    /// The solution from some start of many.
    fn searched(&mut self, search: Search) -> Option<Unknowns> {
        (0..search.starts).find_map(|start| {
            let place = |k: usize| (f64::from(start + 1) * IRRATIONAL[k % 3] * (k + 1) as f64).fract();
            let mut r = [0.0; N];
            for (k, &i) in self.touching.iter().enumerate() {
                // Twice what stops the contact alone is the most.
                let normal = -2.0 * place(3 * k) * self.free[3 * k] / self.problem.own_response(i);
                let share = self.problem.contacts()[i].friction * place(3 * k + 1).sqrt() * normal;
                let tangent = share * DVec2::from_angle(TAU * place(3 * k + 2));
                (r[3 * k], r[3 * k + 1], r[3 * k + 2]) = (normal, tangent.x, tangent.y);
            }
            self.at(search.creep, WEIGHTS[start as usize % WEIGHTS.len()]).solved(&r)
        })
    }

    /// Newton's method with halved steps where a whole one does not help.
    fn solved(&self, guess: &Unknowns) -> Option<Unknowns> {
        let mut r = *guess;
        let mut f = self.residual(&r);
        for _ in 0..STEPS {
            if largest(&f) <= FULFILLED * self.scale {
                return Some(r);
            }
            let step = self.step(&r, &f)?;
            let mut share = 1.0;
            let mut best: Option<(f64, Unknowns, Unknowns)> = None;
            for _ in 0..HALVINGS {
                let next: Unknowns = std::array::from_fn(|k| r[k] + share * step[k]);
                let left = self.residual(&next);
                let size = squares(&left);
                if best.is_none_or(|(least, ..)| size < least) {
                    best = Some((size, next, left));
                }
                if size < (1.0 - 0.2 * share) * squares(&f) {
                    break;
                }
                share *= 0.5;
            }
            let (_, next, left) = best?;
            (r, f) = (next, left);
        }
        None
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
    fn residual(&self, r: &Unknowns) -> Unknowns {
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
    fn step(&self, r: &Unknowns, f: &Unknowns) -> Option<Unknowns> {
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
    fn choice(&self, r: &Unknowns) -> Choice {
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

fn largest(f: &Unknowns) -> f64 {
    // Not `max`, which leaves out what is no number.
    f.iter().fold(0.0_f64, |m, v| if v.abs() <= m { m } else { v.abs() })
}

fn squares(f: &Unknowns) -> f64 {
    f.iter().map(|v| v * v).sum()
}

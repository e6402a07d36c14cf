//! Coulomb's law at all contacts together, without a choice of modes: velocities after impulses.

use super::MOST_PALMS;
use super::choose::Choice;
use super::problem::{ContactProblem, Directions, Modes};
use super::solve::Dense;
use crate::ContactMode;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Newton's steps from one start, and halvings of one of them.
const STEPS: u32 = 30;
const HALVINGS: u32 = 12;
/// Impulses within this share of the largest fulfil the law: what rounding leaves of a step over contacts that creep.
const FULFILLED: f64 = 1e-10;
/// Starts spread over the cones that are tried where nothing else leads to a solution; one in a hundred or more does.
const SPREAD: u32 = 1000;

/// Impulse of each contact: normal part and two tangential ones, N s.
pub(crate) type Impulses = [[f64; 3]; MOST_PALMS];

/// The law as equations `F(r) = 0`, one triple a contact, and where they are looked at.
struct Law<'a> {
    problem: &'a ContactProblem,
    touching: &'a [usize],
    /// What a unit of impulse in each of the axes of a contact does to the velocities in those of the others.
    response: [[f64; 3 * MOST_PALMS]; 3 * MOST_PALMS],
    free: [f64; 3 * MOST_PALMS],
    scale: f64,
    /// Diagonal of the response without giving way.
    rigid: [f64; 3 * MOST_PALMS],
    /// How much a velocity weighs against an impulse, in units of the contact's own response.
    weight: f64,
}

impl ContactProblem {
    /// Impulses and final velocities of the contacts `touching` (of a problem of motion, [`Self::of_motion`]): each contact
    /// sticks with its impulse in the cone, slides with it against its final slip, or leaves without one.
    ///
    /// Newton's method on the equations of Alart and Curnier (1991), `r = P(r - rho u)` with the projection onto the cone's
    /// section at `r_n - rho u_n`, begun at `guesses` one after the other until one leads to a solution.
    pub(crate) fn coulomb(
        &self,
        touching: &[bool; MOST_PALMS],
        guess: &Impulses,
        creep: f64,
    ) -> Option<(Choice, Impulses)> {
        let touching: Vec<usize> = (0..self.contacts().len()).filter(|&i| touching[i]).collect();
        let mut law = Law::new(self, &touching);
        let guess = law.gathered(guess);
        let weights = [1.0 / creep.sqrt(), 1e2, 1.0];
        let found = weights.into_iter().find_map(|weight| law.at(creep, weight).solved(&guess));
        let found = found.or_else(|| law.stiffened(creep)).or_else(|| law.searched(creep));
        if found.is_none() && std::env::var_os("CRAWLDUMP").is_some() {
            let n = law.size();
            eprintln!("DUMP n {n} mu {:?}", touching.iter().map(|&i| self.contacts()[i].friction).collect::<Vec<_>>());
            for r in 0..n { law.response[r][r] = law.rigid[r]; eprintln!("DUMP W {:?}", &law.response[r][..n]); }
            eprintln!("DUMP b {:?}", &law.free[..n]);
            eprintln!("DUMP g {:?}", &guess[..n]);
        }
        let found = found?;
        Some((law.choice(&found), law.spread(&found)))
    }
}

/// Which branch of the projection a contact is on.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Branch {
    Apart,
    Sticks,
    Slides { tau: DVec2, length: f64, radius: f64 },
}

/// Square roots of primes: no two of them have a rational ratio.
const IRRATIONAL: [f64; 3] = [std::f64::consts::SQRT_2, 1.732_050_807_568_877_2, 2.236_067_977_499_79];

type Unknowns = [f64; 3 * MOST_PALMS];

impl<'a> Law<'a> {
    fn new(problem: &'a ContactProblem, touching: &'a [usize]) -> Self {
        let axes = |i: usize| {
            let contact = &problem.contacts()[i];
            [contact.n, contact.t[0], contact.t[1]]
        };
        let mut law = Self {
            problem,
            touching,
            response: [[0.0; 3 * MOST_PALMS]; 3 * MOST_PALMS],
            free: [0.0; 3 * MOST_PALMS],
            scale: problem.force_scale(),
            rigid: [0.0; 3 * MOST_PALMS],
            weight: 1.0,
        };
        for (k, &j) in touching.iter().enumerate() {
            for (c, axis) in axes(j).into_iter().enumerate() {
                law.free[3 * k + c] = axis.dot(problem.contacts()[j].free);
                for (l, &i) in touching.iter().enumerate() {
                    let moved = problem.moved_by(i, j, axis);
                    for (r, row) in axes(i).into_iter().enumerate() {
                        law.response[3 * l + r][3 * k + c] = row.dot(moved);
                    }
                }
                law.rigid[3 * k + c] = law.response[3 * k + c][3 * k + c];
            }
        }
        law
    }

    fn rho(&self, i: usize) -> f64 {
        self.weight / self.problem.own_response(i)
    }

    fn size(&self) -> usize {
        3 * self.touching.len()
    }

    fn spread(&self, r: &Unknowns) -> Impulses {
        let mut all = [[0.0; 3]; MOST_PALMS];
        for (k, &i) in self.touching.iter().enumerate() {
            all[i].copy_from_slice(&r[3 * k..3 * k + 3]);
        }
        all
    }

    fn velocities(&self, r: &Unknowns) -> Unknowns {
        let n = self.size();
        let mut u = self.free;
        for (row, u) in self.response[..n].iter().zip(&mut u) {
            *u += row[..n].iter().zip(r).map(|(w, r)| w * r).sum::<f64>();
        }
        u
    }

    fn branch(&self, k: usize, r: &Unknowns, u: &Unknowns) -> Branch {
        let i = self.touching[k];
        let rho = self.rho(i);
        let y = |c: usize| r[3 * k + c] - rho * u[3 * k + c];
        if y(0) <= 0.0 {
            return Branch::Apart;
        }
        let (tangent, radius) = (DVec2::new(y(1), y(2)), self.problem.contacts()[i].friction * y(0));
        let length = tangent.length();
        if length <= radius && radius > 0.0 {
            Branch::Sticks
        } else {
            Branch::Slides { tau: tangent.try_normalize().unwrap_or(DVec2::X), length, radius }
        }
    }

    /// `F(r)`, in units of impulse.
    fn residual(&self, r: &Unknowns) -> Unknowns {
        let u = self.velocities(r);
        let mut f = [0.0; 3 * MOST_PALMS];
        for (k, &i) in self.touching.iter().enumerate() {
            let rho = self.rho(i);
            let at = 3 * k;
            match self.branch(k, r, &u) {
                Branch::Apart => f[at..at + 3].copy_from_slice(&r[at..at + 3]),
                Branch::Sticks => (at..at + 3).for_each(|c| f[c] = rho * u[c]),
                Branch::Slides { tau, radius, .. } => {
                    f[at] = rho * u[at];
                    f[at + 1] = r[at + 1] - radius * tau.x;
                    f[at + 2] = r[at + 2] - radius * tau.y;
                }
            }
        }
        f
    }

    /// Newton's step `-F'(r)^-1 F(r)`.
    fn step(&self, r: &Unknowns, f: &Unknowns) -> Option<Unknowns> {
        let (n, u) = (self.size(), self.velocities(r));
        let mut system = Dense::default();
        for (k, &i) in self.touching.iter().enumerate() {
            let contact = &self.problem.contacts()[i];
            let (at, rho) = (3 * k, self.rho(i));
            let branch = self.branch(k, r, &u);
            for c in 0..n {
                let unit = |row: usize| if c == row { 1.0 } else { 0.0 };
                let turned = |row: usize| rho * self.response[row][c];
                let column = match branch {
                    Branch::Apart => [unit(at), unit(at + 1), unit(at + 2)],
                    Branch::Sticks => [turned(at), turned(at + 1), turned(at + 2)],
                    Branch::Slides { tau, length, radius } => {
                        let y = [0, 1, 2].map(|row| unit(at + row) - turned(at + row));
                        let across = tau.perp().dot(DVec2::new(y[1], y[2]));
                        let share = if length > 0.0 { radius / length } else { 0.0 };
                        let d = contact.friction * y[0] * tau + share * across * tau.perp();
                        [turned(at), unit(at + 1) - d.x, unit(at + 2) - d.y]
                    }
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

    fn gathered(&self, all: &Impulses) -> Unknowns {
        let mut r = [0.0; 3 * MOST_PALMS];
        for (k, &i) in self.touching.iter().enumerate() {
            r[3 * k..3 * k + 3].copy_from_slice(&all[i]);
        }
        r
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

    /// The solution followed from contacts that give way as much as the body does down to rigid ones.
    fn stiffened(&mut self, creep: f64) -> Option<Unknowns> {
        let mut r = [0.0; 3 * MOST_PALMS];
        let (mut share, mut reached, mut factor) = (1.0, f64::NAN, 0.1);
        loop {
            match self.at(share, 1.0 / share.sqrt()).solved(&r) {
                Some(found) => {
                    (r, reached) = (found, share);
                    if share <= creep {
                        return Some(r);
                    }
                    factor = f64::max(factor * factor, 0.1);
                }
                None => {
                    factor = factor.sqrt();
                    if reached.is_nan() || factor > 0.95 {
                        return None;
                    }
                }
            }
            share = (reached * factor).max(creep);
        }
    }

    /// The solution from some start of many, spread over the cones.
    fn searched(&mut self, creep: f64) -> Option<Unknowns> {
        // Multiples of irrational numbers fill a cube evenly.
        let place = |start: u32, k: usize| (f64::from(start + 1) * IRRATIONAL[k % IRRATIONAL.len()] * (k + 1) as f64).fract();
        (0..SPREAD).find_map(|start| {
            let mut r = [0.0; 3 * MOST_PALMS];
            for (k, &i) in self.touching.iter().enumerate() {
                let contact = &self.problem.contacts()[i];
                let normal = -self.free[3 * k] / self.problem.own_response(i) * 2.0 * place(start, 3 * k);
                let share = contact.friction * place(start, 3 * k + 1).sqrt() * normal;
                let angle = TAU * place(start, 3 * k + 2);
                (r[3 * k], r[3 * k + 1], r[3 * k + 2]) = (normal, share * angle.cos(), share * angle.sin());
            }
            self.at(creep, [1e4, 1e3, 1e5, 1e2][start as usize % 4]).solved(&r)
        })
    }

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

    /// The modes, directions of slip and motion that impulses mean.
    fn choice(&self, r: &Unknowns) -> Choice {
        let u = self.velocities(r);
        let mut modes: Modes = [ContactMode::Off; MOST_PALMS];
        let mut directions: Directions = [DVec2::X; MOST_PALMS];
        let mut forces = [DVec3::ZERO; MOST_PALMS];
        for (k, &i) in self.touching.iter().enumerate() {
            let contact = &self.problem.contacts()[i];
            let (normal, tangent) = (r[3 * k], DVec2::new(r[3 * k + 1], r[3 * k + 2]));
            let (mode, tangent) = match self.branch(k, r, &u) {
                Branch::Apart => continue,
                Branch::Sticks => (ContactMode::Stick, tangent),
                Branch::Slides { tau, .. } => {
                    directions[i] = -tau;
                    (ContactMode::Slide, contact.friction * normal.max(0.0) * tau)
                }
            };
            modes[i] = mode;
            forces[i] = normal.max(0.0) * contact.n + contact.along_tangent(tangent);
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

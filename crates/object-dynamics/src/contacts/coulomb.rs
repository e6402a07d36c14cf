//! Forces that obey Coulomb's law at all contacts together: no list of modes, and one solution also where squeezes between
//! sticking contacts are free.

use super::MOST_PALMS;
use super::choose::{Choice, Touch};
use super::law::{Law, Unknowns};
use super::problem::ContactProblem;
use glam::DVec2;
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

impl Law<'_> {
    /// The solution followed from contacts that give way as much as the body does down to those that creep.
    fn stiffened(&mut self, creep: f64) -> Option<Unknowns> {
        let (mut r, mut share, mut factor) = ([0.0; 3 * MOST_PALMS], 1.0, 0.1);
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
            let mut r = [0.0; 3 * MOST_PALMS];
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
}

fn largest(f: &Unknowns) -> f64 {
    // Not `max`, which leaves out what is no number.
    f.iter().fold(0.0_f64, |m, v| if v.abs() <= m { m } else { v.abs() })
}

fn squares(f: &Unknowns) -> f64 {
    f.iter().map(|v| v * v).sum()
}

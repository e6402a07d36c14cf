//! The direction in which a contact starts to slide: part of the answer, and not that of the force that held it.

use super::MOST_PALMS;
use super::problem::{ContactProblem, Directions, Modes, Reaction};
use crate::integrate::find_root;
use glam::DVec2;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Angles at which the turning condition is looked at; between two of them it has one root at the most, as far as was seen.
const SCANNED: u32 = 48;
/// Rounds over several contacts that start together, and the change of direction (rad) at which they have settled.
const MOST_ROUNDS: u32 = 100;
const SETTLED: f64 = 1e-12;
/// Newton's steps beside a known direction; the derivative is a difference over this angle.
const NEWTON_STEPS: u32 = 12;
const DIFFERENCE: f64 = 1e-6;

impl ContactProblem {
    /// Directions in which the contacts `starting` begin to slide, with the forces then: `T slip' = gamma tau`, `gamma >= 0`.
    ///
    /// A scan of angles for the zeros of `tau x T slip'`, contact by contact until all agree. The fixed point
    /// `tau <- T slip' / |T slip'|` fails in 28 % of random cases. None where there is no such direction.
    pub(crate) fn starting_directions(
        &self,
        modes: &Modes,
        directions: &Directions,
        starting: &[usize],
        slack: f64,
    ) -> Option<(Directions, Reaction)> {
        let mut now = *directions;
        for _ in 0..MOST_ROUNDS {
            let mut change = 0.0_f64;
            for &i in starting {
                let found = self.one_direction(modes, &now, i, slack)?;
                change = change.max((found - now[i]).length());
                now[i] = found;
            }
            if change < SETTLED || starting.len() == 1 {
                return self.solve(modes, &now).ok().map(|reaction| (now, reaction));
            }
            if change < 0.1
                && let Some(settled) = self.directions_near(modes, &now, starting)
            {
                return Some(settled).filter(|(found, reaction)| {
                    starting.iter().all(|&i| self.starts_along(i, found[i], reaction, slack))
                });
            }
        }
        None
    }

    /// The same close to known directions, by Newton's method on all angles together: for the next instant.
    pub(crate) fn directions_near(
        &self,
        modes: &Modes,
        directions: &Directions,
        starting: &[usize],
    ) -> Option<(Directions, Reaction)> {
        let n = starting.len();
        let mut now = *directions;
        let turns = |now: &Directions| -> Option<(DVector<f64>, Reaction)> {
            let reaction = self.solve(modes, now).ok()?;
            let turn = |k: usize| {
                let i = starting[k];
                now[i].perp_dot(self.contacts()[i].in_tangent(self.slip_rate(i, &reaction)))
            };
            Some((DVector::from_fn(n, |k, _| turn(k)), reaction))
        };
        let turned = |now: &Directions, k: usize, angle: f64| {
            let mut next = *now;
            next[starting[k]] = DVec2::from_angle(angle).rotate(now[starting[k]]);
            next
        };
        for _ in 0..NEWTON_STEPS {
            let (value, reaction) = turns(&now)?;
            let mut slopes = DMatrix::zeros(n, n);
            for k in 0..n {
                let (moved, _) = turns(&turned(&now, k, DIFFERENCE))?;
                slopes.set_column(k, &((moved - &value) / DIFFERENCE));
            }
            let step = -slopes.lu().solve(&value)?;
            let size = step.amax();
            if size.is_nan() || size >= 0.5 {
                return None;
            }
            for k in 0..n {
                now = turned(&now, k, step[k]);
            }
            if size < SETTLED {
                return Some((now, reaction));
            }
        }
        // Rounding of the accelerations may leave more than the last digits of an angle.
        turns(&now).map(|(_, reaction)| (now, reaction))
    }

    fn starts_along(&self, i: usize, tau: DVec2, reaction: &Reaction, slack: f64) -> bool {
        let rate = self.contacts()[i].in_tangent(self.slip_rate(i, reaction));
        let pushes = reaction.forces[i].dot(self.contacts()[i].n) >= -slack;
        pushes && tau.dot(rate) >= -slack * self.own_response(i)
    }

    /// The direction of contact `i` with those of the others held; of several the one nearest to the present one.
    fn one_direction(&self, modes: &Modes, directions: &Directions, i: usize, slack: f64) -> Option<DVec2> {
        let state = |angle: f64| -> Option<(DVec2, Reaction)> {
            let mut all = *directions;
            all[i] = DVec2::from_angle(angle);
            self.solve(modes, &all).ok().map(|reaction| (all[i], reaction))
        };
        let turn = |angle: f64| {
            state(angle).map_or(f64::NAN, |(tau, reaction)| {
                tau.perp_dot(self.contacts()[i].in_tangent(self.slip_rate(i, &reaction)))
            })
        };
        let good = |angle: f64| {
            state(angle)
                .filter(|(tau, reaction)| self.starts_along(i, *tau, reaction, slack))
                .map(|(tau, _)| tau)
        };
        let first = directions[i].to_angle();
        let mut best: Option<DVec2> = None;
        let angle = |k: u32| first + TAU * (f64::from(k) + 0.5) / f64::from(SCANNED);
        let mut before = turn(angle(0));
        for k in 1..=SCANNED {
            let after = turn(angle(k));
            if (before <= 0.0) != (after <= 0.0)
                && let Some(tau) = find_root(turn, angle(k - 1), angle(k), 1e-15).ok().and_then(good)
                && best.is_none_or(|b| tau.dot(directions[i]) > b.dot(directions[i]))
            {
                best = Some(tau);
            }
            before = after;
        }
        best
    }
}

/// Directions of no contact in particular.
pub(crate) const NO_DIRECTIONS: Directions = [DVec2::X; MOST_PALMS];

//! The direction in which a contact starts to slide: part of the answer, and not that of the force that held it.

use super::problem::{ContactProblem, Directions, Modes, Reaction};
use crate::integrate::find_root;
use glam::DVec2;
use std::f64::consts::TAU;

/// Angles at which the turning condition is looked at; between two of them it has one root at the most, as far as was seen.
const SCANNED: u32 = 48;
/// Rounds over several contacts that start together, and the change of direction at which they have settled.
const MOST_ROUNDS: u32 = 100;
const SETTLED: f64 = 1e-12;

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
        for &i in starting {
            now[i] = self.first_guess(i);
        }
        for round in 0..MOST_ROUNDS {
            let mut change = 0.0_f64;
            for &i in starting {
                let found = self.one_direction(modes, &now, i, slack, round > 0)?;
                change = change.max((found - now[i]).length());
                now[i] = found;
            }
            if change < SETTLED || starting.len() == 1 {
                return self.solve(modes, &now).ok().map(|reaction| (now, reaction));
            }
        }
        None
    }

    /// Where the contact would slide without forces.
    fn first_guess(&self, i: usize) -> DVec2 {
        let contact = &self.contacts()[i];
        contact.in_tangent(contact.free).try_normalize().unwrap_or(DVec2::X)
    }

    /// The direction of contact `i` with those of the others held; of several the one nearest to the present one.
    fn one_direction(
        &self,
        modes: &Modes,
        directions: &Directions,
        i: usize,
        slack: f64,
        near: bool,
    ) -> Option<DVec2> {
        let state = |angle: f64| -> Option<(DVec2, DVec2, Reaction)> {
            let tau = DVec2::from_angle(angle);
            let mut all = *directions;
            all[i] = tau;
            let reaction = self.solve(modes, &all).ok()?;
            Some((tau, self.contacts()[i].in_tangent(self.slip_rate(i, &reaction)), reaction))
        };
        let turn = |angle: f64| state(angle).map_or(f64::NAN, |(tau, rate, _)| tau.perp_dot(rate));
        let good = |angle: f64| {
            let (tau, rate, reaction) = state(angle)?;
            let pushes = reaction.forces[i].dot(self.contacts()[i].n) >= -slack;
            (pushes && tau.dot(rate) >= -slack * self.own_response(i)).then_some(tau)
        };
        let first = directions[i].to_angle();
        if near {
            // In later rounds the direction hardly moves: look beside it before all around.
            let (a, b) = (first - 0.05, first + 0.05);
            if let Some(tau) = find_root(turn, a, b, 1e-15).ok().and_then(good) {
                return Some(tau);
            }
        }
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

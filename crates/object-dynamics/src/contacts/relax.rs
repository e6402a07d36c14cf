//! Forces of many contacts that rest and may start to slide together: contact by contact until all agree.

use super::MOST_PALMS;
use super::choose::Touch;
use super::problem::{ContactProblem, Directions, Modes, Reaction};
use crate::ContactMode;
use glam::{DVec2, DVec3};

/// Rounds over the contacts: they converge linearly, slowly where many stick.
const MOST_ROUNDS: u32 = 4_000;
/// Forces have settled when they change by less than this share a round.
const SETTLED: f64 = 1e-13;
/// Every so many rounds it is looked whether forces only drift, by changes that are the same to this share.
const LOOK: u32 = 40;
const STEADY: f64 = 1e-3;

impl ContactProblem {
    /// Modes, directions and forces at which every contact alone obeys Coulomb's law while the others push as they do.
    ///
    /// Block Gauss-Seidel with an exact solution of each contact's own problem. Where it settles slowly the modes and directions
    /// that it has reached are asked for now and then whether they hold already. None where it does not settle.
    pub(crate) fn relaxed(
        &self,
        touches: &[Touch; MOST_PALMS],
        force: f64,
        holds: impl Fn(&Modes, &Directions) -> bool,
    ) -> Option<(Modes, Directions)> {
        let mut forces = [DVec3::ZERO; MOST_PALMS];
        let mut modes: Modes = [ContactMode::Off; MOST_PALMS];
        let mut directions: Directions = [DVec2::X; MOST_PALMS];
        for (i, touch) in touches.iter().enumerate() {
            if let Touch::Slides(tau) = touch {
                directions[i] = *tau;
            }
        }
        let mut last_change = [DVec3::ZERO; MOST_PALMS];
        for round in 0..MOST_ROUNDS {
            let before = forces;
            for i in 0..self.contacts().len() {
                if touches[i] == Touch::Apart {
                    continue;
                }
                let mut others = forces;
                others[i] = DVec3::ZERO;
                let free = self.reaction(others);
                let alone = self.alone(i, &free);
                let (mode, tau, reaction) = alone.one_contact(touches[i], directions[i], force)?;
                (modes[i], directions[i], forces[i]) = (mode, tau, reaction.forces[0]);
            }
            let change: [DVec3; MOST_PALMS] = std::array::from_fn(|i| forces[i] - before[i]);
            if longest(&change) <= SETTLED * force {
                return Some((modes, directions));
            }
            if round % LOOK == LOOK - 1 {
                if holds(&modes, &directions) {
                    return Some((modes, directions));
                }
                let drift: [DVec3; MOST_PALMS] = std::array::from_fn(|i| change[i] - last_change[i]);
                if longest(&drift) < STEADY * longest(&change) {
                    self.squeeze(&modes, &mut forces, &change);
                }
            }
            last_change = change;
        }
        None
    }

    /// Palms that pull sticking contacts apart build up squeezes at a steady rate, round by round: goes on to where the first
    /// of them reaches the edge of its cone.
    fn squeeze(&self, modes: &Modes, forces: &mut [DVec3; MOST_PALMS], change: &[DVec3; MOST_PALMS]) {
        let mut rounds = f64::INFINITY;
        for (i, contact) in self.contacts().iter().enumerate() {
            if modes[i] != ContactMode::Stick {
                continue;
            }
            // |t + k dt|^2 = mu^2 (n + k dn)^2, the first k above zero.
            let (t, dt) = (contact.in_tangent(forces[i]), contact.in_tangent(change[i]));
            let (n, dn) = (contact.n.dot(forces[i]), contact.n.dot(change[i]));
            let square = contact.friction * contact.friction;
            let a = dt.length_squared() - square * dn * dn;
            let b = t.dot(dt) - square * n * dn;
            let c = (t.length_squared() - square * n * n).min(0.0);
            let root = (b * b - a * c).max(0.0).sqrt();
            // Both forms of the roots of a k^2 + 2 b k + c: none of them loses digits.
            for k in [(-b + root) / a, (-b - root) / a, c / (-b - root), c / (-b + root)] {
                if k > 0.0 && k < rounds {
                    rounds = k;
                }
            }
        }
        if rounds.is_finite() {
            for (force, change) in forces.iter_mut().zip(change) {
                *force += rounds * *change;
            }
        }
    }

    /// The problem of contact `i` while the others push as in `free`.
    fn alone(&self, i: usize, free: &Reaction) -> Self {
        let mut contact = self.contacts()[i];
        contact.free = self.slip_rate(i, free);
        Self::new(self.inverse_mass, self.K, [free.a, free.alpha], &[contact])
    }

    /// Coulomb's law at the only contact: leaves, sticks or slides.
    fn one_contact(&self, touch: Touch, tau: DVec2, force: f64) -> Option<(ContactMode, DVec2, Reaction)> {
        let contact = &self.contacts()[0];
        let mut modes: Modes = [ContactMode::Off; MOST_PALMS];
        let mut directions = [tau; MOST_PALMS];
        let off = self.solve(&modes, &directions).ok()?;
        if self.gap_acceleration(0, &off) >= 0.0 {
            return Some((ContactMode::Off, tau, off));
        }
        if touch == Touch::Rests && contact.friction > 0.0 {
            modes[0] = ContactMode::Stick;
            let held = self.solve(&modes, &directions).ok()?;
            if self.in_cones(&modes, &held, 0.0) {
                return Some((ContactMode::Stick, tau, held));
            }
        }
        modes[0] = ContactMode::Slide;
        if touch == Touch::Rests && contact.friction > 0.0 {
            let slack = 1e-12 * force;
            let beside = self.directions_near(&modes, &directions, &[0]).filter(|(found, reaction)| {
                let rate = contact.in_tangent(self.slip_rate(0, reaction));
                found[0].dot(rate) >= 0.0 && contact.n.dot(reaction.forces[0]) >= 0.0
            });
            let (found, reaction) =
                beside.or_else(|| self.starting_directions(&modes, &directions, &[0], slack))?;
            return Some((ContactMode::Slide, found[0], reaction));
        }
        directions[0] = tau;
        let reaction = self.solve(&modes, &directions).ok()?;
        // Painlevé's paradox at this contact alone: no push closes its gap.
        (contact.n.dot(reaction.forces[0]) >= 0.0).then_some((ContactMode::Slide, tau, reaction))
    }
}

fn longest(vectors: &[DVec3; MOST_PALMS]) -> f64 {
    vectors.iter().map(|v| v.length()).fold(0.0, f64::max)
}

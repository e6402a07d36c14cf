//! Motion while no contact changes its mode.

use super::error::{FieldError, PalmContactError};
use super::state::{BodyState, FRICTION_WORK, LENGTH, PALM_WORK, TIME, Vector, add_impulse};
use super::tracker::{Touch, Tracker};
use crate::planar::contacts::{ContactProblem, Correction, PlanarMode, Response};
use contact_kinematics::planar::{RadiusFunction, SurfaceRates};
use glam::DVec2;

/// Steps of the projection onto the contacts: it converges quadratically, from gaps that are a rounding of the path.
const PROJECTIONS: u32 = 4;

/// Modes of all palms, between two events.
pub(super) struct Phase<'a, S> {
    pub(super) tracker: &'a Tracker<'a, S>,
    pub(super) modes: Vec<PlanarMode>,
}

/// All that is known of the touching contacts at one instant.
pub(super) struct Reading {
    pub(super) touches: Vec<(Touch, SurfaceRates)>,
    /// Their modes.
    pub(super) modes: Vec<PlanarMode>,
    pub(super) problem: ContactProblem,
    pub(super) response: Response,
}

impl<S: RadiusFunction> Phase<'_, S> {
    /// Contacts that touch, with forces and accelerations.
    pub(super) fn reading(&self, t: f64, state: &BodyState) -> Result<Reading, FieldError> {
        let (mut touches, mut modes, mut contacts) = (Vec::new(), Vec::new(), Vec::new());
        for (palm, &mode) in self.modes.iter().enumerate() {
            if mode == PlanarMode::Off {
                continue;
            }
            let touch = self.tracker.touch(palm, t, state)?;
            let rates = touch.rates(state)?;
            let sense = if let PlanarMode::Slide { sense } = mode { sense } else { 0.0 };
            let biases = [rates.gap_bias, touch.contact.t.dot(rates.slip_bias)];
            contacts.push(touch.touching(biases, self.tracker.friction(palm), sense));
            touches.push((touch, rates));
            modes.push(mode);
        }
        let problem = ContactProblem::new(self.tracker.mass(), self.tracker.free_fall(), &contacts);
        let response = problem.respond(&modes)?;
        Ok(Reading { touches, modes, problem, response })
    }

    /// Rate of the integrated vector.
    pub(super) fn rate(&self, t: f64, y: &Vector) -> Result<Vector, FieldError> {
        let state = BodyState::of(y);
        let reading = self.reading(t, &state)?;
        let (a, v) = (reading.response.a_WCm, state.v_WCm);
        let mut rate = [0.0; LENGTH];
        let motion = BodyState { p_WCm: v, phi0: state.omega0, v_WCm: a, omega0: reading.response.alpha0 };
        motion.write(&mut rate);
        rate[TIME] = 1.0;
        for ((touch, rates), force) in reading.touches.iter().zip(reading.forces()) {
            add_impulse(&mut rate, touch.palm, force);
            rate[PALM_WORK] += force.dot(rates.surface_velocity);
            if self.modes[touch.palm] != PlanarMode::Stick {
                rate[FRICTION_WORK] += force.dot(touch.contact.t) * rates.slip.dot(touch.contact.t);
            }
        }
        Ok(rate)
    }

    /// Pulls the state onto the contacts: gaps zero, gap rates zero, slips of sticking contacts zero, by the least change in
    /// the metric of kinetic energy. A state that is there to rounding stays as it is. Returns the impulses of the change of
    /// velocity.
    pub(super) fn project(&self, y: &mut Vector) -> Result<Vec<(Touch, DVec2)>, FieldError> {
        let t = y[TIME];
        let mut state = BodyState::of(y);
        let gaps_alone: Vec<PlanarMode> = self
            .modes
            .iter()
            .map(|&mode| if mode == PlanarMode::Stick { PlanarMode::Slide { sense: 0.0 } } else { mode })
            .collect();
        for _ in 0..PROJECTIONS {
            let touches = self.touches(t, &state)?;
            if touches
                .iter()
                .all(|touch| touch.contact.gap.abs() <= self.tracker.gap_rounding(touch.palm, t, &state))
            {
                break;
            }
            let residual = |touch: &Touch| [touch.contact.gap, 0.0];
            let shift = self.correction(&touches, &gaps_alone, residual);
            state.p_WCm += shift.linear;
            state.phi0 += shift.angular;
        }
        let touches = self.touches(t, &state)?;
        let residual = |touch: &Touch| {
            let slip = touch.slip(&state);
            [touch.contact.n.dot(slip), touch.contact.t.dot(slip)]
        };
        let change = self.correction(&touches, &self.modes, residual);
        state.v_WCm += change.linear;
        state.omega0 += change.angular;
        state.write(y);
        let impulse = |(touch, [normal, along]): (Touch, [f64; 2])| {
            (touch, touch.contact.n * normal + touch.contact.t * along)
        };
        Ok(touches.into_iter().zip(change.impulses).map(impulse).collect())
    }

    fn touches(&self, t: f64, state: &BodyState) -> Result<Vec<Touch>, PalmContactError> {
        let touching = (0..self.modes.len()).filter(|&palm| self.modes[palm] != PlanarMode::Off);
        touching.map(|palm| self.tracker.touch(palm, t, state)).collect()
    }

    fn correction(
        &self,
        touches: &[Touch],
        modes: &[PlanarMode],
        residual: impl Fn(&Touch) -> [f64; 2],
    ) -> Correction {
        let contacts: Vec<_> = touches.iter().map(|touch| touch.touching([0.0; 2], 0.0, 0.0)).collect();
        let modes: Vec<_> = touches.iter().map(|touch| modes[touch.palm]).collect();
        let residuals: Vec<_> = touches.iter().map(residual).collect();
        ContactProblem::new(self.tracker.mass(), (DVec2::ZERO, 0.0), &contacts).correction(&modes, &residuals)
    }
}

impl Reading {
    pub(super) fn smallest_minor(&self) -> f64 {
        self.problem.smallest_minor(&self.modes, &self.response)
    }

    /// Forces of the touching palms on the body, world, N.
    pub(super) fn forces(&self) -> impl Iterator<Item = DVec2> {
        let parts = self.touches.iter().zip(&self.response.forces);
        parts.map(|((touch, _), [normal, along])| touch.contact.n * *normal + touch.contact.t * *along)
    }
}

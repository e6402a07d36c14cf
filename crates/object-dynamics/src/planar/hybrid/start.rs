//! States that a run can start from.

use super::error::{ContactSimulationError, StartError};
use super::state::BodyState;
use super::tracker::{Touch, Tracker};
use crate::planar::contacts::{ContactProblem, ContactScene, Correction, PlanarMode};
use contact_kinematics::planar::{PalmSurface, RadiusFunction, SurfaceState};
use glam::DVec2;

/// Share of the body's size, or of its natural speed, to which a start must touch.
const TOUCHING: f64 = 1e-9;
/// Steps by which a body is placed on palms; Newton's method takes about five from nearby.
const PLACING: u32 = 60;
/// Longest of them, as a share of the body's size.
const LONGEST: f64 = 0.25;

/// Where a run starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactStart {
    /// The body.
    pub body: BodyState,
    /// Palms (from 0) that the body touches; it may touch others, or fly into them.
    pub contacts: Vec<usize>,
}

impl<S: RadiusFunction> ContactScene<S> {
    /// The state nearest to `guess` in which the body touches `palms` (from 0) at time `t` (s), and moves along them:
    /// nearest in the metric of kinetic energy.
    ///
    /// # Errors
    /// [`StartError::NoRoom`] where there is none nearby, or another palm is in the way; [`StartError::NoPalm`] and
    /// [`StartError::NotFinite`].
    pub fn place(&self, t: f64, guess: BodyState, palms: &[usize]) -> Result<BodyState, StartError> {
        let tracker = Tracker::new(self);
        tracker.check(&guess, palms)?;
        let mut state = guess;
        for _ in 0..PLACING {
            let touches = tracker.touches(t, &state, palms)?;
            if touches
                .iter()
                .all(|touch| touch.contact.gap.abs() <= tracker.gap_rounding(touch.palm, t, &state))
            {
                break;
            }
            let shift = tracker.normal_correction(&touches, |touch| touch.contact.gap);
            let length = shift.linear.length().max(shift.angular.abs() * tracker.size);
            let share = (LONGEST * tracker.size / length).min(1.0);
            state.p_WCm += shift.linear * share;
            state.phi0 += shift.angular * share;
        }
        for palm in 0..self.palms().len() {
            let gap = tracker.gap(palm, t, &state).map_or(f64::NAN, |[gap, _]| gap);
            let asked = palms.contains(&palm);
            let free = gap >= -TOUCHING * tracker.size && (!asked || gap <= TOUCHING * tracker.size);
            if !free {
                return Err(StartError::NoRoom { palm: palm + 1, gap });
            }
        }
        let touches = tracker.touches(t, &state, palms)?;
        let rate = |touch: &Touch| touch.contact.n.dot(touch.slip(&state));
        let change = tracker.normal_correction(&touches, rate);
        let (v_WCm, omega0) = (state.v_WCm + change.linear, state.omega0 + change.angular);
        Ok(BodyState { v_WCm, omega0, ..state })
    }
}

impl<S: RadiusFunction> Tracker<'_, S> {
    /// Refuses palms that overlap each other at time `t`. Lines are taken to end where others begin.
    pub(super) fn check_overlap(&self, t: f64) -> Result<(), ContactSimulationError> {
        let palms: Vec<_> = self.scene.palms().iter().map(|palm| (palm.surface, palm.motion.at(t))).collect();
        for (second, b) in palms.iter().enumerate() {
            for (first, a) in palms[..second].iter().enumerate() {
                if let Some(kind) = coincide(a, b, TOUCHING * self.size) {
                    let (first, second) = (first + 1, second + 1);
                    return Err(ContactSimulationError::PalmsCoincide { first, second, kind });
                }
                let depth = -distance(a, b).min(distance(b, a));
                if depth > TOUCHING * self.size {
                    let (first, second) = (first + 1, second + 1);
                    return Err(ContactSimulationError::PalmsOverlap { first, second, depth });
                }
            }
        }
        Ok(())
    }

    /// Refuses a start that is not in contact as it says.
    pub(super) fn check_start(&self, t: f64, start: &ContactStart) -> Result<(), StartError> {
        let state = &start.body;
        self.check(state, &start.contacts)?;
        for palm in 0..self.scene.palms().len() {
            let number = palm + 1;
            let lost = |_| StartError::NoRoom { palm: number, gap: f64::NAN };
            let [gap, rate] = self.gap(palm, t, state).map_err(lost)?;
            if gap < -TOUCHING * self.size {
                return Err(StartError::Penetration { palm: number, gap });
            }
            if !start.contacts.contains(&palm) {
                continue;
            }
            if gap > TOUCHING * self.size {
                return Err(StartError::NotInContact { palm: number, gap });
            }
            if rate.abs() > TOUCHING * self.speed(state) {
                return Err(StartError::NotAlong { palm: number, rate });
            }
        }
        Ok(())
    }

    fn check(&self, state: &BodyState, palms: &[usize]) -> Result<(), StartError> {
        if !state.is_finite() {
            return Err(StartError::NotFinite);
        }
        let count = self.scene.palms().len();
        match palms.iter().find(|&&palm| palm >= count) {
            Some(palm) => Err(StartError::NoPalm { palm: palm + 1, count }),
            None => Ok(()),
        }
    }

    fn touches(&self, t: f64, state: &BodyState, palms: &[usize]) -> Result<Vec<Touch>, StartError> {
        let lost = |palm: usize| StartError::NoRoom { palm: palm + 1, gap: f64::NAN };
        palms.iter().map(|&palm| self.touch(palm, t, state).map_err(|_| lost(palm))).collect()
    }

    fn normal_correction(&self, touches: &[Touch], residual: impl Fn(&Touch) -> f64) -> Correction {
        let contacts: Vec<_> = touches.iter().map(|touch| touch.touching([0.0; 2], 0.0, 0.0)).collect();
        let residuals: Vec<_> = touches.iter().map(|touch| [residual(touch), 0.0]).collect();
        let modes = vec![PlanarMode::Slide { sense: 0.0 }; touches.len()];
        ContactProblem::new(self.mass(), (DVec2::ZERO, 0.0), &contacts).correction(&modes, &residuals)
    }
}

/// What two lines or cups are that are one to within `near` (m): the object would touch both at the same point, and nothing says
/// which bears it.
fn coincide(
    (a, at): &(PalmSurface, SurfaceState),
    (b, bt): &(PalmSurface, SurfaceState),
    near: f64,
) -> Option<&'static str> {
    let between = bt.p_WP - at.p_WP;
    match (*a, *b) {
        (PalmSurface::Line, PalmSurface::Line) => {
            let (sine, cosine) = (bt.angle - at.angle).sin_cos();
            let same = sine.abs() <= TOUCHING && cosine > 0.0 && at.to_palm(bt.p_WP).y.abs() <= near;
            same.then_some("line")
        }
        (PalmSurface::Cup { radius: r }, PalmSurface::Cup { radius: s }) => {
            (between.length() + (r - s).abs() <= near).then_some("cup")
        }
        _ => None,
    }
}

/// Distance of two palms, in the order in which one kind is treated; infinite for the other order and where none is
/// defined.
fn distance((a, at): &(PalmSurface, SurfaceState), (b, bt): &(PalmSurface, SurfaceState)) -> f64 {
    let between = bt.p_WP - at.p_WP;
    match (*a, *b) {
        (PalmSurface::Arc { radius: r }, PalmSurface::Arc { radius: s }) => between.length() - r - s,
        (PalmSurface::Line, PalmSurface::Arc { radius }) => at.to_palm(bt.p_WP).y - radius,
        (PalmSurface::Cup { radius: r }, PalmSurface::Arc { radius: s }) => r - between.length() - s,
        _ => f64::INFINITY,
    }
}

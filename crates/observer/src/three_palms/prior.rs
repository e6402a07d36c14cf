//! What is known of any body that palms hold before its log is looked at: that it is about as large as the space between
//! them, and moves about as fast as gravity makes it.
//!
//! Where the data determine the motion this says nothing: a number known to a share `d` of its natural size is drawn by `d^2` of
//! its distance from expectation. Where they leave a direction open it keeps the motion within what can be, so that the
//! numbers that the data do determine are found beside it, and what is left open gets a deviation that is honest.

use super::cold_start::{natural_time, rest_state};
use super::momentum::{Scales, StartState};
use super::state_space::{Constant, MOTION_STATES, Parameters, ThreePalmModel};
use super::track::Track;
use super::unknown_body::{ball, mass_of_weight};
use crate::core::{Model, Start};
use glam::DVec3;
use nalgebra::SVector;

/// Deviation of centre of mass, velocity, angular momentum, and of a body's mass and inertia, in natural sizes.
const BROAD: f64 = 1.0;
/// Deviation of the orientation at the start where a choice of body axes, and no measurement, fixes it: in relative
/// contact noise, so that it is small against what is measured and yet lets sums of both keep their digits.
const CHOSEN: f64 = 0.1;
/// Deviation of a constant that is known, in natural sizes and relative contact noise: likewise.
const KNOWN: f64 = 0.01;
/// Place of the orientation among the states, after position, velocity and angular momentum.
const ORIENTATION: usize = 9;

/// What a [`Start`] is made from.
pub(super) struct Beforehand<'a> {
    pub(super) track: &'a Track,
    pub(super) scales: Scales,
    /// Constants among the states, and deviations of those that are measured beforehand.
    pub(super) constants: &'a [Constant],
    pub(super) deviations: &'a [f64],
    /// Whether the body axes are chosen, so that the orientation at the start is.
    pub(super) axes_chosen: bool,
}

impl Beforehand<'_> {
    /// The prior of a motion that is looked for near a state: of its orientation nothing is known.
    pub(super) fn prior<const N: usize>(
        &self,
        model: &ThreePalmModel<N>,
        near: &SVector<f64, N>,
        parameters: &Parameters,
    ) -> Start<N> {
        let Self { track, scales, constants, deviations, axes_chosen } = self;
        let rest = rest_state(track, natural_time(track, scales.length));
        let R_WO = model.motion(near).R_WO;
        let mut parameters = *parameters;
        // Of a body of which nothing is known: a ball of the weight that the palms carry.
        let ball = mass_of_weight(track).and_then(|mass| ball(mass, scales.length));
        if let (true, Some(ball)) = (constants.contains(&Constant::LogMass), ball) {
            parameters = Parameters::new(&ball);
        }
        let expected = StartState { R_WO, L_WO: DVec3::ZERO, ..rest };
        let mut prior = Start::guess(model.state(&expected, &parameters));
        let sizes = model.scales();
        let mut know = |state: usize, deviation: f64| prior.information[(state, state)] = deviation.powi(-2);
        (0..ORIENTATION).for_each(|state| know(state, BROAD * sizes[state]));
        if *axes_chosen {
            (ORIENTATION..MOTION_STATES).for_each(|state| know(state, CHOSEN * model.relative_noise()));
        }
        let least = KNOWN * model.relative_noise();
        for (k, constant) in constants.iter().enumerate() {
            let state = MOTION_STATES + k;
            match constant {
                Constant::LogMass | Constant::Inertia(_) => know(state, BROAD * sizes[state]),
                _ => {
                    if let Some(deviation) = deviations.get(k) {
                        know(state, deviation.max(least * sizes[state]));
                    }
                }
            }
        }
        prior
    }
}

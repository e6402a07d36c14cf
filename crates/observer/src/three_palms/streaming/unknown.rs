//! A body of unknown mass and inertia: 12 states of the motion and 7 constants, and the search for them.
//!
//! The body axes are the world's at the first node: three of the 19 numbers are a choice, and are held.

use super::kind::{Gathered, Kind};
use super::search::Trial;
use crate::core::Start;
use crate::three_palms::cold_start::{self, Round, natural_time};
use crate::three_palms::covariance::NoiseLevel;
use crate::three_palms::momentum::Scales;
use crate::three_palms::state_space::{BODY, MOTION_STATES, Parameters, ThreePalmModel};
use crate::three_palms::track::Track;
use crate::three_palms::unknown_body::{
    BODY_UNKNOWNS, BodyPoint, BodyProblem, STATES, begin, mass_of_weight, scales_of_ball, spins,
};
use glam::DVec3;
use object_dynamics::MassProperties;

/// Unknowns of the search before those of mass and inertia: the orientation is none of them.
const MOTION_UNKNOWNS: usize = BODY_UNKNOWNS - BODY.len();
/// Shortest track that body and motion are taken from, in natural times: the inertia shows itself late.
const SHORTEST: f64 = 5.0;
/// Heights of the centre of mass that are tried, as shares of the one that static balance suggests.
const HEIGHTS: [f64; 3] = [1.0, 0.8, 1.2];
/// Angular velocity that is tried about each axis in both senses, in natural units.
const SPIN: f64 = 0.5;
/// Deviation to which the choice of body axes is held, rad.
const HELD: f64 = 1e-4;

/// A body of which nothing is known.
pub(super) struct Unknown {
    pub(super) noise: NoiseLevel,
    pub(super) gravity: DVec3,
}

impl Kind<STATES, BODY_UNKNOWNS> for Unknown {
    type Point = BodyPoint;
    type Trial<'a> = UnknownTrial<'a>;

    fn nominal_mass(&self) -> f64 {
        1.0
    }

    fn scales(&self, track: &Track) -> Scales {
        let of_weight = mass_of_weight(track).and_then(|mass| scales_of_ball(&track.of_mass(mass)));
        of_weight.unwrap_or_else(|| {
            // Before there is a weight: a ball of a kilogram.
            let ball = MassProperties::uniform_ellipsoid(1.0, DVec3::ONE);
            ball.map_or(Scales { length: 1.0, velocity: 1.0, momentum: 1.0 }, |b| {
                cold_start::scales(track, &b)
            })
        })
    }

    fn trial<'a>(&'a self, data: &'a Gathered, scales: Scales) -> UnknownTrial<'a> {
        UnknownTrial { data, scales }
    }

    fn begin(&self, found: &BodyPoint, scales: Scales) -> Option<(ThreePalmModel<STATES>, Start<STATES>)> {
        let parameters = Parameters::new(&found.mass()?);
        let model = ThreePalmModel::new(parameters, &BODY, self.gravity, self.noise, scales)?;
        let mut start = Start::guess(model.state(&found.start, &parameters));
        for axis in MOTION_UNKNOWNS..MOTION_STATES {
            start.information[(axis, axis)] = 1.0 / (HELD * HELD);
        }
        Some((model, start))
    }
}

/// Body and motion on the data so far.
pub(super) struct UnknownTrial<'a> {
    data: &'a Gathered,
    scales: Scales,
}

impl Trial<BODY_UNKNOWNS> for UnknownTrial<'_> {
    type Point = BodyPoint;
    type Problem<'b>
        = BodyProblem<'b>
    where
        Self: 'b;

    fn natural_time(&self) -> f64 {
        natural_time(&self.data.track, self.scales.length)
    }

    fn duration(&self) -> f64 {
        self.data.track.duration()
    }

    fn shortest(&self) -> f64 {
        SHORTEST
    }

    fn starts(&self, _round: Round, window: f64) -> Vec<BodyPoint> {
        let Some(mass) = mass_of_weight(&self.data.track) else { return Vec::new() };
        let track = self.data.track.of_mass(mass);
        let rate = SPIN * self.scales.velocity / self.scales.length;
        let mut all = Vec::new();
        for rate in [rate, 0.0] {
            for height in HEIGHTS {
                let turns = spins(rate).into_iter();
                all.extend(turns.map(|w_WO| begin(&track, self.scales, window, height, w_WO)));
            }
        }
        all
    }

    fn problem(&self, window: f64) -> BodyProblem<'_> {
        BodyProblem::new(&self.data.track, self.scales, window)
    }
}

//! A body of known mass and inertia: its 12 states, and the search for its motion.

use super::kind::{Gathered, Kind};
use super::search::Trial;
use crate::core::Start;
use crate::three_palms::cold_start::{self, Round, Search, natural_time, sampling};
use crate::three_palms::covariance::NoiseLevel;
use crate::three_palms::momentum::{MomentumProblem, Scales, StartState, UNKNOWNS};
use crate::three_palms::state_space::{Parameters, ThreePalmModel};
use crate::three_palms::track::Track;
use glam::DVec3;
use object_dynamics::MassProperties;

/// Shortest track that a motion is taken from, in natural times: wrong motions have explained three of them.
const SHORTEST: f64 = 5.0;

/// A known body.
pub(super) struct Known {
    pub(super) mass: MassProperties,
    pub(super) noise: NoiseLevel,
    pub(super) gravity: DVec3,
}

impl Kind<UNKNOWNS, UNKNOWNS> for Known {
    type Point = StartState;
    type Trial<'a> = KnownTrial<'a>;

    fn nominal_mass(&self) -> f64 {
        self.mass.mass()
    }

    fn scales(&self, track: &Track) -> Scales {
        cold_start::scales(track, &self.mass)
    }

    fn trial<'a>(&'a self, data: &'a Gathered, scales: Scales) -> KnownTrial<'a> {
        let (noise, mass) = (self.noise, &self.mass);
        KnownTrial {
            search: Search { track: &data.track, mass, scales, noise, sampling: sampling(data.stride) },
        }
    }

    fn begin(
        &self,
        found: &StartState,
        scales: Scales,
    ) -> Option<(ThreePalmModel<UNKNOWNS>, Start<UNKNOWNS>)> {
        let parameters = Parameters::new(&self.mass);
        let model = ThreePalmModel::new(parameters, &[], self.gravity, self.noise, scales)?;
        let start = Start::guess(model.state(found, &parameters));
        Some((model, start))
    }
}

/// The motion of a known body on the track so far.
pub(super) struct KnownTrial<'a> {
    search: Search<'a>,
}

impl Trial<UNKNOWNS> for KnownTrial<'_> {
    type Point = StartState;
    type Problem<'b>
        = MomentumProblem<'b>
    where
        Self: 'b;

    fn natural_time(&self) -> f64 {
        natural_time(self.search.track, self.search.scales.length)
    }

    fn duration(&self) -> f64 {
        self.search.track.duration()
    }

    fn shortest(&self) -> f64 {
        SHORTEST
    }

    fn starts(&self, round: Round, window: f64) -> Vec<StartState> {
        self.search.starts(window, round)
    }

    fn problem(&self, window: f64) -> MomentumProblem<'_> {
        self.search.problem(window)
    }
}

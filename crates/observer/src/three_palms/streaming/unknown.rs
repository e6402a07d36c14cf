//! A body of unknown mass and inertia: 12 states of the motion and 7 constants, and the search for them.
//!
//! The body axes are the world's at the first node: three of the 19 numbers are a choice, and are held.

use super::kind::{Gathered, Kind};
use super::known::sampling;
use super::search::{Trial, Verdict};
use super::tracker::{Tracker, loose_information, sample};
use crate::core::{ExtendedKalmanFilter, Model, Start};
use crate::least_squares::{Fit, LeastSquares, NormalEquations};
use crate::three_palms::cold_start::{EXPLAINED, Round, Search, natural_time, scales};
use crate::three_palms::covariance::NoiseLevel;
use crate::three_palms::momentum::{Scales, StartState};
use crate::three_palms::state_space::{BODY, MOTION_STATES, NodeInput, Parameters, ThreePalmModel};
use crate::three_palms::track::Track;
use glam::{DQuat, DVec3};
use nalgebra::{SMatrix, SVector};
use object_dynamics::MassProperties;
use std::collections::VecDeque;

/// States of the motion, mass and inertia.
pub(super) const STATES: usize = MOTION_STATES + BODY.len();
/// Shortest track that body and motion are taken from, in natural times: the inertia shows itself late.
const SHORTEST: f64 = 5.0;
/// Heights of the centre of mass that are tried, as shares of the one that static balance suggests.
const HEIGHTS: [f64; 3] = [1.0, 0.8, 1.2];
/// Angular velocity that is tried about each axis in both senses, in natural units.
const SPIN: f64 = 0.5;
/// Deviation to which the choice of body axes is held, rad.
const HELD: f64 = 1e-4;

/// Standard deviation of the worst known state, in natural sizes, with which a motion is taken.
const LARGEST_DEVIATION: f64 = 0.03;
/// Nodes after which innovations are looked at.
const CHECKED: usize = 30;

type State = SVector<f64, STATES>;

/// A body of which nothing is known.
pub(super) struct Unknown {
    pub(super) noise: NoiseLevel,
    pub(super) gravity: DVec3,
}

/// A uniform ball of the scene's size that weighs what the palms carry in the mean over the first nodes.
fn ball(track: &Track, gravity: DVec3, nodes: usize) -> Option<MassProperties> {
    let used = &track.nodes[..nodes.clamp(1, track.nodes.len())];
    let force = used.iter().flat_map(|n| (0..3).map(|i| n.forces[i] * n.palms[i].frame.n)).sum::<DVec3>();
    let mass = force.length() / used.len() as f64 / gravity.length();
    let mean = used[0].p_WC.iter().sum::<DVec3>() / 3.0;
    let radius = used[0].p_WC.iter().map(|c| c.distance(mean)).sum::<f64>() / 3.0;
    MassProperties::uniform_ellipsoid(mass, DVec3::splat(radius)).ok()
}

impl Kind<STATES> for Unknown {
    type Point = State;
    type Trial<'a> = UnknownTrial<'a>;

    fn nominal_mass(&self) -> f64 {
        1.0
    }

    fn scales(&self, track: &Track) -> Scales {
        match ball(track, self.gravity, track.nodes.len()) {
            Some(ball) => scales(track, &ball),
            None => Scales { length: 1.0, velocity: 1.0, momentum: 1.0 },
        }
    }

    fn trial<'a>(&'a self, data: &'a Gathered, scales: Scales) -> UnknownTrial<'a> {
        UnknownTrial { kind: self, data, scales }
    }

    fn tracker(&self, found: &Fit<State, STATES>, scales: Scales) -> Option<Tracker<STATES>> {
        let model = self.model(scales, self.noise)?;
        let start = believed(found, &model);
        Tracker::new(model, start).ok()
    }
}

impl Unknown {
    fn model(&self, scales: Scales, noise: NoiseLevel) -> Option<ThreePalmModel<STATES>> {
        // All of the base's constants are states.
        let base = Parameters::new(&MassProperties::uniform_ellipsoid(1.0, DVec3::ONE).ok()?);
        ThreePalmModel::new(base, &BODY, self.gravity, noise, scales)
    }
}

/// What a fit says, loosely, with the choice of body axes held.
fn believed(fit: &Fit<State, STATES>, model: &ThreePalmModel<STATES>) -> Start<STATES> {
    let mut information = loose_information(fit, &model.scales());
    for axis in 9..12 {
        information[(axis, axis)] = 1.0 / (HELD * HELD);
    }
    Start { state: fit.point, information }
}

/// Body and motion on the data so far.
pub(super) struct UnknownTrial<'a> {
    kind: &'a Unknown,
    data: &'a Gathered,
    scales: Scales,
}

impl UnknownTrial<'_> {
    fn noiseless(&self) -> Option<ThreePalmModel<STATES>> {
        // Without contact noise all conditions have the same weight, as a search needs: weights that depend on the
        // motion prefer motions that turn fast.
        self.kind.model(self.scales, NoiseLevel { contact: 0.0, ..self.kind.noise })
    }
}

impl Trial<STATES> for UnknownTrial<'_> {
    type Point = State;
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

    fn starts(&self, round: Round, window: f64) -> Vec<State> {
        let track = &self.data.track;
        let nodes = track.t.partition_point(|&t| t <= window);
        let (Some(mass), Some(model)) = (ball(track, self.kind.gravity, nodes), self.noiseless()) else {
            return Vec::new();
        };
        let (noise, sampling) = (self.kind.noise, sampling(self.data.stride));
        let search = Search { track, mass: &mass, scales: self.scales, noise, sampling };
        let parameters = Parameters::new(&mass);
        let mut all = Vec::new();
        for height in HEIGHTS {
            for spin in [0.0, SPIN] {
                let mut starts = search.starts(window, Round { height, spin, ..round });
                // A ball looks the same in all orientations.
                starts.dedup_by(|a, b| a.L_WO.distance(b.L_WO) <= 1e-9 * b.L_WO.length());
                all.extend(
                    starts.iter().map(|start| {
                        model.state(&StartState { R_WO: DQuat::IDENTITY, ..*start }, &parameters)
                    }),
                );
            }
        }
        all.reverse();
        all
    }

    fn problem(&self, window: f64) -> BodyProblem<'_> {
        let mut t = 0.0;
        let end = self.data.nodes.iter().take_while(|(input, _)| {
            t += input.duration;
            t <= window + 1e-9
        });
        BodyProblem { nodes: &self.data.nodes, end: end.count().max(2), model: self.noiseless() }
    }

    /// A filter is taken through all nodes from the point found, believed loosely: its
    /// innovations must be those of the noise.
    fn judge(&self, fit: &Fit<State, STATES>) -> Verdict {
        let Some(model) = self.kind.model(self.scales, self.kind.noise) else { return Verdict::Refused };
        let natural = model.scales();
        let start = believed(fit, &model);
        let Ok(mut filter) = ExtendedKalmanFilter::new(model, &start) else {
            return Verdict::Refused;
        };
        let (mut worst, mut deviation): (f64, f64) = (0.0, f64::INFINITY);
        for (k, (input, touching)) in self.data.nodes.iter().enumerate() {
            filter.push(&sample(*input, touching));
            if (k + 1) % CHECKED == 0 || k + 1 == self.data.nodes.len() {
                let report = filter.estimate().report;
                worst = worst.max(report.residual);
                deviation = report.deviations().component_div(&natural).amax();
            }
        }
        Verdict::new(worst < EXPLAINED, deviation, LARGEST_DEVIATION)
    }
}

/// Least squares of the contact conditions by motion, mass and inertia.
pub(super) struct BodyProblem<'a> {
    nodes: &'a VecDeque<(NodeInput, [bool; 3])>,
    end: usize,
    model: Option<ThreePalmModel<STATES>>,
}

impl LeastSquares<STATES> for BodyProblem<'_> {
    type Point = State;

    fn linearise(&self, point: &State) -> Option<NormalEquations<STATES>> {
        let model = self.model.as_ref()?;
        let natural = model.scales();
        // Derivatives of the state by the scaled unknowns; body axes are held.
        let mut by_start = SMatrix::<f64, STATES, STATES>::from_diagonal(&natural);
        (9..12).for_each(|axis| by_start[(axis, axis)] = 0.0);
        let mut x = *point;
        let mut normal = NormalEquations::default();
        for (k, (input, _)) in self.nodes.iter().take(self.end).enumerate() {
            if k > 0 {
                let (next, transition) = model.flow(&x, input);
                x = next;
                by_start = transition * by_start;
            }
            let (y, h) = model.output(&x, input);
            let rows = h * by_start;
            for i in 0..3 {
                normal.add(&rows.row(i).transpose(), y[i]);
            }
        }
        normal.cost.is_finite().then_some(normal)
    }

    fn cost(&self, point: &State) -> Option<f64> {
        let model = self.model.as_ref()?;
        let mut x = *point;
        let mut cost = 0.0;
        for (k, (input, _)) in self.nodes.iter().take(self.end).enumerate() {
            if k > 0 {
                x = model.advance(&x, input);
            }
            cost += model.output(&x, input).0.norm_squared();
        }
        cost.is_finite().then_some(cost)
    }

    fn retract(&self, point: &State, step: &State) -> State {
        self.model.as_ref().map_or(*point, |m| m.retract(point, &step.component_mul(&m.scales())))
    }
}

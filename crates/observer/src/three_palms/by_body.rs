//! Motions of a known body, found as if nothing were known of it.
//!
//! With mass and inertia unknown the orientation at the start is no unknown, and with it goes what makes wrong minima of a
//! short noisy log. The body found then says how the known one must lie: its tensor, turned, has to be the one found,
//! within the covariance.

use super::cold_start::orientations;
use super::covariance::NoiseLevel;
use super::momentum::StartState;
use super::orientations::{equivalent_orientations, nearest_to_identity};
use super::refine::Refined;
use super::sensitivity::exponential;
use super::state_space::{BODY, MOTION_STATES, numbers_of_inertia};
use super::track::Track;
use super::unknown_body::{STATES, most_probable_body};
use crate::least_squares::{LeastSquares, LevenbergMarquardt, NormalEquations};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{SMatrix, SVector};
use object_dynamics::MassProperties;

const CONSTANTS: usize = BODY.len();
/// Step of the derivatives by a rotation, rad: the numbers of a tensor are smooth.
const SMALL_TURN: f64 = 1e-6;
/// Turns that lead to one minimum, rad.
const SAME: f64 = 0.1;
/// Ways to lie that are tried, at most.
const MOST: usize = 12;
/// Not to the minima, which are few: the body found is itself in error, by more than its covariance where the log is short.
const TURNING: LevenbergMarquardt =
    LevenbergMarquardt { iterations: 3, step_tolerance: 1e-6, damping: 1e-2, prior: 0.0 };

/// Motions at the nodes of a track, the likelier ones first.
pub(super) fn motions_by_body(
    track: &Track,
    mass: &MassProperties,
    noise: NoiseLevel,
) -> Vec<Vec<StartState>> {
    let Some(found) = most_probable_body(track, noise) else { return Vec::new() };
    let Some(problem) = Lying::new(&found, mass) else { return Vec::new() };
    let axes = mass.principal().axes.inverse();
    let mut ways: Vec<_> = orientations().into_iter().map(|q| TURNING.fit(&problem, q * axes)).collect();
    ways.retain(|way| way.normal.cost.is_finite());
    ways.sort_by(|a, b| a.normal.cost.total_cmp(&b.normal.cost));
    let mut kept: Vec<DQuat> = Vec::new();
    for way in ways {
        let turned = |other: &DQuat, turn: DQuat| 2.0 * (way.point.inverse() * *other * turn).xyz().length();
        let alike = |other| equivalent_orientations(mass).into_iter().any(|turn| turned(other, turn) < SAME);
        if kept.len() < MOST && !kept.iter().any(alike) {
            kept.push(nearest_to_identity(mass, way.point));
        }
    }
    let path = found.states();
    kept.into_iter()
        .map(|R| {
            path.iter().map(|state| StartState { R_WO: (state.R_WO * R).normalize(), ..*state }).collect()
        })
        .collect()
}

/// Least squares of what the known body, turned, lacks of the one found, in standard deviations.
struct Lying<'a> {
    mass: &'a MassProperties,
    found: SVector<f64, CONSTANTS>,
    /// Square root of the information about it, in the covariance's units.
    root: SMatrix<f64, CONSTANTS, CONSTANTS>,
}

impl<'a> Lying<'a> {
    fn new(found: &Refined<STATES>, mass: &'a MassProperties) -> Option<Self> {
        let body = found.solution.states[0].fixed_rows::<CONSTANTS>(MOTION_STATES).into_owned();
        let covariance = found.solution.covariances[0]
            .fixed_view::<CONSTANTS, CONSTANTS>(MOTION_STATES, MOTION_STATES)
            .into_owned();
        // C = G G': G^-1 makes standard deviations of differences.
        let root = covariance.cholesky()?.l().try_inverse()?;
        Some(Self { mass, found: body, root })
    }

    fn lacking(&self, R: DQuat) -> SVector<f64, CONSTANTS> {
        let R = DMat3::from_quat(R);
        let inertia = numbers_of_inertia(R * self.mass.inertia() * R.transpose());
        let body = SVector::from_fn(|k, _| if k == 0 { self.mass.mass().ln() } else { inertia[k - 1] });
        self.root * (body - self.found)
    }
}

impl LeastSquares<3> for Lying<'_> {
    type Point = DQuat;

    fn linearise(&self, R: &DQuat) -> Option<NormalEquations<3>> {
        let slopes: [SVector<f64, CONSTANTS>; 3] = DVec3::AXES.map(|axis| {
            let turned = |angle: f64| self.lacking(exponential(axis * angle) * *R);
            (turned(SMALL_TURN) - turned(-SMALL_TURN)) / (2.0 * SMALL_TURN)
        });
        let lacking = self.lacking(*R);
        let mut normal = NormalEquations::default();
        for k in 0..CONSTANTS {
            normal.add(&SVector::from_fn(|i, _| slopes[i][k]), lacking[k]);
        }
        normal.cost.is_finite().then_some(normal)
    }

    fn cost(&self, R: &DQuat) -> Option<f64> {
        Some(self.lacking(*R).norm_squared()).filter(|cost| cost.is_finite())
    }

    fn retract(&self, R: &DQuat, step: &SVector<f64, 3>) -> DQuat {
        (exponential(DVec3::new(step[0], step[1], step[2])) * *R).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::three_palms::test_scenes::on_swinging_palms;

    /// Nothing of the body is told but its own mass and moments: how it lies follows from what the log says of a body of
    /// which nothing is known.
    #[test]
    fn the_body_found_says_how_the_known_one_lies() {
        let (log, mass, gravity) = on_swinging_palms();
        let truth = log.truth().unwrap()[0];
        let track = Track::new(&log, mass.mass(), gravity, None).unwrap();
        let paths = motions_by_body(&track, &mass, NoiseLevel { contact: 1e-4, force: 1e-3 });
        assert!(paths.len() > 1 && paths.len() <= MOST, "{}", paths.len());
        let off = |path: &Vec<StartState>| {
            let turn = |turn: DQuat| (path[0].R_WO * turn).angle_between(truth.R_WO);
            equivalent_orientations(&mass).into_iter().map(turn).fold(f64::INFINITY, f64::min)
        };
        let errors: Vec<f64> = paths.iter().map(off).collect();
        assert!(errors[0] < 0.05, "{errors:?}");
        assert!((paths[0][0].p_WCm - truth.p_WCm).length() < 0.01);
    }
}

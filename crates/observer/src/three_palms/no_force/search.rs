//! A start without a guess: ellipsoids in many orientations, at rest, on a window that grows.

use super::orientations::orientations;
use super::problem::{Guess, TouchProblem, UNKNOWNS, uniform};
use super::series::{Nodes, TouchSeries};
use super::shape::FreeEllipsoid;
use crate::least_squares::{Fit, FitStatus, LevenbergMarquardt};
use crate::rigid::numbers_of_inertia;
use glam::DVec3;

/// Semi-axes of the ellipsoids tried, as shares of the ball's radius.
const AXES: [DVec3; 2] = [DVec3::new(0.75, 1.0, 1.3), DVec3::new(0.6, 0.95, 1.2)];
/// First window in natural times.
const FIRST_WINDOW: f64 = 1.0;
const GROWTH: f64 = 1.35;
/// Candidates that are followed beyond the first window, one after the other until one fits.
const FOLLOWED: usize = 8;
/// Fits on the way. The prior holds what a short window does not determine.
const COARSE: LevenbergMarquardt =
    LevenbergMarquardt { iterations: 12, step_tolerance: 1e-5, damping: 1e-2, prior: 1e-5 };

/// Fits as the window grows: few steps each, the data of the next window lead on.
const FOLLOWING: LevenbergMarquardt =
    LevenbergMarquardt { iterations: 15, damping: 1e-5, prior: 0.0, ..COARSE };

pub(super) type Candidate = Fit<Guess, UNKNOWNS>;

/// The best fit of the whole series; none where no start leads to one. Ends with the first that leaves at most `enough`
/// (root mean square, m).
pub(super) fn search(series: &TouchSeries, nodes: &Nodes, gravity: DVec3, enough: f64) -> Option<Candidate> {
    let (_, length) = series.ball();
    let natural = (length / gravity.length()).sqrt();
    let first = (FIRST_WINDOW * natural).min(series.duration());
    let problem = |window: f64| TouchProblem::new(nodes, gravity, length, window).coarse();
    let mut candidates: Vec<Candidate> =
        starts(length).into_iter().map(|start| COARSE.fit(&problem(first), start)).collect();
    sort(&mut candidates);
    candidates.truncate(FOLLOWED);
    let mut found: Vec<Candidate> = Vec::new();
    for candidate in candidates {
        let (mut fit, mut window) = (candidate, first);
        while window < series.duration() && fit.status != FitStatus::Failed {
            window = (window * GROWTH).min(series.duration());
            fit = FOLLOWING.fit(&problem(window), fit.point);
        }
        found.push(fit);
        sort(&mut found);
        if found.first().is_some_and(|best| best.normal.rms() < enough) {
            break;
        }
    }
    found.into_iter().next()
}

fn starts(radius: f64) -> Vec<Guess> {
    let mut all = Vec::new();
    for axes in AXES {
        for turn in orientations() {
            all.push(Guess {
                w: DVec3::ZERO,
                shape: FreeEllipsoid::numbers(radius * axes, turn),
                inertia: numbers_of_inertia(uniform(radius * axes, turn)),
            });
        }
    }
    all
}

fn sort(candidates: &mut Vec<Candidate>) {
    candidates.retain(|c| c.status != FitStatus::Failed && c.normal.cost.is_finite());
    candidates.sort_by(|a, b| a.normal.cost.total_cmp(&b.normal.cost));
}

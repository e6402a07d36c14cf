//! Whether poses speak for a plane lower than stated.
//!
//! Under a plane stated too high by `d` every half-space is moved in by `d`. Where the body is rounder than that, this is what a
//! smaller body would have done, and nothing contradicts it. But of a body with edges the half-spaces of its sides, moved in,
//! leave its edges shorter by more than `d`: where it touched with an edge it seems to have hung in the air. These gaps close as
//! the plane is taken lower, and stop closing at its true height.

use super::level::RESTING;
use super::{Observation, intersect};
use exact_hull::HalfSpace;
use exact_hull::Polyhedron;

/// Gaps that close by less than this share of the height say nothing: the half-spaces of a square prism close by 0.41 on its edges
/// and 0.73 on its corners, touches on the sides not at all.
const CLOSING: f64 = 0.15;
/// The bound of all poses is cut by the worst of their errors, so that the plane seems too high by up to 8.4 deviations of white
/// noise (324 sets of a tossed box) and by up to 1.8 margins of trackers with other faults (42 simulated sets) where it is right.
const DEVIATIONS: f64 = 10.0;
const MARGINS: f64 = 2.0;
/// Heights are tried down to so many margins below the stated one, and first as many below.
const LOWEST: f64 = 20.0;
const FIRST: f64 = 0.25;

/// How far below the stated height the plane seems to be, m, under tracking `noise` (m) and a `margin` of the bound; `None` where
/// nothing speaks for that.
pub(super) fn lower_plane(observations: &[Observation], margin: f64, noise: f64) -> Option<f64> {
    let runs = observations.iter().map(|o| o.at.0 + 1).max().unwrap_or(0);
    let mut lengths = vec![0; runs];
    observations.iter().for_each(|o| lengths[o.at.0] = lengths[o.at.0].max(o.at.1 + 1));
    let bare: Vec<Observation> = observations.iter().map(|o| Observation { kink: 0.0, ..*o }).collect();
    let moving: Vec<&Observation> =
        bare.iter().filter(|o| o.touching && o.at.1 + RESTING < lengths[o.at.0]).collect();
    let gap = |below: f64| {
        let bound: Polyhedron = intersect(&bare, below).ok()?;
        let mut caps = bound.caps();
        let planes = moving.iter().map(|o| -caps.height(&HalfSpace { margin: below, ..o.half_space }));
        Some(planes.sum::<f64>() / moving.len().max(1) as f64)
    };
    let (here, first, lowest) = (gap(0.0)?, gap(FIRST * margin)?, gap(LOWEST * margin)?);
    let closing = (here - first) / (FIRST * margin);
    // Where the gaps would have closed if they went on as they begin.
    let below = (here - lowest) / closing;
    (closing > CLOSING && below > (DEVIATIONS * noise).max(MARGINS * margin)).then_some(below)
}

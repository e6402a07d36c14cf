//! Who decides how the upper palm is moved.

use super::belief::{DrawnBody, drawn};
use super::hold::{Hold, Stroke, Wall};
use super::predict::{Course, Prediction};
use super::workspace::ParallelWorkspace;
use crate::goal::Goal;
use crate::knowledge::Knowledge;
use crate::planner::Reason;
use crate::space::SpaceKnowledge;
use contact_kinematics::Direction;
use glam::DVec2;
use shape_bounds::ShapeBounds;
use std::f64::consts::{FRAC_PI_2, TAU};
use thiserror::Error;

/// What a planner is shown.
pub struct ParallelView<'a> {
    /// Contacts and bounds.
    pub known: &'a SpaceKnowledge,
    /// Where the body is.
    pub hold: &'a Hold,
    /// Limits of the palms.
    pub workspace: &'a ParallelWorkspace,
    /// What is to be reached.
    pub goal: &'a Goal<Direction>,
    /// Where shear stopped strokes before.
    pub walls: &'a [Wall],
    /// Contacts nearer than this to one that there is are not taken, rad between normals.
    pub spacing: f64,
    /// Number of the stroke, from 0.
    pub stroke: usize,
    /// Strokes before it, one after another, that brought no contact.
    pub idle: usize,
}

/// A stroke to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelProposal {
    /// How the upper palm moves.
    pub stroke: Stroke,
    /// What it is expected to bring; none if the planner does not predict.
    pub expected: Option<Prediction>,
    /// Why.
    pub reason: Reason,
}

/// Why there is no next stroke.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ParallelPlanError {
    /// No stroke uncovers what is left: on no body drawn, and all that the palms can do was gone through, in steps of 0.2 rad, up to where friction or a pad ended it.
    #[error("no stroke uncovers what is left, at {} directions of the body: all that the palms can do was gone through in steps of 0.2 rad", directions.len())]
    NotFound {
        /// Outward normals in body axes where the bounds are farthest apart, the farthest first.
        directions: Vec<Direction>,
    },
}

/// Chooses strokes by what is known. Deterministic: the same views, in the same order, give the same strokes.
pub trait ParallelPlanner {
    /// Its name, as in tables and files.
    fn name(&self) -> &'static str;

    /// The next stroke.
    ///
    /// # Errors
    /// [`ParallelPlanError`] where no stroke gains anything.
    fn next(&mut self, view: &ParallelView<'_>) -> Result<ParallelProposal, ParallelPlanError>;
}

/// A stroke that may be made.
pub(super) struct Candidate {
    pub(super) stroke: Stroke,
    pub(super) course: Course,
    pub(super) prediction: Prediction,
}

/// Headings that are spread evenly, and by how much each turns the body, rad.
const HEADINGS: usize = 12;
const TURNS: [f64; 3] = [0.4, 0.9, FRAC_PI_2];
/// Corners of the upper bound, the farthest first, that strokes are aimed at, and that are named where nothing is found.
const AIMED: usize = 6;
/// A stroke is worth its way if it is expected to bring this share of what is still to be gained.
const WORTH: f64 = 0.01;

impl ParallelView<'_> {
    /// Bodies drawn for the view, of a planner with `seed`.
    pub(super) fn bodies(&self, count: usize, seed: u64) -> Vec<DrawnBody> {
        let seed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(self.stroke as u64);
        drawn(self.known, self.workspace, self.goal, count, seed)
    }

    /// Directions of the farthest corners of the upper bound from the lower one.
    pub(super) fn farthest_gaps(&self) -> Vec<Direction> {
        let mut gaps = self.known.bounds().map_or_else(Vec::new, ShapeBounds::gaps);
        gaps.sort_by(|a, b| b.distance.total_cmp(&a.distance));
        gaps.iter().take(AIMED).map(|gap| gap.direction).collect()
    }

    /// The goal's quantity that a stroke must be expected to bring.
    pub(super) fn worth(&self) -> f64 {
        WORTH * (self.known.progress(self.goal) - self.goal.value()).max(0.0)
    }

    /// All strokes from `course`, in a fixed order: of all headings, and towards `aims` (body axes).
    pub(super) fn candidates(
        &self,
        bodies: &[DrawnBody],
        course: &Course,
        aims: &[Direction],
    ) -> Vec<Candidate> {
        let Some(hold) = course.holds.first() else { return Vec::new() };
        let mut strokes: Vec<Stroke> = Vec::new();
        for k in 0..HEADINGS {
            let heading = TAU * k as f64 / HEADINGS as f64;
            strokes.extend(TURNS.map(|turn| Stroke { heading, turn }));
        }
        strokes.extend(aims.iter().filter_map(|along| towards(hold, *along)));
        let one = |stroke: Stroke| {
            let course = course.then(self, bodies, stroke);
            let prediction = course.prediction(self, bodies);
            Candidate { stroke, course, prediction }
        };
        strokes.into_iter().map(one).collect()
    }
}

/// The shortest stroke that brings `along` (body axes) or its opposite to a contact; none where it is there.
pub(super) fn towards(hold: &Hold, along: Direction) -> Option<Stroke> {
    let v = hold.R_WO * along.get();
    let v = if v.z < 0.0 { -v } else { v };
    let level = v.truncate();
    let turn = level.length().atan2(v.z);
    // The body turns from where its normal is to Z: the top moves against the way that the normal leans.
    let back: DVec2 = -level.try_normalize()?;
    Some(Stroke { heading: back.to_angle(), turn })
}

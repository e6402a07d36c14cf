//! Who decides how the palms turn next.

use super::belief::Belief;
use super::predict::{Course, Prediction};
use super::track::Track;
use super::workspace::Workspace;
use crate::goal::Goal;
use crate::knowledge::Knowledge;
use crate::planar::PlanarKnowledge;
use crate::planner::Reason;
use shape_bounds::exact_hull::planar::Direction;
use thiserror::Error;

/// What a planner is shown: never the body.
pub struct View<'a> {
    /// Contacts and bounds.
    pub known: &'a PlanarKnowledge,
    /// Where palms and body are.
    pub track: &'a Track,
    /// Limits of the palms.
    pub workspace: &'a Workspace,
    /// What is to be reached.
    pub goal: &'a Goal<Direction>,
    /// Largest share of the bodies drawn that a motion may lose.
    pub risk: f64,
    /// Contacts nearer than this to one that there is are not taken, in rad between normals.
    pub spacing: f64,
    /// Number of the motion, from 0.
    pub motion: usize,
}

/// A motion to be made.
#[derive(Clone, Debug, PartialEq)]
pub struct RollProposal {
    /// Absolute angles of the palms (rad) that they are turned to one after another, on straight ways.
    pub legs: Vec<[f64; 2]>,
    /// What it is expected to bring; none if the planner does not predict.
    pub expected: Option<Prediction>,
    /// Why.
    pub reason: Reason,
}

/// Why there is no next motion.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RollPlanError {
    /// No motion uncovers what is left: on no body drawn, and none of all steps that the palms can make from where they can get to, on a lattice and within the
    /// risk, leads to what was not there before.
    #[error("no motion of the palms uncovers what is left, at {} directions of the body: all that they can do was gone through in steps of 0.3 rad", directions.len())]
    NotFound {
        /// Outward normals in body axes, with the most left first.
        directions: Vec<Direction>,
    },
    /// No body drawn rests on the palms: contacts contradict each other or the workspace's size.
    #[error(
        "no body between the bounds rests on the palms: check the size that was stated, {size} m, and the noise"
    )]
    NoBody {
        /// As stated, m.
        size: f64,
    },
}

/// Chooses motions of the palms by what is known. Deterministic: the same views, in the same order, give the same motions.
pub trait RollPlanner {
    /// Its name, as in tables and files.
    fn name(&self) -> &'static str;

    /// The next motion.
    ///
    /// # Errors
    /// [`RollPlanError`] where no motion gains anything.
    fn next(&mut self, view: &View<'_>) -> Result<RollProposal, RollPlanError>;
}

/// A motion that may be made.
pub(super) struct Candidate {
    pub(super) to: [f64; 2],
    pub(super) course: Course,
    pub(super) prediction: Prediction,
}

/// Spacing of the angles that palms are turned to, rad.
pub(super) const SPACING: f64 = 0.3;
/// The same where each prediction is a simulation.
const SIMULATED: f64 = 0.6;
/// Short motions beside those, rad.
const NEARBY: f64 = 0.2;
/// A motion is worth its way if it is expected to bring this share of what is still to be gained.
const WORTH: f64 = 0.02;

/// Angles that palms may be turned to from `here`, in a fixed order.
pub(super) fn targets(workspace: &Workspace, here: [f64; 2], spacing: f64) -> Vec<[f64; 2]> {
    let mut all = workspace.lattice(spacing);
    let steps = [-NEARBY, 0.0, NEARBY];
    let near = steps.iter().flat_map(|a| steps.iter().map(move |b| [here[0] + a, here[1] + b]));
    all.extend(near.filter(|palms| *palms != here && workspace.allows(*palms)));
    all.retain(|palms| *palms != here);
    all
}

/// All straight motions from `course` that lose few enough bodies.
pub(super) fn candidates(view: &View<'_>, belief: &Belief, course: &Course) -> Vec<Candidate> {
    let one = |to: [f64; 2]| {
        let course = course.then(belief, view.workspace, to);
        let prediction = course.prediction(belief, view.workspace);
        Candidate { to, course, prediction }
    };
    let spacing = if belief.dynamics.is_some() { SIMULATED } else { SPACING };
    let all = targets(view.workspace, course.palms, spacing).into_iter().map(one);
    all.filter(|c| c.prediction.lost <= view.risk).collect()
}

/// Area (m^2) that a motion must be expected to bring.
pub(super) fn worth(view: &View<'_>, belief: &Belief) -> f64 {
    let left = match view.goal {
        Goal::Gap(goal) => 1.0 - goal / view.known.measures().gap(),
        _ => 1.0,
    };
    WORTH * left.max(0.0) * belief.between()
}

/// The bodies drawn for a view, of a planner with `seed`.
pub(super) fn belief(view: &View<'_>, bodies: usize, seed: u64) -> Result<Belief, RollPlanError> {
    let seed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(view.motion as u64);
    let belief = Belief::draw(view.known, view.track, view.workspace, view.spacing, bodies, seed);
    let none = RollPlanError::NoBody { size: view.workspace.size };
    if belief.bodies.is_empty() { Err(none) } else { Ok(belief) }
}

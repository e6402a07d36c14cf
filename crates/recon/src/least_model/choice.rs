//! What was chosen, what else there was, and how that is known.

use super::Accuracy;
use serde::Serialize;

/// A model that was chosen for a wanted accuracy, question by question.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Choice {
    /// What was asked for.
    pub wanted: Accuracy,
    /// What is reached, in the same sense: of a simulation as its error estimate says, of a reconstruction by the bound that is stated with it.
    pub reached: f64,
    /// Whether that is as near as was asked for, and nothing speaks against it.
    pub is_reached: bool,
    /// Each question with its alternatives.
    pub decisions: Vec<Decision>,
    /// Time that all trials took that led to the choice, the chosen one included, s.
    pub seconds: f64,
}

/// One question.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Decision {
    /// What is asked.
    pub question: Question,
    /// What was to choose from; one of them is chosen.
    pub alternatives: Vec<Alternative>,
}

/// What may be modelled or left out.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Question {
    /// Is the motion in a plane, to within noise?
    Space,
    /// Do inertial forces matter?
    Dynamics,
    /// Do palms rub?
    Friction,
    /// Are mass and inertia known?
    Body,
    /// Are forces needed?
    Forces,
    /// How many axes of a force?
    Axes,
    /// How much of the log at once?
    Window,
    /// How many of the samples?
    Thinning,
    /// In which coordinates is the motion integrated, by which scheme?
    Integrator,
    /// To which tolerance?
    Tolerance,
}

/// One answer to a question.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alternative {
    /// What it is.
    pub model: Model,
    /// Whether it was taken.
    pub chosen: bool,
    /// Time that it takes, s; none where it was not tried and nothing predicts it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// The accuracy that it reaches; none where nothing says so.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<f64>,
    /// How that is known.
    pub evidence: Evidence,
}

/// A way to model something.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Model {
    /// All motion in the plane of the world's x and z axes.
    Planar,
    /// Motion in space.
    Spatial,
    /// Forces balance at all times.
    Quasistatic,
    /// Newton and Euler.
    Dynamic,
    /// Palms without friction.
    Frictionless,
    /// Palms with the friction that is stated, or any.
    Friction,
    /// Mass and inertia as stated.
    KnownBody,
    /// Mass and inertia estimated with the motion.
    EstimatedBody,
    /// With forces.
    Forces,
    /// From contacts alone, of an ellipsoid.
    NoForces,
    /// Forces along the normal alone.
    NormalForce,
    /// Forces in three axes.
    ThreeAxes,
    /// All of the log at once.
    WholeLog,
    /// One of so many samples.
    Every(usize),
    /// Orientation and angular velocity alone, of three planes that are touched throughout; order 8 with step control.
    MinimalCoordinates,
    /// All coordinates, through changes of contact modes; order 8 with step control.
    ContactModes,
    /// Relative and absolute tolerance of a step.
    Tolerance(f64),
}

/// How something is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "by")]
pub enum Evidence {
    /// The scene or the caller says so.
    Stated,
    /// It was run, and states this accuracy itself.
    Run,
    /// Predicted from another run by how errors change with this setting.
    Predicted,
    /// A test of what is left: a statistic that is one of chance below its limit.
    Test {
        /// What was measured; the largest number where it is beyond all noise.
        value: f64,
        /// What it may be, by chance once in a thousand.
        limit: f64,
    },
    /// Nothing in this log or scene can be modelled so.
    Impossible,
    /// The run came to an error, or says of itself that it is not to be relied on.
    Refused,
    /// Accuracy was in reach without it.
    Needless,
}

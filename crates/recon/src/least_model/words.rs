//! Questions and answers in words.

use super::{Alternative, Evidence, Model, Question};
use std::fmt;

impl fmt::Display for Question {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Space => "In a plane, or in space",
            Self::Dynamics => "Forces in balance, or inertia",
            Self::Friction => "Friction",
            Self::Body => "Mass and inertia",
            Self::Forces => "Forces",
            Self::Axes => "Axes of the forces",
            Self::Window => "How much of the log at once",
            Self::Thinning => "How many of the samples",
            Self::Integrator => "Coordinates and scheme",
            Self::Tolerance => "Tolerance of a step",
        })
    }
}

impl fmt::Display for Model {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Planar => f.write_str("the plane of the world's x and z axes"),
            Self::Spatial => f.write_str("space"),
            Self::Quasistatic => f.write_str("balance at all times"),
            Self::Dynamic => f.write_str("Newton and Euler"),
            Self::Frictionless => f.write_str("none"),
            Self::Friction => f.write_str("any, or as stated"),
            Self::KnownBody => f.write_str("as stated"),
            Self::EstimatedBody => f.write_str("estimated with the motion"),
            Self::Forces => f.write_str("with forces"),
            Self::NoForces => f.write_str("contacts alone, of an ellipsoid"),
            Self::NormalForce => f.write_str("along the normal alone"),
            Self::ThreeAxes => f.write_str("three axes"),
            Self::WholeLog => f.write_str("all of it"),
            Self::Every(1) => f.write_str("all samples"),
            Self::Every(k) => write!(f, "one of {k}"),
            Self::MinimalCoordinates => f.write_str("orientation alone, order 8"),
            Self::ContactModes => f.write_str("all coordinates through contact modes, order 8"),
            Self::Tolerance(tolerance) => write!(f, "{tolerance:.1e}"),
        }
    }
}

impl fmt::Display for Evidence {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stated => f.write_str("as stated"),
            Self::Run => f.write_str("was run"),
            Self::Predicted => f.write_str("predicted from another run"),
            Self::Test { value, limit } if value <= limit => {
                write!(f, "a test finds no more than chance: {value:.2e} of at most {limit:.2e}")
            }
            Self::Test { value, limit } => {
                write!(f, "a test speaks against it: {value:.2e}, by chance at most {limit:.2e}")
            }
            Self::Impossible => f.write_str("not possible here"),
            Self::Refused => f.write_str("came to an error, or is not to be relied on"),
            Self::Needless => f.write_str("not needed, not tried"),
        }
    }
}

impl Alternative {
    /// What it costs, what it reaches, and how that is known.
    #[must_use]
    pub fn told(&self) -> String {
        let seconds = self.seconds.map(|seconds| format!("{:.1e} s", seconds));
        let accuracy = self.accuracy.map(|accuracy| format!("accuracy {accuracy:.1e}"));
        let parts = [seconds, accuracy, Some(self.evidence.to_string())];
        parts.into_iter().flatten().collect::<Vec<_>>().join("; ")
    }
}

impl super::Choice {
    /// In one sentence, whether the accuracy is reached.
    #[must_use]
    pub fn verdict(&self) -> String {
        let (wanted, reached) = (self.wanted.get(), self.reached);
        if self.is_reached {
            format!("An accuracy of {wanted:.1e} was asked for, and {reached:.1e} is reached (sizes, rad).")
        } else {
            format!(
                "An accuracy of {wanted:.1e} was asked for, which is not reached: the best there is is {reached:.1e} (sizes, rad)."
            )
        }
    }
}

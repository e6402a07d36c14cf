//! Three palms in space: the paper's own method, and contacts without forces.

mod motion_state;
mod no_force;
mod paper_method;
mod paper_system;
mod track;

pub use motion_state::MotionState;
pub use no_force::{
    Closure, KnownTouch, NoForceError, NoForceEstimate, NoForceEvidence, TouchShape, estimate_without_forces,
};
pub use paper_method::{
    PaperError, PaperMethod, PaperReconstruction, PaperStart, PredictorCorrector, integrate_paper_system,
};
pub use track::{Track, TrackError};

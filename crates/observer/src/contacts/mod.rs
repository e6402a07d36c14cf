//! Motion, mass and inertia from contacts of any palms: nodes linked by measured impulses.

mod axes;
mod backwards;
mod between;
mod body;
mod changed;
mod cold;
mod directly;
mod drawn;
mod elimination;
mod equations;
mod estimate;
mod explanations;
mod feet;
mod flow;
mod gaps;
mod impulses;
mod joint;
mod link;
mod mode_odds;
mod modes;
mod noise;
mod onward;
mod options;
mod outliers;
mod plane;
mod problem;
mod ranges;
mod reach;
mod record;
mod redrawn;
mod relabel;
mod rivals;
mod roughness;
mod rows;
mod samples;
mod search;
mod sensor_change;
mod serial;
mod sharp;
mod slips;
mod slopes;
mod solve;
mod spurious;
mod stage;
mod state;
mod stepping;
mod stream;
mod suspects;
#[cfg(test)]
mod tests;
mod triangular;
mod unresolved;
mod verdict;
mod widened;
mod windows;

pub use estimate::{ContactEstimate, estimate_contacts};
pub use mode_odds::EstimatedModes;
pub use noise::{ContactNoiseLevel, ImpulseNoise};
pub use options::{ContactEstimateError, ContactOptions};
pub use stream::{
    ForceReading, MotionStream, PalmSensed, PlaneReadings, StreamBody, StreamError, StreamEstimate,
    StreamMotion, StreamOptions, StreamPalm, StreamStage,
};
pub use verdict::ContactEvidence;

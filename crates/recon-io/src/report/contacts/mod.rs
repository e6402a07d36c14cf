//! Reports of motions through contact modes, simulated or estimated: pictures, bands of modes, curves.

mod bands;
mod estimate;
mod estimate_curves;
mod estimate_page;
mod followed;
mod moment;
mod page;
mod picture;
mod plane;
mod plane_estimate;
mod space;
mod spans;
mod view;

#[cfg(test)]
mod tests;

pub use estimate::{EstimateData, ShapeMarks};
pub use estimate_page::{doubtful_spans, sample_gaps, write_estimate_report};
pub use followed::{FollowedMotion, FollowedPage, write_followed_report};
pub use page::{write_contact_report, write_planar_contact_report};
pub use plane_estimate::{PlaneEstimateData, write_plane_estimate_report};
pub use spans::{ModeSpan, estimated_mode_spans, mode_spans, mode_times, planar_mode_spans};

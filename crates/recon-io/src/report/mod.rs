//! `report.html`: one page without any reference to the outside, which shows a reconstruction to a person.

mod batch;
mod contacts;
mod contour;
mod data;
mod evidence_table;
mod exploration;
mod figures_page;
mod notices;
mod page;
mod pushes;
mod thin;

pub use batch::{BatchPage, LogCard, write_batch_report};
pub use contacts::{
    EstimateData, FollowedMotion, FollowedPage, ModeSpan, PlaneEstimateData, ShapeMarks, doubtful_spans,
    estimated_mode_spans, mode_spans, mode_times, planar_mode_spans, sample_gaps, write_contact_report,
    write_estimate_report, write_followed_report, write_planar_contact_report, write_plane_estimate_report,
};
pub use contour::{ContourPage, JumpRow, write_contour_report};
pub use data::{Bound, Bounds, Evidence, EvidenceValue, Level, MotionState, PalmContact, TrueShape, Verdict};
pub use exploration::{ExplorationPage, ExplorationWords, TouchRow, write_exploration_report};
pub use figures_page::{FiguresPage, write_figures_page};
pub use page::Fact;
pub use pushes::{PushedLog, write_pushes_report};

pub(crate) use data::{Departure, level};

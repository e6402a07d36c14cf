//! Files of recon: sensor logs, scene files, contact lists, meshes, tables and the report. No mathematics, but for what the
//! check of results ([`check`]) reads off the corners of meshes.
//!
//! Start with [`read_any_log`] and [`Scene`] for what a robot recorded, [`parse_contacts`] for a list of contacts, [`OutputFolder`] for results:
//!
//! ```
//! use recon_io::{TriangleMesh, parse_contacts, write_ply};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let text = "x,y,z,nx,ny,nz\n1,0,0,1,0,0\n-1,0,0,-1,0,0\n0,1,0,0,1,0\n0,-1,0,0,-1,0\n0,0,1,0,0,1\n0,0,-1,0,0,-1\n";
//! let contacts = parse_contacts(text.as_bytes())?.concat();
//! assert_eq!(contacts.len(), 6);
//! // What is wrong is named with its place.
//! let wrong = parse_contacts(&b"x,y,z,nx,ny,nz\n1,0,zero,1,0,0\n"[..]).unwrap_err();
//! assert!(wrong.to_string().contains("line 2") && wrong.to_string().contains('z'), "{wrong}");
//! let bounds = recon::shape_bounds::ShapeBounds::from_contacts(&contacts)?;
//! let upper = bounds.upper().bounded().ok_or("open")?.mesh();
//! let mut file = Vec::new();
//! write_ply(&TriangleMesh::new(upper.vertices, upper.triangles)?, "the cube around it", &mut file)?;
//! assert!(file.starts_with(b"ply"));
//! # Ok(())
//! # }
//! ```
//!
//! Errors of reading name the file, the line or key, the value and the mend. What is written as a whole appears as a
//! whole or not at all ([`OutputFolder`], [`AtomicFile`]).

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "mcap")]
mod bag;
mod check;
mod export;
mod log;
mod mesh;
mod mesh_formats;
mod mode_columns;
mod number;
mod output;
mod planar_figures;
mod plausibility;
mod report;
mod rows;
mod scene;
mod separator;
mod stream;
mod summary;
mod table;
mod touches;

#[cfg(feature = "mcap")]
pub use bag::{
    Bag, BagError, BagErrorKind, BagLog, BagMapping, BagOverview, BagTransform, BagUnits, ForceOn, Joint,
    JointTopic, MappingDraft, MappingError, MappingErrorKind, Message, MessageKind, PalmClock, PalmTopics,
    Pitch, Reading, ResultBag, ResultContact, ResultPose, TaxelTopic, TaxelValue, TimeOf, Topic, TopicClock,
    TopicGap, TopicOverview, Unread, clocks_of_bag, draft_mapping, is_bag, log_of_bag, overview, palms_of,
    parse_bag, read_bag,
};
pub use check::{CheckError, Fault, check, check_unwritten, outline_stands_out, stands_out};
pub use export::{
    ExportError, ExportFormat, ExportShape, ExportedFile, MassDeviations, ObjectModel, SceneModel,
};
pub use log::{
    AnyLog, ContactRows, LogFileError, LogFileErrorKind, LogReader, PalmSetup, PlaneRows, PoseAgainstScene,
    RowReader, RowSample, log_of_columns, parse_any_log, parse_contact_log, parse_log,
    parse_planar_contact_log, parse_planar_log, planar_contact_log_of_columns, planar_log_of_columns,
    read_any_log, read_contact_log, read_log, read_planar_contact_log, read_planar_log, read_push_logs,
    write_contact_log, write_log, write_planar_contact_log, write_planar_log, write_push_poses,
    write_push_samples,
};
pub use mesh::{MeshError, TriangleMesh, write_ply};
pub use mesh_formats::{write_glb, write_stl};
pub use mode_columns::{mode_columns, probabilities, push_modes};
pub use number::{brief, brief_to, with_brief_numbers};
pub use output::{
    AtomicFile, FileTarget, FolderTarget, OutputError, OutputFolder, Summed, fingerprint, is_standard_output,
    remove_left_behind,
};
pub use planar_figures::{FigureCurve, FigureFrame, FigurePanel, write_figures};
pub use plausibility::{Implausibility, implausibilities, implausible_contacts};
pub use report::{
    BatchPage, Bound, Bounds, ContourPage, EstimateData, Evidence, EvidenceValue, ExplorationPage,
    ExplorationWords, Fact, FiguresPage, FollowedMotion, FollowedPage, JumpRow, Level, LogCard, ModeSpan,
    MotionState, PalmContact, PlaneEstimateData, PushedLog, ShapeMarks, TouchRow, TrueShape, Verdict,
    doubtful_spans, estimated_mode_spans, mode_spans, mode_times, planar_mode_spans, sample_gaps,
    write_batch_report, write_contact_report, write_contour_report, write_estimate_report,
    write_exploration_report, write_figures_page, write_followed_report, write_planar_contact_report,
    write_plane_estimate_report, write_pushes_report,
};
pub use scene::{
    AnyOutline, BoxedShape, KnownInertia, KnownPalm, OutlineScene, PlanarBody, PlanarKnown, PlanarScene,
    Scene, SceneError, SceneErrorKind, Sensors, Shape, Simulation, SurfaceScene,
};
pub use stream::{StreamRow, write_stream_header, write_stream_row};
pub use summary::{
    INERTIA_LEARNED, SummaryOf, estimate_summary, explanation, mode_figures, sensor_fault, status_in_words,
    verdict_figures,
};
pub use table::{
    POSE, POSE_IN_PLANE, mode_probabilities, write_contact_curves, write_covariances, write_estimated_motion,
    write_motion, write_radius_functions,
};
pub use touches::{
    Touches, TouchesError, TouchesErrorKind, parse_contacts, parse_planar_contacts, parse_poses,
    read_contacts, read_touches, touches_of_columns, write_contacts,
};

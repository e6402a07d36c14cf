//! Files of recon: sensor logs, scene files, contact lists, meshes, tables and the report. No mathematics, but for what the
//! check of results ([`check`]) reads off the corners of meshes.
//!
//! Errors of reading name the file, the line or key, the value and the mend. What is written as a whole appears as a
//! whole or not at all ([`OutputFolder`], [`AtomicFile`]).

#[cfg(feature = "mcap")]
mod bag;
mod check;
mod export;
mod log;
mod mesh;
mod mesh_formats;
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
pub use number::{brief, brief_to, with_brief_numbers};
pub use output::{
    AtomicFile, FileTarget, FolderTarget, OutputError, OutputFolder, Summed, fingerprint, is_standard_output,
};
pub use planar_figures::{FigureCurve, FigureFrame, FigurePanel, write_figures};
pub use plausibility::{Implausibility, implausibilities, implausible_contacts};
pub use report::{
    BatchPage, Bound, Bounds, EstimateData, Evidence, EvidenceValue, ExplorationPage, ExplorationWords, Fact,
    FiguresPage, Level, LogCard, ModeSpan, MotionState, PalmContact, PlaneEstimateData, PushedLog,
    ShapeMarks, TouchRow, TrueShape, Verdict, doubtful_spans, estimated_mode_spans, mode_spans, mode_times,
    planar_mode_spans, write_batch_report, write_contact_report, write_estimate_report,
    write_exploration_report, write_figures_page, write_planar_contact_report, write_plane_estimate_report,
    write_pushes_report,
};
pub use scene::{
    BoxedShape, KnownInertia, KnownPalm, PlanarBody, PlanarKnown, PlanarScene, Scene, SceneError,
    SceneErrorKind, Sensors, Shape, Simulation,
};
pub use stream::{StreamRow, write_stream_header, write_stream_row};
pub use summary::{
    INERTIA_LEARNED, SummaryOf, estimate_summary, explanation, sensor_fault, status_in_words, verdict_figures,
};
pub use table::{
    mode_probabilities, write_contact_curves, write_estimated_motion, write_motion, write_radius_functions,
};
pub use touches::{
    Touches, TouchesError, TouchesErrorKind, parse_contacts, parse_planar_contacts, parse_poses,
    read_contacts, read_touches, touches_of_columns, write_contacts,
};

//! From files' contents to results in memory, and from results to a folder.

mod advice;
mod any_palms;
mod any_palms_bounds;
mod any_palms_words;
mod body;
mod bounds;
mod bounds_page;
mod concave;
mod condensed;
mod contacts;
mod doubts;
mod estimate;
mod evidence;
mod exploration;
mod export;
mod features;
mod fitted;
mod folder;
mod least_model;
mod meshes;
mod modes;
mod planar_contacts;
mod planar_motion;
mod planar_motion_bounds;
mod planar_motion_panels;
mod planar_motion_tables;
mod planar_motion_words;
mod planar_read;
mod plane;
mod planes;
mod read;
mod repeated;
mod result_bag;
mod sensor_words;
mod simulate;
mod smooth;
mod sound;
mod truth;
mod views;
mod without_forces;
mod without_forces_page;
mod words;

pub(crate) use any_palms::{AnyPalms, condition_floor, spread};
pub(crate) use bounds::{BoundsResult, exact_bounds};
pub(crate) use bounds_page::{bounds_page, plane_bounds_page};
pub(crate) use concave::concave_bounds;
pub(crate) use contacts::{ContactRun, simulate_contacts};
pub(crate) use doubts::doubtful_fit;
pub(crate) use estimate::{Asked, Estimated, estimated, estimated_planes};
pub(crate) use evidence::row as evidence_row;
pub(crate) use exploration::{
    CONFIDENCE, Descending, Explored, Following, InPlane, InSpace, Placed, STATE, Settings, State, explored,
    felt, followed, goal_of, next_motion, next_stroke, next_touch, rolled, sensed, stroked, until_of,
};
pub(crate) use features::feature_lines;
pub(crate) use fitted::{fit_words, fitted_shape};
pub(crate) use folder::{Extra, write_bounds_folder, write_contact_folder, write_files_folder};
pub(crate) use least_model::{choice_figures, explained};
pub(crate) use meshes::meshes_as;
pub(crate) use modes::describe_times;
pub(crate) use planar_contacts::{PlanarContactRun, simulate_planar_contacts};
pub(crate) use planar_motion::{PlanarMotion, hinged_pair, planar_motion};
pub(crate) use planar_read::{PlanarSource, read_planar, with_palms};
pub(crate) use plane::{PlanarBounds, PlanarRequest, planar_bounds};
pub(crate) use read::{
    LoadedLog, LogOf, LogSource, load, read_log, seen_from_meeting_point, sorted_with_forces,
    sorted_without_forces, three_palms,
};
pub(crate) use repeated::repeated;
pub(crate) use simulate::{Simulated, known_body, simulate};
pub(crate) use smooth::smooth_surface;
pub(crate) use sound::{Noise, noisy_bounds, pose_bounds, sharp_bounds};
pub(crate) use views::views;
pub(crate) use without_forces::{WithoutForces, without_forces};
pub(crate) use without_forces_page::without_forces_page;

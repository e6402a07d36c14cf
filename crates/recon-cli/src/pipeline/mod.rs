//! From files' contents to results in memory, and from results to a folder.

mod any_palms;
mod any_palms_bounds;
mod any_palms_words;
mod body;
mod bounds;
mod concave;
mod contacts;
mod doubts;
mod evidence;
mod exploration;
mod export;
mod fitted;
mod folder;
mod modes;
mod noisy_planes;
mod planar_contacts;
mod planar_motion;
mod plane;
mod read;
mod reconstruct;
mod result_bag;
mod simulate;
mod sound;
mod truth;

pub(crate) use any_palms::{
    AnyPalms, AnyPalmsRequest, condition_floor, estimate_any_palms, refuse_unfelt, spread,
};
pub(crate) use bounds::{BoundsResult, bounds, exact_bounds};
pub(crate) use concave::concave_bounds;
pub(crate) use contacts::{ContactRun, simulate_contacts};
pub(crate) use doubts::doubtful_fit;
pub(crate) use exploration::{Explored, InPlane, InSpace, Settings, explored, goal_of, next_touch, until_of};
pub(crate) use export::exported;
pub(crate) use fitted::{fit_words, fitted_shape};
pub(crate) use folder::{
    write_bounds_folder, write_contact_folder, write_estimate_folder, write_files_folder,
    write_reconstruction_folder, write_touch_folder,
};
pub(crate) use modes::describe_times;
pub(crate) use noisy_planes::{as_planes, noisy_planes};
pub(crate) use planar_contacts::simulate_planar_contacts;
pub(crate) use planar_motion::{PlanarMotion, hinged_pair, planar_motion};
pub(crate) use plane::{PlanarBounds, PlanarRequest, planar_bounds};
pub(crate) use read::{LogOf, LogSource, LogStand, ReadLog, read_log, three_palms};
pub(crate) use reconstruct::{NOTABLE_NOISE, Reconstruction, condensed, reconstruct, sentence};
pub(crate) use result_bag::{bag_of_any_palms, bag_of_planes, normal_forces};
pub(crate) use simulate::{Simulated, known_body, simulate};
pub(crate) use sound::{Noise, noisy_bounds, pose_bounds, sharp_bounds};

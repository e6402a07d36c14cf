//! Planar estimators of shape and motion from touch (paper, section 3), better conditioned than the paper's.
//!
//! Conventions as in [`contact_kinematics::planar`] and [`object_dynamics::planar`].

mod authors;
mod constants;
mod doubt;
mod error;
mod estimate;
mod estimate_contacts;
mod force_driven;
mod input;
mod observer;
mod options;
mod palm_contact;
mod polynomial;
mod quasistatic;
mod scale;
mod shape_fit;
mod start;

pub use authors::{AuthorsFields, AuthorsState};
pub use constants::{Constant, PlanarNominal, Side};
pub use doubt::Doubt;
pub use error::PlanarEstimateError;
pub use estimate::PlanarEstimate;
pub use estimate_contacts::{
    PlaneDeviations, PlaneEstimate, PlaneEstimateError, PlaneOptions, estimate_plane, plane_noise,
};
pub use force_driven::ForceDriven;
pub use input::{InputBuilder, PairInput, PairStage, planar_samples};
pub use observer::PlanarObserver;
pub use options::{PlanarObserverOptions, PlanarStartFrom};
pub use quasistatic::{
    HeightFit, QuasistaticError, QuasistaticPath, QuasistaticPoint, height_from_closure,
    quasistatic_reconstruction,
};
pub use scale::NaturalScale;
pub use shape_fit::{ShapeFit, ShapeFitOptions, fit_shape};
pub use start::{ResidualStart, residual_start};

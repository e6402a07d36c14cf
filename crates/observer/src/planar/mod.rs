//! Shape and motion from touch in the plane (paper, section 3): from forces ([`estimate_plane`]), from contacts alone ([`fit_shape`]), for slow
//! palms ([`quasistatic_reconstruction`]); and the paper's own vector fields ([`AuthorsFields`])
//! with their observability by Lie derivatives ([`AuthorsFields::observability`]).
//!
//! Conventions as in [`contact_kinematics::planar`] and [`object_dynamics::planar`].

mod authors;
mod error;
mod estimate_contacts;
mod observability;
mod quasistatic;
mod shape_fit;

pub use authors::{AuthorsFields, AuthorsState};
pub use error::PlanarEstimateError;
pub use estimate_contacts::{
    PlaneContact, PlaneDeviations, PlaneEstimate, PlaneEstimateError, PlaneOptions, estimate_plane,
    plane_noise,
};
pub use observability::{LONGEST_CHAIN, LieField, NaturalUnits, Observability};
pub use quasistatic::{
    HeightFit, QuasistaticError, QuasistaticPath, QuasistaticPoint, height_from_closure,
    quasistatic_reconstruction,
};
pub use shape_fit::{ShapeFit, ShapeFitOptions, fit_shape};

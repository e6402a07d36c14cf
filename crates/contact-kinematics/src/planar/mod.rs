//! The planar case: a smooth convex object between two palms hinged at the origin (paper, section 3, Fig. 1).
//!
//! World axes X right, Y up; angles counter-clockwise. Palm `i` leaves the hinge along `u_i`; its unit normal `n_i`
//! points into the wedge, at the object. The object is described by its radius function about its centre of mass.
//!
//! Palms of any pose and motion, lines, arcs and cups, are [`PalmSurface`]s; [`SurfaceContact`] is the contact with one.

mod circle;
mod contact;
mod ellipse;
mod error;
mod fourier;
mod palms;
mod polygon;
mod radius;
mod surface;

pub use circle::Circle;
pub use contact::{PairContact, PairVelocity};
pub use ellipse::Ellipse;
pub use error::{PalmPairError, ShapeError};
pub use fourier::FourierBody;
pub use palms::{PairRates, PalmPair, PalmPairState};
pub use polygon::RoundedPolygon;
pub use radius::{RadiusBounds, RadiusFunction, RadiusJet};
pub use surface::{
    BodyPlace, ContactError, MotionPart, PalmSurface, SurfaceContact, SurfaceError, SurfaceMotion,
    SurfacePose, SurfaceRates, SurfaceState,
};

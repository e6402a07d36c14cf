//! Geometry and kinematics of a smooth convex body touched by palms: no masses, no forces, no files.
//!
//! A smooth convex body is described by its support function `h(n)` about a body-fixed origin (in this workspace
//! the centre of mass). Its gradient is the contact point with outward normal `n`, its Hessian holds the radii of
//! curvature. No chart of the sphere is used anywhere, so there is no direction in which a formula fails.
//!
//! Frames: `W` world (Z up), `O` object, `P_i` palm `i`. Units: SI.

mod contact;

mod motion_law;
mod palm;
pub mod planar;
mod stop;
mod support;
mod surface;

pub use contact::{
    Contact, ContactCurve, ContactRates, ContactSupport, CurveError, CurvePoint, Darboux, ThreeContacts,
    acceleration_defect, body_normal, body_normal_rate, contact_curve_rates, contact_velocity, darboux,
    radius_rate, separation_rates,
};
pub use motion_law::MotionLaw;
pub use palm::{Palm, PalmError, PalmFrame, PalmState, PalmTriple};
pub use stop::{Stopped, is_stopped, unless_stopped};
pub use support::{
    CurvatureRadii, Ellipsoid, MinkowskiSum, Monomial, PolynomialSupport, RoundedPolytope, ShapeError,
    Sphere, SupportFunction, SupportJet, Translated, check_convex, principal_radii,
};
pub use surface::{
    BodyPlace, ContactError, FASTEST_PALM, FASTEST_TURN, MotionPart, PalmSurface, PoseTable, Pressed,
    PressureError, SurfaceContact, SurfaceError, SurfaceMotion, SurfacePoint, SurfacePose, SurfaceRates,
    SurfaceState, TaxelArray,
};
pub use unit_direction::{Direction, DirectionError};

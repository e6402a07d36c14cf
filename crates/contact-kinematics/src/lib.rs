//! Geometry and kinematics of a smooth convex body touched by palms: no masses, no forces, no files.
//!
//! A smooth convex body is described by its support function `h(n)` about a body-fixed origin (in this workspace
//! the centre of mass). Its gradient is the contact point with outward normal `n`, its Hessian holds the radii of
//! curvature. No chart of the sphere is used anywhere, so there is no direction in which a formula fails.
//!
//! Start with a body, an [`Ellipsoid`], a [`PolynomialSupport`] or any [`SupportFunction`], and ask where it is touched:
//!
//! ```
//! use contact_kinematics::{Direction, Ellipsoid, SupportFunction, check_convex, principal_radii};
//! use glam::DVec3;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let body = Ellipsoid::new(DVec3::new(0.05, 0.04, 0.02))?;
//! // The palm below it has its normal upwards, so the body's is downwards there.
//! let touched = body.jet(-Direction::Z);
//! assert_eq!((touched.point, touched.value), (DVec3::new(0.0, 0.0, -0.02), 0.02));
//! // How far the contact moves for a small turn of the palm: the radii of curvature, here 0.04^2 / 0.02 and 0.05^2 / 0.02.
//! let radii = principal_radii(touched.hessian, -Direction::Z);
//! assert!((radii[0] - 0.08).abs() < 1e-15 && (radii[1] - 0.125).abs() < 1e-15);
//! // And over the whole surface, guaranteed: smooth and strictly convex.
//! let all = check_convex(&body)?;
//! assert!(all.min <= 0.02 * 0.02 / 0.05 && radii[1] <= all.max * (1.0 + 1e-15));
//! # Ok(())
//! # }
//! ```
//!
//! Then [`PalmSurface`] for palms of any shape, [`ThreeContacts`] for three flat ones, [`ContactCurve`] for what contacts trace on the body,
//! [`planar`] for the plane.
//!
//! Frames: `W` world (Z up), `O` object, `P_i` palm `i`. Units: SI.

#![cfg_attr(docsrs, feature(doc_cfg))]

mod at_once;
mod contact;

mod motion_law;
mod palm;
pub mod planar;
mod stop;
mod support;
mod surface;

pub use at_once::{at_once, in_parts};
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

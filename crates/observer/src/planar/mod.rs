//! Shape and motion from touch in the plane (paper, section 3): from forces ([`estimate_plane`]), from contacts alone ([`fit_shape`]), for slow
//! palms ([`quasistatic_reconstruction`]); and the paper's own vector fields ([`AuthorsFields`])
//! with their observability by Lie derivatives ([`AuthorsFields::observability`]).
//!
//! Conventions as in [`contact_kinematics::planar`] and [`object_dynamics::planar`].
//!
//! ```
//! use contact_kinematics::planar::FourierBody;
//! use object_dynamics::planar::{ConstantRates, PlanarMass, PlanarObject, PlanarStart, simulate_prescribed};
//! use observer::contacts::ContactNoiseLevel;
//! use observer::planar::{PlaneOptions, estimate_plane};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // What two palms without friction sense of 200 g that turn between them, for a second and a half.
//! let shape = FourierBody::new(&[0.04, 0.003, 0.0045, 0.0006], &[0.0, -0.002, 0.001, -0.0008])?;
//! let mass = PlanarMass::from_gyration(0.2, 0.000_729)?;
//! let motion = ConstantRates { angles: [0.785, 1.571], rates: [0.2, 0.0] };
//! let times: Vec<f64> = (0..=350).map(|k| f64::from(k) * 4e-3).collect();
//! let object = PlanarObject { shape, mass, gravity: 9.81 };
//! let run = simulate_prescribed(&object, &motion, PlanarStart { phi0: 5.85, omega0: 6.0 }, &times, 1e-12)?;
//! let log = run.log()?.contact_log([0.0; 2]).ok_or("no force")?;
//!
//! let noise = ContactNoiseLevel { contact: 0.0, force_fixed: 0.0, force_share: 0.0, impulse: None, floor: 2e-5 };
//! let options = PlaneOptions::new(noise, 9.81, vec![Some(0.0); 2]);
//! let found = estimate_plane(&log, &options)?;
//! assert!((found.mass.0 - 0.2).abs() < 1e-3);
//! assert!((found.states[0].omega0 - 6.0).abs() < 1e-2);
//! # Ok(())
//! # }
//! ```

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
    estimate_plane_from, plane_noise,
};
pub use observability::{LONGEST_CHAIN, LieField, NaturalUnits, Observability};
pub use quasistatic::{
    HeightFit, QuasistaticError, QuasistaticPath, QuasistaticPoint, height_from_closure,
    quasistatic_reconstruction,
};
pub use shape_fit::{ShapeFit, ShapeFitOptions, fit_shape};

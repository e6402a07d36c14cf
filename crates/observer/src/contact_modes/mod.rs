//! Whether contacts slide, stick or are off, sample by sample, and how sure that is: from forces and, where there is one, an
//! estimate of the slip.
//!
//! Each mode gives a density of the same outputs (`density.rs`), and remembers what changes slowly: sliding its speed, sticking
//! the ratio of friction to normal force, on bins (`bins.rs`, `steps.rs`, `chain.rs`; what a sample says in each, `likelihood.rs`). A friction that is not known is carried
//! as a grid (`friction.rs`, `contact.rs`), of which those are followed that are near the ratio (`asleep.rs`); where in its bin a ratio is, those before it say (`foretold.rs`). Slips of several contacts share the error of one twist (`twist.rs`).
//! What is left of readings where modes are told is held against their noise (`doubt.rs`), and whether forces go better
//! with slips of before is followed beside them (`late.rs`). `classifier.rs` is the way of a sample.
//!
//! ```
//! use nalgebra::{Matrix2, Vector2};
//! use observer::contact_modes::{ContactFriction, ContactModes, ContactModesOptions, ContactReading, ContactSeen, ContactSlip};
//! # fn main() -> Result<(), observer::contact_modes::ContactModesError> {
//! let options = ContactModesOptions::new(0.6, 0.01, 1.0);
//! let mut modes = ContactModes::new(&[ContactFriction::Known(0.3)], options)?;
//! let slip = ContactSlip { velocity: Vector2::new(-0.05, 0.0), covariance: Matrix2::identity() * 4e-6 };
//! let (normal_force, friction, force_deviation) = (2.0, Vector2::new(0.6, 0.0), 0.04);
//! let reading = ContactReading { normal_force, friction, force_deviation, slip: Some(slip), touches: false };
//! for _ in 0..5 {
//!     modes.push(1e-3, &[ContactSeen::Read(reading)])?;
//! }
//! assert!(modes.odds(0).is_some_and(|odds| odds.slide > 0.99));
//! # Ok(())
//! # }
//! ```

mod asleep;
mod bins;
mod chain;
mod checked;
mod classifier;
mod contact;
mod density;
mod doubt;
mod error;
mod foretold;
mod friction;
mod late;
mod likelihood;
pub(crate) mod normal;
mod options;
mod passage;
mod reading;
mod steps;
#[cfg(test)]
mod tests;
mod twist;
mod whole;

pub use classifier::{ContactModes, ContactOdds};
pub use doubt::{ContactModesDoubt, DoubtedReading};
pub use error::ContactModesError;
pub use friction::{ContactFriction, LearnedFriction};
pub use options::ContactModesOptions;
pub use reading::{ContactReading, ContactSeen, ContactSlip};
pub use twist::TwistError;
pub use whole::{WholeModes, whole_modes};

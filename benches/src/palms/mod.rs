//! Flat, convex and concave palms on seeded bodies: the runs behind the study `palms` and its charts.

mod body;
mod coverage;
mod gap;
mod hold;
mod paired;
mod rest;
mod run;
mod shape;
#[cfg(test)]
mod tests;
mod told;

pub use body::{FLATTEST, PalmBody, SIZE, palm_body};
pub use coverage::{Coverage, NEAR};
pub use gap::{GapOfContacts, contact_at};
pub use hold::{GRAVITY, Held, HoldError, MOTION, Motion, PalmKind, held};
pub use paired::{Interval, median_of, paired};
pub use rest::lowest;
pub use run::{ESTIMATED, End, LOOKS, LOST, PalmRun, PalmRunError, palm_run, radians};
pub use shape::PalmShape;
pub use told::{NOISE, Told, told};

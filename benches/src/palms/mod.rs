//! Flat, convex and concave palms on seeded bodies: the runs behind the study `palms` and its charts.

mod body;
mod hold;
mod rest;
mod shape;

pub use body::{FLATTEST, PalmBody, SIZE, palm_body};
pub use hold::{GRAVITY, Held, HoldError, Motion, PalmKind, held};
pub use rest::lowest;
pub use shape::PalmShape;

//! Contacts of bodies whose noise is not what is stated, and the way from them to bounds.

mod bodies;
mod judge;
mod noise;

pub use bodies::Body;
pub use judge::{Bounded, Levels, Tally, bounded, cleaned};
pub use noise::{Case, Course, TrueNoise, WrongContacts};

//! Contacts of a body with three palms: where they are, how they move, and what the palms' sensors say of it.

mod curve;
mod forward;
mod sensed;

pub use curve::{ContactCurve, CurveError, CurvePoint, Darboux, darboux};
pub use forward::{Contact, ContactRates, ThreeContacts};
pub use sensed::{
    ContactSupport, acceleration_defect, body_normal, body_normal_rate, contact_curve_rates,
    contact_velocity, radius_rate, separation_rates,
};

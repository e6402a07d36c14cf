//! Why contact modes cannot be told.

use crate::bank::BankError;
use thiserror::Error;

/// Why contact modes cannot be told. Contacts and samples are counted from zero. A sample that is refused leaves everything as
/// it was before.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactModesError {
    /// There is no contact.
    #[error("there is no contact; state the friction of at least one")]
    NoContact,
    /// A sample has another number of contacts than were stated.
    #[error(
        "sample {sample} has {what} of {found} contact(s), and the friction of {needed} was stated; give one for each contact, \
         `ContactSeen::Missing` where nothing was read"
    )]
    Contacts {
        /// What was given for each contact.
        what: &'static str,
        /// The sample.
        sample: usize,
        /// As given.
        found: usize,
        /// As stated.
        needed: usize,
    },
    /// A contact has another number of samples than there are times.
    #[error(
        "contact {contact} has {found} sample(s), and there are {samples} times; give one for each, `ContactSeen::Missing` where nothing was read"
    )]
    Samples {
        /// The contact.
        contact: usize,
        /// As given.
        found: usize,
        /// Times that were given.
        samples: usize,
    },
    /// A coefficient of friction is not usable.
    #[error("friction of contact {contact} is {value}; it must be from 1e-3 to 10, or unknown")]
    Friction {
        /// The contact.
        contact: usize,
        /// As given.
        value: f64,
    },
    /// A setting is not usable.
    #[error("{what} is {value}; it must be {needed}")]
    Option {
        /// What the number is.
        what: &'static str,
        /// As given.
        value: f64,
        /// What it has to be.
        needed: &'static str,
    },
    /// A time step is not usable.
    #[error("the time step before sample {sample} is {value} s; time must go on, by less than 1000 s")]
    TimeStep {
        /// The sample.
        sample: usize,
        /// As given, s.
        value: f64,
    },
    /// A reading is not a number, or infinite.
    #[error(
        "{what} of contact {contact} at sample {sample} is {value}; leave a reading that is missing out (`Missing`, `None`)"
    )]
    NotFinite {
        /// What was read.
        what: &'static str,
        /// The contact.
        contact: usize,
        /// The sample.
        sample: usize,
        /// As given.
        value: f64,
    },
    /// A noise is not positive.
    #[error(
        "{what} of contact {contact} at sample {sample} is {value}; it must be above zero, for nothing is read exactly"
    )]
    Noise {
        /// What noise.
        what: &'static str,
        /// The contact.
        contact: usize,
        /// The sample.
        sample: usize,
        /// As given.
        value: f64,
    },
    /// A reading is beyond what any sensor tells from its noise.
    #[error(
        "{what} of contact {contact} at sample {sample} is {value} of its units of comparison; it must be at most {most}: look \
         for a unit or a noise that is off"
    )]
    Range {
        /// What was read, and in which units.
        what: &'static str,
        /// The contact.
        contact: usize,
        /// The sample.
        sample: usize,
        /// In these units.
        value: f64,
        /// The largest that is taken.
        most: f64,
    },
    /// The covariance of the shared error of the twist is none.
    #[error(
        "the covariance of the twist's error at sample {sample} is not symmetric and positive definite; state variances above zero"
    )]
    TwistCovariance {
        /// The sample.
        sample: usize,
    },
    /// The label cannot be made.
    #[error(transparent)]
    Label(#[from] BankError),
}

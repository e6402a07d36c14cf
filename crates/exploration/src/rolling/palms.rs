//! What palms do and feel.

use glam::DVec2;
use shape_bounds::planar::ContactSample;
use thiserror::Error;

/// Contacts are read whenever a palm has turned by so many rad.
pub(super) const SENSED: f64 = 0.05;
/// Contacts are predicted in steps of so many rad: cells are not much smaller.
pub(super) const PREDICTED: f64 = 0.1;

/// What is felt at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// Absolute angles of the palms, rad.
    pub palms: [f64; 2],
    /// Orientation of the body in rad, full turns counted.
    pub phi: f64,
    /// Contacts on palm 1 and 2, in the frame of the body.
    pub contacts: [ContactSample; 2],
    /// Distances of the contacts from the hinge, m.
    pub s: [f64; 2],
    /// Whether the body fell since the reading before.
    pub fell: bool,
}

impl Reading {
    /// Where the lines of force meet, body axes: the centre of mass is above or below it. None if they do not.
    #[must_use]
    pub fn meeting(&self) -> Option<DVec2> {
        let [a, b] = self.contacts;
        let (n, m) = (a.normal.get(), b.normal.get());
        let across = n.perp_dot(m);
        let met = a.point + n * ((b.point - a.point).perp_dot(m) / across);
        met.is_finite().then_some(met)
    }
}

/// Why nothing is felt.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PalmsError {
    /// The body left a palm.
    #[error("contact on palm {palm} is {s:.4} m from the hinge, beyond its end at {length} m")]
    Off {
        /// From 1.
        palm: usize,
        /// In m.
        s: f64,
        /// Of the palm, m.
        length: f64,
    },
    /// The palms enclose no wedge, or an angle is not a number.
    #[error("palms at {} and {} rad enclose no wedge", palms[0], palms[1])]
    Wedge {
        /// As asked for, rad.
        palms: [f64; 2],
    },
    /// A contact that is not finite.
    #[error("palm {palm} felt a contact that is not finite")]
    NotFinite {
        /// From 1.
        palm: usize,
    },
}

/// Two palms with a body between them.
pub trait Palms {
    /// What is felt now.
    ///
    /// # Errors
    /// [`PalmsError`].
    fn feel(&mut self) -> Result<Reading, PalmsError>;

    /// Turns the palms to absolute angles (rad) on the straight way, and feels.
    ///
    /// # Errors
    /// [`PalmsError`].
    fn turn(&mut self, to: [f64; 2]) -> Result<Reading, PalmsError>;
}

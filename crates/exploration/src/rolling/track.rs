//! Where palms and body are, and what the rests so far tell of the centre of mass.

use super::dynamics::Dynamics;
use super::palms::Reading;
use glam::{DMat2, DVec2};

/// What a planner knows beside the contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// Absolute angles of the palms, rad.
    pub palms: [f64; 2],
    /// Orientation of the body, rad.
    pub phi: f64,
    /// How often it fell so far.
    pub falls: usize,
    /// Sums over readings of `m m^T` and `m (m . P)`, with the horizontal `m` in body axes and the point `P` where the forces meet.
    sums: (DMat2, DVec2),
    /// Centre of mass in body axes, m, where it is known.
    centre: Option<DVec2>,
    /// Of palms that do not wait until the body rests: how it moves.
    pub dynamics: Option<Dynamics>,
}

/// Weight of where the centre of mass is thought to be beforehand against one reading of the line that it is on.
const PRIOR: f64 = 1e-3;

impl Track {
    /// After the first reading.
    #[must_use]
    pub fn new(reading: &Reading) -> Self {
        let sums = (DMat2::ZERO, DVec2::ZERO);
        let (palms, phi) = (reading.palms, reading.phi);
        let mut track = Self { palms, phi, falls: 0, sums, centre: None, dynamics: None };
        track.follow(reading);
        track
    }

    /// Of palms at absolute angles and a body at the orientation `phi` (rad) with its centre of mass at `centre` (m, body axes) that moves so; at
    /// rest without.
    #[must_use]
    pub fn about(palms: [f64; 2], phi: f64, centre: DVec2, dynamics: Option<Dynamics>) -> Self {
        Self { palms, phi, falls: 0, sums: (DMat2::ZERO, DVec2::ZERO), centre: Some(centre), dynamics }
    }

    /// After another one. At rest the weight passes through the point where the forces meet: a line that the centre of mass is on.
    pub fn follow(&mut self, reading: &Reading) {
        (self.palms, self.phi) = (reading.palms, reading.phi);
        self.falls += usize::from(reading.fell);
        if let Some(met) = reading.meeting() {
            let level = DVec2::from_angle(-reading.phi);
            self.sums.0 += DMat2::from_cols(level * level.x, level * level.y);
            self.sums.1 += level * level.dot(met);
        }
    }

    /// Where the centre of mass is (m, body axes) if it would be at `guess` for all that is known beforehand.
    #[must_use]
    pub fn centre(&self, guess: DVec2) -> DVec2 {
        if let Some(centre) = self.centre {
            return centre;
        }
        let system = self.sums.0 + DMat2::from_diagonal(DVec2::splat(PRIOR));
        system.inverse() * (self.sums.1 + guess * PRIOR)
    }
}

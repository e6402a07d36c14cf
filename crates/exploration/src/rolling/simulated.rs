//! Palms with a body that is computed.

use super::balance::{Balance, FALL, Rest, RollingBody, settle};
use super::palms::{Palms, PalmsError, Reading, SENSED};
use super::workspace::{along, pair};
use crate::random::Source;
use glam::DVec2;
use shape_bounds::exact_hull::planar::Direction;
use shape_bounds::planar::ContactSample;

/// A body at rest between palms, felt with seeded normal noise.
pub struct SimulatedPalms<B> {
    body: B,
    length: f64,
    palms: [f64; 2],
    rest: Rest,
    point: f64,
    normal: f64,
    source: Source,
}

impl<B: RollingBody> SimulatedPalms<B> {
    /// A body that is let go at the orientation `phi` (rad) between palms of `length` (m) at absolute angles (rad).
    ///
    /// # Errors
    /// [`PalmsError::Wedge`] where it comes to rest nowhere.
    pub fn new(body: B, length: f64, palms: [f64; 2], phi: f64) -> Result<Self, PalmsError> {
        let wedge = PalmsError::Wedge { palms };
        let rest = settle(&body, &pair(palms).ok_or(wedge)?, phi).ok_or(wedge)?;
        Ok(Self { body, length, palms, rest, point: 0.0, normal: 0.0, source: Source::new(0) })
    }

    /// With normal noise: standard deviations of a point per axis, in m, and of a normal, in rad.
    #[must_use]
    pub fn with_noise(self, point: f64, normal: f64, seed: u64) -> Self {
        Self { point, normal, source: Source::new(seed), ..self }
    }

    fn read(&mut self, fell: bool) -> Result<Reading, PalmsError> {
        let palms = self.palms;
        let wedge = pair(palms).ok_or(PalmsError::Wedge { palms })?;
        let balance = Balance::at(&self.body, &wedge, self.rest.phi);
        if let Some(i) = balance.s.iter().position(|s| *s > self.length) {
            return Err(PalmsError::Off { palm: i + 1, s: balance.s[i], length: self.length });
        }
        let mut felt = |i: usize| {
            let tilt = self.source.normal() * self.normal;
            let off = DVec2::new(self.source.normal(), self.source.normal()) * self.point;
            let point = balance.points[i] + off;
            let normal = Direction::from_angle(balance.thetas[i] + tilt);
            let finite = point.is_finite() && normal.get().is_finite();
            if finite {
                Ok(ContactSample { point, normal })
            } else {
                Err(PalmsError::NotFinite { palm: i + 1 })
            }
        };
        let contacts = [felt(0)?, felt(1)?];
        Ok(Reading { palms, phi: self.rest.phi, contacts, s: balance.s, fell })
    }
}

impl<B: RollingBody> Palms for SimulatedPalms<B> {
    fn feel(&mut self) -> Result<Reading, PalmsError> {
        self.read(false)
    }

    fn turn(&mut self, to: [f64; 2]) -> Result<Reading, PalmsError> {
        let mut fell = false;
        for palms in along(self.palms, to, SENSED) {
            let wedge = PalmsError::Wedge { palms };
            self.rest = settle(&self.body, &pair(palms).ok_or(wedge)?, self.rest.phi).ok_or(wedge)?;
            fell |= self.rest.turned > FALL;
            self.palms = palms;
        }
        self.read(fell)
    }
}

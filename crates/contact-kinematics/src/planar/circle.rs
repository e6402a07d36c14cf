//! Disc with its centre anywhere against the centre of mass.

use super::error::ShapeError;
use super::radius::{RadiusBounds, RadiusFunction, RadiusJet, point_jet};
use glam::DVec2;

/// A disc of radius `R` whose centre lies at `centre` from the centre of mass: `r = R + centre . n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    radius: f64,
    centre: DVec2,
}

impl Circle {
    /// From radius and centre (m, body axes from the centre of mass).
    ///
    /// # Errors
    /// [`ShapeError::Length`] or [`ShapeError::NotFinite`].
    pub fn new(radius: f64, centre: DVec2) -> Result<Self, ShapeError> {
        check_length("radius", radius)?;
        check_point("centre coordinate", centre)?;
        Ok(Self { radius, centre })
    }
}

impl RadiusFunction for Circle {
    fn jet(&self, theta: f64) -> RadiusJet {
        RadiusJet { r: self.radius, d: 0.0, rho: self.radius } + point_jet(self.centre, theta)
    }

    fn radius_bounds(&self) -> RadiusBounds {
        RadiusBounds { min: self.radius, max: self.radius }
    }
}

pub(super) fn check_length(what: &'static str, value: f64) -> Result<(), ShapeError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ShapeError::Length { what, value }) }
}

pub(super) fn check_point(what: &'static str, p: DVec2) -> Result<(), ShapeError> {
    match (0..2).find(|&i| !p[i].is_finite()) {
        Some(index) => Err(ShapeError::NotFinite { what, index, value: p[index] }),
        None => Ok(()),
    }
}

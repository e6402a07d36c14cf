//! Where a body touches a palm: the normal at which the distance of body and palm is stationary.
//!
//! With `D = p_WP - p_WCm` in body axes, `G(theta) = n(theta) . D - r(theta)` is the distance of the palm's centre
//! from the body's tangent line. Its largest value is the centre's distance from the body (arc); minus its smallest
//! is the distance of the body's farthest point (cup). `G' = -(t . D - d)` and `G'' = -(G + rho)`.

use super::{BodyPlace, ContactError, PalmSurface, SurfaceState};
use crate::planar::radius::{RadiusFunction, RadiusJet};
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Newton's method takes 3 to 6 steps; bisection of a bracket of [`LONGEST_STEP`] ends after 55.
const MOST_STEPS: u32 = 80;
/// Steps in rad by which a bracket is looked for: the first is that of a warm start, and each doubles up to the
/// longest.
const FIRST_STEP: f64 = 0.01;
const LONGEST_STEP: f64 = 0.3;
/// Directions of the search over a whole turn, for starts from which Newton's method found a stationary value that is
/// not proved to be the one.
const SCAN: u32 = 128;
/// An offset below this many units of rounding of its terms is rounding.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

pub(super) struct Found {
    pub(super) gap: f64,
    pub(super) theta: f64,
    pub(super) jet: RadiusJet,
}

pub(super) fn find(
    shape: &(impl RadiusFunction + ?Sized),
    place: &BodyPlace,
    surface: PalmSurface,
    palm: &SurfaceState,
    guess: Option<f64>,
) -> Result<Found, ContactError> {
    let D = palm.p_WP - place.p_WCm;
    if !(D.is_finite() && palm.angle.is_finite() && place.phi0.is_finite()) {
        return Err(ContactError::NotFinite);
    }
    let D_O = DVec2::from_angle(-place.phi0).rotate(D);
    match surface {
        PalmSurface::Line => {
            let theta = palm.angle - FRAC_PI_2 - place.phi0;
            let jet = shape.jet(theta);
            let outward = -DVec2::from_angle(palm.angle).perp();
            Ok(Found { gap: outward.dot(D) - jet.r, theta, jet })
        }
        PalmSurface::Arc { radius } => {
            let now = Search { shape, D_O, sign: 1.0 }.run(guess, D_O.to_angle())?;
            if now.distance <= 0.0 {
                return Err(ContactError::CentreInside { depth: -now.distance });
            }
            Ok(Found { gap: now.distance - radius, theta: now.theta, jet: now.jet })
        }
        PalmSurface::Cup { radius } => {
            let now = Search { shape, D_O, sign: -1.0 }.run(guess, (-D_O).to_angle())?;
            Ok(Found { gap: radius + now.distance, theta: now.theta, jet: now.jet })
        }
    }
}

/// Search for the largest (`sign = 1`) or smallest (`-1`) value of `G`.
struct Search<'a, S: ?Sized> {
    shape: &'a S,
    D_O: DVec2,
    sign: f64,
}

struct Trial {
    theta: f64,
    jet: RadiusJet,
    /// `G`.
    distance: f64,
    /// `-sign G'`, which rises through zero where `G` is what is looked for.
    offset: f64,
    /// Its derivative.
    stiffness: f64,
    /// Rounding of `offset`.
    noise: f64,
}

impl<S: RadiusFunction + ?Sized> Search<'_, S> {
    fn run(&self, guess: Option<f64>, cold: f64) -> Result<Trial, ContactError> {
        let now = self.settle(guess.filter(|theta| theta.is_finite()).unwrap_or(cold));
        match now {
            Ok(now) if self.is_proved(&now) => Ok(now),
            _ => self.search(),
        }
    }

    /// Whether a stationary value is the extreme one. A positive distance is: `G` is concave wherever it is positive.
    /// So is that of a farthest point beyond every radius of curvature: the body lies inside of the circle through it
    /// (Blaschke).
    fn is_proved(&self, now: &Trial) -> bool {
        if self.sign > 0.0 { now.distance > 0.0 } else { -now.distance >= self.shape.radius_bounds().max }
    }

    /// The best of the stationary values that are reached from every direction that can be nearest to the best: it
    /// lies within half a step of one of the directions, and gives up less than `G''` allows on the way there.
    fn search(&self) -> Result<Trial, ContactError> {
        let step = TAU / f64::from(SCAN);
        let values: Vec<(f64, f64)> = (0..SCAN)
            .map(|i| f64::from(i) * step)
            .map(|theta| (theta, self.sign * self.trial(theta).distance))
            .collect();
        let best = values.iter().fold(f64::NEG_INFINITY, |best, (_, value)| best.max(*value));
        let most = values.iter().fold(0.0, |most: f64, (_, value)| most.max(value.abs()));
        // `G` between two directions exceeds `most` by less than a thousandth of the sum.
        let bend = 1.001 * (most + self.shape.radius_bounds().max);
        let near = values.iter().filter(|(_, value)| best - value <= 0.125 * step * step * bend);
        let mut found: Result<Trial, ContactError> =
            Err(ContactError::NotFound { iterations: 0, offset: f64::NAN });
        for (theta, _) in near {
            let now = self.settle(*theta)?;
            let better = match &found {
                Ok(found) => self.sign * now.distance > self.sign * found.distance,
                Err(_) => true,
            };
            if better {
                found = Ok(now);
            }
        }
        found
    }

    fn trial(&self, theta: f64) -> Trial {
        let jet = self.shape.jet(theta);
        let n = DVec2::from_angle(theta);
        let distance = n.dot(self.D_O) - jet.r;
        let noise =
            ROUNDING * (self.D_O.length() + jet.r.abs() + jet.d.abs() + jet.rho * (1.0 + theta.abs()));
        Trial {
            theta,
            jet,
            distance,
            offset: self.sign * (-n.perp().dot(self.D_O) - jet.d),
            stiffness: self.sign * (distance + jet.rho),
            noise,
        }
    }

    /// Newton's method from `start` on, kept in a bracket in which the offset changes sign.
    fn settle(&self, start: f64) -> Result<Trial, ContactError> {
        let mut now = self.trial(start);
        let (mut low, mut high) = self.bracket(&now);
        for _ in 0..MOST_STEPS {
            if now.offset.abs() <= now.noise {
                return Ok(now);
            }
            if now.offset < 0.0 {
                low = now.theta
            } else {
                high = now.theta
            }
            let newton = now.theta - now.offset / now.stiffness;
            let inside = now.stiffness > 0.0 && newton > low && newton < high;
            let next = if inside { newton } else { 0.5 * (low + high) };
            if next == now.theta || high - low <= f64::EPSILON * (1.0 + low.abs()) {
                return Ok(now);
            }
            now = self.trial(next);
        }
        Err(ContactError::NotFound { iterations: MOST_STEPS, offset: now.offset.abs() })
    }

    /// Directions around `start` between which the offset rises through zero. It does so within a turn, as `G` is
    /// periodic.
    fn bracket(&self, start: &Trial) -> (f64, f64) {
        let up = if start.offset < 0.0 { 1.0 } else { -1.0 };
        let (mut inner, mut step, mut gone) = (start.theta, FIRST_STEP, 0.0);
        while gone < TAU {
            let outer = inner + up * step;
            if self.trial(outer).offset * up >= 0.0 {
                return (inner.min(outer), inner.max(outer));
            }
            (inner, gone, step) = (outer, gone + step, (2.0 * step).min(LONGEST_STEP));
        }
        (start.theta.min(inner), start.theta.max(inner))
    }
}

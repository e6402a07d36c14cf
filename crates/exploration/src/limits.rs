//! Which directions of touch can be reached.

use crate::heading::Heading;
use std::f64::consts::PI;
use thiserror::Error;

/// All directions within an angle of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<H> {
    /// The axis.
    pub axis: H,
    /// The angle in rad, in [0, pi].
    pub half_angle: f64,
}

/// Directions that can be reached: those in one of the cones (everywhere if there are none), and in none of those that are forbidden.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits<H> {
    within: Vec<Cone<H>>,
    without: Vec<Cone<H>>,
}

/// Why limits are none.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LimitsError {
    /// An angle that is none.
    #[error("cone {index} of the limits: half angle {half_angle} rad must be from 0 to pi")]
    Angle {
        /// Which cone, the allowed ones first.
        index: usize,
        /// As given, in rad.
        half_angle: f64,
    },
    /// Nothing is left.
    #[error(
        "the limits contradict each other: no direction of {tried} spread evenly is in an allowed cone and in no forbidden \
         one; widen the first or narrow the second"
    )]
    Contradiction {
        /// Directions that were tried.
        tried: usize,
    },
}

/// Directions by which it is found whether any are left: some 2 degrees apart in space.
const TRIED: usize = 10_000;
/// A direction this far beyond the rim of a cone, in rad, is on it: rounding of the angle.
const RIM: f64 = 1e-9;
/// A direction is moved this far past the rim of a forbidden cone, in rad.
const PAST: f64 = 1e-8;

impl<H: Heading> Default for Limits<H> {
    fn default() -> Self {
        Self { within: Vec::new(), without: Vec::new() }
    }
}

impl<H: Heading> Limits<H> {
    /// Directions in one of `within` (everywhere if it is empty) and in none of `without`.
    ///
    /// # Errors
    /// [`LimitsError`] for angles that are none and limits that leave no direction.
    pub fn new(within: Vec<Cone<H>>, without: Vec<Cone<H>>) -> Result<Self, LimitsError> {
        for (index, cone) in within.iter().chain(&without).enumerate() {
            if !(0.0..=PI).contains(&cone.half_angle) {
                return Err(LimitsError::Angle { index, half_angle: cone.half_angle });
            }
        }
        let limits = Self { within, without };
        let some_axis = limits.within.iter().any(|cone| limits.allow(cone.axis));
        if !some_axis && !H::spread(TRIED).into_iter().any(|heading| limits.allow(heading)) {
            return Err(LimitsError::Contradiction { tried: TRIED });
        }
        Ok(limits)
    }

    /// Whether nothing is forbidden.
    #[must_use]
    pub fn are_none(&self) -> bool {
        self.within.is_empty() && self.without.is_empty()
    }

    /// Whether a direction can be reached.
    #[must_use]
    pub fn allow(&self, heading: H) -> bool {
        let off = |cone: &Cone<H>| cone.axis.angle_to(heading) - cone.half_angle;
        let inside = self.within.is_empty() || self.within.iter().any(|cone| off(cone) <= RIM);
        inside && self.without.iter().all(|cone| off(cone) > 0.0)
    }

    /// The direction itself if it can be reached, else one near it that can, if one is found on the rim of a cone.
    #[must_use]
    pub fn nearest(&self, heading: H) -> Option<H> {
        if self.allow(heading) {
            return Some(heading);
        }
        let onto = |cone: &Cone<H>, beyond: f64| {
            cone.axis.turned_towards(heading, (cone.half_angle + beyond).clamp(0.0, PI))
        };
        let rims = self.within.iter().map(|cone| onto(cone, 0.0));
        let out = self.without.iter().map(|cone| onto(cone, PAST));
        let axes = self.within.iter().map(|cone| cone.axis);
        rims.chain(out)
            .chain(axes)
            .filter(|h| self.allow(*h))
            .min_by(|a, b| a.angle_to(heading).total_cmp(&b.angle_to(heading)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact_kinematics::Direction;
    use glam::DVec3;

    fn cone(axis: Direction, half_angle: f64) -> Cone<Direction> {
        Cone { axis, half_angle }
    }

    #[test]
    fn what_is_out_of_reach_is_moved_to_the_rim() {
        let limits = Limits::new(vec![cone(Direction::Z, 1.0)], vec![cone(Direction::Z, 0.2)]).unwrap();
        let below = limits.nearest(Direction::new(DVec3::new(1.0, 0.0, -1.0)).unwrap()).unwrap();
        assert!((below.angle_to(Direction::Z) - 1.0).abs() < 1e-9 && below.get().x > 0.0);
        let top = limits.nearest(Direction::new(DVec3::new(0.01, 0.0, 1.0)).unwrap()).unwrap();
        assert!((top.angle_to(Direction::Z) - 0.2).abs() < 1e-7 && limits.allow(top));
    }

    #[test]
    fn limits_that_leave_nothing_are_refused() {
        let contradiction = Limits::new(vec![cone(Direction::Z, 0.5)], vec![cone(Direction::Z, 0.6)]);
        assert!(matches!(contradiction, Err(LimitsError::Contradiction { .. })));
        for angle in [-0.1, 4.0, f64::NAN] {
            let none = Limits::new(vec![], vec![cone(Direction::Z, angle)]);
            assert!(matches!(none, Err(LimitsError::Angle { index: 0, .. })));
        }
    }
}

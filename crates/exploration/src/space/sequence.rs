//! Directions that are spread evenly however many are taken.

use contact_kinematics::Direction;
use glam::DVec3;
use std::f64::consts::TAU;

/// The root of `x^3 = x + 1`, the plastic number.
const PLASTIC: f64 = 1.324_717_957_244_746;

/// Direction `k` of the low-discrepancy sequence R2 (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018) on the
/// sphere, by Archimedes's map, which keeps areas.
#[must_use]
pub fn low_discrepancy(k: usize) -> Direction {
    let share = |rate: f64| (0.5 + rate * (k + 1) as f64).fract();
    let z = 1.0 - 2.0 * share(1.0 / PLASTIC);
    let (sin, cos) = (TAU * share(1.0 / (PLASTIC * PLASTIC))).sin_cos();
    let across = (1.0 - z * z).max(0.0).sqrt();
    // A unit vector by construction.
    Direction::new_unchecked(DVec3::new(across * cos, across * sin, z))
}

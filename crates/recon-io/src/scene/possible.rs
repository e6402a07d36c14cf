//! Numbers that are possible one by one, and together belong to no object that palms hold: wrong units, as a rule.

use super::{Scene, SceneErrorKind as Kind, Simulation};
use glam::DVec3;
use recon::contact_kinematics::{Direction, SupportFunction};

/// Masses between which an object is one that is felt: from a grain of dust to a ship, kg.
const MASSES: std::ops::RangeInclusive<f64> = 1e-9..=1e9;
/// Greatest speed of an object at the start, m/s, and its greatest angular velocity, rad/s.
const FASTEST: f64 = 1e3;
const FASTEST_SPIN: f64 = 1e4;
/// Greatest gravity, m/s^2: that of a fast centrifuge.
const STRONGEST: f64 = 1e3;
/// Rounding of what a moment of inertia is made from, as a share.
const ROUNDING: f64 = 1e-6;

/// Gravity in m/s^2.
pub(super) fn gravity(value: f64) -> Result<f64, Kind> {
    let must = "zero or above, and at most 1e3: check its unit, which is m/s^2";
    Kind::check("gravity", value, must, |gravity| (0.0..=STRONGEST).contains(&gravity))
}

/// A mass in kg.
pub(super) fn mass(value: f64) -> Result<f64, Kind> {
    let must = "above zero: from 1e-9 to 1e9; check its unit, which is kg";
    Kind::check("object.mass", value, must, |mass| MASSES.contains(&mass))
}

/// The start of a simulation.
pub(super) fn start(simulation: &Simulation) -> Result<(), Kind> {
    let spin = simulation.w_WO.length();
    let must = "at most 1e4: check its unit, which is rad/s";
    Kind::check("simulation.angular_velocity (its length)", spin, must, |w| w <= FASTEST_SPIN)?;
    let must = "at most 1e3: check its unit, which is m/s";
    Kind::check("simulation.velocity (its length)", simulation.v_WCm.length(), must, |v| v <= FASTEST)?;
    Ok(())
}

/// No body has mass outside of its surface: the second moment along an axis over the mass is at most the square of how far the shape
/// reaches along it. A shape that is none is told where it is made.
pub(super) fn inertia_within_shape(scene: &Scene) -> Result<(), Kind> {
    let (Some(simulation), Ok(Some(mass))) = (&scene.simulation, scene.mass_properties()) else {
        return Ok(());
    };
    let Ok(body) = simulation.body() else { return Ok(()) };
    let principal = mass.principal();
    let half = 0.5 * principal.moments.element_sum();
    for (moment, axis) in principal.moments.to_array().into_iter().zip(DVec3::AXES) {
        let Ok(axis) = Direction::new(principal.axes * axis) else { continue };
        let reach = body.value(axis).max(body.value(Direction::new_unchecked(-axis.get())));
        let spread = ((half - moment).max(0.0) / mass.mass()).sqrt();
        if spread > reach * (1.0 + ROUNDING) {
            return Err(Kind::MassOutside { mass: mass.mass(), spread, reach });
        }
    }
    Ok(())
}

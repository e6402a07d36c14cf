//! Three palms without friction in minimal coordinates, against multipliers.

use super::super::judged::Ran;
use super::super::spatial::scene::{Scene, Spec};
use super::super::{Failure, Method, Way};
use super::{TOLERANCE, allowed, largest};
use crate::multipliers::by_multipliers;
use glam::{DQuat, DVec3};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{InitialMotion, SimulationError};

/// Tolerance of the other way.
const FINE: f64 = 1e-13;

pub(in super::super) const METHOD: Method = Method {
    name: "simulation, three palms",
    about: "minimal coordinates at a tolerance of 1e-9, over ten natural times or to the loss of contact; right: poses within ten thousand tolerances (sizes, rad) of those by multipliers at 1e-13, or within ten times what a start that is a tolerance off comes to: long motions amplify errors",
    ways: {
        use Way::*;
        &[
            Parallel, Flat, Steep, Sphere, Revolution, Pole, Relative, Force, Slow, Rate, Shaking, Long,
            Size, Tolerance,
        ]
    },
    seeds: 30,
    every: 1,
    run,
};

/// How far two poses are apart, in sizes and rad, whichever is more.
fn apart((p, q): (DVec3, DQuat), (p_of, q_of): (DVec3, DQuat), size: f64) -> f64 {
    let turn = q * q_of.inverse();
    let angle = 2.0 * DVec3::new(turn.x, turn.y, turn.z).length().atan2(turn.w.abs());
    (p.distance(p_of) / size).max(angle)
}

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let scene = Scene::drawn(Spec::of(way, strength), seed)?;
    let tolerance = if way == Way::Tolerance { strength } else { TOLERANCE };
    let (times, size) = (scene.times(), scene.of.size);
    let poses = |start: InitialMotion| -> Result<Vec<(DVec3, DQuat)>, _> {
        let run = scene.scene.simulate(start, times, self::Tolerance::uniform(tolerance))?;
        Ok::<_, SimulationError>(run.instants.iter().map(|now| (now.touch.p_WCm, now.R_WO)).collect())
    };
    let run = match poses(scene.start) {
        Ok(run) => run,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let fine = self::Tolerance::uniform(FINE);
    let truth = by_multipliers(&scene.scene, scene.start, (times.rate.recip(), run.len()), fine)?;
    let off = largest(run.iter().zip(truth).map(|(now, of)| apart(*now, of, size)));
    let InitialMotion { R_WO, w_WO } = scene.start;
    let other = poses(InitialMotion { R_WO: DQuat::from_scaled_axis(DVec3::splat(tolerance)) * R_WO, w_WO });
    let grown =
        other.map_or(0.0, |other| largest(run.iter().zip(other).map(|(now, of)| apart(*now, of, size))));
    Ok(Ran::Found { off: off / allowed(tolerance, grown), doubt: None })
}

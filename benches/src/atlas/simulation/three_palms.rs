//! Three palms without friction in minimal coordinates, against multipliers.

use super::super::judged::Ran;
use super::super::spatial::scene::{Scene, Spec};
use super::super::{Failure, Method, Way};
use super::{GROWN, TOLERANCE};
use crate::multipliers::by_multipliers;
use glam::DVec3;
use recon::object_dynamics::integrate::Tolerance;

/// Tolerance of the other way.
const FINE: f64 = 1e-13;

pub(in super::super) const METHOD: Method = Method {
    name: "simulation, three palms",
    about: "minimal coordinates at a tolerance of 1e-9, over ten natural times or to the loss of contact; right: poses within ten thousand tolerances (sizes, rad) of those by multipliers at 1e-13",
    ways: {
        use Way::*;
        &[
            Parallel, Flat, Steep, Sphere, Revolution, Pole, Relative, Force, Slow, Rate, Shaking, Long,
            Size, Tolerance,
        ]
    },
    seeds: 10,
    every: 1,
    run,
};

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let scene = Scene::drawn(Spec::of(way, strength), seed)?;
    let tolerance = if way == Way::Tolerance { strength } else { TOLERANCE };
    let times = scene.times();
    let run = match scene.scene.simulate(scene.start, times, self::Tolerance::uniform(tolerance)) {
        Ok(run) => run,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let count = run.instants.len();
    let fine = self::Tolerance::uniform(FINE);
    let truth = by_multipliers(&scene.scene, scene.start, (times.rate.recip(), count), fine)?;
    let mut off = 0.0;
    for (now, (p, q)) in run.instants.iter().zip(truth) {
        let turn = now.R_WO * q.inverse();
        let angle = 2.0 * DVec3::new(turn.x, turn.y, turn.z).length().atan2(turn.w.abs());
        let error = (now.touch.p_WCm.distance(p) / scene.of.size).max(angle);
        off = if error > off || error.is_nan() { error } else { off };
    }
    Ok(Ran::Found { off: off / (GROWN * tolerance), doubt: None })
}

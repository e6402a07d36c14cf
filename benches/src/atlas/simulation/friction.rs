//! Three palms that rub: what the motion must keep to.

use super::super::judged::Ran;
use super::super::spatial::Rubbed;
use super::super::{Failure, G, Method, Way};
use crate::departures::Departures;

const TOLERANCE: f64 = 1e-7;
/// What may be off at this tolerance: overlap in sizes, force beyond its cone in weights, creep in natural speeds, energy in weight times size.
/// Where sticking contacts come loose the motion goes on by steps of first order, which creep by up to 1e-4.
const ALLOWED: [f64; 4] = [1e-5, 1e-5, 2e-4, 1e-4];

pub(in super::super) const METHOD: Method = Method {
    name: "simulation, friction",
    about: "three palms with friction 0.3 at a tolerance of 1e-7; right: overlap below 1e-5 sizes, forces in their cones to 1e-5 weights, sticking contacts slower than 2e-4 natural speeds, energy accounted for to 1e-4",
    ways: {
        use Way::*;
        &[
            Parallel, Flat, Steep, Sphere, Revolution, Relative, Drop, Slow, Friction, Shaking, Long,
            Switches, Size, Tolerance,
        ]
    },
    seeds: 12,
    every: 1,
    run,
};

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let rubbed = Rubbed::drawn(way, strength, seed)?;
    let tolerance = if way == Way::Tolerance { strength } else { TOLERANCE };
    let run = match rubbed.simulate(tolerance) {
        Ok(run) => run,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let Departures { gap, cone, creep, energy } = Departures::of(&rubbed.scene, &run);
    let scale = rubbed.flat.scale();
    let units = [scale.size, scale.weight, (G * scale.size).sqrt(), scale.weight * scale.size];
    let looser = (tolerance / TOLERANCE).max(1.0);
    let mut off = 0.0;
    for ((departure, unit), allowed) in [gap, cone, creep, energy].into_iter().zip(units).zip(ALLOWED) {
        let own = departure / unit / allowed / looser;
        off = if own > off || own.is_nan() { own } else { off };
    }
    let ends = run.instants.last().is_some_and(|last| last.state.body.p_WCm.is_finite());
    Ok(Ran::Found { off: if ends { off } else { f64::NAN }, doubt: None })
}

//! Two hinged palms in the plane, against the simulation of any palms with their friction at zero.

use super::super::judged::Ran;
use super::super::planar::Spec;
use super::super::{Failure, Method, Way};
use super::{TOLERANCE, allowed, largest};
use glam::DVec2;
use recon::object_dynamics::planar::{
    BodyState, ContactStart, PlanarStart, PlanarTruth, simulate_prescribed,
};

/// Tolerance of the other way.
const FINE: f64 = 1e-12;

pub(in super::super) const METHOD: Method = Method {
    name: "simulation, plane",
    about: "two hinged palms at a tolerance of 1e-9, to the loss of contact; right: places within ten thousand tolerances (sizes, rad), or within ten times what one of the start grows to, of those of the simulation of any palms at 1e-12",
    ways: {
        use Way::*;
        &[Parallel, Flat, Sphere, Relative, Force, Slow, Shaking, Long, Size, Tolerance]
    },
    seeds: 30,
    every: 1,
    run,
};

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let of = Spec::of(way, strength);
    let tolerance = if way == Way::Tolerance { strength } else { TOLERANCE };
    let Some(scene) = of.scene(seed)? else { return Ok(Ran::NoScene("the body is not convex".to_owned())) };
    let count = (of.lasts * 14.0) as usize;
    let times: Vec<f64> = (0..=count).map(|k| k as f64 / 14.0 * scene.time).collect();
    let simulated = |start| simulate_prescribed(&scene.object, &scene.palms, start, &times, tolerance);
    let run = match simulated(scene.start) {
        Ok(run) => run,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let Some(first) = run.samples.first() else {
        return Ok(Ran::Refused("no contact at the start".to_owned()));
    };
    let truth = first.truth;
    let body = BodyState { p_WCm: truth.p_WCm, phi0: truth.phi0, v_WCm: truth.v_WCm, omega0: truth.omega0 };
    let other = scene.any_palms(0.0)?;
    let start = ContactStart { body, contacts: vec![0, 1] };
    let count = run.samples.len();
    let other = other.simulate(&start, &times[..count], FINE)?;
    let apart = |a: &PlanarTruth, (p, phi): (DVec2, f64)| {
        let place: f64 = a.p_WCm.distance(p) / scene.length;
        place.max((a.phi0 - phi).abs())
    };
    let now = || run.samples.iter().map(|sample| &sample.truth);
    let off = largest(now().zip(&other.instants).map(|(a, b)| apart(a, (b.body.p_WCm, b.body.phi0))));
    let nudged = simulated(PlanarStart { phi0: scene.start.phi0 + tolerance, ..scene.start });
    let grown = nudged.map_or(0.0, |nudged| {
        let others = nudged.samples.iter().map(|sample| &sample.truth);
        largest(now().zip(others).map(|(a, b)| apart(a, (b.p_WCm, b.phi0))))
    });
    Ok(Ran::Found { off: off / allowed(tolerance, grown), doubt: None })
}

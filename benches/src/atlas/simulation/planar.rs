//! Two hinged palms in the plane, against the simulation of any palms with their friction at zero.

use super::super::judged::Ran;
use super::super::planar::Spec;
use super::super::{Failure, Method, Way};
use super::{GROWN, TOLERANCE};
use recon::object_dynamics::planar::{BodyState, ContactStart, simulate_prescribed};

/// Tolerance of the other way.
const FINE: f64 = 1e-12;

pub(in super::super) const METHOD: Method = Method {
    name: "simulation, plane",
    about: "two hinged palms at a tolerance of 1e-9, to the loss of contact; right: places within ten thousand tolerances (sizes, rad) of those of the simulation of any palms at 1e-12",
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
    let run = match simulate_prescribed(&scene.object, &scene.palms, scene.start, &times, tolerance) {
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
    let mut off = 0.0;
    for (a, b) in run.samples.iter().zip(&other.instants) {
        let place: f64 = a.truth.p_WCm.distance(b.body.p_WCm) / scene.length;
        let error = place.max((a.truth.phi0 - b.body.phi0).abs());
        off = if error > off || error.is_nan() { error } else { off };
    }
    Ok(Ran::Found { off: off / (GROWN * tolerance), doubt: None })
}

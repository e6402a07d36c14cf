//! The estimate in the plane, between two hinged palms without friction.

mod scene;

pub(super) use scene::Spec;
use scene::misread;

use super::judged::Ran;
use super::{DEVIATIONS, Failure, G, Method, Way};
use crate::planar::scene::Scene;
use recon::object_dynamics::planar::{PlanarNoise, PlanarTruth};
use recon::observer::contacts::ContactNoiseLevel;
use recon::observer::planar::{PlaneEstimate, PlaneOptions, estimate_plane};
use recon::observer::reliability::Reliability;

/// What contact conditions are off by beside noise, natural speeds.
const FLOOR: f64 = 1e-6;
/// What an estimate from exact readings may be off by, in sizes, natural speeds and rates.
const EXACT: f64 = 1e-6;
const WAYS: &[Way] = {
    use Way::*;
    &[
        Parallel,
        Flat,
        Sphere,
        Relative,
        Force,
        Hinge,
        Slow,
        Window,
        Noise,
        Unstated,
        Bias,
        Gain,
        Delay,
        Correlation,
        Taxels,
        Outliers,
        Gap,
        Rate,
        Palm,
        Shaking,
        Long,
        Size,
    ]
};

const WAYS_OF_KNOWN: &[Way] = {
    use Way::*;
    &[
        Parallel,
        Flat,
        Sphere,
        Relative,
        Force,
        Hinge,
        Slow,
        Window,
        Noise,
        Unstated,
        Bias,
        Gain,
        Delay,
        Correlation,
        Taxels,
        Outliers,
        Gap,
        Rate,
        Mass,
        Inertia,
        Palm,
        Shaking,
        Long,
        Size,
    ]
};

const ABOUT: &str = "two hinged palms, from no guess; right: centre, velocity and rate within five stated deviations at all samples relied on";

pub(super) const KNOWN: Method = Method {
    name: "planar, body known",
    about: ABOUT,
    ways: WAYS_OF_KNOWN,
    seeds: 1,
    every: 1,
    run: |way, strength, seed| of_spec(Spec::of(way, strength), seed, true),
};

pub(super) const UNKNOWN: Method = Method {
    name: "planar, body unknown",
    about: ABOUT,
    ways: WAYS,
    seeds: 1,
    every: 1,
    run: |way, strength, seed| of_spec(Spec::of(way, strength), seed, false),
};

/// One run.
pub(super) fn of_spec(of: Spec, seed: u64, known: bool) -> Result<Ran, Failure> {
    let (scene, exact) = of.drawn(seed)?;
    let [contact, force] = [of.noise[0] * scene.length, of.noise[1] * scene.weight()];
    let added = PlanarNoise {
        contact: contact * of.unstated,
        force: force * of.unstated,
        torque: force * scene.length * of.unstated,
    };
    let noisy = added.add_to(&exact, seed);
    let log = of.wrong.misread(misread(&of, &exact, &noisy)?, scene.length, seed)?;
    let Some(log) = log.contact_log([0.0; 2]) else {
        return Ok(Ran::Refused("a torque has no lever, or an angle is that of no palm".to_owned()));
    };
    let body = if known { Some(of.wrong.told(scene.object.mass)?) } else { None };
    let noise = ContactNoiseLevel {
        contact,
        force_fixed: force,
        force_share: 0.0,
        impulse: None,
        floor: FLOOR * scene.length / scene.time,
    };
    let options = PlaneOptions { body, suspects: true, ..PlaneOptions::new(noise, G, vec![Some(0.0); 2]) };
    let found = match estimate_plane(&log, &options) {
        Ok(found) => found,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let off = errors(&found, exact.truth().ok_or("no truth")?, &scene, contact == 0.0);
    let doubt = match &found.reliability {
        Reliability::Unreliable(reasons) => {
            Some(reasons.first().map_or_else(|| "not relied on".to_owned(), ToString::to_string))
        }
        _ if !found.relied_on.contains(&true) => Some("no sample is relied on".to_owned()),
        _ => None,
    };
    Ok(Ran::Found { off: off / DEVIATIONS, doubt })
}

/// The largest error in deviations.
fn errors(made: &PlaneEstimate, truth: &[PlanarTruth], scene: &Scene, exact: bool) -> f64 {
    let share = if exact { EXACT } else { 0.0 };
    let least = [scene.length, scene.length / scene.time, scene.time.recip()].map(|unit| share * unit);
    let mut worst = 0.0;
    for (k, truth) in truth.iter().enumerate().filter(|(k, _)| made.relied_on[*k]) {
        let (state, of) = (&made.states[k], &made.deviations[k]);
        let (p, v) = (state.p_WCm - truth.p_WCm, state.v_WCm - truth.v_WCm);
        let spin = state.omega0 - truth.omega0;
        let parts = [
            (p.x, of.p_WCm.x, least[0]),
            (p.y, of.p_WCm.y, least[0]),
            (v.x, of.v_WCm.x, least[1]),
            (v.y, of.v_WCm.y, least[1]),
            (spin, of.omega0, least[2]),
        ];
        for (error, deviation, least) in parts {
            let off: f64 = error.abs() / deviation.max(least);
            worst = if off > worst || off.is_nan() { off } else { worst };
        }
    }
    worst
}

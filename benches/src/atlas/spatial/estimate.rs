//! The estimate from contacts of a whole log.

use super::super::judged::Ran;
use super::super::{DEVIATIONS, Failure, G, Method, Way};
use super::contacts::{self, LoggedMotion};
use super::scene::{Motion, Spec, state};
use super::{WAYS, WAYS_OF_KNOWN, in_deviations, lost, worse};
use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::object_dynamics::{BodyState, ContactLog, ContactLogError, ForceChannel, PalmHinge};
use recon::observer::contacts::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use recon::observer::reliability::Reliability;

/// What conditions are off by beside noise, as a share of the natural speed.
pub(super) const FLOOR: f64 = 3e-5;
/// What an estimate from exact readings may be off by, in sizes and natural speeds.
const EXACT: f64 = 1e-6;

const ABOUT: &str = "from no guess; right: centre, velocity and rate (and mass) within five stated deviations of the simulated ones at all samples relied on";

pub(in super::super) const KNOWN: Method = Method {
    name: "spatial, body known",
    about: ABOUT,
    ways: WAYS_OF_KNOWN,
    seeds: 1,
    every: 2,
    run: |way, strength, seed| run(way, strength, seed, true),
};

pub(in super::super) const UNKNOWN: Method = Method {
    name: "spatial, body unknown",
    about: ABOUT,
    ways: WAYS,
    seeds: 1,
    every: 1,
    run: |way, strength, seed| run(way, strength, seed, false),
};

fn run(way: Way, strength: f64, seed: u64, known: bool) -> Result<Ran, Failure> {
    if let Way::Drop | Way::Friction | Way::Switches = way {
        return Ok(of_contacts(&contacts::logged((way, strength), None, seed)?, known));
    }
    if let Way::Loss | Way::Held = way {
        return lost::run(strength, way == Way::Held, known, seed);
    }
    of_spec(Spec::of(way, strength), seed, known)
}

/// Palms that are said to have no friction and have some, forces with so much noise (weights), body unknown.
pub(in super::super) fn friction_and_sensing(friction: f64, noise: f64, seed: u64) -> Result<Ran, Failure> {
    Ok(of_contacts(&contacts::logged((Way::Friction, friction), Some(noise), seed)?, false))
}

fn of_contacts(of: &LoggedMotion, known: bool) -> Ran {
    let LoggedMotion { log, truth, noise, mass, friction, size } = of;
    let options =
        ContactOptions { friction: *friction, body: known.then_some(*mass), ..options(*noise, *size, log) };
    let own = |t: f64| log.times().iter().position(|at| *at == t).and_then(|k| truth.get(k).copied());
    judged(log, &options, (mass.mass(), *size, false), own)
}

/// Of three palms without friction.
pub(in super::super) fn of_spec(of: Spec, seed: u64, known: bool) -> Result<Ran, Failure> {
    let motion = Motion::drawn(of, seed)?;
    let (log, noise) = motion.log()?;
    let log =
        ContactLog::try_from(&log).and_then(|log| if of.by_torques { by_torques(&log) } else { Ok(log) });
    let log = match log {
        Ok(log) => log,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let mut options = ContactOptions {
        friction: Some(0.0),
        body: known.then(|| motion.told()),
        ..options(noise, of.size, &log)
    };
    if of.by_torques {
        // What noise of torques makes of forces hangs on the levers: it is read off the forces, as the command does.
        options.noise = ContactNoiseLevel::by_roughness(&log, options.noise.floor, false);
    }
    Ok(judged(&log, &options, (motion.scene.mass.mass(), of.size, noise[0] == 0.0), |t| {
        motion.at(t).map(state)
    }))
}

/// Moment of inertia of palms, kg m^2: as they stand still, it does not matter.
const STILL: f64 = 1.0;

/// With normal forces from the torques of palms that turn about a level axis through the origin.
fn by_torques(log: &ContactLog) -> Result<ContactLog, ContactLogError> {
    let mut records = log.records();
    for (record, palm) in records.iter_mut().zip(log.palms()) {
        let axis = Direction::new_unchecked(palm.motion(0).pose.R_WP * DVec3::X);
        record.hinge = Some(PalmHinge { pivot: DVec3::ZERO, axis, inertia: STILL });
    }
    let hinged = ContactLog::new(log.times().to_vec(), records.clone(), None)?;
    for (i, record) in records.iter_mut().enumerate() {
        let forces = hinged.forces_of_torque(i)?;
        record.force = ForceChannel::Normal(forces.into_iter().map(Option::unwrap_or_default).collect());
    }
    ContactLog::new(log.times().to_vec(), records, None)
}

/// Of contacts (m) and forces (N) with so much noise.
fn options([contact, force_fixed]: [f64; 2], size: f64, log: &ContactLog) -> ContactOptions {
    let floor = FLOOR * (G * size).sqrt();
    let stated = ContactNoiseLevel { contact, force_fixed, force_share: 0.0, impulse: None, floor };
    let guessed = if contact > 0.0 { None } else { ContactNoiseLevel::guessed(log, G, None) };
    ContactOptions { suspects: true, ..ContactOptions::new(guessed.unwrap_or(stated), G) }
}

fn judged(
    log: &ContactLog,
    options: &ContactOptions,
    (mass, size, exact): (f64, f64, bool),
    truth: impl Fn(f64) -> Option<BodyState>,
) -> Ran {
    let found = match estimate_contacts(log, None, options) {
        Ok(found) => found,
        Err(error) => return Ran::refused(&error),
    };
    let mut off = if options.body.is_some() || exact { 0.0 } else { of_mass(&found, mass) };
    for (k, t) in log.times().iter().enumerate().filter(|(k, _)| found.relied_on[*k]) {
        let Some(truth) = truth(*t) else { continue };
        let least = if exact { least(size) } else { [0.0; 4] };
        let deviations = [0, 1, 2].map(|i| found.deviations[k][i].max(DVec3::splat(least[i])));
        off = worse(off, in_deviations(&found.states[k], &truth, &deviations) / DEVIATIONS);
    }
    Ran::Found { off, doubt: doubt(&found) }
}

/// What errors of an estimate from exact readings are at least: five of them are five millionths of the size, the natural speed and rate.
fn least(size: f64) -> [f64; 4] {
    [EXACT * size, EXACT * (G * size).sqrt(), EXACT * (G / size).sqrt(), 0.0]
}

/// Error of an unknown body's mass in its deviations, over what is allowed.
fn of_mass(found: &ContactEstimate, mass: f64) -> f64 {
    (found.mass / mass).ln().abs() / found.mass_deviation / DEVIATIONS
}

/// Why it says not to rely on it.
pub(super) fn doubt(found: &ContactEstimate) -> Option<String> {
    match &found.reliability {
        Reliability::Unreliable(reasons) => {
            Some(reasons.first().map_or_else(|| "not relied on".to_owned(), ToString::to_string))
        }
        Reliability::Reliable if !found.relied_on.contains(&true) => {
            Some("no sample is relied on".to_owned())
        }
        Reliability::Reliable => None,
    }
}

//! What several diagrams measure alike.

use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    ContactLog, InitialMotion, MassProperties, SampleTimes, SensorLog, SensorNoise, Simulation,
    SimulationError, ThreePalmScene,
};
use recon::observer::contacts::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};

/// A simulation close to rounding, and its log without truth.
pub(super) fn exact_log<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    start: InitialMotion,
    duration: f64,
    rate: f64,
) -> Result<(Simulation, SensorLog), SimulationError> {
    let simulation = scene.simulate(start, SampleTimes { duration, rate }, Tolerance::uniform(1e-14))?;
    let log = simulation.sensor_log(scene)?.split_truth().0;
    Ok((simulation, log))
}

/// Estimate with the scene's mass and inertia known, from an exact log of which nothing else is said.
pub(super) fn estimate<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
) -> Result<ContactEstimate, String> {
    let log = ContactLog::try_from(log).map_err(|error| error.to_string())?;
    exact_estimate(&log, *scene.mass(), scene.gravity().length())
}

/// The same of any log.
pub(super) fn exact_estimate(
    log: &ContactLog,
    mass: MassProperties,
    gravity: f64,
) -> Result<ContactEstimate, String> {
    let noise = ContactNoiseLevel::guessed(log, gravity, None).ok_or("no two palms are touched at once")?;
    let options =
        ContactOptions { friction: Some(0.0), body: Some(mass), ..ContactOptions::new(noise, gravity) };
    estimate_contacts(log, None, &options).map_err(|error| error.to_string())
}

/// The same from a noisy log, as one of contacts, of a known body or an unknown; `floor` is what conditions are off by beside noise, m/s.
pub(super) fn noisy_estimate<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
    noise: &SensorNoise,
    known: bool,
    floor: f64,
) -> Result<ContactEstimate, String> {
    let (contact, force_fixed) = (noise.contact, noise.force);
    let level = ContactNoiseLevel { contact, force_fixed, force_share: 0.0, impulse: None, floor };
    let options = ContactOptions {
        friction: Some(0.0),
        body: known.then_some(*scene.mass()),
        ..ContactOptions::new(level, scene.gravity().length())
    };
    let log = ContactLog::try_from(log).map_err(|error| error.to_string())?;
    estimate_contacts(&log, None, &options).map_err(|error| error.to_string())
}

/// Largest error of the centre of mass over the log, m.
pub(super) fn centre_error(estimate: &ContactEstimate, simulation: &Simulation) -> f64 {
    let pairs = estimate.states.iter().zip(&simulation.instants);
    pairs.map(|(state, now)| state.p_WCm.distance(now.touch.p_WCm)).fold(0.0, f64::max)
}

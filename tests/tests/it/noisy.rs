//! Logs of three planes through the estimate from contacts: what the tests of it share.

use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{ContactLog, Instant, PalmReading, SensorLog, SensorNoise, ThreePalmScene};
use recon::observer::contacts::{
    ContactEstimate, ContactEstimateError, ContactNoiseLevel, ContactOptions, estimate_contacts,
};
use recon::observer::reliability::Reliability;

/// What conditions are off by beside noise, m/s: next to nothing for bodies of some metres.
const FLOOR: f64 = 1e-5;

/// The estimate of a known body, or of one of which nothing is known.
pub(crate) fn estimated<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
    noise: SensorNoise,
    known: bool,
) -> ContactEstimate {
    let noise = ContactNoiseLevel {
        contact: noise.contact,
        force_fixed: noise.force,
        force_share: 0.0,
        impulse: None,
        floor: FLOOR,
    };
    let options = ContactOptions {
        friction: Some(0.0),
        body: known.then(|| *scene.mass()),
        suspects: true,
        ..ContactOptions::new(noise, scene.gravity().length())
    };
    estimate_contacts(&ContactLog::try_from(log).unwrap(), None, &options).unwrap()
}

/// The same of a log without noise, with nothing said of sensors.
pub(crate) fn exactly<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
    known: bool,
) -> Result<ContactEstimate, ContactEstimateError> {
    let (log, gravity) = (ContactLog::try_from(log).unwrap(), scene.gravity().length());
    let noise = ContactNoiseLevel::guessed(&log, gravity, None).ok_or(ContactEstimateError::NoContact)?;
    let body = known.then(|| *scene.mass());
    let options =
        ContactOptions { friction: Some(0.0), body, suspects: true, ..ContactOptions::new(noise, gravity) };
    estimate_contacts(&log, None, &options)
}

/// Largest errors of centre of mass (m) and angular velocity (rad/s) over a log.
pub(crate) fn largest_errors(found: &ContactEstimate, instants: &[Instant]) -> (f64, f64) {
    let pairs = || found.states.iter().zip(instants);
    let centre = pairs().map(|(state, now)| state.p_WCm.distance(now.touch.p_WCm)).fold(0.0, f64::max);
    let spin = pairs().map(|(state, now)| state.w_WO.distance(now.w_WO)).fold(0.0, f64::max);
    (centre, spin)
}

/// Squares of the errors of centre of mass, velocity and angular velocity at a sample over their variances.
pub(crate) fn squares(found: &ContactEstimate, k: usize, now: &Instant) -> [f64; 9] {
    let state = found.states[k];
    let errors = [state.p_WCm - now.touch.p_WCm, state.v_WCm - now.rates.v_WCm, state.w_WO - now.w_WO];
    std::array::from_fn(|i| (errors[i / 3][i % 3] / found.deviations[k][i / 3][i % 3]).powi(2))
}

/// Largest error at a sample, in its deviations.
pub(crate) fn worst(found: &ContactEstimate, k: usize, now: &Instant) -> f64 {
    squares(found, k, now).into_iter().fold(0.0, f64::max).sqrt()
}

/// The same over all samples that are relied on.
pub(crate) fn worst_of_all(found: &ContactEstimate, instants: &[Instant]) -> f64 {
    let relied = found.relied_on.iter().zip(instants).enumerate().filter(|(_, (relied, _))| **relied);
    relied.map(|(k, (_, now))| worst(found, k, now)).fold(0.0, f64::max)
}

/// What is said against an estimate, in words; empty where it is relied on.
pub(crate) fn words(reliability: &Reliability) -> String {
    match reliability {
        Reliability::Reliable => String::new(),
        Reliability::Unreliable(reasons) => {
            reasons.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
        }
    }
}

/// The log with readings changed, by sample and palm.
pub(crate) fn changed(log: &SensorLog, change: impl Fn(usize, usize, &mut PalmReading)) -> SensorLog {
    let mut samples = log.samples().to_vec();
    for (k, sample) in samples.iter_mut().enumerate() {
        sample.palms.iter_mut().enumerate().for_each(|(i, palm)| change(k, i, palm));
    }
    SensorLog::new(samples, None).unwrap()
}

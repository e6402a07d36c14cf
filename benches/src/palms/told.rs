//! What the estimator knows after a run: deviations that it states of a body of which nothing is known.

use super::body::{PalmBody, SIZE};
use super::hold::GRAVITY;
use nalgebra::Matrix6;
use recon::object_dynamics::{
    ChannelNoise, ContactLog, ContactMode, ContactNoise, ContactScene, ContactSimulation, MOST_PALMS,
};
use recon::observer::contacts::{
    ContactEstimate, ContactNoiseLevel, ContactOptions, ImpulseNoise, estimate_contacts,
};

/// Noise of contacts over the size, and of each axis of a force over the weight.
pub const NOISE: [f64; 2] = [0.0005, 0.002];
/// What impulses between samples are off by on each axis, over the weight times the interval.
const IMPULSE: f64 = 0.002;
/// What contact conditions are off by beside, over the natural speed.
const FLOOR: f64 = 3e-5;

/// What is known at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Told {
    /// Median over the samples of the largest deviation of place, velocity, rate and turn along any axis, in natural units.
    pub motion: f64,
    /// Deviation of the mass, relative.
    pub mass: f64,
    /// Largest deviation of the inertia over all combinations of its entries, over the mean moment.
    pub inertia: f64,
    /// Over the least such deviation: the condition number.
    pub condition: f64,
    /// Error of the mass over its deviation.
    pub error: f64,
    /// Whether the estimate is to be relied on.
    pub relied_on: bool,
}

/// The estimate from a run's readings with noise, contact modes known; none where there is none.
#[must_use]
pub fn told(
    scene: &ContactScene<&super::PalmShape>,
    run: &ContactSimulation,
    body: &PalmBody,
    seed: u64,
) -> Option<Told> {
    let (contact, weight) = (NOISE[0] * SIZE, body.mass.mass() * GRAVITY);
    let force = ChannelNoise { fixed: NOISE[1] * weight, share: 0.0 };
    let interval = run.instants.get(1)?.state.t - run.instants[0].state.t;
    let impulse = ChannelNoise { fixed: IMPULSE * weight * interval, share: 0.0 };
    let noise = ContactNoise { contact, force, impulse, ..ContactNoise::default() };
    let log = ContactLog::from_simulation(scene, run).ok()?.with_noise(&noise, seed).ok()?;
    let floor = FLOOR * (GRAVITY * SIZE).sqrt();
    let impulse = Some(ImpulseNoise { fixed: impulse.fixed, share: 0.0 });
    let level = ContactNoiseLevel { contact, force_fixed: force.fixed, force_share: 0.0, impulse, floor };
    let options = ContactOptions::new(level, GRAVITY);
    let modes = run.instants.iter().map(|now| {
        let mut modes = [ContactMode::Off; MOST_PALMS];
        modes.iter_mut().zip(&now.modes).for_each(|(to, from)| *to = *from);
        modes
    });
    let modes: Vec<_> = modes.collect();
    let found = estimate_contacts(&log, Some(&modes), &options).ok()?;
    let [least, largest] = inertia(&found)?;
    Some(Told {
        motion: motion(&found),
        mass: found.mass_deviation,
        inertia: largest,
        condition: largest / least,
        error: (found.mass / body.mass.mass()).ln() / found.mass_deviation,
        relied_on: found.reliability.is_reliable(),
    })
}

fn motion(found: &ContactEstimate) -> f64 {
    let speed = (GRAVITY * SIZE).sqrt();
    let units = [SIZE, speed, speed / SIZE, 1.0];
    let one = |of: &[glam::DVec3; 4]| {
        of.iter().zip(units).map(|(d, unit)| d.max_element() / unit).fold(0.0, f64::max)
    };
    let mut all: Vec<f64> = found.deviations.iter().map(one).collect();
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
}

/// The least and the largest deviation of the inertia along the axes of its covariance, over the mean moment.
fn inertia(found: &ContactEstimate) -> Option<[f64; 2]> {
    let covariance = Matrix6::from(found.inertia_covariance);
    let mean = found.inertia.to_cols_array().iter().step_by(4).sum::<f64>() / 3.0;
    let roots = (covariance / (mean * mean)).symmetric_eigenvalues().map(|x| x.max(0.0).sqrt());
    let (least, largest) = (roots.min(), roots.max());
    (least > 0.0 && largest.is_finite()).then_some([least, largest])
}

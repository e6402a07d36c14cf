//! Noisy logs to estimate from: three planes without friction, with it, and bodies in a plane, of all of which neither is told.

use super::Failure;
use super::scenes::{Scene, World, scene};
use recon::least_model::contact_size;
use recon::object_dynamics::{
    BodyState, ChannelNoise, ContactLog, ContactNoise, ForceChannel, MassProperties, SampleTimes, planar,
};
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions};
use recon_tests::Random;

const G: f64 = 9.81;
const TOLERANCE: f64 = 1e-10;

/// A log, what is told of it, and what is true.
pub(super) struct Logged {
    pub(super) kind: &'static str,
    pub(super) log: ContactLog,
    pub(super) options: ContactOptions,
    pub(super) truth: Vec<BodyState>,
    /// m.
    pub(super) size: f64,
    /// Samples in a natural time.
    pub(super) density: f64,
    /// Whether palms rub, and whether all is in a plane.
    pub(super) rubs: bool,
    pub(super) is_planar: bool,
}

/// One of a kind, from 0; none where there is no motion of ten natural times.
pub(super) fn logged(kind: usize, seed: u64) -> Result<Option<Logged>, Failure> {
    let mut random = Random::new(seed ^ 0xBEEF);
    let Some(of) = scene(kind, seed)? else { return Ok(None) };
    let natural = (of.size / G).sqrt();
    let density = 20.0 * 50_f64.powf(random.within(0.0, 1.0));
    let lasts = random.within(8.0, 14.0);
    let share = 2e-3 * 0.025_f64.powf(random.within(0.0, 1.0));
    let times = SampleTimes { duration: lasts * natural, rate: density / natural };
    let Some((exact, mass, weight)) = exact(&of, times)? else { return Ok(None) };
    let [contact, force] = [share * of.size, 3.0 * share * weight];
    let noise =
        ContactNoise { contact, force: ChannelNoise { fixed: force, share: 0.0 }, ..ContactNoise::default() };
    let (log, truth) = exact.with_noise(&noise, seed)?.split_truth();
    let mut records = log.records();
    for record in &mut records {
        (record.friction, record.impulse) = (None, ForceChannel::Missing);
    }
    let log = ContactLog::new(log.times().to_vec(), records, None)?;
    let floor = 3e-5 * (G * of.size).sqrt();
    let noise = ContactNoiseLevel { contact, force_fixed: force, force_share: 0.0, impulse: None, floor };
    let options = ContactOptions { body: Some(mass), suspects: true, ..ContactOptions::new(noise, G) };
    let truth = truth.unwrap_or_default();
    let size = contact_size(&log);
    Ok(Some(Logged {
        kind: of.kind,
        log,
        options,
        truth,
        size,
        density,
        rubs: of.rubs(),
        is_planar: matches!(of.world, World::Plane { .. }),
    }))
}

fn exact(of: &Scene, times: SampleTimes) -> Result<Option<(ContactLog, MassProperties, f64)>, Failure> {
    match &of.world {
        World::Space { scene, start, .. } => {
            let Ok(run) = scene.simulate(start, times, TOLERANCE) else { return Ok(None) };
            // What comes to rest early tells nothing of its motion.
            let moves = run.instants.len() * 2 / 3;
            let still = run.instants[moves..].iter().all(|now| now.state.body.w_WO.length() < 1e-6);
            let log = ContactLog::from_simulation(scene, &run)?;
            let mass = *scene.mass();
            Ok((!still).then_some((log, mass, mass.mass() * G)))
        }
        World::Plane { scene, start } => {
            let Ok(run) = scene.simulate(start, &times.all()?, TOLERANCE) else { return Ok(None) };
            let log: planar::ContactLog = run.log(scene)?;
            let log = log.in_space(&[None, None])?;
            let mass = scene.object().mass;
            let moment = mass.inertia();
            let body = MassProperties::from_principal(mass.mass(), glam::DVec3::splat(moment))?;
            Ok(Some((log, body, mass.mass() * G)))
        }
    }
}

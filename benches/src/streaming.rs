//! Random scenes of three palms that swing, followed sample by sample at the pace of a robot.

use crate::fault::{Fault, Scale};
use cpu_time::ProcessTime;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, MotionLaw, Palm};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, Instant, MassProperties, Sample, SampleTimes, SensorLog, SensorNoise, ThreePalmScene,
};
use recon::observer::contacts::stream::{
    MotionStream, PlaneReadings, StreamBody, StreamEstimate, StreamOptions,
};
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions};
use recon_tests::Random;
use std::f64::consts::TAU;
use std::thread::sleep;
use std::time::Duration;

type Failure = Box<dyn std::error::Error + Send + Sync>;

const GRAVITY: f64 = 9.81;
const MASS: f64 = 1.3;
/// Shortest log that is looked at, in natural times.
const SHORTEST: f64 = 15.0;
/// Scenes that are tried for each that is wanted: in some the body cannot stand, or contact is lost soon.
const TRIED: u64 = 20;
/// What conditions are off by beside noise, as a share of the natural speed.
const FLOOR: f64 = 3e-5;

/// A noisy log with its truth.
pub struct Case {
    /// At each sample.
    pub truth: Vec<Instant>,
    /// As measured.
    pub samples: Vec<Sample>,
    /// Natural time, s.
    pub natural: f64,
    mass: MassProperties,
    noise: ContactNoiseLevel,
    rate: f64,
}

impl Case {
    /// Time of the first sample, s.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.samples.first().map_or(0.0, |sample| sample.t)
    }

    /// By how much principal moments are off, as shares of the true ones: the largest.
    #[must_use]
    pub fn moments_off(&self, body: &StreamBody) -> f64 {
        let found = MassProperties::new(body.mass, body.inertia).map(|mass| mass.principal().moments);
        found.map_or(f64::NAN, |found| (found / self.mass.principal().moments - 1.0).abs().max_element())
    }

    /// The same with what is not as stated of sensors or body.
    ///
    /// # Errors
    /// Those of readings that are no log any more.
    pub fn with(&self, fault: &Fault) -> Result<Self, Failure> {
        let size = self.natural * self.natural * GRAVITY;
        let of = Scale { size, weight: MASS * GRAVITY };
        let log =
            fault.of_log(&SensorLog::new(self.samples.clone(), None)?, of).map_err(|e| e.to_string())?;
        let samples = log.samples().to_vec();
        let is_left = |truth: &&Instant| samples.binary_search_by(|s| s.t.total_cmp(&truth.t)).is_ok();
        let truth = self.truth.iter().filter(is_left).copied().collect();
        let (mass, noise) = (fault.of_mass(self.mass), self.noise);
        Ok(Self { truth, samples, natural: self.natural, mass, noise, rate: self.rate })
    }

    /// A stream for it, of a body that is known or not.
    ///
    /// # Errors
    /// None: its options are usable.
    pub fn stream(&self, known: bool) -> Result<MotionStream, Failure> {
        let body = known.then_some(self.mass);
        let contacts = ContactOptions { body, suspects: true, ..ContactOptions::new(self.noise, GRAVITY) };
        Ok(MotionStream::new(PlaneReadings::palms(), StreamOptions { contacts, sample_rate: self.rate })?)
    }
}

/// So many of a size (m), of sensors of a quality (noise of contacts as a share of the size, of forces as one of what a palm carries, per cent), as far
/// as there are, of so many seconds or natural times at most.
///
/// # Errors
/// Those of scenes that are none.
pub fn some(
    count: usize,
    seed: u64,
    size: f64,
    rate: f64,
    quality: [f64; 2],
    longest: [f64; 2],
) -> Result<Vec<Case>, Failure> {
    let mut all = Vec::with_capacity(count);
    for seed in seed..seed + TRIED * count as u64 {
        if all.len() < count {
            all.extend(one(seed, size, rate, quality, longest)?);
        }
    }
    Ok(all)
}

/// None where the body cannot stand or contact is lost soon.
fn one(
    seed: u64,
    size: f64,
    rate: f64,
    [contact, force]: [f64; 2],
    longest: [f64; 2],
) -> Result<Option<Case>, Failure> {
    let mut random = Random::new(seed);
    let axes = DVec3::new(1.0, random.within(1.0, 2.0), random.within(1.0, 2.5));
    let axes = axes * (3.0 * size / axes.element_sum());
    let uniform = MassProperties::uniform_ellipsoid(MASS, axes)?.principal().moments;
    let moments = uniform * (DVec3::ONE + random.vector(-0.15, 0.15));
    // Some such moments are those of no body.
    let Ok(mass) = MassProperties::from_principal(MASS, moments) else { return Ok(None) };
    let natural = (size / GRAVITY).sqrt();
    let mut palm = |k: u32| {
        let azimuth = f64::from(k) * TAU / 3.0 + random.within(-0.4, 0.4);
        let motion = MotionLaw::Sinusoid {
            mean: random.within(0.7, 1.2),
            amplitude: random.within(0.02, 0.08),
            frequency: random.within(0.4, 1.0) / natural,
            phase: random.within(-3.0, 3.0),
        };
        Palm::new(azimuth, motion)
    };
    let palms = [palm(0)?, palm(1)?, palm(2)?];
    let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, palms, GRAVITY)?;
    let R_WO = DQuat::from_scaled_axis(random.vector(-3.0, 3.0));
    let w_WO = random.vector(-1.0, 1.0) * (random.within(0.0, 0.5) / natural);
    let duration = longest[0].min(longest[1] * natural);
    let times = SampleTimes { duration, rate };
    let Ok(run) = scene.simulate(InitialMotion { R_WO, w_WO }, times, Tolerance::uniform(1e-10)) else {
        return Ok(None);
    };
    let log = run.sensor_log(&scene)?;
    if log.duration() < SHORTEST * natural {
        return Ok(None);
    }
    let contact = 0.01 * contact * size;
    let force = 0.01 * force * MASS * GRAVITY / 3.0;
    let noisy = log.with_noise(&SensorNoise { contact, force, torque: 0.0 }, seed)?;
    let floor = FLOOR * size / natural;
    let noise = ContactNoiseLevel { contact, force_fixed: force, force_share: 0.0, impulse: None, floor };
    Ok(Some(Case { truth: run.instants, samples: noisy.samples().to_vec(), natural, mass, noise, rate }))
}

/// What came of a stream whose samples were pushed when their time had come.
pub struct Paced {
    /// Wall time of each push, microseconds.
    pub microseconds: Vec<f64>,
    /// Processor time of both threads over wall time.
    pub cores: f64,
    /// Estimates with the numbers of their samples.
    pub estimates: Vec<(usize, StreamEstimate)>,
}

/// Follows a case at its own pace.
///
/// # Errors
/// What the stream refuses.
pub fn paced(case: &Case, known: bool) -> Result<Paced, Failure> {
    let mut stream = case.stream(known)?;
    let mut readings = PlaneReadings::new(None);
    let mut microseconds = Vec::with_capacity(case.samples.len());
    let mut estimates = Vec::with_capacity(case.samples.len());
    let (clock, processor) = (std::time::Instant::now(), ProcessTime::now());
    for (k, sample) in case.samples.iter().enumerate() {
        let due = Duration::from_secs_f64((sample.t - case.start()).max(0.0));
        if let Some(early) = due.checked_sub(clock.elapsed()) {
            sleep(early);
        }
        let begun = std::time::Instant::now();
        if let Some((t, sensed)) = readings.push(sample)? {
            let estimate = stream.push(t, &sensed)?;
            microseconds.push(1e6 * begun.elapsed().as_secs_f64());
            estimates.push((k.saturating_sub(1), estimate));
        }
    }
    let cores = processor.elapsed().as_secs_f64() / clock.elapsed().as_secs_f64();
    Ok(Paced { microseconds, cores, estimates })
}

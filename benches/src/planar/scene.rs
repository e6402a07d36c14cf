//! Bodies between two frictionless palms in the plane, drawn at random: bodies of 3 cm to 3 m, palms that stand, swing slowly or fast, bodies
//! that turn on, turn back or are let go at rest.

use crate::bound::Scales;
use crate::bound::plane::{ContactErrors, TrueSample, least_covariance};
use glam::DVec2;
use nalgebra::SMatrix;
use recon::contact_kinematics::MotionLaw;
use recon::contact_kinematics::planar::{
    FourierBody, MotionPart, PalmSurface, RadiusFunction, SurfaceMotion, SurfacePose,
};
use recon::object_dynamics::planar::*;
use recon::observer::contacts::ContactNoiseLevel;
use recon::observer::planar::PlaneOptions;
use recon_tests::Random;
use std::f64::consts::{PI, TAU};

type Failure = Box<dyn std::error::Error>;

/// Gravity, m/s^2.
pub const GRAVITY: f64 = 9.81;
/// What contact conditions are off by beside noise, natural speeds.
const FLOOR: f64 = 1e-6;
/// Length of a log, natural times.
pub const LASTS: f64 = 20.0;

/// A body, its palms and how it is let go.
pub struct Scene {
    /// The body.
    pub object: PlanarObject<FourierBody>,
    /// The palms.
    pub palms: HarmonicPalms,
    /// How it is let go.
    pub start: PlanarStart,
    /// Size, m.
    pub length: f64,
    /// Natural time, s.
    pub time: f64,
    /// Length of its logs, natural times.
    pub lasts: f64,
}

/// Mean radius of a random outline, m, and the harmonics of its radius function.
pub fn outline(between: &mut impl FnMut(f64, f64) -> f64) -> (f64, Vec<f64>, Vec<f64>) {
    let length = 0.03 * 100_f64.powf(between(0.0, 1.0));
    let harmonics = 2 + between(0.0, 4.0) as usize;
    let mut cosines = vec![length, length * between(-0.2, 0.2)];
    let mut sines = vec![0.0, length * between(-0.2, 0.2)];
    for k in 2..=harmonics {
        let most = 0.35 / (k * k - 1) as f64;
        cosines.push(length * between(-most, most));
        sines.push(length * between(-most, most));
    }
    (length, cosines, sines)
}

/// Scenes whose contacts last for at least half of the time.
///
/// # Errors
/// Those of what is drawn: no body and no palms are such.
pub fn drawn(count: usize, seed: u64) -> Result<Vec<Scene>, Failure> {
    let mut random = Random::new(seed);
    let mut all = Vec::new();
    while all.len() < count {
        let Some(scene) = one(&mut random)? else { continue };
        if scene.log(10.0 / scene.time).is_ok_and(|log| lasts(&log) > 0.5 * LASTS * scene.time) {
            all.push(scene);
        }
    }
    Ok(all)
}

/// A scene; none where the body is not convex.
fn one(random: &mut Random) -> Result<Option<Scene>, Failure> {
    let mut between = |a: f64, b: f64| random.within(a, b);
    let (length, cosines, sines) = outline(&mut between);
    let mass = PlanarMass::from_gyration(
        200.0 * length * length * between(0.5, 2.0),
        length * length * between(0.3, 0.6),
    )?;
    let time = (length / GRAVITY).sqrt();
    let (wedge, middle) = (between(60.0, 120.0_f64), between(-20.0, 20.0));
    // A fifth of the palms stand; the others swing slowly or fast, by tens as often.
    let (stand, quick) = (between(0.0, 1.0) < 0.2, 0.05 * 20_f64.powf(between(0.0, 1.0)));
    let swing = if stand { 0.0 } else { 1.0 };
    let palms = HarmonicPalms {
        centres: [(90.0 + middle - wedge / 2.0).to_radians(), wedge.to_radians()],
        amplitudes: [swing * between(0.05, 0.5), swing * between(0.0, 0.2)],
        frequencies: [quick / time, quick * between(0.5, 1.5) / time],
        phases: [between(0.0, TAU), between(0.0, TAU)],
    };
    // A third of the bodies are let go without spin: they rest, rock and turn back.
    let spin = if between(0.0, 1.0) < 1.0 / 3.0 { 0.0 } else { between(-1.0, 1.0) };
    let start = PlanarStart { phi0: between(0.0, TAU), omega0: spin / time };
    let Ok(shape) = FourierBody::new(&cosines, &sines) else { return Ok(None) };
    if shape.radius_bounds().min < 0.1 * length {
        return Ok(None);
    }
    Ok(Some(Scene {
        object: PlanarObject { shape, mass, gravity: GRAVITY },
        palms,
        start,
        length,
        time,
        lasts: LASTS,
    }))
}

/// Time from the first sample to the last, s.
fn lasts(log: &PlanarLog) -> f64 {
    let samples = log.samples();
    samples[samples.len() - 1].t - samples[0].t
}

impl Scene {
    /// The same palms as lines that turn about the hinge, with a friction.
    ///
    /// # Errors
    /// Those of the scene.
    pub fn any_palms(&self, friction: f64) -> Result<ContactScene<FourierBody>, Failure> {
        let palms = &self.palms;
        let turn = |i: usize| MotionPart::Turn {
            pivot: DVec2::ZERO,
            law: MotionLaw::Sinusoid {
                mean: 0.0,
                amplitude: palms.amplitudes[i],
                frequency: palms.frequencies[i],
                phase: palms.phases[i],
            },
        };
        let [first, second] = palms.centres;
        let line = |angle: f64, parts: Vec<MotionPart>| -> Result<ScenePalm, Failure> {
            let motion = SurfaceMotion { pose: SurfacePose::new(DVec2::ZERO, angle)?, parts };
            Ok(ScenePalm { surface: PalmSurface::Line, motion, friction })
        };
        let all = vec![line(first, vec![turn(0)])?, line(first + second + PI, vec![turn(0), turn(1)])?];
        Ok(ContactScene::new(self.object.clone(), all)?)
    }

    /// What is sensed, without noise.
    ///
    /// # Errors
    /// Those of the simulation.
    pub fn log(&self, rate: f64) -> Result<PlanarLog, Failure> {
        self.log_at(rate, 0.0)
    }

    /// With all times shifted, s.
    pub(super) fn log_at(&self, rate: f64, shift: f64) -> Result<PlanarLog, Failure> {
        let count = (self.lasts * self.time * rate) as usize;
        let times = (1..=count).map(|k| k as f64 / rate - shift).filter(|t| *t > 0.0);
        let times: Vec<f64> = std::iter::once(0.0).chain(times).collect();
        Ok(simulate_prescribed(&self.object, &self.palms, self.start, &times, 1e-12)?.log()?)
    }

    /// Of the body, N.
    #[must_use]
    pub fn weight(&self) -> f64 {
        self.object.mass.mass() * GRAVITY
    }

    /// Noise of contacts as a share of the size, of forces of 1 % of the weight.
    #[must_use]
    pub fn noise(&self, share: f64) -> PlanarNoise {
        PlanarNoise { contact: share * self.length, force: 0.01 * self.weight(), torque: 0.0 }
    }

    /// What is told of a log of this noise, without friction.
    #[must_use]
    pub fn options(&self, noise: PlanarNoise, body: Option<PlanarMass>) -> PlaneOptions {
        let level = ContactNoiseLevel {
            contact: noise.contact,
            force_fixed: noise.force,
            force_share: 0.0,
            impulse: None,
            floor: FLOOR * self.length / self.time,
        };
        PlaneOptions { body, suspects: true, ..PlaneOptions::new(level, GRAVITY, vec![Some(0.0); 2]) }
    }

    /// Of an exact log.
    pub(crate) fn true_samples(&self, log: &PlanarLog) -> Result<Vec<TrueSample>, Failure> {
        let truth = log.truth().ok_or("no truth")?;
        let one = |(of, truth): (&PlanarSample, &PlanarTruth)| {
            let [Some(a), Some(b)] = of.contacts else { return Err("a palm without contact".into()) };
            let &PlanarTruth { p_WCm, v_WCm, omega0, .. } = truth;
            let (forces, palms) = (of.forces.ok_or("no forces")?, self.palms.at(of.t)?);
            Ok(TrueSample { t: of.t, p_WCm, v_WCm, omega0, contacts: [a, b], forces, palms })
        };
        log.samples().iter().zip(truth).map(one).collect()
    }

    /// The least covariance of place, velocity and spin at the end of an exact log, in natural units.
    ///
    /// # Errors
    /// Those of a log that is not exact, and of equations that are singular.
    pub fn bound(
        &self,
        exact: &PlanarLog,
        known: bool,
        share: f64,
        errors: ContactErrors,
    ) -> Result<SMatrix<f64, 5, 5>, Failure> {
        let samples = self.true_samples(exact)?;
        let scales = Scales { length: self.length, time: self.time };
        let least = least_covariance(&samples, self.object.mass, known, self.noise(share), scales, errors);
        let mut least = least.ok_or("no bound")?;
        let speed = self.length / self.time;
        let natural = [self.length, self.length, speed, speed, self.time.recip()];
        for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))) {
            least[(i, j)] /= natural[i] * natural[j];
        }
        Ok(least)
    }

    /// How often the body turns back against a palm: how often an angular velocity against one changes its sign.
    ///
    /// # Errors
    /// Those of a log that is not exact.
    pub fn turn_backs(&self, exact: &PlanarLog) -> Result<usize, Failure> {
        let samples = self.true_samples(exact)?;
        let against = |sample: &TrueSample, palm: usize| sample.omega0 - sample.palms.motion.rates[palm];
        let changes = |pair: &[TrueSample]| {
            (0..2).filter(|&palm| against(&pair[0], palm) * against(&pair[1], palm) < 0.0).count()
        };
        Ok(samples.windows(2).map(changes).sum())
    }
}

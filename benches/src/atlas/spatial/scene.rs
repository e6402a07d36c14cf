//! Random bodies on three palms, changed along a way of failing, and their logs.

use super::super::{Failure, G, Way};
use super::sensed::{correlated, late};
use crate::fault::{Fault, Scale};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, MotionLaw, Palm, PalmFrame};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    BodyState, InitialMotion, Instant, MassProperties, SampleTimes, SensorLog, SensorNoise, Simulation,
    ThreePalmScene,
};
use recon_tests::Random;
use std::f64::consts::TAU;

/// Bodies that are tried for one that stays on its palms over the whole log.
const TRIED: u64 = 12;
const TOLERANCE: f64 = 1e-11;

/// What a scene is drawn from. Times and rates are natural ones, of the mean semi-axis.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Spec {
    /// Mean semi-axis, m.
    pub(in super::super) size: f64,
    /// Semi-axes but for their size; none: random ones.
    pub(in super::super) axes: Option<DVec3>,
    /// Whether moments of inertia are off those of a uniform body.
    pub(in super::super) uniform: bool,
    /// Azimuths, rad.
    pub(in super::super) azimuths: [f64; 3],
    /// Slope of all palms, rad; none: random ones.
    pub(in super::super) slope: Option<f64>,
    /// Amplitude of the palms, rad, and their rate.
    pub(in super::super) swing: [f64; 2],
    pub(in super::super) spin: f64,
    /// Whether it is let go where it lies lowest.
    pub(in super::super) lowest: bool,
    /// Angle between a contact's normal and the body's third axis, rad.
    pub(in super::super) pole: Option<f64>,
    /// How long the log is, and how many samples there are in a natural time.
    pub(in super::super) lasts: f64,
    pub(in super::super) rate: f64,
    /// Whether contact may end before that.
    pub(in super::super) may_end: bool,
    /// Of contacts in sizes, of forces in weights, as stated; and what it is of that.
    pub(in super::super) noise: [f64; 2],
    pub(in super::super) unstated: f64,
    pub(in super::super) correlation: f64,
    /// How late all forces are.
    pub(in super::super) delay: f64,
    pub(in super::super) by_torques: bool,
    pub(in super::super) fault: Option<Fault>,
}

impl Spec {
    /// Of a way.
    pub(in super::super) fn of(way: Way, strength: f64) -> Self {
        let base = Self {
            size: 0.05,
            axes: None,
            uniform: false,
            azimuths: [0.0, TAU / 3.0, 2.0 * TAU / 3.0],
            slope: None,
            swing: [0.0, 1.0],
            spin: 0.3,
            lowest: false,
            pole: None,
            lasts: 8.0,
            rate: 10.0,
            may_end: false,
            noise: [1e-3, 3e-3],
            unstated: 1.0,
            correlation: 0.0,
            delay: 0.0,
            by_torques: false,
            fault: None,
        };
        let natural = (base.size / G).sqrt();
        let faulty = |fault| Self { fault: Some(fault), ..base };
        let degrees = strength.to_radians();
        match way {
            Way::Parallel => {
                Self { lowest: true, azimuths: [0.0, 0.5 * (TAU - degrees), 0.5 * (TAU + degrees)], ..base }
            }
            Way::Flat | Way::Steep => Self { slope: Some(degrees), lowest: true, ..base },
            Way::Hinge => Self { slope: Some(degrees), by_torques: true, lowest: true, ..base },
            Way::Sphere => Self {
                uniform: true,
                axes: Some(DVec3::new(1.0, 1.0 + strength, 1.0 + 2.0 * strength)),
                ..base
            },
            Way::Revolution => {
                Self { uniform: true, axes: Some(DVec3::new(1.0, 1.0 + strength, 2.0)), ..base }
            }
            Way::Pole => Self { pole: Some(strength), ..base },
            Way::Relative => Self { swing: [0.1, 3.0 * strength], ..base },
            Way::Force => Self { spin: strength, may_end: true, ..base },
            Way::Slow => Self { spin: strength, lowest: true, ..base },
            Way::Window => Self { lasts: strength, ..base },
            Way::Noise => Self { noise: [strength, 3.0 * strength], ..base },
            Way::Unstated => Self { unstated: strength, ..base },
            Way::Correlation => Self { correlation: strength, ..base },
            Way::Bias => faulty(Fault::Bias(strength)),
            Way::Gain => faulty(Fault::Gain(strength)),
            Way::Delay => Self { delay: strength, ..base },
            Way::Taxels => faulty(Fault::Taxels(strength)),
            Way::Outliers => faulty(Fault::Outliers(strength)),
            Way::Gap => Self { lasts: 12.0, ..faulty(Fault::Gap(strength * natural)) },
            Way::Dropped => Self { rate: 20.0, ..faulty(Fault::Dropped(strength)) },
            Way::Mass => faulty(Fault::Mass(strength)),
            Way::Inertia => faulty(Fault::Inertia(strength)),
            Way::Palm => faulty(Fault::Turned(strength)),
            Way::Rate => Self { rate: strength, ..base },
            Way::Shaking => Self { swing: [0.05_f64.min(0.3 / (strength * strength)), strength], ..base },
            Way::Long => Self { lasts: strength, rate: 10.0, spin: 0.2, ..base },
            Way::Size => Self { size: strength, ..base },
            _ => base,
        }
    }

    /// Natural time, s.
    pub(in super::super) fn natural(&self) -> f64 {
        (self.size / G).sqrt()
    }
}

/// A body on its palms and how it is let go.
pub(in super::super) struct Scene {
    pub(in super::super) of: Spec,
    pub(in super::super) axes: DVec3,
    pub(in super::super) mass: MassProperties,
    pub(in super::super) scene: ThreePalmScene<Ellipsoid>,
    pub(in super::super) start: InitialMotion,
}

/// A motion.
pub(in super::super) struct Motion {
    pub(in super::super) scene: Scene,
    pub(in super::super) simulation: Simulation,
    seed: u64,
}

impl Scene {
    /// One for a seed.
    pub(in super::super) fn drawn(of: Spec, seed: u64) -> Result<Self, Failure> {
        let mut random = Random::new(seed);
        let axes = DVec3::new(1.0, random.within(1.1, 1.6), random.within(1.7, 2.4));
        let axes = of.axes.unwrap_or(axes);
        let axes = axes * (3.0 * of.size / axes.element_sum());
        let mass = 1000.0 * 2.0 / 3.0 * TAU * axes.element_product();
        let uniform = MassProperties::uniform_ellipsoid(mass, axes)?;
        let moments = uniform.principal().moments * random.vector(0.92, 1.08);
        let mass = if of.uniform { uniform } else { MassProperties::from_principal(mass, moments)? };
        let natural = of.natural();
        let mut normals = [DVec3::Z; 3];
        let mut palms = Vec::with_capacity(3);
        for k in 0..3 {
            let azimuth = of.azimuths[k] + if of.fault.is_none() { 0.0 } else { random.within(-0.2, 0.2) };
            let (random_slope, phase) = (random.within(0.75, 1.1), random.within(0.0, TAU));
            let (amplitude, frequency) = (of.swing[0], of.swing[1] / natural);
            let mean = of.slope.unwrap_or(random_slope);
            normals[k] = PalmFrame::from_azimuth_slope(azimuth, mean + amplitude * phase.sin()).n;
            palms.push(Palm::new(azimuth, MotionLaw::Sinusoid { mean, amplitude, frequency, phase })?);
        }
        let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palms[0], palms[1], palms[2]], G)?;
        // Only palms with an inertia have a torque; as they stand still, which one does not matter.
        let scene = if of.by_torques { scene.with_palm_inertias([1.0; 3])? } else { scene };
        let turned = DQuat::from_scaled_axis(random.vector(-3.0, 3.0));
        let about = random.vector(-1.0, 1.0).normalize_or(DVec3::X);
        let R_WO = match of.pole {
            _ if of.lowest => crate::palms::lowest(&Ellipsoid::new(axes)?, normals, turned).R_WO,
            Some(angle) => {
                let at_pole =
                    DQuat::from_rotation_arc(DVec3::new(angle.sin(), 0.0, angle.cos()), -normals[0]);
                DQuat::from_axis_angle(normals[0], about.x) * at_pole
            }
            None => turned,
        };
        let start = InitialMotion { R_WO, w_WO: about * (of.spin / natural) };
        Ok(Self { of, axes, mass, scene, start })
    }

    /// Weight, N.
    pub(in super::super) fn scale(&self) -> Scale {
        Scale { size: self.of.size, weight: self.mass.mass() * G }
    }

    /// Sample times of the whole log.
    pub(in super::super) fn times(&self) -> SampleTimes {
        let natural = self.of.natural();
        SampleTimes { duration: self.of.lasts * natural, rate: self.of.rate / natural }
    }
}

impl Motion {
    /// A motion over the whole log, of the first body that stays on its palms so long; of the one that stays longest where none does.
    pub(in super::super) fn drawn(of: Spec, seed: u64) -> Result<Self, Failure> {
        let tried = if of.may_end { 1 } else { TRIED };
        let mut longest: Option<Self> = None;
        let mut failure: Option<Failure> = None;
        for attempt in 0..tried {
            let seed = seed * TRIED + attempt;
            let scene = Scene::drawn(of, seed)?;
            let times = scene.times();
            let simulation = match scene.scene.simulate(scene.start, times, Tolerance::uniform(TOLERANCE)) {
                Ok(simulation) => simulation,
                Err(error) => {
                    failure = Some(error.into());
                    continue;
                }
            };
            let samples = simulation.instants.len();
            let whole = samples as f64 >= times.duration * times.rate;
            if longest.as_ref().is_none_or(|other| other.simulation.instants.len() < samples) {
                longest = Some(Self { scene, simulation, seed });
            }
            if whole {
                break;
            }
        }
        longest
            .filter(|of| of.simulation.instants.len() > 1)
            .ok_or_else(|| failure.unwrap_or_else(|| "contact is lost at once".into()))
    }

    /// What is sensed, noisy and with what is not as stated, and the noise of contacts (m) and forces (N) as stated.
    pub(in super::super) fn log(&self) -> Result<(SensorLog, [f64; 2]), Failure> {
        let Scene { of, scene, .. } = &self.scene;
        let scale = self.scene.scale();
        let clean = self.simulation.sensor_log(scene)?.split_truth().0;
        let clean = if of.delay > 0.0 { late(&clean, of.delay * of.rate)? } else { clean };
        let [contact, force] = [of.noise[0] * scale.size, of.noise[1] * scale.weight];
        let noise = SensorNoise { contact, force, torque: force * scale.size };
        let noise = SensorNoise {
            contact: noise.contact * of.unstated,
            force: noise.force * of.unstated,
            torque: noise.torque * of.unstated,
        };
        let mut log = clean.with_noise(&noise, self.seed)?;
        if of.correlation > 0.0 {
            log = correlated(&clean, &log, of.correlation)?;
        }
        if let Some(fault) = &of.fault {
            log = fault.of_log(&log, scale)?;
        }
        let mut samples = log.samples().to_vec();
        for palm in samples.iter_mut().flat_map(|sample| &mut sample.palms) {
            *(if of.by_torques { &mut palm.force } else { &mut palm.torque }) = None;
        }
        Ok((SensorLog::new(samples, None)?, [contact, force]))
    }

    /// The true motion at the time of a sample.
    pub(in super::super) fn at(&self, t: f64) -> Option<&Instant> {
        let times = self.scene.times();
        self.simulation.instants.get((t * times.rate).round() as usize)
    }

    /// What is told of the body.
    pub(in super::super) fn told(&self) -> MassProperties {
        let own = self.scene.mass;
        self.scene.of.fault.map_or(own, |fault| fault.of_mass(own))
    }
}

/// State of an instant.
pub(in super::super) fn state(now: &Instant) -> BodyState {
    BodyState { p_WCm: now.touch.p_WCm, v_WCm: now.rates.v_WCm, w_WO: now.w_WO, R_WO: now.R_WO }
}

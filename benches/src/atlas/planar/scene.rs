//! Random bodies between two hinged palms, changed along a way of failing.

use super::super::{Failure, G, Way};
use crate::planar::broken::Wrong;
use crate::planar::scene::Scene;
use recon::contact_kinematics::planar::{FourierBody, RadiusFunction};
use recon::object_dynamics::planar::{HarmonicPalms, PlanarLog, PlanarMass, PlanarObject, PlanarStart};
use recon_tests::Random;
use std::f64::consts::{PI, TAU};

/// Bodies that are tried for one that stays between its palms.
const TRIED: u64 = 8;

/// What a scene is drawn from, in natural units of its mean radius.
#[derive(Clone, Copy)]
pub(in super::super) struct Spec {
    pub(in super::super) size: f64,
    /// Of the harmonics of the outline.
    pub(in super::super) shape: f64,
    /// Between the palms, rad.
    pub(in super::super) wedge: Option<f64>,
    pub(in super::super) swing: [f64; 2],
    pub(in super::super) spin: f64,
    pub(in super::super) lasts: f64,
    pub(in super::super) rate: f64,
    pub(in super::super) noise: [f64; 2],
    pub(in super::super) unstated: f64,
    pub(in super::super) correlation: f64,
    pub(in super::super) taxels: f64,
    pub(in super::super) by_torques: bool,
    pub(in super::super) may_end: bool,
    pub(in super::super) wrong: Wrong,
}

impl Spec {
    /// Of a way.
    pub(in super::super) fn of(way: Way, strength: f64) -> Self {
        let base = Self {
            size: 0.05,
            shape: 1.0,
            wedge: None,
            swing: [0.2, 0.3],
            spin: 0.4,
            lasts: 10.0,
            rate: 10.0,
            noise: [1e-3, 3e-3],
            unstated: 1.0,
            correlation: 0.0,
            taxels: 0.0,
            by_torques: false,
            may_end: false,
            wrong: Wrong::Nothing,
        };
        let natural = (base.size / G).sqrt();
        let broken = |wrong| Self { wrong, ..base };
        let degrees = strength.to_radians();
        match way {
            Way::Parallel => Self { wedge: Some(degrees), ..base },
            Way::Flat => Self { wedge: Some(PI - 2.0 * degrees), ..base },
            Way::Hinge => {
                Self { wedge: Some(PI - 2.0 * degrees), by_torques: true, swing: [0.0, 1.0], ..base }
            }
            Way::Sphere => Self { shape: 2.0 * strength, ..base },
            Way::Relative => Self { swing: [0.2, 2.0 * strength], ..base },
            Way::Force => Self { spin: strength, may_end: true, ..base },
            Way::Slow => Self { spin: strength, swing: [0.0, 1.0], ..base },
            Way::Window => Self { lasts: strength, ..base },
            Way::Noise => Self { noise: [strength, 3.0 * strength], ..base },
            Way::Unstated => Self { unstated: strength, ..base },
            Way::Correlation => Self { correlation: strength, ..base },
            Way::Taxels => Self { taxels: strength, ..base },
            Way::Bias => broken(Wrong::Bias(strength)),
            Way::Gain => broken(Wrong::Gain(strength)),
            Way::Delay => broken(Wrong::ForcesLate(strength * natural)),
            Way::Outliers => broken(Wrong::Outliers(strength)),
            Way::Gap => broken(Wrong::Gap(strength * natural)),
            Way::Mass => broken(Wrong::Mass(strength)),
            Way::Inertia => broken(Wrong::Inertia(strength)),
            Way::Palm => broken(Wrong::Palm(strength)),
            Way::Rate => Self { rate: strength, ..base },
            Way::Shaking => Self { swing: [0.1_f64.min(0.3 / (strength * strength)), strength], ..base },
            Way::Long => Self { lasts: strength, rate: 10.0, ..base },
            Way::Size => Self { size: strength, ..base },
            _ => base,
        }
    }

    /// One body between its palms; none that is not convex.
    pub(in super::super) fn scene(&self, seed: u64) -> Result<Option<Scene>, Failure> {
        let mut random = Random::new(seed);
        let mut between = |a: f64, b: f64| random.within(a, b);
        let (length, time) = (self.size, (self.size / G).sqrt());
        let mut part = |most: f64| length * self.shape * between(-most, most);
        let cosines = [length, part(0.2), part(0.11), part(0.04), part(0.02)];
        let sines = [0.0, part(0.2), part(0.11), part(0.04), part(0.02)];
        let Ok(shape) = FourierBody::new(&cosines, &sines) else { return Ok(None) };
        if shape.radius_bounds().min < 0.1 * length {
            return Ok(None);
        }
        let mass = PlanarMass::from_gyration(
            200.0 * length * length * between(0.5, 2.0),
            length * length * between(0.35, 0.6),
        )?;
        let (drawn, middle) = (between(1.2, 2.0), between(-0.2, 0.2));
        let wedge = self.wedge.unwrap_or(drawn);
        let (amplitude, frequency) = (self.swing[0].min(0.3 * wedge), self.swing[1] / time);
        let palms = HarmonicPalms {
            centres: [0.5 * (PI - wedge) + middle * wedge.min(PI - wedge).min(1.0), wedge],
            amplitudes: [amplitude, 0.4 * amplitude.min(PI - wedge)],
            frequencies: [frequency, frequency * between(0.6, 1.4)],
            phases: [between(0.0, TAU), between(0.0, TAU)],
        };
        let way = if between(-1.0, 1.0) > 0.0 { 1.0 } else { -1.0 };
        let start = PlanarStart { phi0: between(0.0, TAU), omega0: way * self.spin / time };
        let object = PlanarObject { shape, mass, gravity: G };
        Ok(Some(Scene { object, palms, start, length, time, lasts: self.lasts }))
    }

    /// The scene that lasts, or lasts longest, with its log.
    pub(super) fn drawn(&self, seed: u64) -> Result<(Scene, PlanarLog), Failure> {
        let tried = if self.may_end { 1 } else { TRIED };
        let mut longest: Option<(Scene, PlanarLog)> = None;
        let mut failure: Failure = "contact is lost at once".into();
        for attempt in 0..tried {
            let Some(scene) = self.scene(seed * TRIED + attempt)? else { continue };
            match self.wrong.log(&scene, self.rate / scene.time) {
                Ok(log) => {
                    let whole =
                        log.samples().last().is_some_and(|last| last.t >= (self.lasts - 1.0) * scene.time);
                    if longest.as_ref().is_none_or(|(_, other)| other.samples().len() < log.samples().len()) {
                        longest = Some((scene, log));
                    }
                    if whole {
                        break;
                    }
                }
                Err(error) => failure = error,
            }
        }
        longest.ok_or(failure)
    }
}

/// Noise that is alike, contacts at taxels, torques alone.
pub(super) fn misread(of: &Spec, exact: &PlanarLog, noisy: &PlanarLog) -> Result<PlanarLog, Failure> {
    let mut samples = noisy.samples().to_vec();
    let fresh = (1.0 - of.correlation * of.correlation).sqrt();
    let mut held = [0.0; 4];
    for (k, sample) in samples.iter_mut().enumerate() {
        let clean = &exact.samples()[k];
        let (before, share) = if k == 0 { (0.0, 1.0) } else { (of.correlation, fresh) };
        let colour = |held: &mut f64, value: &mut f64, exact: f64| {
            *held = before * *held + share * (*value - exact);
            *value = exact + *held;
        };
        for i in 0..2 {
            if let (Some(s), Some(e)) = (&mut sample.contacts[i], clean.contacts[i]) {
                colour(&mut held[i], s, e);
                if of.taxels > 0.0 {
                    let pitch = of.taxels * of.size;
                    *s = (*s / pitch).round() * pitch;
                }
            }
            if let (Some(f), Some(e)) = (&mut sample.forces, clean.forces) {
                colour(&mut held[2 + i], &mut f[i], e[i]);
            }
        }
        *(if of.by_torques { &mut sample.forces } else { &mut sample.torques }) = None;
    }
    Ok(PlanarLog::new(samples, noisy.truth().map(<[_]>::to_vec))?)
}

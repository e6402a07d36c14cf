//! A contact that is drawn: it sticks with a wandering force, breaks loose, slides with a wandering speed, and comes to rest.

use super::{Moment, settle};
use crate::Random;
use nalgebra::{Matrix2, Matrix6, Vector2};
use recon::object_dynamics::ContactMode;
use recon::observer::contact_modes::{ContactReading, ContactSeen, ContactSlip};

const DT: f64 = 1e-3;
const FORCE_NOISE: f64 = 0.02;
/// Of each component of the slip, white, in shares of the natural speed, which is 1 here.
const SLIP_NOISE: f64 = 3.6e-3;

/// Normal numbers by the transform of Box and Muller.
#[derive(Clone, Debug)]
pub(crate) struct Normal(Random);

impl Normal {
    pub(crate) fn new(random: Random) -> Self {
        Self(random)
    }

    pub(crate) fn draw(&mut self) -> f64 {
        let (a, b) = (self.0.within(0.0, 1.0), self.0.within(0.0, 1.0));
        (-2.0 * (1.0 - a).ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

/// Samples at 1 kHz of one contact with this friction; the natural speed is 1 m/s. Speeds and ratios follow smooth paths, not the
/// walks that the classifier assumes: ratios are sums of sines within and beyond the cone, sliding starts where they cross it,
/// and its speed is driven by a smooth push that comes and goes.
#[must_use]
pub fn drawn(friction: f64, samples: usize, seed: u64) -> Vec<Moment> {
    let mut random = Random::new(seed);
    let waves: Vec<[f64; 3]> = (0..4)
        .map(|_| [random.within(0.2, 0.5), random.within(3.0, 20.0), random.within(0.0, 6.0)])
        .collect();
    let heading = random.within(0.0, 6.0);
    let mut normal = Normal::new(random);
    let (mut speed, mut slides) = (0.0_f64, false);
    let mut moments = Vec::new();
    for k in 0..samples {
        let t = k as f64 * DT;
        // What would be needed to stick, in shares of the friction.
        let needed: f64 = waves.iter().map(|[size, rate, phase]| size * (rate * t + phase).sin()).sum();
        let needed = (0.7 + needed).abs();
        slides |= needed > 1.0;
        if slides {
            speed += 3.0 * friction * (needed - 1.0) * DT;
            if speed <= 0.0 {
                (speed, slides) = (0.0, false);
            }
        }
        let ratio = friction * if slides { 1.0 } else { needed.min(1.0) };
        let u = Vector2::new((heading + 2.0 * t).cos(), (heading + 2.0 * t).sin());
        let force_deviation = FORCE_NOISE * (1.0 + ratio * ratio).sqrt();
        let mut noise = |deviation: f64| deviation * Vector2::new(normal.draw(), normal.draw());
        let (force, slip, along) = (noise(force_deviation), noise(SLIP_NOISE), noise(force_deviation).x);
        let covariance = Matrix2::identity() * (SLIP_NOISE * SLIP_NOISE);
        let reading = ContactReading {
            normal_force: 1.0 + along,
            friction: ratio * u + force,
            force_deviation,
            slip: Some(ContactSlip { velocity: slip - speed * u, covariance }),
            touches: false,
        };
        moments.push(Moment {
            dt: DT,
            seen: vec![ContactSeen::Read(reading)],
            slopes: Vec::new(),
            covariance: Matrix6::identity(),
            truth: vec![if slides { ContactMode::Slide } else { ContactMode::Stick }],
            settled: vec![true],
        });
    }
    settle(&mut moments);
    moments
}

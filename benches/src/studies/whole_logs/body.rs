//! Random bodies on random palms, and their noisy logs.

use super::Failure;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    BodyState, InitialMotion, MassProperties, SampleTimes, SensorLog, SensorNoise, ThreePalmScene,
};
use recon_benches::fault::Scale;
use recon_tests::Random;
use std::f64::consts::TAU;

pub(crate) const G: f64 = 9.81;
/// Natural times that a log lasts at least.
const SHORTEST: f64 = 5.0;

/// A body on its palms.
pub(crate) struct Body {
    pub(crate) size: f64,
    pub(crate) mass: MassProperties,
    scene: ThreePalmScene<Ellipsoid>,
    start: InitialMotion,
    seed: u64,
}

/// So many bodies.
pub(crate) fn some(count: usize, seed: u64) -> Result<Vec<Body>, Failure> {
    let mut random = Random::new(seed);
    let mut all = Vec::with_capacity(count);
    while all.len() < count {
        let body = one(&mut random, seed + all.len() as u64)?;
        // Of six seconds, so that all lengths are of the same bodies.
        if body.log(0.0, 100.0, 6.0)?.is_some() {
            all.push(body);
        }
    }
    Ok(all)
}

fn one(random: &mut Random, seed: u64) -> Result<Body, Failure> {
    let size = random.within(0.02_f64.ln(), 3.0_f64.ln()).exp();
    let axes = random.vector(1.0, 3.0);
    let axes = axes * (3.0 * size / axes.element_sum());
    let mass = random.within(300.0, 3000.0) * 2.0 / 3.0 * TAU * axes.element_product();
    let moments = MassProperties::uniform_ellipsoid(mass, axes)?.principal().moments;
    let mass = MassProperties::from_principal(mass, moments * random.vector(0.9, 1.1))?;
    let mut palms = Vec::with_capacity(3);
    for k in 0..3 {
        let azimuth = f64::from(k) * TAU / 3.0 + random.within(-0.3, 0.3);
        palms.push(Palm::fixed(azimuth, random.within(35.0_f64.to_radians(), 85.0_f64.to_radians()))?);
    }
    let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palms[0], palms[1], palms[2]], G)?;
    let spin = random.within(0.0, 0.6) * (G / size).sqrt();
    let R_WO = DQuat::from_scaled_axis(random.vector(-3.0, 3.0));
    let start = InitialMotion { R_WO, w_WO: random.vector(-1.0, 1.0).normalize_or(DVec3::X) * spin };
    Ok(Body { size, mass, scene, start, seed })
}

impl Body {
    pub(crate) fn scale(&self) -> Scale {
        Scale { size: self.size, weight: self.mass.mass() * G }
    }

    /// Noise of contacts, m, and forces, N.
    pub(crate) fn noise(&self, share: f64) -> [f64; 2] {
        [share * self.size, share * self.mass.mass() * G]
    }

    /// Its noisy log and its motion; none that is too short.
    pub(crate) fn log(
        &self,
        noise: f64,
        rate: f64,
        seconds: f64,
    ) -> Result<Option<(SensorLog, Vec<BodyState>)>, Failure> {
        let times = SampleTimes { duration: seconds, rate };
        let Ok(simulation) = self.scene.simulate(self.start, times, Tolerance::uniform(1e-11)) else {
            return Ok(None);
        };
        let lasts = simulation.instants.len() as f64 / rate;
        if lasts < SHORTEST * (self.size / G).sqrt() {
            return Ok(None);
        }
        let truth = simulation.instants.iter().map(|now| BodyState {
            p_WCm: now.touch.p_WCm,
            v_WCm: now.rates.v_WCm,
            w_WO: now.w_WO,
            R_WO: now.R_WO,
        });
        let [contact, force] = self.noise(noise);
        let noise = SensorNoise { contact, force, ..SensorNoise::default() };
        let clean = simulation.sensor_log(&self.scene)?.split_truth().0;
        let seed = self.seed * 1000 + (rate + 10.0 * seconds) as u64;
        Ok(Some((clean.with_noise(&noise, seed)?, truth.collect())))
    }
}

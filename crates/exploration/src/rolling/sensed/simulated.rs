//! Palms and a body by the equations of motion, with Coulomb friction and noise of the sensors.

use super::super::dynamics::{off, scene};
use super::hands::{Hands, HandsError};
use contact_kinematics::planar::{PalmSurface, RadiusFunction};
use glam::DVec2;
use object_dynamics::planar::{
    BodyState, ContactLog, ContactLogSample, ContactNoise, ContactScene, ContactSimulation, ContactStart,
    PlanarObject, PlanarTruth,
};
use object_dynamics::{ChannelNoise, ContactMode};
use observer::contacts::{ContactNoiseLevel, ImpulseNoise};
use observer::planar::PlaneOptions;

/// Relative tolerance of the integrator in a step.
const TOLERANCE: f64 = 1e-9;

/// A simulated body between two simulated palms.
pub struct SimulatedHands<S> {
    object: PlanarObject<S>,
    friction: f64,
    length: f64,
    palms: [f64; 2],
    rate: f64,
    start: ContactStart,
    samples: Vec<ContactLogSample>,
    truth: Vec<PlanarTruth>,
    noise: (ContactNoise, u64),
}

impl<S: RadiusFunction + Clone> SimulatedHands<S> {
    /// `object` is put between palms at absolute angles (rad) of the given coefficient of friction and length (m), at the orientation `phi` (rad) at
    /// which it touches both, at rest. Sensors are read `rate` times a second.
    ///
    /// # Errors
    /// [`HandsError::Scene`] and [`HandsError::Start`].
    pub fn new(
        object: PlanarObject<S>,
        friction: f64,
        length: f64,
        palms: [f64; 2],
        phi: f64,
        rate: f64,
    ) -> Result<Self, HandsError> {
        let start = ContactStart::default();
        let (samples, truth, noise) = (Vec::new(), Vec::new(), (ContactNoise::default(), 0));
        let mut hands = Self { object, friction, length, palms, rate, start, samples, truth, noise };
        let scene = hands.scene(palms, [0.0, 1.0])?;
        let bounds = hands.object.shape.radius_bounds();
        let (middle, half) = (0.5 * (palms[0] + palms[1]), 0.5 * (palms[1] - palms[0]));
        let far = 0.5 * (bounds.min + bounds.max) / half.sin();
        let guess = BodyState { p_WCm: DVec2::from_angle(middle) * far, phi0: phi, ..BodyState::default() };
        hands.start = ContactStart { body: scene.place(0.0, guess, &[0, 1])?, contacts: vec![0, 1] };
        Ok(hands)
    }

    /// Orientation at the first sample, rad: there the axes of the estimate are those of the world.
    #[must_use]
    pub fn start_phi(&self) -> f64 {
        self.truth.first().map_or(self.start.body.phi0, |first| first.phi0)
    }

    /// With seeded normal noise: standard deviations of a contact along its palm, in m, and of each axis of a force, in N, which an impulse has as the
    /// force does over one interval.
    #[must_use]
    pub fn with_noise(self, [contact, force]: [f64; 2], seed: u64) -> Self {
        let channel = |fixed: f64| ChannelNoise { fixed, ..ChannelNoise::default() };
        let noise = ContactNoise { contact, force: channel(force), impulse: channel(force / self.rate) };
        Self { noise: (noise, seed), ..self }
    }

    /// What an estimator is told of them: noise as it is, conditions that are off by `floor` (m/s) beside it, and that there is no friction where there
    /// is none; of one that there is nothing.
    #[must_use]
    pub fn sensors(&self, floor: f64) -> PlaneOptions {
        let ContactNoise { contact, force, impulse } = self.noise.0;
        let impulse = Some(ImpulseNoise { fixed: impulse.fixed, share: 0.0 });
        let noise = ContactNoiseLevel { contact, force_fixed: force.fixed, force_share: 0.0, impulse, floor };
        let friction = vec![(self.friction == 0.0).then_some(0.0); 2];
        let gravity = self.object.gravity;
        PlaneOptions::new(noise, gravity, friction)
    }

    /// Takes the samples of another motion that began at the last sample, whose impulses count from there.
    fn take(&mut self, run: &ContactSimulation, log: &ContactLog) {
        let before = self.samples.last().map(|last| last.palms.iter().map(|p| p.impulse).collect::<Vec<_>>());
        let known = usize::from(before.is_some());
        for (sample, at) in log.samples().iter().zip(&run.instants).skip(known) {
            let mut sample = sample.clone();
            for (palm, sum) in sample.palms.iter_mut().zip(before.iter().flatten()) {
                palm.impulse = palm.impulse.zip(*sum).map(|(now, sum)| now + sum);
            }
            self.samples.push(sample);
            self.truth.push(at.body.into());
        }
    }

    fn scene(&self, to: [f64; 2], times: [f64; 2]) -> Result<ContactScene<S>, HandsError> {
        let PlanarObject { shape, mass, gravity } = &self.object;
        let object = PlanarObject { shape: shape.clone(), mass: *mass, gravity: *gravity };
        Ok(scene(object, self.friction, [self.palms, to], times)?)
    }
}

impl<S: RadiusFunction + Clone> Hands for SimulatedHands<S> {
    fn palms(&self) -> [f64; 2] {
        self.palms
    }

    fn turn(&mut self, to: [f64; 2], seconds: f64, wait: f64) -> Result<(), HandsError> {
        let start = self.samples.last().map_or(0.0, |s| s.t);
        let duration = seconds.max(1.0 / self.rate);
        let scene = self.scene(to, [start, duration])?;
        let count = ((duration + wait) * self.rate).ceil() as usize;
        let times: Vec<f64> = (0..=count).map(|k| start + k as f64 / self.rate).collect();
        let run = scene.simulate(&self.start, &times, TOLERANCE)?;
        if let Some((palm, s)) = off(&run.instants, self.length) {
            return Err(HandsError::Off { palm, s, length: self.length });
        }
        self.take(&run, &run.log(&scene)?);
        if let Some(last) = run.instants.last() {
            let touching = (0..2).filter(|i| last.modes[*i] != ContactMode::Off).collect();
            self.start = ContactStart { body: last.body, contacts: touching };
        }
        self.palms = to;
        Ok(())
    }

    fn log(&self) -> Result<ContactLog, HandsError> {
        let truth = Some(self.truth.clone());
        let log = ContactLog::new(vec![PalmSurface::Line; 2], self.samples.clone(), truth)?;
        let (noise, seed) = &self.noise;
        Ok(noise.add_to(&log, *seed))
    }
}

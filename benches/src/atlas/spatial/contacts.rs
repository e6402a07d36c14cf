//! Motions with friction, with landings, with palms that rub, as logs of contacts.

use super::super::{Failure, G, Way};
use super::scene::{Scene, Spec};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, MotionPart, PalmFrame, PalmSurface, SurfaceMotion, SurfacePose,
};
use recon::object_dynamics::{
    BodyState, ChannelNoise, ContactLog, ContactNoise, ContactScene, ContactSimulation, ContactStart,
    ForceChannel, MassProperties, PalmDrive, ScenePalm,
};
use recon_tests::Random;
use std::f64::consts::TAU;

/// Relative tolerance of these simulations.
const TOLERANCE: f64 = 1e-8;
/// Friction of palms that rub.
const RUBBING: f64 = 0.3;

/// A log of contacts with what is true of it.
pub(super) struct LoggedMotion {
    pub(super) log: ContactLog,
    pub(super) truth: Vec<BodyState>,
    /// Of contacts, m, and forces, N.
    pub(super) noise: [f64; 2],
    pub(super) mass: MassProperties,
    /// As it is told.
    pub(super) friction: Option<f64>,
    pub(super) size: f64,
}

/// A scene with friction and how it begins.
pub(in super::super) struct Rubbed {
    pub(in super::super) scene: ContactScene<Ellipsoid>,
    pub(in super::super) start: ContactStart,
    pub(in super::super) flat: Scene,
}

impl Rubbed {
    /// A body on (or above) three planes, of a way and a strength.
    pub(in super::super) fn drawn(way: Way, strength: f64, seed: u64) -> Result<Self, Failure> {
        let of = Spec::of(way, strength);
        let (friction, height, swing) = match way {
            Way::Drop => (0.0, strength * of.size, [0.0, 1.0]),
            Way::Friction => (strength, 0.0, [0.0, 1.0]),
            Way::Switches => (RUBBING, 0.0, [0.15, strength]),
            _ => (RUBBING, 0.0, of.swing),
        };
        let rubbing = matches!(way, Way::Switches);
        let flat = Scene::drawn(Spec { swing: [0.0, 1.0], lowest: rubbing || of.lowest, ..of }, seed)?;
        let mut random = Random::new(seed ^ 0xF00D);
        let mut palms = Vec::with_capacity(3);
        for k in 0..3 {
            palms.push(palm(&flat, k, swing, friction, &mut random)?);
        }
        let scene = ContactScene::new(Ellipsoid::new(flat.axes)?, flat.mass, palms, G)?;
        let spin = if rubbing { DVec3::ZERO } else { flat.start.w_WO };
        let now = flat.scene.instant(0.0, flat.start.R_WO, spin)?;
        let body = BodyState {
            p_WCm: now.touch.p_WCm + height * DVec3::Z,
            v_WCm: if height > 0.0 { DVec3::ZERO } else { now.rates.v_WCm },
            w_WO: spin,
            R_WO: flat.start.R_WO,
        };
        let start = ContactStart { in_flight: height > 0.0, ..ContactStart::touching(body) };
        Ok(Self { scene, start, flat })
    }

    /// Its motion.
    pub(in super::super) fn simulate(&self, tolerance: f64) -> Result<ContactSimulation, Failure> {
        Ok(self.scene.simulate(&self.start, self.flat.times(), tolerance)?)
    }
}

/// A plane through the origin that swings about its own horizontal axis from where it stands.
fn palm(
    flat: &Scene,
    k: usize,
    [amplitude, rate]: [f64; 2],
    friction: f64,
    random: &mut Random,
) -> Result<ScenePalm, Failure> {
    let n = flat.scene.palms()[k].at(0.0).frame.n;
    let frame = PalmFrame::from_normal(Direction::new(n)?)?;
    let pose = SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&frame.rotation()))?;
    let frequency = rate * random.within(0.7, 1.3) / flat.of.natural();
    // From rest, so that a body at rest is at rest against it: as a cosine, with its mean taken off.
    let law = MotionLaw::Sinusoid { mean: -amplitude, amplitude, frequency, phase: 0.25 * TAU };
    let turn = MotionPart::Turn { pivot: DVec3::ZERO, axis: Direction::new(frame.t1)?, law };
    let parts = if amplitude > 0.0 { vec![turn] } else { Vec::new() };
    let drive = PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts });
    Ok(ScenePalm { surface: PalmSurface::Plane, drive, friction })
}

/// A noisy log of a way and a strength, its forces with a noise of their own (weights) where it is stated.
pub(super) fn logged(
    (way, strength): (Way, f64),
    force: Option<f64>,
    seed: u64,
) -> Result<LoggedMotion, Failure> {
    let rubbed = Rubbed::drawn(way, strength, seed)?;
    let simulation = rubbed.simulate(TOLERANCE)?;
    let (exact, truth) = ContactLog::from_simulation(&rubbed.scene, &simulation)?.split_truth();
    let Scene { of, mass, .. } = rubbed.flat;
    let noise = [of.noise[0] * of.size, force.unwrap_or(of.noise[1]) * mass.mass() * G];
    let force = ChannelNoise { fixed: noise[1], share: 0.0 };
    let added = ContactNoise { contact: noise[0], force, ..ContactNoise::default() };
    let mut records = exact.with_noise(&added, seed)?.records();
    for record in &mut records {
        // Neither the coefficient nor impulses are told.
        record.friction = None;
        record.impulse = ForceChannel::Missing;
    }
    let log = ContactLog::new(exact.times().to_vec(), records, None)?;
    let friction = if matches!(way, Way::Switches) { None } else { Some(0.0) };
    Ok(LoggedMotion { log, truth: truth.unwrap_or_default(), noise, mass, friction, size: of.size })
}

//! Scenes to simulate, drawn at random: three frictionless planes, three planes that rub, two palms in the plane.

use super::Failure;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::planar::FourierBody;
use recon::contact_kinematics::{Ellipsoid, Palm, PalmFrame, PalmSurface, SurfaceMotion, SurfacePose};
use recon::object_dynamics::{
    BodyState, ContactScene, ContactStart, MassProperties, PalmDrive, SampleTimes, ScenePalm, ThreePalmScene,
    planar,
};
use recon_benches::planar::scene::{Scene as InPlane, drawn};
use recon_tests::Random;
use std::f64::consts::TAU;

const G: f64 = 9.81;
/// Samples in a natural time.
const RATE: f64 = 10.0;

/// What is simulated.
pub(super) enum World {
    Space {
        scene: Box<ContactScene<Ellipsoid>>,
        start: Box<ContactStart>,
        held: Box<ThreePalmScene<Ellipsoid>>,
    },
    Plane {
        scene: Box<planar::ContactScene<FourierBody>>,
        start: planar::ContactStart,
    },
}

/// A scene to simulate.
pub(super) struct Scene {
    pub(super) kind: &'static str,
    pub(super) world: World,
    pub(super) size: f64,
    pub(super) times: SampleTimes,
}

impl Scene {
    pub(super) fn rubs(&self) -> bool {
        match &self.world {
            World::Space { scene, .. } => scene.palms().iter().any(|palm| palm.friction > 0.0),
            World::Plane { scene, .. } => scene.palms().iter().any(|palm| palm.friction > 0.0),
        }
    }
}

/// One of a kind, from 0; none where the body is not convex or loses its hold at once.
pub(super) fn scene(kind: usize, seed: u64) -> Result<Option<Scene>, Failure> {
    match kind {
        0 => three_planes("three planes", 0.0, seed),
        1 => {
            let friction = Random::new(seed ^ 77).within(0.05, 0.5);
            three_planes("three planes that rub", friction, seed)
        }
        2 => in_plane(seed),
        _ => {
            let friction = Random::new(seed ^ 77).within(0.01, 0.04);
            three_planes("three planes that rub a little", friction, seed)
        }
    }
}

fn three_planes(kind: &'static str, friction: f64, seed: u64) -> Result<Option<Scene>, Failure> {
    let mut random = Random::new(seed);
    let size = random.within(0.02_f64.ln(), 1.0_f64.ln()).exp();
    let axes = random.vector(1.0, 2.5);
    let axes = axes * (3.0 * size / axes.element_sum());
    let mass = random.within(300.0, 3000.0) * 2.0 / 3.0 * TAU * axes.element_product();
    let mass = MassProperties::uniform_ellipsoid(mass, axes)?;
    let (mut palms, mut held) = (Vec::with_capacity(3), Vec::with_capacity(3));
    for k in 0..3 {
        let azimuth = f64::from(k) * TAU / 3.0 + random.within(-0.3, 0.3);
        let slope = random.within(0.6, 1.2);
        let pose = DQuat::from_mat3(&PalmFrame::from_azimuth_slope(azimuth, slope).rotation());
        let pose = SurfacePose::new(DVec3::ZERO, pose)?;
        let drive = PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts: Vec::new() });
        palms.push(ScenePalm { surface: PalmSurface::Plane, drive, friction });
        held.push(Palm::fixed(azimuth, slope)?);
    }
    let natural = (size / G).sqrt();
    let R_WO = DQuat::from_scaled_axis(random.vector(-3.0, 3.0));
    let spin = random.vector(-1.0, 1.0).normalize_or(DVec3::X) * random.within(0.1, 0.6) / natural;
    let lasts = random.within(5.0, 25.0);
    let body = Ellipsoid::new(axes)?;
    let held = ThreePalmScene::new(body, mass, [held[0], held[1], held[2]], G)?;
    let now = held.instant(0.0, R_WO, spin)?;
    let scene = ContactScene::new(body, mass, palms, G)?;
    let (p_WCm, v_WCm) = (now.touch.p_WCm, now.rates.v_WCm);
    let start = ContactStart::touching(BodyState { p_WCm, v_WCm, w_WO: spin, R_WO });
    let times = SampleTimes { duration: lasts * natural, rate: RATE / natural };
    let world = World::Space { scene: Box::new(scene), start: Box::new(start), held: Box::new(held) };
    Ok(Some(Scene { kind, world, size, times }))
}

fn in_plane(seed: u64) -> Result<Option<Scene>, Failure> {
    let mut random = Random::new(seed ^ 1234);
    let drawn = drawn(1, seed)?;
    let Some(of) = drawn.first() else { return Ok(None) };
    let InPlane { object, palms, start, length, time, .. } = of;
    let friction = if random.within(0.0, 1.0) < 0.5 { 0.0 } else { random.within(0.05, 0.4) };
    let world = of.any_palms(friction)?;
    let lasts = random.within(5.0, 20.0);
    let times = SampleTimes { duration: lasts * time, rate: RATE / time };
    // As two palms without friction hold it at the start.
    let one = [0.0, 1e-3 * time];
    let Ok(run) = planar::simulate_prescribed(object, palms, *start, &one, 1e-9) else { return Ok(None) };
    let Some(first) = run.samples.first() else { return Ok(None) };
    let t = first.truth;
    let body = planar::BodyState { p_WCm: t.p_WCm, phi0: t.phi0, v_WCm: t.v_WCm, omega0: t.omega0 };
    let start = planar::ContactStart { body, contacts: vec![0, 1] };
    let world = World::Plane { scene: Box::new(world), start };
    Ok(Some(Scene { kind: "two palms in the plane", world, size: *length, times }))
}

//! Motion in the plane from contacts and forces of palms that rub, on bodies, palms and coefficients drawn at random: relied on, right.
//! Prints a table in Markdown.
//!
//! `cargo xtask study planar_estimates_friction [BODIES [SEED]]` writes docs/planar-estimates-friction.md.

use crate::planar_tally::Tally;
use glam::DVec2;
use recon::contact_kinematics::MotionLaw;
use recon::contact_kinematics::planar::{
    FourierBody, MotionPart, PalmSurface, RadiusFunction, SurfaceMotion, SurfacePose,
};
use recon::object_dynamics::planar::*;
use recon::object_dynamics::{ChannelNoise, ContactMode};
use recon::observer::contacts::{ContactNoiseLevel, ImpulseNoise};
use recon::observer::planar::*;
use recon_benches::planar::scene::outline;
use recon_tests::Random;
use std::f64::consts::{PI, TAU};

type Failure = Box<dyn std::error::Error>;

const GRAVITY: f64 = 9.81;
/// Length of a log, natural times.
const LASTS: f64 = 20.0;
/// Coefficients of friction.
const FRICTION: [f64; 2] = [0.05, 0.6];
/// What contact conditions are off by beside noise, natural speeds.
const FLOOR: f64 = 1e-6;

/// A body on two palms that rub.
struct Drawn {
    scene: ContactScene<FourierBody>,
    start: BodyState,
    /// Size (m) and natural time (s).
    length: f64,
    time: f64,
}

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let bodies: usize = words.next().map_or(Ok(40), |a| a.parse())?;
    let seed: u64 = words.next().map_or(Ok(97_000), |a| a.parse())?;
    let mut tried = 0;
    let scenes = drawn(bodies, seed, &mut tried)?;
    let stuck = scenes.iter().map(Drawn::shares).collect::<Result<Vec<_>, _>>()?;
    let blows = scenes.iter().map(Drawn::blows).sum::<Result<usize, _>>()?;
    let mean = |i: usize| 100.0 * stuck.iter().map(|share| share[i]).sum::<f64>() / bodies as f64;
    println!(
        "# Motion in the plane under friction\n\nMade by `cargo xtask study planar_estimates_friction {bodies} {seed}`.\n"
    );
    println!(
        "{bodies} bodies of 2 to 5 harmonics, 3 cm to 3 m, on two palms that swing about their hinge, with friction of {} to {} drawn for each, {LASTS} natural times,",
        FRICTION[0], FRICTION[1]
    );
    println!(
        "from no guess; {tried} scenes were drawn, of which the others jam or do not stay. Contacts are off, slide and stick for {:.0}, {:.0} and {:.0} % of the time, with {blows} blows. Known body, unknown friction.",
        mean(0),
        mean(1),
        mean(2)
    );
    println!(
        "Noise of contacts as a share of the size, of each axis of a force 1 % of the weight, of an impulse as much over the time between samples. Columns as in [planar-estimates.md](planar-estimates.md).\n"
    );
    println!(
        "| rate, Hz | noise | impulses | runs | relied on | silent | mean square | place | us a sample |\n|---|---|---|---|---|---|---|---|---|"
    );
    for rate in [100.0, 250.0, 1000.0] {
        for noise in [1e-3, 1e-2] {
            for impulses in [false, true] {
                let mut tally = Tally::default();
                for (i, scene) in scenes.iter().enumerate() {
                    run(&mut tally, scene, [rate, noise], impulses, seed + i as u64)?;
                }
                let read = if impulses { "read" } else { "not read" };
                println!("| {rate} | {noise} | {read} | {} |", tally.told());
            }
        }
    }
    Ok(())
}

/// Scenes that can be simulated to their end and whose palms are touched for at least half of the time.
fn drawn(count: usize, seed: u64, tried: &mut usize) -> Result<Vec<Drawn>, Failure> {
    let mut random = Random::new(seed);
    let mut all = Vec::new();
    while all.len() < count {
        *tried += 1;
        let Some(scene) = one(&mut random)? else { continue };
        if scene.shares().is_ok_and(|shares| shares[0] < 0.5) {
            all.push(scene);
        }
    }
    Ok(all)
}

/// A scene; none where the body is not convex or has no room.
fn one(random: &mut Random) -> Result<Option<Drawn>, Failure> {
    let mut between = |a: f64, b: f64| random.within(a, b);
    let (length, cosines, sines) = outline(&mut between);
    let gyration = length * length * between(0.3, 0.6);
    let mass = PlanarMass::from_gyration(200.0 * length * length * between(0.5, 2.0), gyration)?;
    let time = (length / GRAVITY).sqrt();
    let (wedge, middle) = (between(60.0, 120.0_f64).to_radians(), between(-20.0, 20.0_f64).to_radians());
    let mut palm = |angle: f64| -> Result<ScenePalm, Failure> {
        let (amplitude, phase) = (between(0.05, 0.4), between(0.0, TAU));
        let law = MotionLaw::Sinusoid {
            mean: -amplitude * phase.sin(),
            amplitude,
            frequency: between(0.05, 0.5) / time,
            phase,
        };
        let turn = MotionPart::Turn { pivot: DVec2::ZERO, law };
        let motion = SurfaceMotion { pose: SurfacePose::new(DVec2::ZERO, angle)?, parts: vec![turn] };
        let friction = between(FRICTION[0], FRICTION[1]);
        Ok(ScenePalm { surface: PalmSurface::Line, motion, friction })
    };
    // The object lies above both lines: the second one is walked towards the hinge.
    let first = PI / 2.0 + middle - wedge / 2.0;
    let palms = vec![palm(first)?, palm(first + wedge - PI)?];
    let start = BodyState {
        p_WCm: DVec2::from_angle(first + wedge / 2.0) * (length / (wedge / 2.0).sin()),
        phi0: between(0.0, TAU),
        omega0: between(-1.0, 1.0) / time,
        ..BodyState::default()
    };
    let Ok(shape) = FourierBody::new(&cosines, &sines) else { return Ok(None) };
    if shape.radius_bounds().min < 0.1 * length {
        return Ok(None);
    }
    let scene = ContactScene::new(PlanarObject { shape, mass, gravity: GRAVITY }, palms)?;
    let Ok(start) = scene.place(0.0, start, &[0, 1]) else { return Ok(None) };
    Ok(Some(Drawn { scene, start, length, time }))
}

impl Drawn {
    fn simulated(&self, rate: f64) -> Result<ContactSimulation, Failure> {
        let count = (LASTS * self.time * rate) as usize;
        let times: Vec<f64> = (0..=count).map(|k| k as f64 / rate).collect();
        let start = ContactStart { body: self.start, contacts: vec![0, 1] };
        Ok(self.scene.simulate(&start, &times, 1e-10)?)
    }

    /// How many blows there are.
    fn blows(&self) -> Result<usize, Failure> {
        let run = self.simulated(10.0 / self.time)?;
        Ok(run.events.iter().filter(|event| event.blow_work.is_some()).count())
    }

    /// Shares of time over which contacts are off, slide and stick.
    fn shares(&self) -> Result<[f64; 3], Failure> {
        let run = self.simulated(10.0 / self.time)?;
        let mut counts = [0.0; 3];
        let modes = run.instants.iter().flat_map(|now| now.modes.iter().take(2));
        modes.for_each(|mode: &ContactMode| counts[usize::from(mode.number())] += 1.0);
        Ok(counts.map(|n| n / (2 * run.instants.len()) as f64))
    }
}

/// One run.
fn run(
    tally: &mut Tally,
    of: &Drawn,
    [rate, noise]: [f64; 2],
    impulses: bool,
    seed: u64,
) -> Result<(), Failure> {
    let force = 0.01 * of.scene.object().mass.mass() * GRAVITY;
    let contact = noise * of.length;
    let level = ContactNoise {
        contact,
        force: ChannelNoise { fixed: force, ..ChannelNoise::default() },
        impulse: ChannelNoise { fixed: force / rate, ..ChannelNoise::default() },
    };
    let log = level.add_to(&of.simulated(rate)?.log(&of.scene)?, seed);
    let noise = ContactNoiseLevel {
        contact,
        force_fixed: force,
        force_share: 0.0,
        impulse: impulses.then_some(ImpulseNoise { fixed: force / rate, share: 0.0 }),
        floor: FLOOR * of.length / of.time,
    };
    let options = PlaneOptions {
        body: Some(of.scene.object().mass),
        suspects: true,
        ..PlaneOptions::new(noise, GRAVITY, vec![None; 2])
    };
    tally.run(&log, &options, of.length, |_| 0.0)?;
    Ok(())
}

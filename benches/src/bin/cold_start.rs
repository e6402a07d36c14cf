//! Cold start on random scenes without noise: how many come out right from no guess, and how long they take.

use glam::DQuat;
use recon::contact_kinematics::{Ellipsoid, Palm};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{InitialMotion, MassProperties, SampleTimes, ThreePalmScene};
use recon::observer::{KnownBody, estimate_motion};
use recon_tests::Random;
use std::time::Instant;

/// Scenes tried; those that lose contact within a second are passed over.
const SCENES: usize = 120;
/// Error of the centre of mass that counts as right, m.
const RIGHT: f64 = 1e-6;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let mut random = Random::new(1);
    let (mut tried, mut right, mut reported) = (0, 0, 0);
    let mut times = Vec::new();
    for _ in 0..SCENES {
        let Some((error, reliable, milliseconds)) = scene(&mut random)? else { continue };
        tried += 1;
        right += usize::from(error < RIGHT);
        reported += usize::from(error >= RIGHT && !reliable);
        times.push(milliseconds);
    }
    times.sort_by(f64::total_cmp);
    let share = |p: f64| times.get(((times.len() as f64 - 1.0) * p) as usize).copied().unwrap_or(f64::NAN);
    println!("# Cold start on random scenes\n\nMade by `cargo xtask study cold_start`.\n");
    println!(
        "Ellipsoids of semi-axes 1 to 2.5 m on three palms, spin up to 1.4 rad/s, 1 to 4 s at 1 kHz without noise;"
    );
    println!(
        "mass and inertia known, nothing else. Right: centre of mass within {RIGHT:e} m over the whole log.\n"
    );
    println!("| scenes | right | wrong and reported | wrong in silence | median ms | 90 % ms | slowest ms |");
    println!("|---|---|---|---|---|---|---|");
    let silent = tried - right - reported;
    let (median, most, slowest) = (share(0.5), share(0.9), share(1.0));
    println!("| {tried} | {right} | {reported} | {silent} | {median:.0} | {most:.0} | {slowest:.0} |");
    Ok(())
}

/// Largest error (m), whether it is relied on, and the time (ms) of one scene; none if it loses contact too soon.
fn scene(random: &mut Random) -> Result<Option<(f64, bool, f64)>, Failure> {
    let axes = random.vector(1.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(random.within(0.5, 2.5), axes)?;
    let mut palms = Vec::with_capacity(3);
    for k in 0..3 {
        let azimuth = f64::from(k) * std::f64::consts::TAU / 3.0 + random.within(-0.3, 0.3);
        palms.push(Palm::fixed(azimuth, random.within(0.8, 1.2))?);
    }
    let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palms[0], palms[1], palms[2]], 9.81)?;
    let start = InitialMotion {
        R_WO: DQuat::from_scaled_axis(random.vector(-3.0, 3.0)),
        w_WO: random.vector(-0.8, 0.8),
    };
    let times = SampleTimes { duration: 4.0, rate: 1000.0 };
    let Ok(simulation) = scene.simulate(start, times, Tolerance::uniform(1e-13)) else { return Ok(None) };
    if simulation.instants.len() < 1000 {
        return Ok(None);
    }
    let log = simulation.sensor_log(&scene)?.without_truth();
    let known = KnownBody { mass, gravity: scene.gravity(), palm_inertias: None, noise: None };
    let clock = Instant::now();
    let estimate = estimate_motion(&log, &known)?;
    let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
    let pairs = estimate.motion.iter().zip(&simulation.instants);
    let error = pairs.map(|(m, now)| m.p_WCm.distance(now.touch.p_WCm)).fold(0.0, f64::max);
    Ok(Some((error, estimate.reliability.is_reliable(), milliseconds)))
}

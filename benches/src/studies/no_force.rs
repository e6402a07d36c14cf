//! Three palms without force sensors: random scenes from no guess, without noise and with it.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, MotionLaw, Palm, Translated};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, MassProperties, SampleTimes, SensorLog, SensorNoise, ThreePalmScene,
};
use recon::observer::three_palms::no_force::{KnownTouch, NoForceError, estimate_without_forces};
use recon_tests::Random;
use std::time::Instant;

/// Scenes of a row, if not stated; those that lose contact too early are passed over.
const SCENES: usize = 50;
const SEED: u64 = 4;
/// Smallest and largest ratio of the longest semi-axis to the shortest one.
const FORMS: (f64, f64) = (1.05, 6.0);
/// Longest and shortest log, s.
const DURATION: (f64, f64) = (3.0, 2.0);
/// Error of the semi-axes that counts as right without noise, as a share of the largest.
const RIGHT: f64 = 1e-6;
/// Error in standard deviations that counts as right under noise.
const DEVIATIONS: f64 = 5.0;

type Failure = Box<dyn std::error::Error>;

/// Milliseconds; none where nothing fits, then whether it is right, none where it is not determined, and the error of the largest moment.
type Run = (f64, Option<(Option<bool>, Option<f64>)>);

#[derive(Default)]
struct Count {
    tried: usize,
    right: usize,
    open: usize,
    missed: usize,
    silent: usize,
    milliseconds: Vec<f64>,
    /// Relative errors of the largest principal moment over mass, of those right.
    moments: Vec<f64>,
}

/// Arguments: scenes of a row, seed.
pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let scenes: usize = words.next().map_or(Ok(SCENES), |word| word.parse())?;
    let seed: u64 = words.next().map_or(Ok(SEED), |word| word.parse())?;
    println!(
        "# Three palms without force sensors\n\nMade by `cargo xtask study no_force {scenes} {seed}`.\n"
    );
    println!(
        "Ellipsoids of 1.8 m in the mean, axes of 1 : {} to 1 : {}, with their centre up to 0.2 m off the centre of mass, uniform, on palms that swing by",
        FORMS.0, FORMS.1
    );
    println!(
        "0.05 rad or stand still, spin up to 1 rad/s, logs of 2 to 3 s at 500 Hz of contacts and palm poses alone. Right: semi-axes"
    );
    println!(
        "within {RIGHT:e} of the largest without noise, within {DEVIATIONS} deviations with it. Open: refused as not determined;"
    );
    println!("missed: refused because nothing fits, though the scene is of the kind assumed.\n");
    println!(
        "| palms | noise of s | scenes | right | open | missed | wrong in silence | median ms | slowest ms | moments, median error |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (swing, noise) in
        [0.05, 0.0].into_iter().flat_map(|of| [0.0, 2.5e-4, 2.5e-3].map(|noise| (of, noise)))
    {
        let count = run(scenes, seed, noise, swing)?;
        let palms = if swing > 0.0 { "swing" } else { "stand" };
        let Count { tried, right, open, missed, silent, mut milliseconds, mut moments } = count;
        milliseconds.sort_by(f64::total_cmp);
        moments.sort_by(f64::total_cmp);
        let middle = |v: &[f64]| v.get(v.len() / 2).copied().unwrap_or(f64::NAN);
        println!(
            "| {palms} | {noise:e} m | {tried} | {right} | {open} | {missed} | {silent} | {:.0} | {:.0} | {:.1e} |",
            middle(&milliseconds),
            milliseconds.last().copied().unwrap_or(f64::NAN),
            middle(&moments)
        );
    }
    Ok(())
}

fn run(scenes: usize, first: u64, noise: f64, swing: f64) -> Result<Count, Failure> {
    let mut random = Random::new(first);
    let mut count = Count::default();
    while count.tried < scenes {
        let seed = first + count.tried as u64;
        let Some((axes, log)) = scene(&mut random, noise, swing, seed)? else { continue };
        count.tried += 1;
        let Some((milliseconds, found)) = crate::rows::row(|| judged(axes, &log, noise))? else { continue };
        count.milliseconds.push(milliseconds);
        match found {
            Some((Some(right), moment)) => {
                count.right += usize::from(right);
                count.silent += usize::from(!right);
                count.moments.extend(moment);
            }
            Some((None, _)) => count.open += 1,
            None => count.missed += 1,
        }
    }
    Ok(count)
}

fn judged(axes: DVec3, log: &SensorLog, noise: f64) -> Result<Run, Failure> {
    let known =
        KnownTouch { gravity: DVec3::new(0.0, 0.0, -9.81), contact_noise: (noise > 0.0).then_some(noise) };
    let clock = Instant::now();
    let estimate = estimate_without_forces(log, &known);
    let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
    let estimate = match estimate {
        Ok(estimate) => estimate,
        Err(NoForceError::NotDetermined { .. }) => return Ok((milliseconds, Some((None, None)))),
        Err(_) => return Ok((milliseconds, None)),
    };
    let mut sorted = axes.to_array();
    sorted.sort_by(f64::total_cmp);
    let error = (estimate.shape.semi_axes - DVec3::from_array(sorted)).length();
    // The matrix's diagonal is of squared semi-axes: dD = 2 a da.
    let deviation = (3..6).map(|i| estimate.covariance[(i, i)]).sum::<f64>().sqrt() / (2.0 * sorted[0]);
    let right = if noise > 0.0 { error < DEVIATIONS * deviation } else { error < RIGHT * sorted[2] };
    let mut moment = None;
    if right {
        let found = MassProperties::new(1.0, estimate.inertia_per_mass)?.principal().moments;
        let truth = MassProperties::uniform_ellipsoid(1.0, axes)?.principal().moments;
        moment = Some(((found - truth) / truth).abs().z);
    }
    Ok((milliseconds, Some((Some(right), moment))))
}

/// Semi-axes and log of a random scene; none if it loses contact too soon.
fn scene(
    random: &mut Random,
    noise: f64,
    swing: f64,
    seed: u64,
) -> Result<Option<(DVec3, SensorLog)>, Failure> {
    let longest = random.within(FORMS.0.ln(), FORMS.1.ln()).exp();
    let axes = DVec3::new(1.0, random.within(1.0, longest), longest);
    let axes = axes * (3.0 * 1.8 / axes.element_sum());
    let mass = MassProperties::uniform_ellipsoid(random.within(0.5, 2.5), axes)?;
    let mut palms = Vec::with_capacity(3);
    for k in 0..3 {
        let azimuth = f64::from(k) * std::f64::consts::TAU / 3.0 + random.within(-0.3, 0.3);
        let (slope, frequency, phase) =
            (random.within(0.8, 1.1), random.within(1.5, 3.0), random.within(0.0, 6.0));
        palms.push(Palm::new(
            azimuth,
            MotionLaw::Sinusoid { mean: slope, amplitude: swing, frequency, phase },
        )?);
    }
    let body = Translated { body: Ellipsoid::new(axes)?, offset: random.vector(-0.2, 0.2) };
    let scene = ThreePalmScene::new(body, mass, [palms[0], palms[1], palms[2]], 9.81)?;
    let start = InitialMotion {
        R_WO: DQuat::from_scaled_axis(random.vector(-3.0, 3.0)),
        w_WO: random.vector(-0.6, 0.6),
    };
    let times = SampleTimes { duration: DURATION.0, rate: 500.0 };
    let Ok(simulation) = scene.simulate(start, times, Tolerance::uniform(1e-13)) else { return Ok(None) };
    if simulation.instants.last().is_none_or(|last| last.t < DURATION.1) {
        return Ok(None);
    }
    let level = SensorNoise { contact: noise, force: 0.0, torque: 0.0 };
    let log = simulation.sensor_log(&scene)?.split_truth().0.with_noise(&level, seed)?;
    let mut samples = log.samples().to_vec();
    for palm in samples.iter_mut().flat_map(|s| &mut s.palms) {
        (palm.force, palm.torque) = (None, None);
    }
    Ok(Some((axes, SensorLog::new(samples, None)?)))
}

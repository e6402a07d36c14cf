//! The motion sample by sample over a minute at 1 kHz: time per sample, its quantiles and its course, beside the errors.

use glam::{DQuat, DVec3};
use nalgebra::SVector;
use recon::contact_kinematics::{Ellipsoid, Palm, SlopeMotion};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, Instant, MassProperties, SampleTimes, SensorLog, SensorNoise, ThreePalmScene,
};
use recon::observer::{MotionStream, NoiseLevel, StreamEstimate, StreamOptions, StreamStage};
use std::time::Instant as Clock;

/// Samples a second, and length of the log in s.
const RATE: f64 = 1000.0;
const DURATION: f64 = 60.0;
/// Noise: 0.1 % of the size, 1 % of what a palm carries.
const NOISE: NoiseLevel = NoiseLevel { contact: 2.4e-3, force: 0.065 };
/// Parts in which the course of the time is told.
const PARTS: usize = 6;

type Failure = Box<dyn std::error::Error>;
type Scene = ThreePalmScene<Ellipsoid>;

fn main() -> Result<(), Failure> {
    let (scene, truth, log) = log()?;
    println!("# Streaming\n\nMade by `cargo xtask study streaming`.\n");
    println!(
        "An ellipsoid (semi-axes 1.6, 2.0, 2.4 m, 1.3 kg) on three palms that swing by 0.04 rad, {} samples at 1 kHz,",
        log.samples().len()
    );
    println!("with noise of 0.1 % of the size on contacts and 1 % on forces; on one core, from no guess.\n");
    println!("| body | first motion after | median us | 99 % us | largest us | samples over 1 ms |");
    println!("|---|---|---|---|---|---|");
    let runs = [("known", true), ("unknown", false)].map(|(name, known)| (name, run(&scene, &log, known)));
    let mut all = Vec::new();
    for (name, run) in runs {
        let run = run?;
        let first = run.estimates.iter().find(|(_, e)| e.stage == StreamStage::Tracking);
        let first = first.map_or("never".to_owned(), |(_, e)| format!("{:.2} s", e.motion.t));
        let mut sorted = run.microseconds.clone();
        sorted.sort_by(f64::total_cmp);
        let slow = sorted.iter().filter(|&&us| us > 1000.0).count();
        println!(
            "| {name} | {first} | {:.1} | {:.0} | {:.0} | {slow} |",
            share(&sorted, 0.5),
            share(&sorted, 0.99),
            share(&sorted, 1.0)
        );
        all.push((name, run));
    }
    println!("\nThe course of the time: mean and 99 % (us) in each tenth of a minute.\n");
    println!("| body |{}", (0..PARTS).map(|k| format!(" {} s |", 10 * k)).collect::<String>());
    println!("|---|{}", "---|".repeat(PARTS));
    for (name, run) in &all {
        let part = |k: usize| {
            let length = run.microseconds.len() / PARTS;
            let mut part = run.microseconds[k * length..(k + 1) * length].to_vec();
            part.sort_by(f64::total_cmp);
            format!(" {:.1}, {:.0} |", part.iter().sum::<f64>() / length as f64, share(&part, 0.99))
        };
        println!("| {name} |{}", (0..PARTS).map(part).collect::<String>());
    }
    println!(
        "\nErrors (root mean square) and what the covariance says, over all samples that are followed without a"
    );
    println!(
        "contradiction, the first seconds with their wrong starts included; contradicted: share of samples with a motion"
    );
    println!("that the innovations speak against. Mass (with its deviation) and moments at the end.\n");
    println!("| body | position m | said | velocity m/s | said | mass | inertia | NEES / 6 | contradicted |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, run) in &all {
        println!("| {name} |{}", errors(&scene, run, &truth));
    }
    Ok(())
}

struct Run {
    microseconds: Vec<f64>,
    /// With the index of the sample that each belongs to.
    estimates: Vec<(usize, StreamEstimate)>,
}

fn log() -> Result<(Scene, Vec<Instant>, SensorLog), Failure> {
    let axes = DVec3::new(1.6, 2.0, 2.4);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes)?;
    let palm = |azimuth, frequency, phase| {
        Palm::new(azimuth, SlopeMotion::Sinusoid { slope: 0.8, amplitude: 0.04, frequency, phase })
    };
    let palms = [palm(0.1, 1.7, 0.3)?, palm(2.2, 2.1, 1.0)?, palm(4.3, 1.3, 2.0)?];
    let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, palms, 9.81)?;
    let R_WO = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let start = InitialMotion { R_WO, w_WO: DVec3::new(0.07, -0.05, 0.05) };
    let times = SampleTimes { duration: DURATION, rate: RATE };
    let run = scene.simulate(start, times, Tolerance::uniform(1e-12))?;
    let noise = SensorNoise { contact: NOISE.contact, force: NOISE.force, torque: 0.0 };
    let log = run.sensor_log(&scene)?.without_truth().with_noise(&noise, 1)?;
    Ok((scene, run.instants, log))
}

fn run(scene: &Scene, log: &SensorLog, known: bool) -> Result<Run, Failure> {
    let mut stream = MotionStream::new(StreamOptions {
        mass: known.then_some(*scene.mass()),
        gravity: scene.gravity(),
        palm_inertias: None,
        noise: NOISE,
        sample_rate: RATE,
    })?;
    let mut microseconds = Vec::with_capacity(log.samples().len());
    let mut estimates = Vec::with_capacity(log.samples().len());
    for (k, sample) in log.samples().iter().enumerate() {
        let clock = Clock::now();
        let estimate = stream.push(sample)?;
        microseconds.push(1e6 * clock.elapsed().as_secs_f64());
        estimates.extend(estimate.map(|e| (k - 1, e)));
    }
    Ok(Run { microseconds, estimates })
}

fn share(sorted: &[f64], p: f64) -> f64 {
    sorted.get(((sorted.len() as f64 - 1.0) * p) as usize).copied().unwrap_or(f64::NAN)
}

fn errors(scene: &Scene, run: &Run, truth: &[Instant]) -> String {
    let with_motion =
        |e: &&(usize, StreamEstimate)| matches!(e.1.stage, StreamStage::Tracking | StreamStage::Contradicted);
    let (mut sums, mut nees, mut count, mut contradicted, mut followed) =
        ([0.0; 4], 0.0, 0usize, 0usize, 0usize);
    for (k, estimate) in run.estimates.iter().filter(with_motion) {
        let now = &truth[*k];
        let p = estimate.motion.p_WCm - now.touch.p_WCm;
        let v = estimate.motion.v_WCm - now.rates.v_WCm;
        let variance =
            |block: usize| (3 * block..3 * block + 3).map(|i| estimate.covariance[(i, i)]).sum::<f64>();
        contradicted += usize::from(estimate.stage == StreamStage::Contradicted);
        followed += 1;
        if estimate.stage == StreamStage::Contradicted {
            continue;
        }
        let six = estimate.covariance.fixed_view::<6, 6>(0, 0).into_owned();
        let error = SVector::<f64, 6>::from_fn(|i, _| [p, v][i / 3][i % 3]);
        nees += six.cholesky().map_or(f64::INFINITY, |c| error.dot(&c.solve(&error)));
        for (sum, term) in
            sums.iter_mut().zip([p.length_squared(), variance(0), v.length_squared(), variance(1)])
        {
            *sum += term;
        }
        count += 1;
    }
    let n = count.max(1) as f64;
    let [p, ps, v, vs] = sums.map(|s| (s / n).sqrt());
    let body = run.estimates.last().and_then(|(_, e)| e.body);
    let (mass, inertia) = body.map_or(("known".to_owned(), "known".to_owned()), |b| {
        let true_moments = scene.mass().principal().moments;
        let moments = MassProperties::new(b.mass, b.inertia).map_or(DVec3::NAN, |m| m.principal().moments);
        (
            format!("{:.1e} ({:.1e}) kg", (b.mass - scene.mass().mass()).abs(), b.mass_deviation),
            format!("{:.1e} of the moments", ((moments - true_moments) / true_moments).abs().max_element()),
        )
    });
    let share = contradicted as f64 / followed.max(1) as f64;
    format!(
        " {p:.1e} | {ps:.1e} | {v:.1e} | {vs:.1e} | {mass} | {inertia} | {:.2} | {share:.3} |",
        nees / n / 6.0
    )
}

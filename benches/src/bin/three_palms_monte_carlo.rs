//! Monte Carlo study of the three-palm estimators against the Cramer-Rao bound: prints a table in Markdown.
//!
//! `cargo xtask study three_palms_monte_carlo [RUNS]` writes docs/three-palms-monte-carlo.md.

use glam::DVec3;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{
    InitialMotion, Instant as Now, SampleTimes, SensorLog, SensorNoise, ThreePalmScene, integrate::Tolerance,
};
use recon::observer::{
    KnownBody, MotionEstimate, NoiseLevel, UnknownBody, equivalent_orientations, estimate_body,
    estimate_motion,
};
use recon_tests::{f5, g2};
use std::ops::Range;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

/// Size of the objects, m, that contact noise is relative to, and mean force, N, that force noise is relative to.
const SIZE: f64 = 2.5;
const FORCE: f64 = 6.5;
/// Natural sizes of the numbers compared; a bound above this share of them says nothing, and the prior would decide.
const BELOW_PRIOR: f64 = 0.1;
/// A failure is an error beyond this many of its deviations without a warning.
const SILENT: f64 = 5.0;

/// Errors and deviations of one estimate, and whether it is relied on.
struct Outcome {
    errors: Vec<f64>,
    deviations: Vec<f64>,
    reliable: bool,
    milliseconds: f64,
}

/// One row of the table.
#[derive(Clone, Copy)]
struct Setting {
    noise: f64,
    rate: f64,
    window: f64,
    unknown: bool,
}

fn main() -> Result<(), Failure> {
    let mut words = std::env::args().skip(1);
    let runs: u64 = words.next().map_or(Ok(5), |word| word.parse())?;
    let first: u64 = words.next().map_or(Ok(1000), |word| word.parse())?;
    println!("# Three-palm estimators against the Cramer-Rao bound\n");
    println!(
        "Made by `cargo xtask study three_palms_monte_carlo {runs} {first}`; {runs} runs a row, seeds {first} to {}.\n",
        first + runs - 1
    );
    println!(
        "Scenes `F5` (immobile palms) and `G2` (palms that swing, full inertia tensor); contact noise relative to a size of \
         {SIZE} m, force noise 1 % of {FORCE} N; cold start, no guess.\n"
    );
    println!(
        "Compared are, of a known body, the 12 numbers of the state at the start; of an unknown one centre of mass, \
         velocity, angular momentum, mass and principal moments. RMSE / bound: geometric mean over the numbers whose \
         bound is below {BELOW_PRIOR} of their natural size, over runs that are relied on. Error^2 / variance: mean over \
         the same, with its 95 % band (numbers of one run hang together: the band allows for it). Reported: runs that come \
         with a warning. Silent: runs with an error beyond {SILENT} deviations and no warning.\n"
    );
    println!(
        "| scene | body | contact noise | rate Hz | window s | RMSE / bound | error^2 / variance | 95 % band | reported | silent | median ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let (scene, start) = f5();
    rows("F5", &scene, start, first..first + runs)?;
    let (scene, start) = g2();
    rows("G2", &scene, start, first..first + runs)
}

fn rows<S: SupportFunction>(
    name: &str,
    scene: &ThreePalmScene<S>,
    start: InitialMotion,
    seeds: Range<u64>,
) -> Result<(), Failure> {
    for unknown in [false, true] {
        for noise in [1e-3, 1e-2] {
            for rate in [1000.0, 100.0] {
                for window in [0.5, 1.0, 2.0, 4.0] {
                    row(name, scene, start, Setting { noise, rate, window, unknown }, &seeds)?;
                }
            }
        }
    }
    Ok(())
}

fn row<S: SupportFunction>(
    name: &str,
    scene: &ThreePalmScene<S>,
    start: InitialMotion,
    setting: Setting,
    seeds: &Range<u64>,
) -> Result<(), Failure> {
    let Setting { noise, rate, window, unknown } = setting;
    let times = SampleTimes { duration: window, rate };
    let simulation = scene.simulate(start, times, Tolerance::uniform(1e-13))?;
    let clean = simulation.sensor_log(scene)?.without_truth();
    let level = SensorNoise { contact: noise * SIZE, force: 0.01 * FORCE, torque: 0.0 };
    let now = &simulation.instants[0];
    let bound = estimate(scene, &clean, level, unknown, now)?;
    let mut outcomes = Vec::new();
    for seed in seeds.clone() {
        outcomes.push(estimate(scene, &clean.with_noise(&level, seed)?, level, unknown, now)?);
    }
    let sizes = sizes(scene, unknown);
    let counted: Vec<usize> =
        (0..sizes.len()).filter(|&i| bound.0.deviations[i] < BELOW_PRIOR * sizes[i]).collect();
    let relied: Vec<&Outcome> = outcomes.iter().map(|o| &o.0).filter(|o| o.reliable).collect();
    let silent = relied.iter().filter(|o| counted_worst(o) > SILENT).count();
    let (ratio, square, band) = statistics(&relied, &bound, &counted);
    let mut times: Vec<f64> = outcomes.iter().map(|o| o.0.milliseconds).collect();
    times.sort_by(f64::total_cmp);
    let body = if unknown { "unknown" } else { "known" };
    let reported = outcomes.len() - relied.len();
    println!(
        "| {name} | {body} | {:.1} % | {rate} | {window} | {ratio} | {square} | {band} | {reported} of {} | {silent} | {:.0} |",
        100.0 * noise,
        outcomes.len(),
        times[times.len() / 2],
    );
    Ok(())
}

fn counted_worst(outcome: &Outcome) -> f64 {
    outcome.errors.iter().zip(&outcome.deviations).fold(0.0, |m, (e, d)| m.max(e.abs() / d))
}

type Estimated = (Outcome, Vec<Vec<f64>>);

/// Texts of the ratio to the bound, of the normalised squares, and of their band.
fn statistics(relied: &[&Outcome], bound: &Estimated, counted: &[usize]) -> (String, String, String) {
    if relied.is_empty() || counted.is_empty() {
        return ("-".into(), "-".into(), "-".into());
    }
    let count = relied.len() as f64;
    let mean = |i: usize| relied.iter().map(|o| o.errors[i].powi(2)).sum::<f64>() / count;
    let logs: f64 = counted.iter().map(|&i| 0.5 * (mean(i) / bound.0.deviations[i].powi(2)).ln()).sum();
    let squares: f64 = counted
        .iter()
        .map(|&i| relied.iter().map(|o| (o.errors[i] / o.deviations[i]).powi(2)).sum::<f64>() / count)
        .sum();
    // The sum of squares of numbers with correlations C has the variance 2 |C|^2.
    let d = counted.len() as f64;
    let correlation: f64 = counted
        .iter()
        .flat_map(|&i| counted.iter().map(move |&j| (i, j)))
        .map(|(i, j)| (bound.1[i][j] / (bound.0.deviations[i] * bound.0.deviations[j])).powi(2))
        .sum();
    let half = 1.96 * (2.0 * correlation / count).sqrt() / d;
    (
        format!("{:.2} ({} numbers)", (logs / d).exp(), counted.len()),
        format!("{:.2}", squares / d),
        format!("{:.2} to {:.2}", (1.0 - half).max(0.0), 1.0 + half),
    )
}

/// Natural sizes of the numbers compared.
fn sizes<S: SupportFunction>(scene: &ThreePalmScene<S>, unknown: bool) -> Vec<f64> {
    let length = 0.8 * SIZE;
    let rate = (9.81 / length).sqrt();
    let moment = scene.mass().principal().moments.element_sum() / 3.0;
    let mut all: Vec<f64> = [length, length * rate, moment * rate].into_iter().flat_map(|s| [s; 3]).collect();
    if unknown {
        all.push(scene.mass().mass());
        all.extend([moment; 3]);
    } else {
        all.extend([1.0; 3]);
    }
    all
}

fn estimate<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
    noise: SensorNoise,
    unknown: bool,
    now: &Now,
) -> Result<Estimated, Failure> {
    let noise = Some(NoiseLevel { contact: noise.contact, force: noise.force });
    let clock = Instant::now();
    if unknown {
        let known = UnknownBody { gravity: scene.gravity(), palm_inertias: None, noise };
        let Ok(found) = estimate_body(log, &known) else { return Ok(refused(13, clock)) };
        let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
        let (mut errors, mut covariance) = motion_errors(scene, &found.motion, now, 9);
        let body = &found.body;
        let moments = body.mass.principal().moments - scene.mass().principal().moments;
        errors.push(body.mass.mass() - scene.mass().mass());
        errors.extend(moments.to_array());
        let deviations: Vec<f64> =
            std::iter::once(body.mass_deviation).chain(body.moment_deviations.to_array()).collect();
        for (k, d) in deviations.iter().enumerate() {
            covariance.iter_mut().for_each(|row| row.push(0.0));
            covariance.push((0..10 + k).map(|j| if j == 9 + k { d * d } else { 0.0 }).collect());
        }
        Ok(outcome(errors, covariance, found.motion.reliability.is_reliable(), milliseconds))
    } else {
        let known = KnownBody { mass: *scene.mass(), gravity: scene.gravity(), palm_inertias: None, noise };
        let Ok(found) = estimate_motion(log, &known) else { return Ok(refused(12, clock)) };
        let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
        let (errors, covariance) = motion_errors(scene, &found, now, 12);
        Ok(outcome(errors, covariance, found.reliability.is_reliable(), milliseconds))
    }
}

/// No estimate is a warning too.
fn refused(count: usize, clock: Instant) -> Estimated {
    let infinite = vec![f64::INFINITY; count];
    let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
    let outcome = Outcome { errors: infinite.clone(), deviations: infinite, reliable: false, milliseconds };
    (outcome, vec![vec![0.0; count]; count])
}

fn outcome(errors: Vec<f64>, covariance: Vec<Vec<f64>>, reliable: bool, milliseconds: f64) -> Estimated {
    let deviations = (0..errors.len()).map(|i| covariance[i][i].max(0.0).sqrt()).collect();
    (Outcome { errors, deviations, reliable, milliseconds }, covariance)
}

/// Errors of the first `count` numbers of the state at the start, with their covariance.
fn motion_errors<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    found: &MotionEstimate,
    now: &Now,
    count: usize,
) -> (Vec<f64>, Vec<Vec<f64>>) {
    let L = now.R_WO * (scene.mass().inertia() * (now.R_WO.inverse() * now.w_WO));
    let turns =
        equivalent_orientations(scene.mass()).map(|turn| (found.start.R_WO * turn) * now.R_WO.inverse());
    let turn = turns.into_iter().fold(turns[0], |best, t| if t.w.abs() > best.w.abs() { t } else { best });
    let parts = [
        found.start.p_WCm - now.touch.p_WCm,
        found.start.v_WCm - now.rates.v_WCm,
        found.start.L_WO - L,
        DVec3::new(turn.x, turn.y, turn.z) * 2.0 * turn.w.signum(),
    ];
    let errors = (0..count).map(|i| parts[i / 3][i % 3]).collect();
    let row = |i: usize| (0..count).map(|j| found.covariance[(i, j)]).collect();
    (errors, (0..count).map(row).collect())
}

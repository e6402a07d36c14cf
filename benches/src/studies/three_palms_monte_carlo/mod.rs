//! Monte Carlo study of the three-palm estimators against the Cramer-Rao bound: prints a table in Markdown.
//!
//! `cargo xtask study three_palms_monte_carlo [RUNS [FIRST_SEED [WORD...]]]` writes docs/three-palms-monte-carlo.md. Words
//! choose rows, also such as are not in the table: `F5` or `G2`, `known` or `unknown`, and `noise=0.01`, `rate=1000`,
//! `window=2`, each as often as one likes.

mod estimates;
mod statistics;

use estimates::{Estimated, Experiment};
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{InitialMotion, SampleTimes, SensorNoise, ThreePalmScene, integrate::Tolerance};
use recon_benches::bound::Scales;
use recon_benches::bound::space::least_at_start;
use recon_tests::{f5, g2};
use statistics::Statistics;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Size of the objects, m, that contact noise is relative to, and mean force, N, that force noise is relative to.
const SIZE: f64 = 2.5;
const FORCE: f64 = 6.5;
/// Mean distance of the contacts from their mean, m, as the estimators measure it.
const LENGTH: f64 = 1.3;
/// Deviation of the estimators' prior in natural sizes: numbers whose bound is below it are counted.
const PRIOR: f64 = 1.0;
/// Ratio to the bound beyond which there is no number in the table: some run led nowhere.
const FAR: f64 = 10.0;
/// A failure is an error beyond this many of its deviations without a warning.
const SILENT: f64 = 5.0;

/// One row of the table.
#[derive(Clone, Copy)]
struct Row {
    scene: &'static str,
    unknown: bool,
    noise: f64,
    rate: f64,
    window: f64,
}

impl Row {
    fn body(&self) -> &'static str {
        if self.unknown { "unknown" } else { "known" }
    }
}

/// What the words of the command line choose.
#[derive(Default)]
struct Choice {
    scenes: Vec<&'static str>,
    unknown: Vec<bool>,
    noise: Vec<f64>,
    rate: Vec<f64>,
    window: Vec<f64>,
}

impl Choice {
    fn new(words: &[String]) -> Result<Self, Failure> {
        let mut choice = Self::default();
        for word in words {
            let number = |value: &str| -> Result<f64, Failure> {
                let number: f64 = value.parse().map_err(|_| format!("{word}: not a number"))?;
                if number > 0.0 && number.is_finite() {
                    Ok(number)
                } else {
                    Err(format!("{word}: not positive").into())
                }
            };
            match word.split_once('=') {
                None if word == "F5" => choice.scenes.push("F5"),
                None if word == "G2" => choice.scenes.push("G2"),
                None if word == "known" => choice.unknown.push(false),
                None if word == "unknown" => choice.unknown.push(true),
                Some(("noise", value)) => choice.noise.push(number(value)?),
                Some(("rate", value)) => choice.rate.push(number(value)?),
                Some(("window", value)) => choice.window.push(number(value)?),
                _ => {
                    let needed = "F5, G2, known, unknown, or a number for noise=, rate=, window=";
                    return Err(format!("{word}: a word that chooses rows must be {needed}").into());
                }
            }
        }
        Ok(choice)
    }

    /// All rows of what is chosen, and of the table where nothing is.
    fn rows(&self) -> Vec<Row> {
        fn or<'a, T>(chosen: &'a [T], table: &'a [T]) -> &'a [T] {
            if chosen.is_empty() { table } else { chosen }
        }
        let mut rows = Vec::new();
        for &scene in or(&self.scenes, &["F5", "G2"]) {
            for &unknown in or(&self.unknown, &[false, true]) {
                for &noise in or(&self.noise, &[1e-3, 1e-2]) {
                    for &rate in or(&self.rate, &[1000.0, 100.0]) {
                        let windows = or(&self.window, &[0.5, 1.0, 2.0, 4.0]);
                        rows.extend(windows.iter().map(|&window| Row {
                            scene,
                            unknown,
                            noise,
                            rate,
                            window,
                        }));
                    }
                }
            }
        }
        rows
    }
}

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let runs: u64 = words.next().map_or(Ok(5), |word| word.parse())?;
    let first: u64 = words.next().map_or(Ok(1000), |word| word.parse())?;
    let words: Vec<String> = words.collect();
    let rows = Choice::new(&words)?.rows();
    introduce(runs, first, &words);
    let lines = in_parallel(&rows, |k, row| crate::rows::row_of(k, || line(row, first..first + runs)))?;
    lines.iter().flatten().for_each(|line| println!("{line}"));
    Ok(())
}

fn introduce(runs: u64, first: u64, words: &[String]) {
    let command = [&[runs.to_string(), first.to_string()], words].concat().join(" ");
    println!("# Three-palm estimators against the Cramer-Rao bound\n");
    println!(
        "Made by `cargo xtask study three_palms_monte_carlo {command}`; {runs} runs a row, seeds {first} to {}.\n",
        first + runs - 1
    );
    println!(
        "Scenes `F5` (immobile palms) and `G2` (palms that swing, full inertia tensor); contact noise relative to a size of \
         {SIZE} m, force noise 1 % of {FORCE} N; cold start, no guess.\n"
    );
    println!(
        "Compared are centre of mass, velocity and angular velocity at the start; of a known body the three numbers of how its \
         axes lie as well, of an unknown one mass and moments of inertia about its true axes. Counted are the numbers whose bound is below the \
         prior of the estimator: one natural size (axes: a radian). The bound (Cramér-Rao) is that of the data alone, by a filter that knows nothing of the \
         estimators: where their prior says something too, the error can be below it. RMSE / bound: geometric mean over these numbers, \
         over runs that are relied on, and over all runs with an estimate. Error^2 / variance: mean over the same, relied on, with its \
         95 % band (numbers of one run hang together, and are taken to be worth three); below 1 the deviations are on the safe side. Reported: \
         runs that come with a warning. Silent: runs with an error beyond {SILENT} deviations and no warning. Time: median of processor \
         time.\n"
    );
    println!(
        "| scene | body | contact noise | rate Hz | window s | numbers | RMSE / bound | of all runs | error^2 / variance | 95 % band | reported | silent | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
}

/// The lines of the rows in their order, made by as many threads as there are processors.
fn in_parallel<T: Send>(
    rows: &[Row],
    line: impl Fn(usize, &Row) -> Result<T, Failure> + Sync,
) -> Result<Vec<T>, Failure> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some((k, row)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|k| Some((k, rows.get(k)?)))
        {
            done.push((k, line(k, row)));
        }
        done
    };
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    let done = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().map(|worker| worker.join()).collect::<Result<Vec<_>, _>>()
    })
    .map_err(|_| "a worker ended early")?;
    let mut lines: Vec<(usize, Result<T, Failure>)> = done.into_iter().flatten().collect();
    lines.sort_by_key(|(k, _)| *k);
    lines.into_iter().map(|(_, line)| line).collect()
}

fn line(row: &Row, seeds: Range<u64>) -> Result<String, Failure> {
    if row.scene == "F5" {
        let (scene, start) = f5();
        line_of(&scene, start, row, seeds)
    } else {
        let (scene, start) = g2();
        line_of(&scene, start, row, seeds)
    }
}

fn line_of<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    start: InitialMotion,
    row: &Row,
    seeds: Range<u64>,
) -> Result<String, Failure> {
    let Row { noise, rate, window, unknown, .. } = *row;
    let times = SampleTimes { duration: window, rate };
    let simulation = scene.simulate(start, times, Tolerance::uniform(1e-13))?;
    let clean = simulation.sensor_log(scene)?.split_truth().0;
    let level = SensorNoise { contact: noise * SIZE, force: 0.01 * FORCE, torque: 0.0 };
    let speed = (9.81 * LENGTH).sqrt();
    let experiment = Experiment { scene, now: &simulation.instants[0], unknown, speed };
    let scales = Scales { length: LENGTH, time: LENGTH / speed };
    let bound = least_at_start(&simulation.instants, *scene.mass(), !unknown, level, scales);
    let bound = bound.ok_or("the equations of the bound are singular")?;
    let mut runs = Vec::new();
    for seed in seeds {
        runs.push(experiment.estimate(&clean.with_noise(&level, seed)?, level));
    }
    let sizes = sizes(scene, unknown);
    let counted: Vec<usize> = (0..sizes.len()).filter(|&i| bound[i] < PRIOR * sizes[i]).collect();
    Ok(format(row, &Outcome { runs, bound, counted }))
}

/// What came of a row.
struct Outcome {
    runs: Vec<Estimated>,
    /// Least deviations.
    bound: Vec<f64>,
    /// Numbers that are counted.
    counted: Vec<usize>,
}

fn format(row: &Row, outcome: &Outcome) -> String {
    let Outcome { runs, bound, counted } = outcome;
    let dash = || "-".to_owned();
    let relied: Vec<&Estimated> = runs.iter().filter(|run| run.reliable).collect();
    let there: Vec<&Estimated> = runs.iter().filter(|run| run.exists()).collect();
    let silent = relied.iter().filter(|run| run.worst() > SILENT).count();
    let statistics = |runs: &[&Estimated]| Statistics::new(runs, bound, counted);
    let (of_relied, of_all) = (statistics(&relied), statistics(&there));
    let ratio = |s: &Option<Statistics>| match s {
        None => dash(),
        Some(s) if s.ratio < FAR => format!("{:.2}", s.ratio),
        Some(_) => format!("> {FAR}"),
    };
    let (square, band) = of_relied.as_ref().map_or_else(
        || (dash(), dash()),
        |s| {
            let band = format!("{:.2} to {:.2}", (1.0 - s.half_band).max(0.0), 1.0 + s.half_band);
            (format!("{:.2}", s.square), band)
        },
    );
    let mut times: Vec<f64> = runs.iter().map(|run| run.milliseconds).collect();
    times.sort_by(f64::total_cmp);
    let Row { scene, noise, rate, window, .. } = row;
    format!(
        "| {scene} | {} | {} % | {rate} | {window} | {} | {} | {} | {square} | {band} | {} of {} | {silent} | {:.0} |",
        row.body(),
        // As it was given, without the last bits of the product.
        (1e8 * noise).round() / 1e6,
        counted.len(),
        ratio(&of_relied),
        ratio(&of_all),
        runs.len() - relied.len(),
        runs.len(),
        times.get(times.len() / 2).copied().unwrap_or_default(),
    )
}

/// Natural sizes of the numbers compared.
fn sizes<S: SupportFunction>(scene: &ThreePalmScene<S>, unknown: bool) -> Vec<f64> {
    let rate = (9.81 / LENGTH).sqrt();
    let moment = scene.mass().principal().moments.element_sum() / 3.0;
    let mut all: Vec<f64> = [LENGTH, LENGTH * rate, rate].into_iter().flat_map(|s| [s; 3]).collect();
    if unknown {
        all.push(scene.mass().mass());
        all.extend([moment; 3]);
    } else {
        all.extend([1.0; 3]);
    }
    all
}

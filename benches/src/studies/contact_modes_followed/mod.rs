//! Probabilities of contact modes of a stream that follows the reference logs from no guess: body and friction unknown, slips the stream's own.
//!
//! Arguments: the folder of the logs, the first seed, seeds, scenes. Writes Markdown tables.

mod cost;

use super::contact_estimates::{Case, case};
use super::contact_logs::log::{Anything, Log};
use super::contact_modes_estimated::tally::{Run, reliability};
use super::contact_modes_estimated::{NOISE, SCENES, Truth, on_two_cores};
use recon::object_dynamics::{
    ContactLog, ContactMode, ContactPoints, ForceChannel, MOST_PALMS, MeasuredMotion, RecordedMotion,
};
use recon::observer::contact_modes::LearnedFriction;
use recon::observer::contacts::ContactOptions;
use recon::observer::contacts::stream::{
    ForceReading, MotionStream, PalmSensed, StreamEstimate, StreamOptions, StreamPalm, StreamStage,
};
use std::path::PathBuf;

/// Seeds from here on; the stream was looked at with those below 20.
const FIRST_SEED: u64 = 401;
/// Samples a second of the logs.
const RATE: f64 = 1000.0;

/// One log with one noise, followed.
struct Followed {
    run: Run,
    /// Samples of the log, those from the first motion on, and those at which one was relied on.
    samples: [usize; 3],
    /// Samples of contacts whose decided mode is right.
    decided: f64,
    /// Whether something was doubted.
    doubted: bool,
}

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let first: u64 = words.next().map_or(Ok(FIRST_SEED), |s| s.parse())?;
    let seeds: u64 = words.next().map_or(Ok(3), |s| s.parse())?;
    let names: Vec<String> = words.collect();
    let asked: Vec<&str> =
        SCENES.into_iter().filter(|name| names.is_empty() || names.iter().any(|n| n == name)).collect();
    let jobs: Vec<(&str, u64)> =
        asked.iter().flat_map(|name| (first..first + seeds).map(move |seed| (*name, seed))).collect();
    print!("{}", include_str!("about.md"));
    println!("Seeds {first} to {}.\n", first + seeds - 1);
    println!("{HEAD}");
    let mut all = Vec::new();
    for (known, words) in [(true, "friction known"), (false, "friction unknown")] {
        let made = on_two_cores(&jobs, |name, seed| run(&Log::read(&folder, name)?, name, known, seed))?;
        for name in &asked {
            let own: Vec<&Followed> = made.iter().filter(|followed| followed.run.name == *name).collect();
            println!("{}", row(&format!("{name}, {words}"), &own));
        }
        all = made;
    }
    println!("\n{}", include_str!("reliability.md").trim_end());
    println!();
    print!("{}", reliability(&all.iter().map(|followed| &followed.run).collect::<Vec<_>>()));
    cost::main(&folder, first, &asked)?;
    print!("\n{}", include_str!("holds.md"));
    Ok(())
}

/// What the palms of a log sense at each sample.
fn sensed(log: &ContactLog) -> Anything<(Vec<StreamPalm>, Vec<Vec<PalmSensed>>)> {
    let records = log.records();
    let palms =
        records.iter().map(|record| StreamPalm { surface: record.surface, friction: record.friction });
    let palms = palms.collect();
    let one = |k: usize| -> Anything<Vec<PalmSensed>> {
        let palm = |record: &recon::object_dynamics::PalmRecord| -> Anything<PalmSensed> {
            let RecordedMotion::Measured(states) = &record.motion else { return Err("poses alone".into()) };
            let ContactPoints::World(points) = &record.contacts else { return Err("no points".into()) };
            let ForceChannel::Three(forces) = &record.force else { return Err("no forces".into()) };
            let MeasuredMotion { pose, v_WP, w_WP } = states[k];
            let (twist, force) = (Some([v_WP, w_WP]), ForceReading::Three(forces[k]));
            Ok(PalmSensed { pose, twist, contact: points[k], force })
        };
        records.iter().map(palm).collect()
    };
    let samples: Anything<Vec<_>> = (0..log.times().len()).map(one).collect();
    Ok((palms, samples?))
}

fn stream(palms: Vec<StreamPalm>, options: ContactOptions) -> Anything<MotionStream> {
    let contacts = ContactOptions { mode_odds: true, suspects: true, ..options };
    Ok(MotionStream::new(palms, StreamOptions { contacts, sample_rate: RATE })?)
}

fn run(file: &Log, name: &str, known: bool, seed: u64) -> Anything<Followed> {
    let Case { log, options, .. } = case(file, NOISE, f64::INFINITY, seed)?;
    let truth = Truth::new(file, log.times())?;
    let (mut palms, samples) = sensed(&log)?;
    for (i, palm) in palms.iter_mut().enumerate().filter(|_| known) {
        palm.friction = Some(file.friction(i + 1));
    }
    let mut stream = stream(palms, options)?;
    let mut followed = Followed { run: Run::new(name, false), samples: [0; 3], decided: 0.0, doubted: false };
    let mut last = None;
    for (k, sensed) in samples.iter().enumerate() {
        let estimate = stream.push(log.times()[k], sensed)?;
        followed.take(&truth, k, &estimate);
        last = Some(estimate);
    }
    let last = last.ok_or("no sample")?;
    if let Some(modes) = &last.modes {
        let learned = modes.frictions.iter().enumerate().filter_map(|(i, of)| Some((i, (*of)?)));
        learned.for_each(|(i, LearnedFriction { coefficient, deviation })| {
            followed.run.friction(coefficient, deviation, file.friction(i + 1));
        });
        followed.doubted = modes.doubts.iter().any(Option::is_some);
    }
    followed.run.relied_on = last.stage == StreamStage::Tracking;
    Ok(followed)
}

impl Followed {
    fn take(&mut self, truth: &Truth, k: usize, estimate: &StreamEstimate) {
        self.samples[0] += 1;
        self.samples[2] += usize::from(estimate.stage == StreamStage::Tracking);
        let Some(modes) = &estimate.modes else { return };
        self.samples[1] += 1;
        for i in 0..truth.modes.len().min(MOST_PALMS) {
            let mode = truth.modes[i][k];
            if mode == ContactMode::Off {
                continue;
            }
            let of = &modes.odds[i];
            self.run.add(mode, modes.decided[i], [of.off, of.slide, of.stick], truth.near[i][k]);
            self.decided += f64::from(!truth.near[i][k] && modes.decided[i] == mode);
        }
    }
}

const HEAD: &str = "| log | runs, relied on at the end | modes told from (s), motion relied on | samples | right | decided right | above 0.99 | of all: above 0.99 and wrong (worst run) | Brier | friction: largest error, in its deviations | runs doubted |\n|---|---|---|---|---|---|---|---|---|---|---|";

fn row(name: &str, all: &[&Followed]) -> String {
    let sum = |of: &dyn Fn(&Followed) -> f64| all.iter().map(|followed| of(followed)).sum::<f64>();
    let samples = sum(&|of| of.run.samples).max(1.0);
    let worst = all.iter().map(|of| of.run.wrong / of.run.samples.max(1.0)).fold(0.0, f64::max);
    let learned = all.iter().filter_map(|of| of.run.friction);
    let largest = learned.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
    let friction = largest.map_or(String::new(), |[error, of]| format!("{error:.4}, {of:.1}"));
    let [every, told, tracked] = [0, 1, 2].map(|i| sum(&|of| of.samples[i] as f64));
    format!(
        "| {name} | {}, {} | {:.2}, {:.3} | {samples} | {:.4} | {:.4} | {:.3} | {:.5} ({worst:.5}) | {:.4} | {friction} | {} |",
        all.len(),
        all.iter().filter(|of| of.run.relied_on).count(),
        (every - told) / RATE / all.len().max(1) as f64,
        tracked / every.max(1.0),
        sum(&|of| of.run.right) / samples,
        sum(&|of| of.decided) / samples,
        sum(&|of| of.run.confident) / samples,
        sum(&|of| of.run.wrong) / samples,
        sum(&|of| of.run.brier) / samples,
        all.iter().filter(|of| of.doubted).count(),
    )
}

//! The atlas of failures: `atlas [SEEDS [FIRST]]` makes all runs and writes docs/atlas.md, docs/atlas.csv and the pictures under docs/atlas;
//! `atlas boundaries` writes docs/boundaries.md anew from docs/atlas.csv;
//! `atlas smoke` makes a run of every way at its middle strength; `atlas one NAME WAY STRENGTH SEED` tells of one run.

use crate::rows;
use recon::contact_kinematics::unless_stopped;
use recon_benches::atlas::{
    Counts, MAPS, METHODS, Outcome, Run, Spot, boundaries, counts_csv, map_picture, page, picture, spots,
    stem,
};
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Counts of the atlas, and what follows from them.
const COUNTS: &str = "docs/atlas.csv";
const BOUNDARIES: &str = "docs/boundaries.md";
const SEEDS: u64 = 1;
const FIRST: u64 = 20_000;
/// Longest time of a run, s: beyond it, it is counted as a crash.
const LONGEST: f64 = 600.0;
/// Runs between two lines of progress.
const TOLD: usize = 500;

pub(crate) fn main() -> Result<(), Failure> {
    let words: Vec<String> = crate::words().collect();
    match words.first().map(String::as_str) {
        Some("one") => return one(&words[1..]),
        Some("smoke") => return smoke(),
        Some("boundaries") => return write_boundaries(&fs::read_to_string(COUNTS)?),
        _ => {}
    }
    let number = |k: usize, usual: u64| words.get(k).map_or(Ok(usual), |word| word.parse());
    let (each, first) = (number(0, SEEDS)?, number(1, FIRST)?);
    let spots = spots();
    let jobs: Vec<(usize, u64)> = (0..spots.len())
        .flat_map(|k| (first..first + spots[k].seeds(each)).map(move |seed| (k, seed)))
        .collect();
    let runs = all(&jobs, &spots)?;
    let made = runs.iter().flatten().count();
    if made < runs.len() && !merging() {
        return Ok(());
    }
    let mut counts = vec![Counts::default(); spots.len()];
    for ((k, seed), run) in jobs.iter().zip(&runs) {
        run.iter().for_each(|run| counts[*k].take(*seed, run));
    }
    pictures(&spots, &counts)?;
    let csv = counts_csv(&spots, &counts);
    fs::write(COUNTS, &csv)?;
    write_boundaries(&csv)?;
    let seconds = runs.iter().flatten().map(|run| run.milliseconds).sum::<f64>() / 1e3;
    let part = if made < runs.len() { format!("{made} of its {}", runs.len()) } else { made.to_string() };
    println!("# Atlas of failures\n");
    println!(
        "Made by `cargo xtask atlas {each} {first}`: {part} runs, {:.0} minutes of wall time in all, from seed {first} on. Each method along each way of failing that concerns it, from where it",
        seconds / 60.0
    );
    println!(
        "is harmless to where nothing can be known. Bodies of 5 cm between palms, logs of 0.7 s at 200 Hz with noise of 0.1 % of the size and 0.3 % of the weight, but for what the way"
    );
    println!(
        "changes; judged by the simulator's truth. Reported: not relied on, in words. Natural times are `sqrt(size / g)`. Counts are in [atlas.csv](atlas.csv), boundaries in [boundaries.md](boundaries.md). Thresholds were set"
    );
    println!(
        "on seeds from {FIRST} on as well: what was proven on seeds used once stands beside each of them in [limits.md](limits.md).\n"
    );
    print!("{}", page(&spots, &counts));
    Ok(())
}

fn write_boundaries(csv: &str) -> Result<(), Failure> {
    Ok(fs::write(BOUNDARIES, boundaries(csv).ok_or_else(|| format!("{COUNTS} is no such table"))?)?)
}

/// Whether this process makes the page from the rows of others.
fn merging() -> bool {
    std::env::args().any(|word| word == "--merge")
}

/// All runs of this part, on all cores, in their order; none where one is of another part.
fn all(jobs: &[(usize, u64)], spots: &[Spot]) -> Result<Vec<Option<Run>>, Failure> {
    let (next, begun) = (AtomicUsize::new(0), Instant::now());
    let made: Mutex<Vec<(usize, Option<Run>)>> = Mutex::new(Vec::with_capacity(jobs.len()));
    let work = || -> Result<(), Failure> {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some((k, seed)) = jobs.get(number) else { return Ok(()) };
            let run = match rows::row_of(number, || Ok::<_, Failure>(limited(&spots[*k], *seed))) {
                // What is not made yet is left out, and the page says how much.
                Err(_) if merging() => None,
                run => run?,
            };
            made.lock().unwrap_or_else(PoisonError::into_inner).push((number, run));
            if number % TOLD == 0 {
                eprintln!("{number} of {} runs, {:.0} s", jobs.len(), begun.elapsed().as_secs_f64());
            }
        }
    };
    thread::scope(|scope| {
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let workers: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| worker.join().map_err(|_| "a thread was lost")?)
    })?;
    let mut made = made.into_inner().unwrap_or_else(PoisonError::into_inner);
    made.sort_by_key(|(number, _)| *number);
    Ok(made.into_iter().map(|(_, run)| run).collect())
}

/// A run that is ended where it takes too long.
fn limited(spot: &Spot, seed: u64) -> Run {
    let (stop, done) = (Arc::new(AtomicBool::new(false)), AtomicBool::new(false));
    thread::scope(|scope| {
        let watch = scope.spawn(|| {
            let begun = Instant::now();
            while !done.load(Ordering::Relaxed) {
                thread::park_timeout(Duration::from_millis(500));
                if begun.elapsed().as_secs_f64() > LONGEST {
                    stop.store(true, Ordering::Relaxed);
                }
            }
        });
        let run = unless_stopped(&stop, || spot.run(seed));
        done.store(true, Ordering::Relaxed);
        watch.thread().unpark();
        run.unwrap_or_else(|_| Run {
            outcome: Outcome::Crash,
            off: f64::NAN,
            why: format!("took longer than {LONGEST} s"),
            milliseconds: 1e3 * LONGEST,
        })
    })
}

fn pictures(spots: &[Spot], counts: &[Counts]) -> Result<(), Failure> {
    let folder = Path::new("docs/atlas");
    fs::create_dir_all(folder)?;
    let mut at = 0;
    for method in METHODS {
        let mut rows = Vec::new();
        for way in method.ways {
            let strengths = method.strengths(*way).len();
            rows.push(counts[at..at + strengths].to_vec());
            at += strengths;
        }
        fs::write(folder.join(stem(method.name) + ".svg"), picture(method, &rows))?;
    }
    for map in MAPS {
        let rows: Vec<Vec<Counts>> = (0..map.up.2.len())
            .map(|k| counts[at + k * map.right.2.len()..][..map.right.2.len()].to_vec())
            .collect();
        at += map.right.2.len() * map.up.2.len();
        fs::write(folder.join(stem(map.name) + ".svg"), map_picture(map, &rows))?;
    }
    debug_assert_eq!(at, spots.len());
    Ok(())
}

/// One run of each way at its third strength; an error where one crashes, or a whole method is right nowhere.
fn smoke() -> Result<(), Failure> {
    let begun = Instant::now();
    let chosen: Vec<Spot> = spots()
        .into_iter()
        .filter(|spot| matches!(spot, Spot::Cell(of, way, strength) if of.strengths(*way).get(2 / of.every) == Some(strength)))
        .collect();
    let jobs: Vec<(usize, u64)> = (0..chosen.len()).map(|k| (k, 7)).collect();
    let mut right = vec![0; METHODS.len()];
    let mut complaints = Vec::new();
    for ((spot, run), (_, seed)) in chosen.iter().zip(all(&jobs, &chosen)?).zip(&jobs) {
        let (Spot::Cell(method, way, strength), Some(run)) = (spot, run) else { continue };
        let place = METHODS.iter().position(|of| of.name == method.name).unwrap_or(0);
        right[place] += usize::from(run.outcome == Outcome::Right);
        if run.outcome == Outcome::Crash {
            complaints.push(format!("{}, {} {strength}, seed {seed}: {}", method.name, way.word(), run.why));
        }
    }
    complaints.extend(
        METHODS
            .iter()
            .zip(&right)
            .filter(|(_, n)| **n == 0)
            .map(|(of, _)| format!("{} is right nowhere", of.name)),
    );
    println!("{} runs in {:.0} s, right: {right:?}", jobs.len(), begun.elapsed().as_secs_f64());
    if complaints.is_empty() { Ok(()) } else { Err(complaints.join("\n").into()) }
}

/// Tells of one run.
fn one(words: &[String]) -> Result<(), Failure> {
    let [name, a, b, seed] = words else { return Err("needed: NAME WAY STRENGTH SEED".into()) };
    let seed: u64 = seed.parse()?;
    let at: f64 = b.parse()?;
    let spot = match a.parse::<f64>() {
        Ok(right) => MAPS.iter().find(|map| map.name == name).map(|map| Spot::Place(map, [right, at])),
        Err(_) => METHODS
            .iter()
            .find(|method| method.name == name)
            .and_then(|of| Some(Spot::Cell(of, *of.ways.iter().find(|way| way.word() == a)?, at))),
    };
    let run = spot.ok_or("no such method, map or way")?.run(seed);
    println!(
        "{}: {:.3} of what is allowed, {:.0} ms {}",
        run.outcome.words(),
        run.off,
        run.milliseconds,
        run.why
    );
    Ok(())
}

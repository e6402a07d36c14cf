//! Motion in the plane from contacts and forces, on bodies and palms drawn at random: relied on, right, how near to the least deviations that
//! the readings allow, and what is noticed of wrong constants. Prints tables in Markdown.
//!
//! `cargo xtask study planar_estimates [BODIES [SEED]]` writes docs/planar-estimates.md.

mod efficiency;

use crate::planar_tally::{SILENT, Tally};
use efficiency::Efficiency;
use recon::object_dynamics::planar::*;
use recon::observer::planar::{PlaneEstimate, PlaneOptions};
use recon_benches::planar::broken::{FAULTS, Wrong};
use recon_benches::planar::scene::{LASTS, Scene, drawn};

type Failure = Box<dyn std::error::Error>;

/// Noise of contacts over the size in logs that are wrong.
const NOISE_OF_WRONG: f64 = 2e-3;

/// Scenes of runs from no guess, noises of each, rate, Hz, and noise over size and weight where it is as good as none.
const SCENES: usize = 11;
const RUNS: u64 = 100;
const RATE: f64 = 250.0;
const EXACT: f64 = 1e-7;

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let bodies: usize = words.next().map_or(Ok(40), |a| a.parse())?;
    let seed: u64 = words.next().map_or(Ok(98_000), |a| a.parse())?;
    let scenes = drawn(bodies, seed)?;
    head(&scenes, bodies, seed)?;
    // Each run has noise of its own, so that what is over all of them is as sure as its band says.
    let (mut all, mut noises) = (Efficiency::default(), 0);
    for rate in [100.0, 250.0, 1000.0] {
        for noise in [1e-3, 1e-2] {
            for known in [true, false] {
                let mut tally = Efficiency::default();
                for scene in &scenes {
                    noises += 1;
                    tally.run(scene, rate, noise, known, seed + noises)?;
                }
                all.add(&tally);
                let body = if known { "known" } else { "unknown" };
                println!("| {rate} | {noise} | {body} | {} |", tally.told());
            }
        }
    }
    println!("| all | | | {} |", all.told());
    starts(seed)?;
    println!(
        "\nWrong constants and broken logs, known body, noise {} % of the size. Power: of each silent run, how probable it was, by the deviation that \
         the run itself states of that constant, that it would be named (4.75 of these, odds of two in a million).\n",
        100.0 * NOISE_OF_WRONG
    );
    println!(
        "| wrong | rate, Hz | runs | relied on | silent | mean square | place | us a sample |\n|---|---|---|---|---|---|---|---|"
    );
    for (wrong, name) in FAULTS {
        for rate in [100.0, 1000.0] {
            let mut tally = Tally::default();
            for (i, scene) in scenes.iter().enumerate() {
                let (log, options) = of_wrong(scene, rate, wrong, seed + 1000 + i as u64)?;
                tally.run(&log, &options, scene.length, |made| deviations(scene, wrong, made))?;
            }
            println!("| {name} | {rate} | {} |", tally.told());
        }
    }
    Ok(())
}

/// What is wrong in the deviation that is stated of it. Zero where none is.
fn deviations(scene: &Scene, wrong: Wrong, made: &PlaneEstimate) -> f64 {
    let own = wrong.constant(scene).and_then(|(constant, value)| {
        let suspect = made.suspects.iter().find(|suspect| suspect.fault == constant)?;
        Some(value.abs() / suspect.deviation)
    });
    own.unwrap_or(0.0)
}

/// Runs from no guess: the same scenes with other noise each time, and without.
fn starts(seed: u64) -> Result<(), Failure> {
    // Where nobody can know the place there is nothing to be right about.
    let mut scenes = Vec::with_capacity(SCENES);
    for scene in drawn(2 * SCENES, seed + 500)? {
        if scenes.len() < SCENES && efficiency::is_told(&scene, RATE, NOISE_OF_WRONG)? {
            scenes.push(scene);
        }
    }
    println!(
        "\nThe estimator has no start: each run is from no guess. {SCENES} scenes more, known to 1 % by the bound, at {RATE} Hz, known body, with {RUNS} noises each of {} % of the size, and once as good as exact \
         (noise of 1e-7 of size and weight).\n\n\
         | noise | runs | relied on | silent | mean square | place | us a sample |\n|---|---|---|---|---|---|---|",
        100.0 * NOISE_OF_WRONG
    );
    for (share, runs, name) in [(NOISE_OF_WRONG, RUNS, "0.002"), (0.0, 1, "1e-7")] {
        let mut tally = Tally::default();
        for (i, scene) in scenes.iter().enumerate() {
            let exact = scene.log(RATE)?;
            let noise = match share {
                0.0 => {
                    PlanarNoise { contact: EXACT * scene.length, force: EXACT * scene.weight(), torque: 0.0 }
                }
                share => scene.noise(share),
            };
            let told = scene.options(noise, Some(scene.object.mass));
            for run in 0..runs {
                let log = noise.add_to(&exact, seed + 20_000 + (i as u64) * RUNS + run);
                tally.run(&log.contact_log([0.0; 2]).ok_or("no forces")?, &told, scene.length, |_| 0.0)?;
            }
        }
        println!("| {name} | {} |", tally.told());
    }
    Ok(())
}

fn head(scenes: &[Scene], bodies: usize, seed: u64) -> Result<(), Failure> {
    let backs = scenes.iter().map(|scene| scene.turn_backs(&scene.log(20.0 / scene.time)?));
    let backs: Vec<usize> = backs.collect::<Result<_, Failure>>()?;
    let turning = backs.iter().filter(|backs| **backs > 0).count();
    let rest = scenes.iter().filter(|scene| scene.start.omega0 == 0.0).count();
    let stand = scenes.iter().filter(|scene| scene.palms.amplitudes == [0.0; 2]).count();
    println!(
        "# Motion in the plane from contacts and forces\n\nMade by `cargo xtask study planar_estimates {bodies} {seed}`.\n"
    );
    println!(
        "{bodies} bodies of 2 to 5 harmonics, 3 cm to 3 m, on two frictionless palms, up to {LASTS} natural times, from no guess. The palms of {stand} stand, \
         the others swing slowly or fast; {rest} bodies are let go at rest, and {turning} turn back against a palm, {} times in all. Noise of \
         contacts as a share of the size, of forces 1 % of the weight. Relied on: runs without a warning. Silent: of these with an error beyond \
         {SILENT} deviations of some number at some sample.\n",
        backs.iter().sum::<usize>()
    );
    println!(
        "The bound is the least deviation that the readings allow (Cramér-Rao, by sensitivities about the simulated motion: `benches/src/bound/plane.rs`). \
         Below 1 %: runs whose place is known to a hundredth of the size at the end by it; right: of these, relied on and within {SILENT} deviations at all \
         samples. Over these: root mean square errors at the end over the bound, and over that of an estimator that takes the error of a contact \
         in its condition and in the moment of its force for two (see [planar.md](planar.md)); mean square of errors at the end in their deviations, which are wider by what constants that may be wrong add to them, one log in ten being taken for one of \
         those beforehand; the same without that, of noise alone; and the band in which this is 19 times of 20 if deviations are right.\n"
    );
    println!(
        "| rate, Hz | noise | body | runs | relied on | silent | below 1 % | right | over the bound | over that of two | mean square | of noise alone | band | us a sample |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    );
    Ok(())
}

/// A noisy log in which something is wrong, with what is told of it.
fn of_wrong(
    scene: &Scene,
    rate: f64,
    wrong: Wrong,
    seed: u64,
) -> Result<(ContactLog, PlaneOptions), Failure> {
    let noise = scene.noise(NOISE_OF_WRONG);
    let log = wrong.misread(noise.add_to(&wrong.log(scene, rate)?, seed), scene.length, seed)?;
    let options = scene.options(noise, Some(wrong.told(scene.object.mass)?));
    Ok((log.contact_log([0.0; 2]).ok_or("no forces")?, options))
}

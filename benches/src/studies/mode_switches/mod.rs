//! Contact modes in scenes whose contacts come, go, slide and stick: how often they are told right, and how far their probabilities
//! are to be believed.
//!
//! `cargo xtask study mode_switches [SCENES [FIRST SEED [PICTURE]]]` writes docs/mode-switches.md and docs/charts/mode-switches.svg.

mod judge;
mod picture;
pub(super) mod scenes;
mod sensed;

use judge::{Judged, Way};
use scenes::Run;
use std::error::Error;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// Shares of the forces.
const NOISES: [f64; 2] = [1e-3, 1e-2];
/// The friction is unknown in one scene of so many: it takes a hundred times as long.
const UNKNOWN: u64 = 4;

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let mut words = crate::words();
    let scenes: u64 = words.next().map_or(Ok(100), |word| word.parse())?;
    let first: u64 = words.next().map_or(Ok(62_000), |word| word.parse())?;
    let file = words.next().map_or_else(|| PathBuf::from("docs/charts/mode-switches.svg"), PathBuf::from);
    let judged = on_two_cores(scenes, first)?;
    let all: Vec<&Judged> = judged.iter().collect();
    print!("{}", include_str!("about.md"));
    println!(
        "{scenes} scenes of each kind from seed {first} on, each with both noises: {} runs.\n",
        4 * scenes
    );
    println!("{}", judge::tables(&all));
    print!("{}", include_str!("outro.md"));
    Ok(std::fs::write(&file, picture::drawn(&all))?)
}

fn on_two_cores(scenes: u64, first: u64) -> Result<Vec<Judged>, Box<dyn Error>> {
    let next = AtomicU64::new(0);
    let work = || -> Result<Vec<(u64, Judged)>, String> {
        let mut own = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= 2 * scenes {
                return Ok(own);
            }
            let (spatial, seed) = (k.is_multiple_of(2), first + k / 2);
            let of = one(spatial, seed, (k / 2).is_multiple_of(UNKNOWN));
            let of = of.map_err(|error| format!("seed {seed}: {error}"))?;
            own.extend(of.into_iter().map(|judged| (k, judged)));
        }
    };
    let (one, two) = std::thread::scope(|scope| {
        let other = scope.spawn(work);
        (work(), other.join())
    });
    let mut all = one?;
    all.extend(two.map_err(|_| "a thread was lost")??);
    all.sort_by_key(|(k, _)| *k);
    Ok(all.into_iter().map(|(_, judged)| judged).collect())
}

/// One scene with both noises, in all ways.
fn one(spatial: bool, seed: u64, unknown: bool) -> Result<Vec<Judged>, Box<dyn Error>> {
    let run = Run::drawn(spatial, seed)?;
    let mut all = Vec::new();
    for noise in NOISES {
        let sensed = sensed::sensed(&run, noise, seed);
        for way in Way::ALL.into_iter().filter(|way| unknown || *way == Way::Known) {
            all.push(judge::judged(&run, &sensed, way, (spatial, noise))?);
        }
    }
    Ok(all)
}

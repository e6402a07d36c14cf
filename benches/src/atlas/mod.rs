//! The atlas of failures: each method along each way of failing, from where it is harmless to where nothing can be known, and what the
//! method said of itself there, judged by the truth of a simulator.
//!
//! A [`Way`] has some strengths, a [`Method`] the ways that concern it; a run is one method, one way, one strength and one seed. What
//! became of it is an [`Outcome`]. `cargo xtask atlas` makes all of them and writes `docs/atlas.md` with a picture for each method.

mod boundaries;
mod bounds;
mod fits;
mod judged;
mod modes;
mod picture;
mod plan;
mod planar;
mod simulation;
mod spatial;
mod table;
mod way;

pub use boundaries::boundaries;
pub use judged::{Outcome, Run};
pub use picture::{map_picture, picture};
pub use plan::{Counts, MAPS, Map, Spot, spots};
pub use table::{counts_csv, page, stem};
pub use way::Way;

use judged::Ran;

type Failure = Box<dyn std::error::Error>;

/// Deviations within which an estimate is right.
const DEVIATIONS: f64 = 5.0;
/// Gravity, m/s^2.
const G: f64 = 9.81;

/// Something that may fail.
#[derive(Clone, Copy)]
pub struct Method {
    /// In words; also the stem of its files.
    pub name: &'static str,
    /// What is judged, and by which truth.
    pub about: &'static str,
    /// What concerns it.
    pub ways: &'static [Way],
    /// Seeds at each strength, for each that is asked for: cheap methods have more.
    pub seeds: u64,
    /// Of the strengths of a way every one, or the second, fourth and so on: dear methods have fewer.
    pub every: usize,
    run: fn(Way, f64, u64) -> Result<Ran, Failure>,
}

/// All of them, in the order of the page.
pub const METHODS: &[Method] = &[
    spatial::KNOWN,
    spatial::UNKNOWN,
    spatial::STREAM,
    spatial::WITHOUT_FORCES,
    spatial::PAPER,
    planar::KNOWN,
    planar::UNKNOWN,
    simulation::THREE_PALMS,
    simulation::FRICTION,
    simulation::PLANAR,
    bounds::STATED,
    bounds::CURVED,
    fits::METHOD,
    modes::METHOD,
];

impl Method {
    /// Its strengths of a way.
    #[must_use]
    pub fn strengths(&self, way: Way) -> Vec<f64> {
        way.strengths().iter().skip(self.every - 1).step_by(self.every).copied().collect()
    }

    /// One run, whatever becomes of it.
    #[must_use]
    pub fn run(&self, way: Way, strength: f64, seed: u64) -> Run {
        judged::caught(|| (self.run)(way, strength, seed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The harmless end of the ways of all methods that cost milliseconds: each is right somewhere, and none crashes.
    #[test]
    fn cheap_methods_are_right_where_their_ways_are_harmless() {
        let cheap = [
            &simulation::THREE_PALMS,
            &simulation::PLANAR,
            &bounds::CURVED,
            &fits::METHOD,
            &modes::METHOD,
            &spatial::PAPER,
        ];
        for method in cheap {
            let runs = method.ways.iter().step_by(2).map(|way| method.run(*way, way.strengths()[1], 3));
            let runs: Vec<Run> = runs.collect();
            assert!(runs.iter().all(|run| run.outcome != Outcome::Crash), "{}: {runs:?}", method.name);
            let right = runs.iter().filter(|run| run.outcome == Outcome::Right).count();
            assert!(2 * right > runs.len(), "{}: {runs:?}", method.name);
        }
    }

    /// A run is of its method, way, strength and seed alone: what is kept of it is what it would be again.
    #[test]
    fn the_same_run_comes_to_the_same() {
        let again = || fits::METHOD.run(Way::Cone, 60.0, 11);
        let (once, twice) = (again(), again());
        assert_eq!(
            (once.outcome, once.off.to_bits(), once.why),
            (twice.outcome, twice.off.to_bits(), twice.why)
        );
    }
}

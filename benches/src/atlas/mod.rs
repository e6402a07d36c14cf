//! The atlas of failures: each method along each way of failing, from where it is harmless to where nothing can be known, and what the
//! method said of itself there, judged by the truth of a simulator.
//!
//! A [`Way`] has some strengths, a [`Method`] the ways that concern it; a run is one method, one way, one strength and one seed. What
//! became of it is an [`Outcome`]. `cargo xtask atlas` makes all of them and writes `docs/atlas.md` with a picture for each method.

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
    /// One run, whatever becomes of it.
    #[must_use]
    pub fn run(&self, way: Way, strength: f64, seed: u64) -> Run {
        judged::caught(|| (self.run)(way, strength, seed))
    }
}

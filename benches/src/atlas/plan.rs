//! Which runs there are, in the order of their numbers, and what came of those of one place of a picture.

use super::judged::{Outcome, Ran, Run, caught};
use super::spatial::{friction_and_sensing, scene::Spec, whole_log};
use super::{Failure, METHODS, Method, Way, planar};

/// A picture of two causes that meet.
#[derive(Clone, Copy)]
pub struct Map {
    /// In words; also the stem of its file.
    pub name: &'static str,
    /// What is to the right, with its unit and values.
    pub right: (&'static str, &'static str, &'static [f64]),
    /// What is upwards.
    pub up: (&'static str, &'static str, &'static [f64]),
    run: fn([f64; 2], u64) -> Result<Ran, Failure>,
}

const WINDOWS: &[f64] = &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 12.0];
const NOISES: &[f64] = &[1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1];
const FRICTIONS: &[f64] = &[3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3];
const DEPARTURES: &[f64] = &[0.0, 0.01, 0.03, 0.1, 0.2, 0.5];

fn window([lasts, noise]: [f64; 2]) -> Spec {
    Spec { noise: [noise, 3.0 * noise], ..Spec::of(Way::Window, lasts) }
}

/// All of them.
pub const MAPS: &[Map] = &[
    Map {
        name: "window and noise, body known",
        right: ("length of the log", "natural times", WINDOWS),
        up: ("noise of contacts, a third of that of forces", "sizes, weights", NOISES),
        run: |at, seed| whole_log(window(at), seed, true),
    },
    Map {
        name: "window and noise, body unknown",
        right: ("length of the log", "natural times", WINDOWS),
        up: ("noise of contacts, a third of that of forces", "sizes, weights", NOISES),
        run: |at, seed| whole_log(window(at), seed, false),
    },
    Map {
        name: "window and noise in the plane, body unknown",
        right: ("length of the log", "natural times", WINDOWS),
        up: ("noise of contacts, a third of that of forces", "sizes, weights", NOISES),
        run: |[lasts, noise], seed| {
            let of = planar::Spec { noise: [noise, 3.0 * noise], ..planar::Spec::of(Way::Window, lasts) };
            planar::of_spec(of, seed, false)
        },
    },
    Map {
        name: "friction and force sensing, body unknown",
        right: ("friction of palms that are said to have none", "1", FRICTIONS),
        up: ("noise of forces", "weights", NOISES),
        run: |[friction, noise], seed| friction_and_sensing(friction, noise, seed),
    },
    Map {
        name: "roundness and noise, body unknown",
        right: ("departure d from a ball (axes 1, 1 + d, 1 + 2 d)", "1", DEPARTURES),
        up: ("noise of contacts, a third of that of forces", "sizes, weights", NOISES),
        run: |[d, noise], seed| {
            let of = Spec { noise: [noise, 3.0 * noise], ..Spec::of(Way::Sphere, d) };
            whole_log(of, seed, false)
        },
    },
];

impl Map {
    /// One run.
    #[must_use]
    pub fn run(&self, at: [f64; 2], seed: u64) -> Run {
        caught(|| (self.run)(at, seed))
    }
}

/// What is run.
#[derive(Clone, Copy)]
pub enum Spot {
    /// A method, a way, a strength.
    Cell(&'static Method, Way, f64),
    /// A map, and where on it.
    Place(&'static Map, [f64; 2]),
}

impl Spot {
    /// One run of it.
    #[must_use]
    pub fn run(&self, seed: u64) -> Run {
        match self {
            Self::Cell(method, way, strength) => method.run(*way, *strength, seed),
            Self::Place(map, at) => map.run(*at, seed),
        }
    }

    /// How many seeds it has, for so many.
    #[must_use]
    pub fn seeds(&self, each: u64) -> u64 {
        match self {
            Self::Cell(method, ..) => each * method.seeds,
            Self::Place(..) => each,
        }
    }
}

/// All of them, in order.
#[must_use]
pub fn spots() -> Vec<Spot> {
    let mut all = Vec::new();
    for method in METHODS {
        for way in method.ways {
            all.extend(method.strengths(*way).into_iter().map(|strength| Spot::Cell(method, *way, strength)));
        }
    }
    for map in MAPS {
        for up in map.up.2 {
            all.extend(map.right.2.iter().map(|right| Spot::Place(map, [*right, *up])));
        }
    }
    all
}

/// What came of the runs of a spot.
#[derive(Clone, Debug, Default)]
pub struct Counts {
    /// Of each outcome, in the order of [`Outcome::ALL`].
    pub of: [usize; 6],
    /// Errors of what is right in what is allowed, and times, ms.
    pub offs: Vec<f64>,
    /// Wall times, ms.
    pub milliseconds: Vec<f64>,
    /// Silent and crashed: seed, error in what is allowed, words.
    pub bad: Vec<(u64, f64, String)>,
}

impl Counts {
    /// Takes one.
    pub fn take(&mut self, seed: u64, run: &Run) {
        for (count, outcome) in self.of.iter_mut().zip(Outcome::ALL) {
            *count += usize::from(outcome == run.outcome);
        }
        self.milliseconds.push(run.milliseconds);
        match run.outcome {
            Outcome::Right => self.offs.push(run.off),
            Outcome::Silent => self.bad.push((seed, run.off, String::new())),
            Outcome::Crash => self.bad.push((seed, run.off, run.why.clone())),
            _ => {}
        }
    }

    /// How many there are of an outcome.
    #[must_use]
    pub fn count(&self, outcome: Outcome) -> usize {
        self.of.iter().zip(Outcome::ALL).filter(|(_, of)| *of == outcome).map(|(n, _)| n).sum()
    }

    /// All that could be judged.
    #[must_use]
    pub fn judged(&self) -> usize {
        self.of.iter().sum::<usize>() - self.count(Outcome::NoScene)
    }
}

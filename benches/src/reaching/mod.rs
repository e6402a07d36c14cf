//! Planners on seeded bodies: the runs behind the study `reaching` and its charts.

pub mod hindsight;
pub mod plane;
pub mod space;
pub mod statistics;
pub mod told;

use crate::rows::Cells;
use exploration::generators::Family;

/// A planner with the name that tables give it, and how one is made from a seed.
pub struct Named<P: ?Sized> {
    /// As in tables.
    pub name: &'static str,
    /// From the seed of the body, which turns the start.
    pub make: fn(u64) -> Box<P>,
}

/// What a planner did on one body.
#[derive(Clone, Debug)]
pub struct Trace {
    /// The body's family.
    pub family: Family,
    /// Gap (or whatever the goal is about) after each touch.
    pub progress: Vec<f64>,
    /// Way up to each touch, in rad.
    pub way: Vec<f64>,
    /// Time for the planner's choices in all, in s.
    pub seconds: f64,
}

impl Trace {
    /// Touches and way in rad until the goal's quantity was `goal` or less; none if it never was.
    #[must_use]
    pub fn to(&self, goal: f64) -> Option<(usize, f64)> {
        let at = self.progress.iter().position(|gap| *gap <= goal)?;
        Some((at + 1, self.way[at]))
    }
}

/// By its name.
impl Cells for Family {
    fn write(&self, to: &mut Vec<String>) {
        self.name().to_owned().write(to);
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        let name = String::read(from)?;
        Self::ALL.into_iter().find(|family| family.name() == name)
    }
}

impl Cells for Trace {
    fn write(&self, to: &mut Vec<String>) {
        (self.family, self.seconds).write(to);
        (self.progress.clone(), self.way.clone()).write(to);
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        let (family, seconds) = Cells::read(from)?;
        let (progress, way) = Cells::read(from)?;
        Some(Self { family, progress, way, seconds })
    }
}

/// Bodies of each family and the seed of the first: ten with seeds that nothing was chosen on.
#[derive(Clone, Copy, Debug)]
pub struct Bodies {
    /// First seed.
    pub first: u64,
    /// Bodies of each family.
    pub each: u64,
}

impl Bodies {
    /// Family and seed of each.
    pub fn all(self) -> impl Iterator<Item = (Family, u64)> {
        let seeds = move |family| (self.first..self.first + self.each).map(move |seed| (family, seed));
        Family::ALL.into_iter().flat_map(seeds)
    }
}

/// `work` on each item in two threads; results in the order of the items, the same for any number of threads.
pub fn in_threads<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let half = items.len().div_ceil(2);
    let (first, second) = items.split_at(half);
    std::thread::scope(|scope| {
        let other = scope.spawn(|| second.iter().map(&work).collect::<Vec<R>>());
        let mut all: Vec<R> = first.iter().map(&work).collect();
        match other.join() {
            Ok(rest) => all.extend(rest),
            Err(panic) => std::panic::resume_unwind(panic),
        }
        all
    })
}

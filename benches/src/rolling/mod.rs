//! Palm motions on seeded bodies: the runs behind the study `rolling` and its chart.

pub mod reachable;

use crate::reaching::Bodies;
use crate::rows::{Cells, rows_in_threads};
use exploration::generators::{Family, Outline, outline};
use exploration::planar::{Noise, PlanarKnowledge};
use exploration::rolling::{
    InformationRate, LargestGap, NearestGap, PalmSweep, RandomTurns, RollEnd, RollError, RollOutcome,
    RollPlanError, RollPlanner, RollProposal, RollTask, RollingBody, SimulatedPalms, View, Workspace,
    explore_rolling,
};
use exploration::{Confidence, Goal, Heading, Knowledge, KnowledgeError, Source, Spending};
use glam::DVec2;
use recon::shape_bounds::exact_hull::planar::Direction;
use std::f64::consts::TAU;
use std::time::Instant;

/// A planner with the name that tables give it, and how one is made from a seed.
pub struct Roller {
    /// As in tables.
    pub name: &'static str,
    /// From the seed of the body.
    pub make: fn(u64) -> Box<dyn RollPlanner>,
}

/// All that are compared.
pub const PLANNERS: [Roller; 6] = [
    Roller { name: "gap per radian, 2 ahead", make: |s| Box::new(InformationRate::new(s, 2).per_radian()) },
    Roller { name: "gap per second, 2 ahead", make: |s| Box::new(InformationRate::new(s, 2)) },
    Roller { name: "nearest gap", make: |s| Box::new(NearestGap::new(s)) },
    Roller { name: "largest gap", make: |s| Box::new(LargestGap::new(s)) },
    Roller { name: "fixed sweep", make: |_| Box::new(PalmSweep::new()) },
    Roller { name: "random", make: |s| Box::new(RandomTurns::new(s)) },
];

/// Motions ahead and bodies drawn of "gap per radian", and how it is made.
pub type Lookahead = (usize, usize, Roller);

/// The same with other horizons and numbers of bodies: cost against benefit. Two ahead on twelve is the one that is compared with others.
pub const LOOKAHEAD: [Lookahead; 8] = [
    (
        1,
        1,
        per_radian("1 ahead, 1 body", |s| Box::new(InformationRate::new(s, 1).per_radian().with_bodies(1))),
    ),
    (
        1,
        4,
        per_radian("1 ahead, 4 bodies", |s| Box::new(InformationRate::new(s, 1).per_radian().with_bodies(4))),
    ),
    (1, 12, per_radian("1 ahead, 12 bodies", |s| Box::new(InformationRate::new(s, 1).per_radian()))),
    (
        1,
        32,
        per_radian("1 ahead, 32 bodies", |s| {
            Box::new(InformationRate::new(s, 1).per_radian().with_bodies(32))
        }),
    ),
    (
        2,
        4,
        per_radian("2 ahead, 4 bodies", |s| Box::new(InformationRate::new(s, 2).per_radian().with_bodies(4))),
    ),
    (2, 12, per_radian("2 ahead, 12 bodies", |s| Box::new(InformationRate::new(s, 2).per_radian()))),
    (
        3,
        4,
        per_radian("3 ahead, 4 bodies", |s| Box::new(InformationRate::new(s, 3).per_radian().with_bodies(4))),
    ),
    (3, 12, per_radian("3 ahead, 12 bodies", |s| Box::new(InformationRate::new(s, 3).per_radian()))),
];

const fn per_radian(name: &'static str, make: fn(u64) -> Box<dyn RollPlanner>) -> Roller {
    Roller { name, make }
}

/// A generator's body with its centre of mass.
pub struct Rolled {
    outline: Outline,
    centre: DVec2,
}

impl RollingBody for Rolled {
    fn farthest(&self, theta: f64) -> DVec2 {
        (self.outline)(Direction::from_angle(theta))
    }

    fn centre(&self) -> DVec2 {
        self.centre
    }
}

/// Directions by which widths and centroids are summed.
const LATTICE: usize = 720;

/// A body of uniform density and its mean width in m.
#[must_use]
pub fn rolled(family: Family, seed: u64) -> (Rolled, f64) {
    let outline = outline(family, seed);
    let ring: Vec<DVec2> = Direction::spread(LATTICE).into_iter().map(&outline).collect();
    let (mut area, mut moment, mut length) = (0.0, DVec2::ZERO, 0.0);
    for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        let cross = a.perp_dot(*b);
        area += cross;
        moment += (*a + *b) * cross;
        length += a.distance(*b);
    }
    (Rolled { outline, centre: moment / (3.0 * area) }, length / std::f64::consts::PI)
}

/// What a planner did on one body.
#[derive(Clone, Debug)]
pub struct Rolling {
    /// The body's family.
    pub family: Family,
    /// Radians of palm motion, seconds and gap after each reading.
    pub steps: Vec<[f64; 3]>,
    /// Motions.
    pub motions: usize,
    /// Falls.
    pub falls: usize,
    /// Time for the planner's choices in all, in s.
    pub planning: f64,
    /// Why it ended short, in a word; none where the goal is proven.
    pub short: Option<&'static str>,
    /// Directions that were named as out of reach, rad.
    pub named: Vec<f64>,
    /// Whether the body was between the bounds after every reading.
    pub holds: bool,
    /// Contacts taken.
    pub contacts: usize,
}

impl Rolling {
    /// Radians and seconds until the gap was `goal` or less; none if it never was.
    #[must_use]
    pub fn to(&self, goal: f64) -> Option<[f64; 2]> {
        self.steps.iter().find(|step| step[2] <= goal).map(|step| [step[0], step[1]])
    }
}

/// Time of a choice, ms: mean over the motions of some runs.
#[must_use]
pub fn choice_ms(runs: &[Rolling]) -> f64 {
    let motions: usize = runs.iter().map(|run| run.motions).sum();
    1e3 * runs.iter().map(|run| run.planning).sum::<f64>() / motions.max(1) as f64
}

/// Measures the time of another planner.
pub(crate) struct Timed {
    pub(crate) inner: Box<dyn RollPlanner>,
    pub(crate) seconds: f64,
}

impl RollPlanner for Timed {
    fn name(&self) -> &'static str {
        self.inner.name()
    }

    fn next(&mut self, view: &View<'_>) -> Result<RollProposal, RollPlanError> {
        let start = Instant::now();
        let next = self.inner.next(view);
        self.seconds += start.elapsed().as_secs_f64();
        next
    }
}

/// Noise of a run: standard deviation of a point over the mean width, normals by twice that in rad, 95 %.
#[derive(Clone, Copy, Debug)]
pub struct Noisy {
    /// Over the mean width.
    pub level: f64,
    /// Contacts that the confidence is shared among.
    pub budget: usize,
}

/// What is asked for, and with what.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// The gap.
    pub goal: f64,
    /// Radians of palm motion at most.
    pub radians: f64,
    /// Of the contacts; none of exact ones.
    pub noise: Option<Noisy>,
    /// How far each palm may be from where it starts, rad; none for palms that turn almost from one side to the other.
    pub room: Option<f64>,
}

/// Where palms start, rad.
pub const START: [f64; 2] = [0.7, 2.4];

impl Asked {
    /// The limits of the palms about a body of this mean width (m).
    #[must_use]
    pub fn workspace(&self, width: f64) -> Workspace {
        let whole = Workspace::for_size(width);
        let angles = self.room.map(|room| START.map(|at| [at - room, at + room]));
        Workspace { angles: angles.unwrap_or(whole.angles), ..whole }
    }
}

/// Orientation in which the body of a seed is let go, rad.
#[must_use]
pub fn let_go(seed: u64) -> f64 {
    Source::new(seed).between(0.0, TAU)
}

/// One run.
///
/// # Errors
/// Those of the exploration.
pub fn run(
    make: fn(u64) -> Box<dyn RollPlanner>,
    (family, seed): (Family, u64),
    asked: &Asked,
) -> Result<Rolling, RollError> {
    let Asked { goal, radians, noise, .. } = *asked;
    let (body, width) = rolled(family, seed);
    let truth = rolled(family, seed).0;
    let workspace = asked.workspace(width);
    let mut palms =
        SimulatedPalms::new(body, workspace.length, START, let_go(seed)).map_err(RollError::Start)?;
    let mut task = RollTask { radians, motions: 400, ..RollTask::new(Goal::Gap(goal), workspace) };
    let mut known = PlanarKnowledge::exact();
    if let Some(Noisy { level, budget }) = noise {
        let spending = Spending::Budget(budget);
        let confidence = Confidence::new(0.95, spending)
            .map_err(|e| RollError::Knowledge(KnowledgeError::Confidence(e)))?;
        known = PlanarKnowledge::noisy(Noise { point: level * width, normal: 2.0 * level, confidence });
        palms = palms.with_noise(level * width, 2.0 * level, seed);
        task = RollTask { spending: Some(spending), ..task };
    }
    let mut planner = Timed { inner: make(seed), seconds: 0.0 };
    let (mut steps, mut motions, mut falls, mut holds, mut seen) = (Vec::new(), 0, 0, true, 0);
    let outcome = explore_rolling(&mut known, &mut planner, &mut palms, &task, |step, known| {
        steps.push([step.radians, step.seconds, step.progress]);
        motions = step.motion;
        falls += usize::from(step.reading.fell);
        if known.touches() > seen {
            seen = known.touches();
            holds &= contains(known, &truth);
        }
    })?;
    let (short, named) = match &outcome {
        RollOutcome::Reached(_) => (None, Vec::new()),
        RollOutcome::Short { end: RollEnd::Budget, .. } => (Some(SHORT[0]), Vec::new()),
        RollOutcome::Short { end: RollEnd::NotFound { directions }, .. } => {
            (Some(SHORT[1]), directions.iter().map(|d| d.get().to_angle()).collect())
        }
        RollOutcome::Short { end: RollEnd::Lost(_), .. } => (Some(SHORT[2]), Vec::new()),
    };
    let (planning, contacts) = (planner.seconds, known.touches());
    Ok(Rolling { family, steps, motions, falls, planning, short, named, holds, contacts })
}

/// Whether the body's support function is between those of the bounds, but for rounding, at 180 directions.
fn contains(known: &PlanarKnowledge, body: &Rolled) -> bool {
    Direction::spread(180).into_iter().all(|u| {
        let (low, high) = known.support(u);
        let h = (body.outline)(u).dot(u.get());
        low - 1e-9 <= h && h <= high + 1e-9
    })
}

/// The runs of a planner on all bodies (of a part of a study: of some), in two threads, in the order of the bodies.
///
/// # Errors
/// The first error of a run.
pub fn runs(
    roller: &Roller,
    bodies: Bodies,
    asked: &Asked,
) -> Result<Vec<Rolling>, Box<dyn std::error::Error + Send + Sync>> {
    let all: Vec<_> = bodies.all().collect();
    rows_in_threads(&all, |body| Ok(run(roller.make, *body, asked)?))
}

/// How runs end short.
const SHORT: [&str; 3] = ["budget", "not found", "lost"];

impl Cells for Rolling {
    fn write(&self, to: &mut Vec<String>) {
        self.family.write(to);
        self.steps.write(to);
        [self.motions, self.falls, self.contacts].write(to);
        self.named.write(to);
        (self.planning, self.short.map(str::to_owned), self.holds).write(to);
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        let family = Family::read(from)?;
        let steps = Cells::read(from)?;
        let [motions, falls, contacts] = Cells::read(from)?;
        let named = Cells::read(from)?;
        let (planning, word, holds): (_, Option<String>, _) = Cells::read(from)?;
        let short = match word {
            // A word that is none of them is no row.
            Some(word) => Some(SHORT.into_iter().find(|short| *short == word)?),
            None => None,
        };
        Some(Self { family, steps, motions, falls, planning, short, named, holds, contacts })
    }
}

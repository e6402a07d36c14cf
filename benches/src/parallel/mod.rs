//! Strokes of a palm on seeded bodies: the runs behind the study `parallel` and its chart.

pub mod reachable;

use crate::reaching::{Bodies, Named};
use crate::rows::{Cells, rows_in_threads};
use exploration::generators::{Family, solid};
use exploration::parallel::{
    EstimatedPalms, LargestGap, NearestGap, ParallelError, ParallelPalms, ParallelPlanError, ParallelPlanner,
    ParallelProposal, ParallelTask, ParallelView, ParallelWorkspace, PathRate, RandomStrokes, RasterSweep,
    SimulatedParallelPalms, Stop, explore_parallel,
};
use exploration::space::{Noise, SpaceKnowledge};
use exploration::{
    Confidence, Goal, Heading, Knowledge, KnowledgeError, Outcome, Shortfall, Source, Spending,
};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::Direction;
use recon::observer::rolling::RollingNoise;
use std::time::Instant;

/// All that are compared.
pub const PLANNERS: [Named<dyn ParallelPlanner>; 6] = [
    Named { name: "gap per way, 2 ahead", make: |s| Box::new(PathRate::new(s, 2)) },
    Named { name: "gap per way, 1 ahead", make: |s| Box::new(PathRate::new(s, 1)) },
    Named { name: "nearest gap", make: |s| Box::new(NearestGap::new(s)) },
    Named { name: "largest gap", make: |s| Box::new(LargestGap::new(s)) },
    Named { name: "fixed sweep", make: |_| Box::new(RasterSweep::new()) },
    Named { name: "random", make: |s| Box::new(RandomStrokes::new(s)) },
];

/// Strokes ahead and bodies drawn of "gap per way", and how it is made.
pub type Lookahead = (usize, usize, Named<dyn ParallelPlanner>);

/// Cost against benefit: horizons and numbers of bodies.
pub const LOOKAHEAD: [Lookahead; 5] = [
    (1, 1, Named { name: "1 ahead, 1 body", make: |s| Box::new(PathRate::new(s, 1).with_bodies(1)) }),
    (1, 3, Named { name: "1 ahead, 3 bodies", make: |s| Box::new(PathRate::new(s, 1)) }),
    (1, 8, Named { name: "1 ahead, 8 bodies", make: |s| Box::new(PathRate::new(s, 1).with_bodies(8)) }),
    (2, 3, Named { name: "2 ahead, 3 bodies", make: |s| Box::new(PathRate::new(s, 2)) }),
    (3, 3, Named { name: "3 ahead, 3 bodies", make: |s| Box::new(PathRate::new(s, 3)) }),
];

/// Under which conditions bodies are rolled.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Coefficient of friction.
    pub friction: f64,
    /// Gap to be proven.
    pub goal: f64,
    /// Way of the palm at most, in mean widths.
    pub way: f64,
    /// Noise of the palms over the mean width, with what pads let spin, 95 % shared among so many contacts; none for exact contacts in axes of the body.
    pub noise: Option<(RollingNoise, usize)>,
}

/// What a planner did on one body.
#[derive(Clone, Debug)]
pub struct Rolling {
    /// The body's family.
    pub family: Family,
    /// Way of the palm (mean widths), turn of the body (rad) and gap after each reading.
    pub steps: Vec<[f64; 3]>,
    /// Strokes, those that shear stopped and those that the edge of a pad stopped.
    pub strokes: [usize; 3],
    /// Contacts taken.
    pub contacts: usize,
    /// Time for the planner's choices in all, and the longest, s.
    pub planning: [f64; 2],
    /// Why it ended short, in a word; none where the goal is proven.
    pub short: Option<&'static str>,
    /// Whether the body was between the bounds after every contact.
    pub holds: bool,
    /// Normal at the upper contact when it was first held, body axes; none where it was held nowhere.
    pub up: Option<[f64; 3]>,
    /// Directions that were named as out of reach, body axes.
    pub named: Vec<[f64; 3]>,
}

impl Rolling {
    /// Way (mean widths) and turn (rad) until the gap was `goal` or less; none if it never was.
    #[must_use]
    pub fn to(&self, goal: f64) -> Option<[f64; 2]> {
        self.steps.iter().find(|step| step[2] <= goal).map(|step| [step[0], step[1]])
    }
}

struct Timed {
    inner: Box<dyn ParallelPlanner>,
    seconds: [f64; 2],
}

impl ParallelPlanner for Timed {
    fn name(&self) -> &'static str {
        self.inner.name()
    }

    fn next(&mut self, view: &ParallelView<'_>) -> Result<ParallelProposal, ParallelPlanError> {
        let start = Instant::now();
        let next = self.inner.next(view);
        let took = start.elapsed().as_secs_f64();
        self.seconds = [self.seconds[0] + took, self.seconds[1].max(took)];
        next
    }
}

/// Directions over which widths are averaged, and containment is looked at.
const LATTICE: usize = 200;
/// How runs end short.
const SHORT: [&str; 3] = ["budget", "not found", "not held"];

/// One run.
///
/// # Errors
/// Those of the exploration.
pub fn run(
    make: fn(u64) -> Box<dyn ParallelPlanner>,
    (family, seed): (Family, u64),
    setting: &Setting,
) -> Result<Rolling, ParallelError> {
    let body = solid(family, seed);
    let lattice = <Direction as Heading>::spread(LATTICE);
    let size = 2.0 * lattice.iter().map(|n| body(*n).dot(n.get())).sum::<f64>() / LATTICE as f64;
    let workspace = ParallelWorkspace::for_size(size, setting.friction);
    let mut task = ParallelTask {
        way: setting.way * size,
        strokes: 400,
        ..ParallelTask::new(Goal::Gap(setting.goal), workspace)
    };
    let mut run = Rolling {
        family,
        steps: Vec::new(),
        strokes: [0; 3],
        contacts: 0,
        planning: [0.0; 2],
        short: None,
        holds: true,
        up: None,
        named: Vec::new(),
    };
    let palms = SimulatedParallelPalms::new(&body, workspace, Source::new(seed).rotation());
    let Ok(mut palms) = palms else {
        run.short = Some(SHORT[2]);
        return Ok(run);
    };
    let mut known = SpaceKnowledge::exact();
    // How axes of the body that are estimated lie to its own.
    let mut own = (DQuat::IDENTITY, DVec3::ZERO);
    let mut estimated;
    let palms: &mut dyn ParallelPalms = match setting.noise {
        Some((over, budget)) => {
            let noise =
                RollingNoise { contact: over.contact * size, palm: over.palm * size, spin: over.spin };
            let spending = Spending::Budget(budget);
            let confidence = Confidence::new(0.95, spending)
                .map_err(|e| ParallelError::Knowledge(KnowledgeError::Confidence(e)))?;
            known = SpaceKnowledge::noisy(Noise { point: noise.palm, normal: 0.0, confidence });
            task.spending = Some(spending);
            own = palms.pose();
            estimated = EstimatedPalms::new(palms.with_noise(noise, seed), noise)?;
            &mut estimated
        }
        None => &mut palms,
    };
    let mut planner = Timed { inner: make(seed), seconds: [0.0; 2] };
    let (mut turned, mut last, mut seen) = (0.0, None, 0);
    let outcome = explore_parallel(&mut known, &mut planner, palms, &task, |step, known| {
        let up = step.reading.hold.normals()[0];
        run.up.get_or_insert(up.get().to_array());
        turned += last.map_or(0.0, |last: Direction| last.angle_to(up));
        last = Some(up);
        run.steps.push([step.way / size, turned, step.progress]);
        run.strokes[0] = step.stroke;
        run.strokes[1] += usize::from(step.reading.stop == Some(Stop::Shear));
        run.strokes[2] += usize::from(step.reading.stop == Some(Stop::Pad));
        if known.touches() > seen {
            seen = known.touches();
            run.holds &= lattice.iter().all(|u| {
                let (low, high) = known.support(*u);
                let along = Direction::new(own.0.inverse() * u.get()).unwrap_or(*u);
                let h = (own.0 * body(along) + own.1).dot(u.get());
                low - 1e-9 <= h && h <= high + 1e-9
            });
        }
    })?;
    run.short = match &outcome {
        Outcome::Reached(_) => None,
        Outcome::Short { shortfall: Shortfall::Budget, .. } => Some(SHORT[0]),
        Outcome::Short { .. } => Some(SHORT[1]),
    };
    if let Outcome::Short { shortfall: Shortfall::NotFound { directions }, .. } = outcome {
        run.named = directions.iter().filter_map(|d| d.as_slice().try_into().ok()).collect();
    }
    (run.planning, run.contacts) = (planner.seconds, known.touches());
    Ok(run)
}

/// The runs of a planner on all bodies (of a part of a study: of some), in two threads, in the order of the bodies.
///
/// # Errors
/// The first error of a run.
pub fn runs(
    planner: &Named<dyn ParallelPlanner>,
    bodies: Bodies,
    setting: &Setting,
) -> Result<Vec<Rolling>, Box<dyn std::error::Error + Send + Sync>> {
    let all: Vec<_> = bodies.all().collect();
    rows_in_threads(&all, |body| Ok(run(planner.make, *body, setting)?))
}

impl Cells for Rolling {
    fn write(&self, to: &mut Vec<String>) {
        self.family.write(to);
        self.steps.write(to);
        (self.strokes, self.contacts, self.planning).write(to);
        (self.short.map(str::to_owned), self.holds).write(to);
        self.up.write(to);
        self.named.write(to);
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        let family = Family::read(from)?;
        let steps = Cells::read(from)?;
        let (strokes, contacts, planning) = Cells::read(from)?;
        let (word, holds): (Option<String>, _) = Cells::read(from)?;
        let short = match word {
            // A word that is none of them is no row.
            Some(word) => Some(SHORT.into_iter().find(|short| *short == word)?),
            None => None,
        };
        let up = Cells::read(from)?;
        let named = Cells::read(from)?;
        Some(Self { family, steps, strokes, contacts, planning, short, holds, up, named })
    }
}

//! Runs in space.

use super::{Bodies, Named, Trace};
use crate::rows::rows_in_threads;
use exploration::generators::{Family, Solid, solid};
use exploration::space::{
    FixedSweep, GaussianVariance, HausdorffGreedy, Noise, PathAware, RandomTouches, SimulatedFinger,
    SpaceKnowledge, VolumeGreedy, turned_tetrahedron,
};
use exploration::{
    Confidence, ExploreError, Goal, Heading, Knowledge, Motion, Outcome, PlanError, Planner, Proposal,
    Situation, Spending, Task, explore,
};
use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::shape_bounds::distance::nearest;
use recon::shape_bounds::{ContactSample, ShapeBounds};
use std::time::Instant;

/// Any planner in space.
pub type AnyPlanner = dyn Planner<SpaceKnowledge>;

/// All that are compared.
pub const PLANNERS: [Named<AnyPlanner>; 6] = [
    Named { name: "path-aware", make: |seed| Box::new(PathAware::new(turned_tetrahedron(seed))) },
    Named { name: "volume-greedy", make: |seed| Box::new(VolumeGreedy::new(turned_tetrahedron(seed))) },
    Named { name: "Hausdorff-greedy", make: |seed| Box::new(HausdorffGreedy::new(turned_tetrahedron(seed))) },
    Named {
        name: "Gaussian process",
        make: |seed| Box::new(GaussianVariance::new(turned_tetrahedron(seed))),
    },
    Named { name: "R2 sweep", make: |seed| Box::new(FixedSweep::new(turned_tetrahedron(seed))) },
    Named { name: "random", make: |seed| Box::new(RandomTouches::new(turned_tetrahedron(seed), seed)) },
];

/// Measures the time of another planner.
struct Timed<'a> {
    inner: &'a mut AnyPlanner,
    seconds: f64,
}

impl Planner<SpaceKnowledge> for Timed<'_> {
    fn name(&self) -> &'static str {
        self.inner.name()
    }

    fn next(
        &mut self,
        situation: &Situation<'_, SpaceKnowledge>,
    ) -> Result<Proposal<SpaceKnowledge>, PlanError> {
        let start = Instant::now();
        let proposal = self.inner.next(situation);
        self.seconds += start.elapsed().as_secs_f64();
        proposal
    }
}

/// One run on a body with exact touches.
///
/// # Errors
/// Those of the exploration.
pub fn run(
    make: fn(u64) -> Box<AnyPlanner>,
    family: Family,
    seed: u64,
    goal: Goal<Direction>,
    most: usize,
) -> Result<Trace, ExploreError> {
    let mut known = SpaceKnowledge::exact();
    let mut finger = SimulatedFinger::new(solid(family, seed), Motion::Plane);
    let mut inner = make(seed);
    let mut planner = Timed { inner: &mut *inner, seconds: 0.0 };
    let (mut progress, mut way, mut sum) = (Vec::new(), Vec::new(), 0.0);
    explore(&mut known, &mut planner, &mut finger, &Task::new(goal, most), |step, _| {
        sum += step.turned;
        progress.push(step.progress);
        way.push(sum);
    })?;
    Ok(Trace { family, progress, way, seconds: planner.seconds })
}

/// The runs of a planner on all bodies (of a part of a study: of some), to a gap.
///
/// # Errors
/// The first error of a run.
pub fn runs(
    planner: &Named<AnyPlanner>,
    bodies: Bodies,
    gap: f64,
    most: usize,
) -> Result<Vec<Trace>, Box<dyn std::error::Error + Send + Sync>> {
    let all: Vec<_> = bodies.all().collect();
    rows_in_threads(&all, |(family, seed)| Ok(run(planner.make, *family, *seed, Goal::Gap(gap), most)?))
}

/// Mean width of a body in m.
#[must_use]
pub fn mean_width(body: &Solid) -> f64 {
    let lattice = Direction::spread(2000);
    2.0 * lattice.iter().map(|u| body(*u).dot(u.get())).sum::<f64>() / lattice.len() as f64
}

/// What a run under noise came to.
#[derive(Clone, Copy, Debug)]
pub struct Certified {
    /// Touches, if the goal was proven.
    pub touches: Option<usize>,
    /// Whether the body lies between the bounds.
    pub holds: bool,
    /// Whether the gap that is stated is no less than that of exact contacts at the same places.
    pub bounds_gap: bool,
}

/// One run under noise: points off by `level` of the mean width per axis, normals by twice `level` rad.
///
/// # Errors
/// Those of the exploration.
pub fn certified_run(
    family: Family,
    seed: u64,
    noise_seed: u64,
    level: f64,
    goal: f64,
    spending: Spending,
) -> Result<Certified, ExploreError> {
    let body = solid(family, seed);
    let point = level * mean_width(&body);
    let normal = 2.0 * level;
    let confidence = Confidence::new(0.95, spending)
        .map_err(|reason| ExploreError::Knowledge(exploration::KnowledgeError::Confidence(reason)))?;
    let mut known = SpaceKnowledge::noisy(Noise { point, normal, confidence });
    let mut finger =
        SimulatedFinger::new(solid(family, seed), Motion::Plane).with_noise(point, normal, noise_seed);
    let mut planner = PathAware::new(turned_tetrahedron(noise_seed));
    let task = Task { spending: Some(spending), ..Task::new(Goal::Gap(goal), 400) };
    let mut exact = Vec::new();
    let ended = explore(&mut known, &mut planner, &mut finger, &task, |step, _| {
        let along = step.proposal.along;
        exact.push(ContactSample { point: body(along), normal: along });
    })?;
    let proven = ended.certificate().proven;
    let touches = matches!(ended, Outcome::Reached(_)).then_some(known.touches());
    let true_gap =
        ShapeBounds::from_contacts(&exact).map_or(1.0, |b| 1.0 - b.lower_volume() / b.upper_volume());
    let holds = known.bounds().is_none_or(|bounds| between(&body, bounds));
    Ok(Certified { touches, holds, bounds_gap: proven >= true_gap - 1e-12 })
}

/// Whether the body holds every corner of the lower bound and no half-space of the upper one cuts it: exact, but for rounding.
fn between(body: &Solid, bounds: &ShapeBounds) -> bool {
    let support = |d: DVec3| Direction::new(d).map_or(DVec3::ZERO, body);
    let corners = bounds.lower().solid().map_or(&[][..], |s| s.vertices());
    let inside = corners.iter().all(|v| nearest(*v, &[], support).certified <= 1e-12);
    let cuts_nothing = |h: &recon::shape_bounds::exact_hull::HalfSpace| h.excess(body(h.normal)) <= 1e-12;
    inside && bounds.upper().bounded().is_none_or(|upper| upper.face_half_spaces().iter().all(cuts_nothing))
}

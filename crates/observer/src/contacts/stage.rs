//! A motion on its way from a search to what is reported: one stage after the other replaces it by a better one.

use super::any_axes::with_any_axes;
use super::axes::{Oriented, against_by_cost, known_motion};
use super::beginning::Beginning;
use super::body::CONSTANTS;
use super::directly::directly;
use super::explanations::FreeBody;
use super::levers::errors_of_levers;
use super::onward::resumed;
use super::plane;
use super::problem::{Beforehand, Problem};
use super::record::Record;
use super::redrawn::DRAWS;
use super::rivals::{Decided, Rival, SEARCHES, as_probable, decided, others_of_any_axes, well_known};
use super::search::{ENOUGH, Ended, fine, finest_nodes, refined, search};
use super::sharp::{blunted, sharpened, sharpest, stated};
use super::solve::{Covariances, Solved};
use super::state::Tangent;
use super::verdict::is_explained;
use crate::reliability::{LARGEST_MISFIT, Reason};
use glam::DQuat;
use object_dynamics::MassProperties;

/// How often a motion is carried over all samples for what is missed, at most, and what is a change of that, as a share of what conditions are off by.
const ROUNDS: usize = 4;
const NO_MORE: f64 = 1e-5;
/// How many of the motions that are as good for an unknown body are looked at for a known one.
const FOLLOWED: usize = 3;
/// How much dearer the log may be with a known body than without, in units of chi-squared: with the right motion one in two thousand is by more.
const DEARER: f64 = 20.0;
/// The same where an unknown body had several motions as probable, of which the right one may be none: one in twenty is by more.
const DEARER_OF_SEVERAL: f64 = 9.5;

/// A solution, and what is known of it so far.
pub(super) struct Stage<'a> {
    pub(super) problem: Problem<'a>,
    pub(super) solved: Solved<CONSTANTS>,
    /// Of this solution, where a stage has made them.
    covariances: Option<Covariances<CONSTANTS>>,
    /// Whether the search was for nothing better.
    found: bool,
    /// Linearisations before the last solution.
    pub(super) before: usize,
    /// How far the axes of a known body may be from where they were found, rad, if it is known.
    pub(super) doubt: Option<f64>,
    /// Of a known body whose axes the log does not tell, how they would lie: the motion is then one of a body whose axes lie in any way.
    pub(super) untold: Option<DQuat>,
    /// Why a known body is not the one.
    pub(super) against: Option<Reason>,
    /// The solution without it, where it is not.
    pub(super) free: Option<FreeBody>,
    /// Motions of an unknown body that are as good.
    others: Vec<Rival>,
    /// What else the readings leave open.
    pub(super) open: Option<Reason>,
}

/// What was found without knowing a body that is not the one; `problem` may know it.
fn free_body(problem: &Problem, unknown: &Solved<CONSTANTS>, against: Option<Reason>) -> Option<FreeBody> {
    let Some(Reason::OtherBody { mass, squares, .. }) = against else { return None };
    let covariance = unknown.equations.covariance_of_body(&problem.natural_information())?;
    // Of a body in the plane mass and moment of inertia.
    let departures = if problem.planar { 2 } else { 4 };
    let each = (squares / f64::from(departures)).sqrt();
    let deviation = |i: u8| covariance[(usize::from(i), usize::from(i))].max(0.0).sqrt();
    let departures = (0..departures).map(|i| (each * deviation(i), deviation(i))).collect();
    Some(FreeBody { cost: unknown.equations.cost, mass: mass - 1.0, departures })
}

/// Why the motion of a known body is not to be believed, by how much dearer it makes the log than that of an unknown one, of which there were others as
/// probable where `open` says so.
fn too_dear(
    problem: &Problem,
    known: &Oriented,
    unknown: &Solved<CONSTANTS>,
    mass: &MassProperties,
    open: Option<Reason>,
) -> [Option<Reason>; 2] {
    let dearer = known.solved.equations.cost - unknown.equations.cost;
    let other = || against_by_cost(problem, unknown, mass, dearer);
    [if dearer > DEARER { other() } else { None }, open.filter(|_| dearer > DEARER_OF_SEVERAL)]
}

/// Replaces the motion of a known body by a more probable one that others lead to, each with what was known of the body in it; those that are less
/// probable go to `others`. Gives the linearisations.
fn followed(
    problem: &mut Problem,
    known: &mut Oriented,
    others: &mut Vec<Solved<CONSTANTS>>,
    rivals: Vec<(Rival, Beforehand)>,
    mass: &MassProperties,
) -> usize {
    let mut iterations = 0;
    for ((rival, frozen), body) in rivals.into_iter().take(FOLLOWED) {
        let of_known = (problem.body, std::mem::replace(&mut problem.frozen, frozen));
        problem.body = body;
        let other = known_motion(problem, &rival, mass);
        iterations += other.as_ref().map_or(0, |other| other.iterations);
        // One that is as good is the same, and what was found first is judged by the more probable motion of an unknown body.
        let better = |other: &Oriented| other.solved.equations.cost < known.solved.equations.cost - ENOUGH[0];
        match other {
            Some(other) if better(&other) => others.push(std::mem::replace(known, other).solved),
            other => {
                (problem.body, problem.frozen) = of_known;
                others.extend(other.map(|other| other.solved));
            }
        }
    }
    iterations
}

/// Each of the stages gives none where the equations are singular.
impl<'a> Stage<'a> {
    /// What a search comes to.
    pub(super) fn searched(mut problem: Problem<'a>) -> Option<Self> {
        let ended = search(&mut problem)?;
        Some(Self::at(problem, ended))
    }

    /// What a motion at the first samples is carried on to.
    pub(super) fn resumed(mut problem: Problem<'a>, from: &Beginning) -> Option<Self> {
        let ended = resumed(&mut problem, from)?;
        Some(Self::at(problem, ended))
    }

    /// Of which nothing else is known.
    pub(super) fn at(problem: Problem<'a>, Ended { solved, found, before, .. }: Ended) -> Self {
        let (covariances, others, doubt, untold, against, free, open) =
            (None, Vec::new(), None, None, None, None, None);
        Self { problem, solved, covariances, found, before, doubt, untold, against, free, others, open }
    }

    pub(super) fn replaced(
        mut self,
        solved: impl FnOnce(&mut Problem, Solved<CONSTANTS>) -> Option<Solved<CONSTANTS>>,
    ) -> Option<Self> {
        let before = self.solved.iterations;
        self.solved = solved(&mut self.problem, self.solved)?;
        self.before += before;
        self.covariances = None;
        Some(self)
    }

    /// Whether noise is all that is left of a solution in space without friction: others may be as probable.
    pub(super) fn is_in_noise(&self) -> bool {
        let Problem { exact, planar, record, .. } = &self.problem;
        !exact && !planar && record.frictionless() && self.solved.explained()
    }

    /// Makes room for another solution; gives what the readings left open with this one.
    fn supersede(&mut self) -> Option<Reason> {
        self.before += self.solved.iterations;
        self.covariances = None;
        self.open.take()
    }

    /// The most probable of the motions that are found.
    pub(super) fn decided(mut self) -> Option<Self> {
        self.before += self.solved.iterations;
        let Decided { solved, covariances, others, open } = decided(&mut self.problem, self.solved)?;
        (self.solved, self.covariances, self.others, self.open) = (solved, covariances, others, open);
        Some(self)
    }

    /// With conditions that are off as well by what is not known of the spin.
    pub(super) fn blurred(self) -> Option<Self> {
        self.replaced(plane::blurred)
    }

    /// With conditions as bad as all that is left of them.
    pub(super) fn blunted(self) -> Option<Self> {
        self.replaced(blunted)
    }

    /// To the end, where it was given up.
    pub(super) fn finished(mut self) -> Option<Self> {
        self.problem.patient = true;
        if self.solved.settled {
            Some(self)
        } else {
            self.replaced(|problem, solved| fine(problem, solved.unknowns))
        }
    }

    /// With conditions off by what was stated or guessed.
    pub(super) fn stated(self) -> Option<Self> {
        if self.problem.noise.floor == self.problem.floor { Some(self) } else { self.replaced(stated) }
    }

    /// That of a body whose mass properties are known.
    pub(super) fn of_known(mut self, mass: &MassProperties) -> Option<Self> {
        if self.problem.planar {
            self.supersede();
            let problem = &mut self.problem;
            let (solved, against) = plane::known_motion(problem, &self.solved, mass)?;
            self.free = free_body(problem, &self.solved, against);
            (self.solved, self.against, self.doubt) = (solved, against, Some(0.0));
            return Some(self);
        }
        let short = (self.problem.is_smooth() && !self.found).then(|| directly(&mut self.problem, mass));
        if let Some(ended) = short.flatten() {
            self.supersede();
            self.before += ended.before;
            (self.solved, self.doubt) = (ended.solved, Some(0.0));
            return Some(self);
        }
        let mut certain = self.of_certain_axes(mass)?;
        if let Some((solved, own)) = with_any_axes(&mut certain.problem, &certain.solved, mass) {
            certain.before += certain.solved.iterations;
            (certain.solved, certain.untold) = (solved, Some(own));
        }
        Some(certain)
    }

    /// The same of a body in space whose axes lie in one way, whether or not the log tells which.
    pub(super) fn of_certain_axes(mut self, mass: &MassProperties) -> Option<Self> {
        let several = self.supersede();
        let settled = !self.is_in_noise() || well_known(&self.problem, &self.solved);
        let problem = &mut self.problem;
        let free = (problem.body, problem.frozen.clone());
        let mut known = known_motion(problem, &self.solved, mass)?;
        self.before += known.iterations - known.solved.iterations;
        let mut others = Vec::new();
        // What was as good for an unknown body need not be for this one.
        let rivals = self.others.drain(..).map(|rival| (rival, free.0)).collect();
        self.before += followed(problem, &mut known, &mut others, rivals, mass);
        for _ in 0..if settled { 0 } else { SEARCHES } {
            let before = known.solved.equations.cost;
            let of_known = (problem.body, problem.frozen.clone());
            let rivals = others_of_any_axes(problem, &known.solved, mass).unwrap_or_default();
            let any = problem.body;
            (problem.body, problem.frozen) = of_known;
            let rivals = rivals.into_iter().map(|rival| (rival, any)).collect();
            self.before += followed(problem, &mut known, &mut others, rivals, mass);
            if known.solved.equations.cost > before - ENOUGH[0] {
                break;
            }
            // It is by the unknown body that a known one is judged, and not by one of any axes.
            known.against = None;
        }
        let open = others.iter().find_map(|other| as_probable(problem, &known.solved, other));
        self.open = self.open.or(open);
        let [other, several] = too_dear(problem, &known, &self.solved, mass, several);
        known.against = known.against.or(other);
        self.open = self.open.or(known.open).or(several);
        (self.doubt, self.against) = (Some(known.doubt), known.against);
        self.free = free_body(problem, &self.solved, known.against);
        self.solved = known.solved;
        Some(self)
    }

    /// With what steps from sample to sample miss of the motion over those of `all` in between.
    pub(super) fn over(mut self, all: &Record) -> Option<Self> {
        let natural = self.problem.natural_information();
        for _ in 0..ROUNDS {
            let missed = self.problem.missed_of(all, &self.solved.unknowns);
            let change = |(k, now): (usize, &Tangent)| {
                let change = now - self.problem.missed.get(k).copied().unwrap_or_default();
                change.component_mul(&change).dot(&natural)
            };
            let most = missed.iter().enumerate().map(change).fold(0.0, f64::max).sqrt();
            if most < NO_MORE * self.problem.noise.floor / self.problem.units.speed {
                break;
            }
            self.problem.missed = missed;
            self = self.replaced(|problem, solved| sharpest(problem, solved.unknowns))?;
        }
        Some(self)
    }

    /// On a record of which another one was solved that has fewer of its samples, or fewer nodes.
    pub(super) fn on_all<'b>(self, record: &'b Record, sharp: bool) -> Option<Stage<'b>> {
        let place = |sample: &usize| record.samples.partition_point(|own| own < sample);
        let nodes: Vec<usize> = self.problem.node_samples().iter().map(place).collect();
        let mut problem = self.problem.on(record);
        problem.blurred.clear();
        if !sharp {
            problem.frozen.clear();
        }
        let floor = std::mem::replace(&mut problem.noise.floor, problem.floor);
        problem.nodes = finest_nodes(&problem);
        problem.noise.floor = floor;
        let start = refined(&problem, &nodes, &self.solved.unknowns);
        let before = self.before + self.solved.iterations;
        let solved = if sharp { sharpest(&mut problem, start) } else { fine(&mut problem, start) }?;
        let Self { found, doubt, untold, against, free, open, .. } = self;
        Some(Stage {
            doubt,
            untold,
            against,
            free,
            open,
            ..Stage::at(problem, Ended { solved, found, before, agreed: false })
        })
    }

    /// With conditions as good, or as bad, as what is left of them.
    pub(super) fn sharpened(mut self) -> Option<Self> {
        if self.solved.misfit() >= LARGEST_MISFIT {
            return Some(self);
        }
        let before = self.solved.iterations;
        let (solved, covariances) = sharpened(&mut self.problem, self.solved)?;
        self.before += before;
        (self.solved, self.covariances) = (solved, Some(covariances));
        Some(self)
    }

    /// As a linear model has them.
    pub(super) fn covariances(&mut self) -> Option<Covariances<CONSTANTS>> {
        self.covariances.take().or_else(|| self.solved.covariances(&self.problem))
    }

    /// With what is beyond a linear model, of what is not refused anyway.
    pub(super) fn widened(&self, linear: Covariances<CONSTANTS>) -> Covariances<CONSTANTS> {
        let refused = self.open.is_some()
            || self.against.is_some()
            || !self.solved.settled
            || !is_explained(self.solved.misfit(), self.solved.equations.conditions);
        if refused {
            return linear;
        }
        // In the plane a lever is adjusted along the one direction that it has.
        if self.problem.planar {
            return linear.reaching(&self.problem, &self.solved);
        }
        let widened = linear.redrawn(&self.problem, &self.solved, DRAWS);
        widened.with_errors(errors_of_levers(&self.problem, &self.solved))
    }
}

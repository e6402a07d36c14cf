//! Least squares over all nodes: links, contact conditions and what is known beforehand, linearised.

use super::body::{Body, CONSTANTS};
use super::chain::SHARED;
use super::ends::Held;
use super::equations::{Equations, LinkEquation, Room, Row, Split};
use super::feet::{Foot, Share, Told, at_end};
use super::first::First;
use super::flow::{Carried, Transition};
use super::noise::{ContactNoiseLevel, WrenchNoise};
use super::plane;
use super::record::{Contact, Record, Wrench};
use super::rows::Rows;
use super::solve::Solved;
use super::state::{Motion, Tangent, Turn, tangent};
use contact_kinematics::{at_once, is_stopped};
use glam::DVec3;
use nalgebra::{SMatrix, SVector};
use std::borrow::Cow;
use std::ops::Range;

/// Links are never taken for better than this share of a condition's deviation, all together: without noise of the forces the
/// chain would be rigid, and the equations singular in double precision. It adds a thousandth to the variance of a velocity where noise is what
/// conditions are off by; elsewhere links are no better than conditions.
const LINK_FLOOR: f64 = 0.03;

/// Information that keeps a combination of the body's constants, where the conditions claim to have one.
pub(super) const FROZEN: f64 = 1e4;

/// Natural units of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    pub(super) length: f64,
    pub(super) speed: f64,
    pub(super) mass: f64,
}

impl Units {
    /// The natural time, s.
    pub(super) fn time(&self) -> f64 {
        self.length / self.speed
    }
}

/// What is known of a body beforehand: its constants, and the information of these.
pub(super) type Beforehand = (Body, SMatrix<f64, CONSTANTS, CONSTANTS>);

/// What is to be solved: a record cut into links at `nodes`.
#[derive(Debug)]
pub(super) struct Problem<'a> {
    pub(super) record: &'a Record,
    /// Noise; its floor is that of the moment.
    pub(super) noise: ContactNoiseLevel,
    /// The floor of the noise as it was stated or guessed, m/s.
    pub(super) floor: f64,
    /// Whether noise of the contacts is not what conditions are off by.
    pub(super) exact: bool,
    /// Whether the direction of friction tells that of a slip.
    pub(super) friction: bool,
    pub(super) gravity: DVec3,
    /// Samples at which there is a node, in order; the first and the last of the record among them.
    pub(super) nodes: Vec<usize>,
    pub(super) units: Units,
    /// What is known of the first motion.
    pub(super) first: First,
    /// What is known of the body beforehand: values and information.
    pub(super) body: Beforehand,
    /// Combinations of the body's constants that keep their value from beforehand.
    pub(super) frozen: Vec<SVector<f64, CONSTANTS>>,
    /// Whether all motion is in the plane of x and z.
    pub(super) planar: bool,
    /// Whether the error of a contact is one in its condition and in the moments of its impulses; a search takes it for two, as from a motion that is not
    /// the right one conditions tell none; so it is in space, as what noise says of an inertia is counted for such links.
    pub(super) shares: bool,
    /// Whether a solution that hardly gets on is worth going on with: not one of the many that are tried.
    pub(super) patient: bool,
    /// What a step over each interval misses of the motion, where that is known: else none of it.
    pub(super) missed: Vec<Tangent>,
    /// A spin in the plane that is held to see what that costs.
    pub(super) held: Option<Held>,
    /// What the conditions of each sample are off by beside noise, since the spin is not known that they are taken with, m/s; else nothing.
    pub(super) blurred: Vec<f64>,
}

/// Unknowns: the motions at the nodes and the body's constants.
#[derive(Clone, Debug)]
pub(super) struct Unknowns {
    pub(super) motions: Vec<Motion>,
    pub(super) body: Body,
}

impl Unknowns {
    /// The same motion of another body.
    pub(super) fn with(&self, body: Body) -> Self {
        let one = |motion: &Motion| {
            let turn = self.body.turn(motion.q, motion.L);
            Motion { L: body.inertia_along(turn.R) * turn.w, ..*motion }
        };
        Self { motions: self.motions.iter().map(one).collect(), body }
    }
}

impl Problem<'_> {
    /// The same on another record.
    pub(super) fn on<'b>(&self, record: &'b Record) -> Problem<'b> {
        let Self {
            noise, floor, exact, friction, gravity, units, first, body, planar, shares, patient, ..
        } = *self;
        let (nodes, frozen) = (self.nodes.clone(), self.frozen.clone());
        let blurred = self.blurred.clone();
        Problem {
            record,
            noise,
            floor,
            exact,
            friction,
            gravity,
            nodes,
            units,
            first,
            body,
            frozen,
            planar,
            shares,
            patient,
            missed: Vec::new(),
            held: None,
            blurred,
        }
    }

    fn wrenches(&self, k: usize) -> [&Wrench; 2] {
        [&self.record.wrenches[k], &self.record.wrenches[k + 1]]
    }

    /// None where the unknowns are beyond all numbers.
    pub(super) fn linearise<const P: usize>(&self, at: &Unknowns) -> Option<Equations<P>> {
        self.linearise_in(at, &mut Room::default())
    }

    /// The same in memory that is there; of many nodes one half on a thread of its own.
    pub(super) fn linearise_in<const P: usize>(
        &self,
        at: &Unknowns,
        room: &mut Room<P>,
    ) -> Option<Equations<P>> {
        if is_stopped() {
            return None;
        }
        let count = self.nodes.len();
        let [whole, half] = room.taken(count);
        if count < SHARED {
            self.linearise_some(at, 0..count, whole)?;
        } else {
            let middle = count / 2;
            let (first, second) = at_once(
                || self.linearise_some(at, 0..middle, whole),
                || self.linearise_some(at, middle..count, half),
            );
            first.and(second)?;
            whole.take_on(half);
        }
        self.add_prior(at, whole);
        let all = std::mem::take(whole);
        all.cost.is_finite().then_some(all)
    }

    /// Conditions and links of some nodes, with what the last of the links says of the node after it, which then is the last one.
    pub(super) fn linearised<const P: usize>(
        &self,
        at: &Unknowns,
        some: Range<usize>,
    ) -> Option<Equations<P>> {
        let mut all = Equations::default();
        self.linearise_some(at, some, &mut all)?;
        Some(all)
    }

    /// The same in place of what was in `all`.
    fn linearise_some<const P: usize>(
        &self,
        at: &Unknowns,
        some: Range<usize>,
        all: &mut Equations<P>,
    ) -> Option<()> {
        let count = (some.end + 1).min(self.nodes.len()) - some.start;
        all.cleared(count);
        for (i, j) in some.enumerate() {
            let mut carried = Carried::<P>::new(at.motions[j], &at.body);
            let from = self.nodes[j];
            let end = self.nodes.get(j + 1).copied().unwrap_or(from);
            if end != from + 1 {
                self.rows(from, &carried.motion, &carried.turn, &at.body, |row, _, _| all.add(i, &row));
            }
            let mut noise = WrenchNoise::default();
            for k in from..end {
                self.advance(&mut carried, k, &at.body);
                noise += self.record.intervals[k].noise;
                if k + 1 < end {
                    self.rows(k + 1, &carried.motion, &carried.turn, &at.body, |row, _, _| {
                        all.add(i, &carried.at_node(&row));
                    });
                }
            }
            let mut feet = Vec::new();
            if end == from + 1 {
                self.add_split((i, j), &carried, at, all, &mut feet);
            }
            if end > from {
                all.add_link(i, self.linked(&noise, &carried, at, j, feet)?);
            }
        }
        Some(())
    }

    /// The samples at which there are nodes, by their numbers in the log.
    pub(super) fn node_samples(&self) -> Vec<usize> {
        self.nodes.iter().map(|&k| self.record.samples[k]).collect()
    }

    /// Motions at some samples by what was measured since sample `from`, with a motion there.
    pub(super) fn carried(&self, from: usize, motion: Motion, body: &Body, samples: &[usize]) -> Vec<Motion> {
        let mut carried = Carried::<0>::new(motion, body);
        let mut at = from;
        let mut to = |k: usize| {
            while at < k {
                self.step(&mut carried, at, body);
                at += 1;
            }
            carried.motion
        };
        samples.iter().map(|&k| to(k)).collect()
    }

    /// How many natural times the record lasts.
    pub(super) fn lasts(&self) -> f64 {
        let times = &self.record.times;
        (times[times.len() - 1] - times[0]) / self.units.time()
    }

    /// One over the squares of the natural units of a motion's numbers.
    pub(super) fn natural_information(&self) -> Tangent {
        let Units { length, speed, mass } = self.units;
        let natural = [length, speed, mass * length * speed, 1.0];
        Tangent::from_fn(|i, _| natural[i / 3].powi(-2))
    }

    /// Information of a contact condition in natural units, of a body that turns at the natural rate.
    pub(super) fn condition_information(&self) -> f64 {
        (self.units.speed / self.condition_deviation()).powi(2)
    }

    /// Its deviation, m/s.
    pub(super) fn condition_deviation(&self) -> f64 {
        let Units { length, speed, .. } = self.units;
        self.noise.floor.max(self.noise.contact * speed / length)
    }

    /// Of the conditions of a sample.
    pub(super) fn noise_at(&self, k: usize) -> ContactNoiseLevel {
        let blurred = self.blurred.get(k).copied().unwrap_or(0.0);
        ContactNoiseLevel { floor: self.noise.floor.hypot(blurred), ..self.noise }
    }

    /// The conditions of a sample at a motion there, each in its deviation, with their contact and how far it is by that from where it was read.
    pub(super) fn rows<const P: usize>(
        &self,
        k: usize,
        motion: &Motion,
        turn: &Turn,
        body: &Body,
        mut visit: impl FnMut(Row<P>, &Contact, DVec3),
    ) {
        let contacts = &self.record.contacts[k];
        if contacts.is_empty() {
            return;
        }
        let changes = if P > 0 { body.by_inertia(turn) } else { Default::default() };
        let noise = self.noise_at(k);
        for contact in contacts {
            let Some(rows) = Rows::new(contact, motion, turn, &noise, self.friction) else { continue };
            let whitened = rows.whitened(motion, turn, &changes).zip(rows.feet());
            whitened.for_each(|(row, (foot, _))| visit(row, contact, foot));
        }
    }

    /// Carries a motion with its derivatives over the interval after sample `k`.
    pub(super) fn advance<const P: usize>(&self, carried: &mut Carried<P>, k: usize, body: &Body) {
        carried.advance(&self.record.intervals[k], self.wrenches(k), body, self.gravity);
        self.missed.get(k).into_iter().for_each(|missed| carried.shift(missed, body));
    }

    /// The motion alone.
    pub(super) fn step<const P: usize>(&self, carried: &mut Carried<P>, k: usize, body: &Body) {
        carried.step(&self.record.intervals[k], self.wrenches(k), body, self.gravity);
        self.missed.get(k).into_iter().for_each(|missed| carried.shift(missed, body));
    }

    /// What steps over the intervals miss of the motion as it is carried over each of the samples of `all`, that of the record among them.
    pub(super) fn missed_of(&self, all: &Record, at: &Unknowns) -> Vec<Tangent> {
        let place = |k: usize| all.samples.partition_point(|&own| own < self.record.samples[k]);
        let mut missed = Vec::with_capacity(self.record.intervals.len());
        for (j, pair) in self.nodes.windows(2).enumerate() {
            let mut carried = Carried::<0>::new(at.motions[j], &at.body);
            for k in pair[0]..pair[1] {
                let mut whole = carried;
                whole.step(&self.record.intervals[k], self.wrenches(k), &at.body, self.gravity);
                for i in place(k)..place(k + 1) {
                    let ends = [&all.wrenches[i], &all.wrenches[i + 1]];
                    carried.step(&all.intervals[i], ends, &at.body, self.gravity);
                }
                missed.push(carried.motion.from(&whole.motion));
            }
        }
        missed
    }

    /// Conditions of node `j`, number `i` of the equations, with a link of one interval after it; those that tell of contacts by whose moments it is off
    /// go to `feet`.
    fn add_split<const P: usize>(
        &self,
        (i, j): (usize, usize),
        carried: &Carried<P>,
        at: &Unknowns,
        all: &mut Equations<P>,
        feet: &mut Vec<Foot<P>>,
    ) {
        let motion = self.split(j, carried, at);
        let turn = at.body.turn(motion.q, motion.L);
        let mut tell = |row: Split<P>, value: f64, moment: Share| {
            if moment.moment != DVec3::ZERO {
                let by = at_end(moment.moment, carried.after, &carried.turn);
                feet.push(Foot { row, value, moment, by });
            }
        };
        self.rows(self.nodes[j], &motion, &turn, &at.body, |row, contact, foot| {
            let (own, after) = self.split_row(j, carried, &row);
            all.add_split(i, &own, &after);
            let by = contact.share(foot, self.shared(contact, |contact| contact.J_after));
            tell(Split { own: own.tangent(), next: tangent(&after), body: own.by_body }, own.value, by);
        });
        self.feet_after(self.nodes[j + 1], &at.motions[j + 1], &at.body, |row: Row<P>, by| {
            let split = Split { own: Tangent::zeros(), next: row.tangent(), body: row.by_body };
            tell(split, row.value, by);
        });
    }

    /// The link after node `j`. None where its noise has no inverse.
    fn linked<const P: usize>(
        &self,
        noise: &WrenchNoise,
        carried: &Carried<P>,
        at: &Unknowns,
        j: usize,
        feet: Vec<Foot<P>>,
    ) -> Option<LinkEquation<P>> {
        let mut told = Told::default();
        feet.iter().for_each(|foot| told.add(&foot.moment, foot.value));
        let noise = self.link_noise(noise, (carried.motion.p, carried.after), &told)?;
        let residual = at.motions[j + 1].from(&carried.motion);
        Some(LinkEquation {
            residual,
            left: residual - told.at_end(carried.after, &carried.turn),
            carried: *carried,
            information: noise.information(&at.body, &carried.turn),
            adjusted: carried.adjusted(&at.body, &residual),
            feet,
        })
    }

    pub(super) fn add_prior<const P: usize>(&self, at: &Unknowns, all: &mut Equations<P>) {
        all.cost += self.prior_cost::<P>(at);
        self.first.add(&at.motions[0], &at.body, self.record.origin, all);
        self.held.iter().for_each(|held| held.add(at, all));
        if self.planar {
            let held = plane::held().component_mul(&self.natural_information());
            all.nodes.iter_mut().for_each(|node| node.own += Transition::from_diagonal(&held));
        }
        if P > 0 {
            let (known, slope) = (self.body_information(), at.body.slope_from(&self.body.0));
            all.body += (slope.transpose() * known * slope).fixed_view::<P, P>(0, 0);
            all.body_gradient += (slope.transpose() * known * at.body.from(&self.body.0)).fixed_rows::<P>(0);
        }
    }

    /// Equations without what keeps the frozen combinations.
    pub(super) fn unfrozen<'e>(
        &self,
        equations: &'e Equations<CONSTANTS>,
        at: &Unknowns,
    ) -> Cow<'e, Equations<CONSTANTS>> {
        if self.frozen.is_empty() {
            return Cow::Borrowed(equations);
        }
        let mut free = equations.clone();
        let (d, slope) = (at.body.from(&self.body.0), at.body.slope_from(&self.body.0));
        for combination in &self.frozen {
            let g = slope.transpose() * combination;
            free.body -= g * g.transpose() * FROZEN;
            free.body_gradient -= g * (FROZEN * combination.dot(&d));
        }
        Cow::Owned(free)
    }

    /// With what keeps the frozen combinations.
    fn body_information(&self) -> SMatrix<f64, CONSTANTS, CONSTANTS> {
        self.frozen.iter().fold(self.body.1, |all, g| all + g * g.transpose() * FROZEN)
    }

    /// Chi-squared of conditions and links of a solution, without that of what was known beforehand.
    pub(super) fn cost_of_log(&self, solved: &Solved<CONSTANTS>) -> f64 {
        (solved.equations.cost - self.prior_cost::<CONSTANTS>(&solved.unknowns)).max(0.0)
    }

    pub(super) fn prior_cost<const P: usize>(&self, at: &Unknowns) -> f64 {
        let held = self.held.map_or(0.0, |held| held.cost(at));
        let cost = held + self.first.cost(&at.motions[0], &at.body, self.record.origin);
        if P == 0 {
            return cost;
        }
        let d = at.body.from(&self.body.0);
        cost + (self.body_information() * d).dot(&d)
    }

    /// What links are never taken for better than, as a share of a condition's deviation, all together.
    fn link_floor(&self) -> f64 {
        if self.exact { 1.0 } else { LINK_FLOOR }
    }

    /// Noise with the moment about `p` in place of the origin, and a floor.
    pub(super) fn about(&self, noise: &WrenchNoise, p: DVec3) -> WrenchNoise {
        let mut moved = noise.about(p);
        let deviation = self.link_floor() * self.condition_deviation() / (self.nodes.len() as f64).sqrt();
        let floor = self.units.mass * deviation;
        for i in 0..6 {
            let unit = if i < 3 { 1.0 } else { self.units.length };
            moved.white[(i, i)] += (floor * unit).powi(2);
        }
        if self.planar {
            moved.white += plane::unfelt(&self.units);
        }
        moved
    }
}

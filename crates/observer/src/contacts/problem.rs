//! Least squares over all nodes: links, contact conditions and what is known beforehand, linearised.

use super::body::{Body, CONSTANTS};
use super::chain::SHARED;
use super::equations::{Equations, LinkEquation, Room, Row, Split};
use super::feet::{Foot, Share, Told, at_end};
use super::first::First;
use super::flow::{Carried, Transition};
use super::noise::{ContactNoiseLevel, WrenchNoise};
use super::plane;
use super::record::{Contact, Record, Wrench};
use super::rows::Rows;
use super::solve::{Solved, Step};
use super::state::{Motion, Tangent, Turn, parts, tangent};
use crate::rigid::exponential;
use contact_kinematics::{at_once, is_stopped};
use glam::{DQuat, DVec3};
use nalgebra::{SMatrix, SVector, Vector6};
use std::borrow::Cow;
use std::ops::Range;

/// Links are never taken for better than this share of a condition's deviation, all together: without noise of the forces the
/// chain would be rigid, and the equations singular in double precision. It adds a thousandth to the variance of a velocity where noise is what
/// conditions are off by; elsewhere links are no better than conditions.
const LINK_FLOOR: f64 = 0.03;

/// Information that keeps a combination of the body's constants, where the conditions claim to have one.
pub(super) const FROZEN: f64 = 1e4;

/// Natural times over which steps integrate the motion anew: a minute of a body of 0.1 m (700) settles with 1 to 20 of them, and not with all.
const STRETCH: f64 = 20.0;

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

/// Where a step leads.
pub(super) struct Trial {
    pub(super) unknowns: Unknowns,
    pub(super) cost: f64,
    /// What the residual of each link is beyond its linear prediction.
    pub(super) departures: Vec<Tangent>,
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

    /// The unknowns after a step, and their cost. None beyond all numbers.
    ///
    /// Positions and orientations follow from velocities with hardly any noise: over a stretch they are integrated anew, with what the step
    /// leaves of each link's defect. Moved one by one they would miss each other by the square of the step; integrated over many natural
    /// times they would be carried away by such squares.
    pub(super) fn trial<const P: usize>(
        &self,
        at: &Unknowns,
        step: &Step<P>,
        equations: &Equations<P>,
    ) -> Option<Trial> {
        if is_stopped() {
            return None;
        }
        let numbers = Vector6::from_fn(|i, _| if P > i + 1 { step.body[i + 1] } else { 0.0 });
        let after = if P > 0 { at.body.moved(step.body[0], &numbers) } else { at.body };
        let change = (P > 0).then_some(&numbers);
        let count = at.motions.len();
        let some = |nodes| self.trial_of_some(at, step, (change, &after), &equations.links, nodes);
        // Where a stretch begins nothing is carried on, but of a flight.
        let apart = |&j: &usize| self.begins_stretch(j) && !self.record.contacts[self.nodes[j]].is_empty();
        let middle = (count / 2..count).find(apart).filter(|_| count >= SHARED);
        let (motions, departures, mut cost) = match middle {
            None => some(0..count)?,
            Some(middle) => {
                let (first, rest) = at_once(|| some(0..middle), || some(middle..count));
                let ((mut motions, mut departures, cost), rest) = (first?, rest?);
                motions.extend(rest.0);
                departures.extend(rest.1);
                (motions, departures, cost + rest.2)
            }
        };
        let unknowns = Unknowns { motions, body: after };
        cost += self.prior_cost::<P>(&unknowns);
        cost.is_finite().then_some(Trial { unknowns, cost, departures })
    }

    /// Of some nodes, from one on at which nothing is carried on: the motions, what the residual of each link is beyond its linear prediction, and the cost.
    fn trial_of_some<const P: usize>(
        &self,
        at: &Unknowns,
        Step { motions: steps, body }: &Step<P>,
        (change, after): (Option<&Vector6<f64>>, &Body),
        links: &[LinkEquation<P>],
        nodes: Range<usize>,
    ) -> Option<(Vec<Motion>, Vec<Tangent>, f64)> {
        let mut motions: Vec<Motion> = Vec::with_capacity(nodes.len());
        let mut departures = Vec::with_capacity(nodes.len());
        let mut cost = 0.0;
        // Node `j` after its step, which leads to `p` and `q` and beyond them `by`.
        let place = |j: usize, p: DVec3, q: DQuat, by: &Tangent| {
            let [shift, _, _, turn] = parts(by);
            let to = (p + shift, (exponential(turn) * q).normalize());
            at.motions[j].moved(&steps[j], to, &at.body, change, after)
        };
        let first = nodes.start;
        let mut moved = place(first, at.motions[first].p, at.motions[first].q, &steps[first]);
        for j in nodes {
            motions.push(moved);
            let mut carried = Carried::<P>::new(moved, after);
            let end = self.nodes.get(j + 1).copied().unwrap_or(self.nodes[j] + 1);
            let split = end == self.nodes[j] + 1 && j + 1 < at.motions.len();
            let (mut noise, mut told) = (WrenchNoise::default(), Told::default());
            for k in self.nodes[j]..end {
                if !split {
                    let nothing = |_: &Contact| DVec3::ZERO;
                    cost += self.rows_cost(k, (&carried.motion, &carried.turn), nothing, &mut told);
                }
                if j + 1 < at.motions.len() {
                    self.step(&mut carried, k, after);
                    noise += self.record.intervals[k].noise;
                }
            }
            let Some(link) = links.get(j) else { break };
            let left = link.residual + steps[j + 1] - link.carried.along(&steps[j], body);
            let mut next = match at.motions[j + 1] {
                Motion { p, q, .. } if self.begins_stretch(j + 1) => place(j + 1, p, q, &steps[j + 1]),
                _ => place(j + 1, carried.motion.p, carried.motion.q, &left),
            };
            if self.record.contacts[end].is_empty() {
                // Of a flight the momenta are known best, and no condition is there to keep.
                let [_, velocity, momentum, _] = parts(&left);
                next.v = carried.motion.v + velocity;
                next.L = carried.motion.L + momentum;
            }
            let r = next.from(&carried.motion);
            departures.push(r - left);
            if split {
                let motion = moved.kicked(&r, self.share(j));
                let turn = after.turn(motion.q, motion.L);
                cost += self.rows_cost(self.nodes[j], (&motion, &turn), |contact| contact.J_after, &mut told);
                self.feet_after::<0>(end, &next, after, |row, by| told.add(&by, row.value));
            }
            let left = r - told.at_end(carried.after, &carried.turn);
            let noise = self.link_noise(&noise, (carried.motion.p, carried.after), &told)?;
            cost += noise.cost(&left, after, &carried.turn);
            moved = next;
        }
        Some((motions, departures, cost))
    }

    /// Whether a node is the first of a stretch of the log.
    fn begins_stretch(&self, j: usize) -> bool {
        let times = &self.record.times;
        let stretch = |j: usize| ((times[self.nodes[j]] - times[0]) / (STRETCH * self.units.time())).floor();
        j > 0 && stretch(j) > stretch(j - 1)
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

    fn prior_cost<const P: usize>(&self, at: &Unknowns) -> f64 {
        let cost = self.first.cost(&at.motions[0], &at.body, self.record.origin);
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

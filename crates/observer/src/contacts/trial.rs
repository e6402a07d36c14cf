//! Where a step of all unknowns leads, and what that costs.

use super::body::Body;
use super::chain::SHARED;
use super::equations::{Equations, LinkEquation};
use super::feet::Told;
use super::flow::Carried;
use super::noise::WrenchNoise;
use super::problem::{Problem, Unknowns};
use super::record::Contact;
use super::solve::Step;
use super::state::{Motion, Tangent, parts};
use crate::rigid::exponential;
use contact_kinematics::{at_once, is_stopped};
use glam::{DQuat, DVec3};
use nalgebra::Vector6;
use std::ops::Range;

/// Natural times over which steps integrate the motion anew: a minute of a body of 0.1 m (700) settles with 1 to 20 of them, and not with all.
const STRETCH: f64 = 20.0;

/// Where a step leads.
pub(super) struct Trial {
    pub(super) unknowns: Unknowns,
    pub(super) cost: f64,
    /// What the residual of each link is beyond its linear prediction.
    pub(super) departures: Vec<Tangent>,
}

impl Problem<'_> {
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
}

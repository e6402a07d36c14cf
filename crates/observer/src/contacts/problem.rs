//! Least squares over all nodes: links, contact conditions and what is known beforehand, linearised.

use super::flow::{Carried, Transition, link_information};
use super::noise::ContactNoiseLevel;
use super::record::{Record, Wrench};
use super::rows::Rows;
use super::solve::Step;
use super::state::{Body, MOTION, Motion, Tangent};
use crate::three_palms::{cross_matrix, exponential};
use glam::{DQuat, DVec3};
use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, Vector6};

/// Links are never taken for better than this share of a condition's floor, all together: without noise of the forces the
/// chain would be rigid, and the equations singular in double precision. It adds a thousandth to the variance of a velocity.
const LINK_FLOOR: f64 = 0.03;

/// Natural units of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    pub(super) length: f64,
    pub(super) speed: f64,
    pub(super) mass: f64,
}

/// What is to be solved: a record cut into links at `nodes`.
#[derive(Debug)]
pub(super) struct Problem<'a> {
    pub(super) record: &'a Record,
    pub(super) noise: ContactNoiseLevel,
    pub(super) gravity: DVec3,
    /// Samples at which there is a node, in order; the first and the last of the record among them.
    pub(super) nodes: Vec<usize>,
    pub(super) units: Units,
    /// What is known of the first motion: value and information of each number.
    pub(super) first: (Motion, Tangent),
    /// What is known of the body: value and information of each number.
    pub(super) body: (Body, SVector<f64, 7>),
}

/// Unknowns: the motions at the nodes and the body's constants.
#[derive(Clone, Debug)]
pub(super) struct Unknowns {
    pub(super) motions: Vec<Motion>,
    pub(super) body: Body,
}

/// Normal equations of one node.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeEquations<const P: usize> {
    pub(super) own: Transition,
    /// Block with the next node.
    pub(super) next: Transition,
    pub(super) body: SMatrix<f64, MOTION, P>,
    pub(super) gradient: Tangent,
}

/// Normal equations at some unknowns.
#[derive(Clone, Debug)]
pub(super) struct Equations<const P: usize> {
    pub(super) nodes: Vec<NodeEquations<P>>,
    pub(super) body: SMatrix<f64, P, P>,
    pub(super) body_gradient: SVector<f64, P>,
    pub(super) cost: f64,
    pub(super) conditions: usize,
    links: Vec<LinkEquation<P>>,
}

/// A link at some unknowns.
#[derive(Clone, Copy, Debug)]
struct LinkEquation<const P: usize> {
    residual: Tangent,
    by_motion: Transition,
    by_body: SMatrix<f64, MOTION, P>,
}

impl Problem<'_> {
    fn wrenches(&self, k: usize) -> [&Wrench; 2] {
        [&self.record.wrenches[k], &self.record.wrenches[k + 1]]
    }

    /// None where the unknowns are beyond all numbers.
    pub(super) fn linearise<const P: usize>(&self, at: &Unknowns) -> Option<Equations<P>> {
        let zero = NodeEquations {
            own: Transition::zeros(),
            next: Transition::zeros(),
            body: SMatrix::zeros(),
            gradient: Tangent::zeros(),
        };
        let count = self.nodes.len();
        let mut all = Equations {
            nodes: vec![zero; count],
            body: SMatrix::zeros(),
            body_gradient: SVector::zeros(),
            cost: 0.0,
            conditions: 0,
            links: Vec::with_capacity(count),
        };
        for j in 0..count {
            let mut carried = Carried::<P>::new(at.motions[j], &at.body);
            self.add_rows(j, self.nodes[j], &carried, at, &mut all)?;
            let Some(&end) = self.nodes.get(j + 1) else { break };
            let mut noise = Matrix6::zeros();
            for k in self.nodes[j]..end {
                let interval = &self.record.intervals[k];
                carried.advance(interval, self.wrenches(k), &at.body, self.gravity);
                noise += interval.noise;
                if k + 1 < end {
                    self.add_rows(j, k + 1, &carried, at, &mut all)?;
                }
            }
            let information = self.link_information(&noise, &carried, &at.body)?;
            self.add_link(j, &carried, &information, at, &mut all);
        }
        self.add_prior(at, &mut all);
        all.cost.is_finite().then_some(all)
    }

    /// The unknowns after a step, and their cost.
    ///
    /// Positions and orientations follow from velocities with hardly any noise: they are integrated anew, with what the step
    /// leaves of each link's defect. Moved one by one they would miss each other by the square of the step.
    pub(super) fn trial<const P: usize>(
        &self,
        at: &Unknowns,
        step: &Step<P>,
        equations: &Equations<P>,
    ) -> Option<(Unknowns, f64)> {
        let Step { motions: steps, body } = step;
        let numbers = Vector6::from_fn(|i, _| if P > i + 1 { body[i + 1] } else { 0.0 });
        let after = if P > 0 { at.body.moved(body[0], &numbers) } else { at.body };
        let change = (P > 0).then_some(&numbers);
        let mut motions: Vec<Motion> = Vec::with_capacity(at.motions.len());
        let mut cost = 0.0;
        let vector = |t: &Tangent, i: usize| DVec3::new(t[i], t[i + 1], t[i + 2]);
        // Node `j` after its step, which leads to `p` and `q` and beyond them `by`.
        let place = |j: usize, p: DVec3, q: DQuat, by: &Tangent| {
            let to = (p + vector(by, 0), (exponential(vector(by, 9)) * q).normalize());
            at.motions[j].moved(&steps[j], to, &at.body, change, &after)
        };
        let mut moved = place(0, at.motions[0].p, at.motions[0].q, &steps[0]);
        for j in 0..at.motions.len() {
            motions.push(moved);
            let mut carried = Carried::<P>::new(moved, &after);
            let end = self.nodes.get(j + 1).copied().unwrap_or(self.nodes[j] + 1);
            let mut noise = Matrix6::zeros();
            for k in self.nodes[j]..end {
                for contact in &self.record.contacts[k] {
                    let Some(rows) = Rows::new(contact, &carried.motion, &carried.turn, &self.noise) else {
                        continue;
                    };
                    let r = rows.residual;
                    cost += (rows.information * r).dot(&r);
                }
                if j + 1 < at.motions.len() {
                    let interval = &self.record.intervals[k];
                    carried.step(interval, self.wrenches(k), &after, self.gravity);
                    noise += interval.noise;
                }
            }
            let Some(link) = equations.links.get(j) else { break };
            let left = link.residual + steps[j + 1] - link.by_motion * steps[j] - link.by_body * body;
            let next = place(j + 1, carried.motion.p, carried.motion.q, &left);
            let r = next.from(&carried.motion);
            let information = self.link_information(&noise, &carried, &after)?;
            cost += (information * r).dot(&r);
            moved = next;
        }
        let moved = Unknowns { motions, body: after };
        cost += self.prior_cost::<P>(&moved);
        cost.is_finite().then_some((moved, cost))
    }

    /// Motions at some samples by what was measured since sample `from`, with a motion there.
    pub(super) fn carried(&self, from: usize, motion: Motion, body: &Body, samples: &[usize]) -> Vec<Motion> {
        let mut carried = Carried::<0>::new(motion, body);
        let mut at = from;
        let mut to = |k: usize| {
            while at < k {
                carried.step(&self.record.intervals[at], self.wrenches(at), body, self.gravity);
                at += 1;
            }
            carried.motion
        };
        samples.iter().map(|&k| to(k)).collect()
    }

    /// One over the squares of the natural units of a motion's numbers.
    pub(super) fn natural_information(&self) -> Tangent {
        let Units { length, speed, mass } = self.units;
        let natural = [length, speed, mass * length * speed, 1.0];
        Tangent::from_fn(|i, _| natural[i / 3].powi(-2))
    }

    /// Information of a contact condition in natural units, of a body that turns at the natural rate.
    pub(super) fn condition_information(&self) -> f64 {
        let Units { length, speed, .. } = self.units;
        let deviation = self.noise.floor.max(self.noise.contact * speed / length);
        (speed / deviation).powi(2)
    }

    fn link_information<const P: usize>(
        &self,
        noise: &Matrix6<f64>,
        carried: &Carried<P>,
        body: &Body,
    ) -> Option<Transition> {
        let noise = self.about(noise, carried.motion.p);
        link_information(&noise, carried.after, body, &carried.turn)
    }

    fn add_rows<const P: usize>(
        &self,
        j: usize,
        k: usize,
        carried: &Carried<P>,
        at: &Unknowns,
        all: &mut Equations<P>,
    ) -> Option<()> {
        let touched = self.record.contacts[k].iter();
        let mut rows =
            touched.filter_map(|c| Rows::new(c, &carried.motion, &carried.turn, &self.noise)).peekable();
        if rows.peek().is_none() {
            return Some(());
        }
        let (mut own, mut to_body) = (Transition::zeros(), SMatrix::<f64, MOTION, P>::zeros());
        let (mut gradient, mut body_gradient) = (Tangent::zeros(), SVector::<f64, P>::zeros());
        let mut body = SMatrix::<f64, P, P>::zeros();
        for rows in rows {
            let r = rows.residual;
            let weighted = rows.information * r;
            all.cost += weighted.dot(&r);
            all.conditions += rows.count;
            let (by_motion, by_body) =
                (rows.by_motion(&carried.motion, &carried.turn), rows.by_body::<P>(&at.body, &carried.turn));
            let w_motion = rows.information * by_motion;
            own += by_motion.transpose() * w_motion;
            gradient += by_motion.transpose() * weighted;
            if P > 0 {
                to_body += w_motion.transpose() * by_body;
                body += by_body.transpose() * rows.information * by_body;
                body_gradient += by_body.transpose() * weighted;
            }
        }
        let node = &mut all.nodes[j];
        if carried.after == 0.0 {
            node.own += own;
            node.gradient += gradient;
            node.body += to_body;
            all.body += body;
            all.body_gradient += body_gradient;
            return Some(());
        }
        // Through the derivatives of the motion at the sample by that at the node and by the body.
        let (F, E) = carried.derivatives(&at.body);
        let carried_own = own * F;
        node.own += F.transpose() * carried_own;
        node.gradient += F.transpose() * gradient;
        if P > 0 {
            node.body += F.transpose() * to_body + carried_own.transpose() * E;
            let mixed = E.transpose() * to_body;
            all.body += E.transpose() * own * E + mixed + mixed.transpose() + body;
            all.body_gradient += E.transpose() * gradient + body_gradient;
        }
        Some(())
    }

    fn add_link<const P: usize>(
        &self,
        j: usize,
        carried: &Carried<P>,
        information: &Transition,
        at: &Unknowns,
        all: &mut Equations<P>,
    ) {
        let r = at.motions[j + 1].from(&carried.motion);
        let weighted = information * r;
        let (F, E) = carried.adjusted(&at.body, &r);
        let through = information * F;
        all.cost += weighted.dot(&r);
        let (by_motion, by_body) = carried.derivatives(&at.body);
        all.links.push(LinkEquation { residual: r, by_motion, by_body });
        let node = &mut all.nodes[j];
        node.own += F.transpose() * through;
        node.next -= through.transpose();
        node.gradient -= F.transpose() * weighted;
        if P > 0 {
            let w_body = information * E;
            node.body += F.transpose() * w_body;
            all.nodes[j + 1].body -= w_body;
            all.body += E.transpose() * w_body;
            all.body_gradient -= E.transpose() * weighted;
        }
        let next = &mut all.nodes[j + 1];
        next.own += information;
        next.gradient += weighted;
    }

    fn add_prior<const P: usize>(&self, at: &Unknowns, all: &mut Equations<P>) {
        all.cost += self.prior_cost::<P>(at);
        let (value, information) = &self.first;
        let d = at.motions[0].from(value);
        let node = &mut all.nodes[0];
        for i in 0..MOTION {
            node.own[(i, i)] += information[i];
            node.gradient[i] += information[i] * d[i];
        }
        let d = self.body_departure(&at.body);
        for i in 0..P {
            all.body[(i, i)] += self.body.1[i];
            all.body_gradient[i] += self.body.1[i] * d[i];
        }
    }

    fn prior_cost<const P: usize>(&self, at: &Unknowns) -> f64 {
        let (value, information) = &self.first;
        let d = at.motions[0].from(value);
        let cost = d.component_mul(&d).dot(information);
        let d = self.body_departure(&at.body);
        cost + (0..P).map(|i| self.body.1[i] * d[i] * d[i]).sum::<f64>()
    }

    fn body_departure(&self, body: &Body) -> SVector<f64, 7> {
        let known = &self.body.0;
        SVector::from_fn(|i, _| match i {
            0 => body.log_mass - known.log_mass,
            _ => body.numbers[i - 1] - known.numbers[i - 1],
        })
    }

    /// Noise of impulse and moment about the origin, with the moment about `p` and a floor.
    fn about(&self, noise: &Matrix6<f64>, p: DVec3) -> Matrix6<f64> {
        let mut shift = Matrix6::identity();
        shift.fixed_view_mut::<3, 3>(3, 0).copy_from(&Matrix3::from(-cross_matrix(p)));
        let mut moved = shift * noise * shift.transpose();
        let floor = self.units.mass * self.noise.floor * LINK_FLOOR / (self.nodes.len() as f64).sqrt();
        for i in 0..6 {
            let unit = if i < 3 { 1.0 } else { self.units.length };
            moved[(i, i)] += (floor * unit).powi(2);
        }
        moved
    }
}

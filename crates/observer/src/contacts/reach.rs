//! What each contact condition says by itself, and what a change of the readings makes of it.

use super::body::{Body, CONSTANTS};
use super::equations::{Equations, Gradient, Row};
use super::flow::Carried;
use super::problem::{Problem, Unknowns};
use super::record::Contact;
use super::rows::Rows;
use super::state::{Motion, Tangent, Turn, tangent};
use contact_kinematics::is_stopped;
use glam::DVec3;
use nalgebra::{Matrix3, Vector3};

/// Conditions of one contact, by the motions at a node and the next one, and by the body.
struct Condition {
    node: usize,
    /// By the motion at the node and the body, and by the motion at the next node.
    rows: Vec<(Row<CONSTANTS>, [DVec3; 4])>,
    information: Matrix3<f64>,
}

/// What all conditions fall with at some unknowns.
pub(super) struct Conditions(Vec<Condition>);

/// All residuals at some unknowns, conditions and links.
pub(super) struct Residuals {
    conditions: Vec<Vector3<f64>>,
    links: Vec<Tangent>,
}

/// Derivatives of all residuals by a constant.
pub(super) struct Derivatives {
    conditions: Vec<Vector3<f64>>,
    links: Vec<Tangent>,
}

impl Conditions {
    pub(super) fn new(problem: &Problem, at: &Unknowns) -> Self {
        let mut all = Vec::new();
        let add = |node: usize, k: usize, motion: &Motion, at_nodes: &AtNodes<CONSTANTS>| {
            let turn = at.body.turn(motion.q, motion.L);
            let changes = at.body.by_inertia(&turn);
            all.extend(problem.conditions(k, motion, &turn).map(|(_, rows)| Condition {
                node,
                rows: rows.linear(motion, &turn, &changes).map(at_nodes).collect(),
                information: rows.information(),
            }));
        };
        problem.gone_through(at, Problem::advance, add);
        Self(all)
    }

    /// Slope of half the cost by a constant, information on it, and its block with motions and body. None where conditions came or went.
    pub(super) fn normal(
        &self,
        equations: &Equations<CONSTANTS>,
        residuals: &Residuals,
        by: &Derivatives,
    ) -> Option<(f64, f64, Gradient<CONSTANTS>)> {
        if by.conditions.len() != self.0.len() || by.links.len() != equations.links.len() {
            return None;
        }
        let mut mixed = equations.gradient_of(&by.links);
        let (mut slope, mut own) = (0.0, 0.0);
        for (link, by) in equations.links.iter().zip(&by.links) {
            let weighted = link.information * by;
            slope += weighted.dot(&link.left);
            own += weighted.dot(by);
        }
        for ((condition, residual), by) in self.0.iter().zip(&residuals.conditions).zip(&by.conditions) {
            let weighted = condition.information * by;
            slope += weighted.dot(residual);
            own += weighted.dot(by);
            for ((own, next), weight) in condition.rows.iter().zip(weighted.iter()) {
                mixed.motions[condition.node] += own.tangent() * *weight;
                if let Some(after) = mixed.motions.get_mut(condition.node + 1) {
                    *after += tangent(next) * *weight;
                }
                mixed.body += own.by_body * *weight;
            }
        }
        Some((slope, own, mixed))
    }
}

impl Residuals {
    /// Without derivatives: a constant changes readings alone, and the motion that meets them stays. None where work was stopped, or where the unknowns are
    /// beyond all numbers.
    pub(super) fn new(problem: &Problem, at: &Unknowns) -> Option<Self> {
        if is_stopped() {
            return None;
        }
        let mut conditions = Vec::new();
        let add = |_: usize, k: usize, motion: &Motion, _: &AtNodes<0>| {
            let turn = at.body.turn(motion.q, motion.L);
            conditions.extend(problem.conditions(k, motion, &turn).map(|(_, rows)| rows.residual));
        };
        let links = problem.gone_through(at, Problem::step, add);
        // What conditions tell of the moment of a link is known where both are made.
        let left = || Some(problem.linearise::<CONSTANTS>(at)?.links.iter().map(|link| link.left).collect());
        let links = if problem.shares { left()? } else { links };
        Some(Self { conditions, links })
    }

    /// Of the two sides of a difference, over its length. None where conditions come or go.
    pub(super) fn slope(after: &Self, before: &Self, step: f64) -> Option<Derivatives> {
        let pairs = |a: usize, b: usize| (a == b).then_some(());
        pairs(after.conditions.len(), before.conditions.len())?;
        pairs(after.links.len(), before.links.len())?;
        let both = after.conditions.iter().zip(&before.conditions);
        Some(Derivatives {
            conditions: both.map(|(a, b)| (a - b) / step).collect(),
            links: after.links.iter().zip(&before.links).map(|(a, b)| (a - b) / step).collect(),
        })
    }
}

/// Makes of a condition on the motion at a sample one on those at its node and the next one.
type AtNodes<'a, const P: usize> = dyn Fn(Row<P>) -> (Row<P>, [DVec3; 4]) + 'a;

impl Problem<'_> {
    /// Visits the motions of all samples at some unknowns, each with its node: from node to node they are carried by `carry`. Gives the residuals of
    /// the links.
    fn gone_through<const P: usize>(
        &self,
        at: &Unknowns,
        carry: impl Fn(&Self, &mut Carried<P>, usize, &Body),
        mut visit: impl FnMut(usize, usize, &Motion, &AtNodes<P>),
    ) -> Vec<Tangent> {
        let none = [DVec3::ZERO; 4];
        let mut links = Vec::with_capacity(self.nodes.len());
        for (j, &from) in self.nodes.iter().enumerate() {
            let mut carried = Carried::<P>::new(at.motions[j], &at.body);
            let end = self.nodes.get(j + 1).copied().unwrap_or(from);
            if end != from + 1 {
                visit(j, from, &carried.motion, &|row| (row, none));
            }
            for k in from..end {
                carry(self, &mut carried, k, &at.body);
                if k + 1 < end {
                    visit(j, k + 1, &carried.motion, &|row| (carried.at_node(&row), none));
                }
            }
            if end == from + 1 {
                let motion = self.split(j, &carried, at);
                visit(j, from, &motion, &|row| self.split_row(j, &carried, &row));
            }
            if let Some(next) = at.motions.get(j + 1) {
                links.push(next.from(&carried.motion));
            }
        }
        links
    }

    /// Visits the conditions of all contacts: the sample, the palm, and what is left of them in deviations.
    pub(super) fn visit_conditions(&self, at: &Unknowns, mut visit: impl FnMut(usize, usize, Vector3<f64>)) {
        self.gone_through(at, Problem::step, |_, k, motion, _: &AtNodes<0>| {
            let turn = at.body.turn(motion.q, motion.L);
            for (contact, rows) in self.conditions(k, motion, &turn) {
                visit(k, contact.palm, rows.values());
            }
        });
    }

    /// Of the palms at sample `k`, at a motion there.
    pub(super) fn conditions<'a>(
        &'a self,
        k: usize,
        motion: &'a Motion,
        turn: &'a Turn,
    ) -> impl Iterator<Item = (&'a Contact, Rows)> + 'a {
        let noise = self.noise_at(k);
        let rows = move |contact: &'a Contact| {
            Some((contact, Rows::new(contact, motion, turn, &noise, self.friction)?))
        };
        self.record.contacts[k].iter().filter_map(rows)
    }
}

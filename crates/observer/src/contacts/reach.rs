//! What each contact condition says by itself, and what a change of the readings makes of it.

use super::body::{Body, CONSTANTS};
use super::equations::{Equations, Gradient, Row};
use super::flow::Carried;
use super::problem::{Problem, Unknowns};
use super::rows::Rows;
use super::state::{Motion, Tangent, tangent};
use glam::DVec3;
use nalgebra::{Matrix3, Vector3};

/// Conditions of one contact, by the motions at a node and the next one, and by the body.
struct Condition {
    node: usize,
    /// By the motion at the node and the body, and by the motion at the next node.
    rows: Vec<(Row<CONSTANTS>, [DVec3; 4])>,
    information: Matrix3<f64>,
    residual: Vector3<f64>,
}

/// All residuals at some unknowns, conditions and links.
pub(super) struct Residuals {
    conditions: Vec<Condition>,
    links: Vec<Tangent>,
}

/// Derivatives of all residuals by a constant.
pub(super) struct Derivatives {
    conditions: Vec<Vector3<f64>>,
    links: Vec<Tangent>,
}

impl Residuals {
    /// None where the unknowns are beyond all numbers.
    pub(super) fn new(problem: &Problem, at: &Unknowns) -> Option<Self> {
        let links = problem.linearise::<CONSTANTS>(at)?.links.iter().map(|link| link.left).collect();
        let mut conditions = Vec::new();
        let nodes = &problem.nodes;
        for (j, &from) in nodes.iter().enumerate() {
            let mut carried = Carried::<CONSTANTS>::new(at.motions[j], &at.body);
            let end = nodes.get(j + 1).copied().unwrap_or(from);
            let mut add = |k: usize, motion: &Motion, at_nodes: &dyn Fn(Row<CONSTANTS>) -> _| {
                conditions.extend(problem.conditions(j, k, motion, &at.body, at_nodes));
            };
            let none = [DVec3::ZERO; 4];
            if end != from + 1 {
                add(from, &carried.motion, &|row| (row, none));
            }
            for k in from..end {
                problem.advance(&mut carried, k, &at.body);
                if k + 1 < end {
                    add(k + 1, &carried.motion, &|row| (carried.at_node(&row), none));
                }
            }
            if end == from + 1 {
                let motion = problem.split(j, &carried, at);
                add(from, &motion, &|row| problem.split_row(j, &carried, &row));
            }
        }
        Some(Self { conditions, links })
    }

    /// Of the two sides of a difference, over its length. None where conditions come or go.
    pub(super) fn slope(after: &Self, before: &Self, step: f64) -> Option<Derivatives> {
        let pairs = |a: usize, b: usize| (a == b).then_some(());
        pairs(after.conditions.len(), before.conditions.len())?;
        pairs(after.links.len(), before.links.len())?;
        let both = after.conditions.iter().zip(&before.conditions);
        Some(Derivatives {
            conditions: both.map(|(a, b)| (a.residual - b.residual) / step).collect(),
            links: after.links.iter().zip(&before.links).map(|(a, b)| (a - b) / step).collect(),
        })
    }

    /// Slope of half the cost by a constant, information on it, and its block with motions and body. None where conditions came or went.
    pub(super) fn normal(
        &self,
        equations: &Equations<CONSTANTS>,
        by: &Derivatives,
    ) -> Option<(f64, f64, Gradient<CONSTANTS>)> {
        if by.conditions.len() != self.conditions.len() || by.links.len() != equations.links.len() {
            return None;
        }
        let mut mixed = equations.gradient_of(&by.links);
        let (mut slope, mut own) = (0.0, 0.0);
        for (link, by) in equations.links.iter().zip(&by.links) {
            let weighted = link.information * by;
            slope += weighted.dot(&link.left);
            own += weighted.dot(by);
        }
        for (condition, by) in self.conditions.iter().zip(&by.conditions) {
            let weighted = condition.information * by;
            slope += weighted.dot(&condition.residual);
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

impl Problem<'_> {
    /// Conditions at sample `k` of the link after node `j`; `at_nodes` makes of one on the motion there one on those of node `j` and the next.
    fn conditions<'a>(
        &'a self,
        j: usize,
        k: usize,
        motion: &'a Motion,
        body: &Body,
        at_nodes: &'a dyn Fn(Row<CONSTANTS>) -> (Row<CONSTANTS>, [DVec3; 4]),
    ) -> impl Iterator<Item = Condition> + 'a {
        let turn = body.turn(motion.q, motion.L);
        let (changes, noise) = (body.by_inertia(&turn), self.noise_at(k));
        self.record.contacts[k].iter().filter_map(move |contact| {
            let rows = Rows::new(contact, motion, &turn, &noise, self.friction)?;
            Some(Condition {
                node: j,
                rows: rows.linear(motion, &turn, &changes).map(at_nodes).collect(),
                information: rows.information(),
                residual: rows.residual,
            })
        })
    }
}

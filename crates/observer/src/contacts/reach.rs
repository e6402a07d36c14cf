//! What each contact condition says by itself, and what a change of the readings makes of it.

use super::body::CONSTANTS;
use super::equations::{Equations, Gradient};
use super::flow::{Carried, Transition};
use super::problem::{Problem, Unknowns};
use super::rows::Rows;
use super::state::{MOTION, Motion, Tangent};
use nalgebra::{Matrix3, SMatrix, Vector3};

/// Conditions of one contact, by the motions at a node and the next one, and by the body.
struct Condition {
    node: usize,
    own: SMatrix<f64, 3, MOTION>,
    next: SMatrix<f64, 3, MOTION>,
    body: SMatrix<f64, 3, CONSTANTS>,
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
        let links = problem.linearise::<CONSTANTS>(at)?.links.iter().map(|link| link.residual).collect();
        let mut conditions = Vec::new();
        let nodes = &problem.nodes;
        for (j, &from) in nodes.iter().enumerate() {
            let mut carried = Carried::<CONSTANTS>::new(at.motions[j], &at.body);
            let end = nodes.get(j + 1).copied().unwrap_or(from);
            let whole = [Transition::identity(), Transition::zeros()];
            let mut add = |k: usize, motion: &Motion, [own, next]: [Transition; 2], body| {
                conditions.extend(problem.conditions(j, k, motion, at, ([own, next], body)));
            };
            if end != from + 1 {
                add(from, &carried.motion, whole, SMatrix::zeros());
            }
            for k in from..end {
                problem.advance(&mut carried, k, &at.body);
                if k + 1 < end {
                    let (F, E) = carried.derivatives(&at.body);
                    add(k + 1, &carried.motion, [F, Transition::zeros()], E);
                }
            }
            if end == from + 1 {
                let (motion, [own, next], body) = problem.split(j, &carried, at);
                add(from, &motion, [own, next], body);
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
            slope += weighted.dot(&link.residual);
            own += weighted.dot(by);
        }
        for (condition, by) in self.conditions.iter().zip(&by.conditions) {
            let weighted = condition.information * by;
            slope += weighted.dot(&condition.residual);
            own += weighted.dot(by);
            mixed.motions[condition.node] += condition.own.transpose() * weighted;
            if let Some(next) = mixed.motions.get_mut(condition.node + 1) {
                *next += condition.next.transpose() * weighted;
            }
            mixed.body += condition.body.transpose() * weighted;
        }
        Some((slope, own, mixed))
    }
}

impl Problem<'_> {
    /// Conditions at sample `k`, whose motion follows those of node `j` and the next and the body by these derivatives.
    fn conditions<'a>(
        &'a self,
        j: usize,
        k: usize,
        motion: &'a Motion,
        at: &'a Unknowns,
        ([own, next], body): ([Transition; 2], SMatrix<f64, MOTION, CONSTANTS>),
    ) -> impl Iterator<Item = Condition> + 'a {
        let turn = at.body.turn(motion.q, motion.L);
        self.record.contacts[k].iter().filter_map(move |contact| {
            let rows = Rows::new(contact, motion, &turn, &self.noise, self.friction)?;
            let by_motion = rows.by_motion(motion, &turn);
            let by_body: SMatrix<f64, 3, CONSTANTS> = rows.by_body(&at.body, &turn);
            Some(Condition {
                node: j,
                own: by_motion * own,
                next: by_motion * next,
                body: by_motion * body + by_body,
                information: rows.information,
                residual: rows.residual,
            })
        })
    }
}

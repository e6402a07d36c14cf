//! A record read the other way: what bodies do without friction they do backwards as well, and its end is another beginning to search from.

use super::body::Body;
use super::problem::{Problem, Unknowns};
use super::record::{Contact, Interval, Record};
use super::search::{Ended, fine, fine_nodes, forwards, refined};
use super::state::Motion;
use glam::DMat3;

/// Where a search from the end of the record ends. None unless what it finds is explained.
pub(super) fn backwards(problem: &mut Problem) -> Option<Ended> {
    let reversed = problem.record.reversed();
    let mut turned = problem.on(&reversed);
    let ended = forwards(&mut turned).filter(|ended| ended.solved.explained())?;
    let last = reversed.times.len() - 1;
    let nodes: Vec<usize> = turned.nodes.iter().rev().map(|k| last - k).collect();
    let start = ended.solved.unknowns.reversed();
    problem.nodes = fine_nodes(problem);
    problem.frozen.clear();
    let start = refined(problem, &nodes, &start);
    let solved = fine(problem, start)?;
    Some(Ended::at(problem, solved, ended.all()))
}

impl Record {
    fn reversed(&self) -> Self {
        let contact = |contact: &Contact| Contact {
            u: -contact.u,
            W: -contact.W,
            J_before: contact.J_after,
            J_after: contact.J_before,
            ..*contact
        };
        let interval = |of: &Interval| Interval { first: of.h * of.impulse.force - of.first, ..*of };
        Self {
            times: self.times.iter().rev().map(|t| -t).collect(),
            samples: self.samples.iter().rev().copied().collect(),
            contacts: self.contacts.iter().rev().map(|all| all.iter().map(contact).collect()).collect(),
            wrenches: self.wrenches.iter().rev().copied().collect(),
            intervals: self.intervals.iter().rev().map(interval).collect(),
            misread: Vec::new(),
            misread_forces: Vec::new(),
            ..*self
        }
    }
}

impl Unknowns {
    /// Of the record read the other way; axes of the body are again those of the world at the first sample.
    fn reversed(&self) -> Self {
        let first = self.motions.last().map(|motion| motion.q).unwrap_or_default();
        let one = |motion: &Motion| Motion {
            v: -motion.v,
            L: -motion.L,
            q: (motion.q * first.conjugate()).normalize(),
            ..*motion
        };
        let inertia = self.body.inertia_along(DMat3::from_quat(first));
        let body = Body::free(self.body.log_mass, inertia);
        Self { motions: self.motions.iter().rev().map(one).collect(), body }
    }
}

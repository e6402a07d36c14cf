//! Changes of contact modes of a log beside those of its simulation.

use super::log::{Change, Log};
use recon::object_dynamics::ContactSimulation;

/// Changes of modes are the same when they are at most this far apart, s.
const APART: f64 = 2e-3;

/// Whether two are changes of the same palm to the same mode, whenever.
fn alike(a: &Change, b: &Change) -> bool {
    a.palm == b.palm && a.mode == b.mode
}

/// Of some changes the one like a given that is nearest to it.
pub(super) fn nearest<'a>(change: &Change, others: &'a [Change]) -> Option<&'a Change> {
    let alike = others.iter().filter(|other| alike(other, change));
    alike.min_by(|a, b| (a.t - change.t).abs().total_cmp(&(b.t - change.t).abs()))
}

/// How many changes of modes are the same from the start: palm, new mode, and time.
pub(super) fn same_changes(theirs: &[Change], ours: &[Change]) -> usize {
    let same = |(a, b): &(&Change, &Change)| alike(a, b) && (a.t - b.t).abs() <= APART;
    // Two palms that change within the tolerance may do so in either order.
    let mut left: Vec<&Change> = ours.iter().collect();
    let mut count = 0;
    for change in theirs {
        let Some(at) = left.iter().take(3).position(|other| same(&(change, other))) else { break };
        left.remove(at);
        count += 1;
    }
    count
}

/// Which changes of the log have one of ours of the same palm and mode within the tolerance, each of ours once.
pub(super) fn matching(theirs: &[Change], ours: &[Change]) -> Vec<usize> {
    let mut left: Vec<&Change> = ours.iter().collect();
    let taken = theirs.iter().enumerate().filter(|(_, change)| {
        let same = |o: &&Change| alike(o, change) && (o.t - change.t).abs() <= APART;
        left.iter().position(same).map(|at| left.remove(at)).is_some()
    });
    taken.map(|(index, _)| index).collect()
}

/// Changes of modes at the samples, told as the logs tell them.
pub(super) fn changes(log: &Log, simulation: &ContactSimulation) -> Vec<Change> {
    let mut found = Vec::new();
    let mode = |k: usize, i: usize| {
        let now = &simulation.instants[k];
        match now.modes[i].number() {
            0 => 0,
            _ if now.rates[i].slip.length() < log.slip_tolerance() => 2,
            _ => 1,
        }
    };
    for k in 1..simulation.instants.len() {
        for i in 0..log.palm_count() {
            if mode(k, i) != mode(k - 1, i) {
                found.push(Change { t: simulation.instants[k].state.t, palm: i, mode: mode(k, i) });
            }
        }
    }
    found
}

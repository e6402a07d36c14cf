//! What an estimate from contacts rests on, and which of its rows are to be relied on.

use super::equations::Equations;
use super::problem::{Problem, Units};
use super::samples::Deviations;
use crate::chance::excess;
use crate::faults::{Assumption, Explanation, Suspect};
use crate::reliability::{LARGEST_DEVIATION, LARGEST_MISFIT, Reason, Reliability};
use glam::DVec3;

/// Standard deviations of a normal variable beyond which a stretch of the log is not explained by noise, or a constant of the sensors
/// is not what it was taken for: once in a million.
pub(super) const UNEXPLAINED: f64 = 4.75;
/// The same once in ten thousand.
const UNLIKELY: f64 = 3.7;
/// Share of a deviation that what a linear model leaves out may be, as a product of two deviations: it makes errors of that size at most which last.
const BENT: f64 = 0.5;
/// Length of a stretch in natural times.
const STRETCH: f64 = 1.0;

/// What an estimate from contacts rests on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactEvidence {
    /// Samples of the log.
    pub samples: usize,
    /// Motions that were solved for: one a window of samples.
    pub nodes: usize,
    /// Contact conditions.
    pub conditions: usize,
    /// Squared corrections of all readings, in their deviations, over the number of conditions: about 1 when all is as stated.
    pub misfit: f64,
    /// How many times the variance of independent noise that of a mean of what is left is, beyond what chance makes of it: 1 of white noise.
    pub lasting: f64,
    /// Deviations by which an estimate may be off since forces change faster than they are sampled: 0 where noise hides none of it.
    pub unresolved: f64,
    /// How many times as noisy as stated contacts and forces count: they scatter by more, or repeat themselves from sample to sample. Else 1.
    pub rougher: [f64; 2],
    /// Linearisations: coarse, all.
    pub iterations: [usize; 2],
    /// Whether less than half a standard deviation was left to gain.
    pub settled: bool,
}

impl ContactEvidence {
    pub(super) fn reliability(&self) -> Reliability {
        let mut reliability = Reliability::Reliable;
        if !self.settled {
            reliability.add(Reason::NotConverged { iterations: self.iterations[1] });
        }
        if !self.is_explained() {
            reliability.add(Reason::Inconsistent { misfit: self.misfit });
        }
        reliability
    }

    /// Whether noise explains what is left.
    pub(super) fn is_explained(&self) -> bool {
        is_explained(self.misfit, self.conditions)
    }

    /// Whether a body turns too little to tell where its centre of mass is, by its angular velocities at the nodes and the deviations there.
    ///
    /// The conditions hold the product of both. Where it does not change beyond its deviations the linear model of that product is kept as long
    /// as the deviations of its factors, multiplied, hardly count beside the velocity that they are added to.
    pub(super) fn still(nodes: &[(DVec3, Deviations)]) -> Option<Reason> {
        let deviations = change_of_spin(nodes);
        let bent = |(_, [p, v, w, _]): &(DVec3, Deviations)| p.length() * w.length() > BENT * v.length();
        (deviations < UNEXPLAINED && nodes.iter().any(bent)).then_some(Reason::Still { deviations })
    }

    /// A constant of the sensors, where the data speak against one: the one that explains them best, if that was asked.
    pub(super) fn against(suspects: &[Suspect], explanations: &[Explanation]) -> Option<Reason> {
        let most = suspects.iter().max_by(|a, b| a.score().abs().total_cmp(&b.score().abs()))?;
        let sensor = |of: &Explanation| match of.assumption {
            Assumption::One(fault) => {
                let own = suspects.iter().find(|suspect| suspect.fault == fault)?;
                Some(Suspect { value: of.value, deviation: of.deviation, ..*own })
            }
            _ => None,
        };
        let named = explanations.iter().find_map(sensor).unwrap_or(*most);
        (most.score().abs() > UNEXPLAINED).then_some(Reason::Fault(named))
    }

    /// What all deviations are to be multiplied by: a misfit that is left is noise that was not stated, of readings that are alike fewer count as
    /// independent, and what is missed between samples lasts.
    pub(super) fn widening(&self) -> f64 {
        (self.misfit.max(1.0) * self.lasting).sqrt() * self.unresolved.hypot(1.0)
    }

    /// The same of constants of the sensors: where noise does not explain what is left, that lasts since one of them is wrong.
    pub(super) fn widening_of_constants(&self) -> f64 {
        if self.is_explained() { self.widening() } else { self.misfit.max(1.0).sqrt() }
    }
}

/// The largest change of the spin from its mean, in its deviations.
fn change_of_spin(nodes: &[(DVec3, Deviations)]) -> f64 {
    let mean = nodes.iter().map(|(w, _)| *w).sum::<DVec3>() / nodes.len().max(1) as f64;
    let change = |(w, [_, _, deviation, _]): &(DVec3, Deviations)| {
        ((*w - mean).abs() / deviation.max(DVec3::splat(f64::MIN_POSITIVE))).max_element()
    };
    nodes.iter().map(change).fold(0.0, f64::max)
}

/// Whether noise explains this misfit, of so many conditions.
pub(super) fn is_explained(misfit: f64, conditions: usize) -> bool {
    // Of few conditions chance alone makes more.
    let conditions = conditions as f64;
    misfit <= LARGEST_MISFIT || excess(misfit * conditions, conditions) < UNLIKELY
}

/// For each node, by how many deviations of a normal variable the misfit of the stretch around it exceeds that of the whole.
///
/// Where noise is not what conditions are off by, what is left lasts, and tells no stretch from another.
pub(super) fn stretches<const P: usize>(problem: &Problem, equations: &Equations<P>) -> Vec<f64> {
    if problem.exact && problem.record.frictionless() {
        return vec![0.0; problem.nodes.len()];
    }
    let Units { length, speed, .. } = problem.units;
    let half = 0.5 * STRETCH * length / speed;
    let times: Vec<f64> = problem.nodes.iter().map(|&k| problem.record.times[k]).collect();
    let mut sums = vec![(0.0, 0.0)];
    for node in &equations.nodes {
        let (cost, conditions) = sums[sums.len() - 1];
        sums.push((cost + node.cost, conditions + node.conditions as f64));
    }
    let scale = (equations.cost / equations.conditions.max(1) as f64).max(1.0);
    let one = |&t: &f64| {
        let from = times.partition_point(|&other| other < t - half);
        let to = times.partition_point(|&other| other <= t + half);
        let (cost, conditions) = (sums[to].0 - sums[from].0, sums[to].1 - sums[from].1);
        excess(cost / scale, conditions)
    };
    times.iter().map(one).collect()
}

/// Whether a row is to be relied on, if the estimate is: noise explains the stretch around it, and the deviations are
/// small enough for the linearisation that they come from.
pub(super) fn relied_on(excess: f64, deviations: &Deviations, units: &Units) -> bool {
    let Units { length, speed, .. } = *units;
    let natural = [length, speed, speed / length, 1.0];
    let small = |(of, unit): (&glam::DVec3, f64)| of.max_element() <= LARGEST_DEVIATION * unit;
    excess <= UNEXPLAINED && deviations.iter().zip(natural).take(3).all(small)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a body that turns steadily its centre of mass is told by a product of two unknowns: as long as their deviations multiplied hardly count beside
    /// that of the velocity, its linear model holds, and where they count the body is too still.
    #[test]
    fn a_body_that_turns_steadily_is_still_where_a_product_of_deviations_counts() {
        let steady = |spin: f64| {
            let of = [1e-4, 3e-4, spin, 0.1].map(DVec3::splat);
            ContactEvidence::still(&[(DVec3::Z * 3.0, of), (DVec3::Z * (3.0 + spin), of)])
        };
        // Root of three of each: 1e-4 * spin * 3 against half of 3e-4 * sqrt(3).
        let largest = 0.5 * 3e-4 / (1e-4 * 3.0_f64.sqrt());
        assert_eq!(steady(0.99 * largest), None);
        assert!(matches!(steady(1.01 * largest), Some(Reason::Still { .. })));
        // One that changes its spin by more than its deviations tells them apart.
        let of = [1e-2, 3e-4, 0.1, 0.1].map(DVec3::splat);
        assert_eq!(ContactEvidence::still(&[(DVec3::ZERO, of), (DVec3::X, of)]), None);
        assert!(ContactEvidence::still(&[(DVec3::ZERO, of), (DVec3::X * 0.5, of)]).is_some());
    }
}

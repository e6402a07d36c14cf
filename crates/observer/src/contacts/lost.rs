//! What is wrong where a search of a long log ends nowhere: a constant of the sensors that is not as stated leaves no motion of many natural times to be
//! found, but one of its first ones.

use super::estimate::{ContactEstimate, estimate_contacts};
use super::onward::LONG;
use super::options::ContactOptions;
use super::problem::Units;
use crate::reliability::{Reason, Reliability};
use object_dynamics::{ContactLog, ContactMode, MOST_PALMS};

/// Natural times that a motion is looked for over.
const BEGINNING: f64 = 8.0;

/// Whether no motion was found of a log that is so long that its beginning may tell why.
/// `duration` in s.
pub(super) fn is_lost(settled: bool, duration: f64, units: &Units) -> bool {
    !settled && duration > LONG.lasts.start * units.time()
}

impl ContactEstimate {
    /// With what speaks against the constants of the sensors or the body over the beginning of a log of which no motion was found: what a point that is
    /// none says of them is no more than chance.
    pub(super) fn explained_by_beginning(
        mut self,
        log: &ContactLog,
        modes: Option<&[[ContactMode; MOST_PALMS]]>,
        (options, units): (&ContactOptions, &Units),
    ) -> Self {
        let end = log.times()[0] + BEGINNING * units.time();
        let samples: Vec<usize> = (0..log.times().partition_point(|t| *t <= end)).collect();
        let modes = modes.map(|modes| &modes[..samples.len()]);
        let told = || estimate_contacts(&log.picked(&samples).ok()?, modes, options).ok();
        let Some(begun) = told() else { return self };
        if let Reliability::Unreliable(reasons) = begun.reliability {
            let named = |reason: &Reason| matches!(reason, Reason::Fault(_) | Reason::OtherBody { .. });
            reasons.into_iter().filter(named).for_each(|reason| self.reliability.add(reason));
        }
        Self { suspects: begun.suspects, explanations: begun.explanations, ..self }
    }
}

//! Motions in which a palm that sticks is let go, for its slip.

use super::solution::{Of, Solution};
use super::window::Window;
use crate::contacts::record::Record;
use crate::contacts::samples::at_all;
use crate::contacts::slips::Known;
use object_dynamics::{ContactMode, MOST_PALMS};

impl Window {
    /// The motions at the window's end in which one palm each, of those that stick somewhere, need not.
    pub(super) fn freed(
        &self,
        record: &Record,
        (modes, longest): (&[[ContactMode; MOST_PALMS]], f64),
        of: &Of,
        solution: &Solution,
    ) -> Vec<(usize, Solution)> {
        let Of { problem, solved, ref covariances, unresolved, .. } = *of;
        let sticks = |palm: &usize| modes.iter().any(|modes| modes[*palm] == ContactMode::Stick);
        let palms: Vec<usize> = (0..self.palms.len()).filter(sticks).collect();
        if palms.is_empty() {
            return Vec::new();
        }
        let motions = at_all(record, problem, &solved.unknowns, covariances);
        let known = Known { log: record, modes, problem, solved, covariances, motions: &motions, longest };
        let Solution { number, t, missed, .. } = *solution;
        let one = |palm: usize| {
            let freed = known.without_sticking(palm, |problem, solved, covariances| {
                let (problem, lasting) = (&problem, solved.lasting(&problem));
                let (solved, against, open) = (&solved, false, false);
                let of = Of { problem, solved, covariances, against, open, lasting, unresolved };
                Solution::new(&of, (number, t), self.options.body.as_ref(), missed)
            });
            freed.map(|solution| (palm, solution))
        };
        palms.into_iter().filter_map(one).collect()
    }
}

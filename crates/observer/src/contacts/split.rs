//! The motion at a node's own sample, which a share of the link after it leads to, where that link is one interval of the record.

use super::equations::Row;
use super::flow::Carried;
use super::problem::{Problem, Unknowns};
use super::state::Motion;
use glam::DVec3;

impl Problem<'_> {
    /// Share of a link's residual that the node's own sample has, if the link is one interval.
    ///
    /// The noise of a force at a sample is felt in the intervals before and after it, half in each: changes of the velocity from node to node have a
    /// variance of `R (1 - q / 2)` and `R q / 4` in common with those beside them, of links with the variance `R` that a sample makes the share `q` of. A
    /// link takes all of `R`, which leaves links independent; the node is then the motion before it, and its contact is touched after the share
    /// `s` of the link's, where `s (1 - s) = q / 4`: after half of it where a link is one interval of the log. The noise of a measured impulse is that of
    /// its interval, and all after the sample. In space it is `q / 2`, the same for one interval: what noise says of an inertia is counted for that.
    ///
    /// A blow is after the sample before it.
    pub(super) fn share(&self, j: usize) -> f64 {
        let interval = &self.record.intervals[self.nodes[j]];
        if interval.blow {
            return 0.0;
        }
        let at = |k: usize| self.record.samples[k];
        let intervals = at(self.nodes[j] + 1).abs_diff(at(self.nodes[j])).max(1);
        let of_sample = interval.noise.sampled_share() / intervals as f64;
        if self.planar { 0.5 * (1.0 - (1.0 - of_sample).max(0.0).sqrt()) } else { 0.5 * of_sample }
    }

    /// The same of each sample: none of those after which a link is longer.
    pub(super) fn shares_of_samples(&self) -> Vec<f64> {
        let mut shares = vec![0.0; self.record.contacts.len()];
        for (j, pair) in self.nodes.windows(2).enumerate().filter(|(_, pair)| pair[1] == pair[0] + 1) {
            shares[pair[0]] = self.share(j);
        }
        shares
    }

    /// The motion at the sample of a node with a link of one interval after it.
    pub(super) fn split<const P: usize>(&self, j: usize, carried: &Carried<P>, at: &Unknowns) -> Motion {
        at.motions[j].kicked(&at.motions[j + 1].from(&carried.motion), self.share(j))
    }

    /// A condition on that motion as one on those at the node and the next one.
    pub(super) fn split_row<const P: usize>(
        &self,
        j: usize,
        carried: &Carried<P>,
        row: &Row<P>,
    ) -> (Row<P>, [DVec3; 4]) {
        let share = self.share(j);
        let [_, v, L, _] = row.by_motion;
        let after = [DVec3::ZERO, v * share, L * share, DVec3::ZERO];
        let mut own = *row;
        own.add(-1.0, &carried.at_node(&Row { by_motion: after, ..Row::zero() }));
        (own, after)
    }

    /// The motions at the nodes as their samples have them, after their share of what the links say.
    pub(super) fn at_samples(&self, at: &Unknowns) -> Vec<Motion> {
        let one = |j: usize| {
            let motion = at.motions[j];
            match self.nodes.get(j + 1) {
                Some(&end) if end == self.nodes[j] + 1 => {
                    let carried = self.carried(self.nodes[j], motion, &at.body, &[end])[0];
                    motion.kicked(&at.motions[j + 1].from(&carried), self.share(j))
                }
                _ => motion,
            }
        };
        (0..at.motions.len()).map(one).collect()
    }
}

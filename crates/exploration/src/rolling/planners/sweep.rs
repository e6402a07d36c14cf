use crate::planner::Reason;
use crate::rolling::planner::{RollPlanError, RollPlanner, RollProposal, View};
use crate::rolling::workspace::Workspace;

/// Palm motions that look at nothing, after Erdmann ("An exploration of nonprehensile two-palm manipulation", 1998): both palms tilt together from
/// one side to the other, the wedge is narrowed by a step, they tilt back; at the narrowest it is widened again.
#[derive(Clone, Debug, Default)]
pub struct PalmSweep {
    next: usize,
}

/// Wedges between the widest and the narrowest, both included.
const WEDGES: usize = 4;

impl PalmSweep {
    /// From the widest wedge on.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Both ends of a tilt with wedge `k`, in rad; the same wedge comes again on the way back.
    fn ends(workspace: &Workspace, k: usize) -> [[f64; 2]; 2] {
        let [[low1, high1], [low2, high2]] = workspace.angles;
        let [narrow, wide] = workspace.wedge;
        let (narrow, wide) = (narrow.max(low2 - high1), wide.min(high2 - low1));
        let period = 2 * (WEDGES - 1);
        let step = (k % period).min(period - k % period);
        let wedge = wide - (wide - narrow) * step as f64 / (WEDGES - 1) as f64;
        let (first, last) = (low1.max(low2 - wedge), high1.min(high2 - wedge));
        [[first, first + wedge], [last, last + wedge]]
    }
}

impl RollPlanner for PalmSweep {
    fn name(&self) -> &'static str {
        "fixed sweep"
    }

    fn next(&mut self, view: &View<'_>) -> Result<RollProposal, RollPlanError> {
        let ends = Self::ends(view.workspace, self.next / 2);
        // There with one wedge, back with the next.
        let legs = vec![ends[usize::from(matches!(self.next % 4, 1 | 2))]];
        self.next += 1;
        Ok(RollProposal { legs, expected: None, reason: Reason::Sequence })
    }
}

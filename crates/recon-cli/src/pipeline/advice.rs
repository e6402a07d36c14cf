//! What to do next after an estimate.

/// Share of the upper bound's volume (area) that the lower one has where there is little left to gain.
const TIGHT: f64 = 0.6;

/// What decides on what to do next.
pub(super) struct Advice {
    pub(super) reliable: bool,
    /// Volumes (areas) of the lower and the upper bound; none where there is no upper one.
    pub(super) bounds: Option<[f64; 2]>,
    /// Whether mass and inertia were estimated.
    pub(super) identified: bool,
    /// Whether all of the inertia was learned, if so.
    pub(super) learned: bool,
    /// Whether the motion is one in the plane, which simulators take no object of.
    pub(super) in_plane: bool,
}

impl Advice {
    /// The step that gains most.
    pub(super) fn next(&self) -> &'static str {
        match (self.reliable, self.bounds) {
            (false, _) => {
                "see which evidence in report.html is marked (! or a cross), and what was read of the log: recon check-input LOG --scene SCENE"
            }
            (true, _) if self.identified && !self.learned => {
                "turn the object about more axes: the log does not tell all of its inertia"
            }
            (true, None) => "touch the object from all sides: only then it has an upper bound",
            (true, Some([lower, upper])) if lower < TIGHT * upper => {
                "touch more of the object (a longer log): the bounds leave much of its shape open"
            }
            (true, Some(_)) if !self.identified => "--identify tells mass and inertia from the log as well",
            (true, Some(_)) if self.in_plane => "nothing is left that this log could tell",
            (true, Some(_)) => "--export mjcf,urdf writes the object for simulators",
        }
    }
}

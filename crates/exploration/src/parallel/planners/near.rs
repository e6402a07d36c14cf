use super::idle::Idle;
use super::{BODIES, best};
use crate::parallel::hold::Hold;
use crate::parallel::planner::{ParallelPlanError, ParallelPlanner, ParallelProposal, ParallelView};
use crate::parallel::predict::Course;
use crate::planner::Reason;
use crate::space::metric::{PalmPose, Together, distance};
use contact_kinematics::Direction;
use glam::{DQuat, DVec3};

/// Of all strokes that bring nearly as much as the best one, the one with the nearest end in the metric of configurations
/// (the paper's second strategy).
#[derive(Clone, Debug)]
pub struct NearestGap {
    seed: u64,
    idle: Idle,
}

/// Share of the best gain that is enough.
const SHARE: f64 = 0.5;

impl NearestGap {
    /// With bodies of this seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { seed, idle: Idle::default() }
    }
}

impl ParallelPlanner for NearestGap {
    fn name(&self) -> &'static str {
        "nearest gap"
    }

    fn next(&mut self, view: &ParallelView<'_>) -> Result<ParallelProposal, ParallelPlanError> {
        let bodies = view.bodies(BODIES, self.seed);
        if let Some(instead) = self.idle.instead(view, &bodies)? {
            return Ok(instead);
        }
        let all = view.candidates(&bodies, &Course::start(&bodies, view.hold), &view.farthest_gaps());
        let Some((first, gain)) = best(&all, view.worth()) else { return self.idle.walked(view) };
        let good = (0..all.len()).filter(|k| all[*k].prediction.gain >= SHARE * gain);
        let way = |k: usize| {
            let ends = all[k].course.holds.iter().zip(&bodies);
            let ways = ends.map(|(end, body)| between(view, body, end));
            ways.sum::<f64>() / bodies.len() as f64
        };
        let nearest = good.map(|k| (k, way(k))).min_by(|a, b| a.1.total_cmp(&b.1));
        let k = nearest.map_or(first, |(k, _)| k);
        let reason = if k == first { Reason::Best } else { Reason::Near };
        Ok(ParallelProposal { stroke: all[k].stroke, expected: Some(all[k].prediction), reason })
    }
}

/// Distance (m) of the palms at the end of a stroke from where they are, as the body sees them.
fn between(view: &ParallelView<'_>, body: &impl crate::parallel::hold::Held, end: &Hold) -> f64 {
    let poses = |hold: &Hold| palms(hold, |n| body.farthest(n));
    // Holds are finite and the size is checked.
    distance(&poses(view.hold), &poses(end), 0.5 * view.workspace.size, Together::AtOnce)
        .unwrap_or(f64::INFINITY)
}

/// Both palms in the frame of the body.
fn palms(hold: &Hold, farthest: impl Fn(Direction) -> DVec3) -> [PalmPose; 2] {
    let back: DQuat = hold.R_WO.inverse();
    let [up, down] = hold.normals();
    let pose = |along: Direction, pad: glam::DVec2| PalmPose {
        R_OP: back,
        p_OP: farthest(along) - back * pad.extend(0.0),
    };
    [pose(up, hold.pads[0]), pose(down, hold.pads[1])]
}

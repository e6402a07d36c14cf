//! Bounds from poses of a body above a plane, as of a tracked object that is dropped on a table.
//!
//! Each pose says that the whole body is above the plane: one half-space of the body's frame. Where the body touches the
//! plane the half-space is tight. Both together tell the noise: a touching half-space that the others cut far below its
//! own plane contradicts them. And where it touches, some point of the body is near the plane, which bounds it from
//! inside.
//!
//! ```
//! use glam::{DQuat, DVec3};
//! use shape_bounds::poses::{BodyPose, PoseBounds};
//! use std::f64::consts::FRAC_PI_2;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A cube of 100 mm that came to rest twice on each of its faces; of each end five frames.
//! let about = |axis: DVec3, turns: u32| DQuat::from_axis_angle(axis, f64::from(turns) * FRAC_PI_2);
//! let faces = (0..4).map(|k| about(DVec3::X, k)).chain([about(DVec3::Y, 1), about(DVec3::Y, 3)]).cycle().take(12);
//! let lies = |turn| vec![BodyPose { R_WO: turn, p_WO: DVec3::new(0.0, 0.0, 0.05) }; 5];
//! let bounds = PoseBounds::above_plane(&faces.map(lies).collect::<Vec<_>>(), 0.0, 0.95)?;
//! assert!((bounds.upper.volume() - 1e-3).abs() < 1e-6);
//! # Ok(())
//! # }
//! ```

mod error;
mod height;
mod level;
mod lower;
mod rule;
mod runs;
mod suspect;
#[cfg(test)]
mod tests;

pub use error::PoseError;
pub use height::PlaneHeight;
pub use rule::{CALIBRATED_RUNS, CONFIDENCES, PoseRule};
pub use runs::ContradictingRun;

use crate::bounds::{Gap, ShapeBounds};
use contact_kinematics::Direction;
use exact_hull::HalfSpace;
use exact_hull::Hull;
use exact_hull::{Intersection, Polyhedron};
use glam::{DQuat, DVec3};
use runs::Agreed;

/// Where a body was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyPose {
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Position of the body's origin in the world, in m.
    pub p_WO: DVec3,
}

/// Bounds from poses above a plane, with the noise level that the data themselves show.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseBounds {
    /// The body is in here, at the stated confidence.
    pub upper: Polyhedron,
    /// This is in the body, at the stated confidence; `None` where the touching poses prove nothing inside.
    pub lower: Option<Hull>,
    /// The half-space of each pose with its margin, run by run: they all hold at the stated confidence. Empty for runs that
    /// are left out.
    pub half_spaces: Vec<Vec<HalfSpace>>,
    /// Margin common to all half-spaces, in m.
    pub margin: f64,
    /// Noise at which the trusted share of the touching poses are consistent with all others, in m; where the body is
    /// propped up, at which few enough runs contradict the others.
    pub consistent_level: f64,
    /// Runs that contradict others, which have no part in the bounds.
    pub left_out: Vec<ContradictingRun>,
    /// Whether many poses that seem to touch cannot, so that something else than the plane holds or pushes the body: then
    /// what is judged is how many runs contradict each other, and there is no lower bound.
    pub propped: bool,
    /// Poses that were taken for touching the plane.
    pub touching: usize,
    /// How far lower than stated the plane seems to be, in m: where a body with edges seems to have hung in the air when it touched
    /// with them. A body that is round tells nothing of that.
    pub plane_seems_lower: Option<f64>,
    /// Touching poses that disagree with the others by more than the margins, as (run, frame).
    pub outliers: Vec<(usize, usize)>,
}

/// One pose's half-space and what is known of its error.
#[derive(Clone, Copy)]
struct Observation {
    half_space: HalfSpace,
    /// The largest second difference of the position around the frame, in m.
    roughness: f64,
    /// Margin from the roughness of the motion.
    kink: f64,
    /// How far off the plane a touching body may be at the frame, from the same.
    gap: f64,
    touching: bool,
    at: (usize, usize),
}

impl PoseBounds {
    /// Bounds of a convex body from `runs` of poses sampled evenly in time, with the body always above the `plane`, by the
    /// default rule.
    ///
    /// # Errors
    /// Those of [`Self::by_rule`].
    pub fn above_plane(
        runs: &[Vec<BodyPose>],
        plane: impl Into<PlaneHeight>,
        confidence: f64,
    ) -> Result<Self, PoseError> {
        Self::by_rule(runs, plane, confidence, &PoseRule::default())
    }

    /// [`Self::above_plane`] by a rule of one's own.
    ///
    /// The margins hold two parts: a share of the largest second difference of the position around a frame; and a
    /// multiple of the level, common to all, at which a share of the poses in which the body touches the plane (it is at
    /// rest, or is accelerated upwards by more than in flight) are consistent with all poses. What the height of the plane
    /// may be off comes on top. The body's size is not used.
    ///
    /// Runs that contradict others are left out where the rest then agrees to half of the level or better. Where that
    /// leaves a level of a tenth of the body's size, poses that seem to touch do not: see [`Self::propped`].
    ///
    /// # Errors
    /// [`PoseError`] for values that are not finite, runs of fewer than three frames, an impossible confidence or rule,
    /// too few touching poses to judge, and half-spaces that leave some direction open.
    pub fn by_rule(
        runs: &[Vec<BodyPose>],
        plane: impl Into<PlaneHeight>,
        confidence: f64,
        rule: &PoseRule,
    ) -> Result<Self, PoseError> {
        let plane = plane.into();
        rule.check()?;
        let observations = observe(runs, plane.z, rule)?;
        if !(confidence > 0.5 && confidence < 1.0) {
            return Err(PoseError::Confidence(confidence));
        }
        let touching = observations.iter().filter(|o| o.touching).count();
        if touching < level::FEWEST {
            return Err(PoseError::TooFewTouching { found: touching, needed: level::FEWEST });
        }
        let Agreed { kept, level, left_out, propped } = runs::agreed(observations, runs.len(), rule)?;
        let rule = if propped { &runs::PROPPED } else { rule };
        let (of_rule, of_height) = plane.allowance(runs.len(), confidence)?;
        let margin = level * rule.factor(of_rule, runs.len()) + of_height;
        let upper = intersect(&kept, margin)?;
        let outliers = if propped { Vec::new() } else { level::inconsistent(&kept, &upper, margin) };
        let inside = if propped { Vec::new() } else { lower::certain_points(&kept, &upper, margin) };
        let lower = Hull::of(&inside).ok().filter(|hull| hull.solid().is_some());
        let plane_seems_lower = if propped {
            None
        } else {
            suspect::lower_plane(&kept, margin, level::noise_scale(runs) / 6.0_f64.sqrt())
        };
        let half_spaces = by_run(&kept, runs.len(), margin);
        let consistent_level = level;
        Ok(Self {
            upper,
            lower,
            half_spaces,
            margin,
            consistent_level,
            left_out,
            propped,
            touching,
            plane_seems_lower,
            outliers,
        })
    }
}

impl PoseBounds {
    /// The largest gap between the bounds; `None` without a lower bound.
    #[must_use]
    pub fn largest_gap(&self) -> Option<Gap> {
        let upper = Intersection::Bounded(self.upper.clone());
        ShapeBounds::between(self.lower.clone()?, upper)?.largest_gap()
    }
}

/// The half-space, in the body's frame, that keeps a body at `pose` above the plane of height `plane_z`.
#[must_use]
pub fn half_space_above_plane(pose: &BodyPose, plane_z: f64) -> HalfSpace {
    let down = -(pose.R_WO.inverse() * DVec3::Z);
    HalfSpace { point: down * (pose.p_WO.z - plane_z), normal: Direction::new_unchecked(down), margin: 0.0 }
}

fn observe(runs: &[Vec<BodyPose>], plane_z: f64, rule: &PoseRule) -> Result<Vec<Observation>, PoseError> {
    if let Some(run) = runs.iter().position(|poses| poses.len() < 3) {
        return Err(PoseError::ShortRun { run, frames: runs[run].len() });
    }
    let noise = level::noise_scale(runs);
    let mut observations = Vec::new();
    for (run, poses) in runs.iter().enumerate() {
        let flight = level::flight_scale(poses);
        for (frame, pose) in poses.iter().enumerate() {
            let unit = (pose.R_WO.length() - 1.0).abs() < 1e-3;
            if !(pose.p_WO.is_finite() && plane_z.is_finite() && unit) {
                return Err(PoseError::Pose { run, frame, pose: *pose, plane_z });
            }
            let roughness = level::roughness(poses, frame);
            let normalised = BodyPose { R_WO: pose.R_WO.normalize(), ..*pose };
            observations.push(Observation {
                half_space: half_space_above_plane(&normalised, plane_z),
                roughness,
                kink: rule.kink * roughness,
                gap: rule.gap * roughness,
                touching: level::touches(poses, frame, flight, noise),
                at: (run, frame),
            });
        }
    }
    Ok(observations)
}

impl Observation {
    /// The half-space with `margin` and what the kink adds.
    fn moved(&self, margin: f64) -> HalfSpace {
        HalfSpace { margin: margin + self.kink, ..self.half_space }
    }
}

fn by_run(kept: &[Observation], runs: usize, margin: f64) -> Vec<Vec<HalfSpace>> {
    let mut all = vec![Vec::new(); runs];
    kept.iter().for_each(|o| all[o.at.0].push(o.moved(margin)));
    all
}

fn intersect(observations: &[Observation], margin: f64) -> Result<Polyhedron, PoseError> {
    let moved: Vec<HalfSpace> = observations.iter().map(|o| o.moved(margin)).collect();
    match Intersection::of(&moved)? {
        Intersection::Bounded(polyhedron) => Ok(polyhedron),
        Intersection::Unbounded(open) => Err(PoseError::Open { directions: open.directions().to_vec() }),
    }
}

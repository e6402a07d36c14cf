//! A finger that touches a body which is computed.

use super::SpaceKnowledge;
use crate::finger::{Finger, Motion, TouchError};
use crate::planner::Proposal;
use crate::random::Source;
use contact_kinematics::Direction;
use glam::DVec3;
use shape_bounds::ContactSample;
use shape_bounds::distance::nearest;

/// Touches the convex body whose farthest point along a direction is `support(direction)`, with seeded normal noise.
pub struct SimulatedFinger<F> {
    support: F,
    motion: Motion,
    point: f64,
    normal: f64,
    source: Source,
}

/// Steps along a ray at most: each takes the ray to a plane that separates it from the body.
const STEPS: usize = 500;
/// A ray has arrived when it is this near, relative to its length.
const ARRIVED: f64 = 1e-12;

impl<F: Fn(Direction) -> DVec3> SimulatedFinger<F> {
    /// Without noise.
    #[must_use]
    pub fn new(support: F, motion: Motion) -> Self {
        Self { support, motion, point: 0.0, normal: 0.0, source: Source::new(0) }
    }

    /// With normal noise: standard deviations of a point per axis, in m, and of a normal about each tangent axis, in rad.
    #[must_use]
    pub fn with_noise(self, point: f64, normal: f64, seed: u64) -> Self {
        Self { point, normal, source: Source::new(seed), ..self }
    }

    /// Where the ray from `from` towards `to` meets the body, and the normal there: steps to the plane that separates the ray's
    /// end from the body (van den Bergen, "Ray casting against general convex objects", 2004).
    fn cast(&self, from: DVec3, to: DVec3) -> Result<(DVec3, Direction), TouchError> {
        let along = to - from;
        let length = along.length();
        let support = |d: DVec3| Direction::new(d).map_or(DVec3::NAN, |d| (self.support)(d));
        let (mut here, mut normal) = (from, None);
        for _ in 0..STEPS {
            let near = nearest(here, &[], support);
            let facing = near.direction.dot(along);
            if near.certified <= ARRIVED * length {
                break;
            }
            if facing >= 0.0 {
                return Err(TouchError::Missed);
            }
            normal = Direction::new(near.direction).ok();
            here -= along * (near.certified / facing);
        }
        let normal = normal.or_else(|| Direction::new(-along).ok()).ok_or(TouchError::Missed)?;
        Ok((here, normal))
    }
}

impl<F: Fn(Direction) -> DVec3> Finger<SpaceKnowledge> for SimulatedFinger<F> {
    fn touch(&mut self, proposal: &Proposal<SpaceKnowledge>) -> Result<ContactSample, TouchError> {
        let (point, normal) = match (self.motion, proposal.ray) {
            (Motion::Ray, Some([from, to])) => self.cast(from, to)?,
            _ => ((self.support)(proposal.along), proposal.along),
        };
        let read = self.source.reading(point, normal, [self.point, self.normal]);
        let (point, normal) = read.ok_or(TouchError::NotFinite)?;
        if !point.is_finite() {
            return Err(TouchError::NotFinite);
        }
        Ok(ContactSample { point, normal })
    }
}

//! Palms with a body that is computed.

use super::hold::{Held, Hold, Stop, steps};
use super::palms::{FeltBetween, ParallelPalms, ParallelPalmsError};
use super::workspace::ParallelWorkspace;
use crate::random::Source;
use contact_kinematics::Direction;
use glam::{DQuat, DVec2, DVec3};
use shape_bounds::ContactSample;

/// The convex body whose farthest point along a direction is `support(direction)`, felt with seeded normal noise.
pub struct SimulatedParallelPalms<F> {
    body: Body<F>,
    workspace: ParallelWorkspace,
    hold: Hold,
    point: f64,
    normal: f64,
    source: Source,
}

struct Body<F>(F);

impl<F: Fn(Direction) -> DVec3> Held for Body<F> {
    fn farthest(&self, along: Direction) -> DVec3 {
        (self.0)(along)
    }
}

/// A turn is made in steps of so many rad.
const STEP: f64 = 0.01;
/// Of a body that tips over, rad, and how many at most: more than once round.
const TIPPED: f64 = 0.005;
const TIPS: usize = 2000;

impl<F: Fn(Direction) -> DVec3> SimulatedParallelPalms<F> {
    /// A body that is squeezed in the orientation `R_WO`, over the middle of both pads: where friction does not hold it it tips over to where it does.
    ///
    /// # Errors
    /// [`ParallelPalmsError::NotHeld`] where it comes to rest nowhere.
    pub fn new(support: F, workspace: ParallelWorkspace, R_WO: DQuat) -> Result<Self, ParallelPalmsError> {
        let body = Body(support);
        let none = ParallelPalmsError::NotHeld { friction: workspace.friction };
        let mut hold = Hold { R_WO, pads: [DVec2::ZERO; 2] };
        let held = |hold: &Hold| body.shear(hold.normals()[0]) <= workspace.most_shear();
        let mut tips = 0;
        while !held(&hold) {
            let [up, down] = hold.normals();
            let span = (hold.R_WO * (body.farthest(up) - body.farthest(down))).truncate();
            // Both forces turn it so that the upper contact goes on to where it leans.
            let heading = span.try_normalize().ok_or(none)?;
            (hold, _) = hold.rolled(&body, heading, TIPPED);
            tips += 1;
            if tips > TIPS {
                return Err(none);
            }
        }
        hold.pads = [DVec2::ZERO; 2];
        Ok(Self { body, workspace, hold, point: 0.0, normal: 0.0, source: Source::new(0) })
    }

    /// With normal noise: standard deviations of a point per axis, in m, and of a normal about each tangent axis, in rad.
    #[must_use]
    pub fn with_noise(self, point: f64, normal: f64, seed: u64) -> Self {
        Self { point, normal, source: Source::new(seed), ..self }
    }

    fn read(&mut self, way: f64, stop: Option<Stop>) -> Result<FeltBetween, ParallelPalmsError> {
        let [up, down] = self.hold.normals();
        let (hold, noise) = (self.hold, [self.point, self.normal]);
        let (body, source) = (&self.body, &mut self.source);
        let mut felt = |along: Direction, palm: &'static str| {
            let read = source.reading(body.farthest(along), along, noise);
            let (point, normal) = read.ok_or(ParallelPalmsError::NotFinite { palm })?;
            let finite = point.is_finite().then_some(ContactSample { point, normal });
            finite.ok_or(ParallelPalmsError::NotFinite { palm })
        };
        let contacts = [felt(up, "upper")?, felt(down, "lower")?];
        Ok(FeltBetween { hold, contacts, way, stop })
    }
}

impl<F: Fn(Direction) -> DVec3> ParallelPalms for SimulatedParallelPalms<F> {
    fn feel(&mut self) -> Result<FeltBetween, ParallelPalmsError> {
        self.read(0.0, None)
    }

    fn roll(&mut self, heading: f64, turn: f64) -> Result<FeltBetween, ParallelPalmsError> {
        if !(heading.is_finite() && turn.is_finite()) {
            return Err(ParallelPalmsError::Stroke { heading, turn });
        }
        let along = DVec2::from_angle(heading);
        let (parts, step) = steps(turn, STEP);
        let (mut way, mut stop) = (0.0, None);
        for _ in 0..parts {
            match self.hold.stepped(&self.body, &self.workspace, along, step) {
                Ok((next, moved)) => {
                    self.hold = next;
                    way += moved;
                }
                Err(why) => {
                    stop = Some(why);
                    break;
                }
            }
        }
        self.read(way, stop)
    }
}

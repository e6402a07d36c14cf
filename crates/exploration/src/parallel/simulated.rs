//! Palms with a body that is computed.

use super::hold::{Held, Hold, Stop, steps};
use super::palms::{FeltBetween, ParallelPalms, ParallelPalmsError, SensedPalms};
use super::workspace::ParallelWorkspace;
use crate::random::Source;
use contact_kinematics::Direction;
use glam::{DQuat, DVec2, DVec3};
use observer::rolling::{RollingNoise, RollingReading};
use shape_bounds::ContactSample;

/// The convex body whose farthest point along a direction is `support(direction)`: felt as it is in its own axes ([`ParallelPalms`]), or by palms with
/// seeded normal noise that know nothing of its pose ([`SensedPalms`]).
pub struct SimulatedParallelPalms<F> {
    body: Body<F>,
    workspace: ParallelWorkspace,
    hold: Hold,
    noise: RollingNoise,
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
        let noise = RollingNoise { contact: 0.0, palm: 0.0, spin: 0.0 };
        Ok(Self { body, workspace, hold, noise, source: Source::new(0) })
    }

    /// With noise of the sensors, and pads that let the body spin.
    #[must_use]
    pub fn with_noise(self, noise: RollingNoise, seed: u64) -> Self {
        Self { noise, source: Source::new(seed), ..self }
    }

    /// Where the body is from the middle of the lower palm: how it is turned, and its origin, m.
    #[must_use]
    pub fn pose(&self) -> (DQuat, DVec3) {
        let [_, down] = self.hold.normals();
        let lower = self.hold.pads[1].extend(0.0);
        (self.hold.R_WO, lower - self.hold.R_WO * self.body.farthest(down))
    }

    fn felt(&self, way: f64, stop: Option<Stop>) -> Result<FeltBetween, ParallelPalmsError> {
        let [up, down] = self.hold.normals();
        let felt = |normal: Direction, palm: &'static str| {
            let point = self.body.farthest(normal);
            let finite = point.is_finite().then_some(ContactSample { point, normal });
            finite.ok_or(ParallelPalmsError::NotFinite { palm })
        };
        let contacts = [felt(up, "upper")?, felt(down, "lower")?];
        Ok(FeltBetween { hold: self.hold, contacts, noise: None, way, stop })
    }

    fn sensed(&mut self) -> RollingReading {
        let [upper, lower] = self.hold.pads;
        let span = self.hold.span(&self.body);
        let middle = lower.extend(0.0) + span - upper.extend(0.0);
        let RollingNoise { contact, palm, .. } = self.noise;
        let contacts = [upper, lower].map(|c| c + self.source.normal3().truncate() * contact);
        RollingReading { upper: middle + self.source.normal3() * palm, contacts }
    }

    /// One of the equal steps of a stroke, and how far the upper palm went, m.
    fn step(&mut self, along: DVec2, turn: f64) -> Result<f64, Stop> {
        let (next, moved) = self.hold.stepped(&self.body, &self.workspace, along, turn)?;
        let spin = self.noise.spin * turn.abs().sqrt();
        // Without it nothing is drawn, so that noise of sensors stays what it is.
        self.hold = if spin > 0.0 { next.spun(&self.body, spin * self.source.normal()) } else { next };
        Ok(moved)
    }

    /// A stroke, step by step: how far the upper palm went (m), and what stopped it. `each` sees the palms after every step.
    fn moved(
        &mut self,
        heading: f64,
        turn: f64,
        mut each: impl FnMut(&mut Self),
    ) -> Result<(f64, Option<Stop>), ParallelPalmsError> {
        if !(heading.is_finite() && turn.is_finite()) {
            return Err(ParallelPalmsError::Stroke { heading, turn });
        }
        let (along, (parts, step)) = (DVec2::from_angle(heading), steps(turn, STEP));
        let mut way = 0.0;
        for _ in 0..parts {
            match self.step(along, step) {
                Ok(moved) => way += moved,
                Err(why) => return Ok((way, Some(why))),
            }
            each(self);
        }
        Ok((way, None))
    }
}

impl<F: Fn(Direction) -> DVec3> ParallelPalms for SimulatedParallelPalms<F> {
    fn feel(&mut self) -> Result<FeltBetween, ParallelPalmsError> {
        self.felt(0.0, None)
    }

    fn roll(&mut self, heading: f64, turn: f64) -> Result<FeltBetween, ParallelPalmsError> {
        let (way, stop) = self.moved(heading, turn, |_| ())?;
        self.felt(way, stop)
    }
}

impl<F: Fn(Direction) -> DVec3> SensedPalms for SimulatedParallelPalms<F> {
    fn sense(&mut self) -> Result<RollingReading, ParallelPalmsError> {
        Ok(self.sensed())
    }

    fn stroke(
        &mut self,
        heading: f64,
        turn: f64,
    ) -> Result<(Vec<RollingReading>, Option<Stop>), ParallelPalmsError> {
        let mut sensed = Vec::new();
        let (_, stop) = self.moved(heading, turn, |palms| sensed.push(palms.sensed()))?;
        Ok((sensed, stop))
    }
}

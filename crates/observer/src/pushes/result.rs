//! What pushes tell.

use super::outline::PushedOutline;
use super::touches::NoTouch;
use glam::DVec2;
use object_dynamics::pushing::{PushMode, PushPose};

/// The coefficient of friction between finger and object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushFriction {
    /// Its mean over pushes, at a slip of a quarter of the finger's speed.
    pub value: f64,
    /// Its standard deviation, with the one from push to push: that need not average out.
    pub deviation: f64,
    /// What it gains with the speed of slip, and its deviation, s/m.
    pub by_slip: (f64, f64),
    /// The slip at which it is told, m/s.
    pub at_slip: f64,
    /// Pushes that slide.
    pub pushes: usize,
}

impl PushFriction {
    /// The coefficient at a slip in m/s.
    #[must_use]
    pub fn at(&self, slip: f64) -> f64 {
        self.value + self.by_slip.0 * (slip - self.at_slip)
    }
}

/// One instant of a push in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushInstant {
    /// s, since the push began.
    pub t: f64,
    /// Pose by which it was judged; between those that were measured it is inferred.
    pub pose: PushPose,
    /// Where the outline is touched, object's frame, m.
    pub point: DVec2,
    /// Friction over normal force; positive to the left, as the finger looks at the object.
    pub ratio: f64,
    /// Slip of the finger over the outline, m/s; positive to the left.
    pub slip: f64,
    /// Probability that the contact sticks.
    pub stick: f64,
    /// Probability that the finger slides to the left.
    pub left: f64,
    /// Probability that it slides to the right.
    pub right: f64,
}

impl PushInstant {
    /// The most probable mode.
    #[must_use]
    pub fn mode(&self) -> PushMode {
        if self.stick >= self.left.max(self.right) {
            PushMode::Stick
        } else if self.left > self.right {
            PushMode::Left
        } else {
            PushMode::Right
        }
    }
}

/// One push.
#[derive(Clone, Debug, PartialEq)]
pub struct PushResult {
    /// Its number in the log.
    pub number: u32,
    /// Where the outline was first and last touched, object's frame, m.
    pub ends: [DVec2; 2],
    /// What is left between finger and outline there, m.
    pub gaps: [f64; 2],
    /// Its own coefficient of friction, where it slides.
    pub friction: Option<f64>,
    /// In contact, under load.
    pub instants: Vec<PushInstant>,
}

/// All that pushes tell.
#[derive(Clone, Debug, PartialEq)]
pub struct PushesEstimate {
    /// The outline.
    pub outline: PushedOutline,
    /// Friction; none where too little slides to tell it.
    pub friction: Option<PushFriction>,
    /// The ratio of friction to normal force that 95 % of all windows stay below: where nothing slides, friction is at least that.
    pub ratio_seen: f64,
    /// Deviation of the friction from push to push, and of a ratio within a push.
    pub spread: [f64; 2],
    /// Each push that touched.
    pub pushes: Vec<PushResult>,
    /// Pushes that did not, and why.
    pub untouched: Vec<(u32, NoTouch)>,
    /// Noise of each component of the force, N; none where every push is in contact throughout.
    pub force_noise: Option<f64>,
    /// How far the finger gives way, m/N.
    pub compliance: f64,
    /// How far the finger's record is ahead of the object's at the first force, and at the last one, with deviations, s.
    pub clocks: [(f64, f64); 2],
    /// Deviations of touches: of the mean of both of a push, and of half their difference, m.
    pub touch_deviations: [f64; 2],
    /// The table's friction length, m: its largest torque over its largest force.
    pub table_length: f64,
    /// What the motion that the force drives lacks of the pose after a push, medians, m and rad.
    pub missed: (f64, f64),
}

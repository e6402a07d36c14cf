//! What one node of the state-space model carries: block means of the touch at it, and the wrench since the one before.
//!
//! A node stands for a block of samples. Means and moments over the block are taken of quantities of the data alone, so
//! that nothing is lost by not visiting every sample: white noise enters a fit through its means.

use contact_kinematics::PalmFrame;
use glam::DVec3;
use std::ops::{Add, Mul};

/// Time integrals over an interval of a force along one palm's normal.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wrench {
    /// Of the force, N s.
    pub(crate) impulse: DVec3,
    /// Of the time since the start of the interval times the force, N s^2.
    pub(crate) first: DVec3,
    /// Of the torque about the world's origin, N m s.
    pub(crate) torque: DVec3,
}

impl Add for Wrench {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            impulse: self.impulse + other.impulse,
            first: self.first + other.first,
            torque: self.torque + other.torque,
        }
    }
}

impl Mul<f64> for Wrench {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { impulse: self.impulse * factor, first: self.first * factor, torque: self.torque * factor }
    }
}

impl Wrench {
    /// The integrals over this interval and one of length `next` after it, this one lasting `duration`.
    pub(crate) fn then(self, duration: f64, next: Self) -> Self {
        let first = self.first + next.first + next.impulse * duration;
        Self { impulse: self.impulse + next.impulse, first, torque: self.torque + next.torque }
    }
}

/// One palm over the block of samples about a node. Moments are means of a quantity times 1, `u`, `u^2 / 2`, with `u`
/// the time from the node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PalmTouch {
    /// Frame at the node.
    pub(crate) frame: PalmFrame,
    /// Rate of the palm's slope at the node, rad/s.
    pub(crate) rate: f64,
    /// Moments of the normal.
    pub(crate) normal: [DVec3; 3],
    /// Moments of `n x c`, m.
    pub(crate) arm: [DVec3; 3],
    /// Mean of `n x c` for derivatives, m: the same, or smoothed over neighbours. Noise in a derivative passes for
    /// information.
    pub(crate) smooth_arm: DVec3,
    /// Share that the block itself has in it.
    pub(crate) own_share: f64,
    /// Mean of `p = -s2 rate`, m/s.
    pub(crate) lift: f64,
    /// Force as reported times the normal at the node, N, and its rate.
    pub(crate) force: [DVec3; 2],
    /// Torque of that force about the world's origin, N m, and its rate.
    pub(crate) torque: [DVec3; 2],
}

/// The touch of all palms over the block of samples about a node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub(crate) palms: [PalmTouch; 3],
    /// Samples in the block.
    pub(crate) samples: f64,
    /// Time from sample to sample, s.
    pub(crate) spacing: f64,
    /// Variance, by palm, of the rate at which the body turns against it, as far as the present estimate knows it,
    /// (rad/s)^2: contact noise enters the condition times that rate, so this much more of it than the estimate says.
    pub(crate) slide_variance: [f64; 3],
}

/// Input of the state-space model at one node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeInput {
    /// Time since the node before, s; zero at the first.
    pub(crate) duration: f64,
    /// Integrals over the first and the second half of that time, by palm.
    pub(crate) halves: [[Wrench; 3]; 2],
    /// What the estimate before this one adds to the impulse of the whole interval, N s, for derivatives: noise in them
    /// passes for information, and it is the same noise that the estimate weighs.
    pub(crate) correction: DVec3,
    /// Touch at the node before; that of the first node is its own.
    pub(crate) from: Touch,
    /// Touch at this node.
    pub(crate) here: Touch,
}

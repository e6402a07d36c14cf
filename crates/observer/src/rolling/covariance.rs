//! Covariance of a pose, and what turns add to it.

use crate::rigid::cross_matrix;
use glam::{DMat3, DVec3};

/// Covariance of an error of the pose in the world: turns `theta` and shifts `d` of the body's origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct PoseCovariance {
    pub(super) rotation: DMat3,
    pub(super) translation: DMat3,
    pub(super) cross: DMat3,
}

impl PoseCovariance {
    pub(super) const NONE: Self =
        Self { rotation: DMat3::ZERO, translation: DMat3::ZERO, cross: DMat3::ZERO };

    pub(super) fn turned(self, by: DMat3) -> Self {
        let turn = |m: DMat3| by * m * by.transpose();
        Self { rotation: turn(self.rotation), translation: turn(self.translation), cross: turn(self.cross) }
    }

    /// A further turn of this covariance about a point at `-arm` from the origin.
    pub(super) fn with_turn(self, turn: DMat3, arm: DVec3) -> Self {
        // d = theta x arm.
        let shift = -cross_matrix(arm);
        Self {
            rotation: self.rotation + turn,
            translation: self.translation + shift * turn * shift.transpose(),
            cross: self.cross + turn * shift.transpose(),
        }
    }
}

/// The same variance along both level axes.
pub(super) fn level(variance: f64) -> DMat3 {
    DMat3::from_diagonal(DVec3::new(variance, variance, 0.0))
}

pub(super) fn outer(v: DVec3) -> DMat3 {
    DMat3::from_cols(v * v.x, v * v.y, v * v.z)
}

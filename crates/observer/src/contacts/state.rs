//! The motion at a node and the constants of the body.

use super::body::Body;
use crate::rigid::{cross_matrix, logarithm};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3, Vector6};

/// Numbers of a motion's tangent: centre of mass, velocity, angular momentum, turn in world axes.
pub(super) const MOTION: usize = 12;
pub(super) type Tangent = SVector<f64, MOTION>;

/// Of its four vectors.
pub(super) fn tangent(parts: &[DVec3; 4]) -> Tangent {
    Tangent::from_fn(|i, _| parts[i / 3][i % 3])
}

/// Its four vectors: centre of mass, velocity, angular momentum, turn.
pub(super) fn parts(of: &Tangent) -> [DVec3; 4] {
    std::array::from_fn(|i| DVec3::new(of[3 * i], of[3 * i + 1], of[3 * i + 2]))
}

/// Motion at a node; positions from the record's origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub(super) p: DVec3,
    pub(super) v: DVec3,
    pub(super) L: DVec3,
    pub(super) q: DQuat,
}

/// What follows from motion and body at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub(super) R: DMat3,
    /// Inverse inertia in world axes.
    pub(super) K: DMat3,
    pub(super) w: DVec3,
}

impl Motion {
    /// The motion after a step that led to the position `p` and the orientation `q`, of `body` before and `after` it.
    ///
    /// Contact conditions are linear in the body's twist about a point of space: that moves by what the step means to first
    /// order, and the angular momentum follows. A large step of centre of mass or inertia then leaves the conditions as
    /// they were promised, and those are what is stiffest.
    pub(super) fn moved(
        &self,
        step: &Tangent,
        (p, q): (DVec3, DQuat),
        body: &Body,
        numbers: Option<&Vector6<f64>>,
        after: &Body,
    ) -> Self {
        let [place, velocity, momentum, by] = parts(step);
        let turn = body.turn(self.q, self.L);
        let mut change = self.L.cross(by) + momentum;
        if let Some(numbers) = numbers {
            for (slope, by) in body.by_inertia(&turn).into_iter().zip(numbers.iter()) {
                change += slope * *by;
            }
        }
        let spin = turn.K * change + by.cross(turn.w);
        let w = turn.w + spin;
        let v = self.v + velocity - turn.w.cross(place) + w.cross(p - self.p);
        Self { p, v, L: after.inertia_along(DMat3::from_quat(q)) * w, q }
    }

    /// With a share of what a link's residual says that velocity and angular momentum were changed by.
    pub(super) fn kicked(&self, residual: &Tangent, share: f64) -> Self {
        let [_, velocity, momentum, _] = parts(residual);
        Self { v: self.v + velocity * share, L: self.L + momentum * share, ..*self }
    }

    /// Derivatives of the angular velocity by the motion and by the numbers of the inertia.
    pub(super) fn spin_derivatives(&self, body: &Body) -> (SMatrix<f64, 3, MOTION>, SMatrix<f64, 3, 6>) {
        let turn = body.turn(self.q, self.L);
        let K = Matrix3::from(turn.K);
        let mut by_motion = SMatrix::<f64, 3, MOTION>::zeros();
        by_motion.fixed_view_mut::<3, 3>(0, 6).copy_from(&K);
        by_motion
            .fixed_view_mut::<3, 3>(0, 9)
            .copy_from(&Matrix3::from(turn.K * cross_matrix(self.L) - cross_matrix(turn.w)));
        let changes = body.by_inertia(&turn).map(|change| Vector3::from(turn.K * change));
        (by_motion, SMatrix::from_columns(&changes))
    }

    /// The step that leads here from another motion.
    pub(super) fn from(&self, other: &Self) -> Tangent {
        let turn = logarithm((self.q * other.q.conjugate()).normalize());
        let parts = [self.p - other.p, self.v - other.v, self.L - other.L, turn];
        tangent(&parts)
    }
}

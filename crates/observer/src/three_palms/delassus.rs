//! How an impulse of one palm changes the speed of another's contact.

use glam::{DMat3, DVec3};

/// A palm's push on the body: its normal, and that crossed with the contact from the centre of mass.
#[derive(Clone, Copy)]
pub(super) struct Push {
    pub(super) normal: DVec3,
    /// `n x (c - p)`, m.
    pub(super) arm: DVec3,
}

impl Push {
    /// Change of the speed along this normal by a unit impulse along the `other`: an entry of the Delassus matrix, 1/kg.
    pub(super) fn speed_by(&self, other: &Self, mass: f64, inverse_inertia: DMat3) -> f64 {
        self.normal.dot(other.normal) / mass + self.arm.dot(inverse_inertia * other.arm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use contact_kinematics::{Direction, PalmFrame};

    /// The matrix is that of a kinetic energy: symmetric, and of two equal pushes through the centre of mass one over the mass.
    #[test]
    fn the_matrix_is_symmetric_and_plain_through_the_centre_of_mass() {
        let frame = |n: DVec3| PalmFrame::from_normal(Direction::new(n).unwrap()).unwrap();
        let (a, b) = (frame(DVec3::new(0.2, 0.1, 1.0)), frame(DVec3::new(-0.6, 0.3, 0.8)));
        let inverse = DMat3::from_diagonal(DVec3::new(1.0, 0.5, 0.25));
        let p = DVec3::new(0.1, -0.2, 0.9);
        let push = |frame: &PalmFrame, p_WC: DVec3| Push { normal: frame.n, arm: frame.n.cross(p_WC - p) };
        let (x, y) = (push(&a, DVec3::new(0.3, 0.2, -0.1)), push(&b, DVec3::new(-0.7, 0.1, 0.2)));
        assert!((x.speed_by(&y, 2.0, inverse) - y.speed_by(&x, 2.0, inverse)).abs() < 1e-15);
        let through = push(&a, p - a.n * 0.7);
        assert!((through.speed_by(&through, 2.0, inverse) - 0.5).abs() < 1e-15);
    }
}

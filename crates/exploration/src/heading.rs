//! Directions of touch, in the plane and in space alike.

use contact_kinematics::Direction;
use glam::DVec2;
use shape_bounds::exact_hull::planar;
use std::f64::consts::PI;

/// A direction along which a body can be touched: the outward normal of the plane or line that a finger brings up to it.
pub trait Heading: Copy + PartialEq + std::fmt::Debug {
    /// Angle between two directions in rad, in [0, pi]: the length of the way from one to the other.
    fn angle_to(self, other: Self) -> f64;

    /// The direction reached after `angle` (rad) on the shortest way from `self` to `other`; any shortest way if there are
    /// several, and `self` if there is none.
    fn turned_towards(self, other: Self, angle: f64) -> Self;

    /// The opposite direction.
    fn opposite(self) -> Self;

    /// `count` directions spread evenly: a regular polygon in the plane, a Fibonacci lattice in space.
    fn spread(count: usize) -> Vec<Self>;

    /// The coordinates of the unit vector.
    fn coordinates(self) -> Vec<f64>;
}

impl Heading for Direction {
    fn angle_to(self, other: Self) -> f64 {
        // By the arc tangent: exact for small angles as well, where the cosine is flat.
        let (a, b) = (self.get(), other.get());
        a.cross(b).length().atan2(a.dot(b))
    }

    fn turned_towards(self, other: Self, angle: f64) -> Self {
        let a = self.get();
        let across = other.get() - a * a.dot(other.get());
        // Opposite directions have all ways in common; any will do.
        let across = if across.length_squared() > 1e-24 {
            across.normalize()
        } else if a.dot(other.get()) < 0.0 {
            self.tangent_basis().0
        } else {
            return self;
        };
        Self::new(a * angle.cos() + across * angle.sin()).unwrap_or(self)
    }

    fn opposite(self) -> Self {
        -self
    }

    fn spread(count: usize) -> Vec<Self> {
        // The golden angle between neighbours in height: Fibonacci lattice.
        let turn = PI * (3.0 - 5f64.sqrt());
        let one = |k: usize| {
            let z = 1.0 - (2 * k + 1) as f64 / count as f64;
            let (sin, cos) = (turn * k as f64).sin_cos();
            let across = (1.0 - z * z).max(0.0).sqrt();
            Self::new(glam::DVec3::new(across * cos, across * sin, z)).ok()
        };
        (0..count).filter_map(one).collect()
    }

    fn coordinates(self) -> Vec<f64> {
        self.get().to_array().to_vec()
    }
}

impl Heading for planar::Direction {
    fn angle_to(self, other: Self) -> f64 {
        let (a, b): (DVec2, DVec2) = (self.get(), other.get());
        a.perp_dot(b).abs().atan2(a.dot(b))
    }

    fn turned_towards(self, other: Self, angle: f64) -> Self {
        let sense = if self.get().perp_dot(other.get()) < 0.0 { -1.0 } else { 1.0 };
        let turned = DVec2::from_angle(sense * angle).rotate(self.get());
        Self::new(turned).unwrap_or(self)
    }

    fn opposite(self) -> Self {
        -self
    }

    fn spread(count: usize) -> Vec<Self> {
        (0..count).map(|k| Self::from_angle(2.0 * PI * k as f64 / count as f64)).collect()
    }

    fn coordinates(self) -> Vec<f64> {
        self.get().to_array().to_vec()
    }
}

//! Seeded numbers: the same on every machine.

use contact_kinematics::Direction;
use glam::{DQuat, DVec3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::TAU;

/// A reproducible source of numbers.
#[derive(Clone, Debug)]
pub struct Source(Pcg64);

impl Source {
    /// A source; the same seed gives the same numbers.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between `low` and `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Standard normal (Box and Muller, 1958).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (TAU * self.unit()).cos()
    }

    /// Three independent standard normals.
    pub fn normal3(&mut self) -> DVec3 {
        DVec3::new(self.normal(), self.normal(), self.normal())
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> Direction {
        loop {
            if let Ok(direction) = Direction::new(self.normal3()) {
                return direction;
            }
        }
    }

    /// What is read of a contact: the point off by normal noise of a deviation per axis (m), the normal tilted by one about each tangent axis (rad).
    /// None where the tilt leaves no direction.
    pub(crate) fn reading(
        &mut self,
        point: DVec3,
        normal: Direction,
        [off, tilt]: [f64; 2],
    ) -> Option<(DVec3, Direction)> {
        let (a, b) = normal.tangent_basis();
        let turned = normal.get() + (a * self.normal() + b * self.normal()) * tilt;
        let point = point + self.normal3() * off;
        Direction::new(turned).ok().map(|normal| (point, normal))
    }

    /// Uniform over all rotations: a normalised normal vector in four dimensions.
    pub fn rotation(&mut self) -> DQuat {
        loop {
            let q = DQuat::from_xyzw(self.normal(), self.normal(), self.normal(), self.normal());
            if q.length_squared() > 1e-12 {
                return q.normalize();
            }
        }
    }
}

//! The first touches.

use crate::random::Source;
use contact_kinematics::Direction;
use glam::{DQuat, DVec3};

/// The outward normals of a regular tetrahedron: the fewest that close an upper bound.
#[must_use]
pub fn tetrahedron() -> Vec<Direction> {
    let corners = [(1.0, 1.0, 1.0), (1.0, -1.0, -1.0), (-1.0, 1.0, -1.0), (-1.0, -1.0, 1.0)];
    corners.into_iter().filter_map(|(x, y, z)| Direction::new(DVec3::new(x, y, z)).ok()).collect()
}

/// [`tetrahedron`], turned by the `seed`: no body is built to suit it.
#[must_use]
pub fn turned_tetrahedron(seed: u64) -> Vec<Direction> {
    let turn: DQuat = Source::new(seed).rotation();
    tetrahedron().into_iter().filter_map(|n| Direction::new(turn * n.get()).ok()).collect()
}

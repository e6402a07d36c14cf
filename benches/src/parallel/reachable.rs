//! What two parallel palms can bring about at all with a body that is known: the check on planners that say that nothing is left to be done.
//!
//! All normals that friction holds at, on a lattice of the sphere, that a way through such normals leads to. No code is shared with the planners.

use exploration::generators::Family;
use exploration::generators::solid;
use exploration::space::SpaceKnowledge;
use exploration::{Heading, Knowledge};
use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::shape_bounds::ContactSample;

/// Normals of the lattice.
const LATTICE: usize = 4000;
/// Normals closer than this, rad, are neighbours: some six of them each.
const NEAR: f64 = 0.09;
/// Every so many of those that can be got to are contacts: 0.11 rad apart, about half of what planners take.
const CONTACT: usize = 4;

/// Everything that can be felt of a body between pads without an end.
#[derive(Clone, Debug)]
pub struct Reachable {
    /// The gap that its contacts prove.
    pub gap: f64,
    /// Their normals: with each its opposite, but for the lattice.
    pub normals: Vec<Direction>,
}

impl Reachable {
    /// Of a body that is held with `up` (body axes) at the upper contact, where palms stop at a ratio of tangential to normal force of `most`.
    #[must_use]
    pub fn of((family, seed): (Family, u64), up: Direction, most: f64) -> Self {
        let body = solid(family, seed);
        let holds = |n: Direction| {
            let span: DVec3 = body(n) - body(-n);
            let width = span.dot(n.get());
            (span - n.get() * width).length() <= most * width
        };
        let lattice: Vec<Direction> = <Direction as Heading>::spread(LATTICE);
        let held: Vec<bool> = lattice.iter().map(|n| holds(*n)).collect();
        let cos = NEAR.cos();
        let is_near = |a: Direction, b: Direction| a.get().dot(b.get()).abs() >= cos;
        let mut reached: Vec<bool> = (0..LATTICE).map(|k| held[k] && is_near(lattice[k], up)).collect();
        let mut open: Vec<usize> = (0..LATTICE).filter(|k| reached[*k]).collect();
        while let Some(k) = open.pop() {
            for other in 0..LATTICE {
                if held[other] && !reached[other] && is_near(lattice[k], lattice[other]) {
                    reached[other] = true;
                    open.push(other);
                }
            }
        }
        let normals: Vec<Direction> = (0..LATTICE).filter(|k| reached[*k]).map(|k| lattice[k]).collect();
        let mut known = SpaceKnowledge::exact();
        for normal in normals.iter().step_by(CONTACT) {
            // Exact contacts of a convex body contradict nothing.
            known
                .insert(ContactSample { point: body(*normal), normal: *normal })
                .expect("a contact of the body");
        }
        Self { gap: known.measures().gap(), normals }
    }

    /// Angle from a direction to the nearest that can be felt, rad.
    #[must_use]
    pub fn distance(&self, along: Direction) -> f64 {
        self.normals.iter().map(|n| n.angle_to(along)).fold(f64::INFINITY, f64::min)
    }
}

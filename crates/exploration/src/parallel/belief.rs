//! What the body may be: bodies drawn from between the bounds.

use super::hold::Held;
use super::workspace::ParallelWorkspace;
use crate::goal::Goal;
use crate::knowledge::Knowledge;
use crate::random::Source;
use crate::space::SpaceKnowledge;
use contact_kinematics::Direction;
use glam::DVec3;
use shape_bounds::exact_hull::{HalfSpace, Intersection};
use shape_bounds::{ContactSample, ShapeBounds};

/// A body `(1 - s) L + s U` (Minkowski) of the bounds `L` and `U`: for exact contacts it passes through all of them, with their normals.
pub(super) struct DrawnBody {
    lower: Vec<DVec3>,
    upper: Vec<DVec3>,
    share: f64,
    /// Its contacts where contacts were made.
    contacts: Vec<ContactSample>,
    /// How far the goal is with these.
    left: f64,
}

/// The cube that the upper bound is cut off at before bodies are drawn, in stated sizes from its middle: it has corners that no body of that size gets to.
const ROOM: f64 = 0.75;
/// Slopes of the width are means over so many rad: a drawn body has corners, which the true one is not thought to have.
const SMOOTH: f64 = 0.25;

impl Held for DrawnBody {
    fn farthest(&self, along: Direction) -> DVec3 {
        let u = along.get();
        let top = |corners: &[DVec3]| {
            corners.iter().copied().max_by(|a, b| a.dot(u).total_cmp(&b.dot(u))).unwrap_or(DVec3::ZERO)
        };
        top(&self.lower).lerp(top(&self.upper), self.share)
    }

    fn shear(&self, along: Direction) -> f64 {
        let u = along.get();
        let width = |u: DVec3| match Direction::new(u) {
            Ok(n) => (self.farthest(n) - self.farthest(-n)).dot(n.get()),
            Err(_) => 0.0,
        };
        let (e, f) = along.tangent_basis();
        let (sin, cos) = SMOOTH.sin_cos();
        let slope = |e: DVec3| (width(u * cos + e * sin) - width(u * cos - e * sin)) / (2.0 * SMOOTH);
        let middle = width(u);
        if middle > 0.0 { slope(e).hypot(slope(f)) / middle } else { f64::INFINITY }
    }
}

impl DrawnBody {
    /// What its contacts along `normals` bring: by how much the goal's quantity goes down.
    pub(super) fn gain(&self, normals: &[Direction], goal: &Goal<Direction>) -> f64 {
        if normals.is_empty() {
            return 0.0;
        }
        let mut contacts = self.contacts.clone();
        contacts.extend(normals.iter().map(|n| ContactSample { point: self.farthest(*n), normal: *n }));
        (self.left - left(contacts, goal)).max(0.0)
    }
}

/// How far the goal is with exact contacts; as far as can be where they bound nothing.
fn left(contacts: Vec<ContactSample>, goal: &Goal<Direction>) -> f64 {
    let known = SpaceKnowledge::of_exact(contacts);
    known.map_or(f64::INFINITY, |known| known.progress(goal))
}

/// `count` bodies of the `seed`; none while the upper bound has no end.
pub(super) fn drawn(
    known: &SpaceKnowledge,
    workspace: &ParallelWorkspace,
    goal: &Goal<Direction>,
    count: usize,
    seed: u64,
) -> Vec<DrawnBody> {
    let Some((lower, upper)) = known.bounds().and_then(|bounds| corners(bounds, workspace)) else {
        return Vec::new();
    };
    let mut source = Source::new(seed);
    let one = |k: usize| {
        // One from each of equal parts, so that few bodies are spread.
        let share = (k as f64 + source.unit()) / count as f64;
        let mut body =
            DrawnBody { lower: lower.clone(), upper: upper.clone(), share, contacts: Vec::new(), left: 0.0 };
        let touched = |c: &ContactSample| ContactSample { point: body.farthest(c.normal), normal: c.normal };
        body.contacts = known.contacts().iter().map(touched).collect();
        body.left = left(body.contacts.clone(), goal);
        body
    };
    (0..count).map(one).filter(|body| body.left.is_finite()).collect()
}

/// Corners of both bounds, of the upper one within its room.
fn corners(bounds: &ShapeBounds, workspace: &ParallelWorkspace) -> Option<(Vec<DVec3>, Vec<DVec3>)> {
    let (lower, upper) = (bounds.lower().solid()?, bounds.upper().bounded()?);
    let centre = lower.vertices().iter().copied().sum::<DVec3>() / lower.vertices().len() as f64;
    let walls = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let wall = |along: DVec3| {
        let normal = Direction::new(along).ok()?;
        // What is felt is within the room, however wrong the stated size is.
        let felt = lower.vertices().iter().map(|v| (*v - centre).dot(along)).fold(0.0, f64::max);
        let reach = (ROOM * workspace.size).max(1.1 * felt);
        Some(HalfSpace { point: centre + along * reach, normal, margin: 0.0 })
    };
    let mut all: Vec<HalfSpace> = upper.face_half_spaces().to_vec();
    all.extend(walls.filter_map(wall));
    let room = Intersection::of(&all).ok()?;
    Some((lower.vertices().to_vec(), room.bounded()?.vertices().to_vec()))
}

//! What the body may be: cells between the bounds, and bodies drawn from them.

use super::balance::{RollingBody, settle};
use super::drawn::DrawnBody;
use super::dynamics::{Dynamics, Swing};
use super::gain::Cell;
use super::track::Track;
use super::workspace::{Workspace, pair};
use crate::planar::PlanarKnowledge;
use crate::random::Source;
use glam::DVec2;
use shape_bounds::planar::{ContactSample, ShapeBounds};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Cells, bodies, and where each of them lies now.
pub(super) struct Belief {
    pub(super) cells: Arc<Vec<Cell>>,
    pub(super) bodies: Vec<DrawnBody>,
    /// Orientations in rad and angular velocities in rad/s.
    pub(super) swings: Vec<Swing>,
    /// How they move, if they are not let come to rest.
    pub(super) dynamics: Option<Dynamics>,
    /// Contacts nearer to one that there is are not taken, rad.
    pub(super) spacing: f64,
}

/// Sides of the polygon that stands for the upper bound while that has no end.
const SIDES: usize = 12;
/// Its radius over half the body's stated mean width, about where the first contacts say that the middle is.
const ROOM: f64 = 1.3;
/// Sides shorter than this, over the stated size, are rounding.
const SHORT: f64 = 1e-9;

impl Belief {
    /// `count` bodies of the `seed`, at rest on the palms where `track` says.
    pub(super) fn draw(
        known: &PlanarKnowledge,
        track: &Track,
        workspace: &Workspace,
        spacing: f64,
        count: usize,
        seed: u64,
    ) -> Self {
        let cells = Arc::new(cells(known, workspace.size));
        let mut source = Source::new(seed);
        let dynamics = track.dynamics;
        let mut belief = Self { cells, bodies: Vec::new(), swings: Vec::new(), dynamics, spacing };
        for _ in 0..count {
            let body = DrawnBody::draw(&belief.cells, &mut source);
            let centre = track.centre(body.centre());
            let body = body.with_centre(centre);
            let rest = || pair(track.palms).and_then(|palms| settle(&body, &palms, track.phi));
            let swing = match dynamics {
                Some(dynamics) => Some((track.phi, dynamics.omega)),
                None => rest().map(|rest| (rest.phi, 0.0)),
            };
            if let Some(swing) = swing {
                belief.bodies.push(body);
                belief.swings.push(swing);
            }
        }
        belief
    }

    /// Area between the bounds, m^2.
    pub(super) fn between(&self) -> f64 {
        self.cells.iter().map(|c| c.area).sum()
    }
}

/// The cells of the bounds; while the upper one has no end, within a polygon about the stated size.
fn cells(known: &PlanarKnowledge, size: f64) -> Vec<Cell> {
    let contacts = known.contacts();
    let upper = known.bounds().map(ShapeBounds::upper).and_then(|upper| upper.bounded());
    // Corners, and whether a contact made the side that starts there.
    let ring: Vec<(DVec2, bool)> = match upper {
        Some(region) => region.shape().vertices().iter().map(|v| (*v, true)).collect(),
        None => contacts.iter().fold(room(contacts, size), |ring, c| clipped(&ring, c)),
    };
    let next = ring.iter().cycle().skip(1);
    let long = |((a, _), (b, _)): &(&(DVec2, bool), &(DVec2, bool))| a.distance(*b) > SHORT * size;
    let sides: Vec<(DVec2, DVec2, bool)> =
        ring.iter().zip(next).filter(long).map(|(a, b)| (a.0, b.0, a.1)).collect();
    let touch = |(a, b, real): &(DVec2, DVec2, bool)| {
        let n = -(*b - *a).perp();
        let farthest = contacts.iter().map(|c| c.point).max_by(|x, y| x.dot(n).total_cmp(&y.dot(n)));
        let share = match farthest {
            Some(x) if *real => ((x - *a).dot(*b - *a) / (*b - *a).length_squared()).clamp(0.0, 1.0),
            _ => 0.5,
        };
        (a.lerp(*b, share), n.to_angle())
    };
    let touched: Vec<(DVec2, f64)> = sides.iter().map(touch).collect();
    let mut angle = touched.first().map_or(0.0, |t| t.1);
    let mut all = Vec::with_capacity(touched.len());
    let real = |k: usize| sides[k % sides.len()].2;
    for (k, ((p, a), (q, b))) in touched.iter().zip(touched.iter().cycle().skip(1)).enumerate() {
        let (from, corner) = (angle, sides[k].1);
        angle += (b - a).rem_euclid(TAU);
        let area = 0.5 * (corner - *p).perp_dot(*q - *p).max(0.0);
        all.push(Cell { from, to: angle, points: [*p, *q], corner, real: [real(k), real(k + 1)], area });
    }
    all
}

/// A polygon that holds all contacts, of the stated size, about the point that is half of it behind the first contacts.
fn room(contacts: &[ContactSample], size: f64) -> Vec<(DVec2, bool)> {
    let behind = |c: &ContactSample| c.point - c.normal.get() * (0.5 * size);
    let few = contacts.len().clamp(1, 2);
    let middle = contacts.iter().take(2).map(behind).sum::<DVec2>() / few as f64;
    let step = TAU / SIDES as f64;
    let line = |k: usize| {
        let n = DVec2::from_angle(step * k as f64);
        let reach = contacts.iter().map(|c| (c.point - middle).dot(n)).fold(0.0, f64::max);
        (n, (0.5 * ROOM * size).max(1.02 * reach + 0.02 * size))
    };
    let corner = |k: usize| {
        let ((n, a), (m, b)) = (line(k), line((k + 1) % SIDES));
        // Where n . x = a and m . x = b.
        (middle + (m.perp() * -a + n.perp() * b) / n.perp_dot(m), false)
    };
    (0..SIDES).map(corner).collect()
}

/// What of a convex polygon is behind the tangent of a contact; all of it if nothing would be.
fn clipped(ring: &[(DVec2, bool)], contact: &ContactSample) -> Vec<(DVec2, bool)> {
    let height = |v: DVec2| (v - contact.point).dot(contact.normal.get());
    let mut kept = Vec::with_capacity(ring.len() + 1);
    for ((a, real), (b, _)) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        let (ha, hb) = (height(*a), height(*b));
        let meets = || a.lerp(*b, ha / (ha - hb));
        if ha <= 0.0 {
            kept.push((*a, *real));
            if hb > 0.0 {
                kept.push((meets(), true));
            }
        } else if hb <= 0.0 && hb < ha {
            kept.push((meets(), *real));
        }
    }
    if kept.len() < 3 { ring.to_vec() } else { kept }
}

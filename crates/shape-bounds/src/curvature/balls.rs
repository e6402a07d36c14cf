//! The intersection of balls of one radius.

use super::circle::Circle;
use super::error::CurvatureError;
use super::face::{Arc, Clipped, clip};
use super::measure::face_moments;
use crate::hull::{PointsError, insertion_order};
use crate::integrals::Compensated;
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use glam::DVec3;

/// By how much a contact may be outside of another's ball, relative to the radius, before it is an error: rounding.
const ROUNDING: f64 = 1e-12;

/// The intersection of balls of one radius, each touching from outside at a known point of the body: an upper bound of a
/// body that rolls freely inside of such a ball.
///
/// Balls are inserted one by one; each cuts the faces that it meets along circles. A ball that would cut the surface
/// inconsistently, which only rounding can cause, is left out and counted: that leaves the bound valid.
#[derive(Clone, Debug, PartialEq)]
pub struct BallIntersection {
    radius: f64,
    interior: DVec3,
    /// Centres in the caller's order.
    centres: Vec<DVec3>,
    faces: Vec<Face>,
    skipped: usize,
}

#[derive(Clone, Debug, PartialEq)]
enum Face {
    /// The ball does not touch the surface.
    Hidden,
    /// The ball is the whole intersection.
    Whole,
    /// The face's edges, in order around it.
    Bounded(Vec<Arc>),
}

impl BallIntersection {
    /// The intersection of the balls of `radius` that touch at `contacts`, each centred at `point - radius normal`.
    ///
    /// # Errors
    /// [`CurvatureError::TooFlat`] names a contact outside of another's ball; [`CurvatureError::Points`] for no contacts or
    /// values that are not finite.
    pub fn through_contacts(contacts: &[ContactSample], radius: f64) -> Result<Self, CurvatureError> {
        if contacts.is_empty() {
            return Err(PointsError::Empty.into());
        }
        if let Some(index) = contacts.iter().position(|c| !c.point.is_finite()) {
            return Err(PointsError::NotFinite { index, point: contacts[index].point }.into());
        }
        if !(radius.is_finite() && radius > 0.0) {
            return Err(CurvatureError::Radii { min: 0.0, max: radius });
        }
        let points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
        let centres = contacts.iter().map(|c| c.point - c.normal.get() * radius).collect();
        Self::build(centres, &points, radius)
    }

    /// The intersection of balls about `centres`; `touching[k]` is a point on sphere `k` in all balls.
    fn build(centres: Vec<DVec3>, touching: &[DVec3], radius: f64) -> Result<Self, CurvatureError> {
        let interior = touching.iter().sum::<DVec3>() / touching.len() as f64;
        let order = insertion_order(touching);
        let faces = vec![Face::Hidden; centres.len()];
        let mut all = Self { radius, interior, centres, faces, skipped: 0 };
        all.faces[order[0] as usize] = Face::Whole;
        let mut hint = order[0];
        for &p in &order[1..] {
            hint = all.insert(p, touching[p as usize], hint);
        }
        for &p in &order {
            hint = all.face_along(touching[p as usize], hint);
            let excess = all.excess_of(hint, touching[p as usize]);
            if excess > ROUNDING * radius {
                return Err(CurvatureError::TooFlat {
                    sample: p as usize,
                    other: hint as usize,
                    excess,
                    radius,
                });
            }
        }
        Ok(all)
    }

    /// Takes ball `p`, which touches at `at`, into the intersection; returns where the next search starts.
    fn insert(&mut self, p: u32, at: DVec3, hint: u32) -> u32 {
        let seen = self.face_along(at, hint);
        let centre = self.centres[p as usize];
        if centre == self.centres[seen as usize] {
            return seen;
        }
        let direction = (at - self.interior).normalize();
        let hit = self.interior + direction * self.reach(seen, direction);
        let cut_off = hit.distance_squared(centre) > self.radius * self.radius;
        if !cut_off {
            // Implied by the others at its own contact.
            return seen;
        }
        if self.faces[seen as usize] == Face::Whole {
            return self.make_lens(seen, p);
        }
        match self.clipped_by(p, seen) {
            Some((changes, own)) => {
                for (k, face) in changes {
                    self.faces[k as usize] = face;
                }
                self.faces[p as usize] = Face::Bounded(own);
                p
            }
            None => {
                self.skipped += 1;
                seen
            }
        }
    }

    /// The intersection of the first two balls.
    fn make_lens(&mut self, k: u32, p: u32) -> u32 {
        let circle = Circle::between(self.centres[k as usize], self.centres[p as usize], self.radius);
        let start = circle.middle + circle.axis.any_orthonormal_vector() * circle.radius;
        self.faces[k as usize] = Face::Bounded(vec![Arc { other: p, start }]);
        self.faces[p as usize] = Face::Bounded(vec![Arc { other: k, start }]);
        p
    }

    /// The faces that ball `p` changes, found from face `seen` across cut edges, and the arcs of its own face; `None` when
    /// the new edges do not close.
    #[expect(clippy::type_complexity, reason = "two lists that are used once")]
    fn clipped_by(&self, p: u32, seen: u32) -> Option<(Vec<(u32, Face)>, Vec<Arc>)> {
        let mut queue = vec![seen];
        let mut changes = Vec::new();
        // The new edges as the faces see them: face, from, to.
        let mut edges: Vec<(u32, DVec3, DVec3)> = Vec::new();
        let mut next = 0;
        while next < queue.len() {
            let k = queue[next];
            next += 1;
            let Face::Bounded(arcs) = &self.faces[k as usize] else { return None };
            let touched = |other| {
                if !queue.contains(&other) {
                    queue.push(other);
                }
            };
            match clip(&self.centres, self.radius, k, arcs, p, touched) {
                Clipped::Kept => {}
                Clipped::Gone => changes.push((k, Face::Hidden)),
                Clipped::Cut { arcs, news } => {
                    edges.extend(news.into_iter().map(|(from, to)| (k, from, to)));
                    changes.push((k, Face::Bounded(arcs)));
                }
                Clipped::Inconsistent => return None,
            }
        }
        // In the new face the edges run the other way: from `to` to `from`, where the next one begins.
        let &(first, start, _) = edges.first()?;
        let mut own = Vec::with_capacity(edges.len());
        let (mut k, mut ends) = (first, start);
        for _ in 0..edges.len() {
            let at = edges.iter().position(|e| e.0 == k && e.1 == ends)?;
            let (_, from, to) = edges[at];
            own.push(Arc { other: k, start: to });
            let following = edges.iter().find(|e| e.2 == from)?;
            (k, ends) = (following.0, following.1);
        }
        (k == first && ends == start).then_some((changes, own))
    }

    /// The face that the ray from the interior through `at` meets, by descent over neighbours of the distance to the
    /// spheres, whose minimum is met there.
    fn face_along(&self, at: DVec3, start: u32) -> u32 {
        let direction = (at - self.interior).normalize_or_zero();
        let mut face = start;
        let mut reach = self.reach(face, direction);
        while let Face::Bounded(arcs) = &self.faces[face as usize] {
            let mut next = face;
            for arc in arcs {
                let candidate = self.reach(arc.other, direction);
                if candidate < reach {
                    (reach, next) = (candidate, arc.other);
                }
            }
            if next == face {
                break;
            }
            face = next;
        }
        face
    }

    /// Distance from the interior along `direction` to sphere `k`; only compared with others.
    fn reach(&self, k: u32, direction: DVec3) -> f64 {
        let b = self.centres[k as usize] - self.interior;
        let along = b.dot(direction);
        along + (along * along + self.radius * self.radius - b.length_squared()).max(0.0).sqrt()
    }

    fn excess_of(&self, k: u32, point: DVec3) -> f64 {
        point.distance(self.centres[k as usize]) - self.radius
    }

    /// Radius of the balls, in m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Balls that carry a face, by index into the contacts.
    pub fn face_sources(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.faces.len()).filter(|k| self.faces[*k] != Face::Hidden)
    }

    /// Balls left out because rounding made their edges inconsistent; the bound holds without them.
    #[must_use]
    pub fn skipped(&self) -> usize {
        self.skipped
    }

    /// Corners, once for each face at them.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.faces
            .iter()
            .flat_map(|face| match face {
                Face::Bounded(arcs) => arcs.as_slice(),
                _ => &[],
            })
            .map(|arc| arc.start)
    }

    /// Volume in m^3: the sum over the faces of `(rho A + (c - o) . N) / 3` with the face's area `A` and vector area `N`,
    /// both as integrals along its edges.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let mut threefold = Compensated::default();
        for (k, face) in self.faces.iter().enumerate() {
            let (area, vector) = match face {
                Face::Hidden => continue,
                Face::Whole => (4.0 * std::f64::consts::PI * self.radius * self.radius, DVec3::ZERO),
                Face::Bounded(arcs) => face_moments(&self.centres, self.radius, k as u32, arcs),
            };
            threefold.add(self.radius * area + (self.centres[k] - self.interior).dot(vector));
        }
        threefold.value() / 3.0
    }

    /// Whether `point` is in all balls, to rounding.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.face_sources().all(|k| self.excess_of(k as u32, point) <= ROUNDING * self.radius)
    }

    /// Support function in m: over faces, arcs and corners, in time O(n).
    #[must_use]
    pub fn support(&self, n: Direction) -> f64 {
        let n = n.get();
        let rho = self.radius;
        let mut best = f64::NEG_INFINITY;
        for (k, face) in self.faces.iter().enumerate() {
            let top = self.centres[k] + n * rho;
            let arcs = match face {
                Face::Hidden => continue,
                Face::Whole => return top.dot(n),
                Face::Bounded(arcs) => arcs,
            };
            if arcs.iter().all(|arc| self.excess_of(arc.other, top) <= 0.0) {
                return top.dot(n);
            }
            for (i, arc) in arcs.iter().enumerate() {
                best = best.max(arc.start.dot(n));
                let end = arcs[(i + 1) % arcs.len()].start;
                let circle = Circle::between(self.centres[k], self.centres[arc.other as usize], rho);
                let across = n - circle.axis * n.dot(circle.axis);
                if across.length_squared() > 0.0 {
                    let highest = circle.middle + across.normalize() * circle.radius;
                    if circle.angle(arc.start, highest) < circle.angle(arc.start, end) {
                        best = best.max(highest.dot(n));
                    }
                }
            }
        }
        best
    }
}

//! What a half-space would cut off the upper bound, and a point would add to the lower one, without making either anew.

use crate::touching::climbed;
use glam::DVec3;
use shape_bounds::exact_hull::{Polyhedron, SolidHull};

/// Marks of what was met, of which a new search forgets all at once.
struct Marks {
    met: Vec<u32>,
    search: u32,
}

impl Marks {
    fn new(count: usize) -> Self {
        Self { met: vec![0; count], search: 0 }
    }

    fn forget(&mut self) {
        self.search += 1;
    }

    /// Marks an item; whether it was not marked before.
    fn mark(&mut self, item: usize) -> bool {
        let new = self.met[item] != self.search;
        self.met[item] = self.search;
        new
    }
}

/// Caps of the upper bound.
pub(super) struct Caps<'a> {
    upper: &'a Polyhedron,
    corners: Marks,
    faces: Marks,
    above: Vec<u32>,
    touched: Vec<u32>,
    outline: Vec<DVec3>,
}

impl<'a> Caps<'a> {
    pub(super) fn new(upper: &'a Polyhedron) -> Self {
        let (corners, faces) = (Marks::new(upper.vertices().len()), Marks::new(upper.face_count()));
        Self { upper, corners, faces, above: Vec::new(), touched: Vec::new(), outline: Vec::new() }
    }

    /// The corner farthest along `u`, by climbing from `start`.
    pub(super) fn summit(&self, u: DVec3, start: u32) -> u32 {
        let (vertices, around) = (self.upper.vertices(), self.upper.vertex_neighbours());
        climbed(
            vertices.len(),
            start as usize,
            |v| around[v].map(|next| next as usize),
            |v| vertices[v].dot(u),
            |v| vertices[v].abs().max_element(),
        ) as u32
    }

    /// Volume of the upper bound where `u . y > t`, in m^3; `summit` is the corner farthest along `u`.
    ///
    /// By the divergence theorem about a point of the cutting plane, whose own face adds nothing then.
    pub(super) fn volume_beyond(&mut self, u: DVec3, t: f64, summit: u32) -> f64 {
        let top = self.upper.vertices()[summit as usize];
        let rise = top.dot(u) - t;
        if rise <= 0.0 {
            return 0.0;
        }
        self.find_above(u, t, summit);
        let reference = top - u * rise;
        let faces = std::mem::take(&mut self.touched);
        let volume = faces.iter().map(|face| self.cone(*face, u, t, reference)).sum();
        self.touched = faces;
        volume
    }

    /// Corners above the plane and the faces at them.
    fn find_above(&mut self, u: DVec3, t: f64, summit: u32) {
        self.corners.forget();
        self.faces.forget();
        self.touched.clear();
        self.corners.mark(summit as usize);
        self.above.push(summit);
        while let Some(corner) = self.above.pop() {
            for face in self.upper.faces_at(corner as usize) {
                if self.faces.mark(face as usize) {
                    self.touched.push(face);
                }
            }
            for next in self.upper.vertex_neighbours()[corner as usize] {
                if self.upper.vertices()[next as usize].dot(u) > t && self.corners.mark(next as usize) {
                    self.above.push(next);
                }
            }
        }
    }

    /// Volume between a face's part above the plane and `reference`.
    fn cone(&mut self, face: u32, u: DVec3, t: f64, reference: DVec3) -> f64 {
        let vertices = self.upper.vertices();
        self.outline.clear();
        let mut ring = self.upper.face(face as usize).map(|v| vertices[v as usize]);
        let Some(first) = ring.next() else { return 0.0 };
        let mut previous = first;
        for corner in ring.chain(std::iter::once(first)) {
            let (from, to) = (previous.dot(u) - t, corner.dot(u) - t);
            if from > 0.0 {
                self.outline.push(previous);
            }
            if (from > 0.0) != (to > 0.0) {
                // Of opposite signs or one of them zero, so that their difference is not.
                self.outline.push(previous + (corner - previous) * (from / (from - to)));
            }
            previous = corner;
        }
        let Some(origin) = self.outline.first().copied() else { return 0.0 };
        let twice: DVec3 = self.outline.windows(2).map(|w| (w[0] - origin).cross(w[1] - origin)).sum();
        (origin - reference).dot(twice) / 6.0
    }
}

/// Growth of the lower bound.
pub(super) struct Growth<'a> {
    lower: &'a SolidHull,
    facets: Marks,
    queue: Vec<u32>,
}

impl<'a> Growth<'a> {
    pub(super) fn new(lower: &'a SolidHull) -> Self {
        Self { lower, facets: Marks::new(lower.triangles().len()), queue: Vec::new() }
    }

    /// Volume in m^3 by which the hull grows when it takes `point`; `near` is a corner of a facet that the point sees, if it sees
    /// any: the farthest corner along the direction from the hull to the point is one.
    ///
    /// The sum over the facets that the point sees of the tetrahedra over them, exactly.
    pub(super) fn volume_with(&mut self, point: DVec3, near: u32) -> f64 {
        self.facets.forget();
        self.queue.clear();
        self.queue.extend(self.lower.facets_around(near));
        for k in 0..self.queue.len() {
            self.facets.mark(self.queue[k] as usize);
        }
        let mut volume = 0.0;
        while let Some(facet) = self.queue.pop() {
            let [a, b, c] = self.lower.corners(facet as usize);
            let over = (b - a).cross(c - a).dot(point - a);
            if over > 0.0 {
                volume += over;
                for next in self.lower.neighbours()[facet as usize] {
                    if self.facets.mark(next as usize) {
                        self.queue.push(next);
                    }
                }
            }
        }
        volume / 6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Source;
    use contact_kinematics::Direction;
    use shape_bounds::exact_hull::{HalfSpace, Hull, Intersection};
    use shape_bounds::{ContactSample, ShapeBounds};

    fn touched(source: &mut Source, count: usize) -> (Vec<ContactSample>, ShapeBounds) {
        let axes = DVec3::new(2.5, 1.5, 1.0);
        let contact = |n: Direction| ContactSample {
            point: axes * axes * n.get() / (axes * n.get()).length(),
            normal: n,
        };
        let contacts: Vec<_> = (0..count).map(|_| contact(source.direction())).collect();
        let bounds = ShapeBounds::from_contacts(&contacts).unwrap();
        (contacts, bounds)
    }

    /// Oracle: the bounds made anew.
    #[test]
    fn caps_and_growth_are_those_of_new_bounds() {
        let mut source = Source::new(7);
        let mut compared = 0;
        for count in [12, 30, 100] {
            let (contacts, bounds) = touched(&mut source, count);
            let Some(upper) = bounds.upper().bounded() else { continue };
            let lower = bounds.lower().solid().unwrap();
            let (mut caps, mut growth) = (Caps::new(upper), Growth::new(lower));
            let planes: Vec<HalfSpace> = contacts.iter().map(ContactSample::half_space).collect();
            for _ in 0..40 {
                let u = source.direction();
                let summit = caps.summit(u.get(), 0);
                let (low, high) = bounds.support(u);
                assert!((upper.vertices()[summit as usize].dot(u.get()) - high).abs() < 1e-12);
                let t = source.between(low, high);
                let cut = HalfSpace {
                    point: upper.vertices()[summit as usize] - u.get() * (high - t),
                    normal: u,
                    margin: 0.0,
                };
                let mut all = planes.clone();
                all.push(cut);
                let Ok(Intersection::Bounded(rest)) = Intersection::of(&all) else { panic!("unbounded") };
                let removed = caps.volume_beyond(u.get(), t, summit);
                assert!((removed - (upper.volume() - rest.volume())).abs() < 1e-10, "{removed}");

                let support = lower.vertices().iter().enumerate();
                let near = support.max_by(|a, b| a.1.dot(u.get()).total_cmp(&b.1.dot(u.get()))).unwrap().0;
                let point = lower.vertices()[near] + u.get() * source.between(0.0, 1.0);
                let mut points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
                points.push(point);
                let grown = Hull::of(&points).unwrap();
                let added = growth.volume_with(point, near as u32);
                assert!((added - (grown.solid().unwrap().volume() - lower.volume())).abs() < 1e-10);
                compared += 1;
            }
        }
        assert!(compared >= 80);
    }
}

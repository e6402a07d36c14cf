use super::Polyhedron;
use crate::HalfSpace;
use glam::DVec3;

/// Corners whose heights differ by less than this part of the body's size are level.
const PLATEAU: f64 = 1e-10;

/// Finds the parts of a polyhedron beyond planes.
#[derive(Clone, Debug)]
pub struct Caps<'a> {
    body: &'a Polyhedron,
    /// The search at which a corner was last met.
    met: Vec<u32>,
    search: u32,
    /// A corner of the last cap.
    corner: u32,
    stack: Vec<u32>,
}

impl Polyhedron {
    /// What planes cut off, plane after plane.
    #[must_use]
    pub fn caps(&self) -> Caps<'_> {
        Caps { body: self, met: vec![0; self.vertices().len()], search: 0, corner: 0, stack: Vec::new() }
    }
}

impl Caps<'_> {
    /// The largest distance from `from` of a point of the polyhedron on or beyond the plane; zero if there is none.
    pub fn reach(&mut self, plane: &HalfSpace, from: DVec3) -> f64 {
        let mut reach = 0.0_f64;
        self.each_corner(plane, |p| reach = reach.max(p.distance_squared(from)));
        reach.sqrt()
    }

    /// A ball about the part of the polyhedron on or beyond the plane; `None` if there is none.
    pub fn ball(&mut self, plane: &HalfSpace) -> Option<(DVec3, f64)> {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        self.each_corner(plane, |p| (low, high) = (low.min(p), high.max(p)));
        if low.x > high.x {
            return None;
        }
        let centre = 0.5 * (low + high);
        Some((centre, self.reach(plane, centre)))
    }

    /// The corners of the part of the polyhedron on or beyond the plane.
    fn each_corner(&mut self, plane: &HalfSpace, mut visit: impl FnMut(DVec3)) {
        let vertices = self.body.vertices();
        let neighbours = self.body.vertex_neighbours();
        let top = self.climb(plane);
        if plane.excess(vertices[top as usize]) < 0.0 {
            return;
        }
        self.search += 1;
        self.met[top as usize] = self.search;
        self.stack.push(top);
        while let Some(corner) = self.stack.pop() {
            let here = vertices[corner as usize];
            let inside = plane.excess(here);
            visit(here);
            for next in neighbours[corner as usize] {
                let there = vertices[next as usize];
                let outside = plane.excess(there);
                if outside >= 0.0 {
                    if self.met[next as usize] != self.search {
                        self.met[next as usize] = self.search;
                        self.stack.push(next);
                    }
                } else {
                    // The edge leaves the cap where it crosses the plane.
                    visit(here + (there - here) * (inside / (inside - outside)));
                }
            }
        }
    }

    /// How far the polyhedron reaches beyond the plane; negative if it stays below.
    pub fn height(&mut self, plane: &HalfSpace) -> f64 {
        let top = self.climb(plane);
        plane.excess(self.body.vertices()[top as usize])
    }

    /// The corner farthest along the plane's normal, to [`PLATEAU`].
    fn climb(&mut self, plane: &HalfSpace) -> u32 {
        let vertices = self.body.vertices();
        loop {
            let here = plane.excess(vertices[self.corner as usize]);
            let mut best = (here, self.corner);
            for v in self.body.vertex_neighbours()[self.corner as usize] {
                let candidate = plane.excess(vertices[v as usize]);
                if candidate > best.0 {
                    best = (candidate, v);
                }
            }
            if best.1 == self.corner {
                match self.higher_than_plateau(plane, here) {
                    Some(higher) => best.1 = higher,
                    None => return self.corner,
                }
            }
            self.corner = best.1;
        }
    }

    /// Where many planes meet, their corners coincide but for rounding, and a step may gain nothing: looks at all
    /// corners that are level with the present one and connected with it.
    fn higher_than_plateau(&mut self, plane: &HalfSpace, height: f64) -> Option<u32> {
        let vertices = self.body.vertices();
        let tolerance = PLATEAU * vertices[self.corner as usize].distance(self.body.interior());
        self.search += 1;
        self.met[self.corner as usize] = self.search;
        self.stack.push(self.corner);
        while let Some(corner) = self.stack.pop() {
            for next in self.body.vertex_neighbours()[corner as usize] {
                let candidate = plane.excess(vertices[next as usize]);
                if candidate > height {
                    self.stack.clear();
                    return Some(next);
                }
                if candidate >= height - tolerance && self.met[next as usize] != self.search {
                    self.met[next as usize] = self.search;
                    self.stack.push(next);
                }
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::Intersection;
    use crate::HalfSpace;
    use crate::generators::{AXES, Source, ellipsoid_half_spaces};
    use glam::DVec3;
    use unit_direction::Direction;

    /// Of planes through and beside a body one after the other: how far it reaches beyond each, and what is cut off, is what the intersection with the
    /// half-space beyond the plane says, which goes another way.
    #[test]
    fn caps_are_intersections_with_what_is_beyond_a_plane() {
        let mut source = Source::new(23);
        let normals: Vec<DVec3> = (0..60).map(|_| source.direction()).collect();
        let spaces = ellipsoid_half_spaces(&normals);
        let intersection = Intersection::of(&spaces).unwrap();
        let body = intersection.bounded().unwrap();
        let mut caps = body.caps();
        let (mut cut, mut beside) = (0, 0);
        for _ in 0..200 {
            let normal = Direction::new(source.direction()).unwrap();
            let point = source.normal3() * AXES * 0.6;
            let plane = HalfSpace { point, normal, margin: source.between(-0.1, 0.1) };
            let height = caps.height(&plane);
            let expected = body.support(normal) - normal.get().dot(point) - plane.margin;
            assert!((height - expected).abs() < 1e-12, "{height} {expected}");
            let (from, ball) = (source.normal3(), caps.ball(&plane));
            let reach = caps.reach(&plane, from);
            if height < 0.0 {
                beside += 1;
                assert!(ball.is_none() && reach == 0.0, "{ball:?} {reach}");
                continue;
            }
            let beyond = HalfSpace { normal: -normal, margin: -plane.margin, ..plane };
            let all: Vec<HalfSpace> = spaces.iter().copied().chain([beyond]).collect();
            let cap = Intersection::of(&all).unwrap();
            let cap = cap.bounded().unwrap();
            let farthest = |from: DVec3| cap.vertices().iter().map(|v| v.distance(from)).fold(0.0, f64::max);
            assert!((reach - farthest(from)).abs() < 1e-9, "{reach} {}", farthest(from));
            let (centre, radius) = ball.unwrap();
            assert!((radius - farthest(centre)).abs() < 1e-9, "{radius}");
            cut += 1;
        }
        assert!(cut > 50 && beside > 5, "{cut} {beside}");
    }
}

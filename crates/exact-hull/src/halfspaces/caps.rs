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

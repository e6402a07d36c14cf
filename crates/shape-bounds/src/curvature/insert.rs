//! Taking balls into the intersection, one at a time.

mod replace;

use super::circle::Circle;
use super::support::Climb;
use super::surface::{Corner, NONE, Shape, Surface};
use glam::DVec3;

/// An edge that the new ball's sphere crosses.
#[derive(Clone, Copy)]
struct RimEdge {
    /// The corner that is kept, and which of its edges this is; for an edge that is kept in the middle, the corner at its
    /// other end, which is lost too.
    beyond: (u32, u32),
    /// The corner at the other end.
    lost: u32,
    /// The lost corner and its edge, where the edge is kept in the middle.
    comes_back_from: Option<(u32, u32)>,
    /// The faces on both sides, in the direction of the new corner.
    from: u32,
    to: u32,
}

/// A lost corner whose edges are being looked at: entered through edge `first - 1`, `done` edges after it are dealt with.
#[derive(Clone, Copy)]
struct Visit {
    corner: u32,
    first: u32,
    done: u32,
    edges: u32,
}

/// An intersection that grows by one ball at a time.
pub(super) struct Builder {
    pub(super) surface: Surface,
    pub(super) skipped: usize,
    climb: Climb,
    /// Where the next search starts: a corner that is there.
    hint: u32,
    insertions: u32,
    free: Vec<u32>,
    rim: Vec<RimEdge>,
    visits: Vec<Visit>,
    lost: Vec<u32>,
    /// The new corners, one on each edge of the rim: their places, and their numbers.
    fresh: Vec<DVec3>,
    made: Vec<u32>,
}

/// Where a ball begins to cut.
enum Cut {
    Nowhere,
    /// This corner is outside.
    Corner(u32),
    /// The middle of this corner's edge is outside, and no corner.
    Edge(u32, u32),
    /// Rounding: somewhere in a face, but on none of its edges.
    Inconsistent,
}

impl Builder {
    /// The intersection of the first of the balls about `centres`.
    /// What a ball cuts off by less than `rounding` (m) is left.
    pub(super) fn new(centres: Vec<DVec3>, radius: f64, rounding: f64) -> Self {
        let corner_of = vec![NONE; centres.len()];
        let corners = Vec::with_capacity(2 * centres.len());
        let surface = Surface { radius, rounding, centres, shape: Shape::Ball(0), corners, corner_of };
        Self {
            surface,
            skipped: 0,
            climb: Climb::default(),
            hint: 0,
            insertions: 0,
            free: Vec::new(),
            rim: Vec::new(),
            visits: Vec::new(),
            lost: Vec::new(),
            fresh: Vec::new(),
            made: Vec::new(),
        }
    }

    /// Takes ball `p`, which touches the body at `at`.
    pub(super) fn insert(&mut self, p: u32, at: DVec3) {
        match self.surface.shape {
            Shape::Ball(k) => {
                if self.surface.centre(k).distance(self.surface.centre(p)) > self.surface.rounding {
                    self.surface.shape = Shape::Lens(k, p);
                }
            }
            Shape::Lens(i, j) => {
                if self.cuts_face(i, p, at).is_some() {
                    self.cut_lens(i, j, p);
                }
            }
            Shape::Net => match self.find_cut(p, at) {
                Cut::Nowhere => {}
                Cut::Inconsistent => self.skipped += 1,
                Cut::Corner(corner) => {
                    self.collect_lost(p, corner);
                    self.replace_lost(p);
                }
                Cut::Edge(corner, edge) => {
                    self.split_edge(corner, edge);
                    self.replace_lost(p);
                }
            },
        }
    }

    /// A face that ball `p`, which touches at `at`, cuts; `None` where it cuts none.
    ///
    /// The intersection rolls freely in a ball of the radius: if its farthest point along the normal at `at` is no farther than
    /// `at`, it touches ball `p` there from inside, and lies in it.
    fn cuts_face(&mut self, start: u32, p: u32, at: DVec3) -> Option<u32> {
        let normal = (at - self.surface.centre(p)).normalize_or_zero();
        self.climb.face = start;
        let farthest = self.climb.farthest(&self.surface, normal);
        self.surface.is_outside(p, farthest).then_some(self.climb.face)
    }

    /// Where ball `p` cuts a net: first by climbing from corner to corner away from its centre, where any corner outside will
    /// do; where that ends inside, by the face at the ball's contact.
    fn find_cut(&mut self, p: u32, at: DVec3) -> Cut {
        let surface = &self.surface;
        let centre = surface.centre(p);
        let limit = surface.limit();
        let mut corner = self.hint;
        let mut distance = surface.corners[corner as usize].at.distance_squared(centre);
        while distance <= limit {
            let mut next = corner;
            for neighbour in surface.corners[corner as usize].neighbours {
                let candidate = surface.corners[neighbour as usize].at.distance_squared(centre);
                if candidate > distance {
                    (distance, next) = (candidate, neighbour);
                }
            }
            if next == corner {
                let start = surface.corners[corner as usize].balls[0];
                return self.find_cut_at_contact(p, at, start);
            }
            corner = next;
        }
        Cut::Corner(corner)
    }

    #[cold]
    fn find_cut_at_contact(&mut self, p: u32, at: DVec3, start: u32) -> Cut {
        let Some(face) = self.cuts_face(start, p, at) else { return Cut::Nowhere };
        let surface = &self.surface;
        let Some(first) = surface.corner_on(face) else { return Cut::Inconsistent };
        let (mut corner, mut edge_found) = (first, None);
        loop {
            if surface.is_outside(p, surface.corners[corner as usize].at) {
                return Cut::Corner(corner);
            }
            let balls = surface.corners[corner as usize].balls;
            let (next, _) = surface.next_around(face, corner);
            let edge = ((balls.iter().position(|b| *b == face).unwrap_or(0) + 2) % 3) as u32;
            if edge_found.is_none() && surface.breaks_out(corner, edge, p) {
                edge_found = Some((corner, edge));
            }
            corner = next;
            if corner == first {
                break;
            }
        }
        edge_found.map_or(Cut::Inconsistent, |(corner, edge)| Cut::Edge(corner, edge))
    }

    /// Fills `lost`, and `rim` in cyclic order, by a depth-first visit of the corners outside of ball `p`.
    ///
    /// What equal balls leave of each other's spheres is connected, so what ball `p` cuts off is a disc, the edges in it are
    /// connected, and its rim is one cycle, met in order.
    fn collect_lost(&mut self, p: u32, start: u32) {
        self.insertions += 1;
        let (kept_mark, lost_mark) = (2 * self.insertions, 2 * self.insertions + 1);
        let (surface, visits) = (&mut self.surface, &mut self.visits);
        self.rim.clear();
        self.lost.clear();
        surface.corners[start as usize].mark = lost_mark;
        self.lost.push(start);
        visits.push(Visit { corner: start, first: 0, done: 0, edges: 3 });
        while let Some(visit) = visits.last_mut() {
            if visit.done == visit.edges {
                visits.pop();
                continue;
            }
            let corner = visit.corner;
            let edge = (visit.first + visit.done) % 3;
            visit.done += 1;
            let Corner { balls, neighbours, .. } = surface.corners[corner as usize];
            let beyond = neighbours[edge as usize];
            let (from, to) = (balls[edge as usize], balls[((edge + 1) % 3) as usize]);
            let Corner { at, balls: across, mark, .. } = surface.corners[beyond as usize];
            // The shared edge ends, seen from beyond, where it begins seen from here.
            let back = if across[1] == from {
                0
            } else if across[2] == from {
                1
            } else {
                2
            };
            let mut rim = RimEdge { beyond: (beyond, back), lost: corner, comes_back_from: None, from, to };
            let is_lost = mark == lost_mark || (mark != kept_mark && surface.is_outside(p, at));
            if !is_lost {
                surface.corners[beyond as usize].mark = kept_mark;
                self.rim.push(rim);
            } else if surface.comes_back(corner, edge, p) {
                // Its other end is met on another way.
                rim.comes_back_from = Some((corner, edge));
                self.rim.push(rim);
            } else if mark != lost_mark {
                surface.corners[beyond as usize].mark = lost_mark;
                self.lost.push(beyond);
                visits.push(Visit { corner: beyond, first: back + 1, done: 0, edges: 2 });
            }
        }
    }

    /// Fills `rim` with both ends of an edge that is lost in the middle.
    fn split_edge(&mut self, corner: u32, edge: u32) {
        let Corner { balls, neighbours, .. } = self.surface.corners[corner as usize];
        let (i, j) = (balls[edge as usize], balls[(edge as usize + 1) % 3]);
        let beyond = neighbours[edge as usize];
        let across = self.surface.corners[beyond as usize].balls;
        let back = across.iter().position(|b| *b == j).unwrap_or(0) as u32;
        self.lost.clear();
        self.rim.clear();
        self.rim.push(RimEdge {
            beyond: (corner, edge),
            lost: beyond,
            comes_back_from: None,
            from: j,
            to: i,
        });
        self.rim.push(RimEdge {
            beyond: (beyond, back),
            lost: corner,
            comes_back_from: None,
            from: i,
            to: j,
        });
    }

    /// Ball `p` cuts a lens: its circle in two points, or all of it.
    fn cut_lens(&mut self, i: u32, j: u32, p: u32) {
        let ends = [[i, j, p], [j, i, p]].map(|balls| self.surface.common_point(balls));
        match ends {
            [Some(a), Some(b)] if a != b => {
                self.surface.shape = Shape::Net;
                let (x, y) = (self.add([i, j, p], a), self.add([j, i, p], b));
                self.surface.corners[x as usize].neighbours = [y; 3];
                self.surface.corners[y as usize].neighbours = [x; 3];
                self.hint = x;
            }
            _ => self.surface.shape = self.lens_with(p, &[i, j]),
        }
    }

    /// Ball `p` cuts off every edge: a lens with one of the others is left.
    #[cold]
    fn replace_all(&mut self, p: u32) {
        let faces: Vec<u32> =
            (0..self.surface.centres.len() as u32).filter(|k| self.surface.has_face(*k)).collect();
        self.surface.shape = self.lens_with(p, &faces);
        self.surface.corners.clear();
        self.free.clear();
    }

    /// The lens of ball `p` and that of the others whose circle with it reaches least beyond any other.
    fn lens_with(&self, p: u32, faces: &[u32]) -> Shape {
        let surface = &self.surface;
        let protrusion = |k: u32| {
            let circle = Circle::between(surface.centre(k), surface.centre(p), surface.radius);
            faces
                .iter()
                .filter(|o| **o != k)
                .map(|o| circle.farthest_from(surface.centre(*o)))
                .fold(0.0, f64::max)
        };
        let best = faces.iter().copied().min_by(|a, b| protrusion(*a).total_cmp(&protrusion(*b)));
        best.map_or(surface.shape, |k| Shape::Lens(k, p))
    }
}

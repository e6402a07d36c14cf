//! The incremental hull.

use super::facets::{Facets, NONE};
use super::order::InsertionOrder;
use super::seed::{Seed, find_seed, strict_centre};
use glam::DVec3;

/// An edge of the visible region's rim, as the hidden facet beyond it sees it.
#[derive(Clone, Copy)]
struct RimEdge {
    /// The hidden facet and which of its edges.
    facet: u32,
    edge: u32,
    /// The edge's ends in the direction of the new facet.
    from: u32,
    to: u32,
}

/// A visible facet whose edges are being looked at: entered through `first - 1`, `done` edges after it are dealt with.
#[derive(Clone, Copy)]
struct Visit {
    facet: u32,
    first: u32,
    done: u32,
    edges: u32,
    /// Heights of the point over the facets across the edges, which are fetched together: memory is what takes the time.
    heights: [f64; 3],
}

/// A hull that grows by one point at a time.
pub(super) struct Builder {
    pub(super) facets: Facets,
    /// Where the next search starts: a facet that is there.
    hint: u32,
    insertions: u32,
    rim: Vec<RimEdge>,
    visits: Vec<Visit>,
    visible: Vec<u32>,
}

/// What the points span.
pub(super) enum Built {
    Point(usize),
    Line,
    Plane {
        axis: usize,
    },
    /// The hull, and the original index of each of its points.
    Space(Box<Builder>, Vec<u32>),
}

/// The hull of `points`: finite, not empty, scaled for the predicates.
pub(super) fn build(points: &[DVec3]) -> Built {
    let corners = match find_seed(points) {
        Seed::Point(i) => return Built::Point(i),
        Seed::Line => return Built::Line,
        Seed::Plane { axis } => return Built::Plane { axis },
        Seed::Space(corners) => corners,
    };
    let InsertionOrder { along, places } = InsertionOrder::of(points);
    let sorted = along.iter().map(|i| points[*i as usize]).collect();
    let mut positions = [0; 4];
    for (at, i) in along.iter().enumerate() {
        if let Some(k) = corners.iter().position(|c| *c == *i as usize) {
            positions[k] = at as u32;
        }
    }
    let mut builder = Builder::from_simplex(sorted, positions);
    for place in places {
        builder.insert(place);
    }
    Built::Space(Box::new(builder), along)
}

impl Builder {
    /// A hull of four points (by position), the fourth on the inner side of the first three.
    pub(super) fn from_simplex(points: Vec<DVec3>, [a, b, c, d]: [u32; 4]) -> Self {
        let centre = strict_centre([a, b, c, d].map(|i| points[i as usize]));
        let mut facets = Facets::new(points, centre);
        let corners = [[a, b, c], [a, d, b], [b, d, c], [c, d, a]];
        for vertices in corners {
            facets.add(vertices, 0);
        }
        for (f, vertices) in corners.iter().enumerate() {
            for e in 0..3 {
                let (from, to) = (vertices[e], vertices[(e + 1) % 3]);
                let across =
                    corners.iter().position(|g| (0..3).any(|k| g[k] == to && g[(k + 1) % 3] == from));
                facets.list[f].neighbours[e] = across.map_or(NONE, |g| g as u32);
            }
        }
        Self { facets, hint: 0, insertions: 0, rim: Vec::new(), visits: Vec::new(), visible: Vec::new() }
    }

    /// Takes a point that comes later into the hull; false when the hull holds it already.
    pub(super) fn push(&mut self, point: DVec3) -> bool {
        let p = self.facets.push_point(point);
        self.insert(p)
    }

    /// Takes point `p` into the hull; false when the hull holds it already.
    pub(super) fn insert(&mut self, p: u32) -> bool {
        let Some(seen) = self.facets.find_visible(p, self.hint) else { return false };
        self.insertions += 1;
        self.collect_visible(p, seen);
        self.replace_visible(p);
        true
    }

    /// Fills `visible`, and `rim` in cyclic order, by a depth-first visit of the facets that `p` sees.
    ///
    /// The region is a disc: with exact signs, the facets strictly seen are those seen from `p` moved a little towards
    /// the hull, where nothing is degenerate. Its rim is hence one cycle, met in order.
    fn collect_visible(&mut self, p: u32, seen: u32) {
        let q = self.facets.seen_from_centre(p);
        let (hidden_mark, visible_mark) = (2 * self.insertions, 2 * self.insertions + 1);
        self.rim.clear();
        self.visible.clear();
        self.facets.list[seen as usize].mark = visible_mark;
        self.visible.push(seen);
        self.visit(seen, 0, 3, q);
        while let Some(visit) = self.visits.last_mut() {
            if visit.done == visit.edges {
                self.visits.pop();
                continue;
            }
            let facet = visit.facet;
            let edge = (visit.first + visit.done) % 3;
            let height = visit.heights[visit.done as usize];
            visit.done += 1;
            let beyond = self.facets.list[facet as usize].neighbours[edge as usize];
            let mark = self.facets.list[beyond as usize].mark;
            if mark == visible_mark {
                continue;
            }
            let back = self.edge_towards(beyond, facet, edge);
            if mark != hidden_mark && self.facets.is_visible_at(beyond, p, height) {
                self.facets.list[beyond as usize].mark = visible_mark;
                self.visible.push(beyond);
                self.visit(beyond, back + 1, 2, q);
            } else {
                self.facets.list[beyond as usize].mark = hidden_mark;
                let vertices = self.facets.list[facet as usize].vertices;
                let (from, to) = (vertices[edge as usize], vertices[((edge + 1) % 3) as usize]);
                self.rim.push(RimEdge { facet: beyond, edge: back, from, to });
            }
        }
    }

    /// Begins with the edges of a facet, `edges` of them from `first` on.
    #[inline]
    fn visit(&mut self, facet: u32, first: u32, edges: u32, q: DVec3) {
        let neighbours = self.facets.list[facet as usize].neighbours;
        let heights = [0, 1, 2].map(|k| {
            if k < edges { self.facets.height(neighbours[((first + k) % 3) as usize], q) } else { 0.0 }
        });
        self.visits.push(Visit { facet, first, done: 0, edges, heights });
    }

    /// Which edge of `beyond` is edge `edge` of `facet`. Two facets may share more than one edge, so the vertices decide.
    #[inline]
    fn edge_towards(&self, beyond: u32, facet: u32, edge: u32) -> u32 {
        let from = self.facets.list[facet as usize].vertices[edge as usize];
        let vertices = &self.facets.list[beyond as usize].vertices;
        // The shared edge ends, seen from beyond, where it begins seen from here.
        if vertices[1] == from {
            0
        } else if vertices[2] == from {
            1
        } else {
            2
        }
    }

    /// Puts the cone from `p` over the rim in the place of the visible facets.
    fn replace_visible(&mut self, p: u32) {
        for i in 0..self.visible.len() {
            self.facets.remove(self.visible[i]);
        }
        let mut first = NONE;
        let mut previous = NONE;
        for i in 0..self.rim.len() {
            let RimEdge { facet, edge, from, to } = self.rim[i];
            debug_assert!(self.rim[(i + 1) % self.rim.len()].from == to, "the rim is not one cycle");
            let new = self.facets.add([from, to, p], 2 * self.insertions);
            self.facets.list[new as usize].neighbours[0] = facet;
            self.facets.list[facet as usize].neighbours[edge as usize] = new;
            if previous == NONE {
                first = new;
            } else {
                self.facets.list[new as usize].neighbours[2] = previous;
                self.facets.list[previous as usize].neighbours[1] = new;
            }
            previous = new;
        }
        self.facets.list[first as usize].neighbours[2] = previous;
        self.facets.list[previous as usize].neighbours[1] = first;
        self.hint = first;
    }
}

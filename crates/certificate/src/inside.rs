//! Whether points lie in a closed surface: by exact signs, in a tree of boxes.

use super::star::Star;
use super::surface::{Surface, side};
use glam::DVec3;
use robust::{Coord, orient2d};

/// Triangles of a leaf.
const LEAF: usize = 8;

/// The box of no points.
const NOTHING: (DVec3, DVec3) = (DVec3::INFINITY, DVec3::NEG_INFINITY);

/// A closed surface that is asked for many points.
pub struct Solid<'a> {
    surface: &'a Surface,
    /// Triangles, those of a node side by side.
    order: Vec<u32>,
    nodes: Vec<Node>,
}

struct Node {
    low: DVec3,
    high: DVec3,
    /// Of `order`, for a leaf.
    triangles: std::ops::Range<usize>,
    /// The second child; the first one follows its parent. 0 for a leaf.
    second: usize,
}

impl<'a> Solid<'a> {
    /// Sorts the triangles of a surface into boxes.
    #[must_use]
    pub fn new(surface: &'a Surface) -> Self {
        // Middles beside the numbers: sorted where they lie, without a look at the corners.
        let mut placed: Vec<(DVec3, u32)> = (0..u32::try_from(surface.triangles().len()).unwrap_or(u32::MAX))
            .map(|k| (surface.at(k as usize).iter().sum::<DVec3>(), k))
            .collect();
        let mut solid = Self { surface, order: Vec::new(), nodes: Vec::new() };
        if !placed.is_empty() {
            solid.split(&mut placed, 0);
            solid.order = placed.into_iter().map(|(_, k)| k).collect();
        }
        solid
    }

    /// The node of triangles that stand in `order` from `from` on; returns its box.
    fn split(&mut self, placed: &mut [(DVec3, u32)], from: usize) -> (DVec3, DVec3) {
        let here = self.nodes.len();
        let to = from + placed.len();
        self.nodes.push(Node { low: DVec3::ZERO, high: DVec3::ZERO, triangles: from..to, second: 0 });
        let (low, high) = if placed.len() <= LEAF {
            let corners = placed.iter().flat_map(|(_, k)| self.surface.at(*k as usize));
            corners.fold(NOTHING, |(low, high), c| (low.min(c), high.max(c)))
        } else {
            let (low, high) = placed.iter().fold(NOTHING, |(low, high), (m, _)| (low.min(*m), high.max(*m)));
            let axis = (high - low).max_position();
            let half = placed.len() / 2;
            placed.select_nth_unstable_by(half, |a, b| a.0[axis].total_cmp(&b.0[axis]));
            let (first, second) = placed.split_at_mut(half);
            let first = self.split(first, from);
            self.nodes[here].second = self.nodes.len();
            let second = self.split(second, from + half);
            (first.0.min(second.0), first.1.max(second.1))
        };
        (self.nodes[here].low, self.nodes[here].high) = (low, high);
        (low, high)
    }

    /// Leads over the leaves whose nodes, and all above them, are `wanted`.
    fn leaves(&self, mut wanted: impl FnMut(&Node) -> bool, mut each: impl FnMut(usize)) {
        let mut stack = if self.nodes.is_empty() { vec![] } else { vec![0] };
        while let Some(k) = stack.pop() {
            let node = &self.nodes[k];
            if !wanted(node) {
                continue;
            }
            if node.second == 0 {
                self.order[node.triangles.clone()].iter().for_each(|triangle| each(*triangle as usize));
            } else {
                stack.push(node.second);
                stack.push(k + 1);
            }
        }
    }

    /// How often the surface goes round a point: once for points inside. Counted by the faces that the ray along +x
    /// leaves through; every decision is an exact sign. On the surface itself either answer comes out.
    #[must_use]
    pub fn winding(&self, p: DVec3) -> i32 {
        let may_meet = |low: DVec3, high: DVec3| {
            high.x >= p.x && low.y <= p.y && p.y <= high.y && low.z <= p.z && p.z <= high.z
        };
        let mut count = 0;
        self.leaves(
            |node| may_meet(node.low, node.high),
            |triangle| {
                let corners = self.surface.at(triangle);
                let [a, b, c] = corners;
                if !may_meet(a.min(b).min(c), a.max(b).max(c)) {
                    return;
                }
                let around = winding_in_plane(&corners, p);
                // In front of the point the face has it on its inner side where it faces along the ray.
                if around != 0 && side(corners, p) * f64::from(around) < 0.0 {
                    count += around;
                }
            },
        );
        count
    }

    /// How far a point is from the surface, m.
    #[must_use]
    pub fn distance(&self, p: DVec3) -> f64 {
        let nearest = std::cell::Cell::new(f64::INFINITY);
        let near = |node: &Node| p.clamp(node.low, node.high).distance(p) < nearest.get();
        self.leaves(near, |triangle| {
            nearest.set(nearest.get().min(distance_to_triangle(self.surface.at(triangle), p)));
        });
        nearest.get()
    }

    /// The point of `points` that is farthest outside, and how far, m; `None` where all are inside.
    #[must_use]
    pub fn farthest_outside(&self, points: &[DVec3]) -> Option<(usize, f64)> {
        let corners = self.surface.corners();
        let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
        let star = Star::new(self.surface, middle, |p| self.winding(p));
        let mut at = 0;
        let mut holds = |p: DVec3| {
            let seen = star.as_ref().and_then(|star| star.holds(p, &mut at));
            seen.unwrap_or_else(|| self.winding(p) == 1)
        };
        let outside = points.iter().enumerate().filter(|(_, p)| !holds(**p));
        outside.map(|(k, p)| (k, self.distance(*p))).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// How often a triangle, seen along x, goes round a point: +-1 or 0, the same on either side of a shared edge.
fn winding_in_plane(corners: &[DVec3; 3], p: DVec3) -> i32 {
    let at = |q: DVec3| Coord { x: q.y, y: q.z };
    let of_edge = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        if (a.z <= p.z) == (b.z <= p.z) {
            return 0;
        }
        // Beyond both ends the side is plain; else by exact arithmetic.
        let left = match () {
            () if p.y < a.y.min(b.y) => true,
            () if p.y > a.y.max(b.y) => false,
            () => {
                let turn = orient2d(at(a), at(b), at(p));
                if a.z <= p.z { turn > 0.0 } else { turn < 0.0 }
            }
        };
        i32::from(left && a.z <= p.z) - i32::from(left && a.z > p.z)
    };
    of_edge(0) + of_edge(1) + of_edge(2)
}

fn distance_to_triangle(corners: [DVec3; 3], p: DVec3) -> f64 {
    let [a, b, c] = corners;
    let to_edge = [(a, b), (b, c), (c, a)].map(|(from, to)| {
        let (along, reach) = (to - from, p - from);
        let share = (reach.dot(along) / along.length_squared()).clamp(0.0, 1.0);
        // An edge of no length is a point.
        if share.is_nan() { reach.length() } else { reach.distance(along * share) }
    });
    let nearest = to_edge.into_iter().fold(f64::INFINITY, f64::min);
    let n = (b - a).cross(c - a);
    let above = |from: DVec3, to: DVec3| n.dot((to - from).cross(p - from)) >= 0.0;
    let height = (p - a).dot(n).abs() / n.length();
    if above(a, b) && above(b, c) && above(c, a) && height < nearest { height } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without boxes and without the sides that are plain: every triangle by exact arithmetic.
    fn winding(surface: &Surface, p: DVec3) -> i32 {
        let at = |q: DVec3| Coord { x: q.y, y: q.z };
        let around = |corners: &[DVec3; 3]| -> i32 {
            let edges = [0, 1, 2].map(|k| (corners[k], corners[(k + 1) % 3]));
            let of = |(a, b): (DVec3, DVec3)| match (a.z <= p.z, b.z <= p.z, orient2d(at(a), at(b), at(p))) {
                (true, false, turn) => i32::from(turn > 0.0),
                (false, true, turn) => -i32::from(turn < 0.0),
                _ => 0,
            };
            edges.into_iter().map(of).sum()
        };
        let faces = (0..surface.triangles().len()).map(|k| surface.at(k));
        let passed = |corners: [DVec3; 3]| match around(&corners) {
            around if side(corners, p) * f64::from(around) < 0.0 => around,
            _ => 0,
        };
        faces.map(passed).sum()
    }

    #[test]
    fn a_point_has_the_winding_of_all_triangles_by_exact_signs() {
        // Long slivers, and points whose coordinates are those of corners.
        let surface = crate::tests::net(5, 40, |n| n * DVec3::new(3.0, 0.02, 1.0));
        let solid = Solid::new(&surface);
        let corners = surface.corners();
        for (k, a) in corners.iter().enumerate() {
            let (b, c) = (corners[(7 * k + 3) % corners.len()], corners[(13 * k + 5) % corners.len()]);
            for p in
                [DVec3::new(b.x, a.y, c.z), DVec3::new(0.0, a.y, a.z), (*a + b + c) / 3.0, *a * 0.5, *a * 1.5]
            {
                assert_eq!(solid.winding(p), winding(&surface, p), "{p}");
            }
        }
    }
}

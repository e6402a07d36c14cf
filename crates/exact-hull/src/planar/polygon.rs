use super::Direction;
use crate::predicates::turn;
use glam::DVec2;

/// A convex polygon with an interior, corners in order counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvexPolygon {
    vertices: Vec<DVec2>,
}

impl ConvexPolygon {
    /// From the strict corners of a convex polygon, counter-clockwise, in m; they are taken as they are.
    #[must_use]
    pub fn new(vertices: Vec<DVec2>) -> Self {
        Self { vertices }
    }

    /// Corners in m.
    #[must_use]
    pub fn vertices(&self) -> &[DVec2] {
        &self.vertices
    }

    /// Both ends of each edge; edge `k` starts at corner `k`.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        let next = self.vertices.iter().cycle().skip(1);
        self.vertices.iter().copied().zip(next.copied())
    }

    /// Area in m^2, about the first corner so that distance from the origin costs no digits.
    #[must_use]
    pub fn area(&self) -> f64 {
        let Some(&origin) = self.vertices.first() else { return 0.0 };
        0.5 * self.edges().map(|(a, b)| (a - origin).perp_dot(b - origin)).sum::<f64>()
    }

    /// Length of the outline in m.
    #[must_use]
    pub fn perimeter(&self) -> f64 {
        self.edges().map(|(a, b)| a.distance(b)).sum()
    }

    /// Support function in direction `n`, in m.
    #[must_use]
    pub fn support(&self, n: Direction) -> f64 {
        self.vertices.iter().map(|v| v.dot(n.get())).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether the point is inside or on the outline; exact.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        self.edges().all(|(a, b)| turn(a, b, point) >= 0.0)
    }
}

//! An outline as a closed line through corners, and how far a point is from it.

use glam::DVec2;
use thiserror::Error;

/// Edges that lie in one box; room about it, and what of the square of a distance to it, both of them far more than rounding.
const STRETCH: usize = 16;
const ROUNDING: f64 = 1e-9;
/// Distance from a corner below which its direction says nothing, m.
const AT_CORNER: f64 = 1e-12;

/// A closed line through corners, counter-clockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedLine {
    corners: Vec<DVec2>,
    edges: Vec<Edge>,
    /// Boxes about `STRETCH` edges each, in their order.
    boxes: Vec<[DVec2; 2]>,
}

/// From a corner to the next one: the way there, and its inverse squared length, zero for an edge too short to have one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    from: DVec2,
    to: DVec2,
    along: DVec2,
    inverse_square: f64,
}

impl Edge {
    /// The share of it that lies before its point nearest to another one, that point, and the square of their distance.
    fn nearest(&self, to: DVec2) -> (f64, DVec2, f64) {
        let along = ((to - self.from).dot(self.along) * self.inverse_square).clamp(0.0, 1.0);
        let point = self.from + self.along * along;
        (along, point, point.distance_squared(to))
    }
}

/// Corners that close no line.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ClosedLineError {
    /// Fewer than three.
    #[error("an outline needs at least three corners; there are {found}")]
    TooFew {
        /// How many there are.
        found: usize,
    },
    /// One that is not finite.
    #[error("corner {corner} is ({x}, {y}); it must be finite")]
    NotFinite {
        /// Which, from 0.
        corner: usize,
        /// m.
        x: f64,
        /// m.
        y: f64,
    },
    /// Nothing inside.
    #[error("the outline has an area of {area} m^2; it must go around something")]
    Flat {
        /// m^2.
        area: f64,
    },
}

/// The point of a closed line that is nearest to some point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Distance of that other point, m: positive outside.
    pub distance: f64,
    /// The nearest point of the line.
    pub point: DVec2,
    /// Unit vector out of the object there, towards the other point where that lies outside.
    pub normal: DVec2,
    /// The edge, which begins at the corner of that number.
    pub edge: usize,
    /// Share of the edge that lies before the nearest point.
    pub along: f64,
}

impl ClosedLine {
    /// Through corners in either sense of turning.
    ///
    /// # Errors
    /// [`ClosedLineError`].
    pub fn new(mut corners: Vec<DVec2>) -> Result<Self, ClosedLineError> {
        if corners.len() < 3 {
            return Err(ClosedLineError::TooFew { found: corners.len() });
        }
        if let Some((corner, p)) = corners.iter().enumerate().find(|(_, p)| !p.is_finite()) {
            return Err(ClosedLineError::NotFinite { corner, x: p.x, y: p.y });
        }
        let area = signed_area(&corners);
        if area == 0.0 || !area.is_finite() {
            return Err(ClosedLineError::Flat { area });
        }
        if area < 0.0 {
            corners.reverse();
        }
        let edge = |k: usize| {
            let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
            let along = to - from;
            let inverse = along.length_squared().recip();
            Edge { from, to, along, inverse_square: if inverse.is_finite() { inverse } else { 0.0 } }
        };
        let edges: Vec<Edge> = (0..corners.len()).map(edge).collect();
        let about = |stretch: &[Edge]| {
            let start = [stretch[0].from; 2];
            let [low, high] =
                stretch.iter().fold(start, |[low, high], edge| [low.min(edge.to), high.max(edge.to)]);
            let room = DVec2::splat(ROUNDING * low.abs().max(high.abs()).max_element());
            [low - room, high + room]
        };
        let boxes = edges.chunks(STRETCH).map(about).collect();
        Ok(Self { corners, edges, boxes })
    }

    /// Corners, counter-clockwise.
    #[must_use]
    pub fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// Area inside, m^2.
    #[must_use]
    pub fn area(&self) -> f64 {
        signed_area(&self.corners)
    }

    /// The edges, from corner to corner.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        self.edges.iter().map(|edge| (edge.from, edge.to))
    }

    /// The nearest point of the line.
    #[must_use]
    pub fn nearest(&self, to: DVec2) -> Nearest {
        // No edge of a box is nearer than the box, and none is farther than the nearest one of any box.
        let from_box = |[low, high]: &[DVec2; 2]| to.clamp(*low, *high).distance_squared(to);
        let least = self.boxes.iter().map(from_box).enumerate();
        let least = least.fold((0, f64::INFINITY), |least, now| if now.1 < least.1 { now } else { least });
        let some = if self.boxes.len() > 1 { &self.edges[least.0 * STRETCH..] } else { &[] };
        let around = some.iter().take(STRETCH).map(|edge| edge.nearest(to).2);
        let enough = around.fold(f64::INFINITY, f64::min) * (1.0 + ROUNDING);
        let mut best = (f64::INFINITY, 0, 0.0, DVec2::ZERO);
        let mut inside = false;
        for (k, stretch) in self.edges.chunks(STRETCH).enumerate() {
            let [low, high] = self.boxes[k];
            if (to.y < low.y || to.y > high.y) && from_box(&[low, high]) > enough {
                continue;
            }
            for (k, edge) in (k * STRETCH..).zip(stretch) {
                let (along, point, squared) = edge.nearest(to);
                if squared < best.0 {
                    best = (squared, k, along, point);
                }
                // A ray to the right crosses the line an odd number of times from inside.
                let crosses = (edge.from.y > to.y) != (edge.to.y > to.y);
                if crosses && (edge.along.perp_dot(to - edge.from) > 0.0) == (edge.along.y > 0.0) {
                    inside = !inside;
                }
            }
        }
        let (squared, edge, along, point) = best;
        let distance = squared.sqrt();
        let of_edge = -self.edges[edge].along.perp().normalize_or_zero();
        let between = along > 0.0 && along < 1.0;
        let normal = if between || distance < AT_CORNER {
            of_edge
        } else {
            (to - point) * if inside { -1.0 } else { 1.0 } / distance
        };
        Nearest { distance: if inside { -distance } else { distance }, point, normal, edge, along }
    }
}

/// Half the sum of the cross products: positive counter-clockwise.
fn signed_area(corners: &[DVec2]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    0.5 * corners.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> ClosedLine {
        ClosedLine::new(vec![DVec2::ZERO, DVec2::Y, DVec2::ONE, DVec2::X]).unwrap()
    }

    #[test]
    fn distances_have_the_sign_of_the_side() {
        let square = square();
        assert!((square.area() - 1.0).abs() < 1e-15);
        let out = square.nearest(DVec2::new(0.25, -0.5));
        assert!((out.distance - 0.5).abs() < 1e-15 && out.normal.distance(-DVec2::Y) < 1e-15);
        let within = square.nearest(DVec2::new(0.9, 0.5));
        assert!((within.distance + 0.1).abs() < 1e-15 && within.normal.distance(DVec2::X) < 1e-15);
        // About a corner the normal is that of the way to it.
        let corner = square.nearest(DVec2::new(-0.3, -0.4));
        assert!((corner.distance - 0.5).abs() < 1e-15);
        assert!(corner.normal.distance(DVec2::new(-0.6, -0.8)) < 1e-15);
    }

    /// What boxes leave out is never the nearest edge, nor one that tells inside from outside.
    #[test]
    fn boxes_leave_out_nothing() {
        for (corners, far) in [(3, 0.0), (40, 0.0), (365, 0.0), (365, 1e6)] {
            let turn = |k: usize| std::f64::consts::TAU * k as f64 / corners as f64;
            let radius = |k: usize| 1.0 + 0.3 * (5.0 * turn(k)).sin() + 1e-3 * (91.0 * k as f64).sin();
            let at = |k: usize| DVec2::splat(far) + DVec2::from_angle(turn(k)) * radius(k);
            let line = ClosedLine::new((0..corners).map(at).collect()).unwrap();
            for k in 0..2000 {
                let angle = 0.7 * f64::from(k);
                let place = DVec2::splat(far) + DVec2::from_angle(angle) * (1e-3 * f64::from(k));
                // On the line and beside a corner too.
                let corner = line.corners[k as usize % corners];
                for to in [place, line.nearest(place).point, corner, corner + DVec2::X * 1e-9] {
                    let nearest = line.nearest(to);
                    let each = line.edges.iter().map(|edge| edge.nearest(to).2);
                    let least = each.clone().fold(f64::INFINITY, f64::min);
                    assert_eq!(Some(nearest.edge), each.clone().position(|squared| squared == least));
                    let crossings = line.edges.iter().filter(|edge| {
                        let over = (edge.from.y > to.y) != (edge.to.y > to.y);
                        over && (edge.along.perp_dot(to - edge.from) > 0.0) == (edge.along.y > 0.0)
                    });
                    let inside = crossings.count() % 2 == 1;
                    assert!(nearest.distance == if inside { -least.sqrt() } else { least.sqrt() });
                }
            }
        }
    }

    #[test]
    fn what_closes_no_line_is_refused() {
        assert_eq!(ClosedLine::new(vec![DVec2::X]), Err(ClosedLineError::TooFew { found: 1 }));
        let flat = ClosedLine::new(vec![DVec2::ZERO, DVec2::X, DVec2::X * 2.0]);
        assert_eq!(flat, Err(ClosedLineError::Flat { area: 0.0 }));
        let nan = ClosedLine::new(vec![DVec2::ZERO, DVec2::X, DVec2::NAN]);
        assert!(matches!(nan, Err(ClosedLineError::NotFinite { corner: 2, .. })));
    }
}

//! Area and vector area of a face on a sphere, as integrals along its edges.

use super::circle::Circle;
use super::surface::{Arc, Surface};
use glam::DVec3;

/// Nodes on (0, 1) and weights of Gauss and Legendre's rule with eight points, half of them: the rest by symmetry.
const NODES: [(f64, f64); 4] = [
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.101_666_761_293_186_63, 0.111_190_517_226_687_24),
    (0.019_855_071_751_231_884, 0.050_614_268_145_188_13),
];
/// The longest piece of an arc on which eight points integrate to rounding, in rad.
const PIECE: f64 = 0.4;

/// `(A, N)`: area, and integral of the unit normal, of the face of ball `k`.
///
/// With a pole `q` in the face and `d` from the pole to the edge, `A = rho closed integral of q.(d x dd) / (2 - |d|^2 / 2)`
/// in units of the radius: `1 - cos` of the distance from the pole is `|d|^2 / 2`, so that nothing cancels on small faces.
/// `N = 1/2 closed integral of y x dy`.
pub(super) fn face_moments(surface: &Surface, k: u32, arcs: &[Arc]) -> (f64, DVec3) {
    let (centre, rho) = (surface.centre(k), surface.radius);
    let pole = pole(surface, centre, arcs);
    let (mut area, mut vector) = (0.0, DVec3::ZERO);
    for (i, arc) in arcs.iter().enumerate() {
        let end = arcs[(i + 1) % arcs.len()].start;
        let circle = Circle::between(centre, surface.centre(arc.other), rho);
        let angle = surface.angle(&circle, arc.start, end);
        let pieces = (angle.abs() / PIECE).ceil().max(1.0);
        let step = angle / pieces;
        let mut begin = 0.0;
        for _ in 0..pieces as usize {
            for (node, weight) in NODES {
                for t in [node, 1.0 - node] {
                    let y = circle.at(arc.start, begin + t * step);
                    let tangent = circle.axis.cross(y - circle.middle) * (step * weight);
                    let d = (y - centre) / rho - pole;
                    area += pole.dot(d.cross(tangent)) * rho / (2.0 * (1.0 - d.length_squared() / 4.0));
                    // About the pole's point, so that small faces lose nothing; the shift integrates to zero.
                    vector += d.cross(tangent) * (rho / 2.0);
                }
            }
            begin += step;
        }
    }
    (area, vector)
}

/// A unit vector from the centre into the face.
fn pole(surface: &Surface, centre: DVec3, arcs: &[Arc]) -> DVec3 {
    let rho = surface.radius;
    let mut sum = DVec3::ZERO;
    for (i, arc) in arcs.iter().enumerate() {
        let end = arcs[(i + 1) % arcs.len()].start;
        let circle = Circle::between(centre, surface.centre(arc.other), rho);
        let middle = circle.at(arc.start, surface.angle(&circle, arc.start, end) / 2.0);
        // A full circle has no middle: its axis points into the face.
        sum += if arcs.len() == 1 { circle.axis * rho } else { middle - centre + (arc.start - centre) };
    }
    sum.normalize_or_zero()
}

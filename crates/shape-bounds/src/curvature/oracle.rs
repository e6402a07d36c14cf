//! The intersection of equal balls against every triple of balls, tried one by one.

use super::*;
use crate::body::ConvexBody;
use crate::generators::Source;
use std::f64::consts::PI;

/// Corners by trying all triples: points at distance `radius` from three centres that are in all balls. Solved in the frame
/// of the first two centres, another way than [`super::surface::Surface::common_point`]; `None` when rounding decides.
fn all_corners(centres: &[DVec3], radius: f64) -> Option<Vec<DVec3>> {
    let n = centres.len();
    let mut found = Vec::new();
    for (i, j, k) in (0..n).flat_map(|i| (0..i).flat_map(move |j| (0..j).map(move |k| (i, j, k)))) {
        let x = centres[j] - centres[i];
        let d = x.length();
        let ex = x / d;
        let w = centres[k] - centres[i];
        let along = w.dot(ex);
        let ey = (w - ex * along).normalize();
        let across = w.dot(ey);
        let px = d / 2.0;
        let py = (w.length_squared() - 2.0 * along * px) / (2.0 * across);
        let h = radius * radius - px * px - py * py;
        for sign in [-1.0, 1.0] {
            let at = centres[i] + ex * px + ey * py + ex.cross(ey) * (sign * h.sqrt());
            if !at.is_finite() {
                continue;
            }
            let excess = (0..n)
                .filter(|l| ![i, j, k].contains(l))
                .map(|l| at.distance(centres[l]) - radius)
                .fold(f64::NEG_INFINITY, f64::max);
            if excess.abs() < 1e-9 * radius {
                return None;
            }
            if excess < 0.0 {
                found.push(at);
            }
        }
    }
    Some(found)
}

/// Random balls that all hold the origin, centres anywhere from close together to nearly a radius away: many lenses, long
/// faces, and balls that share several edges.
#[test]
fn corners_are_those_of_all_triples() {
    let mut s = Source::new(17);
    let (mut judged, mut pairs_with_two_edges) = (0, 0);
    for case in 0..3000 {
        let count = 3 + s.below(10);
        let stretch = DVec3::new(1.0, s.between(0.01, 1.0), s.between(0.001, 1.0));
        let spread = s.between(0.05, 0.999);
        let centres: Vec<DVec3> =
            (0..count).map(|_| s.direction() * stretch * s.between(0.2, 1.0) * spread).collect();
        // A ball touches where the ray from its centre through the origin leaves it, if that is in all the others; else
        // it may touch nothing and is left out.
        let touching: Vec<DVec3> = centres.iter().map(|c| *c - c.normalize()).collect();
        let holds = |p: DVec3| centres.iter().all(|c| p.distance(*c) <= 1.0 + 1e-15);
        let (centres, touching): (Vec<DVec3>, Vec<DVec3>) =
            centres.iter().copied().zip(touching).filter(|(_, t)| holds(*t)).unzip();
        if centres.len() < 3 {
            continue;
        }
        let Some(mut expected) = all_corners(&centres, 1.0) else { continue };
        let (body, outside) = BallIntersection::build(&centres, &touching, 1.0, 1e-12);
        assert_eq!((outside, body.skipped()), (None, 0), "case {case}");
        judged += 1;
        let faces = body.face_sources().count();
        assert!(faces < 3 || body.corners().count() == 2 * (faces - 2), "case {case}: Euler");
        for corner in body.corners() {
            let at = expected.iter().position(|e| e.distance(corner) < 1e-7);
            let at = at.unwrap_or_else(|| panic!("case {case}: {corner} is no corner"));
            expected.swap_remove(at);
        }
        assert!(expected.is_empty(), "case {case}: {expected:?} missing");
        let mut edges: Vec<[u32; 2]> = Vec::new();
        for c in body.surface().live_corners() {
            edges.extend((0..3).map(|e| [c.balls[e], c.balls[(e + 1) % 3]]));
        }
        edges.sort_unstable();
        pairs_with_two_edges += usize::from(edges.windows(2).any(|w| w[0] == w[1]));
    }
    assert!(judged > 1000 && pairs_with_two_edges > 20, "{judged} {pairs_with_two_edges}");
}

#[test]
fn measures_of_a_ball_and_of_a_lens() {
    let one = BallIntersection::build(&[DVec3::X], &[DVec3::X * 3.0], 2.0, 0.0).0.measures();
    for (found, expected) in
        [(one.volume, 32.0 / 3.0 * PI), (one.area, 16.0 * PI), (one.mean_curvature, 8.0 * PI)]
    {
        assert!((found / expected - 1.0).abs() < 1e-15);
    }
    // Unit balls whose centres are d apart: two caps of height 1 - d / 2, which meet at the angle 2 asin(d / 2).
    for d in [1.9, 1.0, 0.1, 1e-3] {
        let half: f64 = d / 2.0;
        let lens = BallIntersection::build(
            &[DVec3::X * half, -DVec3::X * half],
            &[DVec3::X * (half - 1.0), DVec3::X * (1.0 - half)],
            1.0,
            1e-12,
        );
        // Its edge is the farthest across the line of the centres.
        let rim = lens.0.support(Direction::Y);
        assert!((rim - (1.0 - half * half).sqrt()).abs() < 1e-15, "{d}: {rim}");
        let found = lens.0.measures();
        let area = 4.0 * PI * (1.0 - half);
        let edge = 2.0 * PI * (1.0 - half * half).sqrt();
        assert!((found.area / area - 1.0).abs() < 1e-13, "{d}");
        let curvature = area + 0.5 * edge * 2.0 * half.asin();
        assert!((found.mean_curvature / curvature - 1.0).abs() < 1e-13, "{d}");
    }
}

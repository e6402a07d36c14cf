use super::*;
use crate::generators::Source;
use crate::predicates::turn;
use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// Points of kinds that break hulls: lattices, lines, near-duplicates, far offsets, thin and circular sets.
fn points(kind: u32, count: usize, s: &mut Source) -> Vec<DVec2> {
    let any = |s: &mut Source| DVec2::new(s.normal(), s.normal());
    (0..count)
        .map(|i| match kind {
            0 => any(s),
            1 => DVec2::new(s.below(5) as f64, s.below(5) as f64),
            2 => DVec2::new(1.0, 0.3) * s.normal() + DVec2::new(0.1, 0.7),
            3 => DVec2::from_angle((i / 3) as f64) + any(s) * 1e-16,
            4 => any(s) + DVec2::new(1e8, -1e8),
            5 => any(s) * DVec2::new(1.0, 1e-12),
            6 => DVec2::from_angle(TAU * i as f64 / count as f64),
            7 => DVec2::new(s.normal(), 0.5),
            _ => DVec2::from_angle(s.unit() * 1e-6) * 1e-200,
        })
        .collect()
}

fn assert_exact(points: &[DVec2], hull: &Hull) {
    match hull {
        Hull::Point(i) => assert!(points.iter().all(|p| *p == points[*i])),
        Hull::Segment([i, j]) => assert!(points.iter().all(|p| turn(points[*i], points[*j], *p) == 0.0)),
        Hull::Polygon(polygon) => {
            let corners = polygon.shape().vertices();
            let tiny = corners.iter().all(|c| c.length() < 1e-100);
            let scale = if tiny { 2f64.powi(664) } else { 1.0 };
            let at = |k: usize| corners[k % corners.len()] * scale;
            for k in 0..corners.len() {
                assert!(turn(at(k), at(k + 1), at(k + 2)) > 0.0);
                assert_eq!(corners[k], points[polygon.sources()[k] as usize]);
            }
            for p in points {
                assert!((0..corners.len()).all(|k| turn(at(k), at(k + 1), *p * scale) >= 0.0));
            }
        }
    }
}

#[test]
fn hulls_are_exact_on_every_kind_of_input_and_incremental_ones_agree() {
    let mut s = Source::new(1);
    for round in 0..900 {
        let kind = round % 9;
        let count = 1 + s.below(120);
        let points = points(kind, count, &mut s);
        let hull = Hull::of(&points).unwrap();
        assert_exact(&points, &hull);
        if kind == 7 && count > 1 {
            assert_eq!(hull.dimension(), 1);
        }
        if kind == 8 {
            continue;
        }
        let mut incremental = IncrementalHull::new();
        for p in &points {
            incremental.insert(*p).unwrap();
        }
        let other = incremental.hull().unwrap();
        assert_exact(&points, &other);
        assert_eq!(other.dimension(), hull.dimension());
        if let (Some(a), Some(b)) = (hull.polygon(), other.polygon()) {
            assert!(
                (a.shape().area() - b.shape().area()).abs() <= 1e-12 * a.shape().area().max(1e-30) + 1e-12
            );
            assert_eq!(a.shape().vertices().len(), b.shape().vertices().len());
        }
    }
}

#[test]
fn a_square_has_its_area_redundant_lines_are_named_and_open_directions_described() {
    let plane = |angle: f64, margin: f64| HalfPlane {
        point: DVec2::ZERO,
        normal: Direction::from_angle(angle),
        margin,
    };
    let mut planes: Vec<HalfPlane> = (0..4).map(|k| plane(f64::from(k) * PI / 2.0, 1.0)).collect();
    planes.push(plane(PI / 4.0, 2.0));
    let region = Intersection::of(&planes).unwrap();
    let region = region.bounded().unwrap();
    assert!((region.shape().area() - 4.0).abs() < 1e-13);
    assert_eq!(region.redundant(), [4]);
    let Intersection::Unbounded(open) = Intersection::of(&planes[..2]).unwrap() else { panic!("bounded") };
    let mut found: Vec<DVec2> = open.directions().iter().map(|d| d.get()).collect();
    found.sort_by(|a, b| a.x.total_cmp(&b.x));
    assert!(
        found.len() == 2
            && found[0].distance(DVec2::NEG_X) < 1e-15
            && found[1].distance(DVec2::NEG_Y) < 1e-15
    );
    assert!((open.within_square(DVec2::ZERO, 3.0).unwrap().shape().area() - 16.0).abs() < 1e-12);
    // A strip is open both ways, a half-plane also inwards.
    let strip = [planes[0], planes[2]];
    let Intersection::Unbounded(open) = Intersection::of(&strip).unwrap() else { panic!("bounded") };
    assert!(!open.directions().is_empty());
    assert!(open.directions().iter().all(|d| d.get().x.abs() < 1e-15));
    let Intersection::Unbounded(open) = Intersection::of(&planes[..1]).unwrap() else { panic!("bounded") };
    assert!(open.directions().iter().any(|d| d.get().distance(DVec2::NEG_X) < 1e-15));
}

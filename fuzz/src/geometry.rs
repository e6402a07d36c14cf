//! Geometry: an answer that keeps its promise, or a typed error.

use exact_hull::predicates::turn;
use exact_hull::{
    Direction, HalfSpace, Hull, HullCertificate, IncrementalHull, Intersection, delaunay, planar,
};
use glam::{DVec2, DVec3};

/// As many points as are judged against each other.
const MOST: usize = 48;

/// Numbers from bytes, three for each: two are a small whole number, the third says what is done with it. Half of them are nearly the one
/// before, whole, huge, tiny or none at all, which is what geometry breaks on and random bits hardly ever are.
fn numbers(bytes: &[u8]) -> Vec<f64> {
    let mut numbers: Vec<f64> = Vec::with_capacity(bytes.len() / 3);
    for chunk in bytes.chunks_exact(3) {
        let small = f64::from(i16::from_le_bytes([chunk[0], chunk[1]]));
        // Of a point's three coordinates it is that of the point before.
        let before = numbers.len().checked_sub(3).map_or(0.0, |at| numbers[at]);
        numbers.push(match chunk[2] {
            0..=99 => small / 256.0,
            100..=139 => small.rem_euclid(8.0) - 4.0,
            140..=169 => before,
            170..=199 => f64::from_bits(before.to_bits().wrapping_add(small.rem_euclid(5.0) as u64)),
            200..=219 => before + small * 1e-12,
            220..=229 => small * 2_f64.powi(-280),
            230..=239 => small * 2_f64.powi(300),
            240..=245 => small * f64::from_bits(1),
            246..=249 => small * 1e304,
            250 => f64::NAN,
            251 => f64::INFINITY,
            _ => 0.0,
        });
    }
    numbers
}

fn points(bytes: &[u8]) -> Vec<DVec3> {
    numbers(bytes).chunks_exact(3).take(MOST).map(DVec3::from_slice).collect()
}

fn planar_points(bytes: &[u8]) -> Vec<DVec2> {
    numbers(bytes).chunks_exact(2).take(MOST).map(DVec2::from_slice).collect()
}

fn assert_hull(hull: &Hull, points: &[DVec3]) {
    if let Hull::Solid(solid) = hull {
        let verdict = HullCertificate::of(&solid.mesh(), points);
        assert!(verdict.is_ok_and(|verdict| verdict.holds()), "{verdict:?}");
        assert!(points.iter().all(|p| solid.contains(*p)));
    }
}

pub(crate) fn hull(bytes: &[u8]) -> bool {
    let points = points(bytes);
    let Ok(hull) = Hull::of(&points) else { return false };
    assert_hull(&hull, &points);
    true
}

pub(crate) fn incremental_hull(bytes: &[u8]) -> bool {
    let mut growing = IncrementalHull::new();
    for p in points(bytes) {
        let before = growing.points().len();
        let taken = growing.insert(p).is_ok();
        assert_eq!(growing.points().len(), before + usize::from(taken));
    }
    let Ok(hull) = growing.hull() else { return false };
    assert_hull(&hull, growing.points());
    assert_eq!(Hull::of(growing.points()).map(|all| all.dimension()), Ok(hull.dimension()));
    true
}

pub(crate) fn half_spaces(bytes: &[u8]) -> bool {
    let plane = |n: &[f64]| {
        let normal = Direction::new(DVec3::from_slice(n)).ok()?;
        Some(HalfSpace { point: DVec3::from_slice(&n[3..]), normal, margin: n[6] })
    };
    let half_spaces: Vec<HalfSpace> = numbers(bytes).chunks_exact(7).take(MOST).filter_map(plane).collect();
    let Ok(intersection) = Intersection::of(&half_spaces) else { return false };
    match intersection {
        Intersection::Bounded(body) => {
            assert!(body.vertices().iter().all(|v| v.is_finite()));
            assert!(half_spaces.iter().all(|h| h.excess(body.interior()) < 0.0));
            assert!(body.face_count() + body.redundant().len() == half_spaces.len());
            // Twice as many corners as faces, less four: three planes meet in each.
            assert_eq!(body.vertices().len(), 2 * body.face_count() - 4);
        }
        Intersection::Unbounded(open) => {
            assert!(half_spaces.iter().all(|h| h.excess(open.interior()) < 0.0));
            assert!(!open.directions().is_empty());
            for d in open.directions() {
                assert!(half_spaces.iter().all(|h| h.normal.get().dot(d.get()) <= 1e-5));
            }
        }
    }
    true
}

pub(crate) fn tetrahedra(bytes: &[u8]) -> bool {
    let points = points(bytes);
    let Ok(all) = delaunay::tetrahedra(&points) else { return false };
    for (t, own) in all.iter().enumerate() {
        for k in 0..4 {
            assert!(all[own.neighbours[k] as usize].neighbours.contains(&(t as u32)));
        }
    }
    true
}

pub(crate) fn planar_hull(bytes: &[u8]) -> bool {
    let points = planar_points(bytes);
    let Ok(hull) = planar::Hull::of(&points) else { return false };
    let ordinary = points
        .iter()
        .all(|p| p.abs().max_element() < 1e100 && p.to_array().iter().all(|c| *c == 0.0 || c.abs() > 1e-100));
    if let Some(polygon) = hull.polygon().filter(|_| ordinary) {
        let corners = polygon.shape().vertices();
        let at = |k: usize| corners[k % corners.len()];
        for k in 0..corners.len() {
            assert!(turn(at(k), at(k + 1), at(k + 2)) > 0.0);
            assert!(points.iter().all(|p| turn(at(k), at(k + 1), *p) >= 0.0));
        }
    }
    true
}

pub(crate) fn half_planes(bytes: &[u8]) -> bool {
    let line = |n: &[f64]| {
        let normal = planar::Direction::new(DVec2::from_slice(n)).ok()?;
        Some(planar::HalfPlane { point: DVec2::from_slice(&n[2..]), normal, margin: n[4] })
    };
    let half_planes: Vec<_> = numbers(bytes).chunks_exact(5).take(MOST).filter_map(line).collect();
    let Ok(intersection) = planar::Intersection::of(&half_planes) else { return false };
    match intersection {
        planar::Intersection::Bounded(region) => {
            assert!(region.shape().vertices().iter().all(|v| v.is_finite()));
            assert!(region.shape().vertices().len() >= 3);
        }
        planar::Intersection::Unbounded(open) => {
            assert!(half_planes.iter().all(|h| h.excess(open.interior()) < 0.0));
            assert!(!open.directions().is_empty());
        }
    }
    true
}

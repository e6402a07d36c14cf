use super::*;
use crate::generators::InputKind;

fn volume(t: &Tetrahedron, points: &[DVec3]) -> f64 {
    let [a, b, c, d] = t.corners.map(|k| points[k as usize]);
    (b - a).cross(c - a).dot(d - a) / 6.0
}

fn assert_delaunay(points: &[DVec3], all: &[Tetrahedron]) {
    for (t, own) in all.iter().enumerate() {
        for k in 0..4 {
            let other = &all[own.neighbours[k] as usize];
            assert!(other.neighbours.contains(&(t as u32)));
        }
        if own.is_outside() {
            assert!(points.iter().all(|p| own.beyond(points, 3, *p) >= 0.0));
            continue;
        }
        let [a, b, c, d] = own.corners.map(|i| points[i as usize]);
        assert!(above(a, b, c, d) > 0.0);
        assert!(points.iter().all(|p| !own.sphere_holds(points, *p)));
    }
}

#[test]
fn spheres_of_delaunay_tetrahedra_are_empty_on_every_kind_of_input() {
    for kind in InputKind::ALL {
        for seed in 0..crate::few_or_all(1, 3) {
            let points = kind.points(70, seed);
            match tetrahedra(&points) {
                Ok(all) => {
                    assert_delaunay(&points, &all);
                    let hull = Hull::of(&points).unwrap();
                    let volume: f64 =
                        all.iter().filter(|t| !t.is_outside()).map(|t| volume(t, &points)).sum();
                    let expected = hull.solid().unwrap().volume();
                    let size = points.iter().map(|p| p.distance(points[0])).fold(0.0, f64::max);
                    assert!((volume - expected).abs() < 1e-12 * size.powi(3), "{kind:?} {volume} {expected}");
                }
                Err(DelaunayError::Flat { dimension }) => {
                    assert_eq!(Hull::of(&points).unwrap().dimension(), dimension);
                    assert!(dimension < 3, "{kind:?}");
                }
                Err(error) => panic!("{kind:?}: {error}"),
            }
        }
    }
}

use super::*;
use crate::generators::{InputKind, Source};
use crate::mesh::TriangleMesh;

/// The hull of `points` judged by exact signs; the dimension.
fn judged(points: &[DVec3], what: impl Fn() -> String) -> usize {
    let hull = Hull::of(points).unwrap();
    match &hull {
        Hull::Solid(solid) => {
            let verdict = HullCertificate::of(&solid.mesh(), points).unwrap();
            assert!(verdict.holds(), "{}: {verdict:?}", what());
            for (f, neighbours) in solid.neighbours().iter().enumerate() {
                for (e, g) in neighbours.iter().enumerate() {
                    let (a, b) = (solid.triangles()[f][e], solid.triangles()[f][(e + 1) % 3]);
                    let back = solid.triangles()[*g as usize];
                    assert!((0..3).any(|k| back[k] == b && back[(k + 1) % 3] == a), "{}", what());
                }
            }
        }
        Hull::Polygon(corners) => {
            let at = |k: usize| points[corners[k % corners.len()]];
            let (axis, sense) = crate::predicates::projection_axis(at(0), at(1), at(2)).unwrap();
            for k in 0..corners.len() {
                for p in points {
                    let [a, b, q] = [at(k), at(k + 1), *p].map(|p| drop_axis(p, axis));
                    assert!(crate::predicates::turn(a, b, q) * sense >= 0.0, "{}", what());
                    assert!(crate::predicates::above(at(0), at(1), at(2), *p) == 0.0, "{}", what());
                }
            }
        }
        Hull::Segment([a, b]) => {
            for p in points {
                assert!(
                    crate::predicates::projection_axis(points[*a], points[*b], *p).is_none(),
                    "{}",
                    what()
                );
                let (low, high) = (points[*a].min(points[*b]), points[*a].max(points[*b]));
                assert!(p.cmpge(low).all() && p.cmple(high).all(), "{}", what());
            }
        }
        Hull::Point(i) => assert!(points.iter().all(|p| p == &points[*i]), "{}", what()),
    }
    hull.dimension()
}

#[test]
fn no_kind_of_input_leaves_a_point_outside() {
    let mut s = Source::new(1);
    for kind in InputKind::ALL {
        for seed in 0..crate::few_or_all(20, 120) {
            let count = (4.0 * 100_f64.powf(s.unit() * if seed % 20 == 0 { 1.35 } else { 1.0 })) as usize;
            let points = kind.points(count, seed);
            let dimension = judged(&points, || format!("{kind:?}, {count} points, seed {seed}"));
            if count > 60 {
                assert_eq!(
                    dimension,
                    kind.dimension().unwrap_or(dimension),
                    "{kind:?}, {count}, seed {seed}"
                );
            }
        }
    }
}

#[test]
fn whole_points_with_many_coplanar_facets_have_their_exact_volume() {
    // Volume by rational arithmetic over the facets: 445 / 6.
    let points = [
        [-3, -2, 3],
        [-3, -2, 1],
        [-2, 0, 1],
        [-2, -3, 1],
        [-1, 2, -3],
        [3, 0, -2],
        [3, 2, -2],
        [0, 3, -1],
        [2, 1, -3],
        [2, 1, -3],
        [2, 1, -3],
        [0, 2, 1],
        [3, -2, -1],
        [1, 2, 0],
        [2, 3, -3],
        [2, -1, 3],
        [3, -1, 2],
        [-1, 1, 1],
    ]
    .map(|p| DVec3::from_array(p.map(f64::from)));
    judged(&points, String::new);
    let volume = Hull::of(&points).unwrap().solid().unwrap().volume();
    assert!((volume - 445.0 / 6.0).abs() < 1e-13, "{volume}");
}

#[test]
fn a_thin_box_keeps_its_volume() {
    let corner =
        |i: u32, scale: DVec3| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * scale;
    for height in [8e-4, 1e-12, 1e-60] {
        let points: Vec<DVec3> = (0..8).map(|i| corner(i, DVec3::new(1.0, 1.0, height))).collect();
        let volume = Hull::of(&points).unwrap().solid().unwrap().volume();
        assert!((volume / height - 1.0).abs() < 1e-14, "{volume}");
    }
}

#[test]
fn a_solid_one_ulp_thick_is_a_solid() {
    // No f64 point lies strictly inside of these, so the search cannot walk from a centre.
    let up = 1.0_f64.next_up();
    let mut points: Vec<DVec3> = Vec::new();
    for i in 0..6 {
        for j in 0..6 {
            points.push(DVec3::new(f64::from(i), f64::from(j), if (i + j) % 2 == 0 { 1.0 } else { up }));
        }
    }
    assert_eq!(judged(&points, String::new), 3);
}

#[test]
fn extreme_scales_are_exact_and_impossible_ones_are_named() {
    for scale in [1e-290, 1e-150, 1e150, 1e290] {
        let points: Vec<DVec3> = InputKind::Sphere.points(50, 3).into_iter().map(|p| p * scale).collect();
        let plain = Hull::of(&InputKind::Sphere.points(50, 3)).unwrap();
        let hull = Hull::of(&points).unwrap();
        // The scale is not a power of two, so the coordinates are rounded anew; all points of a sphere stay corners.
        let volume = |hull: &Hull, scale: f64| {
            let solid = hull.solid().unwrap();
            assert_eq!(solid.vertices().len(), 50);
            let unit = solid.vertices().iter().map(|v| *v / scale).collect();
            TriangleMesh { vertices: unit, triangles: solid.triangles().to_vec() }.moments().volume
        };
        assert!((volume(&hull, scale) / volume(&plain, 1.0) - 1.0).abs() < 1e-12);
    }
    let mixed = [DVec3::ZERO, DVec3::X * 1e250, DVec3::Y, DVec3::Z * 1e-100];
    assert!(matches!(Hull::of(&mixed), Err(PointsError::DynamicRange { .. })));
}

#[test]
fn bad_points_are_named() {
    assert_eq!(Hull::of(&[]), Err(PointsError::Empty));
    let error = Hull::of(&[DVec3::ONE, DVec3::new(0.0, f64::NAN, 1.0)]).unwrap_err();
    assert!(matches!(error, PointsError::NotFinite { index: 1, .. }));
    assert!(error.to_string().starts_with("point 1 (0, NaN, 1)"));
}

#[test]
fn the_certificate_sees_each_defect() {
    let points = InputKind::Sphere.points(40, 5);
    let hull = Hull::of(&points).unwrap();
    let mesh = hull.solid().unwrap().mesh();
    assert!(HullCertificate::of(&mesh, &points).unwrap().holds());

    let far = [points.clone(), vec![DVec3::splat(9.0)]].concat();
    assert_eq!(HullCertificate::of(&mesh, &far).unwrap().outside, 1);
    let mut open = mesh.clone();
    open.triangles.pop();
    assert_eq!(HullCertificate::of(&open, &points).unwrap().open_edges, 3);
    let mut dented = mesh.clone();
    dented.vertices[0] *= 0.2;
    assert!(HullCertificate::of(&dented, &points).unwrap().concave_edges > 0);
}

#[test]
fn one_point_at_a_time_gives_the_hull_of_all() {
    for kind in InputKind::ALL {
        for seed in 0..6 {
            let points = kind.points(90, seed);
            let mut growing = IncrementalHull::new();
            for (k, p) in points.iter().enumerate() {
                growing.insert(*p).unwrap();
                if k % 30 == 29 {
                    let hull = growing.hull().unwrap();
                    let all = Hull::of(&points[..=k]).unwrap();
                    assert_eq!(hull.dimension(), all.dimension(), "{kind:?}");
                    if let (Hull::Solid(hull), Hull::Solid(all)) = (hull, all) {
                        let verdict = HullCertificate::of(&hull.mesh(), &points[..=k]).unwrap();
                        assert!(verdict.holds(), "{kind:?} {seed}: {verdict:?}");
                        let size = points.iter().map(|p| p.distance(points[0])).fold(0.0, f64::max).powi(3);
                        assert!((hull.volume() - all.volume()).abs() < 1e-13 * size, "{kind:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn points_far_beyond_the_first_ones_are_judged_exactly() {
    let mut s = Source::new(4);
    let mut growing = IncrementalHull::new();
    for k in 0..200 {
        growing.insert(s.direction() * 1.2_f64.powi(k)).unwrap();
    }
    let hull = growing.hull().unwrap();
    assert!(HullCertificate::of(&hull.solid().unwrap().mesh(), growing.points()).unwrap().holds());
}

#[test]
fn a_bad_point_leaves_a_growing_hull_as_it_was() {
    let mut growing = IncrementalHull::new();
    assert_eq!(growing.hull(), Err(PointsError::Empty));
    growing.insert(DVec3::X).unwrap();
    assert!(matches!(growing.insert(DVec3::NAN), Err(PointsError::NotFinite { index: 1, .. })));
    assert!(matches!(growing.insert(DVec3::X * 1e200), Err(PointsError::DynamicRange { .. })));
    assert_eq!(growing.points(), [DVec3::X]);
}

/// Corners nearer to each other than rounding tells their heights apart: the climb must not end among them.
#[test]
fn the_climb_passes_clusters_of_near_duplicates() {
    let mut s = Source::new(12);
    for kind in [InputKind::NearDuplicates, InputKind::Clusters, InputKind::CubeFaces, InputKind::Lattice] {
        let points = kind.points(600, 3);
        let Hull::Solid(hull) = Hull::of(&points).unwrap() else { panic!("{kind:?} is flat") };
        let mut walk = SupportWalk::new(&hull);
        for _ in 0..400 {
            let d = s.direction();
            let best = hull.vertices().iter().map(|v| v.dot(d)).fold(f64::NEG_INFINITY, f64::max);
            assert!((walk.farthest(d).dot(d) - best).abs() <= 1e-14, "{kind:?} {d}");
        }
    }
}

#[test]
fn four_flips_restore_the_surface_and_no_edge_is_made_twice() {
    let points = InputKind::Sphere.points(40, 5);
    let Hull::Solid(hull) = Hull::of(&points).unwrap() else { panic!("flat") };
    let rotated = |mut t: [u32; 3]| {
        let first = (0..3).min_by_key(|k| t[*k]).unwrap();
        t.rotate_left(first);
        t
    };
    let mut flipped = 0;
    for facet in 0..hull.triangles().len() as u32 {
        for edge in 0..3 {
            let mut other = hull.clone();
            if !other.flip(facet, edge) {
                continue;
            }
            flipped += 1;
            assert!(is_closed(&other), "facet {facet}, edge {edge}");
            assert!((0..3).all(|_| other.flip(facet, 1)));
            assert!(is_closed(&other));
            let same =
                hull.triangles().iter().zip(other.triangles()).all(|(a, b)| rotated(*a) == rotated(*b));
            assert!(same, "facet {facet}, edge {edge}");
        }
    }
    assert!(flipped > hull.triangles().len());
    let tetrahedron = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let Hull::Solid(mut hull) = Hull::of(&tetrahedron).unwrap() else { panic!("flat") };
    assert!((0..4).all(|facet| (0..3).all(|edge| !hull.flip(facet, edge))));
}

/// Whether each edge has the facet across it that has it in the other sense, and each corner a facet at it.
fn is_closed(hull: &SolidHull) -> bool {
    let edges = |f: usize| (0..3).map(move |k| (hull.triangles()[f][k], hull.triangles()[f][(k + 1) % 3]));
    let facets = 0..hull.triangles().len();
    let matched = facets.clone().all(|f| {
        edges(f).zip(hull.neighbours()[f]).all(|((a, b), g)| edges(g as usize).any(|e| e == (b, a)))
    });
    let around = (0..hull.vertices().len() as u32).map(|v| hull.facets_around(v).count()).sum::<usize>();
    matched && around == 3 * hull.triangles().len()
}

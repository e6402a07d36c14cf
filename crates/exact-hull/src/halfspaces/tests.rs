use super::*;
use crate::generators::{AXES, Source, curve_normals, ellipsoid_half_spaces, ellipsoid_support};

fn space(point: DVec3, normal: DVec3) -> HalfSpace {
    HalfSpace { point, normal: Direction::new(normal).unwrap(), margin: 0.0 }
}

/// Half-spaces that touch an ellipsoid along three curves.
fn along_curves(count: usize, seed: u64) -> Vec<HalfSpace> {
    ellipsoid_half_spaces(&curve_normals(count, &mut Source::new(seed)))
}

/// Half-spaces that touch an ellipsoid all over.
fn all_over(count: usize, seed: u64) -> Vec<HalfSpace> {
    let mut s = Source::new(seed);
    ellipsoid_half_spaces(&(0..count).map(|_| s.direction()).collect::<Vec<_>>())
}

fn cube(half_side: f64) -> Vec<HalfSpace> {
    [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .flat_map(|a| [a, -a])
        .map(|n| space(n * half_side, n))
        .collect()
}

fn polyhedron(half_spaces: &[HalfSpace]) -> Polyhedron {
    match Intersection::of(half_spaces).unwrap() {
        Intersection::Bounded(polyhedron) => polyhedron,
        Intersection::Unbounded(open) => panic!("unbounded along {:?}", open.directions()),
    }
}

#[test]
fn a_cube_and_its_redundant_half_spaces() {
    let mut spaces = cube(0.5);
    spaces.push(space(DVec3::splat(0.6), DVec3::ONE));
    spaces.push(spaces[0]);
    let cube = polyhedron(&spaces);
    let moments = cube.moments();
    assert!((moments.volume - 1.0).abs() < 1e-14 && (moments.area - 6.0).abs() < 1e-13, "{moments:?}");
    assert_eq!(cube.face_count(), 6);
    assert_eq!(cube.redundant().len(), 2);
    assert!(cube.redundant().contains(&6));
    assert!(cube.contains(DVec3::splat(0.5)) && !cube.contains(DVec3::splat(0.5 + 1e-14)));
}

#[test]
fn faces_are_plane_closed_and_anticlockwise() {
    let spaces = along_curves(300, 2);
    let body = polyhedron(&spaces);
    // Each edge of a face belongs to one other face in the opposite sense.
    let mut edges = std::collections::HashSet::new();
    for f in 0..body.face_count() {
        let face: Vec<u32> = body.face(f).collect();
        for k in 0..face.len() {
            assert!(edges.insert((face[k], face[(k + 1) % face.len()])));
        }
        let plane = spaces[body.face_sources()[f] as usize];
        for v in &face {
            let height = plane.excess(body.vertices()[*v as usize]);
            assert!((0.0..1e-12).contains(&height), "{height}");
        }
        let [a, b, c] = [face[0], face[1], face[2]].map(|v| body.vertices()[v as usize]);
        assert!((b - a).cross(c - b).dot(plane.normal.get()) >= -1e-14);
    }
    assert!(edges.iter().all(|(a, b)| edges.contains(&(*b, *a))));
    let euler = body.vertices().len() as i64 - edges.len() as i64 / 2 + body.face_count() as i64;
    assert_eq!(euler, 2);
}

#[test]
fn corners_of_dense_curves_lie_in_every_half_space() {
    // Neighbouring normals are 1e-4 apart, so that the plain three-plane system has a condition number of about 1e8.
    let spaces = along_curves(100_000, 7);
    let body = polyhedron(&spaces);
    let mut s = Source::new(1);
    for _ in 0..300 {
        let corner = body.vertices()[s.below(body.vertices().len())];
        let worst = spaces.iter().map(|h| h.excess(corner)).fold(f64::NEG_INFINITY, f64::max);
        assert!(worst < 1e-10 * AXES.max_element(), "{worst}");
    }
}

#[test]
fn where_thousands_of_planes_nearly_meet_each_corner_is_common_to_its_planes() {
    // The planes of a curve of a third of a million contacts turn about a cusp of their envelope here: rounding of the
    // duals joins planes that are no neighbours.
    let cusp = DVec3::new(0.188_16, 2.135_94, -0.315_16);
    let spaces: Vec<HalfSpace> = along_curves(1_000_000, 1)
        .into_iter()
        .enumerate()
        .filter_map(|(k, h)| (k % 97 == 0 || h.excess(cusp).abs() < 1e-5).then_some(h))
        .collect();
    let body = polyhedron(&spaces);
    for v in 0..body.vertices().len() {
        let planes = body.faces_at(v).map(|f| &body.face_half_spaces()[f as usize]);
        let (exact, _) = super::vertex::common_point(planes, 1e-14).unwrap();
        let distance = body.vertices()[v].distance(exact);
        assert!(distance < 1e-12 * AXES.max_element(), "corner {v}: {distance}");
    }
}

#[test]
fn no_contact_is_cut_off_by_exact_arithmetic() {
    for &(seed, count) in &[(1, 30), (2, 300), (3, 3000), (4, 20_000)][..crate::few_or_all(3, 4)] {
        for spaces in [along_curves(count, seed), all_over(count, seed)] {
            let body = polyhedron(&spaces);
            let Hull::Solid(hull) = Hull::of(body.vertices()).unwrap() else { panic!("flat") };
            let step = (count / 200).max(1);
            for c in spaces.iter().step_by(step) {
                assert!(body.contains(c.point));
                assert!(hull.contains(c.point), "{count}: {}", hull.excess(c.point));
            }
        }
    }
}

#[test]
fn the_upper_bound_supports_the_body_and_converges() {
    let true_volume = 4.0 / 3.0 * std::f64::consts::PI * AXES.x * AXES.y * AXES.z;
    let mut excesses = Vec::new();
    for count in [250, 1000, 4000] {
        let spaces = all_over(count, 5);
        let body = polyhedron(&spaces);
        let mut s = Source::new(9);
        for _ in 0..200 {
            let n = s.direction();
            let above = body.support(Direction::new(n).unwrap()) - ellipsoid_support(n);
            assert!(above >= 0.0, "{above}");
        }
        excesses.push(body.volume() / true_volume - 1.0);
    }
    // The excess volume of random tangent planes falls like 1 / n.
    for pair in excesses.windows(2) {
        assert!((3.0..5.3).contains(&(pair[0] / pair[1])), "{excesses:?}");
    }
}

#[test]
fn unbounded_directions_are_described() {
    let directions = |spaces: &[HalfSpace]| match Intersection::of(spaces).unwrap() {
        Intersection::Unbounded(open) => open.directions().iter().map(|d| d.get()).collect::<Vec<_>>(),
        Intersection::Bounded(_) => panic!("bounded"),
    };
    let has = |list: &[DVec3], d: DVec3| list.iter().any(|e| e.distance(d) < 1e-12);

    // A cube without its lid: up.
    let open: Vec<HalfSpace> = cube(1.0).into_iter().filter(|h| h.normal.get() != DVec3::Z).collect();
    let found = directions(&open);
    assert!(found.len() == 1 && has(&found, DVec3::Z), "{found:?}");
    // An octant: its three axes.
    let octant: Vec<HalfSpace> = [DVec3::X, DVec3::Y, DVec3::Z].map(|n| space(n, n)).to_vec();
    let found = directions(&octant);
    assert!(found.len() == 3 && [DVec3::X, DVec3::Y, DVec3::Z].iter().all(|n| has(&found, -*n)));
    // A prism: both ends.
    let prism: Vec<HalfSpace> = cube(1.0).into_iter().filter(|h| h.normal.get().z == 0.0).collect();
    let found = directions(&prism);
    assert!(found.len() == 2 && has(&found, DVec3::Z) && has(&found, -DVec3::Z), "{found:?}");
    // A wedge: its edge both ways, and the two rims.
    let wedge = [space(DVec3::X, DVec3::X), space(DVec3::Y, DVec3::Y)];
    let found = directions(&wedge);
    assert!([DVec3::Z, -DVec3::Z, -DVec3::X, -DVec3::Y].iter().all(|d| has(&found, *d)), "{found:?}");
    // One half-space, and a slab.
    assert_eq!(directions(&wedge[..1]).len(), 5);
    assert_eq!(directions(&[space(DVec3::X, DVec3::X), space(-DVec3::X, -DVec3::X)]).len(), 4);
}

#[test]
fn random_cones_are_polar_to_their_normals() {
    let mut s = Source::new(8);
    for _ in 0..100 {
        let axis = s.direction();
        let spaces: Vec<HalfSpace> =
            (0..12).map(|_| s.direction()).filter(|n| n.dot(axis) > 0.1).map(|n| space(n, n)).collect();
        if spaces.len() < 3 {
            continue;
        }
        let Intersection::Unbounded(open) = Intersection::of(&spaces).unwrap() else { panic!("bounded") };
        assert!(open.directions().len() >= 3);
        for d in open.directions() {
            let worst = spaces.iter().map(|h| h.normal.get().dot(d.get())).fold(f64::NEG_INFINITY, f64::max);
            assert!(worst.abs() < 1e-13, "an extreme direction lies in a plane: {worst}");
        }
        let clipped = open.within_cube(DVec3::ZERO, 100.0).unwrap();
        assert!(clipped.volume() > 0.0);
    }
}

#[test]
fn contradictions_name_a_smallest_conflict() {
    let mut s = Source::new(12);
    let mut sizes = std::collections::BTreeSet::new();
    for _ in 0..200 {
        // A body and, somewhere among its half-spaces, wrong ones.
        let mut spaces: Vec<HalfSpace> =
            (0..30).map(|_| (s.direction(), s.between(1.0, 2.0))).map(|(n, h)| space(n * h, n)).collect();
        for _ in 0..3 {
            let n = s.direction();
            let at = s.below(spaces.len());
            spaces.insert(at, space(-n * s.between(1.5, 3.0), n));
        }
        let error = Intersection::of(&spaces).unwrap_err();
        let IntersectionError::Contradiction { conflict, deficit } = error else { panic!("{error}") };
        sizes.insert(conflict.len());
        let named: Vec<HalfSpace> = conflict.iter().map(|k| spaces[*k]).collect();
        assert!(matches!(Intersection::of(&named), Err(IntersectionError::Contradiction { .. })));
        for left_out in 0..named.len() {
            let mut rest = named.clone();
            rest.remove(left_out);
            assert!(rest.is_empty() || Intersection::of(&rest).is_ok(), "{conflict:?} without {left_out}");
        }
        // The deficit is what it says.
        for (margin, meets) in [(deficit * 1.001, true), (deficit * 0.999, false)] {
            let moved: Vec<HalfSpace> = spaces.iter().map(|h| HalfSpace { margin, ..*h }).collect();
            assert_eq!(interior::interior_point(&moved).is_ok(), meets);
        }
    }
    assert!(sizes.iter().all(|k| (2..=4).contains(k)), "{sizes:?}");
}

#[test]
fn two_faces_that_touch_leave_no_interior() {
    let mut spaces = cube(1.0);
    spaces.push(space(DVec3::X, -DVec3::X));
    let error = Intersection::of(&spaces).unwrap_err();
    assert!(matches!(&error, IntersectionError::NoInterior { tight, .. } if tight == &[0, 6]), "{error}");
}

#[test]
fn a_thin_slab_far_away_is_found() {
    for thickness in [1e-3, 1e-6, 1e-9] {
        let shift = DVec3::new(30.0, -20.0, 10.0);
        let mut spaces = cube(1.0);
        spaces[4] = space(DVec3::Z * thickness, DVec3::Z);
        spaces[5] = space(DVec3::ZERO, -DVec3::Z);
        spaces.iter_mut().for_each(|h| h.point += shift);
        let volume = polyhedron(&spaces).volume();
        // Coordinates of 30 m are rounded to 4e-15 m.
        assert!((volume / (4.0 * thickness) - 1.0).abs() < 2e-13 / thickness, "{thickness}: {volume}");
    }
}

#[test]
fn bad_half_spaces_are_named() {
    assert_eq!(Intersection::of(&[]), Err(IntersectionError::Empty));
    let mut spaces = cube(1.0);
    spaces[3].margin = f64::NAN;
    assert!(matches!(Intersection::of(&spaces), Err(IntersectionError::NotFinite { index: 3, .. })));
    // Planes that all pass the mean of their points leave the search for one inside, which squares distances.
    spaces = cube(1e160);
    spaces[3].point *= 2.0;
    assert!(matches!(Intersection::of(&spaces), Err(IntersectionError::TooFar { index: 3, .. })));
}

/// Whether some direction is open to rounding, by trying the directions across every two normals, and against every one.
fn is_open(normals: &[DVec3]) -> bool {
    let across = normals.iter().flat_map(|a| normals.iter().map(|b| a.cross(*b)));
    let more = normals.iter().flat_map(|a| {
        let (u, v) = a.any_orthonormal_pair();
        [-*a, u, -u, v, -v]
    });
    across.chain(more).filter(|d| d.length() > 1e-9).any(|d| {
        let d = d.normalize();
        [d, -d].iter().any(|d| normals.iter().all(|n| n.dot(*d) <= 1e-7))
    })
}

#[test]
fn open_and_closed_intersections_are_told_apart_as_by_trying_every_direction() {
    let mut s = Source::new(31);
    let mut counts = [0, 0];
    for case in 0..1600 {
        let (axis, count) = (s.direction(), 3 + s.below(12));
        let turn = s.rotation();
        let normal = |s: &mut Source, k: usize| match case % 8 {
            // Anywhere; on one side; round the waist; round the waist but for rounding; a cone; near-parallel; a slab; a prism.
            0 => s.direction(),
            1 => (s.direction() + axis * 0.9).normalize(),
            2 => {
                let angle = std::f64::consts::TAU * k as f64 / count as f64;
                turn * DVec3::new(angle.cos(), angle.sin(), 0.0)
            }
            3 => (axis.cross(s.direction()).normalize() + s.normal3() * 1e-16).normalize(),
            4 => (axis.cross(s.direction()).normalize() + axis * 0.1).normalize(),
            5 => (s.direction() * 1e-9 + [axis, -axis, turn * axis][s.below(3)]).normalize(),
            6 => (axis * [1.0, -1.0][s.below(2)] + s.normal3() * 1e-16).normalize(),
            _ => turn * [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y][k % 4],
        };
        let normals: Vec<DVec3> = (0..count).map(|k| normal(&mut s, k)).collect();
        let spaces: Vec<HalfSpace> =
            normals.iter().map(|n| space(*n * s.between(0.5, 1.0) + turn * DVec3::Y, *n)).collect();
        let expected = is_open(&normals);
        counts[usize::from(expected)] += 1;
        match Intersection::of(&spaces).unwrap_or_else(|e| panic!("case {case}: {e}")) {
            Intersection::Bounded(body) => {
                assert!(!expected, "case {case}: {}", body.volume());
                assert!(body.volume().is_finite() && body.volume() > 0.0, "case {case}");
            }
            Intersection::Unbounded(open) => {
                assert!(expected, "case {case}");
                for d in open.directions() {
                    let worst = normals.iter().map(|n| n.dot(d.get())).fold(f64::NEG_INFINITY, f64::max);
                    assert!(worst <= recession::OPEN, "case {case}: {worst}");
                }
            }
        }
    }
    assert!(counts[0] > 100 && counts[1] > 500, "{counts:?}");
}

#[test]
fn a_cylinder_touched_round_its_waist_is_open_along_its_axis() {
    let mut s = Source::new(7);
    for count in [4, 7, 24, 60, 300, 2000] {
        for _ in 0..5 {
            let turn = s.rotation();
            let shift = s.normal3();
            let spaces: Vec<HalfSpace> = (0..count)
                .map(|k| {
                    turn * DVec3::from((
                        glam::DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(count)),
                        0.0,
                    ))
                })
                .map(|n| space(n * 0.3 + shift, n))
                .collect();
            let Intersection::Unbounded(open) = Intersection::of(&spaces).unwrap() else {
                panic!("{count}: closed")
            };
            for end in [DVec3::Z, DVec3::NEG_Z] {
                let found = open.directions().iter().any(|d| d.get().distance(turn * end) < 1e-6);
                assert!(found, "{count}: {:?}", open.directions());
            }
            assert!(open.directions().iter().all(|d| d.get().dot(turn * DVec3::Z).abs() > 1.0 - 1e-6));
            let cut = open.within_cube(shift, 1.0).unwrap();
            assert!(cut.volume() > 0.0 && cut.volume() < 8.0);
        }
    }
}

#[test]
fn what_leaves_the_range_of_exact_arithmetic_is_an_error_and_no_open_side() {
    let mut spaces = cube(1.0);
    spaces[0].normal = Direction::new_unchecked(DVec3::new(1.0, 1e-250, 0.0));
    assert!(matches!(Intersection::of(&spaces), Err(IntersectionError::Range(_))));
}

use crate::{Flaw, Solid, Surface, SurfaceError};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The closed surface of the points that `at` gives for unit vectors, on a net of `rows` by `columns` between the poles.
pub(crate) fn net(rows: u32, columns: u32, at: impl Fn(DVec3) -> DVec3) -> Surface {
    let point = |row: u32, column: u32| {
        let (polar, around) =
            (PI * f64::from(row) / f64::from(rows), TAU * f64::from(column) / f64::from(columns));
        at(DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos()))
    };
    let mut corners = vec![point(0, 0)];
    corners.extend(
        (1..rows).flat_map(|row| (0..columns).map(move |column| (row, column))).map(|(r, c)| point(r, c)),
    );
    corners.push(point(rows, 0));
    let last = corners.len() as u32 - 1;
    let ring = |row: u32, column: u32| 1 + (row - 1) * columns + column % columns;
    let mut triangles = Vec::new();
    for column in 0..columns {
        triangles.push([0, ring(1, column), ring(1, column + 1)]);
        triangles.push([last, ring(rows - 1, column + 1), ring(rows - 1, column)]);
        for row in 1..rows - 1 {
            let [a, b] = [ring(row, column), ring(row + 1, column)];
            let [d, c] = [ring(row, column + 1), ring(row + 1, column + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    Surface::new(corners, triangles).unwrap()
}

fn octahedron() -> Surface {
    let corners = [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y, DVec3::Z, -DVec3::Z].to_vec();
    let triangles =
        vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
    Surface::new(corners, triangles).unwrap()
}

#[test]
fn points_are_inside_or_outside_by_exact_signs_and_distances_are_those_to_faces() {
    let surface = octahedron();
    let solid = Solid::new(&surface);
    // On rays through corners and edges, too.
    for (point, expected) in [
        (DVec3::ZERO, 1),
        (DVec3::new(-0.5, 0.0, 0.0), 1),
        (DVec3::new(-1.5, 0.0, 0.0), 0),
        (DVec3::new(-0.2, 0.3, 0.0), 1),
        (DVec3::splat(1.0 / 3.0 - 1e-16), 1),
        (DVec3::splat(1.0 / 3.0 + 1e-16), 0),
        (DVec3::new(-3.0, 0.0, 1.0), 0),
    ] {
        assert_eq!(solid.winding(point), expected, "{point}");
    }
    assert!((solid.distance(DVec3::splat(1.0)) - 2.0 / 3.0_f64.sqrt()).abs() < 1e-15);
    assert!((solid.distance(DVec3::X * 3.0) - 2.0).abs() < 1e-15);
    // Against counting all faces: a finer surface and many points.
    let surface = net(12, 24, |n| n * DVec3::new(3.0, 2.0, 1.0));
    let solid = Solid::new(&surface);
    for k in 0..500 {
        let p = DVec3::new(
            (f64::from(k) * 0.7).sin() * 3.0,
            (f64::from(k) * 1.3).sin() * 2.0,
            (f64::from(k) * 2.1).sin(),
        );
        let gauge = (p / DVec3::new(3.0, 2.0, 1.0)).length();
        if !(0.96..=1.0).contains(&gauge) {
            assert_eq!(solid.winding(p), i32::from(gauge < 1.0), "{p}");
        }
    }
}

#[test]
fn what_is_no_surface_of_a_convex_body_is_named() {
    let whole = octahedron();
    assert_eq!((whole.open_edge(), whole.not_convex(1e-15)), (None, None));
    assert!((whole.size().volume - 4.0 / 3.0).abs() < 1e-15);
    let mut triangles = whole.triangles().to_vec();
    triangles.pop();
    let open = Surface::new(whole.corners().to_vec(), triangles).unwrap();
    assert!(open.open_edge().is_some() && matches!(open.not_convex(1e-15), Some(Flaw::Open(_))));
    let dented = net(8, 16, |n| n * (1.0 - 0.2 * n.z.powi(8)));
    assert!(matches!(dented.not_convex(1e-3), Some(Flaw::NotConvex(why)) if why.contains("dented by")));
    assert!(matches!(
        Surface::new(vec![DVec3::X, DVec3::NAN], vec![]),
        Err(SurfaceError::NotFinite { corner: 1, .. })
    ));
    let missing = Surface::new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 3]]);
    assert_eq!(missing, Err(SurfaceError::NoSuchCorner { triangle: 0, corners: 3 }));
}

//! One suite over every shape: what theory says of any support function.

use super::*;
use proptest::prelude::*;
use std::sync::LazyLock;

struct Case(&'static str, Box<dyn SupportFunction + Send + Sync>, CurvatureRadii);

/// Every shape with its curvature bounds, which are too dear to compute for each drawn normal.
static SHAPES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let certify = |(name, shape): (_, Box<dyn SupportFunction + Send + Sync>)| {
        let radii = check_convex(&shape).unwrap();
        Case(name, shape, radii)
    };
    shapes().into_iter().map(certify).collect()
});

fn shapes() -> Vec<(&'static str, Box<dyn SupportFunction + Send + Sync>)> {
    let ellipsoid = Ellipsoid::new(DVec3::new(2.5, 2.0, 1.5)).unwrap();
    let saddle = PolynomialSupport::new(vec![
        Monomial { powers: [1, 1, 1], coefficient: 0.08 },
        Monomial { powers: [1, 0, 0], coefficient: 0.2 },
        Monomial { powers: [0, 1, 0], coefficient: -0.1 },
    ])
    .unwrap();
    let harmonics = vec![vec![4.0], vec![0.1, -0.2, 0.3], vec![0.02, 0.03, -0.05, 0.04, 0.01], vec![0.01; 7]];
    vec![
        ("sphere", Box::new(Sphere::new(0.7).unwrap())),
        ("ellipsoid", Box::new(ellipsoid)),
        ("ellipsoid plus ball", Box::new(MinkowskiSum(ellipsoid, Sphere::new(0.3).unwrap()))),
        ("translated", Box::new(Translated { body: ellipsoid, offset: DVec3::new(0.1, -0.2, 0.3) })),
        ("general", Box::new(MinkowskiSum(ellipsoid, saddle))),
        ("egg", Box::new(PolynomialSupport::egg(1.0, 0.1, 0.06).unwrap())),
        ("rounded box", Box::new(RoundedPolytope::cuboid(DVec3::new(0.1, 0.09, 0.08), 0.2, 4.0).unwrap())),
        ("harmonics", Box::new(PolynomialSupport::from_harmonics(&harmonics).unwrap())),
    ]
}

fn direction() -> impl Strategy<Value = Direction> {
    // Near the axes and their opposites as often as anywhere: that is where charts of the sphere fail.
    let generic = (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    let axis = (0..6usize, -12.0..0.0f64, 0.0..6.3f64).prop_map(|(axis, log, angle)| {
        let mut v = DVec3::ZERO;
        v[axis / 2] = if axis % 2 == 0 { 1.0 } else { -1.0 };
        v[(axis / 2 + 1) % 3] = 10f64.powf(log) * angle.cos();
        v[(axis / 2 + 2) % 3] = 10f64.powf(log) * angle.sin();
        v
    });
    prop_oneof![generic, axis].prop_filter_map("zero", |v| Direction::new(v).ok())
}

/// 1-homogeneous extension.
fn extended(shape: &dyn SupportFunction, u: DVec3) -> f64 {
    shape.value(Direction::new(u).unwrap()) * u.length()
}

proptest! {
    #[test]
    fn gradient_and_hessian_are_those_of_the_homogeneous_extension(n in direction()) {
        for Case(name, shape, _) in SHAPES.iter() {
            let jet = shape.jet(n);
            let h = 1e-4;
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let plus = Direction::new(n.get() + h * axis).unwrap();
                let minus = Direction::new(n.get() - h * axis).unwrap();
                // Central differences: error h^2 times third derivatives (of order 10), plus rounding / h.
                let slope = (extended(shape, n.get() + h * axis) - extended(shape, n.get() - h * axis)) / (2.0 * h);
                prop_assert!((slope - jet.point.dot(axis)).abs() < 1e-6, "{name}: {slope} {}", jet.point.dot(axis));
                let column = (shape.point(plus) - shape.point(minus)) / (2.0 * h);
                prop_assert!((column - jet.hessian * axis).length() < 2e-6, "{name}");
            }
        }
    }

    #[test]
    fn euler_relations_hold(n in direction()) {
        for Case(name, shape, _) in SHAPES.iter() {
            let jet = shape.jet(n);
            prop_assert!((jet.point.dot(n.get()) - jet.value).abs() < 1e-13, "{name}");
            prop_assert!((jet.hessian * n.get()).length() < 1e-13, "{name}");
            prop_assert!((jet.value - shape.value(n)).abs() < 1e-14, "{name}");
        }
    }

    #[test]
    fn curvature_radii_are_bounds_and_the_body_lies_below_its_tangent_planes(n in direction(), m in direction()) {
        for Case(name, shape, bounds) in SHAPES.iter() {
            let [small, large] = principal_radii(shape.jet(n).hessian, n);
            prop_assert!(bounds.min <= small * (1.0 + 1e-13) && large <= bounds.max * (1.0 + 1e-13), "{name}");
            prop_assert!(shape.point(m).dot(n.get()) <= shape.value(n) + 1e-13, "{name}");
        }
    }
}

#[test]
fn curvature_bounds_of_an_ellipsoid_are_attained() {
    let ellipsoid = Ellipsoid::new(DVec3::new(1.0, 2.0, 2.5)).unwrap();
    let bounds = ellipsoid.curvature_radii();
    assert!(
        (principal_radii(ellipsoid.jet(Direction::Z).hessian, Direction::Z)[0] - bounds.min).abs() < 1e-14
    );
    assert!(
        (principal_radii(ellipsoid.jet(Direction::X).hessian, Direction::X)[1] - bounds.max).abs() < 1e-14
    );
}

#[test]
fn curvature_bounds_of_an_egg_are_tight() {
    // h = 1 + 0.1 z^2 + 0.06 z^3. Across the axis the radius is h - z h'(z), along a meridian h + h'' by angle.
    let egg = PolynomialSupport::egg(1.0, 0.1, 0.06).unwrap();
    let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..=100_000 {
        let z = -1.0 + 2e-5 * f64::from(i);
        let (first, second) = (0.2 * z + 0.18 * z * z, 0.2 + 0.36 * z);
        let across = 1.0 + 0.1 * z * z + 0.06 * z.powi(3) - z * first;
        let along = across + (1.0 - z * z) * second;
        (min, max) = (min.min(across).min(along), max.max(across).max(along));
    }
    let bounds = egg.curvature_radii();
    assert!(bounds.min <= min && max <= bounds.max, "{bounds:?} {min} {max}");
    // The slack asked for is a twentieth of the smallest radius.
    assert!(min - bounds.min <= 0.051 * min && bounds.max - max <= 0.051 * min, "{bounds:?} {min} {max}");
}

#[test]
fn harmonics_are_orthonormal() {
    // Quadrature on a fine cube grid would do; a product of Legendre polynomials along the axis is exact enough:
    // Y_20 = sqrt(5 / 16 pi) (3 z^2 - 1), Y_1-1 = sqrt(3 / 4 pi) y, Y_33 = sqrt(35 / 32 pi) x (x^2 - 3 y^2).
    let pi = std::f64::consts::PI;
    let n = Direction::new(DVec3::new(0.3, -0.5, 0.7)).unwrap();
    let DVec3 { x, y, z } = n.get();
    let single = |l: usize, index: usize| {
        let mut rows: Vec<Vec<f64>> = (0..=l).map(|l| vec![0.0; 2 * l + 1]).collect();
        rows[l][index] = 1.0;
        PolynomialSupport::from_harmonics(&rows).unwrap().value(n)
    };
    assert!((single(2, 2) - (5.0 / (16.0 * pi)).sqrt() * (3.0 * z * z - 1.0)).abs() < 1e-15);
    assert!((single(1, 0) - (3.0 / (4.0 * pi)).sqrt() * y).abs() < 1e-15);
    assert!((single(3, 6) - (35.0 / (32.0 * pi)).sqrt() * x * (x * x - 3.0 * y * y)).abs() < 1e-15);
}

#[test]
fn bodies_that_bend_inwards_and_bad_numbers_are_errors() {
    let egg = PolynomialSupport::egg(1.0, 0.1, 0.9).unwrap();
    assert!(matches!(check_convex(&egg), Err(ShapeError::NotConvex { min }) if min < 0.0));
    assert!(matches!(Sphere::new(0.0), Err(ShapeError::Length { .. })));
    assert!(matches!(
        Ellipsoid::new(DVec3::new(1.0, f64::NAN, 1.0)),
        Err(ShapeError::Length { what: "semi-axis y", .. })
    ));
    assert!(matches!(
        PolynomialSupport::egg(1.0, f64::INFINITY, 0.0),
        Err(ShapeError::Coefficient { index: 1, .. })
    ));
    let steep = Monomial { powers: [40, 0, 0], coefficient: 1.0 };
    assert!(matches!(PolynomialSupport::new(vec![steep]), Err(ShapeError::Degree { degree: 40, .. })));
    assert!(matches!(
        PolynomialSupport::from_harmonics(&[vec![1.0, 2.0]]),
        Err(ShapeError::HarmonicCount { degree: 0, expected: 1, found: 2 })
    ));
}

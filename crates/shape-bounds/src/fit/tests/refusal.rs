use super::*;
use contact_kinematics::{Ellipsoid, ShapeError};

fn fit(contacts: &[NoisyContact], family: ShapeFamily) -> Result<ShapeFit, FitError> {
    ShapeFit::of(contacts, family, &FitOptions::default())
}

#[test]
fn contacts_that_leave_a_parameter_open_are_refused() {
    let body = Ellipsoid::new(DVec3::new(1.5, 1.0, 0.7)).unwrap();
    // Normals in one plane: nothing is seen of the extent across it.
    let circle = |count: usize, arc: f64| {
        (0..count).map(move |i| {
            let (sin, cos) = (arc * i as f64 / count as f64).sin_cos();
            DVec3::new(cos, sin, 0.0)
        })
    };
    match fit(&exact(&body, circle(60, std::f64::consts::TAU)), ShapeFamily::Ellipsoid) {
        Err(FitError::Undetermined { rank: 8, parameters: 9, weakest, .. }) => assert_eq!(weakest, "axes zz"),
        other => panic!("{other:?}"),
    }
    for family in [ShapeFamily::Superquadric, ShapeFamily::Harmonics { degree: 2 }] {
        assert!(
            matches!(
                fit(&exact(&body, circle(60, std::f64::consts::TAU)), family),
                Err(FitError::Undetermined { .. })
            ),
            "{family}"
        );
    }
    // One short arc, with noise: of full rank, but far less certain than the size.
    let mut s = Source::new(31);
    let arc =
        measured(&body, circle(60, 0.05).map(|n| (n + DVec3::Z * 0.01).normalize()), 1e-3, 1e-3, &mut s);
    assert!(matches!(
        fit(&arc, ShapeFamily::Ellipsoid),
        Err(FitError::Undetermined { .. } | FitError::NotConverged { .. })
    ));
    // The same arc does determine a ball.
    let ball = Sphere::new(1.2).unwrap();
    let arc = measured(&ball, circle(60, 0.3), 1e-4, 1e-4, &mut s);
    let found = fit(&arc, ShapeFamily::Sphere).unwrap();
    assert!((found.parameters()[3] - 1.2).abs() < 4.0 * found.covariance()[(3, 3)].sqrt());
    // Of a ball, the directions of a superquadric's axes cannot be known.
    let contacts = exact(&ball, scattered(60, &mut s));
    match fit(&contacts, ShapeFamily::Superquadric) {
        Err(FitError::Undetermined { weakest, .. }) => assert!(weakest.starts_with("turn"), "{weakest}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn harmonics_are_held_convex_and_nearer_to_the_truth() {
    // A flat body, contacts on one side only and noise: the unconstrained fit bends inwards elsewhere.
    let body = Ellipsoid::new(DVec3::new(1.0, 0.9, 0.6)).unwrap();
    let family = ShapeFamily::Harmonics { degree: 4 };
    let mut held = 0;
    let runs = crate::few_or_all(4, 12);
    for seed in 0..runs {
        let mut s = Source::new(seed + 500);
        let normals: Vec<DVec3> = scattered(120, &mut s).into_iter().filter(|n| n.z > -0.1).collect();
        let contacts = measured(&body, normals, 3e-2, 1e-2, &mut s);
        let data = Data::check(&contacts, &FitOptions::default()).unwrap();
        let model = family.model().unwrap();
        let start = ball(model.as_ref(), &contacts, &data);
        let Ok(free) = solve(
            &Spatial { model: model.as_ref(), contacts: &contacts, size: data.size },
            vec![start],
            Effort::default(),
            |_| true,
        ) else {
            panic!("no free fit")
        };
        let limit = 0.1;
        let convex = convex::hold(4, &free.theta, &free.system.root, limit, f64::INFINITY).unwrap();
        assert!(convex.body.curvature_radii().min >= limit);
        if convex.active == 0 {
            continue;
        }
        held += 1;
        // The best harmonic description of the truth has radii above the limit as well, so projecting is no loss.
        let clean = exact(&body, scattered(400, &mut s));
        let truth = ShapeFit::nearest(&clean, family, &FitOptions::default()).unwrap();
        assert!(truth.curvature_radii().min > limit && truth.statistics().active_constraints == 0);
        let far = |theta: &DVector<f64>| (free.system.root.triangle() * (theta - truth.parameters())).norm();
        assert!(far(&convex.theta) < far(&free.theta), "{} {}", far(&convex.theta), far(&free.theta));
    }
    assert!(held * 4 >= runs, "{held}");
}

#[test]
fn bad_values_are_named() {
    let body = Sphere::new(1.0).unwrap();
    let good = exact(&body, scattered(10, &mut Source::new(1)));
    let with = |change: &dyn Fn(&mut NoisyContact)| {
        let mut contacts = good.clone();
        change(&mut contacts[7]);
        fit(&contacts, ShapeFamily::Sphere).unwrap_err()
    };
    assert!(matches!(with(&|c| c.contact.point.y = f64::NAN), FitError::NotFinite { index: 7, .. }));
    assert!(matches!(with(&|c| c.noise.normal = -1.0), FitError::Noise { index: 7, name: "normal", .. }));
    assert!(matches!(
        with(&|c| c.noise.point = DMat3::ZERO),
        FitError::Noise { index: 7, name: "point", .. }
    ));
    assert!(matches!(
        with(&|c| c.noise.pose = crate::noise::PoseNoise::isotropic(0.0, 1e-3)),
        FitError::PoseNoise { index: 7 }
    ));
    assert!(matches!(
        fit(&good[..1], ShapeFamily::Sphere),
        Err(FitError::TooFew { found: 1, needed: 2, .. })
    ));
    assert!(matches!(fit(&[good[0]; 5], ShapeFamily::Sphere), Err(FitError::NoExtent { found: 5 })));
    assert!(matches!(
        fit(&good, ShapeFamily::Harmonics { degree: 40 }),
        Err(FitError::TooFew { needed: 561, .. })
    ));
    let many = exact(&body, scattered(600, &mut Source::new(1)));
    assert!(matches!(
        fit(&many, ShapeFamily::Harmonics { degree: 40 }),
        Err(FitError::Shape(ShapeError::Degree { degree: 33.., .. }))
    ));
    let options = FitOptions { smallest_radius: Some(-1.0), ..FitOptions::default() };
    assert_eq!(ShapeFit::of(&good, ShapeFamily::Sphere, &options).unwrap_err(), FitError::Radius(-1.0));
    // A hollow: points where the normals say the other side is.
    let hollow: Vec<NoisyContact> = good
        .iter()
        .map(|c| NoisyContact { contact: ContactSample { normal: -c.contact.normal, ..c.contact }, ..*c })
        .collect();
    assert!(matches!(fit(&hollow, ShapeFamily::Sphere), Err(FitError::Shape(ShapeError::Length { .. }))));
}

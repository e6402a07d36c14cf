use super::*;

fn models() -> Vec<(Box<dyn Model>, DVector<f64>)> {
    let mut s = Source::new(11);
    let ellipsoid = DVector::from_column_slice(&[0.1, -0.2, 0.3, 1.2, 0.3, 0.9, -0.2, 0.15, 0.7]);
    let superquadric = SuperquadricModel::parameters(&superquadric_body(&mut s));
    let mut harmonics = HarmonicModel::new(4).unwrap().ball(DVec3::new(0.1, 0.2, -0.3), 1.0);
    (4..25).for_each(|i| harmonics[i] = 0.02 * s.normal());
    vec![
        (Box::new(SphereModel), SphereModel.ball(DVec3::new(0.3, 0.1, -0.2), 0.7)),
        (Box::new(EllipsoidModel), ellipsoid),
        (Box::new(SuperquadricModel), superquadric),
        (Box::new(HarmonicModel::new(4).unwrap()), harmonics),
    ]
}

#[test]
fn derivatives_by_parameters_and_normal_agree_with_differences() {
    let mut s = Source::new(12);
    for (model, theta) in models() {
        let count = model.count();
        for _ in 0..50 {
            let n = Direction::new(s.direction()).unwrap();
            let mut columns = vec![DVec3::ZERO; count];
            model.columns(&theta, n, &mut columns).unwrap();
            let jet = model.body(&theta).unwrap().jet(n);
            for (i, column) in columns.iter().enumerate() {
                let mut step = DVector::zeros(count);
                let h = 1e-6;
                step[i] = h;
                let plus = model.body(&model.moved(&theta, &step)).unwrap().point(n);
                let minus = model.body(&model.moved(&theta, &-step)).unwrap().point(n);
                let slope = (plus - minus) / (2.0 * h);
                assert!((slope - *column).length() < 1e-6, "{} {slope} {column}", model.name(i));
            }
            for axis in DVec3::AXES {
                let body = model.body(&theta).unwrap();
                let at = |h: f64| body.point(Direction::new(n.get() + axis * h).unwrap());
                let slope = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!(
                    (slope - jet.hessian * axis).length() < 1e-4,
                    "{} {slope} {}",
                    model.name(0),
                    jet.hessian * axis
                );
            }
            assert!((jet.point.dot(n.get()) - jet.value).abs() < 1e-12);
        }
    }
}

#[test]
fn exact_contacts_give_the_shape_back() {
    let mut s = Source::new(13);
    for _ in 0..crate::few_or_all(8, 30) {
        let ball = Translated { body: Sphere::new(s.between(0.1, 10.0)).unwrap(), offset: s.normal3() };
        let ellipsoid = random_ellipsoid(&mut s);
        let harmonics = harmonic_body(&mut s);
        let superquadric = superquadric_body(&mut s);
        let cases: [(&dyn SupportFunction, ShapeFamily, usize); 5] = [
            (&ball, ShapeFamily::Sphere, 2),
            (&ellipsoid, ShapeFamily::Ellipsoid, 12),
            (&harmonics, ShapeFamily::Harmonics { degree: 4 }, 40),
            // A larger family holds the smaller.
            (&ball, ShapeFamily::Harmonics { degree: 3 }, 30),
            (&superquadric, ShapeFamily::Superquadric, 60),
        ];
        for (body, family, count) in cases {
            let contacts = exact(body, scattered(count, &mut s));
            let fit = ShapeFit::of(&contacts, family, &FitOptions::default()).unwrap();
            let size = contacts.iter().map(|c| c.contact.point.length()).fold(1.0, f64::max);
            assert!(distance(&fit, body) < 1e-9 * size, "{family}: {:e}", distance(&fit, body));
            assert!(fit.statistics().chi_squared < 1e-12);
        }
    }
}

#[test]
fn the_superquadrics_support_function_is_the_largest_over_its_surface() {
    let mut s = Source::new(14);
    for _ in 0..20 {
        let body = Superquadric::new(
            s.normal3(),
            DVec3::new(1.0, 0.7, 1.6),
            s.rotation(),
            [s.between(0.2, 1.8), s.between(0.2, 1.8)],
        )
        .unwrap();
        let [e1, e2] = body.exponents();
        let implicit = |y: DVec3| {
            let q = (body.rotation().inverse() * (y - body.centre())) / body.semi_axes();
            let across = q.x.abs().powf(2.0 / e2) + q.y.abs().powf(2.0 / e2);
            across.powf(e2 / e1) + q.z.abs().powf(2.0 / e1)
        };
        for _ in 0..100 {
            let (n, m) = (Direction::new(s.direction()).unwrap(), Direction::new(s.direction()).unwrap());
            assert!((implicit(body.point(n)) - 1.0).abs() < 1e-9, "{}", implicit(body.point(n)));
            assert!(body.point(m).dot(n.get()) <= body.value(n) + 1e-12);
        }
    }
    // With exponents 1 it is the ellipsoid, Hessian and all, also at the ends of the axes.
    let axes = DVec3::new(1.0, 0.7, 1.6);
    let body = Superquadric::new(DVec3::ZERO, axes, DQuat::IDENTITY, [1.0, 1.0]).unwrap();
    let ellipsoid = contact_kinematics::Ellipsoid::new(axes).unwrap();
    for n in [DVec3::X, DVec3::Y, -DVec3::Z, DVec3::new(0.6, 0.0, -0.8), DVec3::new(0.6, 0.48, 0.64)] {
        let n = Direction::new(n).unwrap();
        let (a, b) = (body.jet(n), ellipsoid.jet(n));
        assert!((a.point - b.point).length() < 1e-12, "{a:?} {b:?}");
        assert!((a.hessian - b.hessian).to_cols_array().iter().all(|v| v.abs() < 1e-10), "{a:?} {b:?}");
    }
}

#[test]
fn one_contact_at_a_time_ends_where_all_at_once_does() {
    let mut s = Source::new(15);
    let cases: [(Box<dyn SupportFunction>, ShapeFamily); 3] = [
        (Box::new(random_ellipsoid(&mut s)), ShapeFamily::Ellipsoid),
        (Box::new(superquadric_body(&mut s)), ShapeFamily::Superquadric),
        (Box::new(harmonic_body(&mut s)), ShapeFamily::Harmonics { degree: 4 }),
    ];
    for (body, family) in cases {
        let normals = scattered(120, &mut s);
        let contacts = measured(&body, normals, 1e-3, 1e-3, &mut s);
        let mut fit = IncrementalFit::new(family, FitOptions::default());
        let mut last = None;
        for contact in &contacts {
            last = fit.insert(*contact).unwrap();
        }
        let batch = ShapeFit::of(&contacts, family, &FitOptions::default()).unwrap();
        let mut stepwise = fit.fit().unwrap();
        assert!(distance(&stepwise, &batch) < 1e-9, "{family}");
        // Between two linearisations the estimate is off by a small part of its standard deviation.
        if family != ShapeFamily::Superquadric {
            stepwise.parameters = last.unwrap();
            let theta = &stepwise.parameters - batch.parameters();
            let off = theta.dot(&batch.covariance().clone().cholesky().unwrap().solve(&theta)).sqrt();
            assert!(off < 0.1, "{family}: {off}");
        }
    }
}

use super::*;
use nalgebra::DMatrix;

/// Means over seeded runs: squared error in units of the stated covariance, per parameter, and mean square error of `h`
/// against the Cramer-Rao bound, which is the covariance at the true parameters and normals.
struct Consistency {
    nees: f64,
    efficiency: f64,
    /// Standard deviation of `nees` for a true covariance.
    spread: f64,
}

fn consistency(
    family: ShapeFamily,
    truth: &DVector<f64>,
    runs: usize,
    count: usize,
    noise: (f64, f64),
) -> Consistency {
    let model = family.model().unwrap();
    let mut s = Source::new(21);
    let normals = scattered(count, &mut s);
    let parameters = family.parameters();
    let at_truth = |normals: &[DVec3], s: &mut Source, noise: (f64, f64)| {
        let body = model.body(truth).unwrap();
        normals
            .iter()
            .map(|n| {
                let n = Direction::new(*n).unwrap();
                let point = body.point(n);
                let (a, b) = n.tangent_basis();
                let turned = n.get() + (a * s.normal() + b * s.normal()) * noise.1;
                NoisyContact {
                    contact: ContactSample {
                        point: point + s.normal3() * noise.0,
                        normal: Direction::new(turned).unwrap(),
                    },
                    noise: ContactNoise::isotropic(noise.0, noise.1),
                }
            })
            .collect::<Vec<_>>()
    };
    let mut clean = at_truth(&normals, &mut s, (0.0, 0.0));
    clean.iter_mut().for_each(|c| c.noise = ContactNoise::isotropic(noise.0, noise.1));
    let root = Spatial { model: model.as_ref(), contacts: &clean, size: 1.0 }
        .assemble(truth, None)
        .unwrap()
        .root
        .inverse()
        .unwrap();
    let bound = &root * root.transpose();
    let mut nees = 0.0;
    let mut square = DMatrix::zeros(parameters, parameters);
    for _ in 0..runs {
        let contacts = at_truth(&normals, &mut s, noise);
        let data = Data::check(&contacts, &FitOptions::default()).unwrap();
        let start = truth.clone();
        let found = solve(
            &Spatial { model: model.as_ref(), contacts: &contacts, size: data.size },
            vec![start],
            Effort::default(),
            |_| true,
        )
        .ok()
        .unwrap();
        let fit = ShapeFit::finish(model.as_ref(), family, &contacts, found, &data).unwrap();
        assert_eq!(fit.statistics().active_constraints, 0);
        let error = fit.parameters() - truth;
        nees += error.dot(&fit.covariance().clone().cholesky().unwrap().solve(&error));
        square += &error * error.transpose();
    }
    let inverse = bound.try_inverse().unwrap();
    Consistency {
        nees: nees / (runs * parameters) as f64,
        efficiency: (inverse * square).trace() / (runs * parameters) as f64,
        spread: (2.0 / (runs * parameters) as f64).sqrt(),
    }
}

fn assert_consistent(family: ShapeFamily, truth: &DVector<f64>, count: usize, noise: (f64, f64)) {
    let found = consistency(family, truth, crate::few_or_all(50, 200), count, noise);
    // Four standard deviations: a true covariance fails once in 16,000 seeds.
    assert!(
        (found.nees - 1.0).abs() < 4.0 * found.spread,
        "{family}: NEES {} +- {}",
        found.nees,
        found.spread
    );
    assert!(
        (found.efficiency - 1.0).abs() < 4.0 * found.spread,
        "{family}: {} +- {}",
        found.efficiency,
        found.spread
    );
}

const NOISE: (f64, f64) = (5e-3, 5e-3);

#[test]
fn spheres_and_harmonics_have_true_covariances_and_meet_the_cramer_rao_bound() {
    let centre = DVec3::new(0.3, -0.1, 0.2);
    assert_consistent(ShapeFamily::Sphere, &SphereModel.ball(centre, 1.3), 20, NOISE);
    let mut s = Source::new(22);
    let mut harmonics = HarmonicModel::new(3).unwrap().ball(centre, 1.0);
    (4..16).for_each(|i| harmonics[i] = 0.03 * s.normal());
    assert_consistent(ShapeFamily::Harmonics { degree: 3 }, &harmonics, 40, NOISE);
}

#[test]
fn ellipsoids_have_true_covariances_and_meet_the_cramer_rao_bound() {
    let truth = DVector::from_column_slice(&[0.1, -0.2, 0.3, 1.2, 0.3, 0.9, -0.2, 0.15, 0.7]);
    assert_consistent(ShapeFamily::Ellipsoid, &truth, 40, NOISE);
    // With exact points or exact normals alone, too.
    assert_consistent(ShapeFamily::Ellipsoid, &truth, 40, (5e-3, 0.0));
    assert_consistent(ShapeFamily::Ellipsoid, &truth, 40, (1e-4, 5e-3));
}

#[test]
fn superquadrics_have_true_covariances_and_meet_the_cramer_rao_bound() {
    let body =
        Superquadric::new(DVec3::ZERO, DVec3::new(1.0, 0.8, 1.4), DQuat::IDENTITY, [0.8, 1.25]).unwrap();
    assert_consistent(ShapeFamily::Superquadric, &SuperquadricModel::parameters(&body), 60, (2e-3, 2e-3));
}

#[test]
fn an_unknown_noise_level_is_estimated() {
    let mut s = Source::new(23);
    let body = random_ellipsoid(&mut s);
    let options = FitOptions { noise_level: NoiseLevel::Estimated, ..FitOptions::default() };
    let mut sum = 0.0;
    for _ in 0..50 {
        let normals = scattered(50, &mut s);
        let mut contacts = measured(&body, normals, 3e-3, 3e-3, &mut s);
        contacts.iter_mut().for_each(|c| c.noise = ContactNoise::isotropic(1.0, 1.0));
        let fit = ShapeFit::of(&contacts, ShapeFamily::Ellipsoid, &options).unwrap();
        sum += fit.statistics().noise_factor.powi(2);
    }
    // A variance of 2 / (141 * 50).
    assert!(
        (sum / 50.0 / 9e-6 - 1.0).abs() < 4.0 * (2.0_f64 / (141.0 * 50.0)).sqrt(),
        "{}",
        sum / 50.0 / 9e-6
    );
}

#[test]
fn the_error_falls_with_the_root_of_the_number_of_contacts() {
    let mut s = Source::new(24);
    let body = random_ellipsoid(&mut s);
    let mut error = |count: usize| {
        let runs = 30;
        let square: f64 = (0..runs)
            .map(|_| {
                let contacts = measured(&body, scattered(count, &mut s), 5e-3, 5e-3, &mut s);
                distance(
                    &ShapeFit::of(&contacts, ShapeFamily::Ellipsoid, &FitOptions::default()).unwrap(),
                    &body,
                )
                .powi(2)
            })
            .sum();
        (square / f64::from(runs)).sqrt()
    };
    let order = (error(25) / error(400)).log2() / 4.0;
    assert!((order - 0.5).abs() < 0.15, "{order}");
}

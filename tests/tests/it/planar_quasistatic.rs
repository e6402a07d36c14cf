//! Quasistatic reconstruction in the plane, on equilibria computed from the shape alone.

use glam::DVec2;
use recon::contact_kinematics::planar::*;
use recon::object_dynamics::planar::*;
use recon::observer::planar::*;

/// The design's body: ellipse of 50 x 40 mm, centre of mass 6 mm off.
fn body() -> Ellipse {
    Ellipse::new(0.05, 0.04, DVec2::new(0.006, 0.0)).unwrap()
}

/// Log of equilibria along a path of the palms.
fn log(shape: &impl RadiusFunction, palms: &[PalmPair], phi0: f64) -> (PlanarLog, Vec<Equilibrium>) {
    let path = PlanarEquilibria::new(shape).follow(palms, phi0).unwrap();
    let samples = path
        .iter()
        .zip(palms)
        .enumerate()
        .map(|(k, (e, p))| PlanarSample {
            t: k as f64,
            angles: [p.angles()[0], p.wedge()],
            contacts: e.contact.s.map(Some),
            ..PlanarSample::default()
        })
        .collect();
    (PlanarLog::new(samples, None).unwrap(), path)
}

/// The pair rotates by 55 degrees with a fixed angle.
fn rotation(count: usize) -> Vec<PalmPair> {
    (0..count)
        .map(|k| {
            let u = k as f64 / (count - 1) as f64;
            PalmPair::new((20.0 + 55.0 * u).to_radians(), 80_f64.to_radians()).unwrap()
        })
        .collect()
}

/// The stable equilibrium nearest to `near`.
fn stable_start(shape: &impl RadiusFunction, palms: &PalmPair, near: f64) -> f64 {
    let all = PlanarEquilibria::new(shape).all(palms);
    let stable = all.iter().filter(|e| e.stability > 0.0).map(|e| e.phi0);
    stable.min_by(|a, b| (a - near).abs().total_cmp(&(b - near).abs())).unwrap()
}

fn errors(path: &QuasistaticPath, truth: &[Equilibrium]) -> (f64, f64) {
    let r =
        path.points.iter().zip(truth).map(|(p, e)| {
            (p.radii[0] - e.contact.jets[0].r).abs().max((p.radii[1] - e.contact.jets[1].r).abs())
        });
    let phi = path.points.iter().zip(truth).map(|(p, e)| (p.phi0 - (e.phi0 - truth[0].phi0)).abs());
    (r.fold(0.0, f64::max), phi.fold(0.0, f64::max))
}

#[test]
fn closed_form_converges_with_fourth_order() {
    let palms = rotation(101);
    let start = stable_start(&body(), &palms[0], 0.72);
    let mut table = Vec::new();
    for count in [51, 101, 201, 401] {
        let palms = rotation(count);
        let (log, truth) = log(&body(), &palms, start);
        let path = quasistatic_reconstruction(&log, truth[0].contact.p_WCm.y).unwrap();
        let (r, phi) = errors(&path, &truth);
        println!(
            "{count} samples: r {:.1e} mm, phi0 {phi:.1e} rad, condition {:.1}",
            1e3 * r,
            path.condition
        );
        // Balance does not depend on the quadrature: X is algebraic.
        for (p, e) in path.points.iter().zip(&truth) {
            assert!((p.p_WCm.x - e.contact.p_WCm.x).abs() < 1e-15);
        }
        table.push((r, phi));
    }
    for pair in table.windows(2).take(2) {
        let order = [(pair[0].0 / pair[1].0).log2(), (pair[0].1 / pair[1].1).log2()];
        assert!(order.iter().all(|&o| o > 3.5), "{order:?}");
    }
    // A second-order quadrature reaches 4.9e-4 mm and 1.7e-4 rad with 101 samples.
    assert!(table[1].0 < 1e-8 && table[1].1 < 1e-5, "{:?}", table[1]);
}

/// An error of the height shifts both radius functions by a constant times the cosine of the palm, without growth.
#[test]
fn an_error_of_the_height_does_not_grow() {
    let palms = rotation(401);
    let (log, truth) = log(&body(), &palms, stable_start(&body(), &palms[0], 0.72));
    let path = quasistatic_reconstruction(&log, truth[0].contact.p_WCm.y + 1e-3).unwrap();
    for ((p, e), pair) in path.points.iter().zip(&truth).zip(&palms) {
        let [c1, c2] = pair.angles().map(f64::cos);
        assert!((p.radii[0] - e.contact.jets[0].r - 1e-3 * c1).abs() < 1e-9);
        assert!((p.radii[1] - e.contact.jets[1].r + 1e-3 * c2).abs() < 1e-9);
    }
}

/// The noise of the radius functions is that of the algebraic X; the quadrature's part of it does not grow.
#[test]
fn noise_passes_without_growth() {
    let palms = rotation(1601);
    let (clean, truth) = log(&body(), &palms, stable_start(&body(), &palms[0], 0.72));
    for contact in [1e-4, 1e-3] {
        let (mut square, mut expected) = ([0.0, 0.0], 0.0);
        let mut phi = 0.0_f64;
        for seed in 0..10 {
            let noisy = PlanarNoise { contact, ..PlanarNoise::default() }.add_to(&clean, seed);
            let path = quasistatic_reconstruction(&noisy, truth[0].contact.p_WCm.y).unwrap();
            for (k, ((p, e), pair)) in path.points.iter().zip(&truth).zip(&palms).enumerate() {
                let [a, b] = pair.angles().map(f64::sin);
                let error = [0, 1].map(|i| p.radii[i] - e.contact.jets[i].r);
                square[k / 801] += error[0].powi(2) + error[1].powi(2);
                expected += (a * a + b * b).powi(2) * (contact / pair.sin()).powi(2);
            }
            phi = phi.max((path.points[1600].phi0 - (truth[1600].phi0 - truth[0].phi0)).abs());
        }
        let samples = f64::from(2 * 10 * 1601);
        let rms = f64::sqrt((square[0] + square[1]) / samples);
        let theory = f64::sqrt(expected / samples);
        println!(
            "noise {} mm: r {:.3} mm rms (noise of X alone {:.3}), phi0 at the end within {phi:.3} rad",
            1e3 * contact,
            1e3 * rms,
            1e3 * theory
        );
        // 32000 errors: 1 % statistics; the quadrature adds some per cent.
        assert!((rms / theory - 1.0).abs() < 0.05, "{rms} {theory}");
        assert!(square[1] < 1.3 * square[0], "the second half is no worse");
        // First order: contact noise over the lever (5.6 mm at least) at the ends of the path. Second order: at each sample
        // the noise of the lever times that of its neighbours, a random walk over 1601 samples.
        let share = contact / 0.0056;
        assert!(phi < 4.0 * (share + 1601_f64.sqrt() * share * share), "{phi}");
    }
}

#[test]
fn closure_on_a_loop_gives_the_height() {
    let count = 801;
    let palms: Vec<PalmPair> = (0..count)
        .map(|k| {
            let u = k as f64 / (count - 1) as f64 * std::f64::consts::TAU;
            let (sin, cos) = u.sin_cos();
            PalmPair::new((20.0 + 15.0 * sin).to_radians(), (60.0 + 10.0 * (1.0 - cos)).to_radians()).unwrap()
        })
        .collect();
    let (log, truth) = log(&body(), &palms, stable_start(&body(), &palms[0], 0.72));
    let height = truth[0].contact.p_WCm.y;
    let fit = height_from_closure(&log, [height - 0.002, height + 0.002]).unwrap();
    println!(
        "height from closure: error {:.1e} mm, sensitivity {:.4} rad/mm",
        1e3 * (fit.height - height),
        1e-3 * fit.sensitivity
    );
    assert!((fit.height - height).abs() < 2e-7, "{fit:?} {height}");
}

#[test]
fn failure_cases_are_named() {
    let palms = rotation(101);
    // A disc about its centre: the lines of force meet in the centre of mass.
    let disc = Circle::new(0.04, DVec2::ZERO).unwrap();
    let contact = |p: &PalmPair| PairContact::new(&disc, p, 0.0);
    let samples: Vec<_> = palms
        .iter()
        .enumerate()
        .map(|(k, p)| PlanarSample {
            t: k as f64,
            angles: [p.angles()[0], p.wedge()],
            contacts: contact(p).s.map(Some),
            ..PlanarSample::default()
        })
        .collect();
    let disc_log = PlanarLog::new(samples.clone(), None).unwrap();
    let height = contact(&palms[0]).p_WCm.y;
    assert!(matches!(
        quasistatic_reconstruction(&disc_log, height),
        Err(QuasistaticError::NoLever { sample: 0, .. })
    ));
    let mut lost = samples;
    lost[7].contacts[1] = None;
    let lost = PlanarLog::new(lost, None).unwrap();
    assert!(matches!(
        quasistatic_reconstruction(&lost, height),
        Err(QuasistaticError::LostContact { palm: 2, sample: 7 })
    ));
    assert!(matches!(height_from_closure(&disc_log, [0.0, 1.0]), Err(QuasistaticError::NoLoop { .. })));
}

/// An object that jumps from one stable branch to another betrays itself.
#[test]
fn a_jump_is_reported() {
    let shape = body();
    let palms: Vec<PalmPair> =
        (0..1300).map(|k| PalmPair::new(0.2 + 1.2e-3 * f64::from(k), 1.3).unwrap()).collect();
    let equilibria = PlanarEquilibria::new(&shape);
    let start = stable_start(&shape, &palms[0], 3.06);
    let Err(FollowError::Fold { index, stability, phi0 }) = equilibria.follow(&palms, start) else {
        panic!("this branch ends");
    };
    let stability_at_start =
        equilibria.all(&palms[0]).iter().find(|e| (e.phi0 - start).abs() < 1e-9).unwrap().stability;
    assert!(index > 100 && stability < 0.2 * stability_at_start, "{index} {stability} {stability_at_start}");
    let until = &palms[..index];
    let (log_before, truth) = log(&shape, until, start);
    let smooth = quasistatic_reconstruction(&log_before, truth[0].contact.p_WCm.y).unwrap();
    // Towards the fold the turn of the object runs away from that of the palms.
    assert!(smooth.gain.0 > 2.0 && smooth.gain.1 == index - 1, "{:?} of {index}", smooth.gain);
    // After it the object sits on another branch.
    let next = equilibria.all(&palms[index]);
    let landing = next
        .iter()
        .filter(|e| e.stability > 0.0 && equilibria.follow(&palms[index..index + 50], e.phi0).is_ok())
        .min_by(|a, b| (a.phi0 - phi0).abs().total_cmp(&(b.phi0 - phi0).abs()))
        .unwrap();
    let (log_after, _) = log(&shape, &palms[index..index + 50], landing.phi0);
    let mut samples = log_before.samples().to_vec();
    samples.extend(log_after.samples());
    for (k, s) in samples.iter_mut().enumerate() {
        s.t = k as f64;
    }
    let joined = PlanarLog::new(samples, None).unwrap();
    // Its centre of mass is then on the other side of where the lines of force meet.
    let refused = quasistatic_reconstruction(&joined, truth[0].contact.p_WCm.y);
    assert!(matches!(refused, Err(QuasistaticError::NoLever { sample, .. }) if sample.abs_diff(index) <= 1));
}

/// A gap in the log, over which the palms' work is not known: the two palms' accounts of the turn disagree there.
#[test]
fn a_gap_is_reported_by_the_mismatch() {
    let palms = rotation(401);
    let (whole, truth) = log(&body(), &palms, stable_start(&body(), &palms[0], 0.72));
    let smooth = quasistatic_reconstruction(&whole, truth[0].contact.p_WCm.y).unwrap();
    let kept = whole.samples().iter().enumerate().filter(|(k, _)| !(150..250).contains(k));
    let gap = PlanarLog::new(kept.map(|(_, s)| *s).collect(), None).unwrap();
    let path = quasistatic_reconstruction(&gap, truth[0].contact.p_WCm.y).unwrap();
    println!("gap at 150: mismatch {:?}, without {:?}", path.mismatch, smooth.mismatch);
    assert!(path.mismatch.1.abs_diff(150) <= 1, "{:?}", path.mismatch);
    assert!(path.mismatch.0 > 100.0 * smooth.mismatch.0);
}

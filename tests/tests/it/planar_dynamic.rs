//! Dynamic reconstruction in the plane: the paper's vector fields, the Newton observer, cold starts.

use crate::planar_common::{last_estimate, scene, times};
use nalgebra::{SMatrix, SVector};
use recon::contact_kinematics::planar::PairContact;
use recon::object_dynamics::planar::*;
use recon::observer::planar::*;
use recon::observer::{Arrival, Model, Status};

fn nominal(object: &PlanarObject<crate::planar_common::Shape>, contact: f64, force: f64) -> PlanarNominal {
    PlanarNominal {
        mass: object.mass,
        gravity: object.gravity,
        contact_deviation: contact,
        force_deviation: force,
    }
}

/// A log with forces or torques only, as a robot would have it.
fn log(run: &PlanarRun) -> PlanarLog {
    run.log().unwrap()
}

#[test]
fn authors_vector_fields_are_the_simulation() {
    let mut worst: f64 = 0.0;
    for name in [
        "S1_tumble_immobile",
        "S2_rotating_pair",
        "S4_ellipse_both_palms_move",
        "F3_paper_scale_rotating",
        "N1_nondim_rotating",
    ] {
        let (object, motion, start) = scene(name);
        let run = simulate_prescribed(&object, &motion, start, &times(100.0, 0.9), 1e-13).unwrap();
        assert!(run.samples.len() > 80, "{name}");
        for s in &run.samples {
            let palms = motion.at(s.sample.t).unwrap();
            let fields =
                AuthorsFields { mass: object.mass, gravity: object.gravity, palm_rates: palms.motion.rates };
            let contact = PairContact::new(&object.shape, &palms.pair, s.truth.phi0);
            let q = AuthorsFields::state_of(&contact, &palms.pair, s.truth.omega0);
            let rate = fields.rate(&q, s.sample.torques.unwrap()).unwrap();
            let velocity = contact.velocity(&palms, s.truth.omega0);
            let [z1, z2] = velocity.relative_rates;
            let [j1, j2] = contact.jets;
            let [w1, w2] = palms.motion.rates;
            let [s1, s2] = velocity.s_rates;
            let expected = AuthorsState::from([j1.d * z1, j2.d * z2, s.alpha0, s1, s2, w1, w2 - w1]);
            // Scale of a field component: the largest of its terms, of which the result is the difference.
            let [g1, g2] = fields.inputs(&q).unwrap();
            let tau = s.sample.torques.unwrap();
            let drift = fields.drift(&q).unwrap();
            for i in 0..7 {
                let size = [drift[i], g1[i] * tau[0], g2[i] * tau[1], expected[i]];
                let size = size.into_iter().fold(f64::MIN_POSITIVE, |m: f64, v| m.max(v.abs()));
                let error = (rate[i] - expected[i]).abs() / size;
                assert!(error < 1e-12, "{name} t {} component {i}: {error:.1e}", s.sample.t);
                worst = worst.max(error);
            }
            // To the regular coordinates and back.
            let x = fields.to_motion(&q).unwrap();
            assert!((x[2] - s.truth.v_WCm.x).abs().max((x[3] - s.truth.v_WCm.y).abs()) < 1e-12 * 10.0);
            let back = fields.from_motion(&x, &palms).unwrap();
            assert!((back - q).amax() < 1e-11, "{name}");
        }
    }
    println!("authors' fields: largest relative difference {worst:.1e}");
}

#[test]
fn jacobians_agree_with_differences() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(100.0, 0.4), 1e-13).unwrap();
    let log = log(&run);
    let inputs = planar_samples(&log, 0.02).unwrap();
    let scale = NaturalScale::from_sample(&log.samples()[0], object.gravity).unwrap();
    let constants = [
        Constant::Mass,
        Constant::Inertia,
        Constant::ForceGain(Side::First),
        Constant::ForceBias(Side::Second),
        Constant::ContactOffset(Side::First),
        Constant::ContactOffset(Side::Second),
    ];
    let model = ForceDriven::<11>::new(nominal(&object, 1e-4, 0.02), scale, &constants).unwrap();
    let truth = &run.samples[20].truth;
    let mut x = SVector::<f64, 11>::from_fn(|i, _| 0.01 * (i as f64 - 4.0));
    x.fixed_rows_mut::<5>(0).copy_from_slice(&[
        truth.p_WCm.x,
        truth.p_WCm.y,
        truth.v_WCm.x,
        truth.v_WCm.y,
        truth.omega0,
    ]);
    // Also where an object stands still against a palm (omega0 = W = 0.2), where the paper's coordinates are singular.
    for omega0 in [truth.omega0, 0.2, 0.25] {
        x[4] = omega0;
        let (_, flow) = model.flow(&x, &inputs[21]);
        let (_, output) = model.output(&x, &inputs[21]);
        assert!(flow.iter().chain(output.iter()).all(|v| v.is_finite()));
        let scales = model.scales();
        for k in 0..11 {
            let h = 1e-6 * scales[k];
            let (mut low, mut high) = (x, x);
            low[k] -= h;
            high[k] += h;
            let by_flow = (model.advance(&high, &inputs[21]) - model.advance(&low, &inputs[21])) / (2.0 * h);
            let by_output =
                (model.output(&high, &inputs[21]).0 - model.output(&low, &inputs[21]).0) / (2.0 * h);
            for i in 0..11 {
                let error = (by_flow[i] - flow[(i, k)]) * scales[k] / scales[i];
                assert!(error.abs() < 1e-6, "omega0 {omega0} flow ({i}, {k}): {error:e}");
            }
            for i in 0..2 {
                let error = (by_output[i] - output[(i, k)]) * scales[k] / scales[0];
                assert!(error.abs() < 1e-6, "omega0 {omega0} output ({i}, {k}): {error:e}");
            }
        }
    }
}

/// The paper's Fig. 3: pair of palms that turns with a fixed angle, 5 % initial error, one Newton step a sample.
#[test]
fn figure_3_of_the_paper() {
    let (object, motion, start) = scene("F3_paper_scale_rotating");
    let run = simulate_prescribed(&object, &motion, start, &times(1000.0, 1.4), 1e-14).unwrap();
    let first = &run.samples[0].truth;
    let guess = [
        first.p_WCm.x * 1.05,
        first.p_WCm.y * 1.05,
        first.v_WCm.x * 1.05,
        first.v_WCm.y * 0.95,
        first.omega0 * 1.05,
    ];
    let options = PlanarObserverOptions {
        window: Some(0.2),
        settle: Some(0.1),
        start: PlanarStartFrom::Motion(guess),
        arrival: Arrival::Forget,
        ..PlanarObserverOptions::default()
    };
    let mut observer = PlanarObserver::<5>::new(nominal(&object, 0.0, 0.0), &[], options).unwrap();
    let (mut worst_r, mut worst_phi): (f64, f64) = (0.0, 0.0);
    for s in &run.samples {
        let Some(estimate) = observer.push(&s.sample).unwrap() else { continue };
        if s.sample.t < 0.2 {
            continue;
        }
        let palms = motion.at(s.sample.t).unwrap();
        let truth = PairContact::new(&object.shape, &palms.pair, s.truth.phi0);
        for i in 0..2 {
            worst_r = worst_r.max((estimate.radii[i] - truth.jets[i].r).abs());
        }
        worst_phi = worst_phi.max((estimate.phi0 - (s.truth.phi0 - first.phi0)).abs());
        assert_eq!(estimate.report.status, Status::Converged, "t = {}", s.sample.t);
    }
    println!("Fig. 3 run: error in r {worst_r:.1e}, in phi0 {worst_phi:.1e}");
    assert!(worst_r < 1e-9, "{worst_r:e}");
    assert!(worst_phi < 1e-8, "{worst_phi:e}");
}

/// No guess at all: every scene that turns is found, to the accuracy that the sampling allows.
#[test]
fn cold_start_needs_no_guess() {
    for (name, settle) in [
        ("S1_tumble_immobile", 0.4),
        ("S2_rotating_pair", 0.4),
        ("S3_rocking_immobile", 0.4),
        ("S4_ellipse_both_palms_move", 0.4),
        ("F3_paper_scale_rotating", 1.3),
    ] {
        let (object, motion, start) = scene(name);
        let run = simulate_prescribed(&object, &motion, start, &times(1000.0, settle + 0.05), 1e-13).unwrap();
        let options = PlanarObserverOptions { settle: Some(settle), ..PlanarObserverOptions::default() };
        let mut observer = PlanarObserver::<5>::new(nominal(&object, 0.0, 0.0), &[], options).unwrap();
        let mut last = None;
        for s in &run.samples {
            last = observer.push(&s.sample).unwrap().map(|e| (e, s)).or(last);
        }
        let (estimate, s) = last.unwrap();
        let palms = motion.at(s.sample.t).unwrap();
        let truth = PairContact::new(&object.shape, &palms.pair, s.truth.phi0);
        let length = observer.scale().unwrap().length;
        let error = (0..2).map(|i| (estimate.radii[i] - truth.jets[i].r).abs()).fold(0.0, f64::max) / length;
        println!("{name}: relative error in r {error:.1e}, {:?}", estimate.report.status);
        assert!(error < 1e-7, "{name}: {error:e}");
    }
}

/// The covariance is that of the estimates: an identity matrix is what normalised errors of the linear problem have.
#[test]
fn covariance_of_a_noise_free_run_is_finite_and_symmetric() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(1000.0, 0.5), 1e-13).unwrap();
    let options = PlanarObserverOptions { settle: Some(0.4), ..PlanarObserverOptions::default() };
    let mut observer = PlanarObserver::<5>::new(nominal(&object, 1e-4, 0.02), &[], options).unwrap();
    for s in &run.samples {
        if let Some(estimate) = observer.push(&s.sample).unwrap() {
            let p: SMatrix<f64, 5, 5> = estimate.report.covariance;
            assert_eq!(p, p.transpose());
            assert!(p.cholesky().is_some());
        }
    }
}

/// The interpolation knows its own error: at 100 Hz, against forces simulated in the middle of the intervals.
#[test]
fn interpolation_error_is_estimated() {
    let (mut actual, mut stated, mut count) = (0.0, 0.0, 0);
    for name in ["S1_tumble_immobile", "S2_rotating_pair", "S4_ellipse_both_palms_move"] {
        let (object, motion, start) = scene(name);
        let run = simulate_prescribed(&object, &motion, start, &times(200.0, 0.9), 1e-13).unwrap();
        let log = log(&run);
        let coarse = PlanarLog::new(log.samples().iter().copied().step_by(2).collect(), None).unwrap();
        let inputs = planar_samples(&coarse, 0.0).unwrap();
        for (k, input) in inputs.iter().enumerate().skip(6) {
            let middle = log.samples()[2 * k - 1].forces.unwrap();
            let stage = &input.stages[1];
            for ((force, truth), error) in stage.forces.iter().zip(middle).zip(input.force_error) {
                actual += (force - truth).powi(2);
                stated += error.powi(2);
                count += 1;
            }
        }
    }
    let (actual, stated) = (f64::sqrt(actual / f64::from(count)), f64::sqrt(stated / f64::from(count)));
    println!("interpolation error of the forces at 100 Hz: {actual:.2e} N, stated {stated:.2e} N");
    assert!(actual < 3.0 * stated && stated < 3.0 * actual, "{actual} {stated}");
}

/// Heavy palms that swing, torques in the log in place of forces: with their inertia the observer finds the motion, and
/// without it the readings contradict each other.
#[test]
fn torques_of_palms_with_inertia() {
    let (object, _, start) = scene("S2_rotating_pair");
    let motion = HarmonicPalms {
        centres: [0.8, 1.5],
        amplitudes: [0.05, 0.08],
        frequencies: [5.0, 7.0],
        phases: [0.3, 1.0],
    };
    let inertias = [4e-4, 3e-4];
    let run = simulate_prescribed(&object, &motion, start, &times(1000.0, 0.6), 1e-13).unwrap();
    assert!(run.lost.is_none());
    let clean = log(&run);
    let loaded = clean.samples().iter().map(|s| {
        let state = motion.at(s.t).unwrap();
        let ([f1, f2], [s1, s2]) = (s.forces.unwrap(), s.contacts.map(Option::unwrap));
        let a = state.motion.accelerations;
        // Ground-referenced motors: I_1 A_1 = tau_1 - f_1 s_1, I_2 A_2 = tau_2 + f_2 s_2.
        let torques = [inertias[0] * a[0] + f1 * s1, inertias[1] * a[1] - f2 * s2];
        PlanarSample { forces: None, torques: Some(torques), ..*s }
    });
    let exact = PlanarLog::new(loaded.collect(), None).unwrap();
    let noisy = PlanarNoise { contact: 1e-4, ..PlanarNoise::default() }.add_to(&exact, 3);
    let errors = |log: &PlanarLog, contact: f64, palm_inertias: [f64; 2]| {
        let options =
            PlanarObserverOptions { settle: Some(0.4), palm_inertias, ..PlanarObserverOptions::default() };
        let observer = PlanarObserver::<5>::new(nominal(&object, contact, 0.0), &[], options).unwrap();
        let last = last_estimate(observer, log.samples().iter().copied());
        let truth = run.samples.last().unwrap();
        let palms = motion.at(truth.sample.t).unwrap();
        let r = PairContact::new(&object.shape, &palms.pair, truth.truth.phi0).jets.map(|j| j.r);
        let worst = (0..2).map(|i| (last.radii[i] - r[i]).abs()).fold(0.0, f64::max);
        (worst, last.doubt, last.radius_deviations)
    };
    let (worst, ..) = errors(&exact, 0.0, inertias);
    println!("palms with inertia, exact torques: error in r {:.1e} mm", 1e3 * worst);
    assert!(worst < 1e-8, "{worst:e}");
    let (worst, doubt, deviations) = errors(&noisy, 1e-4, inertias);
    println!("palms with inertia, 0.1 mm: error in r {:.1e} mm, deviations {deviations:?}", 1e3 * worst);
    assert!(doubt.is_none() && worst < 4.0 * deviations[0].max(deviations[1]), "{worst:e} {doubt:?}");
    let (worst, doubt, _) = errors(&noisy, 1e-4, [0.0; 2]);
    println!("the same, taken as massless: error in r {:.1e} mm, {doubt:?}", 1e3 * worst);
    assert!(matches!(doubt, Some(Doubt::Residual { .. })), "{doubt:?}");
    let negative = PlanarObserverOptions { palm_inertias: [0.0, -1.0], ..PlanarObserverOptions::default() };
    assert!(PlanarObserver::<5>::new(nominal(&object, 0.0, 0.0), &[], negative).is_err());
}

//! The paper's own reconstruction, (35) to (37) from given initial conditions: right on exact data, useless otherwise.

use crate::noisy::estimated;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{
    BodyState, Instant, Sample, SensorLog, SensorNoise, Simulation, ThreePalmScene,
};
use recon::observer::three_palms::Track;
use recon::observer::three_palms::paper_method::{
    PaperError, PaperMethod, PaperReconstruction, PaperStart, PredictorCorrector, integrate_paper_system,
};
use recon_tests::{exact_log, f5, g2};

const ADAMS: PaperMethod = PaperMethod { scheme: PredictorCorrector::Adams4, enforce_constraint: false };
const HEUN: PaperMethod = PaperMethod { scheme: PredictorCorrector::Heun, enforce_constraint: false };

fn true_start(simulation: &Simulation) -> PaperStart {
    let now = &simulation.instants[0];
    PaperStart { radii: now.touch.contacts.map(|c| c.jet.value), R_WO: now.R_WO, w_WO: now.w_WO }
}

fn reconstruct<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
    start: &PaperStart,
    method: PaperMethod,
) -> PaperReconstruction {
    let track = Track::new(log, scene.gravity(), None).unwrap();
    integrate_paper_system(&track, scene.mass(), start, method).unwrap()
}

fn radius_error(found: &PaperReconstruction, simulation: &Simulation) -> f64 {
    let pairs = found.radii.iter().zip(&simulation.instants);
    pairs
        .flat_map(|(r, now)| (0..3).map(|i| (r[i] - now.touch.contacts[i].jet.value).abs()))
        .fold(0.0, f64::max)
}

fn run_error(rate: f64, method: PaperMethod) -> f64 {
    let (scene, start) = f5();
    let (simulation, log) = exact_log(&scene, start, 4.2, rate);
    let found = reconstruct(&scene, &log, &true_start(&simulation), method);
    assert_eq!(found.diverged_at, None);
    radius_error(&found, &simulation)
}

#[test]
fn exact_data_and_exact_start_give_the_radius_functions() {
    // An independent implementation of the same scheme left 9.7e-10 at 1 kHz and 6.4e-6 at 100 Hz on this scene.
    let (fast, slow) = (run_error(1000.0, ADAMS), run_error(100.0, ADAMS));
    assert!(fast < 5e-9, "{fast:e}");
    assert!(slow < 5e-5, "{slow:e}");
    let (scene, start) = g2();
    let (simulation, log) = exact_log(&scene, start, 4.0, 1000.0);
    let found = reconstruct(&scene, &log, &true_start(&simulation), ADAMS);
    let error = radius_error(&found, &simulation);
    assert!(error < 1e-9, "{error:e}");
}

#[test]
fn schemes_converge_with_their_order() {
    let order = |method| (run_error(125.0, method) / run_error(250.0, method)).log2();
    let (heun, adams) = (order(HEUN), order(ADAMS));
    assert!((1.6..2.4).contains(&heun), "{heun}");
    assert!((3.5..5.2).contains(&adams), "{adams}");
}

#[test]
fn errors_of_the_start_grow_a_hundred_thousandfold() {
    let (scene, start) = f5();
    let (simulation, log) = exact_log(&scene, start, 4.2, 500.0);
    let exact = true_start(&simulation);
    let found = reconstruct(&scene, &log, &exact, ADAMS);
    // Measured independently: largest singular value 1.6e5 at 4.2 s (in units of length and rate of one).
    assert!((2e4..1e6).contains(&found.amplification()), "{:e}", found.amplification());
    let off = PaperStart { w_WO: exact.w_WO * 1.01, ..exact };
    let off = reconstruct(&scene, &log, &off, ADAMS);
    assert!(off.diverged_at.is_some() || radius_error(&off, &simulation) > 0.5);
}

#[test]
fn noise_that_the_estimator_averages_ruins_the_integration() {
    let (scene, start) = f5();
    let (simulation, log) = exact_log(&scene, start, 4.2, 500.0);
    let noise = SensorNoise { contact: 2.5e-3, force: 0.0, torque: 0.0 };
    let noisy = log.with_noise(&noise, 3).unwrap();
    let integrated = reconstruct(&scene, &noisy, &true_start(&simulation), ADAMS);
    let found = estimated(&scene, &noisy, noise, true);
    // Palms meet in the world's origin: a radius is how far the centre of mass is from a palm.
    let off = |(state, (now, sample)): (&BodyState, (&Instant, &Sample))| {
        let radius = |i: usize| sample.palms[i].normal.get().dot(state.p_WCm);
        (0..3).map(|i| (radius(i) - now.touch.contacts[i].jet.value).abs()).fold(0.0, f64::max)
    };
    let pairs = found.states.iter().zip(simulation.instants.iter().zip(noisy.samples()));
    let fitted = pairs.map(off).fold(0.0, f64::max);
    assert!(fitted < 0.02, "{fitted}");
    assert!(integrated.diverged_at.is_some() || radius_error(&integrated, &simulation) > 10.0 * fitted);
}

#[test]
fn bad_input_is_named() {
    let (scene, start) = f5();
    let (simulation, log) = exact_log(&scene, start, 1.0, 100.0);
    let track = Track::new(&log, scene.gravity(), None).unwrap();
    let exact = true_start(&simulation);
    let wrong = PaperStart { radii: [1.0, f64::NAN, 1.0], ..exact };
    let result = integrate_paper_system(&track, scene.mass(), &wrong, ADAMS);
    assert!(matches!(result.err(), Some(PaperError::NotFinite { .. })));
    let mut samples = log.samples().to_vec();
    samples.remove(20);
    let uneven = SensorLog::new(samples, None).unwrap();
    let uneven = Track::new(&uneven, scene.gravity(), None).unwrap();
    let result = integrate_paper_system(&uneven, scene.mass(), &exact, ADAMS);
    assert!(matches!(result.err(), Some(PaperError::UnevenSamples { index: 19, .. })));
    assert!(integrate_paper_system(&uneven, scene.mass(), &exact, HEUN).is_ok());
}

#[test]
fn enforcing_the_acceleration_constraint_tames_the_instability() {
    // The paper asks for it, (24), and is right to: 2.5e5 against 17 to 19 over this run. The price is second
    // differences of the contacts, so that the gain is lost on noisy data.
    let (scene, start) = f5();
    let (simulation, log) = exact_log(&scene, start, 4.2, 100.0);
    let exact = true_start(&simulation);
    for scheme in [PredictorCorrector::Heun, PredictorCorrector::Adams4] {
        let free = reconstruct(&scene, &log, &exact, PaperMethod { scheme, enforce_constraint: false });
        let held = reconstruct(&scene, &log, &exact, PaperMethod { scheme, enforce_constraint: true });
        assert!(free.amplification() > 1e5 && held.amplification() < 30.0, "{}", held.amplification());
        assert!(held.constraint_defect < 0.1 * free.constraint_defect);
        assert!(radius_error(&held, &simulation) < radius_error(&free, &simulation));
    }
}

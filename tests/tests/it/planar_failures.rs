//! Where the planar observer has to say that it does not know.

use crate::planar_common::{last_estimate, scene, state, times};
use glam::DVec2;
use recon::contact_kinematics::planar::*;
use recon::object_dynamics::planar::*;
use recon::observer::planar::*;
use recon::observer::{Model, Status};

const CONTACT: f64 = 1e-4;
const FORCE_SHARE: f64 = 0.002;
const RATE: f64 = 500.0;

struct Case<S> {
    object: PlanarObject<S>,
    motion: ConstantRates,
    start: PlanarStart,
    /// Window, s.
    window: f64,
    /// Noise of the forces in weights.
    force_share: f64,
    /// Samples a second.
    rate: f64,
}

/// A case with the usual noise and sampling.
fn case_of<S>(object: PlanarObject<S>, motion: ConstantRates, start: PlanarStart, window: f64) -> Case<S> {
    Case { object, motion, start, window, force_share: FORCE_SHARE, rate: RATE }
}

/// Last estimates over seeds, and how they stand to the truth.
struct Verdict {
    statuses: Vec<Status>,
    /// Largest error in standard deviations.
    worst: f64,
    /// Standard deviation of the angular velocity, rad/s, and of the radius functions, m (medians).
    omega_deviation: f64,
    radius_deviation: f64,
    condition: f64,
    smallest_information: f64,
    words: String,
    doubts: Vec<Doubt>,
}

fn body(shape: impl RadiusFunction) -> PlanarObject<impl RadiusFunction> {
    PlanarObject { shape, mass: PlanarMass::from_gyration(0.2, 0.0008).unwrap(), gravity: 9.81 }
}

fn wedge() -> ConstantRates {
    ConstantRates { angles: [45_f64.to_radians(), 90_f64.to_radians()], rates: [0.2, 0.0] }
}

fn judge(case: &Case<impl RadiusFunction>, seeds: u64) -> Verdict {
    let weight = case.object.mass.mass() * case.object.gravity;
    let nominal = PlanarNominal {
        mass: case.object.mass,
        gravity: case.object.gravity,
        contact_deviation: CONTACT,
        force_deviation: case.force_share * weight,
    };
    let sampled = times(case.rate, case.window + 10.0 / case.rate);
    let run = simulate_prescribed(&case.object, &case.motion, case.start, &sampled, 1e-13).unwrap();
    assert!(run.lost.is_none(), "{:?}", run.lost);
    let clean = run.log().unwrap();
    let noise = PlanarNoise { contact: CONTACT, force: case.force_share * weight, torque: 0.0 };
    let mut verdict = Verdict {
        statuses: Vec::new(),
        worst: 0.0,
        omega_deviation: 0.0,
        radius_deviation: 0.0,
        condition: f64::INFINITY,
        smallest_information: 0.0,
        words: String::new(),
        doubts: Vec::new(),
    };
    let scale = NaturalScale { length: 0.04, gravity: 9.81 };
    let names = ForceDriven::<5>::new(nominal, scale, &[]).unwrap().names();
    let (mut omegas, mut radii) = (Vec::new(), Vec::new());
    for seed in 0..seeds {
        let log = noise.add_to(&clean, seed);
        let options = PlanarObserverOptions {
            window: Some(case.window),
            settle: Some(case.window),
            ..PlanarObserverOptions::default()
        };
        let observer = PlanarObserver::<5>::new(nominal, &[], options).unwrap();
        let estimate = last_estimate(observer, log.samples().iter().copied());
        let truth = run.samples.last().unwrap().truth;
        let error = estimate.state - state(&truth);
        let deviations = estimate.report.deviations();
        let worst = error.iter().zip(&deviations).map(|(e, d)| e.abs() / d).fold(0.0, f64::max);
        verdict.worst = verdict.worst.max(worst);
        verdict.statuses.push(estimate.report.status);
        verdict.doubts.extend(estimate.doubt);
        omegas.push(deviations[4]);
        radii.push(estimate.radius_deviations[0].max(estimate.radius_deviations[1]));
        verdict.condition = estimate.report.condition;
        verdict.smallest_information = estimate.report.smallest_information;
        verdict.words = estimate.report.direction_in_words(&names);
    }
    omegas.sort_by(f64::total_cmp);
    radii.sort_by(f64::total_cmp);
    verdict.omega_deviation = omegas[omegas.len() / 2];
    verdict.radius_deviation = radii[radii.len() / 2];
    verdict
}

fn print(name: &str, v: &Verdict) {
    let silent = v.statuses.iter().filter(|s| **s != Status::NotObservable).count();
    println!(
        "{name}: {} of {} not observable; worst error {:.1} deviations; deviation of omega0 {:.3} rad/s, of r {:.3} mm; condition {:.1e}, smallest information {:.1e}: {} {:?}",
        v.statuses.len() - silent,
        v.statuses.len(),
        v.worst,
        v.omega_deviation,
        1e3 * v.radius_deviation,
        v.condition,
        v.smallest_information,
        v.words,
        v.doubts.first()
    );
}

/// Every run is reported as not observable for the given reason, and its covariance covers the truth.
fn must_doubt(name: &str, case: &Case<impl RadiusFunction>, reason: fn(&Doubt) -> bool) {
    let v = judge(case, 5);
    print(name, &v);
    assert!(v.statuses.iter().all(|s| *s == Status::NotObservable), "{name}: {:?}", v.statuses);
    assert!(v.doubts.len() == 5 && v.doubts.iter().all(reason), "{name}: {:?}", v.doubts);
    assert!(v.worst < 4.0, "{name}: {} deviations", v.worst);
    assert!(v.smallest_information.is_finite() && v.condition > 1.0 && !v.words.is_empty());
}

/// Every run is believed, and rightly.
fn must_trust(name: &str, case: &Case<impl RadiusFunction>) {
    let v = judge(case, 5);
    print(name, &v);
    assert!(v.doubts.is_empty(), "{name}: {:?}", v.doubts);
    // 25 normal errors: 4 deviations in 600 such tests.
    assert!(v.worst < 4.0, "{name}: {} deviations", v.worst);
}

fn spin(phi0: f64, omega0: f64) -> PlanarStart {
    PlanarStart { phi0, omega0 }
}

fn still(d: &Doubt) -> bool {
    matches!(d, Doubt::TooStill { .. })
}

/// Between rest and motion either the rate gives it away, or the fit that settled in a wrong minimum does by its residual.
fn slow(d: &Doubt) -> bool {
    matches!(d, Doubt::TooSlow { .. } | Doubt::Residual { .. } | Doubt::TooStill { .. })
}

#[test]
fn discs_and_near_discs() {
    let case = |shape, omega0| case_of(body(shape), wedge(), spin(0.3, omega0), 0.4);
    must_doubt("centred circle", &case(Circle::new(0.04, DVec2::ZERO).unwrap(), 3.0), still);
    let ellipse = |share: f64| Ellipse::new(0.04 * (1.0 + share), 0.04 * (1.0 - share), DVec2::ZERO).unwrap();
    let case = |share| case_of(body(ellipse(share)), wedge(), spin(0.3, 6.0), 0.4);
    must_doubt("ellipse, axes differ by 0.1 %", &case(0.0005), still);
    must_doubt("ellipse, axes differ by 1 %", &case(0.005), still);
    must_trust("ellipse, axes differ by 20 %", &case(0.1));
}

/// A disc stays where it is however it turns: only forces tell of a centre of mass that is off its middle, and they tell
/// enough at 10 %. A start in a wrong minimum, which happens, is seen by its residual.
#[test]
fn discs_with_an_offset_centre_of_mass() {
    let (mut believed, mut starts) = (0, 0);
    for (offset, omega0, phi0) in [
        (0.1, 3.0, 0.3),
        (0.1, 6.0, 0.3),
        (0.1, 6.0, 2.0),
        (0.1, 6.0, 4.0),
        (0.1, 10.0, 4.0),
        (0.2, 6.0, 0.3),
        (0.2, 6.0, 2.0),
        (0.2, 6.0, 4.0),
    ] {
        let object = body(Circle::new(0.04, DVec2::new(0.04 * offset, 0.0)).unwrap());
        let v = judge(&case_of(object, wedge(), spin(phi0, omega0), 0.4), 5);
        print(&format!("disc, centre of mass {offset} radii off, {omega0} rad/s from {phi0}"), &v);
        assert!(v.worst < 4.0, "{offset} {omega0} {phi0}: {} deviations", v.worst);
        believed += 5 - v.doubts.len();
        starts += 5;
    }
    println!("discs with an offset centre of mass: {believed} of {starts} starts believed");
    assert!(2 * believed > starts, "{believed}");
    for phi0 in [0.3, 2.0, 4.0] {
        let object = body(Circle::new(0.04, DVec2::new(0.002, 0.0)).unwrap());
        let case = case_of(object, wedge(), spin(phi0, 6.0), 0.4);
        must_doubt(&format!("disc, centre of mass 5 % off, from {phi0}"), &case, still);
    }
}

/// Between palms that close contacts and forces of a disc do change, but its turn still does not show.
#[test]
fn discs_between_closing_palms() {
    let motion = ConstantRates { angles: [45_f64.to_radians(), 90_f64.to_radians()], rates: [0.2, -1.0] };
    // What the fit makes of a turn that does not show may also be slow.
    let round = |d: &Doubt| matches!(d, Doubt::TooRound { .. } | Doubt::TooSlow { .. });
    let object = body(Circle::new(0.04, DVec2::ZERO).unwrap());
    let case = case_of(object, motion, spin(0.3, 6.0), 0.4);
    must_doubt("centred circle between closing palms", &case, round);
    let doubts = judge(&case, 5).doubts;
    assert!(doubts.iter().any(|d| matches!(d, Doubt::TooRound { .. })), "{doubts:?}");
}

/// Noise of the forces alone is no motion.
#[test]
fn noisy_forces_do_not_pass_for_motion() {
    for force_share in [0.01, 0.05] {
        let object = body(Circle::new(0.04, DVec2::ZERO).unwrap());
        let usual = case_of(object, wedge(), spin(0.3, 6.0), 0.4);
        let case = Case { force_share, rate: 100.0, ..usual };
        must_doubt(&format!("centred circle, force noise {force_share}"), &case, still);
        let (object, motion, _) = scene("S3_rocking_immobile");
        let all = PlanarEquilibria::new(&object.shape).all(&motion.at(0.0).unwrap().pair);
        let rest = all.iter().find(|e| e.stability > 0.0).unwrap().phi0;
        let case = Case { force_share, rate: 100.0, ..case_of(object, motion, spin(rest, 0.2), 0.4) };
        must_doubt(&format!("rocking at 0.2 rad/s, force noise {force_share}"), &case, still);
    }
}

#[test]
fn windows_of_all_lengths() {
    let (object, motion, start) = scene("S2_rotating_pair");
    for window in [0.02, 0.05, 0.1] {
        let case = case_of(object.clone(), motion, start, window);
        must_doubt(&format!("window {window} s"), &case, |d| matches!(d, Doubt::TooShort { .. }));
    }
    for window in [0.2, 0.4] {
        must_trust(&format!("window {window} s"), &case_of(object.clone(), motion, start, window));
    }
}

/// Rest and slow rocking; at 3 rad/s the object turns back twice in the window, through `z_i = 0`, and is observed.
#[test]
fn rest_and_rocking() {
    let (object, motion, _) = scene("S3_rocking_immobile");
    let all = PlanarEquilibria::new(&object.shape).all(&motion.at(0.0).unwrap().pair);
    let rest = all.iter().find(|e| e.stability > 0.0).unwrap().phi0;
    let case = |omega0| case_of(object.clone(), motion, spin(rest, omega0), 0.4);
    for omega0 in [0.0, 0.02, 0.2, 1.0, 1.5] {
        must_doubt(&format!("rocking at {omega0} rad/s"), &case(omega0), still);
    }
    for omega0 in [2.0, 2.5] {
        must_doubt(&format!("rocking at {omega0} rad/s"), &case(omega0), slow);
    }
    for omega0 in [3.0, 3.5] {
        must_trust(&format!("rocking at {omega0} rad/s, through z = 0"), &case(omega0));
    }
}

#[test]
fn nearly_closed_and_nearly_flat_wedges() {
    let (object, ..) = scene("S2_rotating_pair");
    for phi2 in [0.1_f64, 0.25, 2.95, 3.05] {
        let motion = ConstantRates { angles: [0.5 * (std::f64::consts::PI - phi2), phi2], rates: [0.0; 2] };
        let all = PlanarEquilibria::new(&object.shape).all(&motion.at(0.0).unwrap().pair);
        let rest = all.iter().find(|e| e.stability > 0.0).unwrap().phi0;
        let case = case_of(object.clone(), motion, spin(rest, 0.5), 0.2);
        must_doubt(&format!("wedge of {phi2} rad"), &case, |d| matches!(d, Doubt::Wedge { .. }));
    }
}

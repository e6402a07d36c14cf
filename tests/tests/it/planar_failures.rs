//! Where the estimate in the plane has to say that it does not know.

use crate::planar_common::{errors, noise_level, options, scene, times};
use glam::DVec2;
use recon::contact_kinematics::planar::*;
use recon::object_dynamics::planar::*;
use recon::observer::planar::*;
use recon_tests::few_or_all;

const CONTACT: f64 = 1e-4;
const FORCE_SHARE: f64 = 0.002;
const SIZE: f64 = 0.04;

struct Case<S> {
    object: PlanarObject<S>,
    motion: ConstantRates,
    start: PlanarStart,
    /// Length of the log, s.
    lasts: f64,
    /// Noise of the forces in weights.
    force_share: f64,
    /// Samples a second.
    rate: f64,
}

/// A case with the usual noise and sampling.
fn case_of<S>(object: PlanarObject<S>, motion: ConstantRates, start: PlanarStart, lasts: f64) -> Case<S> {
    Case { object, motion, start, lasts, force_share: FORCE_SHARE, rate: 500.0 }
}

fn body(shape: impl RadiusFunction) -> PlanarObject<impl RadiusFunction> {
    PlanarObject { shape, mass: PlanarMass::from_gyration(0.2, 0.0008).unwrap(), gravity: 9.81 }
}

fn wedge() -> ConstantRates {
    ConstantRates { angles: [45_f64.to_radians(), 90_f64.to_radians()], rates: [0.2, 0.0] }
}

/// Rows of one seed, or of all five, that are relied on, as a share. None of them is farther off than five deviations.
fn relied_on(name: &str, case: &Case<impl RadiusFunction>, known: bool) -> f64 {
    let weight = case.object.mass.mass() * case.object.gravity;
    let run =
        simulate_prescribed(&case.object, &case.motion, case.start, &times(case.rate, case.lasts), 1e-13);
    let run = run.unwrap();
    assert!(run.lost.is_none(), "{:?}", run.lost);
    let force = case.force_share * weight;
    let (mut rows, mut relied) = (0, 0);
    for seed in 0..few_or_all(1, 5) {
        let noise = PlanarNoise { contact: CONTACT, force, torque: 0.0 };
        let log = noise.add_to(&run.log().unwrap(), seed).contact_log([0.0; 2]).unwrap();
        let body = known.then_some(case.object.mass);
        let told = options(noise_level(CONTACT, force, SIZE), case.object.gravity, body);
        let estimate = estimate_plane(&log, &told).unwrap();
        let off = errors(&estimate, log.truth().unwrap());
        println!("{name} {seed} known {known}: {off:?} {:?} {:?}", estimate.reliability, estimate.evidence);
        rows += run.samples.len();
        if estimate.reliability.is_reliable() {
            assert!(off.worst < 5.0, "{name} {seed}: {off:?}");
            relied += off.relied_on;
        }
    }
    f64::from(u32::try_from(relied).unwrap()) / f64::from(u32::try_from(rows).unwrap())
}

/// With nothing known of the body, the harder of the two, or both.
fn knowns() -> &'static [bool] {
    few_or_all(&[false], &[false, true])
}

fn must_doubt(name: &str, case: &Case<impl RadiusFunction>) {
    for &known in knowns() {
        assert_eq!(relied_on(name, case, known), 0.0, "{name}");
    }
}

fn must_trust(name: &str, case: &Case<impl RadiusFunction>) {
    for known in [true, false] {
        let share = relied_on(name, case, known);
        assert!(share > 0.99, "{name}: {share}");
    }
}

/// Either way, if it is right.
fn may_trust(name: &str, case: &Case<impl RadiusFunction>) {
    for &known in knowns() {
        println!("{name}: relied on at {} of the samples", relied_on(name, case, known));
    }
}

fn spin(phi0: f64, omega0: f64) -> PlanarStart {
    PlanarStart { phi0, omega0 }
}

#[test]
fn discs_and_near_discs() {
    let disc = Circle::new(0.04, DVec2::ZERO).unwrap();
    must_doubt("centred circle", &case_of(body(disc), wedge(), spin(0.3, 3.0), 0.6));
    let closing = ConstantRates { rates: [0.2, -1.0], ..wedge() };
    must_doubt("centred circle, closing palms", &case_of(body(disc), closing, spin(0.3, 6.0), 0.5));
    let ellipse = |share: f64| {
        let shape = Ellipse::new(0.04 * (1.0 + share), 0.04 * (1.0 - share), DVec2::ZERO).unwrap();
        case_of(body(shape), wedge(), spin(0.3, 6.0), 0.6)
    };
    must_doubt("ellipse, axes differ by 0.1 %", &ellipse(0.0005));
    may_trust("ellipse, axes differ by 1 %", &ellipse(0.005));
    must_trust("ellipse, axes differ by 20 %", &ellipse(0.1));
}

/// A disc stays where it is however it turns: only forces tell of a centre of mass that is off its middle.
#[test]
fn discs_with_an_offset_centre_of_mass() {
    for &offset in few_or_all(&[0.1][..], &[0.05, 0.1, 0.2]) {
        for phi0 in [0.3, 2.0, 4.0] {
            let object = body(Circle::new(0.04, DVec2::new(0.04 * offset, 0.0)).unwrap());
            let case = case_of(object, wedge(), spin(phi0, 6.0), 0.6);
            may_trust(&format!("disc, centre of mass {offset} radii off, from {phi0}"), &case);
        }
    }
}

/// Noise of the forces alone is no motion.
#[test]
fn noisy_forces_do_not_pass_for_motion() {
    for &force_share in few_or_all(&[0.05][..], &[0.01, 0.05]) {
        let usual = case_of(body(Circle::new(0.04, DVec2::ZERO).unwrap()), wedge(), spin(0.3, 6.0), 0.6);
        let case = Case { force_share, rate: 100.0, ..usual };
        must_doubt(&format!("centred circle, force noise {force_share}"), &case);
    }
}

#[test]
fn logs_of_all_lengths() {
    let (object, motion, start) = scene("S2_rotating_pair");
    for lasts in [0.02, 0.05, 0.1, 0.2] {
        must_doubt(&format!("{lasts} s"), &case_of(object.clone(), motion, start, lasts));
    }
    for lasts in [0.4, 1.0] {
        must_trust(&format!("{lasts} s"), &case_of(object.clone(), motion, start, lasts));
    }
}

/// Rest and slow rocking: hardly anything is learned then; faster, through `z_i = 0` where the paper's coordinates end, all of it.
#[test]
fn rest_and_rocking() {
    let (object, motion, _) = scene("S3_rocking_immobile");
    let all = PlanarEquilibria::new(&object.shape).all(&motion.at(0.0).unwrap().pair);
    let rest = all.iter().find(|e| e.stability > 0.0).unwrap().phi0;
    let case = |omega0| case_of(object.clone(), motion, spin(rest, omega0), 0.6);
    for omega0 in [0.0, 0.02] {
        must_doubt(&format!("rocking at {omega0} rad/s"), &case(omega0));
    }
    for omega0 in [0.2, 1.0, 2.0] {
        may_trust(&format!("rocking at {omega0} rad/s"), &case(omega0));
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
        may_trust(&format!("wedge of {phi2} rad"), &case_of(object.clone(), motion, spin(rest, 0.5), 0.4));
    }
}

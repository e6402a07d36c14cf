//! Which constants can be estimated along with the motion.

use crate::planar_common::{last_estimate, scene, state, times};
use nalgebra::SVector;
use recon::object_dynamics::planar::*;
use recon::observer::Status;
use recon::observer::planar::*;

/// Runs with wrong constants in the model (`factor` on mass and inertia) and wrong sensors, constants estimated as states.
fn constants<const N: usize>(
    list: &[Constant],
    factors: [f64; 2],
    sensor: impl Fn(&PlanarSample) -> PlanarSample,
) -> (PlanarEstimate<N>, PlanarTruth) {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(500.0, 0.8), 1e-13).unwrap();
    let noise = PlanarNoise { contact: 1e-4, force: 0.002, torque: 0.0 };
    let log = noise.add_to(&run.log().unwrap(), 4);
    let mass = PlanarMass::new(object.mass.mass() * factors[0], object.mass.inertia() * factors[1]).unwrap();
    let nominal = PlanarNominal {
        mass,
        gravity: object.gravity,
        contact_deviation: noise.contact,
        force_deviation: noise.force,
    };
    let options = PlanarObserverOptions { steps: 2, ..PlanarObserverOptions::default() };
    let observer = PlanarObserver::<N>::new(nominal, list, options).unwrap();
    let last = last_estimate(observer, log.samples().iter().map(&sensor));
    (last, run.samples.last().unwrap().truth)
}

fn check<const N: usize>(
    what: &str,
    estimate: &PlanarEstimate<N>,
    truth: &PlanarTruth,
    expected: &[f64],
    largest: &[f64],
) {
    let mut full = SVector::<f64, N>::zeros();
    full.fixed_rows_mut::<5>(0).copy_from(&state(truth));
    full.as_mut_slice()[5..].copy_from_slice(expected);
    let deviations = estimate.report.deviations();
    let values: Vec<String> = (5..N)
        .map(|i| format!("{:.5} +- {:.5} for {:.5}", estimate.state[i], deviations[i], full[i]))
        .collect();
    println!(
        "{what}: {} ({:?}), r +- {:.4} mm",
        values.join(", "),
        estimate.report.status,
        1e3 * estimate.radius_deviations[0]
    );
    assert_eq!(estimate.doubt, None, "{what}");
    for i in 0..N {
        let error = (estimate.state[i] - full[i]).abs() / deviations[i];
        assert!(error < 4.0, "{what} state {i}: {error} deviations");
    }
    for (i, limit) in largest.iter().enumerate() {
        assert!(deviations[5 + i] < *limit, "{what} constant {i}: {}", deviations[5 + i]);
    }
}

#[test]
fn constants_are_estimated_each_on_its_own() {
    use Constant::*;
    let same = |s: &PlanarSample| *s;
    let (e, t) = constants::<6>(&[Mass], [1.1, 1.0], same);
    check("mass 10 % off", &e, &t, &[(1.0_f64 / 1.1).ln()], &[0.005]);
    let (e, t) = constants::<6>(&[Inertia], [1.0, 1.1], same);
    check("inertia 10 % off", &e, &t, &[(1.0_f64 / 1.1).ln()], &[0.02]);
    let gain = |s: &PlanarSample| PlanarSample { forces: s.forces.map(|[a, b]| [a / 1.05, b]), ..*s };
    let (e, t) = constants::<6>(&[ForceGain(Side::First)], [1.0; 2], gain);
    check("gain of force 1 5 % low", &e, &t, &[1.05_f64.ln()], &[0.005]);
    let bias = |s: &PlanarSample| PlanarSample { forces: s.forces.map(|[a, b]| [a, b - 0.05]), ..*s };
    let (e, t) = constants::<6>(&[ForceBias(Side::Second)], [1.0; 2], bias);
    check("bias of force 2, 0.05 N", &e, &t, &[0.05], &[0.01]);
}

/// An offset of one contact shifts the centre of mass along, and nothing contradicts it: it stays unknown, and is reported.
#[test]
fn a_contact_offset_is_not_observable() {
    let list = [Constant::ContactOffset(Side::First)];
    let offset =
        |s: &PlanarSample| PlanarSample { contacts: [s.contacts[0].map(|v| v + 1e-3), s.contacts[1]], ..*s };
    let (e, t) = constants::<6>(&list, [1.0; 2], offset);
    assert_eq!(e.report.status, Status::NotObservable);
    assert!(e.report.direction[5].abs() > 0.5, "{}", e.report.direction);
    check("offset of contact 1, 1 mm", &e, &t, &[1e-3], &[]);
}

#[test]
fn mass_inertia_and_biases_are_estimated_together() {
    use Constant::*;
    let list = [Mass, Inertia, ForceBias(Side::First), ForceBias(Side::Second)];
    let bias = |s: &PlanarSample| PlanarSample { forces: s.forces.map(|[a, b]| [a - 0.02, b + 0.03]), ..*s };
    let (e, t) = constants::<9>(&list, [1.05, 0.95], bias);
    let expected = [(1.0_f64 / 1.05).ln(), (1.0_f64 / 0.95).ln(), 0.02, -0.03];
    check("mass, inertia, both biases", &e, &t, &expected, &[0.02, 0.05, 0.03, 0.03]);
}

/// Mass, inertia and both gains can all be scaled together without any change of the motion: that is what is reported.
#[test]
fn a_common_scale_of_mass_and_gains_is_not_observable() {
    use Constant::*;
    let list = [Mass, Inertia, ForceGain(Side::First), ForceGain(Side::Second)];
    let (e, _) = constants::<9>(&list, [1.0; 2], |s: &PlanarSample| *s);
    assert_eq!(e.report.status, Status::NotObservable, "{:?}", e.report);
    let share = |i: usize| e.report.direction[i].abs();
    assert!((5..9).all(|i| (share(i) - 0.5).abs() < 0.01), "{}", e.report.direction);
    assert!(
        PlanarObserver::<8>::new(
            PlanarNominal {
                mass: PlanarMass::new(1.0, 1.0).unwrap(),
                gravity: 9.81,
                contact_deviation: 0.0,
                force_deviation: 0.0
            },
            &list,
            PlanarObserverOptions::default()
        )
        .is_err()
    );
}

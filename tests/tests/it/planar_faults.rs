//! What the planar observer says of logs in which something is broken: contacts, forces, clocks, sensors.

use crate::planar_common::{scene, times};
use recon::object_dynamics::planar::*;
use recon::observer::planar::*;

const CONTACT: f64 = 1e-4;

#[test]
fn lost_contact_and_missing_forces_are_errors_with_a_place() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(500.0, 0.5), 1e-13).unwrap();
    let nominal = PlanarNominal {
        mass: object.mass,
        gravity: object.gravity,
        contact_deviation: CONTACT,
        force_deviation: 0.0,
    };
    let make = || PlanarObserver::<5>::new(nominal, &[], PlanarObserverOptions::default()).unwrap();
    let mut observer = make();
    let mut failure = None;
    for (k, s) in run.samples.iter().enumerate() {
        let mut sample = s.sample;
        if k >= 230 {
            sample.contacts[1] = None;
        }
        if let Err(error) = observer.push(&sample) {
            failure = Some((k, error));
            break;
        }
    }
    let (k, error) = failure.unwrap();
    assert_eq!((k, error), (230, PlanarEstimateError::LostContact { palm: 2, t: run.samples[230].sample.t }));
    let without = PlanarSample { forces: None, torques: None, ..run.samples[0].sample };
    assert_eq!(make().push(&without), Err(PlanarEstimateError::NoForces { t: 0.0 }));
    let mut observer = make();
    observer.push(&run.samples[5].sample).unwrap();
    assert!(matches!(observer.push(&run.samples[4].sample), Err(PlanarEstimateError::Time { .. })));
}

/// A force sensor that reads 20 % too much, from the start or from 0.6 s on, when the start has long been believed: no
/// estimate passes as consistent once it matters.
#[test]
fn a_wrong_force_gain_is_noticed() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(500.0, 1.0), 1e-13).unwrap();
    let nominal = PlanarNominal {
        mass: object.mass,
        gravity: object.gravity,
        contact_deviation: CONTACT,
        force_deviation: 0.001,
    };
    let noise = PlanarNoise { contact: CONTACT, force: 0.001, torque: 0.0 };
    let log = noise.add_to(&run.log().unwrap(), 5);
    for fault in [0.0, 0.6] {
        let options = PlanarObserverOptions { settle: Some(0.4), ..PlanarObserverOptions::default() };
        let mut observer = PlanarObserver::<5>::new(nominal, &[], options).unwrap();
        let (mut estimates, mut noticed, mut worst) = (0, None, 0.0_f64);
        for (sample, step) in log.samples().iter().zip(&run.samples) {
            let gain = if sample.t >= fault { 1.2 } else { 1.0 };
            let sample = PlanarSample { forces: sample.forces.map(|[a, b]| [gain * a, b]), ..*sample };
            let Some(estimate) = observer.push(&sample).unwrap() else { continue };
            estimates += 1;
            match estimate.doubt {
                Some(Doubt::Residual { .. }) => noticed = noticed.or(Some(sample.t)),
                Some(other) => panic!("{other:?}"),
                None => assert!(noticed.is_none(), "believed again at {} s", sample.t),
            }
            let truth = &step.truth;
            let [n1, n2] = motion.at(sample.t).unwrap().pair.normals();
            for (i, n) in [n1, n2].into_iter().enumerate() {
                let error = (estimate.radii[i] - n.dot(truth.p_WCm)).abs() / estimate.radius_deviations[i];
                worst = worst.max(error);
            }
        }
        let noticed = noticed.unwrap();
        println!(
            "gain 1.2 from {fault} s: noticed at {noticed} s, until then r within {worst:.1} deviations"
        );
        assert!(estimates > 0 && noticed < fault.max(0.4) + 0.05);
    }
}

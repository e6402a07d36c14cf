use super::super::flow::Carried;
use super::super::record::{Interval, Wrench};
use super::super::windows::windows;
use super::*;

/// Longest window, s: seven samples at 1 kHz.
const LONGEST: f64 = 7e-3;

/// A body that slides between three palms, and what is said of its sensors.
fn sliding(noise: ContactNoiseLevel) -> (ContactLog, ContactOptions) {
    (noisy(&rubbed(0.1, 1000.0, 0.1), &noise, 3), options(noise))
}

/// A body that its palms let go at a small force flies as it left them: in one step from the last contact to the end of the flight that force would
/// wane all along, and its moment turn the body.
#[test]
fn a_flight_begins_at_a_node() {
    let (log, options) = sliding(noise(1e-5, 1e-4));
    let mut record = Record::new(&log, &options).unwrap();
    record.set_modes(&modes(&log));
    let (left, last) = (20, record.times.len() - 1);
    for k in left..=last {
        record.contacts[k].clear();
        record.wrenches[k] = Wrench::default();
    }
    for k in left - 1..last {
        let ends = [&record.wrenches[k], &record.wrenches[k + 1]];
        record.intervals[k] = Interval::trapezoid(record.intervals[k].h, ends, record.intervals[k].noise);
    }
    let truth = &log.truth().unwrap()[0];
    let mass = MassProperties::uniform_ellipsoid(0.2, DVec3::new(0.05, 0.04, 0.03)).unwrap();
    let R = DMat3::from_quat(truth.R_WO);
    let inertia = R * mass.inertia() * R.transpose();
    let body = Body::free(mass.mass(), inertia);
    let (p, L) = (truth.p_WCm - record.origin, inertia * truth.w_WO);
    let start = Motion { p, v: truth.v_WCm, L, q: DQuat::IDENTITY };
    let end = |record: &Record| {
        let mut carried = Carried::<0>::new(start, &body);
        for (k, interval) in record.intervals.iter().enumerate() {
            let ends = [&record.wrenches[k], &record.wrenches[k + 1]];
            carried.step(interval, ends, &body, DVec3::NEG_Z * G);
        }
        carried.motion
    };
    let (all, averaged) = (end(&record), record.averaged(LONGEST));
    assert!(averaged.times.len() < left, "contacts are averaged: {}", averaged.times.len());
    let turned = (end(&averaged).q * all.q.conjugate()).to_scaled_axis().length();
    let spun = (record.times[last] - record.times[left]) * truth.w_WO.length();
    assert!(turned < 1e-3, "{turned} rad of some {spun}");
}

/// A contact that changes its speed within few samples is averaged with none, and those beside it are.
#[test]
fn contacts_that_bend_faster_than_a_window_stand_alone() {
    let noise = noise(1e-5, 1e-4);
    let (log, options) = sliding(noise);
    let mut record = Record::new(&log, &options).unwrap();
    record.set_modes(&modes(&log));
    let usual = windows(&record, LONGEST).len();
    assert!(2 * usual < record.times.len(), "{usual} windows");
    // By a smooth step in its speed, over four samples: sharp ones are told by themselves.
    let (middle, step) = (50.0, 8.0 * noise.contact);
    for (k, contacts) in record.contacts.iter_mut().enumerate() {
        let s = (k as f64 - middle) / 2.0;
        let along = contacts[0].n.any_orthonormal_vector();
        contacts[0].c += along * (step * (1.0 + (2.0 * s).exp()).ln());
    }
    let all = windows(&record, LONGEST);
    let about = |k: usize| all.iter().find(|window| window.own.contains(&k)).unwrap().own.len();
    assert_eq!(about(50), 1, "it bends there");
    assert!(about(20) > 1 && about(80) > 1, "and nowhere else");
}

//! Of single readings that are none.

use super::frictionless::tumbled;
use super::*;

/// An exact log of a body whose motion is smooth, and its records.
fn exact() -> SensorLog {
    let start = InitialMotion { R_WO: DQuat::from_rotation_x(0.5), w_WO: DVec3::new(2.0, 1.0, 3.0) };
    tumbled(DVec3::new(0.05, 0.04, 0.03), start, SampleTimes { duration: 0.8, rate: 500.0 })
}

fn options() -> ContactOptions {
    let noise =
        ContactNoiseLevel { contact: 1e-9, force_fixed: 1e-9, force_share: 0.0, impulse: None, floor: 1e-6 };
    ContactOptions { friction: Some(0.0), guessed_floor: true, ..super::options(noise) }
}

/// With the readings of some palms at some samples made others.
fn changed(log: &ContactLog, wrong: &[(usize, usize)], to: impl Fn(f64) -> f64) -> ContactLog {
    with_records(log, |i, record| {
        let ForceChannel::Normal(mut forces) = record.force else { panic!("normal forces") };
        for &(k, _) in wrong.iter().filter(|(_, palm)| *palm == i) {
            forces[k] = to(forces[k]);
        }
        PalmRecord { force: ForceChannel::Normal(forces), ..record }
    })
}

fn worst(found: &ContactEstimate, log: &ContactLog) -> f64 {
    let one = |((state, at), of): ((&BodyState, &BodyState), &[DVec3; 4])| {
        let off = [
            (state.p_WCm - at.p_WCm) / of[0],
            (state.v_WCm - at.v_WCm) / of[1],
            (state.w_WO - at.w_WO) / of[2],
        ];
        off.map(|off| off.abs().max_element()).into_iter().fold(0.0, f64::max)
    };
    found.states.iter().zip(log.truth().unwrap()).zip(&found.deviations).map(one).fold(0.0, f64::max)
}

/// Forces that are zero, ten times as large or a twentieth more than they were, at one palm or all, in the middle and at the ends: they are found and no others, and the
/// motion is right. Before, each was up to 27 deviations off in silence.
#[test]
fn forces_that_no_motion_shows_are_told_and_survived() {
    let log = ContactLog::try_from(&exact()).unwrap();
    let right = estimate_contacts(&log, None, &options()).unwrap();
    assert!(right.reliability.is_reliable() && right.misread_forces.is_empty(), "{:?}", right.reliability);
    let all = [(210, 0), (210, 1), (210, 2)];
    for (wrong, factor) in [
        (&[(150, 1)][..], 0.0),
        (&[(150, 2), (151, 2)], 0.0),
        (&[(2, 0)], 0.0),
        (&all, 0.0),
        (&[(300, 0)], 10.0),
        (&[(120, 1)], 1.05),
    ] {
        let wronged = changed(&log, wrong, |force| force * factor);
        let found = estimate_contacts(&wronged, None, &options()).unwrap();
        assert_eq!(found.misread_forces, wrong, "{factor}");
        assert!(found.reliability.is_reliable(), "{:?}", found.reliability);
        let off = worst(&found, &log);
        assert!(off < 5.0, "{wrong:?} {factor}: {off} deviations");
    }
}

/// A palm that gives a sample once more, to the last digit.
#[test]
fn a_sample_that_is_given_twice_counts_once() {
    let log = ContactLog::try_from(&exact()).unwrap();
    let twice = with_records(&log, |i, mut record| {
        if i == 1 {
            let ForceChannel::Normal(forces) = &mut record.force else { panic!("normal forces") };
            forces[170] = forces[169];
            let (ContactPoints::World(points) | ContactPoints::Palm(points)) = &mut record.contacts;
            points[170] = points[169];
        }
        record
    });
    let found = estimate_contacts(&twice, None, &options()).unwrap();
    assert_eq!((&found.misread[..], &found.misread_forces[..]), (&[(170, 1)][..], &[(170, 1)][..]));
    let off = worst(&found, &log);
    assert!(found.reliability.is_reliable() && off < 5.0, "{off} deviations, {:?}", found.reliability);
}

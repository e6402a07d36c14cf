use super::*;
use crate::{PalmReading, Sample, SensorLog, TrueState};
use contact_kinematics::{Direction, PalmError, PalmFrame};
use proptest::prelude::*;

fn any_palm(azimuth: f64) -> impl Strategy<Value = Vec<PalmReading>> {
    let contact =
        prop_oneof![3 => (-3.0..3.0f64, 0.0..4.0f64).prop_map(|(a, b)| Some([a, b])), 1 => Just(None)];
    let one = (0.3..1.3f64, contact, 0.0..9.0f64, -2.0..2.0f64, -1.0..1.0f64);
    let has = [any::<bool>(), any::<bool>(), any::<bool>()];
    (proptest::collection::vec(one, 6), has).prop_map(move |(rows, [force, torque, rate])| {
        let reading = |(slope, contact, f, w, tau): (f64, Option<[f64; 2]>, f64, f64, f64)| PalmReading {
            normal: Direction::new(PalmFrame::from_azimuth_slope(azimuth, slope).n).unwrap(),
            contact,
            force: force.then_some(if contact.is_some() { f } else { 0.0 }),
            torque: (torque && contact.is_some()).then_some(tau),
            rate: rate.then_some(w),
        };
        rows.into_iter().map(reading).collect()
    })
}

fn state(p_WCm: DVec3) -> TrueState {
    TrueState { p_WCm, R_WO: DQuat::IDENTITY, v_WCm: DVec3::X, w_WO: DVec3::Y }
}

fn near(a: Option<f64>, b: Option<f64>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() < 1e-14,
        (a, b) => a == b,
    }
}

proptest! {
    #[test]
    fn a_log_of_three_planes_comes_back(
        palms in (any_palm(0.1), any_palm(2.2), any_palm(4.3)), p in [-1e3..1e3, -1.0..1.0, -1e-9..1e-9f64],
    ) {
        let (a, b, c) = palms;
        let sample = |k: usize| Sample { t: k as f64 / 3.0, palms: [a[k], b[k], c[k]] };
        let truth = vec![state(DVec3::from_array(p)); 6];
        let log = SensorLog::new((0..6).map(sample).collect(), Some(truth)).unwrap();
        let contacts = ContactLog::try_from(&log).unwrap();
        let back = contacts.three_planes().unwrap();
        prop_assert_eq!(back.p_WM, DVec3::ZERO);
        prop_assert_eq!(back.log.truth(), log.truth());
        for (before, after) in log.samples().iter().zip(back.log.samples()) {
            prop_assert_eq!(before.t, after.t);
            for (a, b) in before.palms.iter().zip(&after.palms) {
                prop_assert!((a.normal.get() - b.normal.get()).length() < 1e-15 * 2.0);
                let s = [a, b].map(|p| p.contact.map_or(DVec3::ZERO, |s| DVec3::new(s[0], s[1], 1.0)));
                prop_assert!((s[0] - s[1]).length() < 1e-14, "{:?}", s);
                prop_assert_eq!((a.force, a.torque), (b.force, b.torque));
                prop_assert!(near(a.rate, b.rate), "{:?} {:?}", a.rate, b.rate);
            }
        }
    }
}

const SAMPLES: usize = 200;

/// Three palms that tilt 0.2 rad, with friction `mu` and all three axes of the force.
fn cradle(mu: f64, p_WM: DVec3) -> Vec<PalmRecord> {
    let palm = |azimuth: f64| {
        let row = |k: usize| {
            let frame = PalmFrame::from_azimuth_slope(azimuth, 1.0 + 0.2 * (k as f64 / 100.0).sin());
            let pose = SurfacePose { p_WP: p_WM + 0.3 * frame.t2, R_WP: DQuat::from_mat3(&frame.rotation()) };
            let (sin, cos) = (k as f64 / 40.0 + azimuth).sin_cos();
            let tangential = mu * (sin * frame.t1 + cos * frame.t2);
            let contact = p_WM + frame.contact_from_sensor([0.01, 0.05]);
            (pose, contact, (1.0 + 0.1 * sin) * (frame.n + tangential))
        };
        let rows: Vec<_> = (0..SAMPLES).map(row).collect();
        PalmRecord {
            motion: RecordedMotion::Poses(rows.iter().map(|row| row.0).collect()),
            contacts: ContactPoints::World(rows.iter().map(|row| Some(row.1)).collect()),
            force: ForceChannel::Three(rows.iter().map(|row| row.2).collect()),
            ..super::palm(PalmSurface::Plane, DVec3::ZERO, SAMPLES)
        }
    };
    [0.0, 2.1, 4.2].map(palm).to_vec()
}

fn log(records: Vec<PalmRecord>) -> ContactLog {
    let truth = vec![state(DVec3::new(0.5, 0.6, 0.7)); SAMPLES];
    ContactLog::new(times(SAMPLES), records, Some(truth)).unwrap()
}

#[test]
fn planes_through_another_point_are_moved_there() {
    let p_WM = DVec3::new(0.4, -0.3, 0.2);
    let moved = log(cradle(0.0, p_WM)).three_planes().unwrap();
    let here = log(cradle(0.0, DVec3::ZERO)).three_planes().unwrap();
    assert!((moved.p_WM - p_WM).length() < 1e-14 && here.p_WM == DVec3::ZERO);
    assert!((moved.log.truth().unwrap()[3].p_WCm - (DVec3::new(0.5, 0.6, 0.7) - p_WM)).length() < 1e-14);
    for (a, b) in moved.log.samples().iter().zip(here.log.samples()) {
        for (a, b) in a.palms.iter().zip(&b.palms) {
            let [s1, s2] = a.contact.unwrap();
            let [r1, r2] = b.contact.unwrap();
            assert!((s1 - r1).abs() + (s2 - r2).abs() < 1e-13 && near(a.force, b.force));
            assert!((s1 - 0.01).abs() + (s2 - 0.05).abs() < 1e-13);
        }
    }
    // And back, the palms' material with them.
    let (first, back) = (log(cradle(0.0, p_WM)), ContactLog::try_from(&moved.log).unwrap().shifted(p_WM));
    assert!((back.truth().unwrap()[3].p_WCm - DVec3::new(0.5, 0.6, 0.7)).length() < 1e-14);
    for (a, b) in first.palms().iter().zip(back.palms()) {
        for k in 0..SAMPLES {
            let [p_WC, p_WD] = [a, b].map(|palm| palm.touch(k).unwrap().p_WC);
            let [u, v] = [a, b].map(|palm| palm.motion(k).material_velocity(p_WC));
            assert!((p_WC - p_WD).length() < 1e-13 && (u - v).length() < 1e-6, "{k}: {p_WC} {p_WD} {u} {v}");
        }
    }
}

/// Twists that a file has rounded tell a rate at all samples, those about another axis at none: where a palm turns back, rounding is all that is left of one.
#[test]
fn a_palm_has_rates_at_all_samples_or_at_none() {
    let told = |astray: f64| {
        let mut records = cradle(0.0, DVec3::ZERO);
        for (record, azimuth) in records.iter_mut().zip([0.0, 2.1, 4.2]) {
            let RecordedMotion::Poses(poses) = record.motion.clone() else { panic!("poses") };
            let motion = |(k, pose): (usize, SurfacePose)| {
                let rate = 2.0 * (k as f64 / 100.0).cos();
                let frame = PalmFrame::from_azimuth_slope(azimuth, 1.0 + 0.2 * (k as f64 / 100.0).sin());
                let w_WP = rate * frame.t1 + astray * frame.t2;
                MeasuredMotion { pose, v_WP: w_WP.cross(pose.p_WP), w_WP }
            };
            record.motion = RecordedMotion::Measured(poses.into_iter().enumerate().map(motion).collect());
        }
        let planes = log(records).three_planes().unwrap().log;
        planes.samples().iter().map(|sample| sample.palms.map(|palm| palm.rate.is_some())).collect::<Vec<_>>()
    };
    assert!(told(1e-9).iter().all(|palms| *palms == [true; 3]));
    assert!(told(1e-3).iter().all(|palms| *palms == [false; 3]));
}

#[test]
fn torques_are_about_the_line_through_the_meeting_point() {
    let p_WM = DVec3::new(0.4, -0.3, 0.2);
    let hinged = |aside: DVec3, turn: f64| {
        let mut records = cradle(0.0, p_WM);
        for (record, azimuth) in records.iter_mut().zip([0.0, 2.1, 4.2]) {
            let t1 = PalmFrame::from_azimuth_slope(azimuth, 1.0).t1;
            let axis = Direction::new(turn * t1).unwrap();
            record.hinge = Some(PalmHinge { pivot: p_WM + 0.7 * t1 + aside, axis, inertia: 1e-4 });
            // Of some 1 N at 50 mm.
            record.torque = Some(vec![Some(0.05 * turn); SAMPLES]);
        }
        let sample = log(records).three_planes().unwrap().log.samples()[5];
        sample.palms.map(|palm| palm.torque)
    };
    // About the horizontal axis of each palm, whichever way the hinge counts.
    assert_eq!(hinged(DVec3::ZERO, 1.0), [Some(0.05); 3]);
    assert_eq!(hinged(DVec3::ZERO, -1.0), [Some(0.05); 3]);
    // The lever of the force is another one there.
    assert_eq!(hinged(DVec3::Z * 1e-3, 1.0), [None; 3]);
}

#[test]
fn what_the_estimators_do_not_know_is_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Vec<PalmRecord>)| {
        let mut records = cradle(0.0, DVec3::ZERO);
        change(&mut records);
        log(records).three_planes().unwrap_err()
    };
    assert_eq!(refused(&|r| r.truncate(2)), NotThreePlanes::Count { found: 2 });
    let curved = refused(&|r| {
        r[1].surface = PalmSurface::Cup { radius: 0.1 };
        r[1].largest_offset = f64::INFINITY;
    });
    assert_eq!(curved, NotThreePlanes::Curved { palm: 2, kind: "cup" });
    // One palm half a millimetre off along its normal: it is that far, at some time, from where all meet best.
    let apart = refused(&|r| {
        let RecordedMotion::Poses(poses) = &mut r[2].motion else { unreachable!() };
        poses.iter_mut().for_each(|pose| pose.p_WP += 5e-4 * (pose.R_WP * DVec3::Z));
    });
    let NotThreePlanes::Apart { distance, limit, .. } = apart else { panic!("{apart}") };
    assert!(distance > 1e-5 && distance < 5e-4 && limit < 1e-9, "{apart}");
    let mut records = cradle(0.0, DVec3::ZERO);
    let RecordedMotion::Poses(poses) = &mut records[2].motion else { unreachable!() };
    poses.iter_mut().for_each(|pose| pose.p_WP += 5e-4 * (pose.R_WP * DVec3::Z));
    let within = log(records.clone()).three_planes_within(5e-4).unwrap();
    assert!((within.apart - distance).abs() < 1e-12, "{} {distance}", within.apart);
    let closer = log(records).three_planes_within(0.9 * distance).unwrap_err();
    assert!(matches!(closer, NotThreePlanes::Apart { limit, .. } if limit == 0.9 * distance));
    let beside = refused(&|r| {
        let copy = r[0].motion.clone();
        r[1].motion = copy.clone();
        r[2].motion = copy;
        let RecordedMotion::Poses(poses) = &mut r[2].motion else { unreachable!() };
        poses.iter_mut().for_each(|pose| pose.p_WP += DVec3::Z);
        r.iter_mut().for_each(|r| r.largest_offset = f64::INFINITY);
        r.iter_mut().for_each(|r| r.force = ForceChannel::Missing);
    });
    assert_eq!(beside, NotThreePlanes::NoPoint);
    let stated = refused(&|r| {
        r[0].friction = Some(0.3);
        r[0].force = ForceChannel::Normal(vec![1.0; SAMPLES]);
    });
    assert_eq!(stated, NotThreePlanes::Friction { palm: 1, friction: 0.3 });
    let flat = refused(&|r| {
        let flat = SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY };
        r[2].motion = RecordedMotion::Fixed(flat);
        r[2].largest_offset = f64::INFINITY;
        r[2].force = ForceChannel::Missing;
    });
    assert!(matches!(
        flat,
        NotThreePlanes::Frame { palm: 3, sample: 0, source: PalmError::VerticalNormal { .. }, .. }
    ));
}

#[test]
fn friction_is_seen_and_its_ratio_told() {
    let exact = log(cradle(0.3, DVec3::ZERO)).three_planes().unwrap_err();
    let NotThreePlanes::Rubs { ratio, .. } = exact else { panic!("{exact}") };
    assert!((ratio - 0.3).abs() < 1e-3, "{exact}");
}

#[cfg(feature = "noise")]
#[test]
fn noise_is_not_taken_for_friction_and_does_not_hide_it() {
    let force = ChannelNoise { fixed: 0.0, share: 0.02 };
    let noise = ContactNoise { contact: 1e-4, force, ..ContactNoise::default() };
    let [smooth, rough] = [0.0, 0.02].map(|mu| log(cradle(mu, DVec3::ZERO)));
    // 600 pairs of neighbours: a ratio of that of the noise is seen at 0.02^2 / 0.02^2 / sqrt(2) sqrt(600) = 17 deviations
    // less what its own noise takes, about a factor 2.
    for seed in 0..40 {
        assert!(smooth.with_noise(&noise, seed).unwrap().three_planes().is_ok(), "{seed}");
        let seen = rough.with_noise(&noise, seed).unwrap().three_planes();
        let Err(NotThreePlanes::Rubs { ratio, deviations, .. }) = seen else { panic!("{seed}: {seen:?}") };
        assert!((0.015..0.026).contains(&ratio) && deviations > 6.0, "{ratio} {deviations}");
    }
}

use super::*;
use crate::{ContactMode, FrictionError, SeriesError, TrueState};
use contact_kinematics::{Direction, MotionLaw, MotionPart, SurfaceError, SurfaceMotion};

const FINGERTIP: PalmSurface = PalmSurface::Sphere { radius: 0.012 };

fn error(times: Vec<f64>, record: PalmRecord) -> ContactLogError {
    ContactLog::new(times, vec![record], None).unwrap_err()
}

#[test]
fn contacts_are_put_on_the_palm_and_the_normal_is_the_one_there() {
    let surfaces = [
        (PalmSurface::Plane, DVec3::new(0.01, 0.02, 0.0)),
        (FINGERTIP, 0.012 * DVec3::new(0.6, 0.0, 0.8)),
        (PalmSurface::Cup { radius: 0.12 }, 0.12 * DVec3::new(0.0, 0.6, -0.8)),
        (PalmSurface::Cylinder { radius: 0.015 }, DVec3::new(0.2, 0.009, 0.012)),
    ];
    for (surface, s) in surfaces {
        let n_P = surface.nearest(s).unwrap().n_P.get();
        let log = ContactLog::new(times(2), vec![palm(surface, s + 2e-4 * n_P, 2)], None).unwrap();
        let (motion, touch) = (log.palms()[0].motion(1), log.palms()[0].touch(1).unwrap());
        assert!((motion.pose.at_rest().to_palm(touch.p_WC) - s).length() < 4e-16, "{surface:?}");
        // Rounding of points 0.4 m from the origin, over the smallest radius.
        assert!((motion.pose.R_WP.inverse() * touch.n.get() - n_P).length() < 4e-16 / 0.012, "{surface:?}");
        assert!((log.palms()[0].largest_offset() - 2e-4).abs() < 1e-15);
        // The same points from the world; what stands on a palm stays there, digit by digit.
        let again = ContactLog::new(times(2), log.records(), None).unwrap();
        assert_eq!(again.palms()[0].touch(1), Some(touch), "{surface:?}");
        assert_eq!(again.palms()[0].largest_offset(), 0.0);
    }
}

/// A palm that turns, shakes and wanders, as poses and as poses with twists.
fn moving(times: &[f64]) -> [PalmRecord; 2] {
    let part = |direction: DVec3, amplitude: f64, frequency: f64| MotionPart::Shift {
        direction: Direction::new(direction).unwrap(),
        law: MotionLaw::Sinusoid { mean: 0.0, amplitude, frequency, phase: 0.3 },
    };
    let turn = MotionPart::Turn {
        pivot: DVec3::new(0.1, 0.0, 0.0),
        axis: Direction::new(DVec3::new(1.0, 2.0, -1.0)).unwrap(),
        law: MotionLaw::Sinusoid { mean: 0.2, amplitude: 0.4, frequency: 7.0, phase: 0.0 },
    };
    let pose = SurfacePose { p_WP: DVec3::new(0.3, -0.2, 0.1), R_WP: DQuat::from_rotation_x(0.7) };
    let motion = SurfaceMotion::Parts { pose, parts: vec![part(DVec3::X, 0.02, 9.0), turn] };
    let state = |t: f64| {
        let at = motion.at(t);
        let pose = SurfacePose { p_WP: at.p_WP, R_WP: DQuat::from_mat3(&at.R_WP).normalize() };
        MeasuredMotion { pose, v_WP: at.v_WP, w_WP: at.w_WP }
    };
    let states: Vec<_> = times.iter().map(|t| state(*t)).collect();
    let record = |motion| PalmRecord { motion, ..palm(PalmSurface::Plane, DVec3::X * 0.01, times.len()) };
    [
        record(RecordedMotion::Poses(states.iter().map(|state| state.pose).collect())),
        record(RecordedMotion::Measured(states)),
    ]
}

#[test]
fn twists_come_from_the_poses_where_they_are_not_stated() {
    let worst = |samples: usize| {
        let times: Vec<_> = (0..samples).map(|k| 0.2 * k as f64 / (samples - 1) as f64).collect();
        let log = ContactLog::new(times.clone(), moving(&times).to_vec(), None).unwrap();
        let [from_poses, stated] = [0, 1].map(|i| &log.palms()[i]);
        assert_eq!(
            [from_poses.twist_source(), stated.twist_source()],
            [TwistSource::FromPoses, TwistSource::Stated]
        );
        let error = |k: usize| {
            let (a, b) = (from_poses.motion(k), stated.motion(k));
            assert_eq!(a.pose, b.pose);
            DVec3::new((a.v_WP - b.v_WP).length(), (a.w_WP - b.w_WP).length(), 0.0)
        };
        (0..samples).map(error).fold(DVec3::ZERO, DVec3::max)
    };
    // Slopes of a not-a-knot spline err by the third power of the step next to the ends.
    let (coarse, fine) = (worst(101), worst(201));
    let order = DVec3::new((coarse.x / fine.x).log2(), (coarse.y / fine.y).log2(), 3.0);
    assert!((order - 3.0).abs().max_element() < 0.1, "{order} {fine}");
    assert!(fine.max_element() < 1e-5, "{fine}");
}

#[test]
fn the_material_of_a_palm_moves_with_its_twist() {
    let log = ContactLog::new(times(50), moving(&times(50)).to_vec(), None).unwrap();
    let [before, now, after] = [20, 21, 22].map(|k| log.palms()[1].motion(k));
    let c = DVec3::new(0.2, 0.1, 0.0);
    let c_P = now.pose.at_rest().to_palm(c);
    let moved = |motion: MeasuredMotion| motion.pose.at_rest().to_world(c_P);
    // A central difference errs by h^2 / 6 times the third derivative: 0.3 m of arm, 9 rad/s and less.
    let difference = (moved(after) - moved(before)) / 2e-3;
    assert!((now.material_velocity(c) - difference).length() < 1e-6 / 6.0 * 9.0_f64.powi(3) * 0.3);
}

#[test]
fn a_palm_that_rests_is_immobile_however_that_is_said() {
    let rest = palm(PalmSurface::Plane, DVec3::ZERO, 3);
    let RecordedMotion::Fixed(pose) = rest.motion else { unreachable!() };
    let zero = MeasuredMotion { pose, v_WP: DVec3::ZERO, w_WP: DVec3::ZERO };
    let ways =
        [RecordedMotion::Poses(vec![pose; 3]), RecordedMotion::Measured(vec![zero; 3]), rest.motion.clone()];
    for motion in ways {
        let log = ContactLog::new(times(3), vec![PalmRecord { motion, ..rest.clone() }], None).unwrap();
        assert_eq!(log.palms()[0].twist_source(), TwistSource::Immobile);
        assert_eq!(log.palms()[0].motion(2), zero);
    }
    // A sphere that turns in itself does move.
    let spin = MeasuredMotion { w_WP: DVec3::Z, ..zero };
    let record = PalmRecord { motion: RecordedMotion::Measured(vec![spin; 3]), ..rest };
    let log = ContactLog::new(times(3), vec![record], None).unwrap();
    assert_eq!(log.palms()[0].motion(1).w_WP, DVec3::Z);
}

#[test]
fn forces_and_impulses_say_how_much_of_them_was_measured() {
    let sums = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 2.0, 0.5)];
    let three = PalmRecord {
        force: ForceChannel::Three(vec![DVec3::Z; 3]),
        impulse: ForceChannel::Three(sums),
        ..palm(PalmSurface::Plane, DVec3::ZERO, 3)
    };
    let mut normal = PalmRecord {
        force: ForceChannel::Normal(vec![2.0, 2.0, 0.0]),
        impulse: ForceChannel::Normal(vec![5.0, 5.5, 5.75]),
        ..palm(PalmSurface::Plane, DVec3::ZERO, 3)
    };
    normal.contacts = ContactPoints::Palm(vec![Some(DVec3::ZERO), Some(DVec3::ZERO), None]);
    let log = ContactLog::new(times(3), vec![three, normal], None).unwrap();
    let [three, normal] = [0, 1].map(|i| &log.palms()[i]);
    let n = normal.touch(0).unwrap().n.get();
    assert_eq!(three.force(2), Some(SensedForce { vector: DVec3::Z, axes: SensedAxes::Three }));
    assert_eq!(normal.force(1), Some(SensedForce { vector: 2.0 * n, axes: SensedAxes::Normal }));
    assert_eq!(normal.force(2).unwrap().vector, DVec3::ZERO);
    assert!(three.impulse(0).is_none());
    assert_eq!(three.impulse(2).unwrap().vector, DVec3::new(0.0, 2.0, 0.5));
    assert_eq!(normal.impulse(1).unwrap().vector, 0.5 * n);
    // The contact ended within the interval: its impulse is along the last normal.
    assert_eq!(normal.impulse(2).unwrap().vector, 0.25 * n);
    assert_eq!((normal.impulse_axes(), normal.torque(1)), (Some(SensedAxes::Normal), None));
}

#[test]
fn memory_is_as_said() {
    let samples = 1000;
    let truth = TrueContact { mode: ContactMode::Slide, gap: 0.0, slip: 0.1 };
    let [_, measured] = moving(&times(samples));
    let record = PalmRecord {
        force: ForceChannel::Three(vec![DVec3::ZERO; samples]),
        impulse: ForceChannel::Three(vec![DVec3::ZERO; samples]),
        truth: Some(vec![truth; samples]),
        ..measured
    };
    let state =
        TrueState { p_WCm: DVec3::ZERO, R_WO: DQuat::IDENTITY, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO };
    let fixed = palm(PalmSurface::Plane, DVec3::ZERO, samples);
    let log = ContactLog::new(times(samples), vec![record, fixed], Some(vec![state; samples])).unwrap();
    assert_eq!(log.bytes_per_sample(), 8 + 104 + (56 + 104 + 24 + 24 + 24) + 56);
    let (robot, truth) = log.split_truth();
    assert_eq!(robot.bytes_per_sample(), 8 + (56 + 104 + 24 + 24) + 56);
    assert!(robot.truth().is_none() && robot.palms()[0].truth(5).is_none() && truth.is_some());
    assert!((robot.duration() - 0.999).abs() < 1e-15);
}

#[test]
fn what_is_no_log_is_named() {
    let good = || palm(FINGERTIP, DVec3::X * 0.012, 3);
    let series = |e| matches!(e, ContactLogError::Series(_));
    assert!(series(error(times(1), palm(FINGERTIP, DVec3::X, 1))));
    let repeated = error(vec![0.0, 1.0, 1.0], good());
    assert_eq!(repeated.sample(), Some(2));
    assert!(matches!(
        error(vec![0.0, f64::NAN, 1.0], good()),
        ContactLogError::TimeNotFinite { sample: 1, .. }
    ));
    let truth = ContactLog::new(times(3), vec![good()], Some(vec![])).unwrap_err();
    assert_eq!(truth, ContactLogError::Series(SeriesError::TruthLength { expected: 3, found: 0 }));
    for found in [0, 6] {
        let log = ContactLog::new(times(3), vec![good(); found], None);
        assert_eq!(log.unwrap_err(), ContactLogError::PalmCount { found });
    }
    let radius = error(times(3), PalmRecord { surface: PalmSurface::Cup { radius: -1.0 }, ..good() });
    let source = SurfaceError::Radius { radius: -1.0 };
    assert_eq!(radius, ContactLogError::Surface { palm: 1, source });
    let friction = error(times(3), PalmRecord { friction: Some(-0.1), ..good() });
    assert_eq!(friction, ContactLogError::Friction { palm: 1, source: FrictionError { value: -0.1 } });
    let short = error(times(3), PalmRecord { force: ForceChannel::Normal(vec![1.0]), ..good() });
    assert_eq!(short, ContactLogError::ChannelLength { what: "force", palm: 1, expected: 3, found: 1 });
}

#[test]
fn readings_that_cannot_be_are_named_with_palm_sample_and_value() {
    let good = || palm(FINGERTIP, DVec3::X * 0.012, 3);
    let points = |p: DVec3| ContactPoints::Palm(vec![Some(DVec3::X * 0.012), Some(p), None]);
    let off = error(times(3), PalmRecord { contacts: points(DVec3::Y * 0.02), ..good() });
    let ContactLogError::OffPalm { palm: 1, sample: 1, distance, limit, .. } = off else { panic!("{off}") };
    assert!((distance - 0.008).abs() < 1e-15 && limit == 1e-3);
    let centre = error(times(3), PalmRecord { contacts: points(DVec3::ZERO), ..good() });
    assert!(matches!(centre, ContactLogError::NoNormal { palm: 1, sample: 1, .. }), "{centre}");
    let nan = error(times(3), PalmRecord { contacts: points(DVec3::new(0.0, f64::NAN, 0.0)), ..good() });
    assert!(matches!(nan, ContactLogError::ReadingNotFinite { what: "contact", sample: 1, .. }), "{nan}");
    let RecordedMotion::Fixed(pose) = good().motion else { unreachable!() };
    let skew = SurfacePose { R_WP: pose.R_WP * 1.1, ..pose };
    let no_rotation =
        error(times(3), PalmRecord { motion: RecordedMotion::Poses(vec![pose, pose, skew]), ..good() });
    assert!(matches!(
        no_rotation,
        ContactLogError::Pose { sample: 2, source: SurfaceError::NoRotation { .. }, .. }
    ));
    let away = SurfacePose { p_WP: pose.p_WP + 4000.0 * DVec3::X, ..pose };
    for motion in [
        RecordedMotion::Poses(vec![pose, pose, away]),
        RecordedMotion::Measured([pose, pose, away].map(MeasuredMotion::at_rest).to_vec()),
    ] {
        let jump = error(times(3), PalmRecord { motion, ..good() });
        assert!(
            matches!(
                jump,
                ContactLogError::Pose { palm: 1, sample: 2, source: SurfaceError::Jump { .. }, .. }
            ),
            "{jump}"
        );
    }
    for (v, w, value) in [(1e4, 0.0, 1e4), (0.0, 5e3, 5e3)] {
        let fast = MeasuredMotion { v_WP: DVec3::Y * v, w_WP: DVec3::Z * w, ..MeasuredMotion::at_rest(pose) };
        let motion = RecordedMotion::Measured(vec![MeasuredMotion::at_rest(pose), fast, fast]);
        let told = error(times(3), PalmRecord { motion, ..good() });
        assert!(
            matches!(told, ContactLogError::TooFast { palm: 1, sample: 1, value: v, .. } if v == value),
            "{told}"
        );
    }
    let other = SurfacePose { p_WP: pose.p_WP + 0.1 * DVec3::X, ..pose };
    let few =
        error(times(3), PalmRecord { motion: RecordedMotion::Poses(vec![pose, pose, other]), ..good() });
    assert_eq!(few, ContactLogError::TwistFromPoses { palm: 1, samples: 3 });
    let pull = |values: [f64; 3]| {
        let x = good().motion;
        let RecordedMotion::Fixed(pose) = x else { unreachable!() };
        let n = pose.R_WP * DVec3::X;
        PalmRecord { force: ForceChannel::Three(values.map(|f| f * n).to_vec()), ..good() }
    };
    assert!(ContactLog::new(times(3), vec![pull([5.0, -0.4, 5.0])], None).is_ok());
    let pulls = error(times(3), pull([5.0, -0.6, 5.0]));
    assert!(
        matches!(pulls, ContactLogError::Pull { palm: 1, sample: 1, value, .. } if (value + 0.6).abs() < 1e-12)
    );
    let infinite = PalmRecord { impulse: ForceChannel::Normal(vec![0.0, 0.0, f64::INFINITY]), ..good() };
    assert!(matches!(
        error(times(3), infinite),
        ContactLogError::ReadingNotFinite { what: "impulse", sample: 2, .. }
    ));
    let far = error(times(3), PalmRecord { contacts: points(DVec3::X * 1e300), ..good() });
    let ContactLogError::TooLarge { what: "contact", palm: 1, sample: 1, value, .. } = far else {
        panic!("{far}")
    };
    assert_eq!(value, 1e300);
}

/// What a palm does while nothing is recorded its velocities before and after do not say; what it does at the samples they do.
#[test]
fn a_way_within_a_gap_does_not_contradict_velocities() {
    let usual = times(400);
    let made = |pause: f64, factor: f64| {
        let after = |k: usize| if k < 200 { 0.0 } else { 1.0 };
        let times: Vec<f64> = usual.iter().enumerate().map(|(k, t)| t + pause * after(k)).collect();
        let [_, mut record] = moving(&usual);
        if let RecordedMotion::Measured(states) = &mut record.motion {
            for (k, state) in states.iter_mut().enumerate() {
                state.pose.p_WP += after(k) * 2.0 * DVec3::X;
                state.v_WP *= factor;
            }
        }
        ContactLog::new(times, vec![record], None)
    };
    assert!(made(0.5, 1.0).is_ok(), "{}", made(0.5, 1.0).unwrap_err());
    let unit = made(0.5, 100.0).unwrap_err();
    assert!(matches!(unit, ContactLogError::TwistAgainstPoses { palm: 1, .. }), "{unit}");
}

#[test]
fn twists_that_contradict_the_poses_are_named() {
    let times = times(400);
    let [_, measured] = moving(&times);
    type Change<'a> = &'a dyn Fn(usize, &mut MeasuredMotion);
    let made = |change: Change| {
        let mut record = measured.clone();
        if let RecordedMotion::Measured(states) = &mut record.motion {
            states.iter_mut().enumerate().for_each(|(k, state)| change(k, state));
        }
        ContactLog::new(times.clone(), vec![record], None)
    };
    assert!(made(&|_, _| {}).is_ok());
    let wrong: [(&str, &str, Change); 5] = [
        ("degrees", "angular velocity (W, rad/s)", &|_, state| state.w_WP *= 1.0_f64.to_degrees()),
        ("radians for degrees", "angular velocity (W, rad/s)", &|_, state| {
            state.w_WP *= 1.0_f64.to_radians()
        }),
        ("sign", "angular velocity (W, rad/s)", &|_, state| state.w_WP *= -1.0),
        ("millimetres", "velocity (V, m/s)", &|_, state| state.v_WP *= 100.0),
        ("kilometres", "velocity (V, m/s)", &|_, state| state.v_WP *= 1e-3),
    ];
    for (name, which, change) in wrong {
        let error = made(change).unwrap_err();
        assert!(
            matches!(error, ContactLogError::TwistAgainstPoses { what, palm: 1, .. } if what == which),
            "{name}: {error}"
        );
        assert!(error.to_string().contains("check its unit") && error.sample().is_some(), "{error}");
    }
    // Noise is no contradiction, of a palm that moves or of one that stands: 0.1 rad/s, 0.05 m/s.
    let noise = |k: usize| {
        DVec3::new((k * k % 17) as f64, (k * k % 13) as f64, (k * 7 % 11) as f64) / 8.0 - DVec3::ONE
    };
    let noisy = |k: usize, state: &mut MeasuredMotion| {
        state.w_WP += 0.1 * noise(k);
        state.v_WP += 0.05 * noise(k + 5);
    };
    assert!(made(&noisy).is_ok());
    let still = made(&|k, state| {
        let pose = SurfacePose { p_WP: DVec3::new(0.3, -0.2, 0.1), R_WP: DQuat::from_rotation_x(0.7) };
        *state = MeasuredMotion { pose, v_WP: DVec3::ZERO, w_WP: DVec3::ZERO };
        noisy(k, state);
    });
    assert!(still.is_ok(), "{}", still.unwrap_err());
}

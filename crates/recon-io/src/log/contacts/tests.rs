use super::super::LogFileErrorKind as Kind;
use super::*;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use recon::contact_kinematics::SurfaceError;
use recon::object_dynamics::{
    ContactLog, ContactLogError, ContactMode, ContactPoints, ForceChannel, MeasuredMotion, PalmRecord,
    RecordedMotion, SensorLog, SeriesError, TrueContact, TrueState, TwistSource,
};

const FINGERTIP: PalmSetup = PalmSetup {
    surface: PalmSurface::Sphere { radius: 0.012 },
    friction: Some(0.8),
    pose: None,
    hinge: None,
    largest_offset: 1e-3,
};
const PLANE: PalmSetup = PalmSetup {
    surface: PalmSurface::Plane,
    friction: None,
    pose: Some(SurfacePose { p_WP: DVec3::new(0.0, 0.0, 0.5), R_WP: DQuat::IDENTITY }),
    hinge: None,
    largest_offset: f64::INFINITY,
};

/// A fingertip with everything, that moves, and a fixed plane with the normal force in its own coordinates.
const HEADER: &str = "t,px_1,py_1,pz_1,Px_1,Py_1,Pz_1,Qw_1,Qx_1,Qy_1,Qz_1,Vx_1,Vy_1,Vz_1,Wx_1,Wy_1,Wz_1,fx_1,fy_1,fz_1,\
                      Jx_1,Jy_1,Jz_1,gap_1,slip_1,mode_1,sx_2,sy_2,sz_2,fn_2,Jn_2,tau_2,comment";
const ROWS: [&str; 2] = [
    "0,0.1,0,0.0121,0.1,0,0,1,0,0,0,0.2,0,0,0,0,3,0.5,0,2,1,0,0,1e-6,0.1,1,0.3,0.4,0,1.5,0,0.25,first",
    "0.001,0.1002,0,0.012,0.1002,0,0,1,0,0,0,0.2,0,0,0,0,3,0.5,0,2,1.0005,0,0.002,0,0.1,2,nan,nan,nan,0,0.001,nan,b",
];

/// The table with the cell of one column in one row replaced.
fn with(row: usize, column: &str, value: &str) -> Result<ContactLog, Kind> {
    let place = HEADER.split(',').position(|name| name == column).unwrap();
    let mut rows = ROWS.map(|row| row.split(',').collect::<Vec<_>>());
    rows[row][place] = value;
    let text = [HEADER.to_owned(), rows[0].join(","), rows[1].join(",")].join("\n");
    parse_contact_log(text.as_bytes(), &[FINGERTIP, PLANE])
}

/// The table with columns of other names.
fn renamed(from: &[&str], to: &[&str]) -> Result<ContactLog, Kind> {
    let name = |name| from.iter().position(|f| *f == name).map_or(name, |k| to[k]);
    let header = HEADER.split(',').map(name).collect::<Vec<_>>().join(",");
    parse_contact_log([&header, ROWS[0], ROWS[1]].join("\n").as_bytes(), &[FINGERTIP, PLANE])
}

#[test]
fn what_the_columns_say_is_read() {
    let log = with(0, "t", "0").unwrap();
    let [tip, plane] = [0, 1].map(|i| &log.palms()[i]);
    assert_eq!((tip.surface(), tip.friction()), (FINGERTIP.surface, Some(0.8)));
    // 0.1 mm off: put on the fingertip.
    assert!((tip.touch(0).unwrap().p_WC - DVec3::new(0.1, 0.0, 0.012)).length() < 1e-17);
    assert!((tip.touch(0).unwrap().n.get() - DVec3::Z).length() < 1e-15);
    assert_eq!(tip.motion(0).v_WP, DVec3::new(0.2, 0.0, 0.0));
    assert_eq!((tip.motion(0).w_WP, tip.twist_source()), (DVec3::new(0.0, 0.0, 3.0), TwistSource::Stated));
    assert_eq!(tip.force(0).unwrap().vector, DVec3::new(0.5, 0.0, 2.0));
    assert!((tip.impulse(1).unwrap().vector - DVec3::new(0.0005, 0.0, 0.002)).length() < 1e-16);
    assert_eq!(tip.truth(1).unwrap().mode, ContactMode::Stick);
    assert_eq!(plane.touch(0).unwrap().p_WC, DVec3::new(0.3, 0.4, 0.5));
    assert_eq!(plane.force(0).unwrap().vector, DVec3::new(0.0, 0.0, 1.5));
    assert_eq!((plane.torque(0), plane.torque(1)), (Some(0.25), None));
    assert_eq!((plane.twist_source(), plane.touch(1)), (TwistSource::Immobile, None));
}

#[test]
fn bad_cells_are_named_by_line_and_column() {
    let finite = |row, column: &str, value: &str| match with(row, column, value) {
        Err(Kind::NotFinite { line, column, .. }) => (line, column),
        other => panic!("{other:?}"),
    };
    assert_eq!(finite(1, "fz_1", "nan"), (3, "fz_1".to_owned()));
    assert_eq!(finite(0, "Jy_1", "inf"), (2, "Jy_1".to_owned()));
    assert_eq!(finite(0, "Wz_1", "nan"), (2, "Wz_1".to_owned()));
    assert_eq!(finite(0, "Px_1", "nan"), (2, "Px_1".to_owned()));
    assert!(matches!(with(0, "t", "now"), Err(Kind::NotANumber { line: 2, .. })));
    let half = with(1, "py_1", "nan").unwrap_err();
    assert!(matches!(&half, Kind::PartOfContact { line: 3, palm: 1, .. }), "{half}");
    assert!(half.to_string().contains("px_1, py_1, pz_1"), "{half}");
    let turned = with(0, "Qx_1", "0.5");
    assert!(matches!(turned, Err(Kind::Pose { line: 2, palm: 1, source: SurfaceError::NoRotation { .. } })));
    let off = with(1, "pz_1", "0.0135").unwrap_err();
    assert!(
        matches!(
            off,
            Kind::ContactSamples {
                line: Some(3),
                source: ContactLogError::OffPalm { palm: 1, sample: 1, .. }
            }
        ),
        "{off}"
    );
    let ghost = with(1, "fn_2", "0.5");
    assert!(matches!(ghost, Err(Kind::ForceOffContact { line: 3, palm: 2, column, .. }) if column == "fn_2"));
    assert!(with(1, "fn_2", "nan").is_ok());
    assert!(matches!(with(0, "mode_1", "3"), Err(Kind::Mode { line: 2, value: 3.0, .. })));
    let strained = with(1, "tau_2", "inf").unwrap_err();
    assert!(
        matches!(
            strained,
            Kind::ContactSamples {
                line: Some(3),
                source: ContactLogError::ReadingNotFinite { what: "torque", palm: 2, .. }
            }
        ),
        "{strained}"
    );
    assert!(matches!(with(0, "tau_2", "x"), Err(Kind::NotANumber { line: 2, .. })));
    let back = with(1, "t", "-1");
    assert!(matches!(back, Err(Kind::ContactSamples { line: Some(3), source: ContactLogError::Series(_) })));
}

#[test]
fn a_palm_that_stands_elsewhere_than_the_scene_says_is_named() {
    let text = [HEADER, ROWS[0], ROWS[1]].join("\n");
    let read = |p_WP: DVec3, R_WP: DQuat, largest_offset: f64| {
        let tip = PalmSetup { pose: Some(SurfacePose { p_WP, R_WP }), largest_offset, ..FINGERTIP };
        parse_contact_log(text.as_bytes(), &[tip, PLANE])
    };
    let first = DVec3::new(0.1, 0.0, 0.0);
    // The log's palm is 0.2 mm on at its second sample.
    assert!(read(first, DQuat::IDENTITY, 1e-3).is_ok());
    assert!(read(DVec3::ZERO, DQuat::IDENTITY, f64::INFINITY).is_ok());
    let Err(Kind::PoseAgainstScene(apart)) = read(first, DQuat::IDENTITY, 1.5e-4) else { panic!() };
    assert_eq!((apart.line, apart.palm), (3, 1));
    assert!((apart.distance - 2e-4).abs() < 1e-15 && (apart.log - apart.scene).length() == apart.distance);
    // A fingertip that is turned about its centre touches with another of its points: 12.1 mm times 0.1 rad.
    let Err(Kind::PoseAgainstScene(turned)) = read(first, DQuat::from_rotation_x(0.1), 1e-3) else {
        panic!()
    };
    assert_eq!((turned.line, turned.log), (2, DVec3::new(0.1, 0.0, 0.0121)));
    assert!((turned.distance - 0.0121 * 2.0 * 0.05_f64.sin()).abs() < 1e-15, "{turned}");
    assert!(turned.to_string().contains("line 2: palm 1 stands elsewhere"), "{turned}");
}

#[test]
fn columns_that_are_missing_or_say_the_same_are_named() {
    let missing = |from: &[&str], to: &[&str]| match renamed(from, to) {
        Err(Kind::MissingColumn { column, similar, .. }) => (column, similar),
        other => panic!("{other:?}"),
    };
    assert_eq!(missing(&["fy_1"], &["Fy-1"]), ("fy_1".to_owned(), Some("Fy-1".to_owned())));
    assert_eq!(missing(&["Qz_1"], &["quat"]), ("Qz_1".to_owned(), None));
    // `Px_1` is there, and is something else.
    assert_eq!(missing(&["px_1"], &["x"]), ("px_1".to_owned(), None));
    assert_eq!(missing(&["gap_1"], &["distance"]), ("gap_1".to_owned(), None));
    let both = renamed(&["comment"], &["fn_1"]);
    assert!(matches!(both, Err(Kind::TwoWays { first, .. }) if first == "`fn_1`"));
    assert!(matches!(renamed(&["comment"], &["t"]), Err(Kind::RepeatedColumn { .. })));
    let text = [HEADER, ROWS[0], ROWS[1]].join("\n");
    let count = parse_contact_log(text.as_bytes(), &[FINGERTIP]);
    assert!(matches!(count, Err(Kind::PalmCount { expected: 1, found: 2 })));
    let nowhere = PalmSetup { pose: None, ..PLANE };
    assert!(matches!(
        parse_contact_log(text.as_bytes(), &[FINGERTIP, nowhere]),
        Err(Kind::NoPose { palm: 2 })
    ));
}

#[test]
fn the_header_tells_the_version() {
    let text = [HEADER, ROWS[0], ROWS[1]].join("\n");
    let palms = [FINGERTIP, PLANE];
    let any = parse_any_log(text.as_bytes(), Some(&palms)).unwrap();
    assert_eq!(any, AnyLog::Contacts(parse_contact_log(text.as_bytes(), &palms).unwrap()));
    assert!(matches!(parse_any_log(text.as_bytes(), None), Err(Kind::NoPalms)));
    assert!(matches!(super::super::parse_log(text.as_bytes()), Err(Kind::AnyPalms { .. })));
    let reader = |palms| super::super::LogReader::new(text.as_bytes(), palms);
    assert!(matches!(reader(None), Err(Kind::NoPalms)));
    let Ok(super::super::LogReader::Contacts(rows)) = reader(Some(&palms)) else { panic!("no contacts") };
    let (AnyLog::Contacts(log), rows) = (any, rows.map(Result::unwrap).collect::<Vec<_>>()) else {
        panic!("no contacts")
    };
    assert_eq!(rows.iter().map(|row| row.0).collect::<Vec<_>>(), log.times());
    for (k, (_, sensed)) in rows.iter().enumerate() {
        for (palm, sensed) in log.palms().iter().zip(sensed) {
            assert_eq!(sensed.pose, palm.motion(k).pose);
            assert_eq!(sensed.contact.is_some(), palm.touch(k).is_some());
        }
    }
    let one = "t,s1_1,s2_1,nx_1,ny_1,nz_1,s1_2,s2_2,nx_2,ny_2,nz_2,s1_3,s2_3,nx_3,ny_3,nz_3";
    let row = "0.1,0.2,0.6,0,0.8,0.1,0.2,-0.3,0.5196,0.8,0.1,0.2,-0.3,-0.5196,0.8";
    let text = [one, &format!("0,{row}"), &format!("1,{row}")].join("\n");
    // Version 1 is read as ever, whether or not palms are given.
    for palms in [None, Some(&palms[..])] {
        let expected: Result<SensorLog, Kind> = super::super::parse_log(text.as_bytes());
        match (parse_any_log(text.as_bytes(), palms), expected) {
            (Ok(AnyLog::ThreePalms(log)), Ok(expected)) => assert_eq!(log, expected),
            other => panic!("{other:?}"),
        }
    }
    assert!(matches!(parse_any_log("t,x\n0,1".as_bytes(), None), Err(Kind::MissingColumn { .. })));
    assert!(matches!(parse_any_log("".as_bytes(), None), Err(Kind::Empty)));
    let short = parse_contact_log([HEADER, ROWS[0]].join("\n").as_bytes(), &palms);
    let source = ContactLogError::Series(SeriesError::TooShort { found: 1 });
    assert!(matches!(short, Err(Kind::ContactSamples { source: s, .. }) if s == source));
}

const SAMPLES: usize = 5;

fn vectors(size: f64) -> impl Strategy<Value = Vec<DVec3>> {
    proptest::collection::vec([-size..size, -size..size, -1e-9..1e-9f64].prop_map(DVec3::from_array), SAMPLES)
}

fn any_surface() -> impl Strategy<Value = PalmSurface> {
    (0..4, 0.01..0.3f64).prop_map(|(kind, radius)| match kind {
        0 => PalmSurface::Plane,
        1 => PalmSurface::Sphere { radius },
        2 => PalmSurface::Cup { radius },
        _ => PalmSurface::Cylinder { radius },
    })
}

fn any_channel() -> impl Strategy<Value = ForceChannel> {
    let normal = proptest::collection::vec(0.0..9.0f64, SAMPLES).prop_map(ForceChannel::Normal);
    // Forces of any direction would pull; those are for the sums.
    prop_oneof![Just(ForceChannel::Missing), normal]
}

/// Any palm: contacts somewhere near it, put on it when the log is made.
fn any_palm() -> impl Strategy<Value = PalmRecord> {
    let motion = (0..3, vectors(0.5), vectors(3.0), vectors(2.0)).prop_map(|(kind, at, turns, twists)| {
        // A spline takes no turns beyond a right angle.
        let share = if kind == 1 { 0.14 } else { 1.0 };
        let turn = |k: usize| DQuat::from_scaled_axis(share * turns[k]).normalize();
        let pose = |k: usize| SurfacePose { p_WP: at[k], R_WP: turn(k) };
        match kind {
            0 => RecordedMotion::Fixed(pose(0)),
            1 => RecordedMotion::Poses((0..SAMPLES).map(pose).collect()),
            _ => RecordedMotion::Measured(
                (0..SAMPLES)
                    .map(|k| MeasuredMotion { pose: pose(k), v_WP: twists[k], w_WP: turns[k] })
                    .collect(),
            ),
        }
    });
    let sums = prop_oneof![vectors(5.0).prop_map(ForceChannel::Three), any_channel()];
    let touched = (vectors(1.0), proptest::collection::vec(any::<bool>(), SAMPLES));
    (any_surface(), motion, touched, any_channel(), sums, any::<bool>()).prop_map(
        |(surface, motion, (points, touched), force, impulse, torque)| PalmRecord {
            surface,
            friction: Some(0.3),
            motion,
            contacts: ContactPoints::Palm(
                points
                    .into_iter()
                    .zip(&touched)
                    .map(|(p, there)| there.then_some(p + DVec3::Y * 2.0))
                    .collect(),
            ),
            force,
            impulse,
            hinge: None,
            torque: torque.then(|| touched.iter().map(|there| there.then_some(0.1)).collect()),
            truth: torque
                .then(|| vec![TrueContact { mode: ContactMode::Slide, gap: 1e-7, slip: 0.1 }; SAMPLES]),
            largest_offset: f64::INFINITY,
        },
    )
}

proptest! {
    #[test]
    fn what_is_written_reads_back_bit_for_bit(
        records in proptest::collection::vec(any_palm(), 1..=5), turn in [-3.0..3.0f64, -1.0..1.0, 0.0..1.0], known: bool,
    ) {
        let truth = known.then(|| vec![TrueState {
            p_WCm: DVec3::from_array(turn) / 3.0,
            R_WO: DQuat::from_scaled_axis(turn.into()).normalize(),
            v_WCm: DVec3::X / 7.0,
            w_WO: DVec3::from_array(turn),
        }; SAMPLES]);
        let times = (0..SAMPLES).map(|k| k as f64 / 3.0).collect();
        let log = ContactLog::new(times, records, truth).unwrap();
        let mut text = Vec::new();
        write_contact_log(&log, &mut text).unwrap();
        let setup = |palm: &recon::object_dynamics::LoggedPalm| PalmSetup {
            surface: palm.surface(), friction: palm.friction(), pose: None, hinge: None, largest_offset: 1e-9,
        };
        let palms: Vec<_> = log.palms().iter().map(setup).collect();
        let back = parse_contact_log(&text[..], &palms).unwrap();
        for (k, (a, b)) in log.palms().iter().zip(back.palms()).flat_map(|p| (0..SAMPLES).map(move |k| (k, p))) {
            prop_assert_eq!(a.touch(k), b.touch(k));
            prop_assert_eq!(a.motion(k), b.motion(k));
            prop_assert_eq!((a.force(k), a.impulse(k), a.torque(k)), (b.force(k), b.impulse(k), b.torque(k)));
            prop_assert_eq!((a.truth(k), a.twist_source()), (b.truth(k), b.twist_source()));
        }
        prop_assert_eq!((log.truth(), log.times()), (back.truth(), back.times()));
    }

    #[test]
    fn no_text_makes_it_panic(text in "(t,px_1,py_1,pz_1,fn_1\n)?[t,psPQVW12nxyzfJ_\n\".0-9e -]{0,200}") {
        let _ = parse_any_log(text.as_bytes(), Some(&[PLANE]));
    }
}

use super::*;
use crate::{TriangleMesh, write_contact_curves, write_motion, write_radius_functions};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, PalmFrame};
use recon::object_dynamics::ContactMode;
use recon::shape_bounds::Gap;
use serde_json::Value;

/// A unit ball that spins about Z on three still palms, with a rounding error put on the estimate.
fn data(count: usize) -> ReportData {
    let frames = [0.0, 2.1, 4.2].map(|azimuth| PalmFrame::from_azimuth_slope(azimuth, 1.0));
    let height = 1.0 / frames[0].n.z;
    let state = |k: usize, error: f64| MotionState {
        p_WCm: DVec3::new(0.0, 0.0, height + error),
        R_WO: DQuat::from_rotation_z(1e-2 * k as f64 + error),
        v_WCm: DVec3::ZERO,
        w_WO: DVec3::Z,
    };
    let palm = |frame: PalmFrame| PalmTrack {
        frames: vec![frame; count],
        contacts: (0..count)
            .map(|k| {
                let normal = state(k, 0.0).R_WO.inverse() * -frame.n;
                let p_WC = DVec3::new(0.0, 0.0, height) - frame.n;
                // The last sample has lost palm 1.
                (k + 1 < count || frame != frames[0]).then_some(PalmContact {
                    p_WC,
                    p_OC: normal,
                    normal,
                    radius: 1.0,
                })
            })
            .collect(),
        forces: (0..count).map(|k| (k > 0).then_some(2.5)).collect(),
    };
    let tetrahedron = TriangleMesh::new(
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    );
    let bound = |volume| Bound { mesh: tetrahedron.clone().unwrap(), volume };
    ReportData {
        title: "a <log> & \"more\"".into(),
        verdict: Verdict { level: Level::Good, text: "All </script> is well.".into() },
        times: (0..count).map(|k| 1e-2 * k as f64).collect(),
        palms: frames.map(palm),
        motion: (0..count).map(|k| state(k, 1e-7)).collect(),
        deviations: vec![[DVec3::new(3e-3, 4e-3, 0.0), DVec3::ONE, DVec3::splat(0.5), DVec3::Z * 0.1]; count],
        // The last quarter is not.
        relied_on: (0..count).map(|k| 4 * k < 3 * count).collect(),
        spans: vec![vec![ModeSpan { start: 0.0, end: 1.0, mode: ContactMode::Slide, sure: 10 }]; 3],
        truth: Some((0..count).map(|k| state(k, 0.0)).collect()),
        bounds: Some(Bounds { lower: bound(1.0 / 6.0), upper: Some(bound(8.0)), largest_gap: Some(gap()) }),
        true_shape: None,
        evidence: vec![Evidence {
            key: "condition".into(),
            name: "Condition number".into(),
            value: EvidenceValue::Number(f64::INFINITY),
            unit: String::new(),
            meaning: "Infinite here.".into(),
            level: Level::Bad,
        }],
        warnings: vec!["<b>mind</b>".into()],
        next: "touch <more>".into(),
    }
}

fn page(data: &ReportData) -> String {
    let mut bytes = Vec::new();
    write_report(data, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// The JSON that a page carries.
fn embedded(page: &str) -> serde_json::Value {
    let (_, rest) = page.split_once("<script type=\"application/json\" id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn page_refers_to_nothing_outside_of_itself() {
    let page = page(&data(50)).replace("http://www.w3.org/2000/svg", ""); // a name, not an address
    for outside in ["http:", "https:", "src=", "href=", "@import", "url(", "fetch(", "{{"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.contains("default-src 'none'"));
}

#[test]
fn text_cannot_break_out_of_the_page() {
    let page = page(&data(50));
    assert_eq!(page.matches("</script>").count(), 2);
    assert!(page.contains("<title>a &lt;log&gt; &amp; \"more\" – recon</title>"));
    assert_eq!(embedded(&page)["title"], "a <log> & \"more\"");
    // Verdict, warnings, key figures and evidence need no script.
    let (written, _) = page.split_once("<script type=").unwrap();
    for part in [
        "Reliable</strong>All &lt;/script&gt; is well.",
        "Warning</strong>&lt;b&gt;mind",
        "<dt>Upper bound</dt><dd>8<",
        "Infinite here.",
        "Next</strong>Touch &lt;more&gt;.",
        "<rect class=\"m1\"",
        "<rect class=\"doubtful\"",
    ] {
        assert!(written.contains(part), "{part}");
    }
}

#[test]
fn long_logs_are_thinned_and_gaps_are_kept() {
    let carried = embedded(&page(&data(5000)));
    let times = carried["t"].as_array().unwrap();
    assert!(times.len() <= 700 && times[times.len() - 1] == 49.99);
    assert!(carried["palms"][0]["radius"][times.len() - 1].is_null(), "palm 1 has lost contact at the end");
    assert_eq!(carried["palms"][0]["normals"].as_array().unwrap().len(), 3, "a still palm has one normal");
    let error = carried["departure"]["angle"][3].as_f64().unwrap();
    assert!((error - 1e-7).abs() < 1e-9, "{error}");
}

/// Bands are as high as 95 % of the errors are large: of the centre of mass, of its distance from a palm, of an orientation.
#[test]
fn curves_carry_their_uncertainty_forces_and_what_is_not_relied_on() {
    let data = data(100);
    let carried = embedded(&page(&data));
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    assert_eq!([0, 1, 2].map(|i| number(&carried["band"]["p"][i])), [5.88e-3, 7.84e-3, 0.0]);
    assert_eq!(number(&carried["band"]["w"][0]), 0.98);
    let n = data.palms[1].frames[0].n;
    let along = 1.96 * (3e-3 * n.x).hypot(4e-3 * n.y);
    assert!((number(&carried["palms"][1]["radiusBand"][0]) - along).abs() < 5e-3 * along);
    // A turn about Z of a body that has turned about Z by next to nothing moves z of its quaternion, and half as much.
    assert_eq!([0, 3].map(|i| number(&carried["band"]["q"][i])), [4.9e-9, 0.098]);
    assert!(carried["palms"][0]["force"][0].is_null() && carried["palms"][0]["force"][1] == 2.5);
    assert_eq!(carried["doubtful"], serde_json::json!([[0.745, 0.99]]));
}

/// Of half turns, whose w is zero but for rounding, on either side.
#[test]
fn truth_has_the_signs_of_the_estimate() {
    let mut data = data(20);
    let turned = |states: &mut [MotionState], z: f64| {
        for (k, state) in states.iter_mut().enumerate() {
            state.R_WO = DQuat::from_xyzw(0.0, 0.0, z, 1e-17) * DQuat::from_rotation_x(1e-2 * k as f64);
        }
    };
    turned(&mut data.motion, -1.0);
    turned(data.truth.as_mut().unwrap(), 1.0);
    let carried = embedded(&page(&data));
    assert_eq!(carried["truth"]["q"], carried["motion"]["q"]);
}

/// Where the bounds are farthest apart.
fn gap() -> Gap {
    let direction = Direction::new(DVec3::X).unwrap();
    Gap { direction, outer: DVec3::X * 1.6, inner: DVec3::X * 0.1, distance: 1.5 }
}

#[test]
fn the_next_touch_is_shown_where_the_bounds_are_farthest_apart() {
    let with = |largest_gap| {
        let mut data = data(20);
        data.bounds.as_mut().unwrap().largest_gap = largest_gap;
        embedded(&page(&data))["bounds"]["apart"].clone()
    };
    assert_eq!(with(Some(gap())), serde_json::json!([1.6, 0.0, 0.0]));
    assert_eq!(with(None), Value::Null);
}

/// The same numbers as on the console: six digits, two of a deviation.
#[test]
fn mass_and_inertia_are_tiles_with_their_deviations() {
    let row = |key: &str, value: f64| Evidence {
        key: key.into(),
        name: String::new(),
        value: EvidenceValue::Number(value),
        unit: "kg".into(),
        meaning: String::new(),
        level: Level::Neutral,
    };
    let mut data = data(20);
    data.evidence = vec![row("mass", 0.399_979_3), row("std_mass", 4.43e-5), row("moment_x", 1.6e-4)];
    let page = page(&data);
    for tile in [
        "<dt>Mass</dt><dd>0.399979<small class=\"deviation\">± 4.4e-5</small><small>kg</small></dd>",
        "<dt>Least moment</dt><dd>0.00016<small>kg m²</small></dd>",
    ] {
        assert!(page.contains(tile), "{tile}");
    }
}

#[test]
fn tracks_of_different_length_are_refused() {
    let mut bad = data(20);
    bad.palms[2].contacts.pop();
    let expected = ReportError::Length { what: "contacts of palm 3".into(), expected: 20, found: 19 };
    assert_eq!(bad.check(), Err(expected));
    assert_eq!(write_report(&bad, Vec::new()).unwrap_err().kind(), std::io::ErrorKind::InvalidInput);
    let mut still = data(20);
    still.times[7] = still.times[6];
    assert!(matches!(still.check(), Err(ReportError::Times { index: 7, .. })));
}

#[test]
fn tables_hold_what_the_report_shows() {
    let data = data(20);
    let text = |write: &dyn Fn(&mut Vec<u8>) -> std::io::Result<()>| {
        let mut bytes = Vec::new();
        write(&mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    };
    let motion = text(&|to| write_motion(&data.times, &data.motion, to));
    assert!(
        motion.starts_with("t,cmx,cmy,cmz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n") && motion.lines().count() == 21
    );
    let palms = data.palms.each_ref().map(|palm| &palm.contacts[..]);
    let curves = text(&|to| write_contact_curves(&data.times, &palms, to));
    assert_eq!(crate::parse_contacts(curves.as_bytes()).unwrap().concat().len(), 59);
    let radii = text(&|to| write_radius_functions(&data, to));
    assert!(radii.lines().last().unwrap().ends_with(",nan,1.0,1.0"));
}

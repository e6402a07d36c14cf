use super::definitions::Definition;
use super::encode::{Header, Marker, markers, pose_with_covariance};
use super::*;
use crate::bag::cdr::Cdr;
use crate::bag::{BagMapping, Reading, log_of_bag, parse_bag};

fn tetrahedron() -> TriangleMesh {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    TriangleMesh { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] }
}

fn result<'a>(times: &'a [f64], mesh: &'a TriangleMesh) -> ResultBag<'a> {
    let pose = |t: &f64| ResultPose {
        p_WCm: DVec3::new(*t, 0.0, 6.0),
        R_WO: DQuat::from_rotation_x(*t),
        covariance: Some([[0.01; 6]; 6]),
    };
    let contact = |t: &f64| {
        (*t < 0.5).then_some(ResultContact { p_WC: DVec3::new(*t, 0.0, 5.0), force: Some(2.0 * DVec3::Z) })
    };
    ResultBag {
        epoch: 1_760_000_000_000_000_000,
        times,
        motion: times.iter().map(pose).collect(),
        contacts: vec![times.iter().map(contact).collect()],
        curves: vec![DVec3::X; 3],
        lower: Some(mesh),
        upper: None,
    }
}

/// What is written is read by the code that reads the bags of others: poses, contacts, times.
#[test]
fn results_read_back() {
    let times: Vec<f64> = (0..10).map(|k| 0.1 * f64::from(k)).collect();
    let mesh = tetrahedron();
    let bytes = result(&times, &mesh).bytes().unwrap();
    let bag = parse_bag(&bytes[..]).unwrap();
    assert_eq!(bag.cut, None);
    let topics: Vec<_> = bag.topics.values().map(|topic| (topic.name.as_str(), topic.count)).collect();
    let expected = [
        ("/recon/bounds", 1),
        ("/recon/contact_curves", 1),
        ("/recon/contacts", 10),
        ("/recon/forces", 10),
        ("/recon/lower_bound", 1),
        ("/recon/markers", 10),
        ("/recon/palm_1/contact", 10),
        ("/recon/pose", 10),
        ("/tf", 10),
    ];
    assert_eq!(topics, expected);
    let contacts = &bag.topics["/recon/palm_1/contact"].messages;
    assert_eq!(contacts[2].reading, Reading::Contact(Some(([0.2, 0.0, 5.0], [0.0, 0.0, 2.0]))));
    assert_eq!((contacts[2].stamp, contacts[2].sequence), (1_760_000_000_200_000_000, 2));
    assert_eq!(contacts[9].reading, Reading::Contact(None));
    let Reading::Transforms(transforms) = &bag.topics["/tf"].messages[3].reading else { panic!() };
    assert_eq!((&*transforms[0].parent, &*transforms[0].child), ("world", "object"));
    assert_eq!(transforms[0].pose[..3], [0.1 * 3.0, 0.0, 6.0]);
}

/// The largest force is half of the reach of the contacts long, and ends where it pushes.
#[test]
fn forces_are_drawn_by_points_too() {
    let times = [0.0, 0.1, 0.6];
    let mesh = tetrahedron();
    let bag = result(&times, &mesh);
    let points = bag.along_arrows(1, bag.arrow_scale());
    assert_eq!(points.len(), 17);
    assert_eq!([points[0], points[16]], [DVec3::new(0.1, 0.0, 4.5), DVec3::new(0.1, 0.0, 5.0)]);
    assert!(bag.along_arrows(2, bag.arrow_scale()).is_empty(), "nothing is touched");
}

/// The contact message of our own is a source of logs: of a palm at rest under the object.
#[test]
fn contact_messages_make_a_log() {
    let times: Vec<f64> = (0..10).map(|k| 0.1 * f64::from(k)).collect();
    let mesh = tetrahedron();
    let bag = parse_bag(&result(&times, &mesh).bytes().unwrap()[..]).unwrap();
    let mapping = BagMapping::parse(
        "[[palm]]\nkind = \"flat\"\nframe = \"world\"\ncontact = \"/recon/palm_1/contact\"",
    )
    .unwrap();
    let setups = crate::palms_of(&mapping, None).unwrap();
    let made = log_of_bag(&bag, &mapping, &setups).unwrap();
    let palm = &made.log.palms()[0];
    assert_eq!(palm.touch(2).unwrap().p_WC, DVec3::new(0.2, 0.0, 0.0));
    assert_eq!(palm.force(2).unwrap().vector, 2.0 * DVec3::Z);
    assert!(palm.touch(7).is_none());
}

/// Every field in its place, by the definition that is written beside it.
#[test]
fn markers_are_laid_out_as_defined() {
    let header = Header { time: -1, frame: "object" };
    let marker = Marker::triangles(header, "lower", 7, vec![DVec3::X]).with_frame([0.1, 0.2, 0.3, 0.4]);
    let bytes = markers(&[marker]);
    let mut from = Cdr::new(&bytes).unwrap();
    assert_eq!(from.count(1, "markers"), Ok(1));
    assert_eq!(
        (from.i32("sec"), from.u32("nanosec"), from.text("frame")),
        (Ok(-1), Ok(999_999_999), Ok("object"))
    );
    assert_eq!(from.text("ns"), Ok("lower"));
    assert_eq!((from.i32("id"), from.i32("type"), from.i32("action")), (Ok(7), Ok(11), Ok(0)));
    assert_eq!(from.f64s("pose and scale"), Ok([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]));
    assert_eq!([0; 4].map(|_| from.f32("color").unwrap()), [0.1, 0.2, 0.3, 0.4]);
    assert_eq!((from.i32("lifetime"), from.u32("lifetime"), from.u8("frame_locked")), (Ok(0), Ok(0), Ok(1)));
    assert_eq!((from.count(24, "points"), from.f64s("point")), (Ok(1), Ok([1.0, 0.0, 0.0])));
    assert_eq!((from.count(1, "colors"), from.text("texture_resource")), (Ok(0), Ok("")));
    assert_eq!((from.i32("sec"), from.u32("nanosec"), from.text("frame")), (Ok(0), Ok(0), Ok("")));
    assert_eq!((from.text("format"), from.count(1, "data"), from.count(1, "uv")), (Ok(""), Ok(0), Ok(0)));
    assert_eq!(
        (from.text("text"), from.text("mesh_resource"), from.text("filename")),
        (Ok(""), Ok(""), Ok(""))
    );
    assert_eq!((from.count(1, "data"), from.u8("materials"), from.end()), (Ok(0), Ok(0), Ok(())));
}

#[test]
fn the_covariance_stands_row_by_row() {
    let header = Header { time: 0, frame: "world" };
    let whole = std::array::from_fn(|i| std::array::from_fn(|k| (10 * i + k) as f64));
    let bytes = pose_with_covariance(header, (DVec3::ZERO, DQuat::IDENTITY), Some(whole));
    let mut from = Cdr::new(&bytes).unwrap();
    assert!(from.i32("s").is_ok() && from.u32("ns").is_ok() && from.text("frame").is_ok());
    assert!(from.f64s::<7>("pose").is_ok());
    let covariance: [f64; 36] = from.f64s("covariance").unwrap();
    for (k, value) in covariance.into_iter().enumerate() {
        assert_eq!(value, (10 * (k / 6) + k % 6) as f64);
    }
    assert_eq!(from.end(), Ok(()));
}

/// Every type that a definition names is defined after it, and each once.
#[test]
fn definitions_are_complete() {
    const PRIMITIVE: [&str; 8] =
        ["bool", "uint8", "int32", "uint32", "float32", "float64", "string", "uint64"];
    use Definition::{Contact, MarkerArray, PointCloud2, PoseWithCovarianceStamped, TFMessage};
    for definition in [Contact, MarkerArray, PointCloud2, PoseWithCovarianceStamped, TFMessage] {
        let text = definition.text();
        let defined: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("MSG: ")).collect();
        let mut package = definition.name().split('/').next().unwrap();
        let mut used = 0;
        for line in text.lines().filter(|line| !line.starts_with('#') && !line.starts_with('=')) {
            if let Some(name) = line.strip_prefix("MSG: ") {
                package = name.split('/').next().unwrap();
                continue;
            }
            let kind = line.split([' ', '[']).next().unwrap();
            if !PRIMITIVE.contains(&kind) {
                let full = if kind.contains('/') { kind.to_owned() } else { format!("{package}/{kind}") };
                assert_eq!(defined.iter().filter(|name| **name == full).count(), 1, "{definition:?} {full}");
                used += 1;
            }
        }
        assert!(used > 0);
    }
}

//! Bags that become logs.

use super::{bag, expected};
use crate::bag::{
    Bag, BagErrorKind as Kind, BagLog, BagMapping, BagTransform, ForceOn, Joint, JointTopic, MessageKind,
    Reading, clocks_of_bag, draft_mapping, log_of_bag, overview, palms_of,
};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::PalmSurface;
use recon::object_dynamics::{ContactLog, ForceChannel};
use serde_json::Value;

fn drafted(bag: &Bag) -> BagMapping {
    let draft = draft_mapping(bag, "a.mcap").unwrap();
    let mut as_text = draft.mapping.clone();
    // Taxels beside contacts are a remark in the text.
    as_text.palms.iter_mut().filter(|palm| palm.contact.is_some()).for_each(|palm| palm.taxels = None);
    assert_eq!(BagMapping::parse(&draft.text).unwrap(), as_text, "{}", draft.text);
    draft.mapping
}

fn log(bag: &Bag, mapping: &BagMapping) -> Result<BagLog, Kind> {
    log_of_bag(bag, mapping, &palms_of(mapping, None)?)
}

fn points(value: &Value) -> Vec<DVec3> {
    let number = |v: &Value, i: usize| v[i].as_f64().unwrap_or(0.0);
    let point = |v: &Value| DVec3::new(number(v, 0), number(v, 1), number(v, 2));
    value.as_array().unwrap().iter().map(point).collect()
}

/// The contact of a palm at a sample, in the palm's axes.
fn in_palm(log: &ContactLog, palm: usize, k: usize) -> DVec3 {
    let palm = &log.palms()[palm];
    palm.motion(k).pose.at_rest().to_palm(palm.touch(k).unwrap().p_WC)
}

/// Without topics of contacts these come from the wrenches.
fn from_wrenches(mut mapping: BagMapping) -> BagMapping {
    mapping.palms.iter_mut().for_each(|palm| (palm.contact, palm.taxels) = (None, None));
    mapping.clocks.clear();
    mapping
}

#[test]
fn a_bag_with_one_clock_is_the_log_that_it_was_made_of() {
    let bag = bag("fig5.mcap");
    let mapping = drafted(&bag);
    assert!(
        mapping.clocks.is_empty() && mapping.palms.iter().all(|palm| palm.kind.as_deref() == Some("flat"))
    );
    let made = log(&bag, &mapping).unwrap();
    assert_eq!(
        (made.epoch, made.log.times().len(), &made.warnings),
        (1_760_000_000_000_000_000, 1501, &vec![])
    );
    // Times are those of the log, to the last digit.
    assert_eq!(made.log.times()[..3], [0.0, 0.001, 0.002]);
    let expected = &expected("fig5.mcap")["centre_of_pressure"];
    let by_wrench = log(&bag, &from_wrenches(mapping)).unwrap();
    for (i, palm) in ["palm_1", "palm_2", "palm_3"].into_iter().enumerate() {
        for (k, point) in points(&expected[palm]["first3"]).into_iter().enumerate() {
            assert!(in_palm(&by_wrench.log, i, k).distance(point) < 1e-14);
            assert!(in_palm(&made.log, i, k).distance(point) < 1e-14);
        }
        let world = &expected[palm]["contact_in_world_first"];
        let first = made.log.palms()[i].touch(0).unwrap();
        assert!(first.p_WC.distance(points(&Value::Array(vec![world.clone()]))[0]) < 1e-14);
    }
    // Velocities of the truth come from a spline: the scene starts with (0, 0.3, 0.3) rad/s.
    let truth = &made.log.truth().unwrap()[0];
    assert!(truth.w_WO.distance(DVec3::new(0.0, 0.3, 0.3)) < 1e-5, "{}", truth.w_WO);
}

/// The 3 ms by which contacts are stamped late are found on each palm, and the mapping that is drafted takes them out.
#[test]
fn a_clock_that_is_ahead_is_found_and_taken_out() {
    let bag = bag("s4_fingertips.mcap");
    let mut mapping = drafted(&bag);
    assert_eq!(mapping.clocks.len(), 3);
    let found = draft_mapping(&bag, "a.mcap").unwrap().clocks;
    // The reference finds 3.00 ms too, on a grid of 0.01 ms; contacts of the simulator sink in by up to 6e-7 m, which is 8e-5 s on their way.
    assert!(
        found.iter().all(|clock| (clock.offset.ahead - 0.003).abs() < 5e-6 && clock.offset.deviation < 2e-6),
        "{found:?}"
    );
    assert!(
        mapping
            .clocks
            .iter()
            .all(|clock| clock.topic.ends_with("/contact") && (clock.ahead - 0.003).abs() < 2e-6)
    );
    for palm in &mapping.palms {
        assert_eq!((palm.kind.as_deref(), palm.radius), (Some("sphere"), Some(0.012)));
    }
    let clocks = clocks_of_bag(&bag, &mapping, &palms_of(&mapping, None).unwrap()).unwrap();
    assert!(clocks.iter().all(|clock| !clock.disagrees && (clock.offset.distance) < 1e-6), "{clocks:?}");
    mapping.clocks.remove(1);
    let error = log(&bag, &mapping).unwrap_err();
    let Kind::ClocksDisagree { topic, other, palm: 2, ahead, deviation } = &error else { panic!("{error}") };
    assert_eq!((topic.as_str(), other.as_str()), ("/palm_2/contact", "/palm_2/wrench"));
    assert!((ahead - 0.003).abs() < 5e-6 && *deviation < 2e-6, "{ahead} {deviation}");
    assert!(error.to_string().contains("ahead = 0.00299"), "{error}");
    mapping.clocks_as_stamped = true;
    assert!(log(&bag, &mapping).is_ok());
}

#[test]
fn fingertips_are_brought_together_and_the_dropout_is_named() {
    let bag = bag("s4_fingertips.mcap");
    let mapping = drafted(&bag);
    let made = log(&bag, &mapping).unwrap();
    // 251 contacts, of which those at 600 to 636 ms have no wrench of palm 2.
    assert_eq!(made.log.times().len(), 241);
    let words =
        "/palm_2/wrench has nothing from t = 0.599 to 0.64 s: 40 messages are missing (numbers 600 to 639).";
    assert!(made.warnings.iter().any(|w| w == words), "{:?}", made.warnings);
    assert!(
        made.warnings
            .iter()
            .any(|w| w.contains("10 of 251 samples are left out") && w.contains("/palm_2/wrench"))
    );
    let expected = &expected("s4_fingertips.mcap")["contact_from_wrench_on_sphere"];
    let by_wrench = log(&bag, &from_wrenches(mapping.clone())).unwrap();
    for (i, palm) in ["palm_1", "palm_2", "palm_3"].into_iter().enumerate() {
        // The slowest topic is then that of the transforms, which has every second of the wrenches.
        for (k, point) in
            points(&expected[palm]["first3"]).into_iter().enumerate().filter(|(k, _)| k % 2 == 0)
        {
            assert!(in_palm(&by_wrench.log, i, k / 2).distance(point) < 1e-12, "{palm} {k}");
        }
    }
}

/// At odd milliseconds poses lie between transforms: the error that is stated is that which occurs, by the reference.
#[test]
fn the_stated_error_of_interpolated_poses_is_that_which_occurs() {
    let bag = bag("s4_fingertips.mcap");
    let mut mapping = from_wrenches(drafted(&bag));
    mapping.times = Some("/palm_1/wrench".to_owned());
    let made = log(&bag, &mapping).unwrap();
    assert_eq!(made.log.times().len(), 1001 - 40);
    let expected = &expected("s4_fingertips.mcap")["tf_interpolation_error_max_at_odd_ms"];
    for palm in 1..=3 {
        let note = made
            .notes
            .iter()
            .find(|note| note.starts_with(&format!("Palm {palm}: ")) && note.contains("the pose"));
        let note = note.unwrap_or_else(|| panic!("{:?}", made.notes));
        let stated: Vec<f64> =
            note.split_whitespace().filter_map(|word| word.parse().ok()).filter(|v| *v < 1e-3).collect();
        let truth = &expected[format!("palm_{palm}")];
        for (stated, key) in stated.iter().zip(["position_m", "rotation_rad"]) {
            let truth = truth[key].as_f64().unwrap();
            // Two digits are told; the second derivative changes from one interval to the next.
            assert!((0.9 * truth..1.5 * truth).contains(stated), "{note} {truth}");
        }
        assert_eq!(stated.len(), 2, "{note}");
    }
}

#[test]
fn taxels_give_forces_and_centres_of_the_reference() {
    let bag = bag("taxels.mcap");
    let mut mapping = drafted(&bag);
    mapping.palms.iter_mut().for_each(|palm| palm.contact = None);
    let taxels = &expected("taxels.mcap")["taxels"];
    for (floor, key) in [(None, "all_taxels"), (Some(0.05), "above_5_percent_of_largest")] {
        for palm in &mut mapping.palms {
            palm.wrench = None;
            palm.taxels.as_mut().unwrap().floor = floor;
        }
        let made = log(&bag, &mapping).unwrap();
        for i in 0..3 {
            let expected = &taxels[format!("palm_{}", i + 1)][key];
            let mut all: Vec<(usize, &Value)> =
                expected["first3"].as_array().unwrap().iter().enumerate().collect();
            all.push((100, &expected["last"]));
            for (k, expected) in all {
                let ForceChannel::Normal(forces) = made.log.palms()[i].force_channel() else { panic!() };
                assert!((forces[k] - expected["force_N"].as_f64().unwrap()).abs() < 1e-12, "{i} {k}");
                let centre = points(&Value::Array(vec![expected["centre_in_palm_frame"].clone()]))[0];
                assert!(in_palm(&made.log, i, k).distance(centre) < 1e-12, "{i} {k}");
            }
        }
    }
}

/// The same values come as images and as named arrays.
#[test]
fn tactile_states_are_the_images() {
    let bag = bag("taxels.mcap");
    let image = drafted(&bag);
    let mut images = image.clone();
    images.palms.iter_mut().for_each(|palm| palm.contact = None);
    let mut states = images.clone();
    for (i, palm) in states.palms.iter_mut().enumerate() {
        let taxels = palm.taxels.as_mut().unwrap();
        taxels.topic = "/tactile_states".to_owned();
        taxels.sensor = Some(format!("palm_{}_taxels", i + 1));
        (taxels.rows, taxels.columns) = (Some(16), Some(16));
    }
    let [images, states] = [&images, &states].map(|mapping| log(&bag, mapping).unwrap());
    assert_eq!(images.log, states.log);
}

#[test]
fn an_overview_tells_rates_gaps_and_clocks() {
    let bag = bag("s4_fingertips.mcap");
    let overview = overview(&bag, "s4_fingertips.mcap").unwrap();
    let of = |name: &str| overview.topics.iter().find(|topic| topic.name == name).unwrap();
    for (name, rate) in [("/palm_1/wrench", 1000.0), ("/tf", 500.0), ("/palm_3/contact", 250.0)] {
        assert!((of(name).rate.unwrap() - rate).abs() < 1e-6 * rate, "{name}");
    }
    let [gap] = of("/palm_2/wrench").gaps[..] else { panic!("{:?}", of("/palm_2/wrench").gaps) };
    assert_eq!((gap.from, gap.to, gap.missing, gap.sequences), (0.599, 0.64, 40, Some((600, 639))));
    let expected = expected("s4_fingertips.mcap");
    for topic in &overview.topics {
        let latency = &expected["log_minus_stamp_ns_min_median_max"][&topic.name];
        for (found, expected) in topic.latency.unwrap().into_iter().zip(latency.as_array().unwrap()) {
            // The reference's median is the mean of the two in the middle where the number is even.
            assert!((found - 1e-9 * expected.as_f64().unwrap()).abs() < 1e-6, "{} {found}", topic.name);
        }
    }
    let text = overview.text();
    for words in
        ["its clock is ahead", "comes 0.003 s", "kind sphere of radius 0.012 m", "the clocks disagree"]
    {
        assert!(text.contains(words), "`{words}` is not in\n{text}");
    }
    assert!(overview.json()["clocks"][0]["disagrees"].as_bool().unwrap());
}

#[test]
fn shapes_and_scenes_must_agree() {
    let bag = bag("s4_fingertips.mcap");
    let mapping = drafted(&bag);
    let scene = |palms: &str| crate::Scene::parse(&format!("gravity = 9.81\n{palms}")).unwrap();
    let sphere = |radius: f64| format!("[[palm]]\nkind = \"sphere\"\nradius = {radius}\n");
    let three = sphere(0.012).repeat(3);
    let setups = palms_of(&mapping, Some(&scene(&three))).unwrap();
    assert!(setups.iter().all(|setup| setup.surface == PalmSurface::Sphere { radius: 0.012 }));
    let two = palms_of(&mapping, Some(&scene(&sphere(0.012).repeat(2))));
    assert!(matches!(two, Err(Kind::PalmCount { mapped: 3, palms: 2 })));
    let other = palms_of(&mapping, Some(&scene(&sphere(0.02).repeat(3)))).unwrap_err();
    assert!(other.to_string().contains("sphere of radius 0.012 m by the mapping"), "{other}");
}

/// Every bag that is broken is refused in words that name topic, place and mend.
#[test]
fn broken_bags_are_refused_by_name() {
    let whole = drafted(&bag("whole_short.mcap"));
    let refused = |file: &str, words: &[&str]| {
        let text = log(&bag(file), &whole).unwrap_err().to_string();
        for word in words {
            assert!(text.contains(word), "{file}: `{word}` is not in\n{text}");
        }
    };
    refused(
        "broken_truncated.mcap",
        &["byte", "627 whole messages", "the last on /", "mcap recover", "cut_off = true"],
    );
    refused("broken_schema_encoding.mcap", &["`/palm_2/wrench`", "`ros9msg`", "ros2msg"]);
    refused("broken_message_encoding.mcap", &["`/palm_2/wrench`", "`xyzcdr`", "`cdr`"]);
    refused("broken_empty_topic.mcap", &["`/palm_3/wrench`", "palm[3].wrench", "no message"]);
    refused(
        "broken_frames.mcap",
        &["`/palm_2/wrench`", "`palm_7`", "palm_1, palm_2, palm_3, world", "palm[2].wrench_frame"],
    );
    refused(
        "broken_nan.mcap",
        &["`/palm_1/wrench`", "t = 0.05 s", "force.z is NaN", "3 message(s)", "leave_out_not_finite"],
    );
}

#[test]
fn the_mends_mend() {
    let mut mapping = drafted(&bag("whole_short.mcap"));
    mapping.cut_off = true;
    let cut = log(&bag("broken_truncated.mcap"), &mapping).unwrap();
    assert!(
        (80..95).contains(&cut.log.times().len()) && cut.warnings.iter().any(|w| w.contains("cut off")),
        "{:?}",
        cut.warnings
    );
    mapping.leave_out_not_finite = true;
    let nan = log(&bag("broken_nan.mcap"), &mapping).unwrap();
    assert_eq!(nan.log.times().len(), 201 - 4);
    mapping.palms[1].wrench_frame = Some("palm_2".to_owned());
    let no_frame = log(&bag("broken_frames.mcap"), &mapping).unwrap_err();
    assert!(
        matches!(&no_frame, Kind::NoFrame { topic, key } if topic == "/palm_3/contact" && key == "palm[3].contact_frame")
    );
    mapping.palms[2].contact_frame = Some("palm_3".to_owned());
    let frames = log(&bag("broken_frames.mcap"), &mapping).unwrap();
    assert_eq!(frames.log, log(&bag("whole_short.mcap"), &mapping).unwrap().log);
}

#[test]
fn what_a_mapping_names_must_be_there() {
    let bag = bag("whole_short.mcap");
    let whole = drafted(&bag);
    let refused = |change: &dyn Fn(&mut BagMapping), words: &[&str]| {
        let mut mapping = whole.clone();
        change(&mut mapping);
        let text = log(&bag, &mapping).unwrap_err().to_string();
        for word in words {
            assert!(text.contains(word), "`{word}` is not in\n{text}");
        }
    };
    refused(
        &|m| m.palms[0].wrench = Some("/ft".to_owned()),
        &["`/ft`", "palm[1].wrench", "/palm_3/contact (geometry_msgs/msg/PointStamped)"],
    );
    refused(
        &|m| m.palms[0].wrench = Some("/truth/pose".to_owned()),
        &["PoseStamped", "WrenchStamped is needed"],
    );
    refused(
        &|m| m.palms[1].frame = Some("hand".to_owned()),
        &["`hand`", "palm[2].frame", "palm_1, palm_2, palm_3, world"],
    );
    refused(&|m| m.palms[1].frame = None, &["palm 2", "palm[2].frame"]);
    refused(&|m| m.times = Some("/clock".to_owned()), &["`/clock`", "times"]);
    let clock = |time, ahead| crate::TopicClock { topic: "/palm_1/contact".to_owned(), ahead, time };
    refused(
        &|m| m.clocks.push(clock(crate::TimeOf::Stamp, 100.0)),
        &["clocks disagree", "/palm_1/contact", "nothing in common"],
    );
    // A palm's force that is measured on the palm pushes the other way.
    refused(
        &|m| {
            m.palms.iter_mut().for_each(|palm| palm.force_on = ForceOn::Palm);
        },
        &["palm"],
    );
}

#[test]
fn mappings_say_what_is_wrong_with_them() {
    let refused = |text: &str, words: &[&str]| {
        let error = BagMapping::parse(text).unwrap_err().to_string();
        for word in words {
            assert!(error.contains(word), "`{word}` is not in\n{error}");
        }
    };
    refused("", &["no [[palm]]", "recon inspect"]);
    refused("[[palm]]\nframe = \"a\"", &["palm[1]", "`contact`, `taxels` and `wrench`"]);
    refused("[[palm]]\nwrench = \"/w\"\nkind = \"ball\"", &["palm[1].kind", "`ball`", "sphere"]);
    refused("[[palm]]\nwrench = \"/w\"\nkind = \"sphere\"", &["palm[1].radius"]);
    refused("[[palm]]\ntaxels = { topic = \"/t\", pitch = 0.0 }", &["palm[1].taxels.pitch", "above zero"]);
    refused("wrold = \"w\"", &["wrold"]);
    refused("[[palm]]\nwrench = \"/w\"\n[[clock]]\ntopic = \"/w\"\nahead = 1e9", &["clock[1].ahead"]);
    refused("[units]\nforce = 0.0\n[[palm]]\nwrench = \"/w\"", &["units.force"]);
}

/// A force that points into a flat palm is that on the palm, and the draft says so.
#[test]
fn a_force_on_the_palm_is_told_by_its_sign() {
    let mut bag = bag("whole_short.mcap");
    let whole = log(&bag, &drafted(&bag)).unwrap();
    for message in &mut bag.topics.get_mut("/palm_2/wrench").unwrap().messages {
        let Reading::Wrench(wrench) = &mut message.reading else { panic!() };
        *wrench = wrench.map(|v| -v);
    }
    let mapping = drafted(&bag);
    let on_palm: Vec<bool> = mapping.palms.iter().map(|palm| palm.force_on == ForceOn::Palm).collect();
    assert_eq!(on_palm, [false, true, false]);
    assert_eq!(log(&bag, &mapping).unwrap().log, whole.log);
}

/// The readings of a sensor that is set off and turned in the palm are those in the palm's axes.
#[test]
fn wrenches_of_a_frame_of_their_own_are_moved_into_the_palm() {
    let mut bag = bag("whole_short.mcap");
    let whole = log(&bag, &from_wrenches(drafted(&bag))).unwrap();
    let p = DVec3::new(0.1, -0.2, 0.3);
    let R = DQuat::from_scaled_axis(DVec3::new(0.3, 0.2, 0.1));
    let statics = &mut bag.topics.get_mut("/tf_static").unwrap().messages[0];
    let Reading::Transforms(all) = &mut statics.reading else { panic!() };
    let pose = [p.x, p.y, p.z, R.x, R.y, R.z, R.w];
    all.push(BagTransform { stamp: statics.stamp, parent: "palm_1".into(), child: "sensor".into(), pose });
    for message in &mut bag.topics.get_mut("/palm_1/wrench").unwrap().messages {
        let Reading::Wrench([a, b, c, d, e, f]) = &mut message.reading else { panic!() };
        let (force, torque) = (DVec3::new(*a, *b, *c), DVec3::new(*d, *e, *f));
        let (force, torque) = (R.inverse() * force, R.inverse() * (torque - p.cross(force)));
        ([*a, *b, *c], [*d, *e, *f]) = (force.to_array(), torque.to_array());
        message.frame = "sensor".into();
    }
    let mut mapping = from_wrenches(drafted(&bag));
    // The contacts are in the palm, in which the sensor stands.
    assert_eq!(mapping.palms[0].frame.as_deref(), Some("palm_1"));
    mapping.palms.iter_mut().for_each(|palm| palm.kind = Some("flat".to_owned()));
    let moved = log(&bag, &mapping).unwrap();
    for k in 0..whole.log.times().len() {
        let [a, b] = [&moved, &whole].map(|made| made.log.palms()[0].touch(k).unwrap().p_WC);
        assert!(a.distance(b) < 1e-13, "{k} {a} {b}");
    }
}

#[test]
fn torques_of_motors_come_from_joint_states() {
    let mut bag = bag("whole_short.mcap");
    let mut joints = bag.topics["/palm_1/wrench"].clone();
    joints.name = "/joint_states".to_owned();
    (joints.kind, joints.schema) = (Ok(MessageKind::Joints), MessageKind::Joints.name().to_owned());
    for (k, message) in joints.messages.iter_mut().enumerate() {
        let effort = Some(k as f64).filter(|_| k > 0);
        message.reading = Reading::Joints(vec![Joint { name: "hinge".into(), position: None, effort }]);
    }
    bag.topics.insert(joints.name.clone(), joints);
    let mut mapping = drafted(&bag);
    let joint = |name: &str| Some(JointTopic { topic: "/joint_states".to_owned(), name: name.to_owned() });
    mapping.palms[2].joint = joint("hinge");
    let made = log(&bag, &mapping).unwrap();
    let torques: Vec<_> = (0..3).map(|k| made.log.palms()[2].torque(k)).collect();
    assert_eq!(torques, [None, Some(1.0), Some(2.0)]);
    mapping.palms[2].joint = joint("elbow");
    assert!(log(&bag, &mapping).unwrap_err().to_string().contains("`elbow`"));
}

#[test]
fn a_bag_without_palms_says_what_there_is() {
    let mut bag = bag("whole_short.mcap");
    bag.topics.retain(|name, _| name == "/truth/pose");
    let found = overview(&bag, "a.mcap").unwrap();
    assert!(found.text().contains("No palm was found"), "{}", found.text());
    let error = log(&bag, &found.draft.mapping).unwrap_err().to_string();
    assert!(error.contains("/truth/pose (geometry_msgs/msg/PoseStamped)"), "{error}");
}

#[test]
fn transforms_that_are_no_tree_are_refused() {
    let with = |links: &[(&str, &str)]| {
        let mut bag = bag("whole_short.mcap");
        let statics = &mut bag.topics.get_mut("/tf_static").unwrap().messages[0];
        let Reading::Transforms(all) = &mut statics.reading else { panic!() };
        all.extend(links.iter().map(|(parent, child)| BagTransform {
            stamp: statics.stamp,
            parent: (*parent).into(),
            child: (*child).into(),
            pose: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        }));
        draft_mapping(&bag, "a.mcap").unwrap_err().to_string()
    };
    let circle = with(&[("palm_3", "world")]);
    assert!(circle.contains("stands in itself"), "{circle}");
    let two = with(&[("table", "palm_2")]);
    assert!(two.contains("`palm_2` stands in `world` and in `table`"), "{two}");
}

#[test]
fn stamps_that_were_never_set_are_told_and_log_times_taken() {
    let mut bag = bag("whole_short.mcap");
    bag.topics.get_mut("/palm_1/contact").unwrap().messages.iter_mut().for_each(|message| message.stamp = 0);
    let mut mapping = drafted(&super::bag("whole_short.mcap"));
    let error = log(&bag, &mapping).unwrap_err().to_string();
    for words in ["`/palm_1/contact`", "stamp 0 ns occurs 201 times", "time = \"log\""] {
        assert!(error.contains(words), "{error}");
    }
    let (topic, time) = ("/palm_1/contact".to_owned(), crate::TimeOf::Log);
    mapping.clocks.push(crate::TopicClock { topic, ahead: 0.0, time });
    let whole = super::bag("whole_short.mcap");
    assert_eq!(log(&bag, &mapping).unwrap().log, log(&whole, &mapping).unwrap().log);
}

/// A topic that falls silent again and again is told in one sentence.
#[test]
fn many_silences_are_told_together() {
    let mut bag = bag("whole_short.mcap");
    let mapping = drafted(&bag);
    let messages = &mut bag.topics.get_mut("/palm_1/wrench").unwrap().messages;
    messages.retain(|message| message.sequence % 10 != 5 && !(50..53).contains(&message.sequence));
    let made = log(&bag, &mapping).unwrap();
    let said: Vec<_> = made.warnings.iter().filter(|w| w.starts_with("/palm_1/wrench")).collect();
    let expected = "/palm_1/wrench is silent 21 times, with 23 messages missing by its period; the longest time it has nothing from \
                    t = 0.049 to 0.053 s: 3 messages are missing (numbers 50 to 52).";
    assert_eq!(said, [expected]);
    assert_eq!(made.log.times().len(), 201 - 23);
}

/// Palms whose readings are all told in the world are told apart by the names of their topics.
#[test]
fn palms_of_one_frame_are_told_apart_by_name() {
    let mut bag = bag("whole_short.mcap");
    for topic in bag.topics.values_mut().filter(|topic| topic.name.starts_with("/palm_")) {
        topic.messages.iter_mut().for_each(|message| message.frame = "world".into());
    }
    let mapping = draft_mapping(&bag, "a.mcap").unwrap().mapping;
    for (i, palm) in mapping.palms.iter().enumerate() {
        let [wrench, contact] = ["wrench", "contact"].map(|what| format!("/palm_{}/{what}", i + 1));
        assert_eq!((&palm.wrench, &palm.contact), (&Some(wrench), &Some(contact)));
    }
    assert_eq!(mapping.palms.len(), 3);
}

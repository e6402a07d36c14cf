use super::{bag, expected, path, topic};
use crate::bag::{
    BagErrorKind, BagMapping, MappingErrorKind, Unread, draft_mapping, is_bag, log_of_bag, palms_of,
    parse_bag,
};
use proptest::prelude::*;
use serde_json::json;

#[test]
fn a_bag_that_was_cut_off_is_read_up_to_there() {
    let (bag, expected) = (bag("broken_truncated.mcap"), expected("broken_truncated.mcap"));
    assert_eq!(json!(bag.cut), expected["cut_chunk"]["offset_of_record"]);
    let counts: serde_json::Map<_, _> = bag
        .topics
        .iter()
        .filter(|(_, topic)| topic.count > 0)
        .map(|(name, topic)| (name.clone(), json!(topic.count)))
        .collect();
    assert_eq!(json!(counts), expected["messages_in_whole_chunks"]);
}

#[test]
fn unknown_encodings_are_named_and_leave_other_topics_alone() {
    let bags = ["broken_schema_encoding.mcap", "broken_message_encoding.mcap"];
    let [schema, message] = bags.map(bag);
    let name = "/palm_2/wrench";
    assert_eq!(topic(&schema, name).kind, Err(Unread::SchemaEncoding { found: "ros9msg".to_owned() }));
    assert_eq!(topic(&message, name).kind, Err(Unread::MessageEncoding { found: "xyzcdr".to_owned() }));
    for (file, bag) in bags.iter().zip([&schema, &message]) {
        assert_eq!(json!(topic(bag, name).count), expected(file)["topics"][name]["count"]);
        assert!(topic(bag, name).messages.is_empty());
        let others = bag.topics.values().filter(|topic| topic.kind.is_ok());
        assert_eq!(
            others.map(|topic| topic.messages.len()).collect::<Vec<_>>(),
            [201, 201, 201, 201, 201, 1, 201]
        );
    }
}

#[test]
fn a_topic_without_messages_is_there() {
    let bag = bag("broken_empty_topic.mcap");
    let silent = topic(&bag, "/palm_3/wrench");
    assert_eq!((silent.count, silent.kind.is_ok()), (0, true));
}

#[test]
fn a_topic_without_a_schema_says_so() {
    let unread = super::super::Unread::Schema { schema: String::new() };
    assert!(unread.to_string().starts_with("messages without a schema are not read"), "{unread}");
}

#[test]
fn what_is_no_bag_is_told() {
    let error = parse_bag(&b"t,s1_1,s2_1\n"[..]).unwrap_err();
    assert!(matches!(error, BagErrorKind::NoBag { .. }), "{error}");
    for (bytes, said) in [
        (&b""[..], "it is empty"),
        (b"t,s1_1\n0", "it begins with the text `t,s1_1 0`"),
        (b"\x89MC", "it begins with the bytes 89 4d 43"),
    ] {
        let error = parse_bag(bytes).map(|_| ()).unwrap_err();
        assert!(matches!(error, BagErrorKind::NoBag { .. }) && error.to_string().contains(said), "{error}");
    }
    assert!(is_bag(path("fig5.mcap")) && !is_bag(path("mcap.json")) && !is_bag(path("")));
}

/// Why a bag gives no log by a mapping.
fn refused(bag: &crate::bag::Bag, mapping: &BagMapping) -> BagErrorKind {
    log_of_bag(bag, mapping, &palms_of(mapping, None).unwrap()).unwrap_err()
}

#[test]
fn what_a_mapping_names_wrongly_is_told_by_what_is_wrong() {
    let mut whole = bag("whole_short.mcap");
    let good = draft_mapping(&whole, "a.mcap").unwrap();
    // A world of another name: no frame of a palm is wrong.
    let other = BagMapping { world: "map".to_owned(), ..good.mapping.clone() };
    let error = refused(&whole, &other);
    let BagErrorKind::UnknownFrame { key, known, .. } = &error else { panic!("{error}") };
    assert!(key == "world" && known.contains("palm_1") && known.contains("world"), "{error}");
    // Transforms that cannot be read are what is wrong, not the frames that they would have told.
    let why = Unread::MessageEncoding { found: "xml".to_owned() };
    let transforms = whole.topics.get_mut("/tf_static").unwrap();
    transforms.messages.clear();
    transforms.kind = Err(why.clone());
    let error = refused(&whole, &good.mapping);
    assert!(matches!(&error, BagErrorKind::Unread { topic, .. } if topic == "/tf_static"), "{error}");
    // Without any topic it is topics that lack.
    whole.topics.clear();
    let error = refused(&whole, &good.mapping);
    assert!(matches!(&error, BagErrorKind::NoTopic { asked, .. } if asked == "palm[1].wrench"), "{error}");
    // Two palms with one sensor.
    let twice = good.text.replace("/palm_2/wrench", "/palm_1/wrench");
    let error = BagMapping::parse(&twice).unwrap_err();
    assert!(matches!(error, MappingErrorKind::Shared { key: "wrench", palms: [1, 2], .. }), "{error}");
}

/// One flipped bit in a packed chunk is seen by its checksum, and the place is named.
#[test]
fn damage_is_seen_by_the_checksum() {
    let mut bytes = std::fs::read(path("whole_short.mcap")).unwrap();
    let middle = bytes.len() / 4;
    bytes[middle] ^= 1;
    let error = parse_bag(&bytes[..]).unwrap_err();
    let BagErrorKind::Chunk { place, .. } = error else { panic!("{error}") };
    assert!((place as usize) < middle);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Whatever is damaged, there is a bag or an error: never a panic, and never more messages than before.
    #[test]
    fn no_damage_makes_it_panic(
        hits in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
        cut in any::<prop::sample::Index>(),
        packed in any::<bool>(),
    ) {
        let mut bytes = if packed { std::fs::read(path("broken_truncated.mcap")).unwrap() } else { plain_bag() };
        for (at, to) in hits {
            let at = at.index(bytes.len());
            bytes[at] = to;
        }
        let _ = parse_bag(&bytes[..]);
        let _ = parse_bag(&bytes[..cut.index(bytes.len())]);
    }

    #[test]
    fn no_bytes_after_the_magic_make_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300), operation in 0..20_u8, length in 0..300_u64) {
        let head = [mcap::MAGIC, &[operation], &length.to_le_bytes()].concat();
        let _ = parse_bag(&[head, bytes].concat()[..]);
    }
}

/// A bag whose chunks are not packed, so that damage meets the records in them, and without checksums that would see it.
fn plain_bag() -> Vec<u8> {
    points(None, "")
}

/// A bag of twenty points, packed or not, with this definition.
fn points(packed: Option<mcap::Compression>, definition: &str) -> Vec<u8> {
    let mut to = std::io::Cursor::new(Vec::new());
    let options =
        mcap::WriteOptions::new().compression(packed).calculate_chunk_crcs(false).chunk_size(Some(500));
    let mut writer = options.create(&mut to).unwrap();
    let schema =
        writer.add_schema("geometry_msgs/msg/PointStamped", "ros2msg", definition.as_bytes()).unwrap();
    let channel = writer.add_channel(schema, "/point", "cdr", &Default::default()).unwrap();
    for k in 0..20_u32 {
        let mut message = crate::bag::cdr::CdrWriter::new();
        message.i32(k as i32).u32(0).text("palm").f64s(&[1.0, 2.0, 3.0]);
        let time = u64::from(k) * 1_000_000_000;
        let header = mcap::records::MessageHeader {
            channel_id: channel,
            sequence: k,
            log_time: time,
            publish_time: time,
        };
        writer.write_to_known_channel(&header, &message.into_bytes()).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    to.into_inner()
}

#[test]
fn chunks_that_are_not_packed_are_read() {
    let bag = parse_bag(&plain_bag()[..]).unwrap();
    assert_eq!((topic(&bag, "/point").messages.len(), bag.cut), (20, None));
}

#[test]
fn chunks_that_are_packed_by_lz4_are_read() {
    let bag = parse_bag(&points(Some(mcap::Compression::Lz4), "")[..]).unwrap();
    assert_eq!((topic(&bag, "/point").messages.len(), bag.cut), (20, None));
}

/// A message of a known name with other fields would be read as what it is not.
#[test]
fn other_definitions_of_a_known_name_are_refused() {
    let bag = parse_bag(&points(None, "float32 x\nfloat32 y\nfloat32 z\n")[..]).unwrap();
    let topic = topic(&bag, "/point");
    let Err(Unread::Definition { found, .. }) = &topic.kind else { panic!("{:?}", topic.kind) };
    assert_eq!((found.as_str(), topic.count, topic.messages.len()), ("float32 float32 float32", 20, 0));
}

use super::cdr::CdrError;
use recon::contact_kinematics::{PressureError, SurfaceError};
use recon::object_dynamics::ContactLogError;
use std::path::PathBuf;
use thiserror::Error;

/// A bag that cannot be used: which file, and what is wrong with it where.
#[derive(Debug, Error)]
#[error("{}: {kind}", path.display())]
pub struct BagError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub kind: Box<BagErrorKind>,
}

impl BagErrorKind {
    /// The same of a file.
    #[must_use]
    pub fn in_file(self, path: impl Into<PathBuf>) -> BagError {
        BagError { path: path.into(), kind: Box::new(self) }
    }
}

/// What is wrong with a bag, or with what a mapping says of it. Places are bytes from the start of the file; times are stamps,
/// seconds since the first of the bag where it says `t`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum BagErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[from] std::io::Error),
    /// The file does not begin as bags do.
    #[error(
        "is not an MCAP bag: {}; bags of other storage are converted by `ros2 bag convert`",
        begins(found)
    )]
    NoBag {
        /// Its first bytes.
        found: Vec<u8>,
    },
    /// A chunk cannot be unpacked, or its checksum is wrong.
    #[error(
        "byte {place}: the chunk there cannot be unpacked ({detail}); `mcap recover` keeps what is before and after it"
    )]
    Chunk {
        /// Where it begins.
        place: u64,
        /// What is wrong with it.
        detail: String,
    },
    /// A record that is not what it says.
    #[error("byte {place}: the {what} there cannot be read ({detail}); `mcap recover` keeps what is whole")]
    Record {
        /// Where it, or the chunk that holds it, begins.
        place: u64,
        /// What it is.
        what: &'static str,
        /// What is wrong with it.
        detail: String,
    },
    /// The file ends before its end.
    #[error(
        "ends at byte {place} within a record, with {messages} whole messages before it{}: it was cut off; have it mended by `mcap \
         recover`, or take what is there by `cut_off = true` in the mapping",
        last.as_ref().map_or(String::new(), |(topic, t)| format!(", the last on {topic} at t = {t} s"))
    )]
    Cut {
        /// Where the record begins that is not whole.
        place: u64,
        /// Messages before it.
        messages: usize,
        /// Topic and time of the last of them.
        last: Option<(String, f64)>,
    },
    /// A topic that is mapped is not in the bag.
    #[error("there is no topic `{topic}`, which {asked} names; there are: {found}")]
    NoTopic {
        /// The topic.
        topic: String,
        /// The key that names it.
        asked: String,
        /// Topics with what they hold.
        found: String,
    },
    /// A topic of another kind than what it is taken for.
    #[error("topic `{topic}`, which {asked} names, has {found}; {needed} is needed there")]
    OtherKind {
        /// The topic.
        topic: String,
        /// The key that names it.
        asked: String,
        /// What it has.
        found: String,
        /// What is needed.
        needed: String,
    },
    /// The messages of a topic cannot be read.
    #[error("topic `{topic}`: {why}")]
    Unread {
        /// The topic.
        topic: String,
        /// Why.
        why: Unread,
    },
    /// A topic without messages.
    #[error(
        "topic `{topic}`, which {asked} names, is announced and has no message; take it out of the mapping, or record again"
    )]
    Silent {
        /// The topic.
        topic: String,
        /// The key that names it.
        asked: String,
    },
    /// A reading that is NaN or infinite where there must be a number.
    #[error(
        "topic `{topic}`, t = {t} s (stamp {stamp} ns): {what} is {value}, as in {count} message(s) of this topic; give \
         `leave_out_not_finite = true` in the mapping to do without these"
    )]
    NotFinite {
        /// The topic.
        topic: String,
        /// Time since the first stamp of the bag, s.
        t: f64,
        /// Its stamp, ns.
        stamp: i64,
        /// Which value.
        what: &'static str,
        /// The value.
        value: f64,
        /// How many such messages the topic has.
        count: usize,
    },
    /// Stamps of a topic repeat or go back.
    #[error(
        "topic `{topic}`: stamp {stamp} ns occurs {count} times; drop repeats, or give `time = \"log\"` for it under [[clock]]"
    )]
    Repeated {
        /// The topic.
        topic: String,
        /// The stamp, ns.
        stamp: i64,
        /// How often.
        count: usize,
    },
    /// Readings without a frame.
    #[error("topic `{topic}` has no frame (its frame_id is empty); name it by `{key}` in the mapping")]
    NoFrame {
        /// The topic.
        topic: String,
        /// The key that would say it.
        key: String,
    },
    /// Readings of one topic in several frames.
    #[error(
        "topic `{topic}` has readings in several frames ({found}); record them on topics of their own, or name one by `{key}`"
    )]
    ManyFrames {
        /// The topic.
        topic: String,
        /// The frames.
        found: String,
        /// The key that would say one.
        key: String,
    },
    /// A frame that no transform leads to.
    #[error(
        "{asked} is in frame `{frame}`, which no transform joins with `{to}`; frames that could be: {known}. Name another by `{key}` in the \
         mapping, or record /tf and /tf_static"
    )]
    UnknownFrame {
        /// What is in it: a topic or a palm.
        asked: String,
        /// The frame.
        frame: String,
        /// The frame it should be joined with.
        to: String,
        /// Frames that are joined with that; where there is no such frame, all.
        known: String,
        /// The key that would say another.
        key: String,
    },
    /// Frames that stand in each other in a circle.
    #[error("frame `{frame}` stands in itself, by the transforms above it; record those of one tree")]
    Circle {
        /// One of the frames.
        frame: String,
    },
    /// A frame that stands in two others.
    #[error(
        "frame `{frame}` stands in `{first}` and in `{second}`; a frame has one parent: leave one of these transforms out of the bag"
    )]
    TwoParents {
        /// The frame.
        frame: String,
        /// One parent.
        first: String,
        /// Another.
        second: String,
    },
    /// A transform that is none.
    #[error("transform of `{frame}` at t = {t} s: {source}")]
    Transform {
        /// The child frame.
        frame: String,
        /// Time since the first stamp of the bag, s.
        t: f64,
        /// Why.
        source: SurfaceError,
    },
    /// Topics that have no time in common.
    #[error(
        "clocks disagree: `{topic}` has stamps from {from} to {to} s, `{other}` from {other_from} to {other_to} s (since the first of \
         the bag), which have nothing in common; give `time = \"log\"` for one of them under [[clock]] in the mapping"
    )]
    NoOverlap {
        /// A topic.
        topic: String,
        /// Its first stamp, s.
        from: f64,
        /// Its last stamp, s.
        to: f64,
        /// Another topic.
        other: String,
        /// Its first stamp, s.
        other_from: f64,
        /// Its last stamp, s.
        other_to: f64,
    },
    /// Two topics about one contact that tell different times.
    #[error(
        "clocks disagree: contacts of `{topic}` come {ahead:.6} s (deviation {deviation:.1e} s) after those that `{other}` gives, as the path of \
         the contact on palm {palm} tells; say so by [[clock]] topic = \"{topic}\", ahead = {ahead:.6} in the mapping, or that it is \
         not so by `clocks_as_stamped = true`"
    )]
    ClocksDisagree {
        /// Topic of contacts.
        topic: String,
        /// Topic of forces.
        other: String,
        /// Palm from 1.
        palm: usize,
        /// Stamp of the former minus stamp of the latter for one event, s.
        ahead: f64,
        /// Standard deviation of that, s.
        deviation: f64,
    },
    /// A wrench that no contact on the palm exerts.
    #[error(
        "topic `{topic}`, t = {t} s: {source}; is `force_on` right, and the shape of palm {palm}? Or give contacts by `contact`"
    )]
    Pressure {
        /// The topic.
        topic: String,
        /// Palm from 1.
        palm: usize,
        /// Time since the first stamp of the bag, s.
        t: f64,
        /// Why.
        source: PressureError,
    },
    /// No sample at which all palms have readings.
    #[error(
        "at none of the {asked} times of `{topic}` all mapped topics have readings; {lacking} lacks most of them"
    )]
    NoSamples {
        /// Topic whose times are asked for.
        topic: String,
        /// How many.
        asked: usize,
        /// What lacks readings most often.
        lacking: String,
    },
    /// An array of values that is not that of the mapping.
    #[error("topic `{topic}`, t = {t} s: {found}; `{key}` in the mapping says {expected}")]
    Array {
        /// The topic.
        topic: String,
        /// Time since the first stamp of the bag, s.
        t: f64,
        /// What there is.
        found: String,
        /// What should be.
        expected: String,
        /// The key that says so.
        key: String,
    },
    /// No palm to make a log of.
    #[error("has no topic of wrenches, contacts or taxels that is read; there are: {found}")]
    NoPalms {
        /// Topics with what they hold.
        found: String,
    },
    /// The scene has another number of palms than the mapping.
    #[error(
        "the mapping has {mapped} [[palm]] table(s) where the scene has {palms} palm(s); give one for each, in the same order"
    )]
    PalmCount {
        /// Palms of the mapping.
        mapped: usize,
        /// Palms of the scene.
        palms: usize,
    },
    /// The scene and the mapping say different things of a palm's shape.
    #[error("palm {palm} is {mapped} by the mapping and {scene} by the scene; keep one, or make them agree")]
    OtherShape {
        /// Palm from 1.
        palm: usize,
        /// By the mapping.
        mapped: String,
        /// By the scene.
        scene: String,
    },
    /// The samples do not make a log.
    #[error("{source}{}", stamp.map_or(String::new(), |stamp| format!(" (stamp {stamp} ns)")))]
    Samples {
        /// Stamp of the sample at fault, ns.
        stamp: Option<i64>,
        /// Why.
        source: ContactLogError,
    },
}

/// Why the messages of a topic are not read.
#[derive(Clone, Debug, Error, Eq, PartialEq)]
#[non_exhaustive]
pub enum Unread {
    /// Its schema is of no kind that is read.
    #[error("{} are not read; read are {}", of_schema(schema), known())]
    Schema {
        /// Name of the schema.
        schema: String,
    },
    /// Its schema is written in an unknown language.
    #[error(
        "its schema has the encoding `{found}`; `ros2msg` and `ros2idl` are read. Record with the mcap storage of rosbag2"
    )]
    SchemaEncoding {
        /// As found.
        found: String,
    },
    /// Its definition has other fields than those that are read.
    #[error(
        "its definition of `{schema}` has the fields {found}, where {expected} are read; convert it to the message of ROS 2 of that name"
    )]
    Definition {
        /// Name of the schema.
        schema: String,
        /// Types of its fields, lists in brackets.
        found: String,
        /// Those of the message that is read.
        expected: String,
    },
    /// Its messages are encoded otherwise.
    #[error(
        "its messages have the encoding `{found}`; `cdr` is read. Record with the mcap storage of rosbag2"
    )]
    MessageEncoding {
        /// As found.
        found: String,
    },
    /// It has channels of different kinds.
    #[error("it has messages of `{first}` and of `{second}`; record them on topics of their own")]
    TwoKinds {
        /// One schema.
        first: String,
        /// Another.
        second: String,
    },
    /// A message is not what the schema says.
    #[error(
        "message {number} (log time {logged} ns) is no {kind}: {source}; was it recorded with another version of the definition?"
    )]
    Message {
        /// Number from 1, in the order of the file.
        number: usize,
        /// Its log time, ns.
        logged: u64,
        /// What it should be.
        kind: &'static str,
        /// Why it is not.
        source: CdrError,
    },
}

/// The first bytes of a file, as text where they are.
fn begins(found: &[u8]) -> String {
    match str::from_utf8(found) {
        Ok("") => "it is empty".to_owned(),
        Ok(text) if !text.contains(|c: char| c.is_control() && !c.is_whitespace()) => {
            format!("it begins with the text `{}`", text.split_whitespace().collect::<Vec<_>>().join(" "))
        }
        _ => {
            let bytes: Vec<String> = found.iter().map(|byte| format!("{byte:02x}")).collect();
            format!("it begins with the bytes {}", bytes.join(" "))
        }
    }
}

/// Messages by their schema.
fn of_schema(name: &str) -> String {
    if name.is_empty() { "messages without a schema".to_owned() } else { format!("messages of `{name}`") }
}

fn known() -> String {
    super::MessageKind::ALL.map(super::MessageKind::name).join(", ")
}

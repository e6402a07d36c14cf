//! The messages that are understood, and how their bytes are read.

use super::cdr::{Cdr, CdrError};
use std::sync::Arc;

/// Pictures of more values than this are no arrays of taxels, and are passed by.
const MOST_TAXELS: usize = 1 << 16;

/// A kind of message that is understood.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum MessageKind {
    /// `geometry_msgs/msg/WrenchStamped`.
    Wrench,
    /// `geometry_msgs/msg/PointStamped`.
    Point,
    /// `geometry_msgs/msg/PoseStamped`.
    Pose,
    /// `tf2_msgs/msg/TFMessage`.
    Transforms,
    /// `sensor_msgs/msg/JointState`.
    Joints,
    /// `sensor_msgs/msg/Image` of one number a pixel.
    Image,
    /// `tactile_msgs/msg/TactileState`.
    Tactile,
    /// `recon_msgs/msg/Contact`, whose definition is in `ros/recon_msgs`.
    Contact,
}

impl MessageKind {
    /// All kinds.
    pub const ALL: [Self; 8] = [
        Self::Wrench,
        Self::Point,
        Self::Pose,
        Self::Transforms,
        Self::Joints,
        Self::Image,
        Self::Tactile,
        Self::Contact,
    ];

    /// Its name in ROS 2.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Wrench => "geometry_msgs/msg/WrenchStamped",
            Self::Point => "geometry_msgs/msg/PointStamped",
            Self::Pose => "geometry_msgs/msg/PoseStamped",
            Self::Transforms => "tf2_msgs/msg/TFMessage",
            Self::Joints => "sensor_msgs/msg/JointState",
            Self::Image => "sensor_msgs/msg/Image",
            Self::Tactile => "tactile_msgs/msg/TactileState",
            Self::Contact => "recon_msgs/msg/Contact",
        }
    }

    /// The kind of that name, with or without `/msg/`.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name || kind.name().replace("/msg/", "/") == name)
    }
}

/// What a message says beside its header.
#[derive(Clone, Debug, PartialEq)]
pub enum Reading {
    /// Force (N) and torque (N m), x, y, z each.
    Wrench([f64; 6]),
    /// A point, m.
    Point([f64; 3]),
    /// Position (m) and orientation (x, y, z, w).
    Pose([f64; 7]),
    /// Transforms, each with its own stamp.
    Transforms(Vec<BagTransform>),
    /// States of joints.
    Joints(Vec<Joint>),
    /// Values of an array of taxels, row by row.
    Taxels {
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
        /// As they stand in the message.
        values: Vec<f64>,
    },
    /// A picture that is no array of taxels: several channels, too many pixels or an encoding that has no numbers.
    Picture {
        /// Its encoding.
        encoding: String,
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
    },
    /// Named arrays of values.
    Arrays(Vec<(Arc<str>, Vec<f64>)>),
    /// A contact, or none: point (m) and force on the object (N).
    Contact(Option<([f64; 3], [f64; 3])>),
}

/// A frame in another at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct BagTransform {
    /// Time since the epoch of its clock, ns.
    pub stamp: i64,
    /// The frame in which the child stands.
    pub parent: Arc<str>,
    /// The frame that stands there.
    pub child: Arc<str>,
    /// Translation (m) and rotation (x, y, z, w), child to parent.
    pub pose: [f64; 7],
}

/// State of one joint.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// Its name.
    pub name: Arc<str>,
    /// Angle (rad) or displacement (m), where it is stated.
    pub position: Option<f64>,
    /// Torque (N m) or force (N), where it is stated.
    pub effort: Option<f64>,
}

/// Header and contents of a message.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Decoded {
    /// Time since the epoch of its clock, ns.
    pub(super) stamp: i64,
    pub(super) frame: Arc<str>,
    pub(super) reading: Reading,
}

/// One string for every name, however often it stands in messages.
#[derive(Default)]
pub(super) struct Names(std::collections::BTreeSet<Arc<str>>);

impl Names {
    fn shared(&mut self, name: &str) -> Arc<str> {
        if let Some(known) = self.0.get(name) {
            return Arc::clone(known);
        }
        let new: Arc<str> = name.into();
        self.0.insert(Arc::clone(&new));
        new
    }
}

/// Reads a message of a kind.
///
/// # Errors
/// [`CdrError`] names the field and the byte.
pub(super) fn decode(kind: MessageKind, bytes: &[u8], names: &mut Names) -> Result<Decoded, CdrError> {
    let mut from = Cdr::new(bytes)?;
    let decoded = match kind {
        MessageKind::Transforms => transforms(&mut from, names)?,
        _ => {
            let (stamp, frame) = header(&mut from, names)?;
            Decoded { stamp, frame, reading: reading(kind, &mut from, names)? }
        }
    };
    from.end()?;
    Ok(decoded)
}

fn reading(kind: MessageKind, from: &mut Cdr, names: &mut Names) -> Result<Reading, CdrError> {
    Ok(match kind {
        MessageKind::Wrench => Reading::Wrench(from.f64s("force and torque")?),
        MessageKind::Point => Reading::Point(from.f64s("the point")?),
        MessageKind::Pose => Reading::Pose(from.f64s("the pose")?),
        MessageKind::Joints => joints(from, names)?,
        MessageKind::Image => image(from)?,
        MessageKind::Tactile => arrays(from, names)?,
        MessageKind::Contact => {
            let touched = from.u8("touched")? != 0;
            let (point, force) = (from.f64s("the point")?, from.f64s("the force")?);
            Reading::Contact(touched.then_some((point, force)))
        }
        // Has no header of its own; see `decode`.
        MessageKind::Transforms => transforms(from, names)?.reading,
    })
}

fn header(from: &mut Cdr, names: &mut Names) -> Result<(i64, Arc<str>), CdrError> {
    let (seconds, nanoseconds) = (from.i32("header.stamp.sec")?, from.u32("header.stamp.nanosec")?);
    let stamp = i64::from(seconds) * 1_000_000_000 + i64::from(nanoseconds);
    Ok((stamp, names.shared(from.text("header.frame_id")?)))
}

/// The stamp of the message is that of its first transform, the frame its parent.
fn transforms(from: &mut Cdr, names: &mut Names) -> Result<Decoded, CdrError> {
    let count = from.count(80, "transforms")?;
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        let (stamp, parent) = header(from, names)?;
        let child = names.shared(from.text("child_frame_id")?);
        all.push(BagTransform { stamp, parent, child, pose: from.f64s("a transform")? });
    }
    let first = all.first().map(|first| (first.stamp, Arc::clone(&first.parent)));
    let (stamp, frame) = first.unwrap_or_else(|| (0, names.shared("")));
    Ok(Decoded { stamp, frame, reading: Reading::Transforms(all) })
}

fn joints(from: &mut Cdr, names: &mut Names) -> Result<Reading, CdrError> {
    let count = from.count(4, "name")?;
    let mut known = Vec::with_capacity(count);
    for _ in 0..count {
        known.push(names.shared(from.text("a joint's name")?));
    }
    let mut numbers = |what| -> Result<Vec<f64>, CdrError> {
        let count = from.count(8, what)?;
        (0..count).map(|_| from.f64(what)).collect()
    };
    let (positions, _, efforts) = (numbers("position")?, numbers("velocity")?, numbers("effort")?);
    let joint =
        |(k, name)| Joint { name, position: positions.get(k).copied(), effort: efforts.get(k).copied() };
    Ok(Reading::Joints(known.into_iter().enumerate().map(joint).collect()))
}

fn arrays(from: &mut Cdr, names: &mut Names) -> Result<Reading, CdrError> {
    let count = from.count(8, "sensors")?;
    let mut all = Vec::with_capacity(count);
    for _ in 0..count {
        let name = names.shared(from.text("a sensor's name")?);
        let values = from.count(4, "values")?;
        let values: Result<Vec<f64>, CdrError> =
            (0..values).map(|_| from.f32("values").map(f64::from)).collect();
        all.push((name, values?));
    }
    Ok(Reading::Arrays(all))
}

fn image(from: &mut Cdr) -> Result<Reading, CdrError> {
    let (rows, columns) = (from.u32("height")? as usize, from.u32("width")? as usize);
    let encoding = from.text("encoding")?;
    let big = from.u8("is_bigendian")? != 0;
    let step = from.u32("step")? as usize;
    let data = from.blob("data")?;
    let picture = || Reading::Picture { encoding: encoding.to_owned(), rows, columns };
    let Some((size, value)) = pixel(encoding, big) else { return Ok(picture()) };
    let fits = columns.checked_mul(size).is_some_and(|least| step >= least)
        && step.checked_mul(rows).is_some_and(|all| all <= data.len());
    let few = rows.checked_mul(columns).is_some_and(|count| count <= MOST_TAXELS);
    if !(fits && few && columns > 0) {
        return Ok(picture());
    }
    let row = |line: usize| data[line * step..].chunks_exact(size).take(columns).map(value);
    Ok(Reading::Taxels { rows, columns, values: (0..rows).flat_map(row).collect() })
}

/// The value of a pixel.
type PixelValue = fn(&[u8]) -> f64;

/// Bytes of a pixel of one channel, and how they are read.
fn pixel(encoding: &str, big: bool) -> Option<(usize, PixelValue)> {
    fn of<const N: usize>(bytes: &[u8]) -> [u8; N] {
        let mut array = [0; N];
        array.iter_mut().zip(bytes).for_each(|(to, from)| *to = *from);
        array
    }
    Some(match (encoding, big) {
        ("32FC1", false) => (4, |b| f64::from(f32::from_le_bytes(of(b)))),
        ("32FC1", true) => (4, |b| f64::from(f32::from_be_bytes(of(b)))),
        ("64FC1", false) => (8, |b| f64::from_le_bytes(of(b))),
        ("64FC1", true) => (8, |b| f64::from_be_bytes(of(b))),
        ("8UC1" | "mono8", _) => (1, |b| f64::from(u8::from_le_bytes(of(b)))),
        ("8SC1", _) => (1, |b| f64::from(i8::from_le_bytes(of(b)))),
        ("16UC1" | "mono16", false) => (2, |b| f64::from(u16::from_le_bytes(of(b)))),
        ("16UC1" | "mono16", true) => (2, |b| f64::from(u16::from_be_bytes(of(b)))),
        ("16SC1", false) => (2, |b| f64::from(i16::from_le_bytes(of(b)))),
        ("16SC1", true) => (2, |b| f64::from(i16::from_be_bytes(of(b)))),
        ("32SC1", false) => (4, |b| f64::from(i32::from_le_bytes(of(b)))),
        ("32SC1", true) => (4, |b| f64::from(i32::from_be_bytes(of(b)))),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::super::cdr::CdrWriter;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        /// Whatever bytes come, there is a message or an error.
        #[test]
        fn no_bytes_make_it_panic(mut bytes in proptest::collection::vec(any::<u8>(), 0..200), version in 0..8_u8) {
            if let Some(first) = bytes.first_chunk_mut::<2>() {
                *first = [0, version];
            }
            for kind in MessageKind::ALL {
                let _ = decode(kind, &bytes, &mut Names::default());
            }
        }

        /// Nor does damage to a message that was whole.
        #[test]
        fn no_damage_makes_it_panic(at in 0..10_000_usize, to in any::<u8>(), cut in 0..10_000_usize) {
            for kind in MessageKind::ALL {
                let mut bytes = example(kind, CdrWriter::new());
                prop_assert!(decode(kind, &bytes, &mut Names::default()).is_ok());
                let length = bytes.len();
                bytes[at % length] = to;
                let _ = decode(kind, &bytes, &mut Names::default());
                bytes.truncate(cut % length);
                let _ = decode(kind, &bytes, &mut Names::default());
            }
        }
    }

    fn example(kind: MessageKind, mut to: CdrWriter) -> Vec<u8> {
        if kind == MessageKind::Transforms {
            to.count(1);
        }
        to.i32(12).u32(34).text("palm");
        let numbers = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        match kind {
            MessageKind::Wrench => to.f64s(&numbers[..6]),
            MessageKind::Point => to.f64s(&numbers[..3]),
            MessageKind::Pose => to.f64s(&numbers),
            MessageKind::Transforms => to.text("child").f64s(&numbers),
            MessageKind::Joints => to
                .count(2)
                .text("a")
                .text("b")
                .count(2)
                .f64s(&[0.5, 0.25])
                .count(0)
                .count(2)
                .f64s(&[8.0, 9.0]),
            MessageKind::Image => {
                to.u32(2).u32(1).text("32FC1").u8(0).u32(8).count(16);
                [1.5_f32, 0.0, 2.5, 0.0].iter().flat_map(|v| v.to_le_bytes()).fold(&mut to, |to, b| to.u8(b))
            }
            MessageKind::Tactile => to.count(1).text("tips").count(2).f32(1.5).f32(2.5),
            MessageKind::Contact => to.u8(1).f64s(&numbers[..6]),
        };
        to.into_bytes()
    }

    #[test]
    fn every_kind_is_read_in_both_byte_orders() {
        let names = |k: &str| -> Arc<str> { k.into() };
        let joint = |name: &str, position, effort| Joint {
            name: name.into(),
            position: Some(position),
            effort: Some(effort),
        };
        let pose = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let stamp = 12_000_000_034;
        let transform = BagTransform { stamp, parent: names("palm"), child: names("child"), pose };
        for kind in MessageKind::ALL {
            let expected = match kind {
                MessageKind::Wrench => Reading::Wrench([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
                MessageKind::Point => Reading::Point([1.0, 2.0, 3.0]),
                MessageKind::Pose => Reading::Pose(pose),
                MessageKind::Transforms => Reading::Transforms(vec![transform.clone()]),
                MessageKind::Joints => Reading::Joints(vec![joint("a", 0.5, 8.0), joint("b", 0.25, 9.0)]),
                // A row has eight bytes, of which the first four are a pixel.
                MessageKind::Image => Reading::Taxels { rows: 2, columns: 1, values: vec![1.5, 2.5] },
                MessageKind::Tactile => Reading::Arrays(vec![(names("tips"), vec![1.5, 2.5])]),
                MessageKind::Contact => Reading::Contact(Some(([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]))),
            };
            for to in [CdrWriter::new(), CdrWriter::big_endian()] {
                let found = decode(kind, &example(kind, to), &mut Names::default()).unwrap();
                assert_eq!(
                    (found.stamp, &*found.frame, &found.reading),
                    (stamp, "palm", &expected),
                    "{kind:?}"
                );
            }
        }
    }

    #[test]
    fn pixels_of_every_encoding_have_their_value() {
        let mut bytes = 258_u16.to_be_bytes().to_vec();
        let value = |encoding, big, bytes: &[u8]| pixel(encoding, big).map(|(size, of)| (size, of(bytes)));
        assert_eq!(value("16UC1", true, &bytes), Some((2, 258.0)));
        assert_eq!(value("mono16", false, &bytes), Some((2, 513.0)));
        assert_eq!(value("mono8", false, &bytes), Some((1, 1.0)));
        bytes = (-3_i32).to_be_bytes().to_vec();
        assert_eq!(value("32SC1", true, &bytes), Some((4, -3.0)));
        assert_eq!(value("16SC1", true, &bytes), Some((2, -1.0)));
        assert_eq!(value("8SC1", true, &bytes), Some((1, -1.0)));
        assert_eq!(value("64FC1", true, &0.1_f64.to_be_bytes()), Some((8, 0.1)));
        assert_eq!(value("32FC1", true, &0.5_f32.to_be_bytes()), Some((4, 0.5)));
        assert!(pixel("rgb8", false).is_none() && pixel("32FC3", false).is_none());
    }

    #[test]
    fn names_are_taken_with_and_without_their_middle() {
        for kind in MessageKind::ALL {
            assert_eq!(MessageKind::of(kind.name()), Some(kind));
            assert_eq!(MessageKind::of(&kind.name().replace("/msg/", "/")), Some(kind));
        }
        assert_eq!(MessageKind::of("geometry_msgs/msg/Wrench"), None);
    }
}

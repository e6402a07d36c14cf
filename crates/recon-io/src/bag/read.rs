use super::error::{BagError, BagErrorKind as Kind, Unread};
use super::message::{Decoded, MessageKind, Names, decode};
use super::records::{End, Raw, Unpacker, walk};
use super::topic::{Message, Topic};
use mcap::records::{Channel, Record, op};
use std::collections::{BTreeMap, HashMap};
use std::io::{BufReader, Read};
use std::path::Path;

/// What a bag holds of what is understood, in memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bag {
    /// Its topics, by name.
    pub topics: BTreeMap<String, Topic>,
    /// What wrote it.
    pub library: String,
    /// Metadata records, by name.
    pub metadata: BTreeMap<String, BTreeMap<String, String>>,
    /// Where it was cut off, bytes from its start; none of a whole one.
    pub cut: Option<u64>,
}

/// Reads a bag.
///
/// A bag that was cut off is read up to there, and [`Bag::cut`] says so. Topics that are not understood have a count and a
/// reason in [`Topic::kind`].
///
/// # Errors
/// [`BagError`] names the file and the place.
pub fn read_bag(path: impl AsRef<Path>) -> Result<Bag, BagError> {
    let path = path.as_ref();
    let file = std::fs::File::open(path).map_err(|error| Kind::from(error).in_file(path))?;
    parse_bag(BufReader::with_capacity(1 << 18, file)).map_err(|kind| kind.in_file(path))
}

/// The same from bytes, as they come.
///
/// # Errors
/// [`BagErrorKind`](Kind) names the place.
pub fn parse_bag(from: impl Read) -> Result<Bag, Kind> {
    let (mut reader, mut unpacker) = (Reader::default(), Unpacker::new());
    let end = walk(from, |raw| match raw.operation {
        op::CHUNK => {
            unpacker.unpack(&raw, |operation, contents| reader.record(raw.place, operation, contents))
        }
        _ => {
            let Raw { place, operation, contents } = raw;
            reader.record(place, operation, &contents)
        }
    })?;
    let mut bag = reader.bag;
    for topic in bag.topics.values_mut() {
        // Stable: messages of one log time keep their order in the file.
        topic.messages.sort_by_key(|message| message.logged);
    }
    if let End::Cut { place } = end {
        bag.cut = Some(place);
    }
    Ok(bag)
}

/// Whether a file begins as bags do; false where it cannot be read.
#[must_use]
pub fn is_bag(path: impl AsRef<Path>) -> bool {
    let path = path.as_ref();
    // A pipe would lose the bytes.
    if !path.is_file() {
        return false;
    }
    let mut magic = [0; mcap::MAGIC.len()];
    std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut magic)).is_ok()
        && magic == *mcap::MAGIC
}

#[derive(Default)]
struct Reader {
    bag: Bag,
    /// Name and encoding of schemas by number.
    schemas: HashMap<u16, (String, String)>,
    /// Channels by number; with the name of the topic.
    channels: HashMap<u16, Channel>,
    names: Names,
}

impl Reader {
    fn record(&mut self, place: u64, operation: u8, contents: &[u8]) -> Result<(), Kind> {
        let what = match operation {
            op::HEADER => "header",
            op::SCHEMA => "schema",
            op::CHANNEL => "channel",
            op::MESSAGE => "message",
            op::METADATA => "metadata record",
            _ => return Ok(()),
        };
        let fault = |detail: String| Kind::Record { place, what, detail };
        match mcap::parse_record(operation, contents).map_err(|error| fault(error.to_string()))? {
            Record::Header(header) => self.bag.library = header.library,
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, (header.name, header.encoding));
            }
            Record::Channel(channel) => self.channel(channel),
            Record::Message { header, data } => {
                let channel = self.channels.get(&header.channel_id);
                let topic = channel.and_then(|channel| self.bag.topics.get_mut(&channel.topic));
                let topic =
                    topic.ok_or_else(|| fault(format!("no channel {} was announced", header.channel_id)))?;
                topic.count += 1;
                let Ok(kind) = topic.kind else { return Ok(()) };
                match decode(kind, &data, &mut self.names) {
                    Ok(Decoded { stamp, frame, reading }) => topic.messages.push(Message {
                        stamp,
                        logged: header.log_time,
                        published: header.publish_time,
                        sequence: header.sequence,
                        frame,
                        reading,
                    }),
                    Err(source) => {
                        let (number, logged) = (topic.count, header.log_time);
                        topic.messages.clear();
                        topic.kind = Err(Unread::Message { number, logged, kind: kind.name(), source });
                    }
                }
            }
            Record::Metadata(metadata) => {
                self.bag.metadata.insert(metadata.name, metadata.metadata);
            }
            _ => {}
        }
        Ok(())
    }

    fn channel(&mut self, channel: Channel) {
        if self.channels.get(&channel.id) == Some(&channel) {
            return;
        }
        let (schema, schema_encoding) = self.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
        let message_encoding = channel.message_encoding.clone();
        let kind = kind(&schema, &schema_encoding, &message_encoding);
        if let Some(known) = self.bag.topics.get_mut(&channel.topic) {
            known.channels += 1;
            if known.schema != schema {
                let first = known.schema.clone();
                known.kind = Err(Unread::TwoKinds { first, second: schema });
            } else if let (Ok(_), Err(why)) = (&known.kind, kind) {
                known.kind = Err(why);
            }
        } else {
            let (name, messages) = (channel.topic.clone(), Vec::new());
            let topic = Topic {
                name,
                schema,
                schema_encoding,
                message_encoding,
                channels: 1,
                kind,
                messages,
                count: 0,
            };
            self.bag.topics.insert(channel.topic.clone(), topic);
        }
        self.channels.insert(channel.id, channel);
    }
}

fn kind(schema: &str, schema_encoding: &str, message_encoding: &str) -> Result<MessageKind, Unread> {
    let kind = MessageKind::of(schema).ok_or_else(|| Unread::Schema { schema: schema.to_owned() })?;
    if !["ros2msg", "ros2idl"].contains(&schema_encoding) {
        return Err(Unread::SchemaEncoding { found: schema_encoding.to_owned() });
    }
    match message_encoding {
        "cdr" => Ok(kind),
        found => Err(Unread::MessageEncoding { found: found.to_owned() }),
    }
}

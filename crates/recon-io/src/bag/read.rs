use super::definition::{expected, fields};
use super::error::{BagError, BagErrorKind as Kind, Unread};
use super::message::{Decoded, MessageKind, Names, decode};
use super::records::{End, Raw, Unpacker, walk};
use super::topic::{Message, Topic};
use mcap::records::{Channel, Record, SchemaHeader, op};
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

impl Bag {
    /// Topics with what they hold, in one line.
    pub(super) fn listed(&self) -> String {
        let about = |topic: &Topic| format!("{} ({})", topic.name, topic.schema);
        let all: Vec<String> = self.topics.values().map(about).collect();
        if all.is_empty() { "none".to_owned() } else { all.join(", ") }
    }
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
    /// Schemas by number.
    schemas: HashMap<u16, Schema>,
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
            Record::Schema { header, data } => {
                let kind = kind(&header.name, &header.encoding, &data);
                let SchemaHeader { id, name, encoding } = header;
                self.schemas.insert(id, Schema { name, encoding, kind });
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
        // A number of no schema says that there is none.
        let known = self.schemas.get(&channel.schema_id);
        let (schema, schema_encoding) =
            known.map(|s| (s.name.clone(), s.encoding.clone())).unwrap_or_default();
        let kind =
            known.map_or_else(|| Err(Unread::Schema { schema: String::new() }), |schema| schema.kind.clone());
        let message_encoding = channel.message_encoding.clone();
        let kind = kind.and_then(|kind| match message_encoding.as_str() {
            "cdr" => Ok(kind),
            found => Err(Unread::MessageEncoding { found: found.to_owned() }),
        });
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

/// A schema, and what is read by it.
struct Schema {
    name: String,
    encoding: String,
    kind: Result<MessageKind, Unread>,
}

fn kind(name: &str, encoding: &str, definition: &[u8]) -> Result<MessageKind, Unread> {
    let kind = MessageKind::of(name).ok_or_else(|| Unread::Schema { schema: name.to_owned() })?;
    match encoding {
        "ros2msg" => {}
        // Its language is another, and recorders write it for messages that are defined so alone.
        "ros2idl" => return Ok(kind),
        found => return Err(Unread::SchemaEncoding { found: found.to_owned() }),
    }
    let expected = expected(kind);
    // Definitions that refer to what is not there are not looked at: each message is checked as it is read.
    match std::str::from_utf8(definition).ok().and_then(|text| fields(name, text)) {
        Some(found) if !found.is_empty() && found != expected => {
            Err(Unread::Definition { schema: name.to_owned(), found, expected })
        }
        _ => Ok(kind),
    }
}

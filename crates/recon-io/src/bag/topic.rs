use super::error::Unread;
use super::message::{MessageKind, Reading};
use std::sync::Arc;

/// One topic of a bag, with its messages in the order of their log times.
#[derive(Clone, Debug, PartialEq)]
pub struct Topic {
    /// Its name.
    pub name: String,
    /// Name of its schema.
    pub schema: String,
    /// In which language the schema is written.
    pub schema_encoding: String,
    /// How messages are encoded.
    pub message_encoding: String,
    /// How many channels it has: two of them count their messages apart.
    pub channels: usize,
    /// What its messages are; or why they are not read.
    pub kind: Result<MessageKind, Unread>,
    /// The messages that were read; none where they cannot be.
    pub messages: Vec<Message>,
    /// How many messages there are, read or not.
    pub count: usize,
}

/// One message.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// Time in its header since the epoch of its clock, ns.
    pub stamp: i64,
    /// When it was recorded, ns.
    pub logged: u64,
    /// When it was published, ns.
    pub published: u64,
    /// Its number in its channel, where the recorder counts.
    pub sequence: u32,
    /// The frame in its header.
    pub frame: Arc<str>,
    /// What it says.
    pub reading: Reading,
}

impl Topic {
    /// Frames in the headers of its messages, each once, in the order in which they occur.
    #[must_use]
    pub fn frames(&self) -> Vec<&str> {
        let mut frames: Vec<&str> = Vec::new();
        for message in &self.messages {
            if !frames.contains(&&*message.frame) {
                frames.push(&message.frame);
            }
        }
        frames
    }
}
